"""The cabinet: after a nudge it swings as a damped oscillator, and every ball feels its acceleration.

Walls and paddles keep their places in the cabinet's frame, in which everything is computed. There a ball that
touches nothing changes its velocity by minus the change of the cabinet's. This is done at the start of each
tick, after which the ball is on a new flight; so the search for contacts knows nothing of the cabinet. What a
ball feels in a tick is the cabinet's velocity in the middle of it, so the record holds the cabinet as it is
there.

With the angular frequency ω and the damping δ, and ω_d = √(ω² − δ²), the cabinet's place s [u] and velocity u
[u/s], both from its place at rest, are after the time h [s]

    s' = e^(−δh)·(s·cos ω_d h + (u + δ·s)/ω_d·sin ω_d h)
    u' = e^(−δh)·(u·cos ω_d h − (ω²·s + δ·u)/ω_d·sin ω_d h).

Boards with `nudge` 0 have no cabinet that moves: their fields are always zero, and are not part of the bytes
of a saved world.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.bounce import clamp_speed
from silverball.physics.event_log import log_event
from silverball.physics.for_devices import for_devices, is_captured
from silverball.physics.kernel import as_int, inlined, internal
from silverball.physics.motion import start_flight
from silverball.physics.portable_math import exp, sine_cosine
from silverball.physics.records import (
    NOTHING,
    NUDGE_LEFT,
    NUDGE_RIGHT,
    NUDGE_UP,
    BoardRecord,
    Contact,
    EventKind,
    LogRecord,
    WorldRecord,
)
from silverball.physics.tolerances import CABINET_REST, NEVER

FREQUENCY = 5.0  # [1/s] of the undamped cabinet; chosen: a heavy machine on its legs
DAMPING_RATIO = 0.35  # chosen: after the first swing back hardly anything is seen
OMEGA = 2.0 * 3.141592653589793 * FREQUENCY  # ω [1/s]
DAMPING = DAMPING_RATIO * OMEGA  # δ [1/s]
OMEGA_DAMPED = OMEGA * sqrt(1.0 - DAMPING_RATIO * DAMPING_RATIO)  # ω_d [1/s]


@for_devices(lambda world, board: False)
@inlined
def is_cabinet_moving(world: WorldRecord, board: BoardRecord) -> bool:
    """Whether the cabinet swings after a nudge."""
    if board.nudge == 0.0:
        return False
    return not (
        world.cabinet_x == 0.0
        and world.cabinet_z == 0.0
        and world.cabinet_vx == 0.0
        and world.cabinet_vz == 0.0
    )


@for_devices(lambda world, board, log, buttons, tick: None)
@internal
def nudge_cabinet(world: WorldRecord, board: BoardRecord, log: LogRecord, buttons: int, tick: float) -> None:
    """Give the cabinet the speed of a nudge in the direction of the bits, before it swings on by a tick [s].

    The record holds the cabinet half a tick ago, so it gets the motion that leads to this speed now. Each
    ball that is not held has an event, with the direction in which the ball goes from the cabinet's point of
    view: opposite to the nudge.
    """
    if board.nudge == 0.0:
        return
    push_x = 1.0 if buttons & NUDGE_UP != 0 else 0.0
    push_z = (1.0 if buttons & NUDGE_RIGHT != 0 else 0.0) - (1.0 if buttons & NUDGE_LEFT != 0 else 0.0)
    size = sqrt(push_x * push_x + push_z * push_z)
    if size == 0.0:
        return
    push_x, push_z = push_x / size, push_z / size
    place, speed = swung(0.0, board.nudge, -0.5 * tick)
    world.cabinet_x += place * push_x
    world.cabinet_z += place * push_z
    world.cabinet_vx += speed * push_x
    world.cabinet_vz += speed * push_z
    push_balls(world, board, -speed * push_x, -speed * push_z)
    contact = Contact(0.0, as_int(NOTHING), -push_x, -push_z)
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id != 0 and not is_captured(ball):
            log_event(log, as_int(EventKind.JITTER), ball, world.tick, contact.row, contact, board.nudge)


@for_devices(lambda world, board, tick: None)
@internal
def swing_cabinet(world: WorldRecord, board: BoardRecord, tick: float) -> None:
    """Swing the cabinet on by a tick, at its start, and let the balls feel how its velocity changes."""
    vx, vz = world.cabinet_vx, world.cabinet_vz
    world.cabinet_x, world.cabinet_vx = swung(world.cabinet_x, vx, tick)
    world.cabinet_z, world.cabinet_vz = swung(world.cabinet_z, vz, tick)
    reach_x, reach_z = world.cabinet_vx / OMEGA, world.cabinet_vz / OMEGA
    square = world.cabinet_x * world.cabinet_x + world.cabinet_z * world.cabinet_z
    if square + reach_x * reach_x + reach_z * reach_z < CABINET_REST * CABINET_REST:
        stop_cabinet(world)
    push_balls(world, board, vx - world.cabinet_vx, vz - world.cabinet_vz)


@internal
def swung(place: float, speed: float, time: float) -> tuple[float, float]:
    """Compute place [u] and velocity [u/s] along one axis after a time [s], which may be negative."""
    sine, cosine = sine_cosine(OMEGA_DAMPED * time)
    decay = exp(-DAMPING * time)
    new_place = decay * (place * cosine + (speed + DAMPING * place) / OMEGA_DAMPED * sine)
    pull = OMEGA * OMEGA * place + DAMPING * speed
    return new_place, decay * (speed * cosine - pull / OMEGA_DAMPED * sine)


@for_devices(lambda world: None)
@inlined
def stop_cabinet(world: WorldRecord) -> None:
    """Put the cabinet at rest at its place."""
    world.cabinet_x, world.cabinet_z, world.cabinet_vx, world.cabinet_vz = 0.0, 0.0, 0.0, 0.0


@for_devices(lambda world, board: None)
@internal
def validate_cabinet(world: WorldRecord, board: BoardRecord) -> None:
    """Make the cabinet of a world from outside a possible one: at rest, if it is not."""
    size = abs(world.cabinet_x) + abs(world.cabinet_z) + abs(world.cabinet_vx) + abs(world.cabinet_vz)
    if board.nudge == 0.0 or not size < NEVER:
        stop_cabinet(world)


@internal
def push_balls(world: WorldRecord, board: BoardRecord, vx: float, vz: float) -> None:
    """Change the velocity of every ball that nothing holds, between two ticks."""
    for slot in range(len(world.ball)):
        ball = world.ball[slot]
        if ball.id == 0 or is_captured(ball):
            continue
        ball.vx, ball.vz = clamp_speed(ball.vx + vx, ball.vz + vz, board.speed_cap)
        start_flight(ball, board, 0.0)
