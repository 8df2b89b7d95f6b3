"""Validation of externally modified states: whether each is possible, with every ball on its flight.

A state that the last call left unchanged continues; the log holds a checksum to detect that. Any other state
comes from outside: it was restored, copied, shoved, or its fields were written to. Then every ball must be in
a possible place, or the world gets a named fault. A flight that leads to where its ball is continues, but its
next contact is searched for again from the flight's start. A search is a function of the flight alone, so a
restored world reaches the same bits. A ball that is not on its flight starts a new one from where it is.
"""

from __future__ import annotations

from silverball.physics.balls import separate_balls
from silverball.physics.broad_phase import cell_of, is_near
from silverball.physics.cabinet import validate_cabinet
from silverball.physics.captures import is_possible_capture
from silverball.physics.devices import set_next_clock
from silverball.physics.due_times import later
from silverball.physics.event_log import flight_checksum
from silverball.physics.for_devices import (
    ball_slots,
    for_devices,
    is_captured,
    is_solid,
    level_of,
    paddle_count,
    shares_level,
    switches_off,
)
from silverball.physics.kernel import as_int, inlined, internal, kernel
from silverball.physics.motion import (
    has_valid_motion,
    is_on_flight,
    reset_search,
    set_free,
    start_flight,
)
from silverball.physics.paddle import paddle_distance
from silverball.physics.records import (
    MAX_LEVELS,
    BallRecord,
    BoardGeometry,
    BoardRecord,
    Fault,
    LogRecord,
    Part,
    WorldRecord,
)
from silverball.physics.shapes import distance
from silverball.physics.spinner import is_possible_spinner
from silverball.physics.tolerances import MAX_DEPTH, NEVER, SPEED_MARGIN


@inlined
def is_unchanged(world: WorldRecord, board: BoardRecord, log: LogRecord, tick: float) -> bool:
    """Whether the balls are on the flights, and the paddles at the angles, that the last call left."""
    if flight_checksum(world, board) != log.checksum:
        return False
    is_known = True
    for slot in range(ball_slots(world, board)):
        is_known = is_known and continues_flight(world.ball[slot], board, tick)
    return bool(is_known)


@inlined
def continues_flight(ball: BallRecord, board: BoardRecord, tick: float) -> bool:
    """Whether a ball is on a flight that has not ended; true of an empty slot."""
    if is_captured(ball):
        return bool(ball.id == 0 or is_on_flight(ball, tick))
    return ball.id == 0 or (
        ball.age <= ball.contact_age
        and is_on_flight(ball, tick)
        and is_finite(ball.spin_x + ball.spin_y + ball.spin_z)
        # The spin may have been changed from outside.
        and (board.normal_accel == 0.0 or has_valid_motion(ball, board, tick))
    )


@internal
def admit_state(world: WorldRecord, geometry: BoardGeometry, tick: float) -> bool:
    """Validate a state from outside and set every ball on a flight; if it is impossible, set the fault."""
    board = geometry.board
    if not validate_world(world, board):
        return False
    for slot in range(ball_slots(world, board)):
        ball = world.ball[slot]
        has_holder = ball.id != 0 and is_captured(ball)
        if has_holder and not is_possible_capture(ball, board, geometry.colliders, tick):
            set_free(ball, board, 0.0)
    validate_devices(world, geometry, tick)
    validate_cabinet(world, board)
    if not validate_positions(world, geometry):
        return False
    for slot in range(len(world.ball)):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        if is_captured(ball) and is_on_flight(ball, tick):
            continue
        if is_on_flight(ball, tick) and has_valid_motion(ball, board, tick):
            reset_search(ball)
        else:
            start_flight(ball, board, 0.0)
    return True


@internal
def validate_positions(world: WorldRecord, geometry: BoardGeometry) -> bool:
    """Check that the paddles are within their stops and no ball is inside anything; if not, set the fault.

    Overlapping balls are moved apart first, if that is possible.
    """
    board, colliders = geometry.board, geometry.colliders
    for index in range(paddle_count(world, board)):
        c, angle = colliders[board.collider_first + Part.FIRST_PADDLE + index], world.paddle[index].angle
        if not min(c.angle_rest, c.angle_up) <= angle <= max(c.angle_rest, c.angle_up):
            world.fault = as_int(Fault.BEYOND_STOP)
            return False
    is_free = separate_balls(world, board, colliders)
    for slot in range(len(world.ball)):
        ball = world.ball[slot]
        if ball.id != 0:
            is_free = is_free and is_clear_of_parts(world, geometry, ball)
    if not is_free:
        world.fault = as_int(Fault.INSIDE)
    return bool(is_free)


