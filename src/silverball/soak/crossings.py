"""Checks of sensors and one-way parts: whether a ball crossed what its events say, and no more.

A flight is compared with the straight line between its ends, from which it is at most a margin away. Where
that decides whether it crossed a line or entered a circle, there must be an event, or none. Like `audit.py`,
this module shares no code with the solver.
"""

from __future__ import annotations

from math import hypot, inf
from typing import Any

from silverball.physics.audit import side_gap
from silverball.physics.for_devices import level_of
from silverball.physics.kernel import inlined, kernel
from silverball.physics.records import (
    BallRecord,
    BoardRecord,
    ColliderRecord,
    Colliders,
    Device,
    EventKind,
    LogRecord,
    Shape,
)
from silverball.soak.near_rows import NearBoard

UNKNOWN = -1  # the margin does not tell whether there was a crossing
CLEAR = 1e-6  # [u] by which a ball must be clear of a one-way part for the part to block it


@inlined
def is_sensor(c: ColliderRecord) -> bool:
    """Whether every crossing of a row is an event."""
    return c.role in (Device.SENSOR, Device.PASSAGE, Device.SPINNER)


@kernel
def line_crossings(c: ColliderRecord, ball: BallRecord, x: float, z: float, margin: float) -> int:
    """Count the crossings of a line on the way from (x, z) to the ball, or UNKNOWN."""
    dx, dz = c.x1 - c.x0, c.z1 - c.z0
    length = hypot(dx, dz)
    # How far it is to the left of start → end, before and after.
    before = ((x - c.x0) * dz - (z - c.z0) * dx) / length
    after = ((ball.x - c.x0) * dz - (ball.z - c.z0) * dx) / length
    if min(abs(before), abs(after)) <= margin:
        return UNKNOWN
    if (before > 0.0) == (after > 0.0):
        return 0
    share = before / (before - after)
    at_x, at_z = x + share * (ball.x - x), z + share * (ball.z - z)
    along = ((at_x - c.x0) * dx + (at_z - c.z0) * dz) / length
    slack = margin * (1.0 + hypot(ball.x - x, ball.z - z) / abs(after - before))
    if along < -slack or along > length + slack:
        return 0
    if along < slack or along > length - slack:
        return UNKNOWN
    if c.role == Device.PASSAGE and level_of(ball) != (c.level_right if after > 0.0 else c.level_left):
        return 0
    return 1


@kernel
def disc_entries(c: ColliderRecord, ball: BallRecord, x: float, z: float, margin: float) -> int:
    """Count the entries into a circle on the way from (x, z) to the ball, or UNKNOWN."""
    before, after = hypot(x - c.x, z - c.z) - c.radius, hypot(ball.x - c.x, ball.z - c.z) - c.radius
    if min(abs(before), abs(after)) <= margin:
        return UNKNOWN
    if before < 0.0:
        return 0
    if after < 0.0:
        return 1
    if x == ball.x and z == ball.z:
        return 0
    nearest = side_gap(c.x, c.z, x, z, ball.x, ball.z) - c.radius
    if abs(nearest) <= margin:
        return UNKNOWN
    return 1 if nearest < 0.0 else 0


@kernel
def is_crossing_wrong(
    log: LogRecord,
    near: NearBoard,
    colliders: Colliders,
    ball: BallRecord,
    watch: Any,
    slot: int,
    margin: float,
) -> bool:
    """Whether a ball that met nothing in the last tick has crossed a sensor, but not as often as logged."""
    x, z = watch.x_before[slot], watch.z_before[slot]
    for entry in range(near.header.crossed_first, near.header.crossed_end):
        c = colliders[near.rows[entry]]
        if not is_sensor(c) or c.levels >> level_of(ball) & 1 == 0:
            continue
        if c.form == Shape.LINE:
            expected = line_crossings(c, ball, x, z, margin)
        else:
            expected = disc_entries(c, ball, x, z, margin)
        if expected == UNKNOWN:
            continue
        logged = 0
        for number in range(log.count):
            event = log.event[number]
            if event.kind == EventKind.PASS and event.ball == ball.id and event.part == c.part:
                logged += 1
        if logged != expected:
            return True
    return False


@kernel
def has_changed_course(log: LogRecord, board: BoardRecord, colliders: Colliders, ball: int) -> bool:
    """Whether the ball with this id has crossed a passage in the last tick, perhaps there and back.

    Or a spinner that slows balls: one that stops on its line may fall back, without a second crossing.
    """
    for number in range(log.count):
        event = log.event[number]
        if event.kind != EventKind.PASS or event.ball != ball:
            continue
        for index in range(board.collider_first + board.shape_first, board.collider_end):
            c = colliders[index]
            if c.part == event.part and (c.role == Device.PASSAGE or c.drag > 0.0):
                return True
    return False


@kernel
def is_thrown_back(board: BoardRecord, colliders: Colliders, kind: int, part: int) -> bool:
    """Whether an event is that of a passage which has thrown a ball back: a touch of its line."""
    if kind != EventKind.TOUCH:
        return False
    for index in range(board.collider_first + board.shape_first, board.collider_end):
        if colliders[index].part == part and colliders[index].role == Device.PASSAGE:
            return True
    return False


@kernel
def gap_to_sensor(board: BoardRecord, colliders: Colliders, part: int, x: float, z: float) -> float:
    """Compute how far (x, z) is from the nearest line or circle of a part [u]."""
    gap = inf
    for index in range(board.collider_first + board.shape_first, board.collider_end):
        c = colliders[index]
        if c.part == part and c.form == Shape.LINE:
            gap = min(gap, side_gap(x, z, c.x0, c.z0, c.x1, c.z1))
        elif c.part == part and c.form == Shape.DISC:
            gap = min(gap, abs(hypot(x - c.x, z - c.z) - c.radius))
    return gap


@kernel
def depth_in_one_way(
    near: NearBoard, colliders: Colliders, radius: float, ball: BallRecord, watch: Any, slot: int
) -> float:
    """Compute how deep a ball is in one-way parts that it was clear of, on the blocked side, a tick ago."""
    x, z, depth = watch.x_before[slot], watch.z_before[slot], 0.0
    for entry in range(near.header.crossed_first, near.header.crossed_end):
        c = colliders[near.rows[entry]]
        if c.one_way == 0 or c.levels >> level_of(ball) & 1 == 0:
            continue
        dx, dz, thick = c.x1 - c.x0, c.z1 - c.z0, c.radius + radius
        square = dx * dx + dz * dz
        before = (x - c.x0) * c.inward_x + (z - c.z0) * c.inward_z
        after = (ball.x - c.x0) * c.inward_x + (ball.z - c.z0) * c.inward_z
        along, ahead = (x - c.x0) * dx + (z - c.z0) * dz, (ball.x - c.x0) * dx + (ball.z - c.z0) * dz
        if before > thick + CLEAR and min(along, ahead) >= 0.0 and max(along, ahead) <= square:
            depth = max(depth, thick - after)
    return depth
