"""Layers of a frame: kernels that blend moving parts, levels, light and spots into rectangles of its pixels.

A frame is RGB, uint8 [row, column, 3]; a second array holds the height [u] of what each pixel shows, float32
[row, column]. Rectangles are given by their first column and row and may extend beyond the frame.
"""

from __future__ import annotations

from math import sqrt

from silverball.drawing.kernels.stage import Box, Heights, Pixels, Records, Spots, StageRecord
from silverball.physics.kernel import inlined, kernel


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
