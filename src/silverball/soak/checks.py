"""What does a soak look at after every tick?

With nothing of the solver's own geometry: is a ball off the board, or on another ground than it was created
on (`regions.py`)? Is it inside anything, and was it at every contact just at the surface (`audit.py`)? Did it
get through something on the way although no contact was reported? Has it stayed in one place for a minute?
The first finding stops a world.
"""

from __future__ import annotations

from enum import IntEnum
from math import hypot, sqrt
from typing import Any, NamedTuple

import numpy as np

from silverball.physics.audit import (
    depth_in_borders,
    depth_in_each_other,
    depth_in_paddle,
    depth_in_standing,
    gap_to,
    is_out_of_reach,
    turned_for,
)
from silverball.physics.kernel import kernel
from silverball.physics.records import BALL_COUNT, EventKind, Fault, Lane, Part, Playfield
from silverball.physics.step import step_world
from silverball.soak.driver import act, choose
from silverball.soak.regions import BLOCKED, MAIN_GROUND, OFF_BOARD, ground_of, is_narrow, mark_at

DEPTH = 1e-9  # [u] deeper is a penetration
STUCK_RADIUS = 0.3  # [u] a ball that does not get further than this from a place …
STUCK_AFTER = 60.0  # [s] … for longer than this is stuck, unless it was counted as jammed meanwhile
SAMPLE = 0.05  # [u] between two places of a way that are looked at
PASSED = 1e-6  # [u] deeper, on the way, is a passage
GUTTER_MARGIN = 1e-9  # [u] for the rounding of the moment at which a ball is gone
"""Source of all these: chosen."""


class Found(IntEnum):
    """What a soak can find."""

    NOTHING = 0
    ESCAPE = 1  # a ball where it cannot have got to
    PENETRATION = 2  # a ball deeper than DEPTH inside something
    PASSAGE = 3  # a ball that got through something without a contact
    PHANTOM = 4  # a contact with nothing
    FAULT = 5  # the world has stopped by itself
    STUCK = 6  # a ball in one place for too long


class Was(NamedTuple):
    """A ball before a tick: its id and its centre [u]."""

    id: int
    x: float
    z: float


HAUNT = np.dtype(
    [
        ("id", "i8"),  # the ball's; 0: none
        ("ground", "i8"),  # the number of the ground it was created on
        ("x", "f8"), ("z", "f8"), ("since", "i8"), ("jams", "i8"),  # the place it has not left since a tick
    ],
    align=True,
)  # fmt: skip

WATCH = np.dtype(
    [
        ("haunt", HAUNT, (BALL_COUNT,)),
        ("frames", "i8"),  # ticks watched
        ("deepest", "f8"),  # [u]
        ("found", "i8"),  # Found
        ("slot", "i8"), ("since", "i8"),  # of the finding: the ball, the tick at which it may have begun
        ("depth", "f8"),  # of the finding, where it has one [u]
    ],
    align=True,
)  # fmt: skip


@kernel
def settle(world: Any, site: Any, marks: Any, watch: Any, hostile: bool) -> None:
    """Note where new balls start. On a board that was checked, that can only be the ground of the gutter."""
    for slot in range(BALL_COUNT):
        ball, haunt = world.ball[slot], watch.haunt[slot]
        if ball.id != haunt.id:
            haunt.id, haunt.x, haunt.z = ball.id, ball.x, ball.z
            haunt.since, haunt.jams = world.tick, world.jams
            haunt.ground = MAIN_GROUND
            if hostile:
                haunt.ground = ground_of(mark_at(site, marks, ball.x, ball.z))


@kernel
def note(world: Any, watch: Any, found: int, slot: int, since: int, depth: float) -> None:
    """Write a finding down, if it is the first of its world."""
    if watch.found == Found.NOTHING:
        watch.found, watch.slot, watch.since, watch.depth = found, slot, since, depth


@kernel
def look_at_places(world: Any, board: Any, colliders: Any, site: Any, marks: Any, watch: Any) -> None:
    """Is a ball where it cannot be, or inside anything?"""
    first, now = board.collider_first, world.tick
    for slot in range(BALL_COUNT):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        mark = mark_at(site, marks, ball.x, ball.z)
        ground = ground_of(mark)
        if mark == OFF_BOARD or ball.x < board.gutter - GUTTER_MARGIN:
            note(world, watch, Found.ESCAPE + 0, slot, now, 0.0)
            continue
        if ground != BLOCKED and ground != watch.haunt[slot].ground:
            note(world, watch, Found.ESCAPE + 0, slot, now, 0.0)
        depth = depth_in_borders(board, colliders, ball.x, ball.z)
        if is_narrow(mark):
            depth = max(depth, depth_in_standing(board, colliders, ball.x, ball.z))
        for side in range(2):
            c = colliders[first + Part.LEFT_PADDLE + side]
            inside = depth_in_paddle(c, world.paddle[side].angle, ball.x, ball.z, board.ball_radius)
            depth = max(depth, inside)
        if slot == 0:
            depth = max(depth, depth_in_each_other(world, board.ball_radius))
        watch.deepest = max(watch.deepest, depth)
        if depth > DEPTH:
            note(world, watch, Found.PENETRATION + 0, slot, now, depth)


