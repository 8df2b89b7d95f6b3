"""One moment of play as plain values: all that the drawing needs to know about a world.

Nothing else of a world is read, so a table can be drawn before the physics is loaded.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from silverball.table import Table

if TYPE_CHECKING:
    from silverball.world import World


class BallAt(NamedTuple):
    """A ball in a picture: its id, and its centre (x, z) [u]."""

    id: int
    x: float
    z: float


class Moment(NamedTuple):
    """The state of play at one time.

    Attributes:
        time: Since the world was created [s].
        balls: The balls on the board.
        angles: Of the left and the right paddle, up is positive [deg].
        score: Points so far.
    """

    time: float
    balls: tuple[BallAt, ...]
    angles: tuple[float, float]
    score: int

    @classmethod
    def of(cls, world: World) -> Self:
        """The present moment of a world."""
        return cls.of_record(world.records[0], world.tick_rate)

    @classmethod
    def of_record(cls, record: Any, tick_rate: int) -> Self:
        """The moment of a WORLD record; `tick_rate` is in ticks per second."""
        from silverball.world.events import read_balls, read_paddles

        balls = tuple(BallAt(ball.id, ball.position[0], ball.position[2]) for ball in read_balls(record, 0.0))
        left, right = (math.degrees(paddle.angle) for paddle in read_paddles(record, 2))
        return cls(int(record["tick"]) / tick_rate, balls, (left, right), int(record["score"]))

    @classmethod
    def between(cls, first: Moment, second: Moment, share: float) -> Self:
        """Interpolate between two moments a tick apart: share 0 gives the first, 1 the second."""
        previous = {ball.id: ball for ball in first.balls}
        balls = tuple(
            ball._replace(
                x=_lerp(previous[ball.id].x, ball.x, share), z=_lerp(previous[ball.id].z, ball.z, share)
            )
            if ball.id in previous
            else ball
            for ball in second.balls
        )
        left, right = (_lerp(a, b, share) for a, b in zip(first.angles, second.angles, strict=True))
        return cls(_lerp(first.time, second.time, share), balls, (left, right), second.score)

    @classmethod
    def before(cls, table: Table) -> Self:
        """The moment before play starts: no ball, paddles at rest."""
        rest = {paddle.side: paddle.rest_angle for paddle in table.paddle}
        return cls(0.0, (), (rest.get("left", 0.0), rest.get("right", 0.0)), 0)


def _lerp(first: float, second: float, share: float) -> float:
    return first + share * (second - first)
