"""The planner: it looks ahead, knows only what a copy of the world shows, and works within bounds."""

from __future__ import annotations

import pytest

from boards import full_table, launched, table_of
from silverball.metrics.ball_time import time_balls
from silverball.players import make_player
from silverball.players.planner import Planner, PlannerState, plan_batch, ticks_per_decision
from silverball.players.rollout import play
from silverball.world import World, WorldBatch
from silverball.world.saved_world import digest

FEW = 12  # branches: enough to play, and quick


def game(seed: int, ticks: int, planner: Planner, world: World | None = None) -> list[tuple[bool, bool]]:
    """A planner's presses on a random board with one ball after the other."""
    world = world or World("random", seed=seed)
    pressed = []
    for _ in range(ticks):
        if not world.balls:
            world.create_ball()
        pressed.append(planner.press(world))
        world.step(*pressed[-1])
    return pressed


def test_the_same_game_is_played_again_to_the_last_bit() -> None:
    worlds = [World("random", seed=3) for _ in range(2)]
    first, second = (game(3, 1500, Planner(FEW), world) for world in worlds)
    assert first == second
    assert worlds[0].digest() == worlds[1].digest()
    assert len(set(first)) > 1
    assert worlds[0].score > 0


def test_the_presses_of_a_game_played_without_the_planner_lead_to_the_same_world() -> None:
    world, again = World("random", seed=5), World("random", seed=5)
    for pressed in game(5, 1500, Planner(FEW), world):
        if not again.balls:
            again.create_ball()
        again.step(*pressed)
    assert again.digest() == world.digest()


def test_planning_does_not_change_the_world_by_a_bit() -> None:
    world, planner = World("random", seed=2), Planner(FEW)
    world.create_ball()
    for _ in range(300):
        before, hits, events = world.digest(), world.hits, world.events
        buttons = planner.press(world)
        assert (world.digest(), world.hits, world.events) == (before, hits, events)
        world.step(*buttons)
    assert int(planner.state.memories["moves"][0]) > FEW


def test_planning_does_not_change_a_batch_by_a_bit() -> None:
    batch = WorldBatch("random", count=3, seed=4, tick_rate=60)
    batch.create_balls()
    state = PlannerState.of(batch.state, batch.tallies.shape[1], FEW)
    before, tallies = batch.digests(), batch.tallies.copy()
    plan_batch(batch, state)
    assert batch.digests() == before
    assert (batch.tallies == tallies).all()
    assert (state.memories["tried"] == FEW).all()


@pytest.mark.parametrize("branches", [4, 9, 30])
def test_the_cost_of_a_decision_is_bounded_by_its_branches_and_their_moves(branches: int) -> None:
    world, planner = World("random", seed=8), Planner(branches)
    world.create_ball()
    longest = 0
    for _ in range(240):
        buttons = planner.press(world)
        memory = planner.state.memories[0]
        assert memory["tried"] == (branches if world.balls else 0)
        longest = max(longest, int(memory["moves"]))
        world.step(*buttons)
    # A branch takes at most a step for every step of its ten seconds, and so do the two scouts.
    assert branches < longest <= 600 * (branches + 2)


def test_a_decision_stops_at_its_limit_of_moves() -> None:
    world, planner = World("random", seed=8), Planner(10**6)
    world.create_ball()
    planner.press(world)
    memory = planner.state.memories[0]
    assert memory["tried"] < 10**5
    assert memory["move_limit"] <= memory["moves"] < memory["move_limit"] + 600


def test_it_decides_sixty_times_a_second_and_holds_its_buttons_in_between() -> None:
    assert [ticks_per_decision(rate) for rate in (10, 60, 120, 240, 1000)] == [1, 1, 2, 4, 17]
    pressed = game(1, 1200, Planner(FEW))
    changes = {tick % 4 for tick in range(1, 1200) if pressed[tick] != pressed[tick - 1]}
    assert changes == {0}


