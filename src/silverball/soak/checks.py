"""Checks of the soak after every tick: places, contacts, tunnelling, faults, and balls that are stuck.

They do not use the solver's geometry. A ball must be on the board and in the region it was created in
(`regions.py`), inside nothing, and just at the surface at every contact (`audit.py`). It must not pass
through anything without a contact, nor stay in one place for a minute. The first finding stops a world.
"""

from __future__ import annotations

from enum import IntEnum
from math import hypot, sqrt
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from silverball.physics.audit import (
    angle_after,
    depth_in_borders,
    depth_in_other_ball,
    depth_in_paddle,
    depth_in_stationary,
    gap_to,
    is_out_of_reach,
)
from silverball.physics.kernel import as_int, kernel
from silverball.physics.records import (
    JITTER,
    BallRecord,
    BatchGeometry,
    BoardGeometry,
    BoardRecord,
    Colliders,
    EventKind,
    Fault,
    Lane,
    Lanes,
    LogRecord,
    Part,
    Places,
    WorldRecord,
)
from silverball.physics.step import button_bits, step_world
from silverball.soak.driver import WATCHED_BALLS, ActionRecord, Drivers, apply_action, choose_action
from silverball.soak.regions import (
    BLOCKED,
    MAIN_REGION,
    OFF_BOARD,
    GridHeaderRecord,
    is_narrow,
    label_at,
    region_of,
)

DEPTH = 1e-9  # [u] depth above which an overlap counts as a penetration
STUCK_RADIUS = 0.3  # [u] a ball that does not get further than this from a place …
STUCK_AFTER = 60.0  # [s] … for longer than this is stuck, unless it was counted as jammed meanwhile
SAMPLE = 0.05  # [u] between two checked places of a path
PASSAGE_DEPTH = 1e-6  # [u] overlap along the path above which the ball counts as having tunnelled
GUTTER_MARGIN = 1e-9  # [u] for the rounding of the moment at which a ball drains
"""All of these are judgement calls, not taken from a source."""


class Found(IntEnum):
    """What a soak can find."""

    NOTHING = 0
    ESCAPE = 1  # a ball at a place that it cannot reach
    PENETRATION = 2  # a ball deeper than DEPTH inside something
    PASSAGE = 3  # a ball that tunnelled: it passed through something without a contact
    PHANTOM = 4  # a contact with nothing
    FAULT = 5  # the solver has stopped the world with a fault
    STUCK = 6  # a ball in one place for too long


class PreviousBall(NamedTuple):
    """A ball before a tick: its id and its centre [u]."""

    id: int
    x: float
    z: float


class StateBefore(NamedTuple):
    """The balls and the paddles before a tick; angles of the left and right paddle [rad]."""

    a: PreviousBall
    b: PreviousBall
    angles: tuple[float, float]


STUCK_TRACKER = np.dtype(
    [
        ("id", "i8"),  # the ball's; 0: none
        ("region", "i8"),  # the number of the region it was created in
        ("x", "f8"), ("z", "f8"), ("since", "i8"), ("jams", "i8"),  # the place it has not left since a tick
    ],
    align=True,
)  # fmt: skip

WATCH = np.dtype(
    [
        ("tracker", STUCK_TRACKER, (WATCHED_BALLS,)),
        ("frames", "i8"),  # ticks watched
        ("deepest", "f8"),  # [u]
        ("found", "i8"),  # Found
        ("slot", "i8"), ("since", "i8"),  # of the finding: the ball, the tick at which it may have begun
        ("depth", "f8"),  # of the finding, where it has one [u]
    ],
    align=True,
)  # fmt: skip
WatchRecord: TypeAlias = Any  # a WATCH record


class ReferenceBoard(NamedTuple):
    """A table as the checks know it, compiled for them alone, apart from the board that the solver reads.

    Attributes:
        board: A BOARD record.
        colliders: COLLIDER records of all boards.
        header: The GRID_HEADER record of the board.
        labels: Labels of the cells of all boards.
        hostile: Whether the board was not checked: then a ball may start in any region, and get stuck.
    """

    board: BoardRecord
    colliders: Colliders
    header: GridHeaderRecord
    labels: Any
    hostile: bool


