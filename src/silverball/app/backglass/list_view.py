"""Draws a menu page as a list or a grid, and finds what is under the mouse."""

from __future__ import annotations

from typing import NamedTuple

import pygame

from silverball.app.backglass.words import clipped, label_row
from silverball.app.menus.listing import Listing
from silverball.drawing import themes
from silverball.drawing.themes import Theme

ROW = 1.5  # height of a row, by the size of its text
TITLE, HINT, TEXT = 1.2, 0.8, 3.0  # sizes of title, hint and large text, by that of a row's text
ARROW = 1.2  # width of the arrow on which a click steps back, by the size of the text
TITLE_SHARE = 0.6  # width of the title, at most; the hint is beside it
INSET = 0.5  # between the edge of a row and its text, by the size of the text


class Hit(NamedTuple):
    """What is under the mouse: a row of the listing, and the step that a click means for a setting."""

    row: int
    step: int = 1


class _Cell(NamedTuple):
    """Where a row is in the window [pixel], its index, and the arrow on which a click steps back."""

    area: pygame.Rect
    row: int
    arrow: pygame.Rect


NOWHERE = pygame.Rect(0, 0, 0, 0)


class ListView:
    """The list that was drawn last."""

    def __init__(self) -> None:
        self._cells: list[_Cell] = []
        self._listing: Listing | None = None
        self._labels: tuple[str, ...] = ()  # of the page that is shown
        self._first = 0  # its first visible row

    def clear(self) -> None:
        """Forget the list, because something else is shown."""
        self._cells, self._listing, self._labels = [], None, ()

    @property
    def is_shown(self) -> bool:
        """Whether a list or a grid is on screen."""
        return self._listing is not None

    def at(self, position: tuple[int, int]) -> Hit | None:
        """Return what is at a position in the window [pixel]; None if it is nothing to choose."""
        for cell in self._cells:
            if cell.area.collidepoint(position):
                if self._listing is None or not self._listing.rows[cell.row].can_choose:
                    return None
                return Hit(cell.row, -1 if cell.arrow.collidepoint(position) else 1)
        return None

    def draw(
        self, target: pygame.Surface, listing: Listing, size: int, theme: Theme, top_left: tuple[int, int]
    ) -> None:
        """Draw a listing onto a part of the window.

        Args:
            target: That part.
            listing: The page.
            size: Size of the text [pixel].
            theme: Colours.
            top_left: Where the part is in the window [pixel].
        """
        self._listing, self._cells = listing, []
        width, height = target.get_size()
        title = clipped(listing.title, round(TITLE * size), themes.SCORE, round(TITLE_SHARE * width))
        target.blit(title, (0, 0))
        beside = width - title.get_width() - size
        hint = clipped(listing.hint, round(HINT * size), themes.LABEL, beside)
        target.blit(hint, hint.get_rect(midright=(width, title.get_height() // 2)))
        top = round(1.4 * TITLE * size)
        if listing.text:
            large = clipped(listing.text, round(TEXT * size), themes.TEXT, width)
            target.blit(large, large.get_rect(midtop=(width // 2, top)))
            top += round(1.1 * TEXT * size)
        room = pygame.Rect(0, top, width, max(height - top, 1))
        if listing.columns > 1:
            self._draw_grid(target, room, size, theme)
        else:
            self._draw_rows(target, room, size, theme)
        self._cells = [
            _Cell(cell.area.move(top_left), cell.row, cell.arrow.move(top_left)) for cell in self._cells
        ]

    def _draw_rows(self, target: pygame.Surface, room: pygame.Rect, size: int, theme: Theme) -> None:
        listing = self._listing
        assert listing is not None
        step = round(ROW * size)
        visible = max(room.height // step, 1)
        first = self._first_row(visible)
        inset = round(INSET * size)
        for place, index in enumerate(range(first, min(first + visible, len(listing.rows)))):
            row = listing.rows[index]
            cell = pygame.Rect(0, room.top + place * step, room.width, step - 2)
            is_chosen = index == listing.chosen
            if is_chosen:
                _draw_bar(target, cell, theme, listing.is_editing)
            detail = f"<  {row.detail}  >" if row.is_value else row.detail
            words = themes.TEXT if row.can_choose else themes.FAINT_TEXT
            colors = (themes.SCORE if is_chosen else words, words if row.is_value else themes.FAINT_TEXT)
            inner = target.subsurface(cell.inflate(-2 * inset, 0).clip(target.get_rect()))
            words_at = label_row(inner, row.label, detail, (step - round(1.3 * size)) // 2, size, colors)
            left = cell.left + inset + words_at.left
            arrow = pygame.Rect(left, cell.top, round(ARROW * size), cell.height) if row.is_value else NOWHERE
            self._cells.append(_Cell(cell, index, arrow))
        if first > 0 or first + visible < len(listing.rows):
            _draw_position(target, room, first, visible, len(listing.rows), theme)

    def _first_row(self, visible: int) -> int:
        """Return the first row of those that are visible.

        A page that has opened has its chosen row in the middle. From then on rows move only if the chosen one
        would not be visible: one that the mouse points at stays where it is.
        """
        listing = self._listing
        assert listing is not None
        labels, last = tuple(row.label for row in listing.rows), max(len(listing.rows) - visible, 0)
        if labels != self._labels:
            self._labels, self._first = labels, listing.chosen - visible // 2
        self._first = max(min(self._first, listing.chosen), listing.chosen - visible + 1)
        self._first = min(max(self._first, 0), last)
        return self._first

    def _draw_grid(self, target: pygame.Surface, room: pygame.Rect, size: int, theme: Theme) -> None:
        listing = self._listing
        assert listing is not None
        rows = -(-len(listing.rows) // listing.columns)
        wide, high = room.width // listing.columns, min(room.height // max(rows, 1), round(2.0 * size))
        for index, row in enumerate(listing.rows):
            down, across = divmod(index, listing.columns)
            cell = pygame.Rect(across * wide, room.top + down * high, wide - 3, high - 3)
            self._cells.append(_Cell(cell, index, NOWHERE))
            if index == listing.chosen:
                _draw_bar(target, cell, theme, is_strong=True)
            color = themes.SCORE if index == listing.chosen else themes.TEXT
            text = clipped(row.label, min(size, round(0.7 * high)), color, cell.width)
            target.blit(text, text.get_rect(center=cell.center))


def _draw_bar(target: pygame.Surface, cell: pygame.Rect, theme: Theme, is_strong: bool) -> None:
    """Draw the bar behind the chosen row."""
    edge = theme.panel_edges[1]
    face = tuple(round((0.42 if is_strong else 0.24) * channel) for channel in edge)
    rounding = max(cell.height // 5, 1)
    pygame.draw.rect(target, face, cell, border_radius=rounding)
    pygame.draw.rect(target, edge, cell, 1, border_radius=rounding)


def _draw_position(
    target: pygame.Surface, room: pygame.Rect, first: int, visible: int, count: int, theme: Theme
) -> None:
    """Draw how far a long list has been scrolled."""
    height = max(room.height * visible // count, 4)
    bar = pygame.Rect(room.right - 3, room.top + room.height * first // count, 3, height)
    pygame.draw.rect(target, theme.panel_edges[1], bar, border_radius=1)
