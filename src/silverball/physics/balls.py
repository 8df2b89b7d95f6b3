"""Creating, shoving and separating balls.

A new ball is tried at random places first (as in the original), then at the origin, then systematically in
every place. If nothing is free, it is refused, and nothing changes, not even the random generator. A place is
a square of the board from which the gutter can be reached (computed once per table), so a ball never appears
behind a corner wall.
"""

from __future__ import annotations

from math import sqrt

from silverball.physics.bounce import clamp_speed
from silverball.physics.captures import free_plunger
from silverball.physics.contact import is_present
from silverball.physics.event_log import flight_checksum, log_event, store_checksum
from silverball.physics.for_devices import for_devices, is_captured, level_of, switches_off
from silverball.physics.kernel import as_int, internal, kernel
from silverball.physics.motion import capture, set_level, start_flight
from silverball.physics.paddle import paddle_distance
from silverball.physics.portable_math import sine_cosine, uniform
from silverball.physics.records import (
    NOTHING,
    BallRecord,
    BoardRecord,
    Colliders,
    Contact,
    EventKind,
    LogRecord,
    Outcome,
    Part,
    Places,
    Response,
    WorldRecord,
)
from silverball.physics.shapes import distance
from silverball.physics.tolerances import CREATE_TRIES, FREE_GAP, MAX_DEPTH, PLACE_STEPS

TWO_PI = 6.283185307179586


@kernel
def clearance(
    world: WorldRecord, board: BoardRecord, colliders: Colliders, x: float, z: float, level: int
) -> tuple[float, int]:
    """Compute the smallest gap [u] between a ball at (x, z) on a level and the parts, and which part it is.

    Sensors and parts that are away do not count, nor do one-way parts, which a ball may overlap.
    """
    first, off = board.collider_first, switches_off(world)
    left, right, top = colliders[first], colliders[first + Part.RIGHT_WALL], colliders[first + Part.TOP_WALL]
    smallest, part = z - left.z, as_int(Part.LEFT_WALL)
    if right.z - z < smallest:
        smallest, part = right.z - z, as_int(Part.RIGHT_WALL)
    if top.x - x < smallest:
        smallest, part = top.x - x, as_int(Part.TOP_WALL)
    for index in range(first + Part.FIRST_PADDLE, board.collider_end):
        c = colliders[index]
        if c.response != Response.BOUNCE or c.one_way != 0 or not is_present(c, level, off):
            continue
        if index < first + board.shape_first:
            gap, _, _ = paddle_distance(c, world.paddle[index - first - Part.FIRST_PADDLE].angle, x, z)
        else:
            gap, _, _ = distance(c, x, z)
        if gap < smallest:
            smallest, part = gap, int(c.part)
    return smallest - board.ball_radius, part


@kernel
def clearance_of_balls(world: WorldRecord, board: BoardRecord, x: float, z: float, level: int) -> float:
    """Compute the smallest gap [u] between a ball at (x, z) on a level and the balls on it."""
    smallest = 1e300
    for index in range(len(world.ball)):
        ball = world.ball[index]
        if ball.id != 0 and level_of(ball) == level:
            gap = sqrt((ball.x - x) ** 2 + (ball.z - z) ** 2) - 2.0 * board.ball_radius
            smallest = min(smallest, gap)
    return smallest


@internal
def is_free(world: WorldRecord, board: BoardRecord, colliders: Colliders, x: float, z: float) -> bool:
    """Whether a ball at (x, z) would overlap nothing."""
    if x <= board.gutter + board.ball_radius:
        return False
    gap, _ = clearance(world, board, colliders, x, z, as_int(0))
    return gap >= FREE_GAP and clearance_of_balls(world, board, x, z, as_int(0)) >= FREE_GAP


