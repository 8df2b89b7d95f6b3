"""How does a moment of play become a picture? The still table, and on it everything that moves.

lights of hits → shadows of balls → trails → balls → apron → paddles → score
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
import pygame
from numpy.typing import NDArray

from silverball.drawing.camera import RAIL, Camera
from silverball.drawing.effects import Effects
from silverball.drawing.moment import Moment
from silverball.drawing.obstacles import cylinder_flash, prism_flash
from silverball.drawing.palette import CYLINDERS, PRISMS, in_turn
from silverball.drawing.scoreline import ScoreLine, paint_name
from silverball.drawing.sprites import BallSprites, Flash, PaddleSprites, Sprite
from silverball.drawing.still import paint_still
from silverball.drawing.walls import apron_top
from silverball.table import Table

ADD = pygame.BLEND_RGB_ADD


class Renderer:
    """Draws one table at one size.

    Args:
        table: A finished table.
        size: Width and height of the picture [pixel]; the table is fitted into it.
        still: The still table if it is painted already, RGB [row, column, 3]; another size is stretched.
        board_seed: Written beside the score if the board was made from it.

    Attributes:
        apron: The plate below the gutter [pixel], under which no play is seen.
        score_panel: The strip above the board [pixel].

    Example:
        >>> import silverball as sb
        >>> from silverball.drawing import Moment, Renderer
        >>> table = sb.load_table("classic")
        >>> Renderer(table, (330, 680)).array(Moment.before(table)).shape
        (680, 330, 3)
    """

    def __init__(
        self,
        table: Table,
        size: tuple[int, int],
        still: NDArray[np.uint8] | None = None,
        *,
        board_seed: int | None = None,
    ) -> None:
        self.table = table
        self.camera = Camera(table.board, size)
        self.effects = Effects()
        self._score_line = ScoreLine(table, self.camera, board_seed)
        self.score_panel = self._score_line.panel
        self.set_still(paint_still(table, self.camera) if still is None else still)
        self._balls = BallSprites(self.camera)
        self._paddles = {paddle.side: PaddleSprites(self.camera, paddle) for paddle in table.paddle}
        self._flashes: dict[str, Flash] = {}
        for index, prism in enumerate(table.triangular_prism):
            flash = prism_flash(self.camera, prism, in_turn(PRISMS, index))
            self._flashes[f"triangular_prism[{index}]"] = Flash(*flash)
        for index, cylinder in enumerate(table.cylinder):
            flash = cylinder_flash(self.camera, cylinder, in_turn(CYLINDERS, index))
            self._flashes[f"cylinder[{index}]"] = Flash(*flash)
        self.apron = self._apron_area()

    def set_still(self, pixels: NDArray[np.uint8]) -> None:
        """Use another painting of the still table, RGB [row, column, 3]."""
        still = pygame.image.frombuffer(pixels.tobytes(), (pixels.shape[1], pixels.shape[0]), "RGB")
        if still.get_size() != self.camera.size:
            still = pygame.transform.smoothscale(still, self.camera.size)
        self._score_line.paint_panel(still)
        paint_name(still, self.table, self.camera)
        self._still = still

    def note(self, events: Iterable[Event], tick_rate: int) -> None:
        """Tell what happened since the last picture, so that it can be seen in the next ones."""
        self.effects.note(events, tick_rate)

    def draw(self, moment: Moment, target: pygame.Surface) -> None:
        """Draw a moment onto a surface of the renderer's size."""
        if self._still.get_masks() != target.get_masks() or self._still.get_bitsize() != target.get_bitsize():
            self._still = self._still.convert(target)
        target.blit(self._still, (0, 0))
        lights = filter(None, (flash.at(strength) for flash, strength in self._lit(moment.time)))
        trails = [self._balls.trail_at(*spot) for spot in self.effects.trails(moment)]
        balls = [*moment.balls, *self.effects.dives(moment.time)]
        for sprite in lights:
            target.blit(*sprite, None, ADD)
        target.blits([self._balls.shadow_at(ball.x, ball.z) for ball in balls], False)
        for sprite in trails:
            target.blit(*sprite, None, ADD)
        target.blits([self._balls.at(ball.x, ball.z) for ball in balls], False)
        target.blit(self._still, self.apron, self.apron)
        target.blits(self._paddle_sprites(moment), False)
        self._score_line.draw(target, moment)

    def surface(self, moment: Moment) -> pygame.Surface:
        """A moment as a new surface of 24 bits, whose bytes are RGB."""
        target = rgb_surface(self.camera.size)
        self.draw(moment, target)
        return target

    def array(self, moment: Moment) -> NDArray[np.uint8]:
        """A moment as RGB, uint8, shape [row, column, 3]."""
        width, height = self.camera.size
        pixels = np.frombuffer(pygame.image.tobytes(self.surface(moment), "RGB"), np.uint8)
        return pixels.reshape(height, width, 3)

    def _lit(self, time: float) -> list[tuple[Flash, float]]:
        return [
            (self._flashes[part], strength)
            for part, strength in self.effects.flashes(time)
            if part in self._flashes
        ]

    def _paddle_sprites(self, moment: Moment) -> list[Sprite]:
        angles = dict(zip(("left", "right"), moment.angles, strict=True))
        return [sprites.at(angles[side]) for side, sprites in self._paddles.items()]

    def _apron_area(self) -> pygame.Rect:
        board = self.table.board
        left, top = self.camera.to_pixel(apron_top(board), -0.5 * board.width)
        right, bottom = self.camera.to_pixel(-0.5 * board.length - RAIL, 0.5 * board.width)
        return pygame.Rect(round(left), round(top), round(right - left), round(bottom - top))


def rgb_surface(size: tuple[int, int]) -> pygame.Surface:
    """A surface of 24 bits whose bytes are RGB; it needs no display."""
    return pygame.image.frombuffer(bytearray(3 * size[0] * size[1]), size, "RGB")


if TYPE_CHECKING:
    from silverball.world import Event
