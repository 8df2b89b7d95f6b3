"""Checks of the soak after every tick: places, contacts, tunnelling, faults, and balls that are stuck.

They do not use the solver's geometry. A ball must be on the board and in the region it was created in
(`regions.py`), or to which a hole or another level brought it, inside nothing, and just at the surface at
every contact (`audit.py`). It must not pass through anything without a contact, nor stay in one place for a
minute. `crossings.py` checks sensors and one-way parts. The first finding stops a world.
"""

from __future__ import annotations

from enum import IntEnum
from math import hypot
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from silverball.physics.audit import (
    angle_after,
    depth_in_borders,
    depth_in_other_ball,
    depth_in_paddle,
    gap_to,
    is_met,
    is_out_of_reach,
)
from silverball.physics.for_devices import are_on_one_level, level_of, switches_off
from silverball.physics.kernel import as_int, inlined, kernel
from silverball.physics.records import (
    LAUNCH,
    MAX_BALLS,
    MAX_LEVELS,
    MAX_PADDLES,
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
    Motion,
    Part,
    Places,
    WorldRecord,
)
from silverball.physics.step import button_bits, step_world
from silverball.soak.crossings import (
    depth_in_one_way,
    gap_to_sensor,
    has_changed_course,
    is_crossing_wrong,
    is_thrown_back,
)
from silverball.soak.driver import SHOVES, ActionRecord, Drivers, apply_action, choose_action, move_gates
from silverball.soak.near_rows import NearBoard, NearRows, depth_near
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
    MISSED = 7  # a ball crossed a sensor without an event, or there was an event without a crossing


class PreviousBall(NamedTuple):
    """A ball before a tick: its id and its centre [u]."""

    id: int
    x: float
    z: float


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
        ("tracker", STUCK_TRACKER, (MAX_BALLS,)),
        # Balls, switches and paddles before the tick: centres [u], velocities [u/s], angles [rad], [rad/s].
        ("id_before", "i8", (MAX_BALLS,)), ("x_before", "f8", (MAX_BALLS,)), ("z_before", "f8", (MAX_BALLS,)),
        ("vx_before", "f8", (MAX_BALLS,)), ("vz_before", "f8", (MAX_BALLS,)),
        ("level_before", "i8", (MAX_BALLS,)), ("motion_before", "i8", (MAX_BALLS,)),
        ("off_before", "i8"),
        ("angle_before", "f8", (MAX_PADDLES,)), ("omega_before", "f8", (MAX_PADDLES,)),
        ("frames", "i8"),  # ticks watched
        ("deepest", "f8"),  # [u]
        ("found", "i8"),  # Found
        ("slot", "i8"), ("since", "i8"),  # of the finding: the ball, the tick at which it may have begun
        ("depth", "f8"),  # of the finding, where it has one [u]; of a phantom: the distance of the contact
    ],
    align=True,
)  # fmt: skip
WatchRecord: TypeAlias = Any  # a WATCH record
EventRecord: TypeAlias = Any  # an EVENT record


class ReferenceBoard(NamedTuple):
    """A table as the checks know it, compiled for them alone, apart from the board that the solver reads.

    Attributes:
        board: A BOARD record.
        colliders: COLLIDER records of all boards.
        header: The GRID_HEADER record of the board.
        labels: Labels of the cells of all boards.
        near: The lists of the rows near its places.
        hostile: Whether a ball may start in any region, and get stuck: the check was not made, or warned.
    """

    board: BoardRecord
    colliders: Colliders
    header: GridHeaderRecord
    labels: Any
    near: NearBoard
    hostile: bool


class Watches(NamedTuple):
    """What watches the worlds of a batch.

    Attributes:
        boards: BOARD records [board], compiled for the checks alone.
        colliders: COLLIDER records of all boards.
        headers: GRID_HEADER records [board].
        labels: Labels of the cells of all boards.
        near: The lists of the rows near the places of all boards.
        states: WATCH records [world].
        hostile: Whether the check of each board was not made, or warned, bool [board].
    """

    boards: Any
    colliders: Colliders
    headers: Any
    labels: Any
    near: NearRows
    states: Any
    hostile: Any


@kernel
def register_new_balls(world: WorldRecord, truth: ReferenceBoard, watch: WatchRecord) -> None:
    """Record where new balls start. On a checked board without holes, that can only be at the gutter."""
    for slot in range(truth.board.max_balls):
        ball, tracker = world.ball[slot], watch.tracker[slot]
        if ball.id != tracker.id:
            tracker.id, tracker.x, tracker.z = ball.id, ball.x, ball.z
            tracker.since, tracker.jams = world.tick, world.jams
            tracker.region = MAIN_REGION
            if truth.hostile or truth.board.sensors != 0:
                label = label_at(truth.header, truth.labels, level_of(ball), ball.x, ball.z)
                tracker.region = region_of(label)


