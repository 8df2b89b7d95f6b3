"""A game is scored by rules of the user's own, and says so wherever it is kept."""

from __future__ import annotations

from pathlib import Path

import pytest
from games import bare, bumper, hit_bumper, kinds, lose, put

import silverball as sb
from boards import CLASSIC, table_of
from silverball.game.replay.player import ReplayPlayer
from silverball.game.scores.store import Score, Store
from silverball.game.scores.verify_score import verify_score
from silverball.table import SlantWall


class Streak(sb.ArcadeRules):
    """The n-th hit of a part in a row scores n points; the parts that were hit are remembered."""

    name = "streak 1"

    def hit(self, config, state, tick, points, part):
        before = (state.memory or {}).get(part, 0)
        memory = (state.memory or {}) | {part: before + 1}
        event = sb.GameEvent(sb.GameEventKind.SCORED, tick, before + 1, part)
        return state._replace(score=state.score + before + 1, quiet_since=tick, memory=memory), (event,)


class Walls(sb.FreeRules):
    """Only walls score."""

    name = "walls"

    def hit(self, config, state, tick, points, part):
        return super().hit(config, state, tick, 5 if part.startswith("slant_wall") else 0, part)


class Countdown:
    """Rules that are derived from nothing: one ball, which ends the game; the score is the time it lasted."""

    name = "countdown"

    def configure(self, table, tick_rate):
        return sb.RuleConfig.of(table, tick_rate)._replace(auto_shove=False)

    def refusal(self, config, state):
        return "there is one ball only" if state.used else ""

    def started(self, config, state, tick, ball):
        balls = (sb.InPlay(ball, 1, 0, 0),)
        return state._replace(used=1, balls=balls, memory=tick), ()

    def returned(self, config, state, tick, ball):
        raise AssertionError("no ball is ever saved by these rules")

    def hit(self, config, state, tick, points, part):
        return state, ()

    def drained(self, config, state, tick, ball):
        return state._replace(balls=(), over=True, score=tick - state.memory), ()

    def shoved(self, config, state, tick):
        return state, ()

    def multiplier(self, config, state, tick):
        return 1


def played(rules: sb.Rules, seconds: int = 20) -> sb.Game:
    game = sb.Game(CLASSIC, seed=3, rules=rules)
    for second in range(seconds):
        if not game.view.on_board and not game.is_over:
            game.create_ball()
        game.step(left=second % 2 == 0, right=second % 3 == 0, ticks=240)
    return game


def test_hits_score_as_the_own_rules_say():
    game = sb.Game(bare(bumper(70)), rules=Streak())
    game.create_ball()
    for number in (1, 2, 3):
        assert [(one.value, one.part) for one in hit_bumper(game)] == [(number, "cylinder[0]")]
    assert (game.score, game.state.memory) == (6, {"cylinder[0]": 3})


def test_own_rules_receive_hits_of_parts_without_points():
    walls = [SlantWall(start=(3.0, -3.0), end=(3.0, 3.0), points=0)]
    game = sb.Game(table_of(*walls), rules=Walls())
    game.create_ball()
    put(game, 6.0, 0.0, vx=-5.0)
    game.step(ticks=240)
    assert game.score > 0
    assert game.score % 5 == 0


def test_rules_need_not_be_derived_from_the_built_in_ones():
    game = sb.Game(bare(), rules=Countdown())
    game.create_ball()
    with pytest.raises(sb.SilverballError, match="one ball only"):
        game.create_ball()
    game.step(ticks=100)
    lose(game)
    assert game.is_over
    assert 100 < game.score <= 105


@pytest.mark.parametrize("rules", [Streak(), Walls(), Countdown()])
def test_a_replay_verifies_with_its_own_rules(rules: sb.Rules):
    game = played(rules)
    replay = sb.Replay.from_text(game.replay.to_text())
    assert replay == game.replay
    assert replay.rules == rules.name
    verdict = replay.verify(rules=rules)
    assert verdict.ok, verdict.message
    assert verdict.score == game.score
    ReplayPlayer(replay, rules).seek(replay.ticks)


def test_other_rules_of_the_same_name_give_another_game():
    class Other(Streak):
        def hit(self, config, state, tick, points, part):
            return state, ()

    assert played(Streak()).score > 0
    assert not played(Streak()).replay.verify(rules=Other()).ok


def test_verifying_without_the_right_rules_says_which_are_needed():
    own, built_in = played(Streak()).replay, sb.Game(CLASSIC).replay
    for replay, rules, message in (
        (own, None, r"custom rules, 'streak 1'; .*replay.verify\(rules=…\)"),
        (own, Walls(), "by the rules 'streak 1', not by 'walls'"),
        (built_in, Walls(), "by the built-in rules, not by 'walls'"),
    ):
        with pytest.raises(sb.StateError, match=message):
            replay.verify(rules=rules)
        with pytest.raises(sb.StateError, match=message):
            ReplayPlayer(replay, rules)


