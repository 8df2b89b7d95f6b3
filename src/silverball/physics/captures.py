"""Balls that devices hold: how holes and plungers capture them, and let them go again."""

from __future__ import annotations

from math import sqrt

from silverball.physics.bounce import clamp_speed
from silverball.physics.due_times import later
from silverball.physics.event_log import count_score, log_event
from silverball.physics.flight import state_at
from silverball.physics.for_devices import for_devices
from silverball.physics.holes import can_capture, exit_velocity, launch_speed
from silverball.physics.kernel import as_int, inlined, internal
from silverball.physics.motion import advance_to, capture, clear_ball, set_free
from silverball.physics.paddle import angle_at, paddle_distance, read_sweep
from silverball.physics.portable_math import uniform
from silverball.physics.records import (
    LAUNCH,
    NOTHING,
    BallRecord,
    BoardGeometry,
    BoardRecord,
    ColliderRecord,
    Colliders,
    Contact,
    Device,
    EventKind,
    Lane,
    Motion,
    Part,
    Response,
    WorldRecord,
)
from silverball.physics.shapes import distance
from silverball.physics.tolerances import FREE_GAP, MAX_DEPTH


@internal
def enter_hole(
    lane: Lane, geometry: BoardGeometry, ball: BallRecord, row: int, time: float, tick: float
) -> None:
    """Capture a ball that enters a hole, unless it is too fast or there is no room for it in the middle."""
    world, board = lane.world, geometry.board
    c = geometry.colliders[board.collider_first + row]
    at = state_at(ball, ball.age + time)
    if not can_capture(at.vx, at.vz, c.capture_speed):
        return
    speed = sqrt(at.vx * at.vx + at.vz * at.vz)
    contact = Contact(time, row, 0.0, 0.0)
    if c.role == Device.DRAIN:
        advance_to(ball, board, ball.age + time)
        world.drained += 1
        lane.tally[c.part] += 1
        log_event(lane.log, as_int(EventKind.GUTTER), ball, world.tick, c.part, contact, speed)
        clear_ball(ball)
        return
    if not has_room(world, board, ball, c.x, c.z, ball.level, time):
        return
    if not is_clear(lane, geometry, c.x, c.z, ball.level, time):
        return
    capture(ball, row, c.x, c.z, time)
    count_score(lane, c)
    log_event(lane.log, as_int(EventKind.CAPTURED), ball, world.tick, c.part, contact, speed)
    if c.role == Device.HOLE:
        ball.due_tick, ball.due_offset = later(world.tick, time + c.hold_time, tick)


@inlined
def has_room(
    world: WorldRecord, board: BoardRecord, ball: BallRecord, x: float, z: float, level: int, time: float
) -> bool:
    """Whether a ball at (x, z) on a level would overlap no other ball at a time of the tick [s]."""
    reach = 2.0 * board.ball_radius + FREE_GAP
    for slot in range(board.max_balls):
        other = world.ball[slot]
        if other.id not in (0, ball.id) and other.level == level:
            at = state_at(other, other.age + time)
            if (at.x - x) * (at.x - x) + (at.z - z) * (at.z - z) < reach * reach:
                return False
    return True


@internal
def is_clear(lane: Lane, geometry: BoardGeometry, x: float, z: float, level: int, time: float) -> bool:
    """Whether a ball at (x, z) on a level would overlap no collider at a time of the tick [s]."""
    world, board, scratch = lane.world, geometry.board, lane.scratch
    if min(z - board.low_z, board.high_z - z, board.top_x - x) < -MAX_DEPTH:
        return False
    for index in range(board.collider_first + Part.FIRST_PADDLE, board.collider_end):
        c = geometry.colliders[index]
        if c.response != Response.BOUNCE or c.levels >> level & 1 == 0 or c.switch & world.off != 0:
            continue
        if c.one_way != 0:  # a ball may overlap it
            continue
        dx, dz, reach = x - c.x, z - c.z, c.reach + board.ball_radius
        if dx * dx + dz * dz > reach * reach:
            continue
        row = index - board.collider_first
        if row < board.shape_first:
            angle = angle_at(read_sweep(scratch.sweep[row - Part.FIRST_PADDLE]), time)
            gap, _, _ = paddle_distance(c, angle, x, z)
        else:
            gap, _, _ = distance(c, x, z)
        if gap < board.ball_radius - MAX_DEPTH:
            return False
    return True