@internal
def is_clear_of_parts(world: WorldRecord, geometry: BoardGeometry, ball: BallRecord) -> bool:
    """Whether a ball is inside no part, with the paddles at their present angles; a captured one never is."""
    x, z = ball.x, ball.z
    if is_captured(ball):
        return True
    board, colliders, grid = geometry.board, geometry.colliders, geometry.grid
    if min(z - board.low_z, board.high_z - z, board.top_x - x) < -MAX_DEPTH:
        return False
    min_gap, off = board.ball_radius - MAX_DEPTH, switches_off(world)
    cell = cell_of(board, x, z)
    for entry in range(grid[cell], grid[cell + 1]):
        c = colliders[board.collider_first + grid[entry]]
        if c.one_way != 0 or not is_solid(c, ball, off):
            continue
        gap, _, _ = distance(c, x, z)
        if gap < min_gap:
            return False
    for index in range(paddle_count(world, board)):
        c = colliders[board.collider_first + Part.FIRST_PADDLE + index]
        if not shares_level(c, ball):
            continue
        if is_near(x, z, c.x, c.z, c.reach + board.ball_radius):
            gap, _, _ = paddle_distance(c, world.paddle[index].angle, x, z)
            if gap < min_gap:
                return False
    return True


@kernel
def validate_world(world: WorldRecord, board: BoardRecord) -> bool:
    """Check that positions and speeds of the balls are possible; if not, set the fault and return False."""
    for slot in range(len(world.ball)):
        ball = world.ball[slot]
        if ball.id == 0 or is_valid_ball(ball, board):
            continue
        sum_of_all = ball.x + ball.z + ball.vx + ball.vz + ball.spin_x + ball.spin_y + ball.spin_z
        if not is_finite(sum_of_all):
            world.fault = as_int(Fault.NOT_FINITE)
        elif not (
            abs(ball.x) <= board.half_length
            and abs(ball.z) <= board.half_width
            and 0 <= level_of(ball) < MAX_LEVELS
        ):
            world.fault = as_int(Fault.OUTSIDE)
        else:
            world.fault = as_int(Fault.TOO_FAST)
        return False
    for index in range(paddle_count(world, board)):
        if not is_finite(world.paddle[index].angle):
            world.fault = as_int(Fault.NOT_FINITE)
            return False
    return True


@inlined
def is_valid_ball(ball: BallRecord, board: BoardRecord) -> bool:
    """Whether a ball's position, speed and spin are possible."""
    inside = abs(ball.x) <= board.half_length and abs(ball.z) <= board.half_width
    inside = inside and 0 <= level_of(ball) < MAX_LEVELS
    max_speed = board.speed_cap * SPEED_MARGIN
    slow = ball.vx * ball.vx + ball.vz * ball.vz <= max_speed * max_speed
    return inside and slow and is_finite(ball.spin_x + ball.spin_y + ball.spin_z)


@inlined
def is_finite(x: float) -> bool:
    """Whether x is neither infinite nor NaN."""
    return abs(x) < NEVER


@for_devices(lambda world, geometry, tick: None)
@internal
def validate_devices(world: WorldRecord, geometry: BoardGeometry, tick: float) -> None:
    """Make the state of the devices in a world from outside a possible one."""
    board, colliders = geometry.board, geometry.colliders
    world.off &= board.switches
    world.banks_due &= (1 << board.banks) - 1
    world.launch_held = min(max(world.launch_held, 0), world.tick) if board.plungers != 0 else 0
    for number in range(board.banks):
        mask = board.bank_switches[number]
        is_possible = world.off & mask == mask and 0.0 <= world.bank_offset[number] <= tick
        if not is_possible:
            world.banks_due &= ~(1 << number)
        if world.off & mask == mask and world.banks_due >> number & 1 == 0:
            world.banks_due |= 1 << number
            due, offset = later(world.tick, board.bank_time[number], tick)
            world.bank_tick[number], world.bank_offset[number] = due, offset
    for number in range(board.spinners):
        spinner = world.spinner[number]
        c = colliders[board.collider_first + board.spinner_row[number]]
        if not is_possible_spinner(spinner, c, board, world.tick, tick):
            spinner.angle, spinner.speed, spinner.turns = 0.0, 0.0, 0
            spinner.tick, spinner.offset = world.tick, 0.0
    set_next_clock(world, geometry, tick)