@kernel
def look_at_contacts(
    world: Any, board: Any, colliders: Any, log: Any, watch: Any, before: Any, tick: float
) -> None:
    """Was every ball at the surface of the part that it met, neither inside nor away from it?"""
    if log.lost > 0:
        return
    for number in range(log.count):
        if log.event[number].kind == EventKind.JAM:  # then paddles may have stalled: nobody knows where
            return
    for number in range(log.count):
        event = log.event[number]
        if event.kind not in (EventKind.HIT, EventKind.TOUCH):
            continue
        c = colliders[board.collider_first + event.part]
        side = 1 if event.part == Part.RIGHT_PADDLE else 0
        angle = turned_for(c, before[side], world.paddle[side].angle, event.offset)
        gap = gap_to(c, event.part, angle, event.x, event.z) - board.ball_radius
        slot = 0 if event.ball == watch.haunt[0].id else 1
        watch.deepest = max(watch.deepest, -gap)
        if -gap > DEPTH:
            note(world, watch, Found.PENETRATION + 0, slot, world.tick - 1, -gap)
        elif gap > DEPTH:
            note(world, watch, Found.PHANTOM + 0, slot, world.tick - 1, -gap)


@kernel
def is_untouched(log: Any, ball: int) -> bool:
    """Whether a ball met nothing in the last tick, by the log."""
    if log.lost > 0:
        return False
    for number in range(log.count):
        event = log.event[number]
        if event.kind in (EventKind.BALL_HIT, EventKind.BALL_TOUCH, EventKind.JAM):
            return False
        if event.ball == ball and event.kind in (EventKind.HIT, EventKind.TOUCH):
            return False
    return True


@kernel
def greatest_sag(board: Any, tick: float) -> float:
    """How far a flight can be from the straight line between its ends, a tick [s] apart [u].

    At most a quarter of the tick times all that the velocity changes by on the way: by gravity, by friction,
    and, where a slipping ball begins to roll, by what gravity does in a tick once more.
    """
    pull = sqrt(board.pull_x * board.pull_x + board.pull_z * board.pull_z)
    changes: float = tick * (2.0 * pull + board.friction * board.press)
    return 0.25 * tick * changes


@kernel
def depth_on_the_way(
    board: Any, colliders: Any, site: Any, marks: Any, was: Was, ball: Any, before: Any, after: Any,
    tick: float,
) -> float:  # fmt: skip
    """How deep a ball was inside something at a place on the straight way from `was` to where it is now [u].

    The paddles are on their way from the angles `before` to `after` [rad] meanwhile.
    """
    radius, paddles = board.ball_radius, board.collider_first + Part.LEFT_PADDLE
    dx, dz = ball.x - was.x, ball.z - was.z
    way = hypot(dx, dz)
    swept, at_paddle = way, False
    for side in range(2):
        c = colliders[paddles + side]
        if not is_out_of_reach(c, ball.x, ball.z, radius + way):
            at_paddle = True
            swept = max(swept, way + abs(after[side] - before[side]) * hypot(ball.x - c.x, ball.z - c.z))
    count = int(swept / SAMPLE) + 1
    depth = 0.0
    for number in range(1, count):
        share = number / count
        x, z = was.x + share * dx, was.z + share * dz
        if is_narrow(mark_at(site, marks, x, z)):
            depth = max(depth, depth_in_standing(board, colliders, x, z))
        if at_paddle:
            for side in range(2):
                c = colliders[paddles + side]
                angle = turned_for(c, before[side], after[side], share * tick)
                depth = max(depth, depth_in_paddle(c, angle, x, z, radius))
    return depth


@kernel
def depth_of_meeting(was_a: Was, a: Any, was_b: Was, b: Any, radius: float) -> float:
    """How deep two balls were inside each other on their ways [u]; straight, and so is the relative way."""
    x, z = was_b.x - was_a.x, was_b.z - was_a.z
    dx, dz = b.x - a.x - x, b.z - a.z - z
    square = dx * dx + dz * dz
    share = min(max(-(x * dx + z * dz) / square, 0.0), 1.0) if square > 0.0 else 0.0
    return 2.0 * radius - hypot(x + share * dx, z + share * dz)