class Watches(NamedTuple):
    """What watches the worlds of a batch.

    Attributes:
        boards: BOARD records [board], compiled for the checks alone.
        colliders: COLLIDER records of all boards.
        headers: GRID_HEADER records [board].
        labels: Labels of the cells of all boards.
        states: WATCH records [world].
        hostile: Whether the boards were not checked.
    """

    boards: Any
    colliders: Colliders
    headers: Any
    labels: Any
    states: Any
    hostile: bool


@kernel
def register_new_balls(world: WorldRecord, truth: ReferenceBoard, watch: WatchRecord) -> None:
    """Record where new balls start. On a checked board, that can only be the region of the gutter."""
    for slot in range(WATCHED_BALLS):
        ball, tracker = world.ball[slot], watch.tracker[slot]
        if ball.id != tracker.id:
            tracker.id, tracker.x, tracker.z = ball.id, ball.x, ball.z
            tracker.since, tracker.jams = world.tick, world.jams
            tracker.region = MAIN_REGION
            if truth.hostile:
                tracker.region = region_of(label_at(truth.header, truth.labels, ball.x, ball.z))


@kernel
def report(world: WorldRecord, watch: WatchRecord, found: int, slot: int, since: int, depth: float) -> None:
    """Record a finding, if it is the first of its world."""
    if watch.found == Found.NOTHING:
        watch.found, watch.slot, watch.since, watch.depth = found, slot, since, depth


@kernel
def check_places(world: WorldRecord, truth: ReferenceBoard, watch: WatchRecord) -> None:
    """Check that every ball is at a possible place and not inside anything."""
    board, colliders, now = truth.board, truth.colliders, world.tick
    for slot in range(WATCHED_BALLS):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        label = label_at(truth.header, truth.labels, ball.x, ball.z)
        region = region_of(label)
        if label == OFF_BOARD or ball.x < board.gutter - GUTTER_MARGIN:
            report(world, watch, as_int(Found.ESCAPE), slot, now, 0.0)
            continue
        if region != BLOCKED and region != watch.tracker[slot].region:
            report(world, watch, as_int(Found.ESCAPE), slot, now, 0.0)
        depth = depth_in_borders(board, colliders, ball.x, ball.z)
        if is_narrow(label):
            depth = max(depth, depth_in_stationary(board, colliders, ball.x, ball.z))
        for side in range(2):
            c = colliders[board.collider_first + Part.LEFT_PADDLE + side]
            inside = depth_in_paddle(c, world.paddle[side].angle, ball.x, ball.z, board.ball_radius)
            depth = max(depth, inside)
        if slot == 0:
            depth = max(depth, depth_in_other_ball(world, board.ball_radius))
        watch.deepest = max(watch.deepest, depth)
        if depth > DEPTH:
            report(world, watch, as_int(Found.PENETRATION), slot, now, depth)


@kernel
def check_contacts(
    lane: Lane, truth: ReferenceBoard, watch: WatchRecord, before: StateBefore, tick: float
) -> None:
    """Check that every ball touched the surface of the part that it met."""
    world, log = lane.world, lane.log
    if log.lost > 0:
        return
    for number in range(log.count):
        if log.event[number].kind == EventKind.JAM:  # paddles may have stalled: their angles are unknown
            return
    for number in range(log.count):
        event = log.event[number]
        if event.kind not in (EventKind.HIT, EventKind.TOUCH):
            continue
        c = truth.colliders[truth.board.collider_first + event.part]
        side = 1 if event.part == Part.RIGHT_PADDLE else 0
        angle = angle_after(c, before.angles[side], world.paddle[side].angle, event.offset)
        gap = gap_to(c, event.part, angle, event.x, event.z) - truth.board.ball_radius
        slot = 0 if event.ball == watch.tracker[0].id else 1
        watch.deepest = max(watch.deepest, -gap)
        if -gap > DEPTH:
            report(world, watch, as_int(Found.PENETRATION), slot, world.tick - 1, -gap)
        elif gap > DEPTH:
            report(world, watch, as_int(Found.PHANTOM), slot, world.tick - 1, -gap)


