"""Layers of a frame: kernels that blend moving parts, levels, light and spots into rectangles of its pixels.

A frame is RGB, uint8 [row, column, 3]; a second array holds the height [u] of what each pixel shows, float32
[row, column]. Rectangles are given by their first column and row and may extend beyond the frame.
"""

from __future__ import annotations

from math import sqrt

from silverball.drawing.kernels.stage import Box, Boxes, Cells, Heights, Pixels, Records, Spots, StageRecord
from silverball.physics.kernel import inlined, kernel

TILE = 32  # [pixel] side of the squares of a picture that lamps light anew


@kernel
def lay_sprite(
    frame: Pixels, height: Heights, left: int, top: int, remaining: Pixels, added: Pixels, tall: Heights
) -> None:
    """Blend a moving part over a frame:  new = old · remaining / 255 + added;  its heights replace others."""
    for i in range(max(0, -top), min(remaining.shape[0], frame.shape[0] - top)):
        for j in range(max(0, -left), min(remaining.shape[1], frame.shape[1] - left)):
            share = remaining[i, j]
            if share == 255:
                continue
            for channel in range(3):
                value = frame[top + i, left + j, channel] * share // 255 + added[i, j, channel]
                frame[top + i, left + j, channel] = min(value, 255)
            if tall[i, j] >= 0.0:
                height[top + i, left + j] = tall[i, j]


@kernel
def lay_over(
    below: Pixels, frame: Pixels, left: int, top: int, remaining: Pixels, added: Pixels, box: Box
) -> None:
    """Blend an upper level over the frame below it, within a box:  new = below · remaining / 255 + added."""
    first, last = max(box[0], left, 0), min(box[2], left + remaining.shape[1], frame.shape[1])
    for row in range(max(box[1], top, 0), min(box[3], top + remaining.shape[0], frame.shape[0])):
        for column in range(first, last):
            share = remaining[row - top, column - left]
            if share == 255:
                continue
            for channel in range(3):
                value = below[row, column, channel] * share // 255 + added[row - top, column - left, channel]
                frame[row, column, channel] = min(value, 255)


@kernel
def add_light(rows: Pixels, left: int, top: int, patch: Pixels, strength: int) -> None:
    """Add a picture of light, scaled by strength / 256.

    Args:
        rows: The frame, uint8 [row, 3 · column].
        left: First column of the picture.
        top: Its first row.
        patch: The picture of light, uint8 [row, 3 · column]; it must lie within the frame.
        strength: 0 to 256.
    """
    for i in range(patch.shape[0]):
        line, more = rows[top + i], patch[i]
        for j in range(patch.shape[1]):
            line[3 * left + j] = min(line[3 * left + j] + (more[j] * strength >> 8), 255)


