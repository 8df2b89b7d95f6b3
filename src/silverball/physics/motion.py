"""The motion of a ball over the playfield: it slides, rolls or slips.

A ball of radius r with velocity v and spin ω touches the playfield with its lowest point, which moves with

    u = v + ω × (−r·ŷ) = (vx + r·ω_z, vz − r·ω_x).

While u ≠ 0 the ball *slips*: friction accelerates it by f = −μ·p·u/|u| (p: normal force per unit mass)
and turns it, so that u changes by g + 7/2·f. Once u = 0 the ball *rolls*: friction f = −2/7·g
maintains that, which leaves 5/7 of gravity. On a table without friction the ball *slides* with all of g.

The slip direction is kept constant during a flight, which lasts at most one tick. So the flight stays a
parabola, and friction never pushes along the slip: the slip along this direction does not reverse before the
flight ends. The error: in a tick h gravity turns the slip by at most g·h/|u|, and friction by as much. Where
a slip ends, its remaining transverse part, at most g·h, is removed at once and the ball rolls. Both errors go
to zero with the tick.

Source of 2/7 and 5/7: the moment of inertia 2/5·m·r² of a solid sphere; e.g. A. Sommerfeld, "Mechanics"
(1952), § on the billiard ball. The spin about y acts on a point and does not change.

The fields of a flight in a BALL record. The last column is what holds at the start of a tick, for a ball in
play:

    field         written by                  read by                at the start of a tick
    ------------  --------------------------  ---------------------  ------------------------------------
    x … vz        advance_to, bounces         everything             = state_at(age), bit for bit
    spin_*        advance_to, bounces         bounces, slip          belongs to the same moment as x … vz
    start_*       start_flight                state_at               the state in which the flight started
    accel_x, _z   start_flight                state_at, searches     constant during the flight
    motion        start_flight, hold_still    everything             SLIDING, SLIPPING or ROLLING; never HELD
    roll_age      start_flight                find_contact           the age at which a slip ends, or NEVER
    ticks         start_flight,               advance_ticks,         ticks since the start of the tick in
                  advance_ticks               validation             which the flight started
    offset        start_flight                advance_ticks,         how far into that tick it started [s]
                                              validation
    age           start_flight,               everything             = ticks · tick − offset
                  advance_ticks
    contact_age   find_contact,               searches, skip-ahead   ≥ age: there is no contact with a
                  reset_search                                       stationary part before this age
    contact_row   find_contact,               searches, skip-ahead   what is met at contact_age: a row,
                  reset_search                                       GUTTER or ROLL_START; NOTHING: none is
                                                                     known, search on from contact_age
    search_age    start_flight, search_from   reset_search           the age from which it is searched: 0, or
                                                                     when a collider last came or went
    passed_*      start_flight, crossings     find_contact           the age and row of the last crossing
    solid_*       find_contact,               find_contact           on boards with sensors: contact_* without
                  reset_search                                       crossings

`start_flight` stands for `hold_still` and `restart_slip` too, which start flights in the same way. Within a
tick `age` stays that of the tick's start, so a contact is due at the time  contact_age − age  of the tick. A
flight that started within the tick has age = −offset.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.bounce import clamp_speed
from silverball.physics.flight import state_at
from silverball.physics.for_devices import for_devices, level_of
from silverball.physics.kernel import as_int, inlined, internal
from silverball.physics.records import NOTHING, BallMotion, BallRecord, BoardRecord, Motion
from silverball.physics.tolerances import MIN_SLIP_SPEED, NEVER

ROLLING_SHARE = 5.0 / 7.0  # acceleration of a rolling ball, as a share of that of a sliding one
SLIP_DECAY_FACTOR = 3.5  # d(slip)/dt = 3.5 × friction: 1 from the ball's velocity, 5/2 from its spin
TIME_TOLERANCE = 1.0 + 1e-9  # allows for the rounding of a time


@inlined
def store(ball: BallRecord, at: BallMotion) -> None:
    """Write a ball's position and velocity into its record."""
    ball.x, ball.z, ball.vx, ball.vz = at.x, at.z, at.vx, at.vz


