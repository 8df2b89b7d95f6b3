"""Draw the picture of the first limit in docs/original.md: `python docs/make_original.py`.

A ball at the speed cap meets a slant wall, 30 pictures a second: once moved and then tested for an overlap,
as the original does, once as Silverball plays it.
"""

from __future__ import annotations

import math
from pathlib import Path

from PIL import Image, ImageDraw

import silverball as sb
from silverball.table import Board, SlantWall, Table

PICTURE = Path(__file__).with_name("original_limit.png")
RATE = 30  # frames per second
WALL = SlantWall(start=(-1.2, 1.0), end=(1.2, 1.3))
BOARD = Board()
START, VELOCITY = (0.0, -0.69), (0.0, BOARD.speed_cap)  # (x, z) [u] and to the right [u/s]
SHOWN = 8  # positions
MIDDLE, HALF = (-0.1, 1.1), (1.6, 2.6)  # of the part of the board that is shown, x and z [u]
SCALE, FINER = 110, 3  # pixels per unit; drawn larger by this factor, for smooth edges


def moved_then_tested() -> tuple[list[tuple[float, float]], bool]:
    """Positions of a ball that is moved first and tested afterwards; and whether a test found the wall."""
    (x, z), (vx, vz) = START, VELOCITY
    places, has_hit = [(x, z)], False
    for _ in range(SHOWN - 1):
        vx -= BOARD.gravity / RATE
        x, z = x + vx / RATE, z + vz / RATE
        places.append((x, z))
        has_hit = has_hit or distance(x, z) < BOARD.ball_radius + WALL.thickness
    return places, has_hit


def played() -> list[tuple[float, float]]:
    """Positions of the same ball in Silverball."""
    world = sb.World(Table(board=BOARD, slant_wall=(WALL,)), tick_rate=RATE)
    world.create_ball(START, VELOCITY)
    places = [START]
    for _ in range(SHOWN - 1):
        world.step()
        x, _, z = world.balls[0].position
        places.append((x, z))
    return places


def distance(x: float, z: float) -> float:
    """Distance [u] of a point from the middle line of the wall."""
    (ax, az), (bx, bz) = WALL.start, WALL.end
    along = ((x - ax) * (bx - ax) + (z - az) * (bz - az)) / ((bx - ax) ** 2 + (bz - az) ** 2)
    along = min(max(along, 0.0), 1.0)
    return math.hypot(x - ax - along * (bx - ax), z - az - along * (bz - az))


def pixel(x: float, z: float) -> tuple[float, float]:
    """The pixel that shows a point of the board, as the player sees it."""
    scale = SCALE * FINER
    return (z - MIDDLE[1] + HALF[1]) * scale, (MIDDLE[0] + HALF[0] - x) * scale


def panel(places: list[tuple[float, float]], colour: str) -> Image.Image:
    """Draw one of the two halves of the picture."""
    scale = SCALE * FINER
    image = Image.new("RGB", (round(2 * HALF[1] * scale), round(2 * HALF[0] * scale)), "#12141c")
    draw = ImageDraw.Draw(image)
    draw.line([pixel(*WALL.start), pixel(*WALL.end)], "#e8d44d", round(2 * WALL.thickness * scale))
    for x, z in (WALL.start, WALL.end):
        draw.circle(pixel(x, z), WALL.thickness * scale, "#e8d44d")
    for x, z in places:
        draw.circle(pixel(x, z), BOARD.ball_radius * scale, outline=colour, width=2 * FINER)
    draw.line([pixel(*place) for place in places], colour, FINER)
    return image.resize((image.width // FINER, image.height // FINER), Image.Resampling.LANCZOS)


def draw() -> None:
    """Write the picture."""
    through, has_hit = moved_then_tested()
    assert not has_hit, "the ball that moves first must slip through, else this shows nothing"
    halves = [panel(through, "#ff6a5c"), panel(played(), "#5cc8ff")]
    both = Image.new("RGB", (halves[0].width + halves[1].width + 12, halves[0].height), "white")
    both.paste(halves[0], (0, 0))
    both.paste(halves[1], (halves[0].width + 12, 0))
    both.save(PICTURE, optimize=True)


if __name__ == "__main__":
    draw()
    print(f"wrote {PICTURE}")