@kernel
def relight(
    still: Pixels, lit: Pixels, tiles: Cells, boxes: Boxes, light: Pixels, levels: Boxes, changed: Pixels
) -> None:
    """Light the tiles of a picture anew whose lamps have changed.

    Args:
        still: The picture without lamps, uint8 [row, 3 · column].
        lit: The same with lamps.
        tiles: The lamps that shine on each tile, as `list_cells` lists solids.
        boxes: First column, first row, rows and columns of each lamp's light, and where it begins in
            `light`, int64 [lamp, 5].
        light: The light of all lamps, one picture after the other, uint8.
        levels: How bright each lamp was and is, 0 to 256, int64 [2, lamp].
        changed: Receives whether each tile was lit anew, uint8 [tile row, tile column].
    """
    rows, columns = changed.shape
    for tile in range(rows * columns):
        first, end = tiles[tile], tiles[tile + 1]
        is_new = False
        for place in range(first, end):
            is_new = is_new or levels[0, tiles[place]] != levels[1, tiles[place]]
        top, left = tile // columns * TILE, tile % columns * TILE
        changed[tile // columns, tile % columns] = is_new
        if not is_new:
            continue
        bottom, right = min(top + TILE, still.shape[0]), min(left + TILE, still.shape[1] // 3)
        for row in range(top, bottom):
            old, line = still[row, 3 * left : 3 * right], lit[row, 3 * left : 3 * right]
            for j in range(len(line)):  # from 0 on: indices that may be negative are not vectorised
                line[j] = old[j]
        for place in range(first, end):
            lamp = tiles[place]
            if levels[1, lamp] > 0:
                _add_lamp(lit, boxes, light, lamp, levels[1, lamp], (left, top, right, bottom))


@inlined
def _add_lamp(lit: Pixels, boxes: Boxes, light: Pixels, lamp: int, level: int, tile: Box) -> None:
    """Add the light of a lamp at a level to a tile."""
    left, top, rows, columns, start = (
        boxes[lamp, 0], boxes[lamp, 1], boxes[lamp, 2], boxes[lamp, 3], boxes[lamp, 4],
    )  # fmt: skip
    first, end = max(left, tile[0]), min(left + columns, tile[2])
    if first >= end:
        return
    for row in range(max(top, tile[1]), min(top + rows, tile[3])):
        line = lit[row, 3 * first : 3 * end]
        more = light[start + 3 * ((row - top) * columns + first - left) :]
        for j in range(len(line)):
            line[j] = min(line[j] + (more[j] * level >> 8), 255)


@kernel
def add_spots(
    frame: Pixels, height: Heights, stage: Records, spots: Spots, count: int
) -> tuple[int, int, int, int]:
    """Add the round spots of a trail or of sparks; return the box that contains them.

    Args:
        frame: RGB.
        height: Of what each pixel shows [u].
        stage: The camera, a STAGE record.
        spots: Place x, y, z, radius [u], red, green, blue [0 to 255], float64 [spot, 7].
        count: The number of spots.
    """
    left, top, right, bottom = frame.shape[1], frame.shape[0], 0, 0
    for index in range(count):
        first_column, first_row, end_column, end_row = _add_spot(frame, height, stage[0], spots, index)
        left, top = min(left, first_column), min(top, first_row)
        right, bottom = max(right, end_column), max(bottom, end_row)
    return left, top, right, bottom


@inlined
def _add_spot(
    frame: Pixels, height: Heights, s: StageRecord, spots: Spots, index: int
) -> tuple[int, int, int, int]:
    x, y, z, radius = spots[index, 0], spots[index, 1], spots[index, 2], spots[index, 3]
    depth = (x - s.eye_x) * s.sine - (y - s.eye_y) * s.cosine
    across = s.across + s.focal * z / depth
    down = s.down - s.focal * ((x - s.eye_x) * s.cosine + (y - s.eye_y) * s.sine) / depth
    size = max(radius * s.focal / depth, 0.8)
    left, right = max(int(across - size), 0), min(int(across + size) + 1, frame.shape[1])
    top, bottom = max(int(down - size), 0), min(int(down + size) + 1, frame.shape[0])
    for row in range(top, bottom):
        for column in range(left, right):
            u, v = (column + 0.5 - across) / size, (row + 0.5 - down) / size
            fade = 1.0 - u * u - v * v
            # The camera looks down, so whatever is higher than the spot hides it.
            if fade > 0.0 and height[row, column] <= y + 0.3:
                fade *= fade
                for channel in range(3):
                    value = frame[row, column, channel] + int(fade * spots[index, 4 + channel])
                    frame[row, column, channel] = min(value, 255)
    return left, top, right, bottom


@inlined
def pixel_ray(s: StageRecord, column: int, row: int) -> tuple[float, float, float, float]:
    """Return the unit vector from the eye through the centre of a pixel, and its length before scaling."""
    u, v = (column + 0.5 - s.across) / s.focal, (s.down - row - 0.5) / s.focal
    dx, dy, dz = s.sine + v * s.cosine, v * s.sine - s.cosine, u
    length = sqrt(dx * dx + dy * dy + dz * dz)
    return dx / length, dy / length, dz / length, length