@internal
def clear_ball(ball: BallRecord) -> None:
    """Set all fields of a ball's slot to zero: the slot is empty."""
    ball.x, ball.z, ball.vx, ball.vz = 0.0, 0.0, 0.0, 0.0
    ball.spin_x, ball.spin_y, ball.spin_z = 0.0, 0.0, 0.0
    ball.id = 0
    ball.start_x, ball.start_z, ball.start_vx, ball.start_vz = 0.0, 0.0, 0.0, 0.0
    ball.accel_x, ball.accel_z, ball.motion, ball.roll_age = 0.0, 0.0, 0, 0.0
    ball.ticks, ball.offset, ball.age, ball.contact_age, ball.contact_row = 0, 0.0, 0.0, 0.0, 0
    _clear_device_fields(ball)


@for_devices(lambda ball: None)
@inlined
def _clear_device_fields(ball: BallRecord) -> None:
    ball.level, ball.holder, ball.due_tick, ball.due_offset = 0, 0, 0, 0.0
    ball.search_age, ball.passed_age, ball.passed_row = 0.0, 0.0, 0
    ball.solid_age, ball.solid_row = 0.0, 0


@for_devices(lambda ball, level: None)
@inlined
def set_level(ball: BallRecord, level: int) -> None:
    """Put a ball on a level."""
    ball.level = level


@inlined
def start_flight(ball: BallRecord, board: BoardRecord, offset: float) -> None:
    """Start a new flight from the state in the ball's record, `offset` [s] into the tick."""
    _set_start(ball, offset)
    level = level_of(ball)
    if board.level_normal[level] == 0.0:
        ball.accel_x, ball.accel_z = board.level_x[level], board.level_z[level]
        ball.motion, ball.roll_age = as_int(Motion.SLIDING), NEVER
    else:
        choose_motion(ball, board)


@internal
def hold_still(ball: BallRecord, offset: float) -> None:
    """Hold a ball at its recorded position, from `offset` [s] into the tick until `release`."""
    _set_start(ball, offset)
    ball.accel_x, ball.accel_z, ball.motion = 0.0, 0.0, as_int(Motion.HELD)
    ball.roll_age, ball.contact_age = NEVER, NEVER


@inlined
def is_fixed(ball: BallRecord) -> bool:
    """Whether a ball does not move whatever meets it."""
    return ball.motion in (Motion.HELD, Motion.CAPTURED)


@internal
def capture(ball: BallRecord, row: int, x: float, z: float, offset: float) -> None:
    """Hold a ball at (x, z) for the device in a row, from `offset` [s] into the tick until it lets it go."""
    ball.x, ball.z, ball.vx, ball.vz = x, z, 0.0, 0.0
    ball.spin_x, ball.spin_y, ball.spin_z = 0.0, 0.0, 0.0
    _set_start(ball, offset)
    ball.accel_x, ball.accel_z, ball.motion, ball.roll_age = 0.0, 0.0, as_int(Motion.CAPTURED), NEVER
    ball.holder, ball.due_tick, ball.due_offset = row, 0, 0.0


@internal
def set_free(ball: BallRecord, board: BoardRecord, offset: float) -> None:
    """Let a captured ball fly from the state in its record, from `offset` [s] into the tick on."""
    _leave_holder(ball)
    start_flight(ball, board, offset)


@for_devices(lambda ball: None)
@inlined
def _leave_holder(ball: BallRecord) -> None:
    ball.holder, ball.due_tick, ball.due_offset = 0, 0, 0.0


@inlined
def release(ball: BallRecord, board: BoardRecord, tick: float) -> None:
    """Let a held ball move again from the end of the tick."""
    if ball.motion == Motion.HELD:
        start_flight(ball, board, tick)


