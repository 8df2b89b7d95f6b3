"""How is a replay worked? A line below the score shows time and speed; the paddles change it, or jump."""

from __future__ import annotations

from collections.abc import Hashable
from typing import NamedTuple

from silverball.app.menus import page_layout
from silverball.app.menus.commands import (
    Button,
    Command,
    EndReplay,
    ReplayJump,
    ReplayPause,
    ReplaySpeed,
)
from silverball.app.menus.context import MenuContext, Page
from silverball.drawing.dotmatrix.canvas import WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import NORMAL

JUMP = 5.0  # [s]
STUDY = 270.0  # [s] for which a replay may be held beyond what other pages wait
HELP_TIME = 3.0  # [s] for which the help stands
SPEEDS = {0.25: "1/4×", 0.5: "1/2×"}  # as glyphs they would be too small to read


class ReplayStatus(NamedTuple):
    """Where a replay stands.

    Attributes:
        time: Of the game shown [s].
        length: Of the whole game [s].
        speed: 1 is as it was played.
        paused: Whether it is held.
        title: Whose game it is.
    """

    time: float = 0.0
    length: float = 0.0
    speed: float = 1.0
    paused: bool = False
    title: str = "REPLAY"


class TransportPage(Page):
    """The page of a replay: Space holds it; the paddles change its speed, or jump while it is held.

    Attributes:
        face: Where the replay stands; the window keeps it true.
    """

    name = "transport"
    repeats = True

    def __init__(self, face: ReplayStatus) -> None:
        self.face = face

    @property
    def quiet(self) -> bool:  # type: ignore[override]
        """Not while the replay goes on: somebody looks on."""
        return self.face.paused or self._is_over()

    @property
    def extra_patience(self) -> float:  # type: ignore[override]
        """A replay that is held is being studied."""
        return 0.0 if self._is_over() else STUDY

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Ask the window for what the button means; it alone knows the replay."""
        self.shown_at = context.now
        if button is Button.START:
            return EndReplay() if self._is_over() else ReplayPause()
        if button is Button.BACK:
            return EndReplay()
        step = -1 if button is Button.LEFT else 1
        return ReplayJump(step * JUMP) if self.face.paused or self._is_over() else ReplaySpeed(step)

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """What the game shows, and below it the line of the replay."""
        dots = Dots()
        page_layout.under(dots, below)
        # Where it stands matters most, so the help waits until nobody has touched anything for a while.
        since = max(seconds - self.shown_at, 0.0)
        texts = {2: self.face.title.upper(), 4: self._help(context), 6: "BOTH PADDLES HELD: LEAVE"}
        text = texts.get(int(since / HELP_TIME) % 8, "")
        if text:
            page_layout.foot(dots, (text,), since % HELP_TIME)
        else:
            self._draw_line(dots, seconds)
        return dots

    def signature(self) -> Hashable:
        """Whether the paddles jump."""
        return self.face.paused, self._is_over()

    def _is_over(self) -> bool:
        return self.face.time >= self.face.length

    def _help(self, context: MenuContext) -> str:
        key = context.key("create")
        if self._is_over():
            return f"◄►: BACK   {key}: LEAVE"
        return f"◄►: JUMP   {key}: GO ON" if self.face.paused else f"◄►: SPEED   {key}: HOLD"

    def _draw_line(self, dots: Dots, seconds: float) -> None:
        face, y = self.face, page_layout.FOOT_Y
        if face.paused:
            if page_layout.blinks(seconds, 1.0):
                dots.box(0, y, 2, 7)
                dots.box(4, y, 2, 7)
        else:
            dots.text("►", 0, y, NORMAL)
        end = 9 + dots.text(_clock(face.time), 9, y, NORMAL)
        right = WIDTH - dots.text(_speed(face.speed), WIDTH, y, NORMAL, "right") - 4
        share = face.time / face.length if face.length > 0.0 else 1.0
        page_layout.meter(dots, end + 4, y + 1, right - end - 4, share)


def _clock(seconds: float) -> str:
    whole = max(int(seconds), 0)
    return f"{whole // 60}:{whole % 60:02d}"


def _speed(speed: float) -> str:
    return SPEEDS.get(speed, f"{speed:g}×")
