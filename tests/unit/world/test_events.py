"""`World.events` and `WorldBatch.events`: a loop that reads after each step sees every event exactly once."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest

import silverball as sb
from boards import full_table
from silverball.errors import BoardFull
from silverball.physics.records import LOG_SIZE

BUTTONS = np.random.default_rng(1).random((60, 3)) < [0.4, 0.4, 0.1]


def key(event: sb.Event) -> tuple[str, int, int, float]:
    return event.kind, event.ball, event.tick, event.offset


def play(world: sb.World, ticks: list[int], create_before: bool, create_after: bool) -> list[sb.Event]:
    """Play steps of these lengths [ticks]; the events as a loop that reads after each step sees them."""
    seen: list[sb.Event] = []
    for number, count in enumerate(ticks):
        if create_before and number % 3 == 0:
            create(world)
        world.step(*BUTTONS[number % len(BUTTONS)].tolist(), ticks=count)
        assert world.events_lost == 0
        seen += world.events
        if create_after and number % 5 == 0:
            create(world)
    return seen


def create(world: sb.World) -> None:
    with contextlib.suppress(BoardFull):
        world.create_ball()


@pytest.mark.parametrize("create_before", [True, False])
@pytest.mark.parametrize("create_after", [True, False])
@pytest.mark.parametrize("ticks", [[1] * 1500, [7] * 200, [1, 0, 0, 3, 40] * 60])
def test_each_event_of_a_game_is_seen_exactly_once(
    ticks: list[int], create_before: bool, create_after: bool
) -> None:
    world = sb.World(full_table(), seed=3)
    seen = play(world, ticks, create_before, create_after)
    kinds = [event.kind for event in seen]
    assert len({key(event) for event in seen}) == len(seen)
    pending = len(world.balls) - (
        kinds.count("created") - kinds.count("gutter")
    )  # created after the last step
    assert pending in (0, 1, 2)
    assert kinds.count("created") == world.created - pending
    assert kinds.count("gutter") == world.drained
    assert kinds.count("hit") == sum(world.hits.values())
    assert [event.ball for event in seen if event.kind == "created"] == list(
        range(1, world.created - pending + 1)
    )
    assert [event.tick for event in seen] == sorted(event.tick for event in seen)
    assert bool(seen) == (create_before or create_after)


def test_a_ball_created_after_a_step_is_seen_at_once_and_after_the_next_step_but_not_later() -> None:
    world = sb.World("classic", seed=1)
    world.step()
    assert world.events == ()
    world.create_ball()
    first = world.events
    assert [event.kind for event in first] == ["created"]
    world.step(ticks=0)
    assert world.events == first
    world.step(ticks=0)
    assert world.events == ()


def test_two_balls_created_between_two_steps_are_both_seen() -> None:
    world = sb.World("classic", seed=1)
    world.create_ball()
    world.create_ball()
    world.step(jitter=True)
    assert [(event.kind, event.ball) for event in world.events] == [
        ("created", 1), ("created", 2), ("jitter", 1), ("jitter", 2),
    ]  # fmt: skip


def test_a_restored_world_has_no_events() -> None:
    world = sb.World("classic", seed=1)
    world.step()
    state = world.save()
    world.create_ball()
    world.restore(state)
    assert world.events == ()
    world.step()
    assert world.events == ()
    batch = sb.WorldBatch("classic", 2)
    saved = batch.save(0)
    batch.create_balls()
    batch.restore(saved, 0)
    batch.step(np.zeros((2, 3), bool))
    assert batch.events(0) == ()
    assert [event.kind for event in batch.events(1)] == ["created"]


def test_created_balls_take_no_room_from_the_events_of_a_step() -> None:
    counts = []
    for balls in (0, 2):
        world = sb.World(full_table(), seed=5)
        other = sb.World(full_table(), seed=5)
        for one in (world, other):
            one.create_ball()
            one.create_ball()
        other.step(ticks=0)
        if balls == 0:
            other.step(ticks=0)  # now the creations are gone from the log
        other.step(ticks=40_000)
        counts.append((len(other.events), other.events_lost))
        assert other.events_lost > 0
    assert counts[0] == counts[1]
    assert counts[0][0] <= LOG_SIZE


def test_balls_are_seen_even_if_the_log_of_the_step_before_was_full() -> None:
    world = sb.World(full_table(), seed=5)
    world.create_ball()
    world.step(ticks=0)
    while not world.events_lost or len(world.balls) > 1:
        if not world.balls:
            world.create_ball()
        world.step(ticks=4_000)
    before = world.created
    create(world)
    world.step(ticks=0)
    assert [event.kind for event in world.events] == ["created"] * (world.created - before)
    assert world.created > before


def test_a_batch_shows_the_events_of_each_of_its_worlds() -> None:
    batch = sb.WorldBatch("random", 4, seed=9)
    worlds = [sb.World("random", seed=9 + index) for index in range(4)]
    total = 0
    for number in range(40):
        if number % 7 == 0:
            batch.create_balls()
            for world in worlds:
                create(world)
        held = np.tile(BUTTONS[number], (4, 1))
        batch.step(held, ticks=12)
        for index, world in enumerate(worlds):
            world.step(*BUTTONS[number].tolist(), ticks=12)
            assert batch.events(index) == world.events == batch.events(index - 4)
            total += len(world.events)
    assert total > 20


@pytest.mark.parametrize("index", [4, -5])
def test_a_world_that_is_not_there_has_no_events(index: int) -> None:
    with pytest.raises(ValueError, match=r"index -?\d is out of range: there are 4 worlds"):
        sb.WorldBatch("classic", 4).events(index)


def test_by_default_world_i_of_a_batch_is_the_single_world_of_its_seed() -> None:
    batch = sb.WorldBatch("random", 3, seed=20)
    batch.create_balls()
    batch.step(np.tile([True, False, False], (3, 1)), ticks=300)
    for index, digest in enumerate(batch.digests()):
        world = sb.World("random", seed=20 + index)
        world.create_ball()
        world.step(left=True, ticks=300)
        assert world.tick_rate == batch.tick_rate
        assert world.digest() == digest
