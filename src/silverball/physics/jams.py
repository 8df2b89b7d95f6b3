"""Jams: balls that bounce between things too often in one tick, and the paddles that press them.

    too many events in one tick → the ball is stopped, and the paddles next to it stall
    → again in the same tick → the ball is held until the tick is over

So a ball jams twice in a tick at most. What a tick has pressed into a paddle does not add up: a paddle on a
coil turns back from every jammed ball, and where it cannot, the ball is put back.
"""

from __future__ import annotations

from silverball.physics.broad_phase import is_near
from silverball.physics.event_log import log_event
from silverball.physics.for_devices import ball_slots, paddle_count
from silverball.physics.kernel import as_int, inlined, internal
from silverball.physics.motion import advance_to, hold_still, is_fixed, start_flight
from silverball.physics.paddle import (
    angle_at,
    is_turning,
    paddle_distance,
    read_sweep,
    surface_velocity,
    write_sweep,
)
from silverball.physics.records import (
    NOTHING,
    BallRecord,
    BoardGeometry,
    ColliderRecord,
    Contact,
    EventKind,
    Lane,
    LogRecord,
    PaddleRecord,
    PaddleSweep,
    Part,
)
from silverball.physics.tolerances import JAM_GAP, JAM_SHARE, MAX_CREEP, MAX_PUT_BACK, MAX_TURN_BACK, NEVER


@internal
def stop_jammed_balls(lane: Lane, geometry: BoardGeometry, time: float, limit: int) -> None:
    """Stop the balls that have reached `limit` events in this tick, and stall the paddles next to them.

    A ball is stopped with another one if contacts between the two make up at least 1/JAM_SHARE of `limit`.
    """
    world, board, scratch = lane.world, geometry.board, lane.scratch
    jammed, partners, pair = 0, 0, 0
    for slot in range(ball_slots(world, board)):
        if scratch.ball_events[slot] >= limit:
            jammed |= 1 << slot
    for other in range(1, ball_slots(world, board)):
        for one in range(other):
            both = 1 << one | 1 << other
            if jammed & both != 0 and JAM_SHARE * scratch.pair_events[pair] >= limit:
                partners |= both
            pair += 1
    jammed |= partners
    pair = 0
    for slot in range(ball_slots(world, board)):
        is_jammed = jammed >> slot & 1 != 0
        if is_jammed:
            stop_jammed_ball(lane, geometry, slot, time, scratch.ball_jams[slot] > 0)
            scratch.ball_events[slot] = 0
            scratch.ball_jams[slot] += 1
        for one in range(slot):
            if is_jammed or jammed >> one & 1 != 0:
                scratch.pair_events[pair] = 0
            pair += 1


@internal
def stop_jammed_ball(lane: Lane, geometry: BoardGeometry, slot: int, time: float, is_repeat: bool) -> None:
    """Stop the jammed ball in a slot at a time of the tick, and stall the paddles next to it.

    A ball that jams again in the same tick, although the paddles are still, is held until the tick is over.
    So is one that an accelerating paddle leaves; the paddle goes on.
    """
    world, board, colliders = lane.world, geometry.board, geometry.colliders
    ball = world.ball[slot]
    if ball.id == 0 or is_fixed(ball):
        return
    advance_to(ball, board, ball.age + time)
    near = board.ball_radius + JAM_GAP
    first = board.collider_first + Part.FIRST_PADDLE
    is_held = is_repeat
    for index in range(paddle_count(world, board)):
        is_held |= is_leaving(
            read_sweep(lane.scratch.sweep[index]), colliders[first + index], ball, near, time
        )
    for index in range(paddle_count(world, board)):
        c = colliders[first + index]
        sweep = read_sweep(lane.scratch.sweep[index])
        if must_stall(sweep, c, ball, near, time, is_held):
            sweep = stalled(sweep, time)
        if c.lift_accel != 0.0 and not is_turning(sweep):
            sweep = turned_back(sweep, world.paddle[index], c, ball, board.ball_radius)
            put_back(lane.scratch, sweep, c, ball, slot, board.ball_radius)
        if not is_turning(sweep):
            write_sweep(lane.scratch.sweep[index], sweep, NEVER)
    ball.vx, ball.vz, ball.spin_x, ball.spin_y, ball.spin_z = 0.0, 0.0, 0.0, 0.0, 0.0
    world.jams += 1
    contact = Contact(time, as_int(NOTHING), 0.0, 0.0)
    log_event(lane.log, as_int(EventKind.JAM), ball, world.tick, contact.row, contact, 0.0)
    if is_held:
        hold_still(ball, time)
    else:
        start_flight(ball, board, time)


