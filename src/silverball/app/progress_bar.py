"""What does the score display show while the physics is made ready? A bar, and the time that it takes."""

from __future__ import annotations

from typing import NamedTuple

from silverball.app.menus import page as layout
from silverball.drawing.dotmatrix.canvas import WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import NORMAL

LEAST_SHARE = 0.05  # before which nobody can say how long it will take
LINE_Y = 8  # of the bar below the title of a menu
TITLE_WIDTH = WIDTH - 62  # beside the marks of a menu
SWEEP_TIME = 1.2  # [s] in which the bar of something that has no measure comes and goes


class Progress(NamedTuple):
    """How far the compilation is.

    Attributes:
        seconds: Since it began [s].
        share: Of all that is to be compiled, 0 to 1.
    """

    seconds: float
    share: float

    @property
    def words(self) -> str:
        """The time so far and, as far as one can say, how long it will take altogether."""
        if self.share < LEAST_SHARE:
            return f"{self.seconds:.0f} S"
        whole = max(self.seconds / self.share, self.seconds + 1.0)
        return f"{self.seconds:.0f}/{whole:.0f} S"


def draw_page(seconds: float, progress: Progress | None) -> Dots:
    """The whole display, after somebody has asked for a game.

    Args:
        seconds: By a clock that never goes back [s].
        progress: Of the compilation; None while everything is only loaded.
    """
    dots = Dots()
    if progress is None:
        layout.title(dots, "GETTING READY")
        place = round(seconds % SWEEP_TIME / SWEEP_TIME * WIDTH)
        dots.frame(0, layout.MIDDLE_Y, WIDTH, 10, layout.HALF)
        dots.box(min(place, WIDTH - 14), layout.MIDDLE_Y + 2, 12, 6)
        return dots
    layout.title(dots, "COMPILING, ONCE")
    dots.text(progress.words, WIDTH, layout.TITLE_Y, NORMAL, "right")
    layout.meter(dots, 0, layout.MIDDLE_Y, WIDTH, progress.share, 10)
    layout.foot(dots, ("THEN IT BEGINS", "ESC: BACK TO THE MENU"), seconds)
    return dots


def draw_line(dots: Dots, progress: Progress) -> None:
    """A bar in a menu, with the time in place of the menu's title."""
    dots.box(0, layout.TITLE_Y, TITLE_WIDTH, LINE_Y, 0)
    text = f"COMPILING {progress.words}"
    if NORMAL.width(text) > TITLE_WIDTH:
        text = progress.words
    dots.text(text, 0, layout.TITLE_Y, NORMAL)
    dots.box(0, LINE_Y, WIDTH, 1, layout.FAINT)
    dots.box(0, LINE_Y, round(WIDTH * min(progress.share, 1.0)), 1)