@pytest.mark.parametrize("name", ["", "arcade", "free", "two\nlines", " x", "x" * 61, 5])
def test_rules_with_a_name_that_cannot_stand_in_a_replay_are_refused(name: object):
    rules = Streak()
    rules.name = name  # type: ignore[assignment]
    with pytest.raises(ValueError, match="need a name"):
        sb.Game(CLASSIC, rules=rules)
    text = played(Streak(), 1).replay.to_text()
    with pytest.raises(sb.StateError):
        sb.Replay.from_text(text.replace("own_rules = streak 1", f"own_rules = {name}"))


def test_a_saved_game_continues_with_its_own_rules_and_refuses_others():
    game = played(Streak(), 10)
    other = sb.Game(CLASSIC, seed=99, rules=Streak())
    other.restore(game.save())
    assert other.state == game.state
    for one in (game, other):
        one.step(ticks=1000)
    assert other.digest() == game.digest()
    for rules, state, message in (
        (Walls(), game.save(), "the rules 'streak 1', this game has the rules 'walls'"),
        (None, game.save(), "the rules 'streak 1', this game has the rules 'of arcade play'"),
        (Streak(), sb.Game(CLASSIC).save(), "the rules 'of arcade play', this game has the rules 'streak 1'"),
    ):
        with pytest.raises(sb.StateError, match=message):
            sb.Game(CLASSIC, rules=rules).restore(state)


def test_a_game_with_own_rules_never_enters_the_score_lists(tmp_path: Path):
    game = played(Streak())
    text = game.replay.to_text()
    with Store(tmp_path) as store:
        with pytest.raises(sb.SilverballError, match="custom rules"):
            store.add_score("ABC", game.score, "arcade", "Classic", "digest", game.seed, text)
        assert store.scores() == []
        row = store.add_score("ABC", 5, "arcade", "Classic", "digest", 1, sb.Game(CLASSIC).replay.to_text())
        forged = store.score(row)
    claim: Score = forged._replace(score=game.score, seed=game.seed)
    assert verify_score(claim, text) == (False, "its replay is of a game with custom rules, 'streak 1'")


def test_the_built_in_rules_write_what_they_always_wrote():
    text = sb.Game(CLASSIC).replay.to_text()
    assert text.startswith("silverball replay 1\n")
    assert "own_rules" not in text
    assert "memory" not in sb.Game(CLASSIC).rules_text


def test_every_event_is_seen_once_by_a_loop_that_reads_after_each_step():
    game, seen = sb.Game(bare(bumper(70), ball_save=0.0)), []
    for number in range(300):
        if game.phase == "ready" and number % 7 == 0:
            game.create_ball()
        if game.view.on_board and number % 40 == 0:
            game.jitter()
        game.step(left=number % 5 < 2, ticks=1 + number % 50)
        seen += game.events
    assert seen == game.take_game_events()
    assert {sb.GameEventKind.BALL_READY, sb.GameEventKind.BALL_LOST} <= set(kinds(seen))


def test_an_event_between_two_steps_is_visible_immediately():
    game = sb.Game(bare(tilt_warning=0.5, tilt_limit=9.0))
    game.create_ball()
    game.step()
    game.jitter()
    assert kinds(list(game.events)) == [sb.GameEventKind.BALL_READY, sb.GameEventKind.WARNING]
    game.step()
    assert kinds(list(game.events)) == [sb.GameEventKind.WARNING]
    game.step(ticks=0)
    assert game.events == ()


def test_a_replay_is_saved_whole_or_not_at_all(tmp_path: Path):
    replay = played(Streak(), 2).replay
    path = tmp_path / "game.replay"
    path.write_text("before")
    replay.save(path)
    assert sb.Replay.load(path) == replay
    assert path.read_bytes() == replay.to_text().encode()
    assert [one.name for one in tmp_path.iterdir()] == ["game.replay"]
    for place in (tmp_path / "gone" / "game.replay", tmp_path):
        with pytest.raises(sb.OutputError, match="cannot be written"):
            replay.save(place)


def test_a_mode_can_be_given_by_its_name_and_a_wrong_one_is_refused():
    assert sb.Game(CLASSIC, mode="free").mode is sb.Mode.FREE
    with pytest.raises(ValueError, match="one of free, arcade, got 'chess'"):
        sb.Game(CLASSIC, mode="chess")
    with pytest.raises(ValueError, match="ticks must be an integer ≥ 0, got -1"):
        sb.Game(CLASSIC).step(ticks=-1)