@internal
def put_back(
    scratch: LogRecord, paddle: PaddleSweep, c: ColliderRecord, ball: BallRecord, slot: int, radius: float
) -> None:
    """Put a ball that has sunk into a coil's paddle that stands back to where it was before the tick.

    A ball that has come further than MAX_PUT_BACK has not sunk, but was pushed.
    """
    gap, _, _ = paddle_distance(c, paddle.angle, ball.x, ball.z)
    dx, dz = ball.x - scratch.before_x[slot], ball.z - scratch.before_z[slot]
    if gap < radius - MAX_CREEP and dx * dx + dz * dz < MAX_PUT_BACK * MAX_PUT_BACK:
        ball.x, ball.z = scratch.before_x[slot], scratch.before_z[slot]


@internal
def stall_at_held_ball(lane: Lane, geometry: BoardGeometry, ball: BallRecord, contact: Contact) -> None:
    """Stop a paddle that meets a held ball: whatever meets such a ball, it does not move."""
    index = contact.row - Part.FIRST_PADDLE
    c, record = geometry.colliders[geometry.board.collider_first + contact.row], lane.scratch.sweep[index]
    sweep = stalled(read_sweep(record), contact.time)
    if c.lift_accel != 0.0:
        sweep = turned_back(sweep, lane.world.paddle[index], c, ball, geometry.board.ball_radius)
    write_sweep(record, sweep, NEVER)


@internal
def is_leaving(paddle: PaddleSweep, c: ColliderRecord, ball: BallRecord, near: float, time: float) -> bool:
    """Whether an accelerating paddle within `near` [u] of a jammed ball's centre turns away from it.

    Such a paddle starts from rest. A ball pinched between it and something else meets both again and again
    before there is a gap, so if that stopped the paddle, nothing would ever let the ball go. A paddle at
    constant speed leaves faster than a ball hops.
    """
    if paddle.alpha == 0.0 or not is_turning(paddle):
        return False
    gap, nx, nz = paddle_distance(c, angle_at(paddle, time), ball.x, ball.z)
    ux, uz = surface_velocity(c, paddle.stop - paddle.angle, ball.x - gap * nx, ball.z - gap * nz)
    return bool(gap < near and ux * nx + uz * nz < 0.0)


@internal
def must_stall(
    paddle: PaddleSweep, c: ColliderRecord, ball: BallRecord, near: float, time: float, is_held: bool
) -> bool:
    """Whether a turning paddle is within `near` [u] of a jammed ball's centre, so that it has to stop.

    If the ball is about to be held, a paddle that could reach it stops too: no paddle may run into a held
    ball.
    """
    if not is_turning(paddle) or is_leaving(paddle, c, ball, near, time):
        return False
    gap, _, _ = paddle_distance(c, angle_at(paddle, time), ball.x, ball.z)
    return bool(gap < near or (is_held and is_near(ball.x, ball.z, c.x, c.z, c.reach + near)))


@inlined
def stalled(paddle: PaddleSweep, time: float) -> PaddleSweep:
    """Stop a paddle where it is at a time of the tick."""
    return PaddleSweep(angle_at(paddle, time), 0.0, paddle.stop, 0.0)


@internal
def turned_back(
    paddle: PaddleSweep, before: PaddleRecord, c: ColliderRecord, ball: BallRecord, radius: float
) -> PaddleSweep:
    """Turn a coil's paddle that has stopped back until it only touches a jammed ball.

    A coil starts from rest in every tick in which its paddle is pressed against a jammed ball, and before the
    jam is noticed, it has pressed a little deeper, and the ball has sunk a little. This must not add up over
    many ticks. If it takes more than MAX_TURN_BACK, because the ball is in the direction of the pivot, the
    paddle turns back to where it was before the tick.
    """
    gap, nx, nz = paddle_distance(c, paddle.angle, ball.x, ball.z)
    depth = radius - gap
    if depth <= MAX_CREEP or before.angular_velocity != 0.0 or paddle.angle == before.angle:
        return paddle
    ux, uz = surface_velocity(c, 1.0, ball.x - gap * nx, ball.z - gap * nz)
    closing = ux * nx + uz * nz  # [u/rad] by which the gap closes
    angle = paddle.angle - depth / closing if depth < MAX_TURN_BACK * abs(closing) else before.angle
    angle = min(max(angle, min(c.angle_rest, c.angle_up)), max(c.angle_rest, c.angle_up))
    return PaddleSweep(angle, 0.0, paddle.stop, 0.0)
