"""What must a picture know of a world? One moment of play, as plain values.

The drawing asks for nothing else, so that a table can be drawn before the physics is loaded.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Self

from silverball.table import Table

if TYPE_CHECKING:
    from silverball.world import World


class BallAt(NamedTuple):
    """A ball in a picture: its id, and its centre (x, z) [u]."""

    id: int
    x: float
    z: float


class Moment(NamedTuple):
    """What there is to see at one time.

    Attributes:
        time: Since the world was made [s].
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
        """The moment that a world is in."""
        left, right = world.paddles
        balls = tuple(BallAt(ball.id, ball.position[0], ball.position[2]) for ball in world.balls)
        return cls(world.time, balls, (math.degrees(left.angle), math.degrees(right.angle)), world.score)

    @classmethod
    def between(cls, first: Moment, second: Moment, share: float) -> Self:
        """What there is to see between two moments a tick apart: 0 is the first, 1 the second."""
        was = {ball.id: ball for ball in first.balls}
        balls = tuple(
            ball._replace(x=_mixed(was[ball.id].x, ball.x, share), z=_mixed(was[ball.id].z, ball.z, share))
            if ball.id in was
            else ball
            for ball in second.balls
        )
        left, right = (_mixed(a, b, share) for a, b in zip(first.angles, second.angles, strict=True))
        return cls(_mixed(first.time, second.time, share), balls, (left, right), second.score)

    @classmethod
    def before(cls, table: Table) -> Self:
        """The moment before play starts: no ball, paddles at rest."""
        rest = {paddle.side: paddle.rest_angle for paddle in table.paddle}
        return cls(0.0, (), (rest.get("left", 0.0), rest.get("right", 0.0)), 0)


def _mixed(first: float, second: float, share: float) -> float:
    return first + share * (second - first)
