"""The transport line of a replay: time and speed below the score; the paddles change the speed or jump."""

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
PAUSED_EXTRA_TIME = 270.0  # [s] added to the idle time of a paused replay
HELP_TIME = 3.0  # [s] for each help text
SPEEDS = {0.25: "1/4×", 0.5: "1/2×"}  # the glyphs ¼ and ½ would be too small to read


class ReplayStatus(NamedTuple):
    """The state of a replay.

    Attributes:
        time: Time of the game on screen [s].
        length: Length of the whole game [s].
        speed: Seconds of play per second of real time.
        is_paused: Whether it is paused.
        title: Shown in the line of help.
    """

    time: float = 0.0
    length: float = 0.0
    speed: float = 1.0
    is_paused: bool = False
    title: str = "REPLAY"


class TransportPage(Page):
    """The page of a replay: Space pauses it; the paddles change its speed, or jump while it is paused.

    Attributes:
        status: The state of the replay, updated by the program.
    """

    name = "transport"
    repeats = True

    def __init__(self, status: ReplayStatus) -> None:
        self.status = status

    @property
    def allows_attract(self) -> bool:  # type: ignore[override]
        """Whether the replay is paused or over; while it plays, someone may be watching."""
        return self.status.is_paused or self._is_over()

    @property
    def extra_idle_time(self) -> float:  # type: ignore[override]
        """Extra idle time [s] of a paused replay, which someone may be studying."""
        return 0.0 if self._is_over() else PAUSED_EXTRA_TIME

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Request a pause, a speed, a jump, or the end of the replay."""
        self.shown_at = context.now
        if button is Button.START:
            return EndReplay() if self._is_over() else ReplayPause()
        if button is Button.BACK:
            return EndReplay()
        step = -1 if button is Button.LEFT else 1
        return ReplayJump(step * JUMP) if self.status.is_paused or self._is_over() else ReplaySpeed(step)

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """Draw the display of the game, and the transport line below it."""
        dots = Dots()
        page_layout.copy_above_foot(dots, below)
        # The position matters most, so the help appears only after some time without a button.
        since = max(seconds - self.shown_at, 0.0)
        texts = {2: self.status.title.upper(), 4: self._help(context), 6: "BOTH PADDLES HELD: LEAVE"}
        text = texts.get(int(since / HELP_TIME) % 8, "")
        if text:
            page_layout.foot(dots, (text,), since % HELP_TIME)
        else:
            self._draw_line(dots, seconds)
        return dots

    def signature(self) -> Hashable:
        """Return whether the paddles jump."""
        return self.status.is_paused, self._is_over()

    def _is_over(self) -> bool:
        return self.status.time >= self.status.length

    def _help(self, context: MenuContext) -> str:
        key = context.key_label("create")
        if self._is_over():
            return f"◄►: BACK   {key}: LEAVE"
        return f"◄►: JUMP   {key}: RESUME" if self.status.is_paused else f"◄►: SPEED   {key}: PAUSE"

    def _draw_line(self, dots: Dots, seconds: float) -> None:
        status, y = self.status, page_layout.FOOT_Y
        if status.is_paused:
            if page_layout.is_blink_on(seconds, 1.0):
                dots.box(0, y, 2, 7)
                dots.box(4, y, 2, 7)
        else:
            dots.text("►", 0, y, NORMAL)
        end = 9 + dots.text(_time_text(status.time), 9, y, NORMAL)
        right = WIDTH - dots.text(_speed_text(status.speed), WIDTH, y, NORMAL, "right") - 4
        fraction = status.time / status.length if status.length > 0.0 else 1.0
        page_layout.meter(dots, end + 4, y + 1, right - end - 4, fraction)


def _time_text(seconds: float) -> str:
    whole = max(int(seconds), 0)
    return f"{whole // 60}:{whole % 60:02d}"


def _speed_text(speed: float) -> str:
    return SPEEDS.get(speed, f"{speed:g}×")