@kernel
def is_untouched(log: LogRecord, ball: int) -> bool:
    """Whether a ball met nothing in the last tick, according to the log."""
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
def max_sagitta(board: BoardRecord, tick: float) -> float:
    """Upper bound [u] on how far a flight deviates from its chord over one tick [s].

    At most a quarter of the tick times everything that changes the velocity on the way: gravity, friction,
    and, where a slipping ball begins to roll, once more what gravity does in a tick.
    """
    pull = sqrt(board.accel_x * board.accel_x + board.accel_z * board.accel_z)
    changes: float = tick * (2.0 * pull + board.friction * board.normal_accel)
    return 0.25 * tick * changes


@kernel
def depth_along_path(
    truth: ReferenceBoard, previous: PreviousBall, ball: BallRecord, before: Any, after: Any, tick: float
) -> float:
    """How deep a ball was inside something on the straight path from `previous` to where it is now [u].

    Meanwhile the paddles turn from the angles `before` to `after` [rad].
    """
    board, colliders = truth.board, truth.colliders
    radius, paddles = board.ball_radius, board.collider_first + Part.LEFT_PADDLE
    dx, dz = ball.x - previous.x, ball.z - previous.z
    path = hypot(dx, dz)
    swept, at_paddle = path, False
    for side in range(2):
        c = colliders[paddles + side]
        if not is_out_of_reach(c, ball.x, ball.z, radius + path):
            at_paddle = True
            swept = max(swept, path + abs(after[side] - before[side]) * hypot(ball.x - c.x, ball.z - c.z))
    count = int(swept / SAMPLE) + 1
    depth = 0.0
    for number in range(1, count):
        share = number / count
        x, z = previous.x + share * dx, previous.z + share * dz
        if is_narrow(label_at(truth.header, truth.labels, x, z)):
            depth = max(depth, depth_in_stationary(board, colliders, x, z))
        if at_paddle:
            for side in range(2):
                c = colliders[paddles + side]
                angle = angle_after(c, before[side], after[side], share * tick)
                depth = max(depth, depth_in_paddle(c, angle, x, z, radius))
    return depth


@kernel
def depth_of_meeting(
    previous_a: PreviousBall, a: BallRecord, previous_b: PreviousBall, b: BallRecord, radius: float
) -> float:
    """How deep two balls were inside each other on their straight paths [u]."""
    x, z = previous_b.x - previous_a.x, previous_b.z - previous_a.z
    dx, dz = b.x - a.x - x, b.z - a.z - z
    square = dx * dx + dz * dz
    share = min(max(-(x * dx + z * dz) / square, 0.0), 1.0) if square > 0.0 else 0.0
    return 2.0 * radius - hypot(x + share * dx, z + share * dz)


@kernel
def check_tunnelling(
    lane: Lane, truth: ReferenceBoard, watch: WatchRecord, before: StateBefore, tick: float
) -> None:
    """Check that no ball tunnelled: passed through anything without a contact.

    The path is checked as a straight line, so a depth up to its sagitta is allowed.
    """
    world, log = lane.world, lane.log
    a, b = world.ball[0], world.ball[1]
    after = (world.paddle[0].angle, world.paddle[1].angle)
    allowed = max_sagitta(truth.board, tick) + PASSAGE_DEPTH
    free_a = a.id != 0 and a.id == before.a.id and is_untouched(log, a.id)
    free_b = b.id != 0 and b.id == before.b.id and is_untouched(log, b.id)
    if free_a:
        depth = depth_along_path(truth, before.a, a, before.angles, after, tick)
        if depth > allowed:
            report(world, watch, as_int(Found.PASSAGE), 0, world.tick - 1, depth)
    if free_b:
        depth = depth_along_path(truth, before.b, b, before.angles, after, tick)
        if depth > allowed:
            report(world, watch, as_int(Found.PASSAGE), 1, world.tick - 1, depth)
    if free_a and free_b:
        depth = depth_of_meeting(before.a, a, before.b, b, truth.board.ball_radius)
        if depth > 2.0 * allowed:
            report(world, watch, as_int(Found.PASSAGE), 0, world.tick - 1, depth)


