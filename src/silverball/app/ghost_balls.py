"""The balls of a rival, faint rings on the picture of the player's table."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pygame

if TYPE_CHECKING:
    from silverball.app.rival import Rival
    from silverball.drawing.camera import Camera

LIGHT = (190, 215, 255)
RING, DISC = 150, 60  # opacity


def draw_ghost_balls(target: pygame.Surface, camera: Camera, rival: Rival) -> None:
    """Draw where the balls of a rival are, onto a picture through its camera."""
    world = rival.game.world
    height = world.table.board.ball_radius
    for ball in world.balls:
        x, _, z = ball.position
        across, down = camera.to_pixel(x, z, height)
        radius = max(round(height * camera.scale), 2)
        size = 2 * radius + 2
        faint = pygame.Surface((size, size), pygame.SRCALPHA)
        centre = (radius + 1, radius + 1)
        pygame.draw.circle(faint, (*LIGHT, DISC), centre, radius)
        pygame.draw.circle(faint, (*LIGHT, RING), centre, radius, max(radius // 4, 1))
        target.blit(faint, (round(across) - radius - 1, round(down) - radius - 1))
