"""The simple players: what they press, and that they play the same alone and in a batch."""

from __future__ import annotations

import itertools
import math

import pytest

from boards import PADDLES, full_table, launched, table_of
from silverball.errors import SilverballError
from silverball.players import make_player
from silverball.players.rollout import play
from silverball.players.simple import RANDOM_HOLD
from silverball.world import World, WorldBatch
from silverball.world.saved_world import digest

SIMPLE = ("idle", "random", "blind", "reflex", "hold")  # the planner has tests of its own


def test_the_idle_player_presses_nothing() -> None:
    world = launched(table_of(*PADDLES), (-6.5, 1.0, -3.0, 0.0))
    player = make_player("idle")
    for _ in range(100):
        assert player.press(world) == (False, False)
        world.step()


def test_the_random_player_holds_a_button_for_a_while_and_presses_half_of_the_time() -> None:
    world = World(table_of(*PADDLES), seed=4, tick_rate=60)
    player = make_player("random")
    pressed = []
    for _ in range(60 * 200):
        pressed.append(player.press(world))
        world.step()
    for side in (0, 1):
        held = [row[side] for row in pressed]
        # 200 s / 0.15 s = 1333 independent choices: half of them, give or take 5·√1333/2.
        share = sum(held) / len(held)
        assert abs(share - 0.5) < 5 * 0.5 / math.sqrt(200 / RANDOM_HOLD)
        changes = sum(a != b for a, b in itertools.pairwise(held))
        assert abs(changes - 667) < 5 * math.sqrt(1333) / 2
    both = sum(a == b for a, b in pressed) / len(pressed)
    assert abs(both - 0.5) < 5 * 0.5 / math.sqrt(200 / RANDOM_HOLD)


@pytest.mark.parametrize("tick_rate", [60, 240])
def test_the_random_player_presses_by_time_and_not_by_tick(tick_rate: int) -> None:
    world = World(table_of(*PADDLES), seed=4, tick_rate=tick_rate)
    player = make_player("random")
    halves = []
    for half in range(40):
        world.step(ticks=half * tick_rate // 2 + 3 - world.tick)
        halves.append(player.press(world))
    slow = World(table_of(*PADDLES), seed=4, tick_rate=10)
    for half in range(40):
        slow.step(ticks=half * 5 - slow.tick)
        if half * 0.5 % RANDOM_HOLD < 0.05:  # far from a change
            assert player.press(slow) == halves[half]


@pytest.mark.parametrize("side", [1, -1])
def test_the_reflex_player_lifts_the_paddle_that_a_ball_comes_down_on(side: int) -> None:
    # A ball falls onto the outer half of one paddle.
    world = launched(table_of(*PADDLES), (-5.0, side * -1.0, -4.0, 0.0))
    player = make_player("reflex")
    pressed = set()
    for _ in range(60):
        buttons = player.press(world)
        pressed.add(buttons)
        world.step(*buttons)
    assert pressed == {(False, False), (side == 1, side == -1)}
    assert world.balls[0].position[0] > -7.0


def test_the_reflex_player_loses_fewer_balls_than_the_idle_one() -> None:
    drained = {}
    for name in SIMPLE:
        batch = WorldBatch(full_table(), count=32, seed=1, tick_rate=60)
        drained[name] = play(batch, name, 60.0, balls=1).drained
    assert drained["reflex"] < drained["idle"]


@pytest.mark.parametrize("name", SIMPLE)
def test_a_player_alone_plays_the_same_game_as_in_the_compiled_loop(name: str) -> None:
    batch = WorldBatch(full_table(), count=3, seed=6, tick_rate=60)
    play(batch, name, 20.0, balls=2)
    player = make_player(name)
    for index in range(3):
        world = World(full_table(), seed=6 + index, tick_rate=60)
        for _ in range(1200):
            if len(world.balls) < 2:
                world.create_ball()
            world.step(*player.press(world))
        assert world.digest() == digest(batch.state[index])


def test_the_totals_of_a_rollout_add_up() -> None:
    batch = WorldBatch("random", count=6, seed=1, tick_rate=60)
    progress: list[float] = []
    played = play(batch, "reflex", 50.0, balls=2, audit=True, progress=progress.append)
    state = batch.state
    assert played.seconds == 50.0
    assert progress[-1] == 50.0
    assert played.created == state["created"].sum() > 0
    assert played.drained == state["drained"].sum()
    assert played.score == state["score"].sum()
    names = ("wall_hits", "slant_wall_hits", "paddle_hits", "triangular_prism_hits", "cylinder_hits")
    assert sum(played.hits.values()) == sum(state[name].sum() for name in names)
    assert played.faults == 0
    assert played.deepest <= 1e-9
    assert math.isnan(play(batch, "idle", 1.0).deepest)


def test_an_unknown_player_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(SilverballError, match="reflex"):
        make_player("reflexx")
    with pytest.raises(SilverballError, match="idle, random, blind, reflex, hold, planner, trained"):
        make_player("no-such-player")