@inlined
def restart_slip(ball: BallRecord, board: BoardRecord) -> None:
    """Start a new flight with the present slip direction of a slipping ball, which is valid for one tick."""
    if ball.motion == Motion.SLIPPING and ball.id != 0:
        _set_start(ball, 0.0)
        choose_motion_inlined(ball, board)


@inlined
def _set_start(ball: BallRecord, offset: float) -> None:
    """Make the state in the ball's record the start of a flight, `offset` [s] into the tick."""
    ball.start_x, ball.start_z, ball.start_vx, ball.start_vz = ball.x, ball.z, ball.vx, ball.vz
    ball.ticks, ball.offset, ball.age = 0, offset, -offset
    _search_from_start(ball)
    reset_search(ball)


@for_devices(lambda ball: None)
@inlined
def _search_from_start(ball: BallRecord) -> None:
    ball.search_age, ball.passed_age, ball.passed_row = 0.0, 0.0, NOTHING


@inlined
def reset_search(ball: BallRecord) -> None:
    """Discard the known next contact: the flight is searched again from its `search_age`."""
    ball.contact_age, ball.contact_row = _reset_solid(ball), NOTHING


@for_devices(lambda ball: 0.0)
@inlined
def _reset_solid(ball: BallRecord) -> float:
    """Discard the next contact that is no crossing; return the age from which the flight is searched."""
    ball.solid_age, ball.solid_row = ball.search_age, NOTHING
    return float(ball.search_age)


@inlined
def search_from(ball: BallRecord, age: float) -> None:
    """Search for contacts from an age of the flight on, after a collider has come or gone."""
    ball.search_age = max(age, 0.0)
    reset_search(ball)


@internal
def choose_motion(ball: BallRecord, board: BoardRecord) -> None:
    """Do what `choose_motion_inlined` does, without being compiled into every caller."""
    choose_motion_inlined(ball, board)


@inlined
def choose_motion_inlined(ball: BallRecord, board: BoardRecord) -> None:
    """Set whether a ball on a playfield with friction slips or rolls, and its acceleration.

    Along its direction the slip decreases from |u| at the rate  7/2·μ·p − g·u/|u|.
    """
    level = level_of(ball)
    pull_x, pull_z, pull = board.level_x[level], board.level_z[level], board.level_size[level]
    slip_x, slip_z = slip(ball, board)
    speed = sqrt(slip_x * slip_x + slip_z * slip_z)
    grip = board.friction * board.level_normal[level]
    ball.roll_age = NEVER
    if speed <= MIN_SLIP_SPEED:
        if pull <= SLIP_DECAY_FACTOR * grip:
            ball.motion = as_int(Motion.ROLLING)
            ball.accel_x, ball.accel_z = ROLLING_SHARE * pull_x, ROLLING_SHARE * pull_z
            return
        # Too smooth to roll: the ball starts to slip down the slope.
        along_x, along_z = pull_x / pull, pull_z / pull
    else:
        inverse = 1.0 / speed
        along_x, along_z = slip_x * inverse, slip_z * inverse
        rate = SLIP_DECAY_FACTOR * grip - (pull_x * along_x + pull_z * along_z)
        if rate > 0.0:
            ball.roll_age = speed / rate
    ball.motion = as_int(Motion.SLIPPING)
    ball.accel_x = pull_x - grip * along_x
    ball.accel_z = pull_z - grip * along_z


@inlined
def slip(ball: BallRecord, board: BoardRecord) -> tuple[float, float]:
    """Compute the velocity [u/s] of the ball's lowest point."""
    return ball.vx + board.ball_radius * ball.spin_z, ball.vz - board.ball_radius * ball.spin_x


@inlined
def advance_to(ball: BallRecord, board: BoardRecord, age: float) -> None:
    """Advance the ball's record, spin included, to an age of its flight."""
    store(ball, state_at(ball, age))
    if board.normal_accel != 0.0:
        _advance_spin(ball, board, age)


