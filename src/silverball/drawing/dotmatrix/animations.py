"""Animations of the score display, each a function of the time since it began.

Each draws over the given dots, `at` seconds after its beginning. Nothing is random, so films are
reproducible.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from silverball.drawing.dotmatrix.canvas import FULL, HEIGHT, WIDTH, Dots, Levels, picture
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL

BALL = picture(
    """
    ...+++...
    .+#####+.
    .##@@###.
    +#@@@###+
    +##@####+
    +#######+
    .#####++.
    .+###+++.
    ...+++...
    """,
    levels=".+#@",
)
"""A ball, 9 × 9 dots."""
HALF_BALL = BALL.shape[0] // 2

GOLDEN = 0.6180339887
"""The fractional parts of its multiples are spread evenly: sparks without random numbers."""


def draw_ball(dots: Dots, x: float, y: float) -> None:
    """Draw a ball centred at (x, y); it hides what is behind it."""
    left, top = round(x) - HALF_BALL, round(y) - HALF_BALL
    dots.stamp(BALL > 0, left, top, 0)
    dots.sprite(BALL, left, top)


def burst(dots: Dots, at: float, x: float = WIDTH / 2, y: float = HEIGHT / 2, rays: int = 36) -> None:
    """Draw rays that fly apart from a point and fade; 0.7 s."""
    for ray in range(rays):
        angle = 2.0 * math.pi * ray / rays
        speed = 200.0 * (0.5 + 0.6 * ((ray * GOLDEN) % 1.0))
        light = 1.0 - at / 0.7
        for step in range(8):
            away = speed * (at - 0.012 * step)
            if away > 3.0 and light > 0.0:
                dot_x, dot_y = round(x + away * math.cos(angle)), round(y + 0.7 * away * math.sin(angle))
                dots.dot(dot_x, dot_y, round(FULL * light * (1.0 - 0.11 * step)))


def ring(dots: Dots, at: float, x: float = WIDTH / 2, y: float = HEIGHT / 2, speed: float = 110.0) -> None:
    """Draw a ring that grows."""
    column, row = np.arange(WIDTH)[None, :] - x, np.arange(HEIGHT)[:, None] - y
    away = np.abs(np.hypot(column, row) - speed * at)
    light = np.clip(1.6 - away, 0.0, 1.0) * FULL * max(1.0 - 0.6 * at, 0.0)
    dots.pixels[:] = np.maximum(dots.pixels, light.astype(np.uint8))


def fireworks(dots: Dots, at: float, top: int = 0, bottom: int = HEIGHT) -> None:
    """Draw rockets that rise and burst into falling sparks, one after the other."""
    for rocket in range(8):
        since = at - 0.3 * rocket
        if not 0.0 <= since < 1.3:
            continue
        x = 14.0 + 132.0 * ((0.31 + rocket * GOLDEN) % 1.0)
        goal = top + 4.0 + 7.0 * ((rocket * GOLDEN * 3.0) % 1.0)
        if since < 0.3:
            y = bottom + (goal - bottom) * (since / 0.3)
            dots.line(round(x), round(y), round(x), round(y) + 2, 150)
            continue
        age = since - 0.3
        for spark in range(18):
            angle = 2.0 * math.pi * spark / 18
            speed = 14.0 + 14.0 * ((spark * GOLDEN) % 1.0)
            spark_x = round(x + 1.6 * speed * age * math.cos(angle))
            spark_y = round(goal + speed * age * math.sin(angle) + 14.0 * age * age)
            if top <= spark_y < bottom:
                dots.dot(spark_x, spark_y, round(FULL * (1.0 - age)))


def two_balls(dots: Dots, at: float) -> None:
    """Draw two balls that roll in and meet in the middle: points are doubled; 0.9 s."""
    meet = 0.35
    if at < meet:
        away = 4.5 + 90.0 * (1.0 - at / meet)
    else:
        away = 4.5 + 160.0 * (at - meet)
        ring(dots, at - meet)
        if away > 24.0:
            dots.text("×2", WIDTH // 2, 5, BOLD, "center", scale=2)
    draw_ball(dots, WIDTH / 2 - away, HEIGHT / 2)
    draw_ball(dots, WIDTH / 2 + away, HEIGHT / 2)


def saved_ball(dots: Dots, at: float) -> None:
    """Draw a ball that falls between the paddles and comes back up; 0.85 s."""
    low = 0.32
    for side in (-1, 1):
        for row in range(3):
            dots.line(80 + side * 34, 22 + row, 80 + side * 13, 28 + row // 2, 170)
    if at < low:
        y = -5.0 + 43.0 * (at / low) ** 2
    else:
        y = 38.0 - 110.0 * (at - low)
        for row in range(max(round(y) + 5, 0), HEIGHT):
            light = FULL - 12 * (row - round(y))
            if light > 30:
                dots.line(78, row, 82, row, light)
    draw_ball(dots, WIDTH / 2, y)
    if at > low:
        words = "BALL", "SAVED"
        dots.text(words[0], 4, 10, BOLD)
        dots.text(words[1], WIDTH - 3, 10, BOLD, "right")


def falling_ball(dots: Dots, at: float) -> None:
    """Draw a ball that falls out of the display; 0.45 s."""
    y = 60.0 * at + 90.0 * at * at
    for row in range(max(round(y) - 14, 0), min(max(round(y), 0), HEIGHT)):
        dots.line(76, row, 84, row, max(10 * (row - round(y) + 14), 0))
    draw_ball(dots, WIDTH / 2, y)


def tilt(dots: Dots, at: float) -> None:
    """Draw a shaking TILT over the whole display, alternately inverted.

    It alternates 2.5 times a second: more than three flashes of a large area can cause seizures.
    """
    shake = round(2.5 * math.sin(40.0 * at) * max(1.0 - at, 0.25))
    width = 2 * BOLD.width("TILT")
    left = (WIDTH - width) // 2
    x = left
    for number, letter in enumerate("TILT"):
        lean = round(1.5 * math.sin(23.0 * at + 1.7 * number))
        x += dots.text(letter, x + shake, 5 + lean, BOLD, scale=2) + 4
    dots.sprite(_stripes(), 0, 0)
    if at % 0.4 < 0.2:
        dots.invert()


@lru_cache(maxsize=1)
def _stripes() -> Levels:
    """Return warning stripes on both sides."""
    dots = Dots()
    for stripe in range(0, 34, 6):
        for start, slope in ((stripe, 8), (WIDTH - 2 - stripe, -8)):
            dots.line(start, 0, start - slope, HEIGHT - 1, 110)
            dots.line(start + 1, 0, start + 1 - slope, HEIGHT - 1, 110)
    return dots.pixels


def shaking_text(dots: Dots, at: float, text: str, y: int) -> None:
    """Draw a trembling word in large letters."""
    shift = round(2.0 * math.sin(55.0 * at) * max(1.0 - at, 0.0))
    dots.text(text, WIDTH // 2 + shift, y, BOLD, "center")


def growing_text(dots: Dots, at: float, text: str, y: int) -> None:
    """Draw a word in large letters that opens from its middle and flashes."""
    half = round(min(at / 0.15, 1.0) * WIDTH / 2)
    light = FULL if at % 0.2 < 0.12 or at > 0.6 else 120
    window = (WIDTH // 2 - half, WIDTH // 2 + half)
    dots.text(
        text, WIDTH // 2, y, BOLD if BOLD.width(text) <= WIDTH else NORMAL, "center", light, window=window
    )
