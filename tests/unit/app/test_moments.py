"""Challenges, matches and the end of a game, as an evening at the machine meets them."""

from __future__ import annotations

from datetime import date

import pytest

from evenings import Evening
from rule_tables import with_rules
from silverball.app.controls import Action
from silverball.app.guide import MOST_HINTS
from silverball.app.rival import GhostRival
from silverball.app.settings import Settings
from silverball.game.replay.format import Replay
from silverball.game.scores.daily import daily_seed, day_of
from silverball.game.scores.medals import Medal, medal_of, next_medal
from silverball.game.view import GameEvent, GameEventKind, Mode, Phase
from silverball.table import Arcade

WIDE_OPEN = Settings(table="Leaky", is_guided=True)


@pytest.fixture
def evening(tmp_path):
    one = Evening(tmp_path, WIDE_OPEN)
    one.program.finish_loading()
    yield one
    one.store.close()


def items(evening: Evening) -> dict[str, str]:
    """The items of the open page and their hints."""
    return {item.label: item.hint for item in evening.program.menus.context.pages[-1]._current_items()}


def choose(evening: Evening, *labels: str) -> None:
    """Turn to items and choose them."""
    for label in labels:
        assert label in items(evening)
        page = evening.program.menus.context.pages[-1]
        while page._current_items()[page.index].label != label:
            evening.tap(Action.RIGHT)
        evening.tap(Action.CREATE)


def sign(evening: Evening) -> None:
    """Take all initials that are offered."""
    while evening.program.menus.page == "initials":
        evening.tap(Action.CREATE)


def play(evening: Evening) -> None:
    """Play the game to its end, and sign."""
    while not evening.program.session.has_ended:
        evening.play_to_the_end()
    evening.go(3.0)
    sign(evening)
    assert evening.program.menus.page == "over"


def test_after_a_game_one_reads_whom_to_beat_and_plays_again_with_one_press(evening):
    evening.store.add_score(
        "ZED", 9_999_999, "arcade", *evening.program._catalog.score_key(evening.program.board.recipe), 1, ""
    )
    choose(evening, "PLAY")
    play(evening)
    score = evening.program.session.game.score
    lines = [evening.program.menus.context.pages[-1]._title()]
    for _ in range(5):
        evening.go(1.8)
        lines.append(evening.program.menus.context.pages[-1]._title())
    assert "NO. 2" in lines
    assert f"{9_999_999 - score + 1:,} TO BEAT ZED" in lines
    before = evening.program.session
    evening.tap(Action.CREATE)
    assert evening.program.session is not before
    assert evening.program.is_playing


def test_what_made_the_points_adds_up_to_the_score(evening):
    choose(evening, "PLAY")
    play(evening)
    session = evening.program.session
    assert sum(cause.points for cause in session.tally.causes()) == session.game.score
    choose(evening, "POINTS")
    assert items(evening)["CYLINDERS"] == f"{session.game.score:,}   100 %"


def test_one_press_leads_from_the_attract_mode_into_a_game(evening):
    evening.go(31.0)
    assert evening.program.menus.page == "attract"
    evening.tap(Action.CREATE)
    assert evening.program.is_playing
    assert evening.program.is_audible


def test_on_a_table_with_a_plunger_the_first_ball_lies_on_it(tmp_path):
    table = with_rules("")
    evening = Evening(tmp_path, Settings(table=table.name), table)
    evening.program.finish_loading()
    evening.go(31.0)
    evening.tap(Action.CREATE)
    assert evening.program.session.game.phase is Phase.PLAY
    evening.store.close()


def test_todays_board_has_a_list_of_its_own_and_its_best_game_plays_along(evening):
    choose(evening, "PLAY")
    play(evening)
    choose(evening, "MENU", "CHALLENGES")
    assert "NOBODY HAS PLAYED IT YET" in items(evening)["TODAY'S BOARD"]
    choose(evening, "TODAY'S BOARD")
    game = evening.program.session.game
    assert game.seed == daily_seed(date.today())
    assert evening.program.session.rival is None
    play(evening)
    best = game.score
    choose(evening, "PLAY AGAIN")
    rival = evening.program.session.rival
    assert isinstance(rival, GhostRival)
    play(evening)
    assert rival.game.score == best
    digest = evening.program._catalog.score_key(evening.program.board.recipe).digest
    today = evening.store.scores("arcade", digest, seed=daily_seed(date.today()))
    assert [one.score for one in today] == [best, best]
    assert len(evening.store.scores("arcade", digest)) == 3
    choose(evening, "MENU", "CHALLENGES")
    assert f"BEST {best:,} BY AAA" in items(evening)["TODAY'S BOARD"]


def test_the_ghost_has_the_score_that_it_had_after_as_much_play(evening):
    choose(evening, "PLAY")
    play(evening)
    replay = Replay.from_text(evening.store.last_game())
    choose(evening, "MENU", "CHALLENGES", "RACE THE BEST")
    session = evening.program.session
    assert session.game.seed == replay.seed
    evening.go(7.0)  # waits: the ghost waits too
    assert session.rival.game.score == 0
    evening.tap(Action.CREATE)
    for _ in range(6):
        evening.go(0.5)
        assert session.rival.game.score == session.game.score  # nobody touches a key in both games
        assert [ball.position for ball in session.rival.game.world.balls] == [
            ball.position for ball in session.game.world.balls
        ]


