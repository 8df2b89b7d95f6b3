"""Nudges in games: recorded, verified, saved in flight, tilting, and the same in a batch."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from device_boards import everything, table_with
from silverball.errors import SilverballError
from silverball.game.game import Game
from silverball.game.game_batch import GameBatch
from silverball.game.replay.format import Replay
from silverball.game.view import GameEventKind
from silverball.table.kinds import SlantWall

TABLE = everything().replace(board={"nudge": 5.0})
TURNS = ("left", "right", "up")


def nudged(ticks: int = 600) -> Game:
    """A game with a nudge a second, each in another direction."""
    game = Game(TABLE, seed=3)
    for tick in range(ticks):
        if not game.world.balls and not game.is_over:
            game.create_ball()
        if tick % 240 == 100:
            assert game.nudge(TURNS[tick // 240 % 3])
        game.step(left=tick % 50 < 20, right=tick % 70 < 20, launch=tick % 90 < 40)
    return game


def test_the_nudges_of_a_game_are_recorded_and_verified() -> None:
    replay = nudged(800).replay
    lines = [line.partition(" ")[2] for line in replay.lines]
    assert "(" in lines[0]
    assert ")" in lines[1]
    assert "!" in lines[2]
    read = Replay.from_text(replay.to_text())
    assert read.verify().ok


@pytest.mark.parametrize(("one", "other"), [("(", ")"), (")", "("), ("(", "!"), ("!", ")")])
def test_a_nudge_in_another_direction_is_a_forgery(one: str, other: str) -> None:
    replay = nudged(800).replay
    lines = tuple(line.replace(one, other) for line in replay.lines)
    assert lines != replay.lines
    assert not dataclasses.replace(replay, lines=lines).verify().ok


def test_a_nudge_is_refused_on_a_table_without_one() -> None:
    game = Game(everything(), seed=3)
    game.create_ball()
    game.step(ticks=10)
    assert game.nudge("left")  # there it is the jitter
    game.step(ticks=230)
    replay = game.replay
    assert "!" in replay.lines[0]
    forged = dataclasses.replace(replay, lines=tuple(line.replace("!", "(") for line in replay.lines))
    verdict = forged.verify()
    assert not verdict.ok
    assert "cannot be nudged" in verdict.message


def test_a_game_can_be_saved_between_a_nudge_and_its_tick() -> None:
    game, other = nudged(120), Game(TABLE, seed=3)
    assert game.nudge("right")
    other.restore(game.save())
    assert other.digest() == game.digest()
    for one in (game, other):
        one.step(ticks=60)
    assert other.digest() == game.digest()
    assert game.world.cabinet[1] != 0.0


def test_the_table_is_nudged_once_a_tick_and_not_without_a_ball() -> None:
    game = Game(TABLE)
    with pytest.raises(SilverballError, match="there is no ball to shove"):
        game.nudge("up")
    game.create_ball()
    assert game.nudge("up")
    assert not game.nudge("left")
    game.step()
    assert game.nudge("left")
    with pytest.raises(ValueError, match="direction must be left, right, up, got 'down'"):
        game.nudge("down")


def test_jitter_nudges_up_where_there_is_a_nudge() -> None:
    game = Game(TABLE)
    game.create_ball()
    assert game.jitter()
    game.step(ticks=10)
    assert game.world.cabinet[0] > 0.0
    assert game.world.cabinet[1] == 0.0
    assert game.world.records[0]["draws"] == Game(TABLE).world.records[0]["draws"]  # nothing random


def test_quick_nudges_tilt_and_a_tilted_table_is_not_nudged() -> None:
    game = Game(TABLE)
    game.create_ball()
    done = []
    for direction in TURNS:
        done.append(game.nudge(direction))
        game.step(ticks=10)
    kinds = [event.kind for event in game.take_game_events()]
    assert done == [True] * 3
    assert GameEventKind.WARNING in kinds
    assert GameEventKind.TILT in kinds
    assert not game.nudge("left")
    draining = game.world.cabinet
    game.step()
    assert game.world.cabinet != draining  # it still swings


def test_a_batch_of_games_is_nudged_as_single_games_are() -> None:
    count, ticks = 4, 900
    rng = np.random.default_rng(2)
    actions = rng.random((ticks, count, 7)) < (0.3, 0.3, 0.003, 0.6, 0.003, 0.003, 0.003)
    actions[:, :, 4:] &= (np.cumsum(actions[:, :, 4:], axis=2) == 1) & ~actions[:, :, 2:3]
    batch = GameBatch(TABLE, count=count, seed=11)
    batch.step(actions, ticks=ticks)
    for row in range(count):
        game = Game(TABLE, seed=11 + row)
        for left, right, jitter, launch, *nudges in actions[:, row].tolist():
            if game.is_over:
                break
            if not game.view.on_board and not game._keeper.has_waiting:
                game.create_ball()
            game.step(ticks=0)
            pressed = [name for name, is_nudged in zip(TURNS, nudges, strict=True) if is_nudged]
            if (jitter or pressed) and game.world.balls:
                game._press(left, right, game.tick)
                game._press_launch(launch)
                game.nudge(pressed[0] if pressed else "up")
            game.step(left, right, launch=launch)
        assert game.world.digest() == batch.digests()[row]
        assert game.score == batch.games["score"][row]


def test_the_machine_shoves_a_ball_that_lies_still_as_ever() -> None:
    pocket = (SlantWall(start=(4.0, -1.0), end=(3.0, 0.0)), SlantWall(start=(3.0, 0.0), end=(4.0, 1.0)))
    table = table_with(*pocket, nudge=5.0).replace(arcade={"un_stick": 1.0})
    game = Game(table)
    game.create_ball()
    ball = game.world.records[0]["ball"][0]
    ball["x"], ball["z"] = 3.6, 0.0
    while not any(event.kind is GameEventKind.UNSTUCK for event in game.take_game_events()):
        draws = int(game.world.records[0]["draws"])
        assert game.tick < 20 * 240
        game.step()
    game.step()
    assert game.world.records[0]["draws"] == draws + 1  # a random direction: the jitter
    assert game.world.cabinet == (0.0, 0.0)
