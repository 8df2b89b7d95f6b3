"""The public view of a world: balls, paddles and events as named tuples.

Positions are (x, y, z) [u]: x runs up the table, z to the player's right, y is the height of the board.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from silverball.physics.records import GUTTER, NOTHING, OTHER_BALL, EventKind

KIND_NAMES = {kind.value: kind.name.lower() for kind in EventKind}
SPECIAL_PARTS = {NOTHING: "", GUTTER: "gutter", OTHER_BALL: "ball"}

Vector = tuple[float, float, float]


class BallState(NamedTuple):
    """A ball on the board.

    Attributes:
        id: 1, 2, 3, … in the order of creation.
        position: Centre (x, y, z) [u].
        velocity: (vx, 0, vz) [u/s].
        spin: Angular velocity about x, y and z [rad/s]; zero on a table without friction.

    Examples:
        >>> import silverball as sb
        >>> ball = sb.World("classic").create_ball(position=(2.0, 1.5))
        >>> ball.id, ball.position
        (1, (2.0, 1.0, 1.5))
    """

    id: int
    position: Vector
    velocity: Vector
    spin: Vector


class PaddleState(NamedTuple):
    """A paddle; paddles to the left and to the right report mirrored values, so that lifting is positive.

    Attributes:
        angle: From the horizontal towards up [rad].
        angular_velocity: Positive while lifting [rad/s].

    Examples:
        >>> import silverball as sb
        >>> world = sb.World("classic")
        >>> world.step(left=True, ticks=240)
        >>> left, right = world.paddles
        >>> left.angle > right.angle
        True
    """

    angle: float
    angular_velocity: float


class Event(NamedTuple):
    """Something that happened to a ball.

    Attributes:
        kind: "hit" (a contact above `Board.hit_speed`), "touch" (a slower one, or a passage threw it back),
            "ball_hit" and "ball_touch" (the same with another ball),
            "gutter" (the ball left, or fell into a drain), "created", "jitter"
            (it was shoved), "jam" (it was pinched, and stopped), "pass" (it crossed a sensor, passage or
            spinner), "spin" (a spinner made a turn), "captured" (a hole or plunger holds it), "released"
            (that sent it off), or "reset" (a drop target has come back).
        part: The part's path in the table, for example "cylinder[1]"; for the borders and paddles
            "board.left", "board.right", "board.top", "paddle.left", "paddle.right"; else "gutter", "ball",
            or "" for none.
        ball: The ball's id; 0 for "spin" and "reset".
        tick: The tick in which it happened, counted from 0.
        offset: Time since that tick began [s].
        position: The ball's centre (x, y, z) [u].
        normal: Unit normal (x, 0, z) from the part to the ball; for jitter the direction of the shove.
        speed: Speed of approach along the normal, relative to the surface [u/s]; for jitter the speed that
            the shove adds.

    Examples:
        >>> import silverball as sb
        >>> world = sb.World("classic")
        >>> ball = world.create_ball(position=(9.0, 0.0), velocity=(5.0, 0.0))
        >>> world.step(ticks=60)
        >>> [(event.kind, event.part) for event in world.events]
        [('created', ''), ('hit', 'board.top')]
    """

    kind: str
    part: str
    ball: int
    tick: int
    offset: float
    position: Vector
    normal: Vector
    speed: float


def read_balls(world: Any, height: float) -> tuple[BallState, ...]:
    """Return the balls of a world record, in the order of its slots, at a height y [u]."""
    return tuple(
        BallState(
            id_,
            (x, height, z),
            (vx, 0.0, vz),
            (spin_x, spin_y, spin_z),
        )
        for x, z, vx, vz, spin_x, spin_y, spin_z, id_, *_ in world["ball"].tolist()
        if id_ != 0
    )


def read_paddles(world: Any, count: int) -> tuple[PaddleState, ...]:
    """Return the first `count` paddles of a world record."""
    return tuple(PaddleState(angle, velocity) for angle, _, velocity in world["paddle"][:count].tolist())


def read_events(log: Any, names: tuple[str, ...], height: float) -> tuple[Event, ...]:
    """Return the events of a LOG record, with the names of the parts, at a height y [u]."""
    return tuple(
        Event(
            KIND_NAMES[kind],
            names[part] if part >= 0 else SPECIAL_PARTS[part],
            ball,
            tick,
            offset,
            (x, height, z),
            (nx, 0.0, nz),
            speed,
        )
        for kind, part, ball, tick, offset, x, z, nx, nz, speed in log["event"][: log["count"]].tolist()
    )