@internal
def find_free_place(
    world: WorldRecord, board: BoardRecord, colliders: Colliders, places: Places
) -> tuple[bool, float, float, int]:
    """Find a free place for a ball.

    Returns:
        Whether there is one, its x and z [u], and the draws of the world's random generator after that.
    """
    count = board.place_end - board.place_first
    size = board.place_size
    draws = world.draws
    if count > 0:
        for _ in range(CREATE_TRIES):
            place = board.place_first + int(uniform(world.seed, draws) * count)
            x = places[place, 0] + size * (uniform(world.seed, draws + 1) - 0.5)
            z = places[place, 1] + size * (uniform(world.seed, draws + 2) - 0.5)
            draws += 3
            if is_free(world, board, colliders, x, z):
                return True, x, z, draws
    if board.place_lowest < 0.0 and is_free(world, board, colliders, 0.0, 0.0):
        return True, 0.0, 0.0, draws
    for place in range(board.place_first, board.place_end):
        for step in range(PLACE_STEPS * PLACE_STEPS):
            x = places[place, 0] + size * ((step // PLACE_STEPS + 0.5) / PLACE_STEPS - 0.5)
            z = places[place, 1] + size * ((step % PLACE_STEPS + 0.5) / PLACE_STEPS - 0.5)
            if is_free(world, board, colliders, x, z):
                return True, x, z, draws
    return False, 0.0, 0.0, world.draws


@kernel
def put_ball(
    world: WorldRecord,
    board: BoardRecord,
    log: LogRecord,
    slot: int,
    x: float,
    z: float,
    vx: float,
    vz: float,
) -> None:
    """Create a ball at (x, z) with a velocity, in an empty slot of the world."""
    is_known = flight_checksum(world, board) == log.checksum
    world.created += 1
    ball = world.ball[slot]
    ball.x, ball.z, ball.vx, ball.vz = x, z, vx, vz
    ball.spin_x, ball.spin_y, ball.spin_z = 0.0, 0.0, 0.0
    ball.id = world.created
    set_level(ball, as_int(0))
    start_flight(ball, board, 0.0)
    if is_known:
        store_checksum(world, board, log)
    contact = Contact(0.0, as_int(NOTHING), 0.0, 0.0)
    log_event(log, as_int(EventKind.CREATED), ball, world.tick, contact.row, contact, 0.0)


@kernel
def empty_slot(world: WorldRecord, board: BoardRecord) -> int:
    """Find the first slot without a ball; −1 if the board holds as many as the table allows."""
    for slot in range(board.max_balls):
        if world.ball[slot].id == 0:
            return slot
    return -1


@kernel
def create_ball(
    world: WorldRecord, board: BoardRecord, colliders: Colliders, places: Places, log: LogRecord
) -> int:
    """Create a ball at rest in a free place; on a board with plungers, on one of them.

    Returns:
        An `Outcome`: CREATED, or why not (then nothing is changed).
    """
    slot = empty_slot(world, board)
    if slot < 0:
        return as_int(Outcome.BOARD_FULL)
    if board.plungers != 0:
        return create_on_plunger(world, board, colliders, log, slot)
    found, x, z, draws = find_free_place(world, board, colliders, places)
    if not found:
        return as_int(Outcome.NO_ROOM)
    world.draws = draws
    put_ball(world, board, log, slot, x, z, 0.0, 0.0)
    return as_int(Outcome.CREATED)


@for_devices(lambda world, board, colliders, log, slot: as_int(Outcome.NO_ROOM))
@internal
def create_on_plunger(
    world: WorldRecord, board: BoardRecord, colliders: Colliders, log: LogRecord, slot: int
) -> int:
    """Create a ball on a plunger, in an empty slot; return an `Outcome`."""
    row = free_plunger(world, board, colliders)
    if row < 0:
        return as_int(Outcome.NO_ROOM)
    c = colliders[board.collider_first + row]
    level = as_int(0)
    while c.levels >> level & 1 == 0:
        level += 1
    gap, _ = clearance(world, board, colliders, c.x, c.z, level)
    if gap < -MAX_DEPTH:
        return as_int(Outcome.NO_ROOM)
    is_known = flight_checksum(world, board) == log.checksum
    put_ball(world, board, log, slot, c.x, c.z, 0.0, 0.0)
    world.ball[slot].level = level
    capture(world.ball[slot], row, c.x, c.z, 0.0)
    if is_known:
        store_checksum(world, board, log)
    return as_int(Outcome.CREATED)


@internal
def shove_balls(world: WorldRecord, board: BoardRecord, log: LogRecord) -> None:
    """Jitter: give every ball on the board an impulse of fixed size in a random direction of its own."""
    for slot in range(len(world.ball)):
        ball = world.ball[slot]
        if ball.id == 0 or is_captured(ball):
            continue
        sine, cosine = sine_cosine(TWO_PI * uniform(world.seed, world.draws))
        world.draws += 1
        ball.vx += board.jitter * sine
        ball.vz += board.jitter * cosine
        ball.vx, ball.vz = clamp_speed(ball.vx, ball.vz, board.speed_cap)
        start_flight(ball, board, 0.0)
        contact = Contact(0.0, as_int(NOTHING), sine, cosine)
        log_event(log, as_int(EventKind.JITTER), ball, world.tick, contact.row, contact, board.jitter)


@kernel
def separate_balls(world: WorldRecord, board: BoardRecord, colliders: Colliders) -> bool:
    """Move overlapping balls apart, each pair by half of its overlap.

    Only a state that was modified externally can hold an overlap; an exact step never makes one.

    Returns:
        Whether all balls are apart now; False if that would push one into a part or into a third ball. A
        pair that cannot be moved apart is not changed.
    """
    for other in range(1, board.max_balls):
        for one in range(other):
            if not _separate_pair(world, board, colliders, world.ball[one], world.ball[other]):
                return False
    for other in range(1, board.max_balls):
        for one in range(other):
            a, b = world.ball[one], world.ball[other]
            dx, dz = a.x - b.x, a.z - b.z
            reach = 2.0 * board.ball_radius - FREE_GAP
            if a.id != 0 and b.id != 0 and level_of(a) == level_of(b) and dx * dx + dz * dz < reach * reach:
                return False
    return True


@internal
def _separate_pair(
    world: WorldRecord, board: BoardRecord, colliders: Colliders, a: BallRecord, b: BallRecord
) -> bool:
    """Move two balls apart if they overlap; return whether they are apart now."""
    if a.id == 0 or b.id == 0 or level_of(a) != level_of(b):
        return True
    dx, dz = a.x - b.x, a.z - b.z
    apart = sqrt(dx * dx + dz * dz)
    overlap = 2.0 * board.ball_radius - apart
    if overlap <= FREE_GAP:
        return True
    nx, nz = (dx / apart, dz / apart) if apart > 0.0 else (0.0, 1.0)
    shift = 0.5 * (overlap + FREE_GAP)
    ax, az, bx, bz = a.x + shift * nx, a.z + shift * nz, b.x - shift * nx, b.z - shift * nz
    gap_a, _ = clearance(world, board, colliders, ax, az, level_of(a))
    gap_b, _ = clearance(world, board, colliders, bx, bz, level_of(b))
    if gap_a < 0.0 or gap_b < 0.0:
        return False
    a.x, a.z, b.x, b.z = ax, az, bx, bz
    return True
