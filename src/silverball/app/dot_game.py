"""A tiny pinball on the dots, to play while the physics is compiled: two paddles, three bumpers, five lamps.

It is plain Python with nothing to compile, and costs about 15 ms a second. Places are in dots
(x to the right, y downwards), speeds in dots per second. Nothing of it is a game of Silverball: its only
score is its own best one.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

from silverball.drawing.dotmatrix.canvas import FULL, HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import NORMAL, TINY

STEP = 1 / 120  # [s]
LONGEST = 0.1  # [s] between two frames that is played; more is a pause
TOP, LEFT, RIGHT = 10.0, 34.0, 125.0  # [dot] walls; above is the progress of the compilation
MIDDLE = 0.5 * (LEFT + RIGHT)
GRAVITY = 55.0  # [dot/s²]
BALL = 1.2  # [dot] radius
FASTEST = 95.0  # [dot/s]
BOUNCE = 0.55  # share of the speed that a wall gives back
BUMPER, BUMPER_SPEED = 2.8, 48.0  # [dot] radius; [dot/s] of a ball that leaves one
BUMPERS = ((MIDDLE - 17.0, 16.0), (MIDDLE, 18.0), (MIDDLE + 17.0, 16.0))
PIVOT_Y, REACH, LENGTH = (
    27.0,
    19.0,
    14.5,
)  # [dot] height of the pivots, their distance from the middle, length
DOWN, UP = 0.28, -0.42  # [rad] of a paddle at rest and raised; positive is downwards
TURN = 11.0  # [rad/s] of a raised paddle; it falls half as fast
LAMPS, LAMP_WIDTH = 5, 9.0  # along the top
BUMPER_POINTS, LAMP_POINTS, ALL_LAMPS_POINTS = 10, 20, 200
PAUSE = 1.4  # [s] after a lost ball
FLASH = 0.15  # [s] for which a bumper is bright after a hit
SIDES = ("left", "right")
FAINT, HALF = 90, 150


class _Wall(NamedTuple):
    """A straight wall from one end to the other."""

    x0: float
    y0: float
    x1: float
    y1: float

    def draw(self, dots: Dots, brightness: int = FULL) -> None:
        """Draw it, one dot wide."""
        dots.line(round(self.x0), round(self.y0), round(self.x1), round(self.y1), brightness)


_FLOOR_Y = 20.0  # where the slopes to the paddles begin
_SIDE_MIDDLES = (round(LEFT) // 2, (round(RIGHT) + WIDTH) // 2)  # [dot] beside the board
_WALLS = (
    _Wall(LEFT, _FLOOR_Y, MIDDLE - REACH, PIVOT_Y),
    _Wall(MIDDLE + REACH, PIVOT_Y, RIGHT, _FLOOR_Y),
)


class DotGame:
    """The game: hold the paddle buttons; a lost ball comes back, and the points start again.

    Args:
        best: The best score so far.

    Attributes:
        best: The best score.
        points: Points of the ball in play.
        is_begun: Whether a button has been pressed.
    """

    def __init__(self, best: int = 0) -> None:
        self.best, self.points = best, 0
        self.is_begun = False
        self._held = dict.fromkeys(SIDES, False)
        self._angles = dict.fromkeys(SIDES, DOWN)
        self._turning = dict.fromkeys(SIDES, 0.0)  # [rad/s]
        self._lit: set[int] = set()  # lamps
        self._flashes = [0.0] * len(BUMPERS)  # [s] left
        self._last: float | None = None
        self._rest = 0.0  # [s] not yet played
        self._lost_for: float | None = None  # [s]; None while the ball is in play
        self._balls = 0
        self._new_ball()

    def press(self, button: str) -> None:
        """Press a button: "left" and "right" hold a paddle, any other one only begins."""
        self.is_begun = True
        if button in self._held:
            self._held[button] = True

    def release(self, button: str) -> None:
        """Release a button."""
        if button in self._held:
            self._held[button] = False

    def advance(self, seconds: float) -> None:
        """Go on to a time of a monotonic clock [s]."""
        passed = 0.0 if self._last is None else max(min(seconds - self._last, LONGEST), 0.0)
        self._last = seconds
        if not self.is_begun:
            return
        self._rest += passed
        while self._rest >= STEP:
            self._rest -= STEP
            self._step()

    def _new_ball(self) -> None:
        """Shoot a ball up the right side; each one differs a little."""
        self._balls += 1
        self.points = 0
        self._lit.clear()
        self._lost_for = None
        self._x, self._y = RIGHT - 2.0, _FLOOR_Y - 2.0
        self._vx, self._vy = -22.0 - 5.0 * (self._balls % 4), -40.0

    def _step(self) -> None:
        for side in SIDES:
            self._turn(side)
        self._flashes = [max(left - STEP, 0.0) for left in self._flashes]
        if self._lost_for is not None:
            self._lost_for += STEP
            if self._lost_for >= PAUSE:
                self._new_ball()
            return
        self._vy += GRAVITY * STEP
        self._x += self._vx * STEP
        self._y += self._vy * STEP
        self._meet_borders()
        self._meet_bumpers()
        for wall in _WALLS:
            self._meet(wall)
        for side in SIDES:
            self._meet(self._paddle(side), side)
        speed = math.hypot(self._vx, self._vy)
        if speed > FASTEST:
            self._vx, self._vy = self._vx * FASTEST / speed, self._vy * FASTEST / speed
        if self._y > HEIGHT + BALL:
            self._lost_for = 0.0
            self.best = max(self.best, self.points)

    def _turn(self, side: str) -> None:
        """Turn a paddle towards where its button wants it."""
        before = self._angles[side]
        after = max(before - TURN * STEP, UP) if self._held[side] else min(before + 0.5 * TURN * STEP, DOWN)
        self._angles[side], self._turning[side] = after, (after - before) / STEP

    def _paddle(self, side: str) -> _Wall:
        """Where a paddle is, from its pivot to its tip."""
        angle, way = self._angles[side], 1.0 if side == "left" else -1.0
        x = MIDDLE - way * REACH
        return _Wall(x, PIVOT_Y, x + way * LENGTH * math.cos(angle), PIVOT_Y + LENGTH * math.sin(angle))

    def _meet_borders(self) -> None:
        if self._x < LEFT + BALL:
            self._x, self._vx = LEFT + BALL, abs(self._vx) * BOUNCE
        elif self._x > RIGHT - BALL:
            self._x, self._vx = RIGHT - BALL, -abs(self._vx) * BOUNCE
        if self._y < TOP + BALL:
            self._y, self._vy = TOP + BALL, abs(self._vy) * BOUNCE
            self._light((self._x - LEFT) / (RIGHT - LEFT))

    def _light(self, share: float) -> None:
        """Light the lamp at a share of the top wall; all of them together are worth more."""
        lamp = min(int(LAMPS * share), LAMPS - 1)
        if lamp not in self._lit:
            self._lit.add(lamp)
            self.points += LAMP_POINTS
        if len(self._lit) == LAMPS:
            self._lit.clear()
            self.points += ALL_LAMPS_POINTS

    def _meet_bumpers(self) -> None:
        for number, (x, y) in enumerate(BUMPERS):
            out_x, out_y = self._x - x, self._y - y
            distance = math.hypot(out_x, out_y) or 1e-9
            if distance < BUMPER + BALL:
                out_x, out_y = out_x / distance, out_y / distance
                self._x, self._y = x + (BUMPER + BALL) * out_x, y + (BUMPER + BALL) * out_y
                inwards = self._vx * out_x + self._vy * out_y
                self._vx += (BUMPER_SPEED - inwards) * out_x
                self._vy += (BUMPER_SPEED - inwards) * out_y
                self._flashes[number] = FLASH
                self.points += BUMPER_POINTS

    def _meet(self, wall: _Wall, side: str = "") -> None:
        """Bounce off a wall, or off the paddle of a side, which gives the ball the speed of its face."""
        along_x, along_y = wall.x1 - wall.x0, wall.y1 - wall.y0
        square = along_x**2 + along_y**2
        share = ((self._x - wall.x0) * along_x + (self._y - wall.y0) * along_y) / square
        share = min(max(share, 0.0), 1.0)
        near_x, near_y = wall.x0 + share * along_x, wall.y0 + share * along_y
        out_x, out_y = self._x - near_x, self._y - near_y
        distance = math.hypot(out_x, out_y)
        if distance >= BALL + 0.5:
            return
        out_x, out_y = (out_x / distance, out_y / distance) if distance > 1e-9 else (0.0, -1.0)
        self._x, self._y = near_x + (BALL + 0.5) * out_x, near_y + (BALL + 0.5) * out_y
        way = {"left": 1.0, "right": -1.0, "": 0.0}[side]
        turning = way * self._turning[side] if side else 0.0
        face_x, face_y = -turning * (near_y - wall.y0), turning * (near_x - wall.x0)
        inwards = (self._vx - face_x) * out_x + (self._vy - face_y) * out_y
        if inwards < 0.0:
            self._vx -= (1.0 + BOUNCE) * inwards * out_x
            self._vy -= (1.0 + BOUNCE) * inwards * out_y

    # --- the picture --------------------------------------------------------------------------------

    def draw(self, dots: Dots) -> None:
        """Draw the game below the progress of the compilation, over nothing else."""
        dots.pixels[int(TOP) :] = _backdrop().pixels[int(TOP) :]
        for lamp in range(LAMPS):
            x = LEFT + (lamp + 0.5) * (RIGHT - LEFT) / LAMPS - 0.5 * LAMP_WIDTH
            dots.box(round(x), int(TOP), round(LAMP_WIDTH), 1, FULL if lamp in self._lit else FAINT)
        for (x, y), flash in zip(BUMPERS, self._flashes, strict=True):
            _disc(dots, x, y, BUMPER, FULL if flash > 0.0 else HALF)
        for side in SIDES:
            self._paddle(side).draw(dots)
        if self._lost_for is None:
            _disc(dots, self._x, self._y, BALL, FULL)
        for middle, value in zip(_SIDE_MIDDLES, (self.points, self.best), strict=True):
            dots.text(str(value), middle, 19, NORMAL, "center")


@lru_cache(maxsize=1)
def _backdrop() -> Dots:
    """Walls and labels: the points are at the left, the best ones at the right."""
    dots = Dots()
    for x in (LEFT - 1.0, RIGHT + 1.0):
        dots.line(round(x), int(TOP), round(x), int(_FLOOR_Y), FAINT)
    for wall in _WALLS:
        wall.draw(dots, FAINT)
    for middle, label in zip(_SIDE_MIDDLES, ("POINTS", "BEST"), strict=True):
        dots.text(label, middle, 12, TINY, "center", HALF)
    return dots


def _disc(dots: Dots, x: float, y: float, radius: float, brightness: int) -> None:
    """Fill a circle."""
    for row in range(math.ceil(y - radius), math.floor(y + radius) + 1):
        half = math.sqrt(max(radius**2 - (row - y) ** 2, 0.0))
        first = math.ceil(x - half)
        dots.box(first, row, math.floor(x + half) - first + 1, 1, brightness)
