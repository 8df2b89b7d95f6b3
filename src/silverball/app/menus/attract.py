"""The attract mode: while no button is pressed, the title, the best scores and tips alternate."""

from __future__ import annotations

import math
from collections.abc import Callable

from silverball.app.bindings import keys_for
from silverball.app.menus import page_layout
from silverball.app.menus.commands import Attract, Button, Command
from silverball.app.menus.context import MenuContext, Page
from silverball.app.menus.high_scores import MODE_LABELS
from silverball.app.menus.pages import play
from silverball.drawing.dotmatrix.animations import draw_ball
from silverball.drawing.dotmatrix.canvas import HEIGHT, WIDTH, Dots, scroll, wipe
from silverball.drawing.dotmatrix.fonts import BOLD, NORMAL

PAGE_TIME = 4.0  # [s]
CHANGE_TIME = 0.5  # [s] of it for the transition to the next page
NAME = "SILVERBALL"
SHINE = 90  # brightness of the letters under the light that sweeps over them


class AttractPage(Page):
    """Alternating pages; Space begins a game, any other button leads to the main menu."""

    name = "attract"
    repeats = False
    allows_attract = False

    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Begin a game with Space; go back to the main menu with any other button."""
        if button is Button.START:
            context.close()
            return play(context)
        context.back()
        return Attract(False)

    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """Draw the current page, or the transition to it."""
        pages = self._pages(context, below)
        turn, at = divmod(max(seconds - self.shown_at, 0.0), PAGE_TIME)
        now = pages[int(turn) % len(pages)](context, at)
        if turn < 1.0 or at >= CHANGE_TIME:
            return now
        before = pages[(int(turn) - 1) % len(pages)](context, PAGE_TIME + at)
        share = at / CHANGE_TIME
        return wipe(before, now, share, "right") if int(turn) % 2 else scroll(before, now, share, "up")

    def _pages(self, context: MenuContext, below: Dots) -> list[Callable[[MenuContext, float], Dots]]:
        """Return the pages in their order; the display of the game that is played comes twice as long."""
        pages: list[Callable[[MenuContext, float], Dots]] = [title_picture, _start_picture]
        if context.demo_player is not None:
            pages.append(_demo_player_picture)
            pages += 2 * [lambda context, at: below.copy()]
        for index in range(min(len(context.score_lists), 3)):
            pages.append(lambda context, at, index=index: _best_picture(context, at, index))  # type: ignore[misc]
            pages.append(_start_picture)
        for tip in range(len(_tips(context))):
            pages.append(lambda context, at, tip=tip: _tip_picture(context, at, tip))  # type: ignore[misc]
        return pages


def title_picture(context: MenuContext, at: float) -> Dots:
    """Draw the title, uncovered by a ball that rolls across."""
    dots = Dots()
    width = BOLD.width(NAME)
    left = (WIDTH - width) // 2
    ball = round(-10.0 + 110.0 * at)
    dots.text(NAME, left, 8, BOLD, window=(0, max(ball + 5, 0)))
    if ball < WIDTH:
        draw_ball(dots, ball + 4, 13 - 5.0 * abs(math.sin(4.0 * at)))
    # A light sweeps over the letters once they are complete.
    shine = round((at - 2.2) * 130.0)
    if 0 <= shine < WIDTH + 12:
        for row in range(8, 19):
            edge = shine - (row - 8) // 2
            shine_pixels = dots.pixels[row, max(edge - 6, 0) : max(edge, 0)]
            shine_pixels[shine_pixels > 0] = SHINE
    dots.line(left, 22, left + min(max(ball - left, 0), width), 22, page_layout.HALF)
    if at > 1.6:
        dots.text("A PINBALL TABLE", WIDTH // 2, 25, NORMAL, "center", page_layout.HALF)
    return dots


def _start_picture(context: MenuContext, at: float) -> Dots:
    dots = Dots()
    key = context.key_label("create")
    if page_layout.is_blink_on(at, 1.0):
        dots.text(f"PRESS {key}", WIDTH // 2, 6, BOLD, "center")
    entry = context.table
    text = f"{MODE_LABELS[context.mode]} · {entry.title.upper()}"
    page_layout.marquee(dots, text, 23, 0, WIDTH, NORMAL, at, brightness=page_layout.HALF)
    return dots


def _demo_player_picture(context: MenuContext, at: float) -> Dots:
    """Draw the name of the player of the current demo."""
    dots = Dots()
    assert context.demo_player is not None
    page_layout.title(dots, "NOW PLAYING", seconds=at)
    page_layout.middle(dots, context.demo_player.label, at)
    page_layout.foot(dots, (context.demo_player.hint,), at)
    return dots


def _best_picture(context: MenuContext, at: float, index: int) -> Dots:
    """Draw the three best scores of a list, one after the other."""
    dots = Dots()
    score_lists = context.score_lists
    entry, mode, rows = score_lists[min(index, len(score_lists) - 1)]
    page_layout.title(dots, f"{entry.title.upper()} · {MODE_LABELS[mode]}", seconds=at)
    place = min(int(at / PAGE_TIME * 3.0), min(len(rows), 3) - 1)
    row = rows[place]
    dots.text(f"{place + 1}", 6, 14, BOLD, "left", page_layout.HALF)
    dots.text(row.initials, 24, 14, BOLD)
    dots.number(row.score, WIDTH - 2, 14, 94, (BOLD, NORMAL), "right")
    dots.line(0, HEIGHT - 2, round((WIDTH - 1) * min(at / PAGE_TIME, 1.0)), HEIGHT - 2, page_layout.FAINT)
    return dots


def _tips(context: MenuContext) -> list[tuple[str, str]]:
    """Return the labels of the main actions, each with its keys."""
    tips = []
    for binding in context.actions:
        keys = keys_for(context.settings.current, binding)
        if keys and binding.action in ("left", "right", "create", "jitter", "help"):
            tips.append((binding.label, "  ".join(context.button_label(key) for key in keys[:2])))
    return tips


def _tip_picture(context: MenuContext, at: float, tip: int) -> Dots:
    dots = Dots()
    tips = _tips(context)
    label, keys = tips[min(tip, len(tips) - 1)]
    page_layout.marquee(dots, keys, 3, 0, WIDTH, BOLD, at)
    dots.line(60, 18, 99, 18, page_layout.FAINT)
    page_layout.marquee(dots, label, 22, 0, WIDTH, NORMAL, at, brightness=190)
    return dots