@kernel
def follow_transfers(lane: Lane, truth: ReferenceBoard, watch: WatchRecord) -> None:
    """Record to where holes and passages have brought balls in the last tick."""
    world, log = lane.world, lane.log
    for slot in range(truth.board.max_balls):
        ball, tracker = world.ball[slot], watch.tracker[slot]
        if ball.id == 0 or ball.id != tracker.id:
            continue
        is_moved = level_of(ball) != watch.level_before[slot] or log.lost > 0
        for number in range(log.count):
            event = log.event[number]
            is_hole = event.kind in (EventKind.CAPTURED, EventKind.RELEASED)
            is_moved = is_moved or (is_hole and event.ball == ball.id)
        if is_moved:
            tracker.region = region_of(label_at(truth.header, truth.labels, level_of(ball), ball.x, ball.z))


@kernel
def report(world: WorldRecord, watch: WatchRecord, found: int, slot: int, since: int, depth: float) -> None:
    """Record a finding, if it is the first of its world."""
    if watch.found == Found.NOTHING:
        watch.found, watch.slot, watch.since, watch.depth = found, slot, since, depth


@kernel
def check_places(world: WorldRecord, truth: ReferenceBoard, watch: WatchRecord) -> None:
    """Check that every ball is at a possible place and not inside anything."""
    board, colliders, now = truth.board, truth.colliders, world.tick
    has_checked_pairs = False
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        label = label_at(truth.header, truth.labels, level_of(ball), ball.x, ball.z)
        region = region_of(label)
        if label == OFF_BOARD or ball.x < board.gutter - GUTTER_MARGIN:
            report(world, watch, as_int(Found.ESCAPE), slot, now, 0.0)
            continue
        if watch.tracker[slot].region == BLOCKED:
            watch.tracker[slot].region = region
        if region != BLOCKED and region != watch.tracker[slot].region:
            report(world, watch, as_int(Found.ESCAPE), slot, now, 0.0)
        depth = depth_in_borders(board, colliders, ball.x, ball.z)
        if is_narrow(label) and ball.motion != Motion.CAPTURED:
            inside = depth_near(
                truth.near, board, colliders, ball.x, ball.z, level_of(ball), switches_off(world)
            )
            depth = max(depth, inside)
        for number in range(board.paddles if ball.motion != Motion.CAPTURED else 0):
            c = colliders[board.collider_first + Part.FIRST_PADDLE + number]
            if is_met(c, level_of(ball), switches_off(world)):
                inside = depth_in_paddle(c, world.paddle[number].angle, ball.x, ball.z, board.ball_radius)
                depth = max(depth, inside)
        if not has_checked_pairs:
            has_checked_pairs, depth = True, max(depth, depth_in_other_ball(world, board.ball_radius))
        watch.deepest = max(watch.deepest, depth)
        if depth > DEPTH:
            report(world, watch, as_int(Found.PENETRATION), slot, now, depth)


@kernel
def check_contacts(lane: Lane, truth: ReferenceBoard, watch: WatchRecord) -> None:
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
        if is_thrown_back(truth.board, truth.colliders, event.kind, event.part):  # see `check_crossings`
            continue
        gap = gap_to_part(world, truth, watch, event) - truth.board.ball_radius
        slot = slot_of(watch, event.ball)
        watch.deepest = max(watch.deepest, -gap)
        if -gap > DEPTH:
            report(world, watch, as_int(Found.PENETRATION), slot, world.tick - 1, -gap)
        elif gap > DEPTH:
            report(world, watch, as_int(Found.PHANTOM), slot, world.tick - 1, gap)


@kernel
def gap_to_part(world: WorldRecord, truth: ReferenceBoard, watch: WatchRecord, event: EventRecord) -> float:
    """The distance of the place of a contact from the nearest row of the part that was met [u]."""
    board, gap = truth.board, np.inf
    for row in range(board.collider_end - board.collider_first):
        c = truth.colliders[board.collider_first + row]
        if c.part != event.part:
            continue
        angle, paddle = 0.0, row - Part.FIRST_PADDLE
        if 0 <= paddle < board.paddles:
            angle = angle_after(
                c, watch.angle_before[paddle], world.paddle[paddle].angle, event.offset,
                watch.omega_before[paddle],
            )  # fmt: skip
        gap = min(gap, gap_to(c, row, angle, event.x, event.z))
    return gap


@kernel
def slot_of(watch: WatchRecord, ball: int) -> int:
    """The slot of the ball with this id before the tick."""
    for slot in range(MAX_BALLS):
        if watch.tracker[slot].id == ball:
            return slot
    return 0


