"""What is written above and below the board? The score, the balls, the board's seed, the table's name."""

from __future__ import annotations

import pygame

from silverball.drawing import palette
from silverball.drawing.camera import MARGIN, RAIL, SCORE_HEIGHT, Camera
from silverball.drawing.moment import Moment
from silverball.drawing.text import line, number
from silverball.drawing.walls import apron_top
from silverball.table import Table

SEED_DIGITS = 7  # longer seeds are shortened in the middle


class ScoreLine:
    """The strip above the board.

    Args:
        table: A finished table.
        camera: The view of it.
        board_seed: What the board was made from; a table that is always the same has none to show.
    """

    def __init__(self, table: Table, camera: Camera, board_seed: int | None = None) -> None:
        self._scale = camera.scale
        self._board_seed = board_seed
        self._max_balls = table.board.max_balls
        left, top = camera.to_pixel(
            0.5 * table.board.length + RAIL + SCORE_HEIGHT, -0.5 * table.board.width - RAIL
        )
        right, bottom = camera.to_pixel(
            0.5 * table.board.length + RAIL + 0.14, 0.5 * table.board.width + RAIL
        )
        self.panel = pygame.Rect(round(left), round(top), round(right - left), round(bottom - top))

    def paint_panel(self, still: pygame.Surface) -> None:
        """Paint what does not change onto the still table."""
        scale, panel = self._scale, self.panel
        rounding = round(0.3 * scale)
        gap = max(round(0.1 * scale), 2)
        thin = max(round(0.035 * scale), 1)
        pygame.draw.rect(still, palette.PANEL, panel, border_radius=rounding)
        _frame(still, palette.PANEL_OUTER, panel, thin, rounding)
        _frame(still, palette.PANEL_INNER, panel.inflate(-2 * gap, -2 * gap), thin, rounding - gap)

    def draw(self, target: pygame.Surface, moment: Moment) -> None:
        """Draw the score of a moment."""
        panel, scale = self.panel, self._scale
        inset = round(0.42 * scale)
        size = round(0.92 * scale)
        glyphs = number(moment.score, size, palette.SCORE)
        width = sum(glyph.get_width() for glyph in glyphs)
        across = panel.centerx - width // 2
        for glyph in glyphs:
            target.blit(glyph, (across, panel.centery - glyph.get_height() // 2 + round(0.03 * scale)))
            across += glyph.get_width()
        small = round(0.36 * scale)
        label = line("BALLS", small, palette.LABEL)
        left, upper = panel.left + inset, panel.centery - round(0.19 * scale)
        target.blit(label, label.get_rect(midleft=(left, upper)))
        for number_ in range(self._max_balls):
            spot = (left + round((0.15 + 0.42 * number_) * scale), panel.centery + round(0.21 * scale))
            self._draw_ball(target, spot, number_ < len(moment.balls))
        if self._board_seed is None:
            return
        right = panel.right - inset
        label = line("BOARD", small, palette.LABEL)
        target.blit(label, label.get_rect(midright=(right, upper)))
        seed = line(_short(self._board_seed), small, palette.TEXT)
        target.blit(seed, seed.get_rect(midright=(right, panel.centery + round(0.21 * scale))))

    def _draw_ball(self, target: pygame.Surface, spot: tuple[int, int], there: bool) -> None:
        radius = max(round(0.14 * self._scale), 2)
        if there:
            pygame.draw.aacircle(target, palette.BALL_LIGHT, spot, radius)
        else:
            pygame.draw.aacircle(target, palette.FAINT_TEXT, spot, radius, max(round(0.03 * self._scale), 1))


def paint_name(still: pygame.Surface, table: Table, camera: Camera) -> None:
    """Write the table's name onto the apron, where there is room for it."""
    across, top = camera.to_pixel(apron_top(table.board), 0.0)
    bottom = camera.to_pixel(-0.5 * table.board.length - RAIL - MARGIN, 0.0)[1]
    room = bottom - top
    if room < 0.5 * camera.scale:
        return
    name = line(table.name.upper(), round(min(0.5 * camera.scale, 0.6 * room)), palette.FAINT_TEXT)
    if name.get_width() < 0.8 * table.board.width * camera.scale:
        still.blit(name, name.get_rect(center=(round(across), round(0.5 * (top + bottom)))))


def _frame(target: pygame.Surface, color: palette.Color, box: pygame.Rect, width: int, rounding: int) -> None:
    """A rounded frame, smoothed by drawing it four times as large."""
    large = pygame.Surface((4 * box.width, 4 * box.height), pygame.SRCALPHA)
    large.fill((*color, 0))
    pygame.draw.rect(large, color, large.get_rect(), 4 * width, border_radius=4 * max(rounding, 1))
    target.blit(pygame.transform.smoothscale(large, box.size), box)


def _short(seed: int) -> str:
    text = str(seed)
    return text if len(text) <= SEED_DIGITS else f"{text[:3]}…{text[-3:]}"
