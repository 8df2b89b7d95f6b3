"""Everything in a window beside the table; only what has changed is drawn again.

The *face* (painting, panels, name of the table) is composed once per size, theme and table. On it lie three
panes: the display, the score card (ball, best score, rank, …) and the body (rules card, list, or help). A
pane is drawn when its content differs from what the window shows.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import NamedTuple

import pygame

from silverball.app.arrangement import Arrangement
from silverball.app.backglass.backdrop import backdrop
from silverball.app.backglass.card import Card
from silverball.app.backglass.card_view import draw_card
from silverball.app.backglass.list_view import ListView
from silverball.app.backglass.words import clipped
from silverball.app.menus.listing import Listing
from silverball.app.score_display import WIDE_ROWS
from silverball.drawing import themes
from silverball.drawing.dotmatrix.canvas import WIDTH, Levels
from silverball.drawing.dotmatrix.panel import DotPanel
from silverball.drawing.text import line
from silverball.drawing.themes import Theme

TEXT_BY_HEIGHT, TEXT_BY_WIDTH = 31, 34  # the backglass is at least so many times as high and wide as its text
MIN_TEXT = 10  # [pixel]
DISPLAY_SHARE = 0.4  # height of the display, at most, by that of the backglass
DISPLAY_MARGIN = 1.04  # width of the display with its frame, at most, by that of its dots
BLINKS = 2.5  # [1/s]
FACE_OPACITY = 205  # of 255; of panels over the painting
ELSEWHERE = pygame.Rect(-10_000, 0, 0, 0)  # a table on another screen, towards which nothing fades


class Cell(NamedTuple):
    """A cell of the score card: a label and a value; in a match the one of the player who is up is marked."""

    label: str
    value: str
    is_marked: bool = False


class Content(NamedTuple):
    """What a backglass shows.

    Attributes:
        title: The name of the table.
        theme: Colours.
        dots: The display; None: it shows nothing.
        cells: The score card.
        body: The rules card, a list, or a picture such as the help.
        body_key: Identifies that picture.
    """

    title: str
    theme: Theme
    dots: Levels
    cells: tuple[Cell, ...]
    body: Card | Listing | pygame.Surface
    body_key: Hashable = None


class Places(NamedTuple):
    """Where the parts of a backglass are in the window [pixel], and the size of their text."""

    title: pygame.Rect
    display: pygame.Rect
    cells: pygame.Rect
    body: pygame.Rect
    text: int

    @property
    def inner_body(self) -> pygame.Rect:
        """The body without its margin."""
        margin = -round(1.2 * self.text)
        return self.body.inflate(margin, margin)


def places(area: pygame.Rect) -> Places:
    """Return where the parts of a backglass are that fills an area."""
    text = max(min(area.height // TEXT_BY_HEIGHT, area.width // TEXT_BY_WIDTH), MIN_TEXT)
    gap = round(0.5 * text)
    inner = area.inflate(-2 * gap, -2 * gap)
    title = pygame.Rect(inner.topleft, (inner.width, round(2.2 * text)))
    height = min(inner.width * WIDE_ROWS // WIDTH, round(DISPLAY_SHARE * area.height))
    shape = min(inner.width, round(DISPLAY_MARGIN * height * WIDTH / WIDE_ROWS))
    display = pygame.Rect(inner.centerx - shape // 2, title.bottom, shape, height)
    cells = pygame.Rect(inner.left, display.bottom + gap, inner.width, round(2.6 * text))
    top = cells.bottom + gap
    return Places(title, display, cells, pygame.Rect(inner.left, top, inner.width, inner.bottom - top), text)


class Backglass:
    """Draws the window around the table.

    Attributes:
        list_view: The list that is shown, for the mouse.
    """

    def __init__(self) -> None:
        self.list_view = ListView()
        self._face: pygame.Surface | None = None
        self._face_key: Hashable = None  # what it was composed for
        self._shown_face: Hashable = None  # the face that the window shows
        self._panel: DotPanel | None = None
        self._shown: dict[str, Hashable] = {}  # what the window shows, by pane

    def invalidate(self) -> None:
        """Draw everything anew in the next frame, because the window may show something else."""
        self._shown_face = None

    def draw(
        self, window: pygame.Surface, arrangement: Arrangement, content: Content, seconds: float
    ) -> None:
        """Draw what has changed into a window, except for the table.

        Args:
            window: The window.
            arrangement: Where table and backglass are in it.
            content: What to show.
            seconds: Time of a monotonic clock [s], by which lamps blink.
        """
        area = arrangement.backglass
        assert area is not None, "draw_around() draws windows without a backglass"
        if arrangement.is_apart:
            arrangement = Arrangement(ELSEWHERE, area)
        is_new = self._draw_face(window, arrangement, content.theme, content.title)
        at = places(area)
        assert self._panel is not None
        self._panel.draw_changes(window, content.dots, whole=is_new)
        if self._is_changed("cells", content.cells):
            self._draw_cells(self._pane(window, at.cells), content.cells, at.text)
        is_on = int(2.0 * BLINKS * seconds) % 2 == 0
        self._draw_body(window, at, content, is_on)

    def draw_around(self, window: pygame.Surface, arrangement: Arrangement, theme: Theme) -> None:
        """Draw the painting around a table without a backglass beside it."""
        self.list_view.clear()
        if arrangement.table.size != window.get_size():
            self._draw_face(window, Arrangement(arrangement.table), theme, "")

    def _draw_face(self, window: pygame.Surface, arrangement: Arrangement, theme: Theme, title: str) -> bool:
        """Draw the face if the window does not show it; return whether it did not."""
        key = window.get_size(), tuple(arrangement.table), theme, title
        if key == self._shown_face:
            return False
        if key != self._face_key or self._face is None:
            self._face = self._composed_face(window, arrangement, theme, title)
            self._face_key = key
        self._shown_face = key
        self._shown.clear()
        window.blit(self._face, (0, 0))
        return True

    def _is_changed(self, pane: str, content: Hashable) -> bool:
        """Return whether a pane shows something else, and note what it shows from now on."""
        is_changed = self._shown.get(pane, self) != content
        self._shown[pane] = content
        return is_changed

    def _pane(self, window: pygame.Surface, area: pygame.Rect) -> pygame.Surface:
        """Return a part of the window, with nothing but the face on it."""
        assert self._face is not None
        area = area.clip(window.get_rect())
        window.blit(self._face, area, area)
        return window.subsurface(area)

    def _composed_face(
        self, window: pygame.Surface, arrangement: Arrangement, theme: Theme, name: str
    ) -> pygame.Surface:
        """Return painting, panels and title; the display gets its place, too."""
        face = backdrop(window.get_size(), theme, arrangement.table).convert(window)
        if arrangement.backglass is None:
            return face
        at = places(arrangement.backglass)
        self._panel = DotPanel(at.display, theme.dots, theme.panel, theme.metal, rows=WIDE_ROWS)
        size = round(1.5 * at.text)
        title = clipped(name.upper(), size, themes.TEXT, at.title.width)
        glow = clipped(name.upper(), size, theme.panel_edges[0], at.title.width)
        place = title.get_rect(center=at.title.center)
        for shift in ((-2, 0), (2, 0), (0, -2), (0, 2)):
            face.blit(glow, place.move(shift))
        face.blit(title, place)
        for panel in (at.cells, at.body):
            _draw_panel(face, panel, theme, at.text)
        return face

    def _draw_cells(self, target: pygame.Surface, cells: tuple[Cell, ...], size: int) -> None:
        """Draw the score card: labels above values, side by side."""
        width = target.get_width() // max(len(cells), 1)
        for number, cell in enumerate(cells):
            middle = number * width + width // 2
            label = line(cell.label, round(0.62 * size), themes.FAINT_TEXT)
            color = themes.SCORE if cell.is_marked else themes.TEXT
            value = clipped(cell.value, round(1.3 * size), color, round(0.94 * width))
            target.blit(label, label.get_rect(midtop=(middle, round(0.25 * size))))
            target.blit(value, value.get_rect(midbottom=(middle, target.get_height() - round(0.1 * size))))

    def _draw_body(self, window: pygame.Surface, at: Places, content: Content, is_on: bool) -> None:
        body, area = content.body, at.inner_body
        if isinstance(body, pygame.Surface):
            self.list_view.clear()
            if self._is_changed("body", ("picture", content.body_key)):
                target = self._pane(window, area)
                target.blit(body, body.get_rect(center=(area.width // 2, area.height // 2)))
        elif isinstance(body, Listing):
            if self._is_changed("body", body):
                target = self._pane(window, area)
                self.list_view.draw(target, body, at.text, content.theme, area.topleft)
        else:
            self.list_view.clear()
            if self._is_changed("body", (body, is_on and body.blinks)):
                draw_card(self._pane(window, area), body, at.text, content.theme, is_on)


def _draw_panel(face: pygame.Surface, area: pygame.Rect, theme: Theme, size: int) -> None:
    """Draw a dark translucent panel with a thin bright edge."""
    veil = pygame.Surface(area.size, pygame.SRCALPHA)
    rounding = round(0.5 * size)
    pygame.draw.rect(veil, (*theme.panel, FACE_OPACITY), veil.get_rect(), border_radius=rounding)
    pygame.draw.rect(
        veil, (*theme.panel_edges[1], 150), veil.get_rect(), max(size // 16, 1), border_radius=rounding
    )
    face.blit(veil, area)
