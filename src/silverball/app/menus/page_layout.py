"""Layout of a page: the title at the top, the choice in large letters, and a line of help at the bottom."""

from __future__ import annotations

import math

from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL, Font

TITLE_Y, MIDDLE_Y, FOOT_Y = 0, 10, 24
FAINT, HALF = 70, 145  # brightness of secondary text
MAX_PAGE_DOTS = 15  # more choices are numbered instead
MARGIN = 13  # [dot] on both sides, for the arrows

SCROLL_SPEED = 40.0  # [dot/s] of texts that are too long, a letter in 0.15 s
SCROLL_WAIT = 1.0  # [s] before scrolling starts, and at its end
SLIDE_TIME = 0.12  # [s] for the transition to the next choice
FOOT_TURN = 3.0  # [s] for each help text


def title(dots: Dots, text: str, index: int = 0, count: int = 0, seconds: float = 0.0) -> None:
    """Draw the title, and the index of the visible choice as page dots, or as numbers if there are many."""
    number = f"{index + 1}/{count}" if count > MAX_PAGE_DOTS else ""
    width = NORMAL.width(number) if number else 4 * count if count > 1 else 0
    marquee(dots, text, TITLE_Y, 0, WIDTH - width - 2, NORMAL, seconds, "left", HALF)
    if number:
        dots.text(number, WIDTH, TITLE_Y, NORMAL, "right", HALF)
    if number or not width:
        return
    for page in range(count):
        x = WIDTH - width + page * width // count
        if page == index:
            dots.box(x, TITLE_Y + 2, 3, 3)
        else:
            dots.box(x + 1, TITLE_Y + 3, 1, 1, HALF)


def middle(dots: Dots, text: str, seconds: float, shift: int = 0, brightness: int = 255) -> None:
    """Draw the large line; long texts get smaller letters, and longer ones scroll.

    Args:
        dots: The display.
        text: The text.
        seconds: Since it appeared [s].
        shift: Shift to the right [dot].
        brightness: Brightness of its dots, 0 to 255.
    """
    available = WIDTH - 2 * MARGIN
    if BOLD.width(text) <= available:
        dots.text(
            text, WIDTH // 2 + shift, MIDDLE_Y, BOLD, "center", brightness, window=(MARGIN, WIDTH - MARGIN)
        )
    elif shift:
        left = max((available - NORMAL.width(text)) // 2, 0) + MARGIN
        dots.text(
            text, left + shift, MIDDLE_Y + 2, NORMAL, "left", brightness, window=(MARGIN, WIDTH - MARGIN)
        )
    else:
        marquee(dots, text, MIDDLE_Y + 2, MARGIN, WIDTH - MARGIN, NORMAL, seconds, "center", brightness)


def arrows(dots: Dots, seconds: float, strong: bool = False) -> None:
    """Draw arrows on both sides; strong ones pulse while the paddle buttons change the value."""
    brightness = round(170 + 85 * math.cos(2.0 * math.pi * seconds)) if strong else HALF
    dots.text("◄", 0, MIDDLE_Y, BOLD, "left", brightness)
    dots.text("►", WIDTH, MIDDLE_Y, BOLD, "right", brightness)


def foot(dots: Dots, texts: tuple[str, ...], seconds: float, brightness: int = 190) -> None:
    """Draw the line of help: several texts alternate, and long ones scroll."""
    texts = tuple(text for text in texts if text)
    if not texts:
        return
    times = [max(FOOT_TURN, scroll_time(NORMAL.width(text))) for text in texts]
    at = max(seconds, 0.0) % sum(times)
    for text, time in zip(texts, times, strict=True):
        if at < time:
            marquee(dots, text, FOOT_Y, 0, WIDTH, NORMAL, at, "center", brightness)
            return
        at -= time


def marquee(
    dots: Dots,
    text: str,
    y: int,
    left: int,
    right: int,
    font: Font,
    seconds: float,
    align: str = "center",
    brightness: int = 255,
) -> None:
    """Draw a text between two columns; it scrolls if it does not fit."""
    width, available = font.width(text), right - left
    if width <= available:
        x = left + (available - width) // 2 if align == "center" else left
    else:
        at = max(seconds, 0.0) % scroll_time(width, available)
        x = left - min(round(max(at - SCROLL_WAIT, 0.0) * SCROLL_SPEED), width - available)
    dots.text(text, x, y, font, "left", brightness, window=(left, right))


def meter(dots: Dots, x: int, y: int, width: int, share: float, height: int = 5) -> None:
    """Draw a bar that is filled to a fraction, 0 to 1."""
    dots.frame(x, y, width, height, HALF)
    dots.box(x + 1, y + 1, round((width - 2) * min(max(share, 0.0), 1.0)), height - 2)


def slide(seconds: float, direction: int) -> int:
    """Return how far a new choice is from its place [dot], some seconds after the button was pressed."""
    left = 1.0 - seconds / SLIDE_TIME
    return round(direction * (WIDTH - 2 * MARGIN) * left * left) if 0.0 < left <= 1.0 else 0


def is_blink_on(seconds: float, period: float = 0.5) -> bool:
    """Return whether something that blinks is visible now."""
    return seconds % period < 0.6 * period


def copy_above_foot(dots: Dots, below: Dots) -> None:
    """Copy the display of the game, except for the line of help at the bottom."""
    dots.pixels[: FOOT_Y - 1] = below.pixels[: FOOT_Y - 1]
    dots.pixels[FOOT_Y - 1 : HEIGHT] = 0


def scroll_time(width: int, available: int = WIDTH) -> float:
    """Return the time that a text takes to scroll to its end [s]; the widths are in dots."""
    return 2.0 * SCROLL_WAIT + max(width - available, 0) / SCROLL_SPEED