def test_a_ghost_whose_replay_was_changed_is_left_out_with_a_sentence(evening):
    choose(evening, "PLAY")
    play(evening)
    evening.store._write(lambda db: db.execute("UPDATE score SET replay = 'no replay'"))
    choose(evening, "MENU", "CHALLENGES", "RACE THE BEST")
    assert evening.program.session.rival is None
    assert "this is not a replay" in evening.said[-1]


def test_the_planner_or_who_stands_in_plays_the_same_seed_beside_you(evening):
    choose(evening, "CHALLENGES", "BEAT THE PLANNER")
    session = evening.program.session
    assert (session.rival.game.seed, session.rival.label) == (session.game.seed, "REFLEX")
    evening.tap(Action.CREATE)
    evening.go(3.0)
    assert session.rival.game.tick > 100
    assert evening.program.display.note.startswith("REFLEX ")
    evening.program.demo_players.is_ready = lambda name: True
    evening.go(0.1)
    assert session.rival.label == "PLANNER"


def test_a_match_asks_every_player_for_initials_and_saves_their_scores(evening):
    choose(evening, "CHALLENGES", "3 PLAYERS")
    assert evening.program.session.game.players == 3
    while not evening.program.session.has_ended:
        evening.play_to_the_end()
    evening.go(3.0)
    for letters in ("B", "C", "D"):
        page = evening.program.menus.context.pages[-1]
        while page.choices[page._turn] != letters:
            evening.tap(Action.RIGHT)
        evening.tap(*[Action.CREATE] * 4)
    game = evening.program.session.game
    saved = {one.player: (one.initials, one.score) for one in evening.store.scores()}
    assert saved == {
        player: (f"{letter}AA", score)
        for player, letter, score in zip((1, 2, 3), "BCD", game.scores, strict=True)
    }
    choose(evening, "PLAY AGAIN")
    assert evening.program.session.game.players == 3


def test_hints_come_in_the_first_game_only_and_at_most_three(tmp_path):
    evening = Evening(tmp_path)
    evening.program.finish_loading()
    choose(evening, "PLAY")
    guide = evening.program.games.guide
    play(evening)
    assert 1 <= guide.shown <= MOST_HINTS
    assert evening.program.settings.current.is_guided
    choose(evening, "PLAY AGAIN")
    assert evening.program.games.guide is None
    evening.store.close()
    again = Evening(tmp_path, Settings.of(Evening(tmp_path).store.settings()))
    assert again.program.settings.current.is_guided


def test_the_bonus_of_a_ball_is_counted_out(evening):
    choose(evening, "PLAY")
    session = evening.program.session
    session.tally.add(
        [GameEvent(GameEventKind.BALL_LOST, 90, 1), GameEvent(GameEventKind.SCORED, 90, 12_345)]
    )
    evening.go(0.1)
    assert session.tally.causes()[0] == ("bonus", 12_345)
    assert evening.program.display._announcements.current.name == "bonus"


def test_rank_is_the_sum_of_what_games_have_earned_and_rejected_ones_do_not_count(evening):
    key = evening.program._catalog.score_key(evening.program.board.recipe)
    ids = [
        evening.store.add_score("AAA", 10, "arcade", key.title, key.digest, 1, "", rank=rank)
        for rank in (2, 0, 3)
    ]
    assert evening.store.rank("arcade", key.digest) == 5
    evening.store.save_verdicts({ids[2]: (False, "its replay finishes 0 missions, not 3")})
    assert evening.store.rank("arcade", key.digest) == 2
    assert evening.store.rank(Mode.FREE, key.digest) == 0


def test_medals_go_by_the_points_that_the_table_states():
    arcade = Arcade(bronze=100, silver=1000, gold=5000)
    table = with_rules("").model_copy(update={"arcade": arcade})
    medals = [medal_of(table, score) for score in (99, 100, 1000, 5000, 9000)]
    assert medals == [None, Medal.BRONZE, Medal.SILVER, Medal.GOLD, Medal.GOLD]
    assert next_medal(table, 150) == (Medal.SILVER, 1000)
    assert next_medal(table, 5000) is None


@pytest.mark.parametrize("medals", [(5, 2, 9), (1, 2, 0), (0, 1, 2), (3, 3, 4)])
def test_medals_that_do_not_rise_are_refused(medals):
    with pytest.raises(ValueError, match="must be three points that rise"):
        Arcade(**dict(zip(Medal, medals, strict=True)))


def test_only_dates_are_daily_seeds():
    day = date(2026, 11, 29)
    assert day_of(daily_seed(day)) == day
    assert [day_of(seed) for seed in (0, 7, 999_999, 20_261_301, 2**63 - 1, 991_231)] == [None] * 6