@kernel
def check_stuck(world: WorldRecord, watch: WatchRecord, tick: float) -> None:
    """Check that no ball stays in one place for too long without a jam."""
    for slot in range(WATCHED_BALLS):
        ball, tracker = world.ball[slot], watch.tracker[slot]
        if ball.id == 0:
            continue
        away = (ball.x - tracker.x) ** 2 + (ball.z - tracker.z) ** 2 > STUCK_RADIUS * STUCK_RADIUS
        if away or world.jams != tracker.jams:
            tracker.x, tracker.z, tracker.since, tracker.jams = ball.x, ball.z, world.tick, world.jams
        elif (world.tick - tracker.since) * tick > STUCK_AFTER:
            report(world, watch, as_int(Found.STUCK), slot, tracker.since, 0.0)


@kernel
def watched_tick(
    lane: Lane,
    geometry: BoardGeometry,
    places: Places,
    truth: ReferenceBoard,
    watch: WatchRecord,
    action: ActionRecord,
    tick: float,
) -> None:
    """Apply an action, advance the world by one tick, and check it.

    Args:
        lane: The world.
        geometry: The board that the solver reads.
        places: The squares of all boards in which balls are created.
        truth: The same table, compiled for the checks alone.
        watch: A WATCH record.
        action: An ACTION record.
        tick: Length of a tick [s].
    """
    world = lane.world
    apply_action(world, geometry.board, geometry.colliders, places, lane.log, action)
    register_new_balls(world, truth, watch)
    a, b = world.ball[0], world.ball[1]
    before = StateBefore(
        PreviousBall(a.id, a.x, a.z),
        PreviousBall(b.id, b.x, b.z),
        (world.paddle[0].angle, world.paddle[1].angle),
    )
    buttons = button_bits(action.left != 0, action.right != 0) | (JITTER if action.shove != 0 else 0)
    step_world(lane, geometry, buttons, tick)
    watch.frames += 1
    if world.fault != Fault.NONE:
        report(world, watch, as_int(Found.FAULT), 0, world.tick, 0.0)
    check_places(world, truth, watch)
    if watch.found == Found.NOTHING:
        check_contacts(lane, truth, watch, before, tick)
        check_tunnelling(lane, truth, watch, before, tick)
    if not truth.hostile and truth.board.gravity > 0.0:  # without gravity a ball may stay forever
        check_stuck(world, watch, tick)


@kernel
def soak_worlds(
    lanes: Lanes, geometries: BatchGeometry, drivers: Drivers, watches: Watches,
    first: int, end: int, ticks: int, tick: float,
) -> None:  # fmt: skip
    """Soak the worlds first … end − 1 for a number of ticks of length `tick` [s].

    A world with a finding is not advanced any further.
    """
    for index in range(first, end):
        world, log, tally = lanes.worlds[index], lanes.logs[index], lanes.tallies[index]
        watch, action, number = watches.states[index], drivers.actions[index], lanes.board_of[index]
        board, driver, wild = geometries.boards[number], drivers.states[index], drivers.wild[index]
        lane, geometry = (
            Lane(world, log, tally, log),
            BoardGeometry(board, geometries.colliders, geometries.grid),
        )
        truth = ReferenceBoard(
            watches.boards[number], watches.colliders, watches.headers[number], watches.labels,
            watches.hostile,
        )  # fmt: skip
        for _ in range(ticks):
            if watch.found != Found.NOTHING:
                break
            choose_action(world, board, driver, action, tick, wild)
            watched_tick(lane, geometry, drivers.places, truth, watch, action, tick)
