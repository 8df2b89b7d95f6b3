"""The next contact of a ball, and its effect on the ball.

Contacts with stationary parts are searched for once a flight. The contact found, or the age up to which there
is none, stays in the ball's record until the flight ends. Paddles are searched for in every tick in which
they are near.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.bounce import bounce
from silverball.physics.broad_phase import cell_of, is_culled, is_near
from silverball.physics.crossing import disc_entry, line_crossing
from silverball.physics.devices import cross_sensor
from silverball.physics.event_log import log_event
from silverball.physics.flight import state_at, time_to_border, time_to_shape
from silverball.physics.for_devices import (
    for_devices,
    is_captured,
    is_solid,
    level_of,
    paddle_count,
    shares_level,
    switches_off,
)
from silverball.physics.jams import stall_at_held_ball
from silverball.physics.kernel import as_int, inlined, internal, kernel
from silverball.physics.motion import advance_to, clear_ball, start_flight, start_rolling
from silverball.physics.one_way import time_to_one_way
from silverball.physics.paddle import (
    contact_with_paddle,
    is_turning,
    omega_at,
    read_sweep,
    surface_acceleration,
    surface_velocity,
)
from silverball.physics.records import (
    GUTTER,
    NOTHING,
    NULL_EVENT,
    ROLL_START,
    BallRecord,
    BoardGeometry,
    ColliderRecord,
    Contact,
    Device,
    EventKind,
    Kind,
    Lane,
    Motion,
    Part,
    Response,
    Shape,
    WorldRecord,
)
from silverball.physics.shapes import contact_normal
from silverball.physics.switches import drop_target
from silverball.physics.tolerances import FLIGHT_STEPS, FREE_GAP


@kernel
def find_contact(geometry: BoardGeometry, ball: BallRecord, off: int, tick: float) -> None:
    """Resume the search along a ball's flight at `contact_age`, covering a distance of at most `board.skin`.

    `off` has a bit for each switch whose colliders are away. Crossings of sensors do not change the flight,
    and must not change how it is searched either: the contacts with solid rows are searched for as if there
    were no sensors, and crossings are searched for before the next of them.
    """
    if geometry.board.sensors == 0:
        ball.contact_age, ball.contact_row = next_solid(geometry, ball, off, ball.contact_age, tick)
    else:
        _find_with_sensors(geometry, ball, off, tick)


@for_devices(lambda geometry, ball, off, tick: None)
@internal
def _find_with_sensors(geometry: BoardGeometry, ball: BallRecord, off: int, tick: float) -> None:
    """Do what `find_contact` does on a board with sensors."""
    start = ball.contact_age
    if ball.solid_row == NOTHING and ball.solid_age <= start:
        ball.solid_age, ball.solid_row = next_solid(geometry, ball, off, start, tick)
    ball.contact_age, ball.contact_row = next_crossing(geometry, ball, off, max(start, ball.passed_age))


@internal
def next_crossing(geometry: BoardGeometry, ball: BallRecord, off: int, start: float) -> tuple[float, int]:
    """Find the first crossing of a sensor from an age on, before the next contact with a solid row.

    Returns:
        The age and the row; those of the solid contact, if there is no crossing before it.
    """
    board, colliders, grid = geometry.board, geometry.colliders, geometry.grid
    time, row = ball.solid_age, ball.solid_row
    if not start < time:
        return time, row
    state = state_at(ball, start)
    speed = sqrt(state.vx * state.vx + state.vz * state.vz)
    span = time - start
    travel = (speed + 0.5 * board.max_accel * span) * span + FREE_GAP
    sagitta = 0.5 * board.max_accel * span * span + FREE_GAP
    cell = cell_of(board, state.x, state.z)
    for entry in range(grid[cell], grid[cell + 1]):
        c = colliders[board.collider_first + grid[entry]]
        if c.response == Response.BOUNCE or not is_present(c, ball.level, off):
            continue
        if is_culled(c, state, speed, travel, sagitta):
            continue
        is_past_start = grid[entry] <= ball.passed_row and start == ball.passed_age
        if c.form == Shape.LINE:
            at, direction = line_crossing(c, ball, start, is_past_start, time)
            is_crossed = direction != 0
        else:
            at, is_crossed = disc_entry(c, ball, start, is_past_start, time)
        if is_crossed:
            time, row = at, int(grid[entry])
    return time, row


@inlined
def is_present(c: ColliderRecord, level: int, off: int) -> bool:
    """Whether a ball on a level can meet a collider: it is on this level too, and not away."""
    return c.levels >> level & 1 != 0 and c.switch & off == 0


@internal
def next_solid(
    geometry: BoardGeometry, ball: BallRecord, off: int, start: float, tick: float
) -> tuple[float, int]:
    """Find the next contact of a flight with a solid row, the gutter or the start of a roll, from an age on.

    The flight of a slipping ball is searched to the end of the tick only, where it ends. At equal times the
    row that comes first wins, also on a mirrored table that lists its parts in the same order.

    Returns:
        The age and what is met there; or an age up to which nothing is met, and NOTHING.
    """
    board, colliders, grid = geometry.board, geometry.colliders, geometry.grid
    state = state_at(ball, start)
    speed = sqrt(state.vx * state.vx + state.vz * state.vz)
    span = board.search_time
    if ball.motion == Motion.SLIPPING:
        span = min(span, max(ball.age + tick - start, 0.0))
    max_mean_speed = speed + 0.5 * board.max_accel * span
    if max_mean_speed * span > board.skin:
        span = board.skin / max_mean_speed
    time, row = start + span, NOTHING
    if ball.roll_age < time:
        time, row = max(ball.roll_age, start), ROLL_START
    sagitta = 0.5 * board.max_accel * span * span  # upper bound of the distance from the straight line
    travel = max_mean_speed * span

    if state.z - travel < board.low_z:
        at = start + time_to_border(state.z - board.low_z, state.vz, ball.accel_z)
        if at < time:
            time, row = at, as_int(Part.LEFT_WALL)
    if state.z + travel > board.high_z:
        at = start + time_to_border(board.high_z - state.z, -state.vz, -ball.accel_z)
        if at < time:
            time, row = at, as_int(Part.RIGHT_WALL)
    if state.x + travel > board.top_x:
        at = start + time_to_border(board.top_x - state.x, -state.vx, -ball.accel_x)
        if at < time:
            time, row = at, as_int(Part.TOP_WALL)
    if state.x - travel < board.gutter:
        at = start + time_to_border(state.x - board.gutter, state.vx, ball.accel_x)
        if at < time:
            time, row = at, GUTTER

    reach = board.ball_radius + FREE_GAP
    cell = cell_of(board, state.x, state.z)
    for entry in range(grid[cell], grid[cell + 1]):
        index = board.collider_first + grid[entry]
        if not is_solid(colliders[index], ball, off):
            continue
        if is_culled(colliders[index], state, speed, reach + travel, reach + sagitta):
            continue
        at, is_hit = time_to_collider(colliders[index], ball, board.ball_radius, start, time)
        if at < time:
            time, row = at, index - board.collider_first if is_hit else NOTHING
    return time, row


@for_devices(lambda c, ball, radius, start, limit: time_to_shape(c, ball, radius, start, limit))  # noqa: PLW0108
@inlined
def time_to_collider(
    c: ColliderRecord, ball: BallRecord, radius: float, start: float, limit: float
) -> tuple[float, bool]:
    """Find when a ball meets a collider, as `time_to_shape` does; no plain board has one-way colliders."""
    if c.one_way != 0:
        return time_to_one_way(c, ball, radius, start, limit)
    return time_to_shape(c, ball, radius, start, limit)


@internal
def first_contact(
    lane: Lane, geometry: BoardGeometry, ball: BallRecord, start: float, limit: float, tick: float
) -> Contact:
    """Find the first contact of a ball between two times of the tick [s].

    At equal times a stationary part comes before a paddle, and paddles follow each other in their order. The
    normal is set for paddles only; that of a stationary part is computed in `resolve`.
    """
    if ball.id == 0 or is_captured(ball):
        return Contact(limit, NOTHING, 0.0, 0.0)
    searches = 0
    while ball.contact_row == NOTHING and ball.contact_age < ball.age + limit:
        if searches == FLIGHT_STEPS:
            return Contact(start, NULL_EVENT, 0.0, 0.0)
        find_contact(geometry, ball, switches_off(lane.world), tick)
        searches += 1
    board, colliders = geometry.board, geometry.colliders
    best = Contact(limit, NOTHING, 0.0, 0.0)
    if ball.contact_row != NOTHING:
        time = max(ball.contact_age - ball.age, start)
        if time < limit:
            best = Contact(time, ball.contact_row, 0.0, 0.0)
    state = state_at(ball, ball.age + start)
    span = best.time - start
    if state.x + span * (min(state.vx, 0.0) - board.max_accel * span) > board.paddle_top:
        return best
    speed = sqrt(state.vx * state.vx + state.vz * state.vz)
    travel = span * (speed + board.max_accel * span)
    for number in range(paddle_count(ball, board)):
        row = number + Part.FIRST_PADDLE
        c = colliders[board.collider_first + row]
        if not shares_level(c, ball):
            continue
        if is_near(state.x, state.z, c.sweep_x, c.sweep_z, c.sweep_reach + travel):
            sweep = read_sweep(lane.scratch.sweep[number])
            best = contact_with_paddle(c, row, sweep, ball, board.ball_radius, speed, start, best)
    return best


@internal
def resolve(lane: Lane, geometry: BoardGeometry, ball: BallRecord, contact: Contact, tick: float) -> None:
    """Apply a contact: the ball bounces, crosses a sensor, starts to roll, or leaves through the gutter."""
    world, board, time = lane.world, geometry.board, contact.time
    if contact.row == NULL_EVENT:
        return
    if contact.row == ROLL_START:
        start_rolling(ball, board)
        return
    if contact.row >= 0 and is_sensor(geometry, ball, contact.row):
        cross_sensor(lane, geometry, ball, contact.row, tick)
        return
    if ball.motion == Motion.HELD:
        stall_at_held_ball(lane, geometry, ball, contact)
        return
    advance_to(ball, board, ball.age + time)
    if contact.row == GUTTER:
        world.drained += 1
        contact = Contact(time, as_int(GUTTER), 1.0, 0.0)
        log_event(lane.log, as_int(EventKind.GUTTER), ball, world.tick, contact.row, contact, -ball.vx)
        clear_ball(ball)
        return
    c = geometry.colliders[board.collider_first + contact.row]
    nx, nz, ux, uz = contact.nx, contact.nz, 0.0, 0.0
    acceleration = board.level_size[level_of(ball)]
    if contact.row < Part.FIRST_PADDLE:
        nx, nz = c.inward_x, c.inward_z
    elif contact.row >= board.shape_first:
        nx, nz = contact_normal(c, ball)
    else:
        paddle = read_sweep(lane.scratch.sweep[contact.row - Part.FIRST_PADDLE])
        if is_turning(paddle):
            at_x, at_z = ball.x - board.ball_radius * nx, ball.z - board.ball_radius * nz
            ux, uz = surface_velocity(c, omega_at(paddle, time), at_x, at_z)
            acceleration += surface_acceleration(c, paddle, time)
    contact = Contact(time, contact.row, nx, nz)
    speed = bounce(ball, board, c, contact, ux, uz, acceleration)
    kind = as_int(EventKind.TOUCH)
    if speed > c.hit_speed:
        kind = as_int(EventKind.HIT)
        world.score += c.points
        lane.tally[c.part] += 1
        count_hit(world, c.kind)
    else:
        world.touches += 1
    log_event(lane.log, kind, ball, world.tick, c.part, contact, speed)
    start_flight(ball, board, time)
    if c.role == Device.DROP_TARGET and kind == EventKind.HIT:
        drop_target(lane, geometry, c, time, tick)


@for_devices(lambda geometry, ball, row: False)
@inlined
def is_sensor(geometry: BoardGeometry, ball: BallRecord, row: int) -> bool:
    """Whether balls pass a row instead of bouncing off it."""
    board = geometry.board
    return board.sensors != 0 and geometry.colliders[board.collider_first + row].response != Response.BOUNCE


@internal
def count_hit(world: WorldRecord, kind: int) -> None:
    """Count a hit by the kind of the part."""
    if kind == Kind.WALL:
        world.wall_hits += 1
    elif kind == Kind.SLANT_WALL:
        world.slant_wall_hits += 1
    elif kind == Kind.PADDLE:
        world.paddle_hits += 1
    elif kind == Kind.TRIANGULAR_PRISM:
        world.triangular_prism_hits += 1
    elif kind == Kind.CYLINDER:
        world.cylinder_hits += 1