@internal
def release_ball(lane: Lane, geometry: BoardGeometry, ball: BallRecord, time: float) -> None:
    """Let a hole or plunger send off its ball; if the way is blocked, it is tried again in the next tick."""
    world, board = lane.world, geometry.board
    c = geometry.colliders[board.collider_first + ball.holder]
    if not (
        has_room(world, board, ball, c.exit_x, c.exit_z, c.exit_level, time)
        and is_clear(lane, geometry, c.exit_x, c.exit_z, c.exit_level, time)
    ):
        ball.due_tick, ball.due_offset = world.tick + 1, 0.0
        return
    vx, vz, world.draws = exit_velocity(c.exit_vx, c.exit_vz, c.exit_spread, world.seed, world.draws)
    if c.exit_gain > 0.0:
        faster = 1.0 + c.exit_gain * uniform(world.seed, world.draws)
        vx, vz, world.draws = faster * vx, faster * vz, world.draws + 1
    ball.x, ball.z, ball.level = c.exit_x, c.exit_z, c.exit_level
    _send_off(lane, board, ball, c, vx, vz, time)


@internal
def _send_off(
    lane: Lane, board: BoardRecord, ball: BallRecord, c: ColliderRecord, vx: float, vz: float, time: float
) -> None:
    ball.vx, ball.vz = clamp_speed(vx, vz, board.speed_cap)
    set_free(ball, board, time)
    speed = sqrt(ball.vx * ball.vx + ball.vz * ball.vz)
    nx, nz = (ball.vx / speed, ball.vz / speed) if speed > 0.0 else (0.0, 0.0)
    contact = Contact(time, as_int(NOTHING), nx, nz)
    log_event(lane.log, as_int(EventKind.RELEASED), ball, lane.world.tick, c.part, contact, speed)


@for_devices(lambda lane, geometry, buttons, tick: None)
@internal
def work_plungers(lane: Lane, geometry: BoardGeometry, buttons: int, tick: float) -> None:
    """Launch the balls on the plungers at the start of a tick, if the button has been released.

    A ball stays where something is in its place, as a paddle that has turned over it.
    """
    world, board = lane.world, geometry.board
    if not is_launching(world, board, buttons):
        return
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id != 0 and ball.motion == Motion.CAPTURED:
            c = geometry.colliders[board.collider_first + ball.holder]
            if c.role == Device.PLUNGER and is_clear(lane, geometry, c.x, c.z, ball.level, 0.0):
                speed = launch_speed(
                    c.launch_least, c.launch_greatest, c.charge_time, world.launch_held, tick
                )
                _send_off(lane, board, ball, c, speed * c.launch_x, speed * c.launch_z, 0.0)


@for_devices(lambda world, board, buttons: False)
@inlined
def is_launching(world: WorldRecord, board: BoardRecord, buttons: int) -> bool:
    """Whether the launch button was held up to now and is not any more."""
    return board.plungers != 0 and world.launch_held != 0 and buttons & LAUNCH == 0


@for_devices(lambda world, board, buttons, count: None)
@inlined
def count_launch_ticks(world: WorldRecord, board: BoardRecord, buttons: int, count: int) -> None:
    """Count how long the launch button has been held, at the end of `count` ticks."""
    if board.plungers != 0:
        world.launch_held = world.launch_held + count if buttons & LAUNCH != 0 else 0


@internal
def free_plunger(world: WorldRecord, board: BoardRecord, colliders: Colliders) -> int:
    """Find the row of a plunger on which a new ball can lie; −1 if there is none."""
    for row in range(board.plunger_row, board.collider_end - board.collider_first):
        c = colliders[board.collider_first + row]
        if c.role == Device.PLUNGER:
            is_free = True
            reach = 2.0 * board.ball_radius + FREE_GAP
            for slot in range(board.max_balls):
                ball = world.ball[slot]
                dx, dz = ball.x - c.x, ball.z - c.z
                if ball.id != 0 and c.levels >> ball.level & 1 != 0 and dx * dx + dz * dz < reach * reach:
                    is_free = False
            if is_free:
                return row
    return -1


@for_devices(lambda ball, board, colliders, tick: False)
@internal
def is_possible_capture(ball: BallRecord, board: BoardRecord, colliders: Colliders, tick: float) -> bool:
    """Whether a device can hold a captured ball as its record says."""
    if not 0 <= ball.holder < board.collider_end - board.collider_first:
        return False
    c = colliders[board.collider_first + ball.holder]
    return bool(
        c.role in (Device.HOLE, Device.PLUNGER)
        and ball.x == c.x
        and ball.z == c.z
        and ball.start_x == c.x
        and ball.start_z == c.z
        and ball.vx == 0.0
        and ball.vz == 0.0
        and ball.start_vx == 0.0
        and ball.start_vz == 0.0
        and ball.accel_x == 0.0
        and ball.accel_z == 0.0
        and 0.0 <= ball.due_offset <= tick
        and ball.due_tick >= 0
    )
