"""The panel above the board, which shows given dots, or the score and the board's name."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pygame

from silverball.drawing.dotmatrix.canvas import WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import BOLD, HUGE, NORMAL, fitting
from silverball.drawing.dotmatrix.panel import DotPanel
from silverball.drawing.moment import Moment
from silverball.drawing.themes import Color, Theme

if TYPE_CHECKING:
    from silverball.table import Table

FAINT = 130  # brightness of less important text


class ScorePanel:
    """The panel above the board.

    Args:
        area: Its area in the picture [pixel].
        theme: Its colours.
        table: A finished table.
        board_seed: The seed of a random board; None for other tables.
    """

    def __init__(self, area: pygame.Rect, theme: Theme, table: Table, board_seed: int | None = None) -> None:
        self.area = area
        has_seed = board_seed is not None and not table.name.endswith(str(board_seed))
        self._name = f"{table.name} {board_seed}" if has_seed else table.name
        edge = max(round(0.045 * area.height), 1)
        self._frame = _frame(area, theme, edge)
        self._panel = DotPanel(area.inflate(-4 * edge, -4 * edge), theme.dots, theme.panel, None)
        self._plain: tuple[int, Dots] | None = None  # a score, and its dots

    def draw(self, target: pygame.Surface, moment: Moment, dots: Dots | None = None) -> None:
        """Draw the panel with the given dots, or with the moment's score."""
        if self._frame.get_masks() != target.get_masks() or self._frame.get_bitsize() != target.get_bitsize():
            # Once, because surfaces of the same format are copied fastest
            self._frame = self._frame.convert(target)
        target.blit(self._frame, self.area)
        self._panel.draw(target, self._score(moment.score) if dots is None else dots)

    def _score(self, score: int) -> Dots:
        if self._plain is None or self._plain[0] != score:
            self._plain = score, score_dots(score, self._name)
        return self._plain[1]


def score_dots(score: int, name: str) -> Dots:
    """Return dots with a score above a board's name; before the first point with the name alone."""
    dots, text = Dots(), name.upper()
    if score:
        dots.number(score, WIDTH // 2, 1, WIDTH, (HUGE, BOLD, NORMAL))
        dots.text(text, WIDTH // 2, 24, fitting(text, WIDTH, (NORMAL,)), "center", FAINT)
    else:
        dots.text(text, WIDTH // 2, 10, fitting(text, WIDTH, (BOLD, NORMAL)), "center")
    return dots


def _frame(area: pygame.Rect, theme: Theme, edge: int) -> pygame.Surface:
    """Return the dark panel with its two bright outlines, drawn larger and shrunk to smooth them."""
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
