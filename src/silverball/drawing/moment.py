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
    from silverball.drawing.light_shows import Running
    from silverball.game.core import GameCore
    from silverball.world import World

CAPTURED = 4  # `physics.records.Motion.CAPTURED`, repeated here because that module needs the compiler
NOTHING = -1


class BallAt(NamedTuple):
    """A ball in a picture.

    Attributes:
        id: Its id.
        x: Its centre [u].
        z: Its centre [u].
        level: The level on which it rolls.
        holder: The row of the hole or plunger that holds it; −1: none.
    """

    id: int
    x: float
    z: float
    level: int = 0
    holder: int = -1


class BladeAt(NamedTuple):
    """A spinner: its angle [rad] and angular velocity [rad/s] at the last crossing, and when that was [s]."""

    angle: float
    speed: float
    time: float


class Moment(NamedTuple):
    """The state of play at one time.

    Attributes:
        time: Since the world was created [s].
        balls: The balls on the board.
        angles: Of the paddles in their order, up is positive [deg].
        score: Points so far.
        off: A bit for each switch, in the order of the parts: set while the part is away (a drop target that
            has fallen, a gate that is open).
        blades: The spinners in their order.
        launch_held: How long the launch button has been held [s].
        cabinet: How far a nudge has moved the cabinet, up and to the right [u].
        lamps: The state of each lamp of the table, 0 off, 1 on, 2 blinking; empty: as when a game begins.
        color: The colour of lamps that have that of the mode that runs.
        show: A light show that runs whatever happens; None: those that events begin.
    """

    time: float
    balls: tuple[BallAt, ...]
    angles: tuple[float, ...]
    score: int
    off: int = 0
    blades: tuple[BladeAt, ...] = ()
    launch_held: float = 0.0
    cabinet: tuple[float, float] = (0.0, 0.0)
    lamps: tuple[int, ...] = ()
    color: str = "white"
    show: Running | None = None

    @classmethod
    def of_game(cls, game: GameCore) -> Self:
        """The present moment of a game: that of its world, with its lamps."""
        return cls.of(game.world)._replace(lamps=game.lamp_states, color=game.mode_color)

    @classmethod
    def of(cls, world: World) -> Self:
        """The present moment of a world."""
        return cls.of_record(world.records[0], world.tick_rate)

    @classmethod
    def of_record(cls, record: Any, tick_rate: int) -> Self:
        """The moment of a world record; `tick_rate` is in ticks per second."""
        tick = 1.0 / tick_rate
        has_devices = "spinner" in record.dtype.names
        blades = tuple(
            BladeAt(angle, speed, when * tick + offset)
            for angle, speed, when, offset, *_ in (record["spinner"].tolist() if has_devices else ())
        )
        return cls(
            int(record["tick"]) * tick,
            _balls(record),
            tuple(math.degrees(angle) for angle in record["paddle"]["angle"].tolist()),
            int(record["score"]),
            int(record["off"]) if has_devices else 0,
            blades,
            int(record["launch_held"]) * tick if has_devices else 0.0,
            (float(record["cabinet_x"]), float(record["cabinet_z"])) if has_devices else (0.0, 0.0),
        )

    @classmethod
    def between(cls, first: Moment, second: Moment, share: float) -> Self:
        """Interpolate between two moments a tick apart: share 0 gives the first, 1 the second."""
        previous = {ball.id: ball for ball in first.balls}
        balls = tuple(
            ball._replace(
                x=_lerp(previous[ball.id].x, ball.x, share), z=_lerp(previous[ball.id].z, ball.z, share)
            )
            if ball.id in previous and previous[ball.id].holder == ball.holder
            else ball
            for ball in second.balls
        )
        angles = tuple(_lerp(a, b, share) for a, b in zip(first.angles, second.angles, strict=True))
        held = max(second.launch_held - (1.0 - share) * (second.time - first.time), 0.0)
        time = _lerp(first.time, second.time, share)
        x, z = (_lerp(a, b, share) for a, b in zip(first.cabinet, second.cabinet, strict=True))
        return cls(*second)._replace(time=time, balls=balls, angles=angles, launch_held=held, cabinet=(x, z))

    @classmethod
    def before(cls, table: Table) -> Self:
        """The moment before play starts: no ball, paddles at rest."""
        parts = moving_parts(Layout.of(table))
        return cls(0.0, (), tuple(pose_angle(part, 0) for part in parts if part.motion is Motion.TURNING), 0)


def _balls(record: Any) -> tuple[BallAt, ...]:
    """The balls of a world record."""
    balls = record["ball"]
    has_levels = "level" in balls.dtype.names
    return tuple(
        BallAt(
            int(ball["id"]), float(ball["x"]), float(ball["z"]), int(ball["level"]) if has_levels else 0,
            int(ball["holder"]) if has_levels and ball["motion"] == CAPTURED else NOTHING,
        )
        for ball in balls[balls["id"] != 0]
    )  # fmt: skip


def _lerp(first: float, second: float, share: float) -> float:
    return first + share * (second - first)