@kernel
def is_untouched(log: LogRecord, ball: int) -> bool:
    """Whether a ball met nothing in the last tick, according to the log."""
    if log.lost > 0:
        return False
    for number in range(log.count):
        event = log.event[number]
        if event.kind in (EventKind.BALL_HIT, EventKind.BALL_TOUCH, EventKind.JAM):
            return False
        is_own = event.kind in (EventKind.HIT, EventKind.TOUCH, EventKind.CAPTURED, EventKind.RELEASED)
        if event.ball == ball and is_own:
            return False
    return True


@kernel
def max_sagitta(board: BoardRecord, tick: float) -> float:
    """Upper bound [u] on how far a flight deviates from its chord over one tick [s].

    At most a quarter of the tick times everything that changes the velocity on the way: gravity, friction,
    and, where a slipping ball begins to roll, once more what gravity does in a tick.
    """
    return 0.25 * tick * max_change(board, tick)


@kernel
def max_change(board: BoardRecord, tick: float) -> float:
    """Upper bound [u/s] on how far the velocity of a flight changes over one tick [s]."""
    accel = 0.0
    for level in range(MAX_LEVELS):
        accel = max(accel, 2.0 * board.level_size[level] + board.friction * board.level_normal[level])
    return tick * accel


@kernel
def depth_along_path(
    world: WorldRecord, truth: ReferenceBoard, watch: WatchRecord, slot: int, tick: float
) -> float:
    """How deep the ball in a slot was inside something on the straight path of its last tick [u].

    Meanwhile the paddles have turned.
    """
    board, colliders, ball = truth.board, truth.colliders, world.ball[slot]
    radius, paddles = board.ball_radius, board.collider_first + Part.FIRST_PADDLE
    start_x, start_z = watch.x_before[slot], watch.z_before[slot]
    dx, dz = ball.x - start_x, ball.z - start_z
    path = hypot(dx, dz)
    swept, at_paddle = path, False
    for paddle in range(board.paddles):
        c = colliders[paddles + paddle]
        if is_met(c, level_of(ball), 0) and not is_out_of_reach(c, ball.x, ball.z, radius + path):
            at_paddle = True
            turned = abs(world.paddle[paddle].angle - watch.angle_before[paddle])
            swept = max(swept, path + turned * hypot(ball.x - c.x, ball.z - c.z))
    count = int(swept / SAMPLE) + 1
    depth = 0.0
    for number in range(1, count):
        share = number / count
        x, z = start_x + share * dx, start_z + share * dz
        if is_narrow(label_at(truth.header, truth.labels, level_of(ball), x, z)):
            inside = depth_near(
                truth.near, board, colliders, x, z, level_of(ball), switches_off(world) | watch.off_before
            )
            depth = max(depth, inside)
        if at_paddle:
            for paddle in range(board.paddles):
                c = colliders[paddles + paddle]
                if not is_met(c, level_of(ball), 0):
                    continue
                angle = angle_after(
                    c, watch.angle_before[paddle], world.paddle[paddle].angle, share * tick,
                    watch.omega_before[paddle],
                )  # fmt: skip
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
def is_free(lane: Lane, truth: ReferenceBoard, watch: WatchRecord, slot: int, tick: float) -> bool:
    """Whether the ball in a slot was there before the tick, on the same level, and met nothing in it."""
    ball = lane.world.ball[slot]
    if ball.id == 0 or ball.id != watch.id_before[slot] or level_of(ball) != watch.level_before[slot]:
        return False
    if Motion.CAPTURED in (ball.motion, watch.motion_before[slot]):
        return False
    if truth.board.sensors != 0:  # a spinner may slow it, a passage throw it back, a jitter hide that
        change = hypot(ball.vx - watch.vx_before[slot], ball.vz - watch.vz_before[slot])
        if change > max_change(truth.board, tick) + PASSAGE_DEPTH:
            return False
        if has_changed_course(lane.log, truth.board, truth.colliders, ball.id):
            return False
    return is_untouched(lane.log, ball.id)


@kernel
def check_tunnelling(lane: Lane, truth: ReferenceBoard, watch: WatchRecord, tick: float) -> None:
    """Check that no ball tunnelled: passed through anything without a contact.

    The path is checked as a straight line, so a depth up to its sagitta is allowed.
    """
    world, board = lane.world, truth.board
    allowed = max_sagitta(board, tick) + PASSAGE_DEPTH
    for slot in range(board.max_balls):
        if not is_free(lane, truth, watch, slot, tick):
            continue
        depth = depth_along_path(world, truth, watch, slot, tick)
        if depth > allowed:
            report(world, watch, as_int(Found.PASSAGE), slot, world.tick - 1, depth)
        for other in range(slot + 1, board.max_balls):
            is_same = are_on_one_level(world.ball[other], world.ball[slot])
            if is_same and is_free(lane, truth, watch, other, tick):
                depth = depth_of_meeting(
                    previous_ball(watch, slot), world.ball[slot],
                    previous_ball(watch, other), world.ball[other], board.ball_radius,
                )  # fmt: skip
                if depth > 2.0 * allowed:
                    report(world, watch, as_int(Found.PASSAGE), slot, world.tick - 1, depth)


