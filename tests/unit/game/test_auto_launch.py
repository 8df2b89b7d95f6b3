"""A plunger with `auto_launch` sends off by itself the balls that the game brings, none of the player's."""

from __future__ import annotations

import numpy as np
import pytest

from rule_tables import Bench
from silverball.app.guide import WAIT, PlungerReminder
from silverball.errors import TableError
from silverball.game.builtin_rules import ArcadeRules
from silverball.game.game import Game
from silverball.game.game_batch import GameBatch
from silverball.game.replay.format import Replay
from silverball.game.view import Phase
from silverball.physics.records import EventKind
from silverball.table import Table, check_table, load_table
from silverball.table.file import dump_table, parse_table

SECOND = 240  # ticks
HOLD = 120  # ticks for which the player pulls the plunger
LEAST, GREATEST, DELAY = 12.0, 15.0, 0.5
PLAIN = {"name": "plunger", "position": (-6.0, 3.0), "angle": 100.0}
PLUNGER = {**PLAIN, "auto_launch": (LEAST, GREATEST), "auto_delay": DELAY}
RULES = [{"on_ball": ["launch"], "if_below": {"in_play": 2}, "multiball": 3}]


def table(plunger: dict[str, object] = PLUNGER, **changes: object) -> Table:
    parts = {"paddle": load_table("classic").paddle, "plunger": [plunger], "board": {"max_balls": 4}}
    return Table.model_validate({"format": 2, "name": "Lane", **parts, **changes})


def launches(game: Game) -> list[tuple[int, float]]:
    """The balls that were launched, and how fast."""
    events = game.take_world_events()
    return [(event.ball, event.speed) for event in events if event.kind == "released"]


def start(game: Game) -> None:
    """The player launches a ball."""
    game.create_ball()
    game.step(ticks=HOLD, launch=True)
    game.step()


def test_the_player_launches_his_own_ball():
    game = Game(table(), 5)
    game.create_ball()
    game.step(ticks=60 * SECOND)
    assert launches(game) == []
    assert game.has_ball_to_launch


def test_a_saved_ball_is_launched_after_the_delay_at_a_speed_that_varies():
    speeds = []
    for seed in range(8):
        game = Game(table(arcade={"ball_save": 60.0}), seed)
        start(game)
        launches(game)
        returned = []
        while not returned and game.tick < 60 * SECOND:
            game.step()
            returned = [event for event in game.take_world_events() if event.kind == "created"]
        assert not game.has_ball_to_launch
        game.step(ticks=round(DELAY * SECOND) - 2)
        assert launches(game) == []
        game.step(ticks=4)
        ((ball, speed),) = launches(game)
        assert ball == returned[0].ball
        speeds.append(speed)
    assert all(LEAST <= speed <= GREATEST for speed in speeds)
    assert max(speeds) - min(speeds) > 0.3 * (GREATEST - LEAST)


def test_the_balls_of_a_multiball_are_launched_one_after_the_other():
    game = Game(table(rule=RULES), 5)
    start(game)
    ticks = []
    for _ in range(3 * SECOND):
        ticks += [game.tick for _ in launches(game)]
        game.step()
    assert len(ticks) == 3
    assert all(gap >= DELAY * SECOND for gap in np.diff(ticks[1:]))


def test_without_the_key_the_player_launches_them_too():
    game = Game(table(PLAIN, rule=RULES), 5)
    start(game)
    game.step(ticks=10 * SECOND)
    assert len(launches(game)) == 1
    assert game.has_ball_to_launch


def test_a_button_that_is_let_go_before_launches_it():
    game = Game(table(rule=RULES), 5)
    start(game)
    launches(game)
    game.step(ticks=10, launch=True)
    game.step(ticks=2)
    assert len(launches(game)) == 1
    game.step(ticks=2 * SECOND)
    assert len(launches(game)) == 1  # the third ball; the second one is not launched again


def test_a_tilt_does_not_stop_it():
    game = Game(table(rule=RULES), 5)
    start(game)
    while not game.view.tilted:
        game.jitter()
        game.step()
    game.step(ticks=5 * SECOND)
    assert len(launches(game)) == 3


def test_a_ball_that_falls_back_is_launched_again_while_others_are_in_play():
    bench = Bench(table(rule=RULES))
    ball = bench.record["ball"][0]
    bench.happen(EventKind.CAPTURED, "plunger")
    assert ball["due_tick"] == 0  # the player's own, and the only one
    bench.happen(EventKind.RELEASED, "plunger")
    assert bench.keeper.record["balls"] == 3
    bench.happen(EventKind.CAPTURED, "plunger")
    assert ball["due_tick"] == bench.game.tick + DELAY * SECOND


