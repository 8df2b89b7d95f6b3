"""What does the display show when nobody is there? Name, best scores, how to begin, and tips, in turn."""

from __future__ import annotations

import math
from collections.abc import Callable

from silverball.app.bindings import keys_of
from silverball.app.menus import page as layout
from silverball.app.menus.commands import Attract, Button, Command
from silverball.app.menus.desk import Desk, Page
from silverball.app.menus.high_scores import MODES
from silverball.drawing.dotmatrix.animations import draw_ball
from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH, Dots, scroll, wipe
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL

PAGE_TIME = 4.0  # [s]
CHANGE_TIME = 0.5  # [s] of it, in which one page gives way to the next
NAME = "SILVERBALL"


class AttractPage(Page):
    """Pages that turn by themselves; any button leads to the main menu."""

    name = "attract"
    repeats = False
    quiet = False

    def press(self, button: Button, desk: Desk) -> Command | None:
        """Somebody is there."""
        desk.back()
        return Attract(False)

    def draw(self, desk: Desk, seconds: float, below: Dots) -> Dots:
        """The page whose turn it is."""
        pages = self._pages(desk)
        turn, at = divmod(max(seconds - self.shown_at, 0.0), PAGE_TIME)
        now = pages[int(turn) % len(pages)](desk, at)
        if turn < 1.0 or at >= CHANGE_TIME:
            return now
        before = pages[(int(turn) - 1) % len(pages)](desk, PAGE_TIME + at)
        share = at / CHANGE_TIME
        return wipe(before, now, share, "right") if int(turn) % 2 else scroll(before, now, share, "up")

    def _pages(self, desk: Desk) -> list[Callable[[Desk, float], Dots]]:
        pages: list[Callable[[Desk, float], Dots]] = [title_picture, _start_picture]
        if desk.performer is not None:
            pages.append(_performer_picture)
        for board in range(min(len(desk.boards()), 3)):
            pages.append(lambda desk, at, board=board: _best_picture(desk, at, board))  # type: ignore[misc]
            pages.append(_start_picture)
        for tip in range(len(_tips(desk))):
            pages.append(lambda desk, at, tip=tip: _tip_picture(desk, at, tip))  # type: ignore[misc]
        return pages


def title_picture(desk: Desk, at: float) -> Dots:
    """The name; a ball rolls over it and leaves it behind."""
    dots = Dots()
    width = BOLD.width(NAME)
    left = (WIDTH - width) // 2
    ball = round(-10.0 + 110.0 * at)
    dots.text(NAME, left, 8, BOLD, window=(0, max(ball + 5, 0)))
    if ball < WIDTH:
        draw_ball(dots, ball + 4, 13 - 5.0 * abs(math.sin(4.0 * at)))
    # A light runs over the letters once they stand.
    shine = round((at - 2.2) * 130.0)
    if 0 <= shine < WIDTH + 12:
        for row in range(8, 19):
            edge = shine - (row - 8) // 2
            here = dots.pixels[row, max(edge - 6, 0) : max(edge, 0)]
            here[here > 0] = 90
    dots.line(left, 22, left + min(max(ball - left, 0), width), 22, layout.HALF)
    if at > 1.6:
        dots.text("A PINBALL TABLE", WIDTH // 2, 25, NORMAL, "center", layout.HALF)
    return dots


def _start_picture(desk: Desk, at: float) -> Dots:
    dots = Dots()
    key = desk.key("create")
    if layout.blinks(at, 1.0):
        dots.text(f"PRESS {key}", WIDTH // 2, 6, BOLD, "center")
    entry = desk.table()
    text = f"{MODES[desk.mode()]} · {entry.title.upper()}"
    layout.marquee(dots, text, 23, 0, WIDTH, NORMAL, at, brightness=layout.HALF)
    return dots


def _performer_picture(desk: Desk, at: float) -> Dots:
    """Who plays behind these pages."""
    dots = Dots()
    assert desk.performer is not None
    layout.title(dots, "NOW PLAYING", seconds=at)
    layout.middle(dots, desk.performer.label, at)
    layout.foot(dots, (desk.performer.hint,), at)
    return dots


def _best_picture(desk: Desk, at: float, board: int) -> Dots:
    """The three best of a score table, one after the other."""
    dots = Dots()
    boards = desk.boards()
    entry, mode, rows = boards[min(board, len(boards) - 1)]
    layout.title(dots, f"{entry.title.upper()} · {MODES[mode]}", seconds=at)
    place = min(int(at / PAGE_TIME * 3.0), min(len(rows), 3) - 1)
    row = rows[place]
    dots.text(f"{place + 1}", 6, 14, BOLD, "left", layout.HALF)
    dots.text(row.initials, 24, 14, BOLD)
    dots.number(row.score, WIDTH - 2, 14, 94, (BOLD, NORMAL), "right")
    dots.line(0, HEIGHT - 2, round((WIDTH - 1) * min(at / PAGE_TIME, 1.0)), HEIGHT - 2, layout.FAINT)
    return dots


def _tips(desk: Desk) -> list[tuple[str, str]]:
    """What a key does, and the key."""
    tips = []
    for line in desk.actions:
        keys = keys_of(desk.settings, line)
        if keys and line.action in ("left", "right", "create", "jitter", "help"):
            tips.append((line.label, "  ".join(desk.shown(key) for key in keys[:2])))
    return tips


def _tip_picture(desk: Desk, at: float, tip: int) -> Dots:
    dots = Dots()
    tips = _tips(desk)
    label, keys = tips[min(tip, len(tips) - 1)]
    layout.marquee(dots, keys, 3, 0, WIDTH, BOLD, at)
    dots.line(60, 18, 99, 18, layout.FAINT)
    layout.marquee(dots, label, 22, 0, WIDTH, NORMAL, at, brightness=190)
    return dots