def test_a_restored_world_is_played_without_the_old_plan() -> None:
    world, planner = World("random", seed=6), Planner(FEW)
    state = world.save()
    game(6, 900, planner, world)
    world.restore(state)
    again = game(6, 900, planner, world)
    assert again == game(6, 900, Planner(FEW))


def test_it_does_not_know_the_random_numbers_that_the_world_will_draw() -> None:
    one, other = World("random", seed=9), World("random", seed=9)
    for world in (one, other):
        world.create_ball()
    other.records[0]["draws"] += 1000  # another future of shoves and new balls
    planners = Planner(FEW), Planner(FEW)
    for _ in range(480):
        buttons = planners[0].press(one)
        assert planners[1].press(other) == buttons
        one.step(*buttons)
        other.step(*buttons)
    assert one.digest() != other.digest()
    assert one.balls == other.balls != ()


def test_without_a_ball_it_presses_nothing() -> None:
    world, planner = World("classic"), Planner(FEW)
    assert {planner.press(world) for _ in range(3)} == {(False, False)}
    assert planner.state.memories["tried"][0] == 0


FALLING = ((-4.0, 0.45, -9.0, -2.0), (-4.0, 1.6, -9.0, 2.0), (-2.0, 0.8, -6.0, 2.0), (-1.0, 0.45, -12.0, 0.0))


@pytest.mark.parametrize("side", [1, -1])
def test_it_saves_balls_that_the_reflex_player_loses(side: int) -> None:
    lost = {"reflex": 0, "planner": 0}
    for x, z, vx, vz in FALLING:
        for name in lost:
            world = launched(full_table(), (x, side * z, vx, side * vz))
            player = Planner(30) if name == "planner" else make_player(name)
            for _ in range(480):
                world.step(*player.press(world))
            lost[name] += world.drained
    assert lost["planner"] == 0
    assert lost["reflex"] > 0


def test_it_makes_points_instead_of_holding_a_ball() -> None:
    world, planner = launched(full_table(), (-6.9, -1.2, 0.0, 0.0)), Planner(30)
    for _ in range(4 * 240):
        world.step(*planner.press(world))
    assert world.score > 0
    assert world.drained == 0


def test_two_balls_at_once_are_both_played() -> None:
    world, planner = launched(full_table(), (-5.0, 1.2, -6.0, 0.0), (-4.0, -1.2, -6.0, 0.0)), Planner(30)
    pressed = set()
    for _ in range(480):
        buttons = planner.press(world)
        pressed |= {side for side in (0, 1) if buttons[side]}
        world.step(*buttons)
    assert pressed == {0, 1}
    assert world.drained == 0


def test_it_accepts_a_board_without_paddles() -> None:
    world, planner = launched(table_of(), (0.0, 0.0, 0.0, 0.0)), Planner(FEW)
    for _ in range(480):
        world.step(*planner.press(world))
    assert world.drained == 1


def test_it_plays_alone_what_it_plays_in_a_batch() -> None:
    batch = WorldBatch(full_table(), count=2, seed=6, tick_rate=120)
    play(batch, "planner", 3.0, balls=2)
    for index in range(2):
        world, player = World(full_table(), seed=6 + index, tick_rate=120), make_player("planner")
        for _ in range(360):
            if len(world.balls) < 2:
                world.create_ball()
            world.step(*player.press(world))
        assert world.digest() == digest(batch.state[index])


def test_balls_live_longer_than_under_the_reflex_player() -> None:
    ends = {}
    for kind in ("reflex", "planner"):
        batch = WorldBatch("random", count=8, seed=20, tick_rate=60)
        ends[kind] = time_balls(batch, kind, 30.0, branches=FEW)
    reflex, planner = ends["reflex"], ends["planner"]
    assert planner.drained + planner.stalled < reflex.drained + reflex.stalled
    assert planner.mean[0] > reflex.mean[0]
