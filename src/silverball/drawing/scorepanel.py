"""What is shown above the board? The score in dots; or, where nobody gives dots, in plain glyphs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pygame

from silverball.drawing import palette
from silverball.drawing.moment import Moment
from silverball.drawing.text import line, number
from silverball.drawing.themes import Color, Theme

if TYPE_CHECKING:
    from silverball.table import Table

SEED_DIGITS = 7  # longer seeds are shortened in the middle


class ScorePanel:
    """The panel above the board.

    Args:
        area: Where it is [pixel].
        theme: Its colours.
        table: A finished table.
        board_seed: What the board was made from; a table that is always the same has none to show.
    """

    def __init__(self, area: pygame.Rect, theme: Theme, table: Table, board_seed: int | None = None) -> None:
        self.area = area
        self._theme = theme
        self._max_balls = table.board.max_balls
        self._board_seed = board_seed
        self._dot_panel: Any = None
        self._plain: pygame.Surface | None = None
        self._shown: tuple[int, int] | None = None
        edge = max(round(0.045 * area.height), 1)
        self._glass = area.inflate(-4 * edge, -4 * edge)
        self._frame = _frame(area, theme, edge)

    def draw(self, target: pygame.Surface, moment: Moment, dots: Any = None) -> None:
        """Draw the panel: a picture of dots, or the moment's score."""
        if self._frame.get_masks() != target.get_masks() or self._frame.get_bitsize() != target.get_bitsize():
            self._frame = self._frame.convert(target)  # once: the same format is copied fastest
            self._plain = None
        if dots is not None:
            if self._dot_panel is None:
                from silverball.drawing.dotpanel import DotPanel

                self._dot_panel = DotPanel(self._glass, self._theme.dots, self._theme.panel, None)
            target.blit(self._frame, self.area)
            self._dot_panel.draw(target, dots)
            return
        wanted = (moment.score, len(moment.balls))
        if self._plain is None or self._shown != wanted:
            self._plain = self._frame.copy()
            self._write(self._plain, *wanted)
            self._shown = wanted
        target.blit(self._plain, self.area)

    def _write(self, plain: pygame.Surface, score: int, balls: int) -> None:
        box = plain.get_rect()
        size = max(round(0.72 * box.height), 6)
        glyphs = number(score, size, self._theme.dots)
        width = sum(glyph.get_width() for glyph in glyphs)
        across = box.centerx - width // 2
        for glyph in glyphs:
            plain.blit(glyph, (across, box.centery - glyph.get_height() // 2 + round(0.03 * box.height)))
            across += glyph.get_width()
        small, inset = max(round(0.24 * box.height), 6), round(0.28 * box.height)
        upper, lower = round(0.36 * box.height), round(0.66 * box.height)
        label = line("BALLS", small, palette.LABEL)
        plain.blit(label, label.get_rect(midleft=(inset, upper)))
        radius = max(round(0.09 * box.height), 1)
        for index in range(self._max_balls):
            spot = (inset + radius + round(2.9 * radius * index), lower)
            rim = 0 if index < balls else max(radius // 4, 1)
            pygame.draw.circle(
                plain, palette.TEXT if index < balls else palette.FAINT_TEXT, spot, radius, rim
            )
        if self._board_seed is not None:
            label = line("BOARD", small, palette.LABEL)
            plain.blit(label, label.get_rect(midright=(box.width - inset, upper)))
            seed = line(_short(self._board_seed), small, palette.TEXT)
            plain.blit(seed, seed.get_rect(midright=(box.width - inset, lower)))


def _frame(area: pygame.Rect, theme: Theme, edge: int) -> pygame.Surface:
    """The dark panel in its two lines of light, smoothed by drawing it larger."""
    large = pygame.Surface((3 * area.width, 3 * area.height), 0, 24)
    large.fill(theme.room)
    whole = large.get_rect()
    rounding = max(whole.height // 9, 1)
    pygame.draw.rect(large, theme.panel, whole, border_radius=rounding)
    _rim(large, theme.panel_edges[0], whole, 3 * max(edge // 2, 1), rounding)
    _rim(large, theme.panel_edges[1], whole.inflate(-6 * edge, -6 * edge), 2 * max(edge // 2, 1), rounding)
    return pygame.transform.smoothscale(large, area.size)


def _rim(large: pygame.Surface, color: Color, box: pygame.Rect, width: int, rounding: int) -> None:
    if box.width > 2 * width and box.height > 2 * width:
        pygame.draw.rect(large, color, box, width, border_radius=rounding)


def _short(seed: int) -> str:
    text = str(seed)
    return text if len(text) <= SEED_DIGITS else f"{text[:3]}…{text[-3:]}"
