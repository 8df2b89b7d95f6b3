"""Shots of a paddle: where they go, and how precisely they must be timed.

A ball approaches a paddle in one of two ways, as in any game: it rolls down the guide onto the resting
paddle, or it has been held on the raised paddle, which is dropped, and rolls down that. The button is pressed
at every tick of the approach, one world for each, and the shot is followed until a paddle meets it again.

Directions are in degrees from straight up the table, to the right positive. Lengths are [u], times [s].
"""

from __future__ import annotations

from enum import IntEnum
from math import atan2, hypot, isnan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.metrics.game_traces import CONTACTS, MIN_STRIKE_SPEED, TICK_RATE, TOP_ZONE, is_paddle
from silverball.physics.balls import put_ball
from silverball.physics.event_log import clear_log
from silverball.physics.kernel import as_int, kernel
from silverball.physics.records import NOTHING, BatchGeometry, BoardGeometry, EventKind, Lane, Lanes, records
from silverball.physics.step import button_bits, step_world
from silverball.table import SlantWall, Table
from silverball.world import WorldBatch

WAIT = 2.5  # [s] time on the raised paddle before that is dropped; the ball lies still by then
PRESSES = 2.0  # [s] range of the swept moments of the press
HOLD = 0.3  # [s] length of the press
AFTER = 3.0  # [s] after the press, for which a shot is followed
START = 1.5  # [u] up the guide from its lower end, where the ball is released; less on a shorter guide
CLEAR = 0.002  # [u] between the ball and the guide there
LOW, HIGH = 2.0, 5.0  # [u] the two x at which the crossing of a shot is recorded
AIM_DISTANCE = 3.0  # [u] beyond the paddles' reach: a shot is aimed at the first part met from there on
MIDDLE = 0.16  # of the board's width: a shot within this distance of the middle goes to the middle
DEGREES = 180.0 / np.pi


class Aim(IntEnum):
    """Where a shot goes."""

    NOWHERE = 0  # the ball was not struck that far, or met something on the way
    LEFT = 1
    MIDDLE = 2
    RIGHT = 3


SHOT = np.dtype(
    [
        ("press", "i8"),  # the tick of the press
        ("launched", "i8"),  # whether the ball left the paddles' reach upwards
        ("direction", "f8"), ("speed", "f8"),  # there [deg], [u/s]
        ("first", "i8"),  # the part that it met first after the press, other than paddles; or NOTHING
        ("first_x", "f8"), ("first_z", "f8"),  # where
        ("low_z", "f8"), ("high_z", "f8"),  # z at which it first crossed LOW and HIGH upwards, NaN if never
        ("clean", "i8"),  # whether it reached something to aim at, or LOW, before it met anything else
        ("aim_z", "f8"),  # where that was
        ("highest", "f8"),  # x that it reached before a paddle met it again
    ],
    align=True,
)  # fmt: skip


class Shots(NamedTuple):
    """The shots of one paddle with one approach.

    Attributes:
        side: "left" or "right".
        held: Whether the ball was held on the raised paddle before.
        shot: SHOT records [press], one for each tick of the sweep.
        aim: An `Aim` for each, [press].
        names: Of the table's parts.
        top: x at which the top of the table begins [u].
    """

    side: str
    held: bool
    shot: NDArray[Any]
    aim: NDArray[np.int64]
    names: tuple[str, ...]
    top: float

    def window(self, aim: Aim) -> tuple[float, float]:
        """The longest time without a gap in which a press makes a shot of this aim, and its beginning [ms].

        The beginning counts from the first press that strikes the ball up the table; NaN if none does.
        """
        struck = np.nonzero(self.shot["launched"])[0]
        best, since, run = 0, -1, 0
        for tick, one in enumerate((self.aim == aim).tolist()):
            run = run + 1 if one else 0
            if run > best:
                best, since = run, tick + 1 - run
        tick_ms = 1000.0 / TICK_RATE
        return best * tick_ms, (since - int(struck[0])) * tick_ms if best else float("nan")

    def directions(self) -> NDArray[np.float64]:
        """The directions [deg] of all balls that were struck, in the order of the presses."""
        found: NDArray[np.float64] = self.shot["direction"][self.shot["launched"] == 1]
        return found


def guide_of(table: Table, side: str) -> SlantWall | None:
    """The slant wall that leads down to a paddle: the one with an end nearest to the paddle's pivot."""
    paddle = next((paddle for paddle in table.paddle if paddle.side == side), None)
    if paddle is None or not table.slant_wall:
        return None
    (x, z), nearest = paddle.pivot, None
    for wall in table.slant_wall:
        away = min(hypot(end[0] - x, end[1] - z) for end in (wall.start, wall.end))
        if nearest is None or away < nearest[0]:
            nearest = (away, wall)
    return nearest[1] if nearest is not None else None


