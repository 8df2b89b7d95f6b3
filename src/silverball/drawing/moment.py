"""One moment of play as plain values: all that the drawing needs to know about a world.

Nothing else of a world is read, so a table can be drawn before the physics is loaded.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from silverball.drawing.layout import Layout
from silverball.drawing.moving import Motion, moving_parts, pose_angle
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.world import World


class BallAt(NamedTuple):
    """A ball in a picture.

    Attributes:
        id: Its id.
        x: Its centre [u].
        z: Its centre [u].
        level: The level on which it rolls.
        is_held: Whether a hole holds it.
    """

    id: int
    x: float
    z: float
    level: int = 0
    is_held: bool = False


class Moment(NamedTuple):
    """The state of play at one time.

    Attributes:
        time: Since the world was created [s].
        balls: The balls on the board.
        angles: Of the paddles in their order, up is positive [deg].
        score: Points so far.
        off: A bit for each switch, in the order of the parts: set while the part is away (a drop target that
            has fallen, a gate that is open).
        blades: The angles of the spinners [rad].
        charge: How far the plungers are charged, 0 to 1.
    """

    time: float
    balls: tuple[BallAt, ...]
    angles: tuple[float, ...]
    score: int
    off: int = 0
    blades: tuple[float, ...] = ()
    charge: float = 0.0

    @classmethod
    def of(cls, world: World) -> Self:
        """The present moment of a world."""
        return cls.of_record(world.records[0], world.tick_rate)

    @classmethod
    def of_record(cls, record: Any, tick_rate: int) -> Self:
        """The moment of a WORLD record; `tick_rate` is in ticks per second."""
        angles = tuple(math.degrees(angle) for angle in record["paddle"]["angle"].tolist())
        time = int(record["tick"]) / tick_rate
        return cls(time, _balls(record), angles, int(record["score"]), **_devices(record, time))

    @classmethod
    def between(cls, first: Moment, second: Moment, share: float) -> Self:
        """Interpolate between two moments a tick apart: share 0 gives the first, 1 the second."""
        previous = {ball.id: ball for ball in first.balls}
        balls = tuple(
            ball._replace(
                x=_lerp(previous[ball.id].x, ball.x, share), z=_lerp(previous[ball.id].z, ball.z, share)
            )
            if ball.id in previous and previous[ball.id].is_held == ball.is_held
            else ball
            for ball in second.balls
        )
        angles = tuple(_lerp(a, b, share) for a, b in zip(first.angles, second.angles, strict=True))
        blades = tuple(_lerp(a, b, share) for a, b in zip(first.blades, second.blades, strict=True))
        charge = _lerp(first.charge, second.charge, share)
        time = _lerp(first.time, second.time, share)
        return cls(time, balls, angles, second.score, second.off, blades, charge)

    @classmethod
    def before(cls, table: Table) -> Self:
        """The moment before play starts: no ball, paddles at rest."""
        parts = moving_parts(Layout.of(table))
        return cls(0.0, (), tuple(pose_angle(part, 0) for part in parts if part.motion is Motion.TURNING), 0)


def _balls(record: Any) -> tuple[BallAt, ...]:
    """The balls of a WORLD record."""
    balls = record["ball"]
    return tuple(
        BallAt(int(ball["id"]), float(ball["x"]), float(ball["z"])) for ball in balls[balls["id"] != 0]
    )


def _devices(record: Any, time: float) -> dict[str, Any]:
    """The fields of a moment about drop targets, gates, spinners and plungers of a WORLD record."""
    return {}


def _lerp(first: float, second: float, share: float) -> float:
    return first + share * (second - first)