def test_nothing_reminds_of_a_ball_that_is_launched_by_itself():
    game = Game(table({**PLUNGER, "auto_delay": 8.0}, rule=RULES), 5)
    start(game)
    reminder = PlungerReminder(game, {"create": "SPACE"}.__getitem__)
    hints = []
    for _ in range(round((WAIT + 1.0) * 60)):
        hints.append(reminder.hint())
        game.step(ticks=4)
    assert not any(hints)


def test_rules_in_python_have_it_too():
    class Own(ArcadeRules):
        name = "own"

    game = Game(table(arcade={"ball_save": 60.0}), 5, rules=Own())
    start(game)
    game.step(ticks=12 * SECOND)
    assert len(launches(game)) >= 2


# --- The same bits


@pytest.fixture(scope="module", params=["lane", "silver_comet"])
def machine(request: pytest.FixtureRequest) -> Table:
    if request.param == "lane":
        return table(rule=RULES)
    comet = load_table("silver_comet")
    plunger = comet.plunger[0].model_copy(update={"auto_launch": (22.0, 23.2)})
    return comet.model_copy(update={"plunger": (plunger,)})


def play(game: Game, first: int, end: int, at_once: int = 1) -> None:
    """Hold the plunger for some time each second, and press at random."""
    for tick in range(first, end, at_once):
        pick = np.random.default_rng(tick // 30).random(2) < 0.4
        if tick % 30 == 0 and not game.is_over and game.phase is Phase.READY:
            game.create_ball()
        game.step(bool(pick[0]), bool(pick[1]), at_once, launch=tick % 240 < 60)


def test_ticks_at_once_are_the_same_as_one_by_one_and_the_replay_verifies(machine):
    one, other = Game(machine, 3), Game(machine, 3)
    play(one, 0, 30 * SECOND)
    play(other, 0, 30 * SECOND, 30)
    assert len(launches(one)) > 1
    assert one.digest() == other.digest()
    assert Replay.from_text(one.replay.to_text()).verify().ok


@pytest.mark.parametrize("moment", [30, 60, 90, 150, 1000, 2400])
def test_a_saved_game_continues_bit_for_bit(machine, moment):
    one, other = Game(machine, 3), Game(machine, 3)
    play(one, 0, moment)
    other.restore(one.save())
    play(one, moment, moment + 5 * SECOND)
    play(other, moment, moment + 5 * SECOND)
    assert one.digest() == other.digest()


def test_a_batch_plays_the_same_games(machine):
    count, ticks = 3, 20 * SECOND
    batch = GameBatch(machine, count, 7)
    games = [Game(machine, 7 + number) for number in range(count)]
    actions = np.zeros((1, count, 4), np.bool_)
    for tick in range(0, ticks, 30):
        actions[0, :, :2] = np.random.default_rng(tick).random((count, 2)) < 0.4
        actions[0, :, 3] = tick % 240 < 60
        for number, game in enumerate(games):
            if not game.is_over and game.phase is Phase.READY:
                game.create_ball()
            left, right, _, launch = actions[0, number].tolist()
            game.step(left, right, 30, launch=launch)
        batch.step(actions, 30)
    assert [game.score for game in games] == batch.games["score"].tolist()
    assert [game.world.digest() for game in games] == batch.digests()


# --- The table file


def test_it_is_read_and_written_as_it_was():
    text = dump_table(table())
    assert "auto_launch" in text
    assert parse_table(text, "test") == table()


@pytest.mark.parametrize(
    ("plunger", "words"),
    [
        ({"auto_delay": 0.5}, "auto_launch"),
        ({"auto_launch": 12.0}, "auto_launch"),
        ({"auto_launch": (15.0, 12.0)}, "auto_launch"),
        ({"auto_launch": (12.0, 15.0), "auto_delay": 0.0}, "auto_delay"),
    ],
)
def test_a_wrong_value_is_refused_with_its_name(plunger, words):
    values = {key: list(value) if isinstance(value, tuple) else value for key, value in plunger.items()}
    text = "\n".join(f"{key} = {value}" for key, value in values.items())
    with pytest.raises(TableError, match=words):
        parse_table(f'format = 2\nname = "Lane"\n[[plunger]]\nposition = [-6.0, 3.0]\n{text}\n', "test")


def test_a_speed_beyond_the_cap_is_a_problem():
    problems = check_table(table({**PLUNGER, "auto_launch": (12.0, 100.0)}))
    assert any("auto_launch" in problem.path and "cap" in problem.message for problem in problems)