def start_on(wall: SlantWall, table: Table) -> tuple[float, float]:
    """Where a ball lies on a guide, START above its lower end: x, z [u]."""
    low, high = sorted((wall.start, wall.end))
    length = hypot(high[0] - low[0], high[1] - low[1])
    share = min(START, 0.8 * length) / length
    nx, nz = wall.inward_normal(table.board)
    off = wall.thickness + table.board.ball_radius + CLEAR
    return low[0] + share * (high[0] - low[0]) + off * nx, low[1] + share * (high[1] - low[1]) + off * nz


def shots_of(table: Table, side: str, held: bool) -> Shots | None:
    """All shots of a paddle; None where there is no paddle on this side or no guide that leads to it."""
    wall = guide_of(table, side)
    if wall is None:
        return None
    count = round(PRESSES * TICK_RATE)
    batch = WorldBatch(table, count, 0, TICK_RATE)
    wait = round(WAIT * TICK_RATE) if held else 0
    shot: NDArray[Any] = records(count, SHOT)
    shot["press"] = np.arange(count) + wait
    approach = Approach(*start_on(wall, table), side == "left", wait)
    lanes, geometries = batch.lanes, batch.geometries
    batch.on_threads(
        lambda first, end: shoot(lanes, geometries, shot, approach, first, end, 1.0 / TICK_RATE),
        count * count,
    )
    third = MIDDLE * table.board.width
    aim_z, aim = shot["aim_z"], np.full(count, int(Aim.NOWHERE))
    good = shot["clean"] == 1
    aim[good & (aim_z < -third)] = Aim.LEFT
    aim[good & (np.abs(aim_z) <= third)] = Aim.MIDDLE
    aim[good & (aim_z > third)] = Aim.RIGHT
    return Shots(side, held, shot, aim, batch.boards.names[0], 0.5 * table.board.length - TOP_ZONE)


class Approach(NamedTuple):
    """How the ball comes to the paddle.

    Attributes:
        x: Where it starts at rest [u].
        z: Where it starts at rest [u].
        left: Whether the left button is pressed, rather than the right one.
        wait: Ticks for which the button is held at first.
    """

    x: float
    z: float
    left: bool
    wait: int


@kernel
def shoot(
    lanes: Lanes, geometries: BatchGeometry, shots: Any, approach: Approach, first: int, end: int, tick: float
) -> None:
    """Play one shot in each of the worlds first … end − 1, all on the first board."""
    board, left = geometries.boards[0], approach.left
    geometry = BoardGeometry(board, geometries.colliders, geometries.grid)
    for index in range(first, end):
        world, log, shot = lanes.worlds[index], lanes.logs[index], shots[index]
        lane = Lane(world, log, lanes.tallies[index], log)
        clear_log(log)
        put_ball(world, board, log, 0, approach.x, approach.z, 0.0, 0.0)
        ball = world.ball[0]
        shot.first, shot.low_z, shot.high_z, shot.highest = (
            as_int(NOTHING),
            np.nan,
            np.nan,
            -board.half_length,
        )
        for now in range(shot.press + int(AFTER / tick)):
            clear_log(log)
            up = now < approach.wait or shot.press <= now < shot.press + int(HOLD / tick)
            before = ball.x
            step_world(lane, geometry, button_bits(up and left, up and not left), tick)
            if ball.id == 0:
                break
            if now < shot.press:
                continue
            is_met_again = False
            for number in range(log.count):
                event = log.event[number]
                if event.kind not in CONTACTS:
                    continue
                if is_paddle(board, event.part):
                    is_met_again = shot.launched == 1
                elif event.kind == EventKind.HIT and shot.first == NOTHING:
                    shot.first, shot.first_x, shot.first_z = event.part, event.x, event.z
                    if isnan(shot.low_z) and event.x > board.paddle_top + AIM_DISTANCE:
                        shot.clean, shot.aim_z = shot.launched, event.z
            if is_met_again:
                break
            if shot.launched == 0 and ball.x > board.paddle_top >= before and ball.vx > MIN_STRIKE_SPEED:
                shot.launched = 1
                shot.direction = DEGREES * atan2(ball.vz, ball.vx)
                shot.speed = (ball.vx * ball.vx + ball.vz * ball.vz) ** 0.5
            if shot.launched == 1:
                shot.highest = max(shot.highest, ball.x)
                if before < LOW <= ball.x and isnan(shot.low_z):
                    shot.low_z = ball.z
                    if shot.first == NOTHING:
                        shot.clean, shot.aim_z = 1, ball.z
                if before < HIGH <= ball.x and isnan(shot.high_z):
                    shot.high_z = ball.z