@kernel
def check_crossings(lane: Lane, truth: ReferenceBoard, watch: WatchRecord, tick: float) -> None:
    """Check the crossings of sensors, and that one-way parts block balls from the one side."""
    world, board, log = lane.world, truth.board, lane.log
    if log.lost > 0:
        return
    for number in range(log.count):
        event = log.event[number]
        if event.kind == EventKind.PASS or is_thrown_back(board, truth.colliders, event.kind, event.part):
            gap = gap_to_sensor(board, truth.colliders, event.part, event.x, event.z)
            if gap > DEPTH:
                report(world, watch, as_int(Found.PHANTOM), slot_of(watch, event.ball), world.tick - 1, gap)
    margin = max_sagitta(board, tick) + PASSAGE_DEPTH
    for slot in range(board.max_balls):
        if not is_free(lane, truth, watch, slot, tick):
            continue
        ball = world.ball[slot]
        if is_crossing_wrong(log, truth.near, truth.colliders, ball, watch, slot, margin):
            report(world, watch, as_int(Found.MISSED), slot, world.tick - 1, 0.0)
        depth = depth_in_one_way(truth.near, truth.colliders, board.ball_radius, ball, watch, slot)
        if depth > margin:
            report(world, watch, as_int(Found.PASSAGE), slot, world.tick - 1, depth)


@inlined
def previous_ball(watch: WatchRecord, slot: int) -> PreviousBall:
    """The ball of a slot before the tick."""
    return PreviousBall(watch.id_before[slot], watch.x_before[slot], watch.z_before[slot])


@kernel
def remember_state(world: WorldRecord, board: BoardRecord, watch: WatchRecord) -> None:
    """Record the balls and the paddles before a tick."""
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        watch.id_before[slot], watch.x_before[slot], watch.z_before[slot] = ball.id, ball.x, ball.z
        watch.vx_before[slot], watch.vz_before[slot] = ball.vx, ball.vz
        watch.level_before[slot], watch.motion_before[slot] = level_of(ball), ball.motion
    watch.off_before = switches_off(world)
    for paddle in range(board.paddles):
        watch.angle_before[paddle] = world.paddle[paddle].angle
        watch.omega_before[paddle] = world.paddle[paddle].angular_velocity


@kernel
def check_stuck(world: WorldRecord, board: BoardRecord, watch: WatchRecord, tick: float) -> None:
    """Check that no ball stays in one place for too long without a jam."""
    for slot in range(board.max_balls):
        ball, tracker = world.ball[slot], watch.tracker[slot]
        if ball.id == 0:
            continue
        away = (ball.x - tracker.x) ** 2 + (ball.z - tracker.z) ** 2 > STUCK_RADIUS * STUCK_RADIUS
        if away or world.jams != tracker.jams or ball.motion == Motion.CAPTURED:
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
    move_gates(world, geometry, action)
    register_new_balls(world, truth, watch)
    remember_state(world, truth.board, watch)
    buttons = button_bits(action.left != 0, action.right != 0) | (
        SHOVES[action.shove - 1] if action.shove != 0 else 0
    )
    buttons |= LAUNCH if action.launch != 0 else 0
    step_world(lane, geometry, buttons, tick)
    watch.frames += 1
    if world.fault != Fault.NONE:
        report(world, watch, as_int(Found.FAULT), 0, world.tick, 0.0)
    follow_transfers(lane, truth, watch)
    check_places(world, truth, watch)
    if watch.found == Found.NOTHING:
        check_contacts(lane, truth, watch)
        check_tunnelling(lane, truth, watch, tick)
        if truth.header.crossings != 0:
            check_crossings(lane, truth, watch, tick)
    if not truth.hostile and truth.board.gravity > 0.0:  # without gravity a ball may stay forever
        check_stuck(world, truth.board, watch, tick)


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
        lane = Lane(world, log, tally, log)
        geometry = BoardGeometry(board, geometries.colliders, geometries.grid)
        truth = ReferenceBoard(
            watches.boards[number], watches.colliders, watches.headers[number], watches.labels,
            NearBoard(watches.near.headers[number], watches.near.starts, watches.near.rows),
            watches.hostile[number],
        )  # fmt: skip
        for _ in range(ticks):
            if watch.found != Found.NOTHING:
                break
            choose_action(world, board, driver, action, tick, wild)
            watched_tick(lane, geometry, drivers.places, truth, watch, action, tick)