@inlined
def _set_rolling_spin(ball: BallRecord, board: BoardRecord) -> None:
    """Set the spin at which the ball's lowest point is at rest."""
    ball.spin_x, ball.spin_z = ball.vz * board.curvature, -ball.vx * board.curvature


@inlined
def _advance_spin(ball: BallRecord, board: BoardRecord, age: float) -> None:
    """Advance the spin to an age of the flight; friction f changes it by  dω/dt = 5/(2r)·(−f_z, f_x)."""
    if ball.motion == Motion.ROLLING:
        _set_rolling_spin(ball, board)
    elif ball.motion == Motion.SLIPPING:
        gain, level = 2.5 * age * board.curvature, level_of(ball)
        ball.spin_x -= gain * (ball.accel_z - board.level_z[level])
        ball.spin_z += gain * (ball.accel_x - board.level_x[level])


@internal
def start_rolling(ball: BallRecord, board: BoardRecord) -> None:
    """End the slip of a ball: an impulse −2/7·u removes the remaining slip, and the ball rolls."""
    time = ball.contact_age - ball.age
    advance_to(ball, board, ball.contact_age)
    slip_x, slip_z = slip(ball, board)
    ball.vx -= slip_x / SLIP_DECAY_FACTOR
    ball.vz -= slip_z / SLIP_DECAY_FACTOR
    _set_rolling_spin(ball, board)
    start_flight(ball, board, time)


@inlined
def advance_ticks(ball: BallRecord, board: BoardRecord, tick: float, count: int) -> None:
    """Advance a ball to the end of `count` ticks and clamp its speed; the flight continues unless clamped."""
    if ball.id == 0:
        return
    ball.ticks += count
    ball.age = ball.ticks * tick - ball.offset
    advance_to(ball, board, ball.age)
    if ball.vx * ball.vx + ball.vz * ball.vz > board.speed_cap * board.speed_cap:
        ball.vx, ball.vz = clamp_speed(ball.vx, ball.vz, board.speed_cap)
        start_flight(ball, board, 0.0)


@inlined
def is_on_flight(ball: BallRecord, tick: float) -> bool:
    """Whether the flight in a ball's record leads to its state; after an external change it does not."""
    at = state_at(ball, ball.age)
    return (
        ball.x == at.x
        and ball.z == at.z
        and ball.vx == at.vx
        and ball.vz == at.vz
        and ball.age == ball.ticks * tick - ball.offset
    )


@internal
def has_valid_motion(ball: BallRecord, board: BoardRecord, tick: float) -> bool:
    """Whether a ball moves as its board allows, on a flight that began before this tick."""
    if not (0.0 <= ball.offset <= tick * TIME_TOLERANCE and ball.age >= tick - tick * TIME_TOLERANCE):
        return False
    if not _has_valid_search(ball):
        return False
    level = level_of(ball)
    has_friction = board.level_normal[level] != 0.0
    if ball.motion == Motion.SLIPPING:
        return has_friction
    share = ROLLING_SHARE if ball.motion == Motion.ROLLING else 1.0
    if (
        ball.accel_x != share * board.level_x[level]
        or ball.accel_z != share * board.level_z[level]
        or ball.roll_age != NEVER
    ):
        return False
    if ball.motion == Motion.ROLLING:
        return has_friction and not is_slipping(ball, board)
    return ball.motion == Motion.SLIDING and not has_friction


@for_devices(lambda ball: True)
@inlined
def _has_valid_search(ball: BallRecord) -> bool:
    """Whether the searches along a flight began when it lasted already."""
    return bool(0.0 <= ball.search_age <= ball.age and 0.0 <= ball.passed_age <= ball.age)


@internal
def is_slipping(ball: BallRecord, board: BoardRecord) -> bool:
    """Whether the lowest point of a ball moves over the playfield."""
    slip_x, slip_z = slip(ball, board)
    return slip_x * slip_x + slip_z * slip_z > MIN_SLIP_SPEED * MIN_SLIP_SPEED
