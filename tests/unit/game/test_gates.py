"""Custom rules open and close the held gates of a table."""

from __future__ import annotations

import json

import pytest

from silverball.errors import SilverballError
from silverball.game.builtin_rules import ArcadeRules
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.table import Table

PLUNGER = {"position": (-4.0, 0.0), "launch": (9.0, 14.0), "charge": 0.5}
TABLE = Table.model_validate(
    {
        "name": "Gate",
        "plunger": [PLUNGER],
        "gate": [{"name": "lock", "held": True, "start": (0.0, -2.0), "end": (0.0, 2.0)}],
    }
)
SECOND = 240


class Locked(ArcadeRules):
    """The gate opens with the first launch, and closes with the second."""

    name = "locked"
    gate = "lock"

    def launched(self, config, state, tick, ball):
        state, events = super().launched(config, state, tick, ball)
        count = (state.memory or 0) + 1
        return state._replace(memory=count, open_gates=(self.gate,) if count == 1 else ()), events


def highest_after_launch(game: Game) -> float:
    game.step(ticks=SECOND, launch=True)
    highest = -10.0
    for _ in range(2 * SECOND):
        game.step()
        highest = max([highest, *(ball.position[0] for ball in game.world.balls)])
    return highest


def play() -> tuple[Game, float, float]:
    game = Game(TABLE, 3, rules=Locked())
    game.create_ball()
    first = highest_after_launch(game)
    game.step(ticks=3 * SECOND)  # the ball falls back onto the plunger
    return game, first, highest_after_launch(game)


def test_a_ball_passes_an_open_gate_and_not_a_closed_one():
    game, first, second = play()
    assert first > 2.0
    assert second < 0.0
    assert game.state.open_gates == ()


def test_a_game_with_gates_is_verified_by_its_replay():
    game, _, _ = play()
    assert Replay.from_text(game.replay.to_text()).verify(rules=Locked()).ok


@pytest.mark.parametrize("ticks", [100, SECOND + 20, SECOND + 200])
def test_a_saved_game_knows_its_gates(ticks):
    one = Game(TABLE, 3, rules=Locked())
    one.create_ball()
    for tick in range(ticks):
        one.step(launch=tick < SECOND)
    other = Game(TABLE, 3, rules=Locked())
    other.restore(one.save())
    assert other.state.open_gates == one.state.open_gates == (("lock",) if ticks > SECOND else ())
    for game in (one, other):
        game.step(ticks=500)
    assert one.digest() == other.digest()


def test_the_state_names_no_gates_while_all_are_closed():
    game = Game(TABLE, 3)
    assert "open_gates" not in json.loads(game.rules_text)


def test_rules_that_open_a_gate_that_is_not_there_are_told_which_ones_are():
    rules = Locked()
    rules.gate = "door"
    game = Game(TABLE, 3, rules=rules)
    game.create_ball()
    game.step(ticks=60, launch=True)
    with pytest.raises(SilverballError, match=r"'door'.*\['lock'\]"):
        game.step()