@kernel
def look_at_ways(
    world: Any, board: Any, colliders: Any, site: Any, marks: Any, log: Any, watch: Any,
    was_a: Was, was_b: Was, before: Any, tick: float,
) -> None:  # fmt: skip
    """Did a ball get through something without a contact? The sag of its way may only seem to be in it."""
    a, b = world.ball[0], world.ball[1]
    after = (world.paddle[0].angle, world.paddle[1].angle)
    sag = greatest_sag(board, tick) + PASSED
    free_a = a.id != 0 and a.id == was_a.id and is_untouched(log, a.id)
    free_b = b.id != 0 and b.id == was_b.id and is_untouched(log, b.id)
    if free_a:
        depth = depth_on_the_way(board, colliders, site, marks, was_a, a, before, after, tick)
        if depth > sag:
            note(world, watch, Found.PASSAGE + 0, 0, world.tick - 1, depth)
    if free_b:
        depth = depth_on_the_way(board, colliders, site, marks, was_b, b, before, after, tick)
        if depth > sag:
            note(world, watch, Found.PASSAGE + 0, 1, world.tick - 1, depth)
    if free_a and free_b:
        depth = depth_of_meeting(was_a, a, was_b, b, board.ball_radius)
        if depth > 2.0 * sag:
            note(world, watch, Found.PASSAGE + 0, 0, world.tick - 1, depth)


@kernel
def look_at_haunts(world: Any, watch: Any, tick: float) -> None:
    """Has a ball been in one place for too long, and nobody has called it jammed?"""
    for slot in range(BALL_COUNT):
        ball, haunt = world.ball[slot], watch.haunt[slot]
        if ball.id == 0:
            continue
        away = (ball.x - haunt.x) ** 2 + (ball.z - haunt.z) ** 2 > STUCK_RADIUS * STUCK_RADIUS
        if away or world.jams != haunt.jams:
            haunt.x, haunt.z, haunt.since, haunt.jams = ball.x, ball.z, world.tick, world.jams
        elif (world.tick - haunt.since) * tick > STUCK_AFTER:
            note(world, watch, Found.STUCK + 0, slot, haunt.since, 0.0)


@kernel
def watched_tick(
    world: Any, board: Any, colliders: Any, grid: Any, places: Any, log: Any, tally: Any,
    true_board: Any, true_colliders: Any, site: Any, marks: Any, watch: Any, action: Any,
    tick: float, hostile: bool,
) -> None:  # fmt: skip
    """Do what the action says, move the world on by one tick, and look at it.

    Args:
        world: A WORLD record; with its BOARD and all COLLIDER records, grids, places, LOG and tally as in
            `play_worlds`.
        true_board, true_colliders: The same table, compiled for the watch alone.
        site, marks: The board's map (see `ground.Grounds`).
        watch: A WATCH record.
        action: An ACTION record.
        tick: Length of a tick [s].
        hostile: Whether the board was not checked: then a ball may start on any ground and get stuck.
    """
    act(world, board, colliders, places, log, action)
    settle(world, site, marks, watch, hostile)
    a, b = world.ball[0], world.ball[1]
    was_a, was_b = Was(a.id, a.x, a.z), Was(b.id, b.x, b.z)
    before = (world.paddle[0].angle, world.paddle[1].angle)
    left, right, shove = action.left != 0, action.right != 0, action.shove != 0
    step_world(Lane(world, log, tally), Playfield(board, colliders, grid), left, right, shove, tick)
    watch.frames += 1
    if world.fault != Fault.NONE:
        note(world, watch, Found.FAULT + 0, 0, world.tick, 0.0)
    look_at_places(world, true_board, true_colliders, site, marks, watch)
    if watch.found == Found.NOTHING:
        look_at_contacts(world, true_board, true_colliders, log, watch, before, tick)
        look_at_ways(world, true_board, true_colliders, site, marks, log, watch, was_a, was_b, before, tick)
    if not hostile and board.gravity > 0.0:  # where nothing pulls, a ball may stay for ever
        look_at_haunts(world, watch, tick)


@kernel
def soak_worlds(
    worlds: Any, boards: Any, board_of: Any, colliders: Any, grid: Any, places: Any, logs: Any,
    tallies: Any, true_boards: Any, true_colliders: Any, sites: Any, marks: Any, watches: Any,
    drivers: Any, actions: Any, wild: Any,
    first: int, end: int, ticks: int, tick: float, hostile: bool,
) -> None:  # fmt: skip
    """Soak the worlds first … end − 1 for a number of ticks; arguments as in `watched_tick`, for all worlds.

    A world with a finding stands still. `drivers` are DRIVER records, `wild` [world] says whether balls get
    random velocities.
    """
    for index in range(first, end):
        world, watch, action, number = worlds[index], watches[index], actions[index], board_of[index]
        for _ in range(ticks):
            if watch.found != Found.NOTHING:
                break
            choose(world, boards[number], drivers[index], action, tick, wild[index])
            watched_tick(
                world, boards[number], colliders, grid, places, logs[index], tallies[index],
                true_boards[number], true_colliders, sites[number], marks, watch, action, tick, hostile,
            )  # fmt: skip
