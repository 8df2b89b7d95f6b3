"""The page of high scores: one list per table and mode, each scrolling by itself."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from silverball.app.menus import page_layout
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.context import MenuContext, Page, ScoreRow, TableEntry
from silverball.app.menus.listing import Listing, Row
from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL, TINY
from silverball.game.view import Mode

ROWS = 10  # shown of every list
ROW_HEIGHT = 12  # [dot]; two rows are visible
SCROLL_SPEED = 9.0  # [dot/s] upwards, a row in 1.3 s
WAIT = 2.0  # [s] before scrolling begins, and at its end
TOP = 8  # [dot] where the rows begin
MODE_LABELS = {Mode.ARCADE: "ARCADE", Mode.FREE: "FREE PLAY"}


class ScoresPage(Page):
    """The high scores of every table and mode that has any."""

    name = "scores"

    def __init__(self) -> None:
        self._index = 0

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Turn to another list, or go back."""
        if button in (Button.START, Button.BACK):
            context.back()
            return None
        count = max(len(context.score_lists), 1)
        self._index = (self._index + (-1 if button is Button.LEFT else 1)) % count
        self.shown_at = context.now
        return None

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """Draw the name of the table and its scores."""
        dots = Dots()
        score_lists = context.score_lists
        if not score_lists:
            page_layout.title(dots, "SCORES")
            page_layout.middle(dots, "NO SCORES YET", seconds)
            page_layout.foot(dots, (f"{context.key_label('create')}: BACK",), seconds)
            return dots
        since = max(seconds - self.shown_at, 0.0)
        index = min(self._index, len(score_lists) - 1)
        entry, mode, rows = score_lists[index]
        draw_scores(dots, entry, mode, rows[:ROWS], since)
        page_layout.title(
            dots, f"{entry.title.upper()} · {MODE_LABELS[mode]}", index, len(score_lists), since
        )
        return dots

    def listing(self, context: MenuContext) -> Listing:
        """Return the scores of the shown list, and the rows that turn to another list or go back."""
        lists = context.score_lists
        if not lists:
            return Listing("SCORES", (Row("BACK"),), 0, "NO SCORES YET")
        index = min(self._index, len(lists) - 1)
        entry, mode, rows = lists[index]
        scores = [
            Row(f"{place}  {row.initials}  {row.score:,}", row.date, can_choose=False)
            for place, row in enumerate(rows[:ROWS], 1)
        ]
        buttons = [Row(label) for label, _ in self._buttons(len(lists))]
        title = f"{entry.title.upper()} · {MODE_LABELS[mode]}"
        hint = f"LIST {index + 1} OF {len(lists)}" if len(lists) > 1 else ""
        return Listing(title, (*scores, *buttons), len(scores) + len(buttons) - 1, hint)

    def click(self, index: int, context: MenuContext, step: int) -> Command | None:
        """Turn to another list, or go back."""
        lists = context.score_lists
        buttons = self._buttons(len(lists))
        first = len(lists[min(self._index, len(lists) - 1)][2][:ROWS]) if lists else 0
        return self.press(buttons[index - first][1], context) if index >= first else None

    def _buttons(self, lists: int) -> list[tuple[str, Button]]:
        """Return the labels of what can be done, and the buttons that do it."""
        turns = [("< PREVIOUS LIST", Button.LEFT), ("NEXT LIST >", Button.RIGHT)] if lists > 1 else []
        return [*turns, ("BACK", Button.START)]

    def signature(self) -> Hashable:
        """Return which list is shown."""
        return self._index


def scroll_period(count: int) -> float:
    """Return the time that a list takes to scroll to its end [s]."""
    return 2.0 * WAIT + max(count * ROW_HEIGHT - (HEIGHT - TOP), 0) / SCROLL_SPEED


def draw_scores(dots: Dots, entry: TableEntry, mode: Mode, rows: Sequence[ScoreRow], seconds: float) -> None:
    """Draw the scores of one table, scrolling in a loop below a blank line for its name."""
    at = seconds % scroll_period(len(rows))
    most = max(len(rows) * ROW_HEIGHT - (HEIGHT - TOP), 0)
    moved = round(min(max(at - WAIT, 0.0) * SCROLL_SPEED, float(most)))
    for place, row in enumerate(rows, 1):
        y = TOP + (place - 1) * ROW_HEIGHT - moved
        if TOP - ROW_HEIGHT < y < HEIGHT:
            _draw_row(dots, place, row, y)
    dots.box(0, 0, WIDTH, TOP, 0)


def _draw_row(dots: Dots, place: int, row: ScoreRow, y: int) -> None:
    """Draw rank, initials and score in large letters, and the date in small ones where it fits."""
    dots.text(f"{place}", 11, y + 2, NORMAL, "right", page_layout.HALF)
    dots.text(row.initials, 15, y, BOLD)
    score = f"{row.score:,}"
    left = 20 + BOLD.width(row.initials)
    right = WIDTH - TINY.width(row.date) - 3
    has_date = BOLD.width(score) <= right - left
    dots.number(row.score, right if has_date else WIDTH, y, WIDTH - left, (BOLD, NORMAL, TINY), "right", 220)
    if has_date:
        dots.text(row.date, WIDTH, y + 3, TINY, "right", page_layout.HALF)
