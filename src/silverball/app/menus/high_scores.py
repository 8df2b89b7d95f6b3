"""Who is the best? The score tables, one after the other, each scrolling by itself."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from silverball.app.menus import page_layout
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import MenuContext, Page, ScoreRow, TableEntry
from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL, TINY
from silverball.game.view import Mode

ROWS = 10  # shown of every score table
ROW_HEIGHT = 12  # [dot] of the large rows, of which two are visible
SCROLL_SPEED = 9.0  # [dot/s] upwards: a row in 1.3 s
WAIT = 2.0  # [s] before they begin to scroll, and at the end
TOP = 8  # [dot] where the rows begin
MODES = {Mode.ARCADE: "ARCADE", Mode.FREE: "FREE PLAY"}


class ScoresPage(Page):
    """The best scores of every table and mode that has any."""

    name = "scores"

    def __init__(self) -> None:
        self._index = 0

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Turn to another table, or go back."""
        if button in (Button.START, Button.BACK):
            context.back()
            return None
        count = max(len(context.boards()), 1)
        self._index = (self._index + (-1 if button is Button.LEFT else 1)) % count
        self.shown_at = context.now
        return None

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """The name of the table and its scores."""
        dots = Dots()
        boards = context.boards()
        if not boards:
            page_layout.title(dots, "SCORES")
            page_layout.middle(dots, "NO SCORES YET", seconds)
            page_layout.foot(dots, (f"{context.key('create')}: BACK",), seconds)
            return dots
        since = max(seconds - self.shown_at, 0.0)
        index = min(self._index, len(boards) - 1)
        entry, mode, rows = boards[index]
        draw_board(dots, entry, mode, rows[:ROWS], since)
        page_layout.title(dots, f"{entry.title.upper()} · {MODES[mode]}", index, len(boards), since)
        return dots

    def signature(self) -> Hashable:
        """Which table is shown."""
        return self._index


def board_time(count: int) -> float:
    """How long so many scores take to scroll by [s]."""
    return 2.0 * WAIT + max(count * ROW_HEIGHT - (HEIGHT - TOP), 0) / SCROLL_SPEED


def draw_board(dots: Dots, entry: TableEntry, mode: Mode, rows: Sequence[ScoreRow], seconds: float) -> None:
    """The scores of one table below a line that is left free for its name; they scroll round and round."""
    at = seconds % board_time(len(rows))
    most = max(len(rows) * ROW_HEIGHT - (HEIGHT - TOP), 0)
    moved = round(min(max(at - WAIT, 0.0) * SCROLL_SPEED, float(most)))
    for place, row in enumerate(rows, 1):
        y = TOP + (place - 1) * ROW_HEIGHT - moved
        if TOP - ROW_HEIGHT < y < HEIGHT:
            _draw_row(dots, place, row, y)
    dots.box(0, 0, WIDTH, TOP, 0)


def _draw_row(dots: Dots, place: int, row: ScoreRow, y: int) -> None:
    """Rank, initials and score large; the date small, for it matters least, and only where there is room."""
    dots.text(f"{place}", 11, y + 2, NORMAL, "right", page_layout.HALF)
    dots.text(row.initials, 15, y, BOLD)
    score = f"{row.score:,}"
    left = 20 + BOLD.width(row.initials)
    right = WIDTH - TINY.width(row.date) - 3
    has_date = BOLD.width(score) <= right - left
    dots.number(row.score, right if has_date else WIDTH, y, WIDTH - left, (BOLD, NORMAL, TINY), "right", 220)
    if has_date:
        dots.text(row.date, WIDTH, y + 3, TINY, "right", page_layout.HALF)
