"""Pictures of worlds, drawn in the compiled step: a million a second.

The background of each board is drawn once. A picture is a copy of it, then the lit parts (hit in this step),
the paddles and the balls as sprites. Sprites are blended with a per-byte maximum, so that their order does
not matter. The board fills the picture: its top is the first row, its left border the first column.

The last pictures of an environment are stored in a ring of frames, and a window of the newest ones moves
along it. If the window itself is the observation, the ring is longer than the window; when the window reaches
the end of the ring, it is redrawn at the ring's start. If the window is copied, both have the same length and
the window wraps. If only the kernels write to the ring, an old picture is turned into a new one by repairing
its dirty rectangles: balls and lights are erased and drawn again, paddles only if they have moved.
"""

from __future__ import annotations

from typing import Any

from silverball.envs import pointers as views
from silverball.envs.pointers import BYTE, Pointers, copy_bytes
from silverball.envs.state import BALL_COUNT, LIT_BITS, PICTURE_STATE, PictureStateRecord, RasterRecord
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import ColliderRecord, EventKind, Kind
from silverball.physics.shapes import distance
from silverball.world.single_step import array_at

SUBPIXELS = 8  # positions of a ball within a pixel along each axis; each has a sprite
PICTURE_STATE_SIZE = PICTURE_STATE.itemsize
ANGLES = 32  # of a paddle; each has a sprite


@internal
def draw_step(ptr: Pointers, index: int) -> None:
    """Record the contents of the next picture, and draw it."""
    raster = views.raster(ptr)[0]
    last = raster.stack - 1
    for number in range(last):
        copy_picture_state(ptr, index, number + 1, number)
    record_state(ptr, index, last)
    if raster.wraps != 0:
        for number in range(last):
            draw_in_ring(ptr, index, number)
    draw_in_ring(ptr, index, last)


@internal
def draw_first(ptr: Pointers, index: int) -> None:
    """Fill the window with the first picture of an episode."""
    last = views.raster(ptr)[0].stack - 1
    record_state(ptr, index, last)
    views.picture_states(ptr)[index, last].lit = 0
    for number in range(last):
        copy_picture_state(ptr, index, last, number)
    for frame in range(ptr.ring):  # the caller may have written to them, so nothing can be repaired
        views.drawn(ptr)[index, frame].board = -1
    redraw_stack(ptr, index)


@internal
def redraw_stack(ptr: Pointers, index: int) -> None:
    """Draw all pictures of the window from their states."""
    for number in range(views.raster(ptr)[0].stack):
        draw_in_ring(ptr, index, number)


@kernel
def draw_finals(addresses: Any, rows: Any, pictures: int) -> None:
    """Draw the last observations of the episodes that ended in these environments.

    Args:
        addresses: One ADDRESSES record.
        rows: Numbers of the environments, int64 [row].
        pictures: Address of the output array, uint8 [row, stacked, pixel].
    """
    ptr = addresses[0]
    for row in range(len(rows)):
        for number in range(ptr.stack):
            state = views.final_picture_states(ptr)[rows[row], number]
            draw(ptr, state, pictures + (row * ptr.stack + number) * ptr.pixels)


@internal
def draw_in_ring(ptr: Pointers, index: int, number: int) -> None:
    """Draw picture `number` of the window in its frame of the ring."""
    state, place = views.picture_states(ptr)[index, number], ring_index(ptr, number)
    picture, drawn = frame_address(ptr, index, place), views.drawn(ptr)[index, place]
    if views.rules(ptr)[0].can_repair == 0 or drawn.board != state.board:
        draw(ptr, state, picture)
    else:
        repair_dirty_rects(ptr, drawn, state, picture)
    first = ptr.picture_states_at + (index * ptr.stack + number) * PICTURE_STATE_SIZE
    copy_bytes(ptr.drawn_at + (index * ptr.ring + place) * PICTURE_STATE_SIZE, first, PICTURE_STATE_SIZE)


@inlined
def copy_stack(ptr: Pointers, index: int) -> None:
    """Copy the window of an environment to its observation."""
    target, start = ptr.copies_at + index * ptr.stack * ptr.pixels, views.raster(ptr)[0].start
    to_end = min(ptr.stack, ptr.ring - start)  # pictures before the end of the ring; the rest is at its start
    copy_bytes(target, frame_address(ptr, index, start), to_end * ptr.pixels)
    copy_bytes(target + to_end * ptr.pixels, frame_address(ptr, index, 0), (ptr.stack - to_end) * ptr.pixels)


@inlined
def ring_index(ptr: Pointers, number: int) -> int:
    """The number of the frame of picture `number` of the window."""
    place = views.raster(ptr)[0].start + number
    return int(place if place < ptr.ring else place - ptr.ring)


@inlined
def frame_address(ptr: Pointers, index: int, number: int) -> int:
    """The address of a frame of the ring."""
    return int(ptr.frames_at + (index * ptr.ring + number) * ptr.pixels)


@inlined
def copy_picture_state(ptr: Pointers, index: int, number: int, to: int) -> None:
    """Copy state `number` of an environment over another one of its states."""
    first = ptr.picture_states_at + index * ptr.stack * PICTURE_STATE_SIZE
    copy_bytes(first + to * PICTURE_STATE_SIZE, first + number * PICTURE_STATE_SIZE, PICTURE_STATE_SIZE)


@internal
def record_state(ptr: Pointers, index: int, number: int) -> None:
    """Record the current contents of a world's picture as picture state `number`."""
    state = views.picture_states(ptr)[index, number]
    world, log, rules = views.worlds(ptr)[index], views.logs(ptr)[index], views.rules(ptr)[0]
    state.board = views.board_of(ptr)[index]
    for slot in range(BALL_COUNT):
        ball = world.ball[slot]
        state.x[slot], state.z[slot], state.alive[slot] = ball.x, ball.z, ball.id
    for side in range(2):
        turn = (world.paddle[side].angle - rules.rest_angle[side]) * rules.angle_scale[side]
        has_paddle = rules.angle_scale[side] != 0.0
        state.paddle[side] = int(turn * (ANGLES - 1) + 0.5) if has_paddle else -1
    lit, first = 0, views.boards(ptr)[state.board].shape_first
    for entry in range(log.count):
        event = log.event[entry]
        shape = event.part - first
        if event.kind == EventKind.HIT and 0 <= shape < LIT_BITS:
            lit |= 1 << shape
    state.lit = lit


@internal
def draw(ptr: Pointers, state: PictureStateRecord, picture: int) -> None:
    """Draw the whole picture of a state at an address."""
    raster = views.raster(ptr)[0]
    copy_bytes(picture, ptr.backgrounds_at + state.board * ptr.pixels, ptr.pixels)
    if state.lit != 0:
        light_up(ptr, raster, state, picture)
    draw_paddles(ptr, raster, state, picture)
    for slot in range(BALL_COUNT):
        if state.alive[slot] != 0:
            draw_ball(raster, ptr.ball_sprites_at, state.x[slot], state.z[slot], picture)


@internal
def repair_dirty_rects(
    ptr: Pointers, drawn: PictureStateRecord, state: PictureStateRecord, picture: int
) -> None:
    """Turn the picture of `drawn` into that of `state`, on the same board; every pixel is as `draw` makes it.

    Dirty rectangles are restored to the background, and sprites that they may have cut are drawn again.
    """
    raster = views.raster(ptr)[0]
    background = ptr.backgrounds_at + state.board * ptr.pixels
    lowest = 0  # one past the lowest erased row, which may have cut a paddle
    if drawn.lit != 0:
        lowest = erase_lit_parts(ptr, raster, drawn, picture, background)
    for slot in range(BALL_COUNT):
        if drawn.alive[slot] != 0:
            top, left = ball_corner(raster, drawn.x[slot], drawn.z[slot])
            rows, columns = 2 * raster.ball_rows + 1, 2 * raster.ball_columns + 1
            restore_background(raster, background, picture, top, left, rows, columns)
            lowest = max(lowest, top + rows)
    has_turned = drawn.paddle[0] != state.paddle[0] or drawn.paddle[1] != state.paddle[1]
    if has_turned:
        for side in range(2):
            top, left = raster.paddle_row[side], raster.paddle_column[side]
            rows, columns = raster.paddle_rows, raster.paddle_columns
            restore_background(raster, background, picture, top, left, rows, columns)
    if state.lit != 0:
        lowest = max(lowest, light_up(ptr, raster, state, picture))
    if has_turned or lowest > min(raster.paddle_row[0], raster.paddle_row[1]):
        draw_paddles(ptr, raster, state, picture)
    for slot in range(BALL_COUNT):
        if state.alive[slot] != 0:
            draw_ball(raster, ptr.ball_sprites_at, state.x[slot], state.z[slot], picture)


@inlined
def restore_background(
    raster: RasterRecord, background: int, picture: int, top: int, left: int, rows: int, columns: int
) -> None:
    """Copy a rectangle of the background to the picture, clipped to it."""
    first, last = max(0, left) * raster.channels, min(raster.width, left + columns) * raster.channels
    if last <= first:
        return
    for row in range(max(0, top), min(raster.height, top + rows)):
        start = row * raster.width * raster.channels + first
        copy_bytes(picture + start, background + start, last - first)


@internal
def draw_paddles(ptr: Pointers, raster: RasterRecord, state: PictureStateRecord, picture: int) -> None:
    """Draw the paddles that the board has."""
    rows, columns = raster.paddle_rows, raster.paddle_columns
    for side in range(2):
        if state.paddle[side] >= 0:
            number = side * ANGLES + state.paddle[side]
            sprite = ptr.paddle_sprites_at + number * rows * columns * raster.channels
            top, left = raster.paddle_row[side], raster.paddle_column[side]
            blend_sprite(raster, sprite, rows, columns, picture, top, left)


@inlined
def ball_corner(raster: RasterRecord, x: float, z: float) -> tuple[int, int]:
    """The first row and column of a ball's sprite."""
    row, column = (raster.half_length - x) * raster.rows, (raster.half_width + z) * raster.columns
    return int(row) - raster.ball_rows, int(column) - raster.ball_columns  # never negative on the board


@inlined
def draw_ball(raster: RasterRecord, sprites: int, x: float, z: float, picture: int) -> None:
    """Draw a ball at (x, z) with the sprite for its position within the pixel."""
    row, column = (raster.half_length - x) * raster.rows, (raster.half_width + z) * raster.columns
    pixel_row, pixel_column = int(row), int(column)  # never negative on the board
    subpixel = int((row - pixel_row) * SUBPIXELS) * SUBPIXELS + int((column - pixel_column) * SUBPIXELS)
    rows, columns = 2 * raster.ball_rows + 1, 2 * raster.ball_columns + 1
    sprite = sprites + subpixel * rows * columns * raster.channels
    top, left = pixel_row - raster.ball_rows, pixel_column - raster.ball_columns
    blend_sprite(raster, sprite, rows, columns, picture, top, left)


@internal
def blend_sprite(
    raster: RasterRecord, sprite: int, rows: int, columns: int, picture: int, top: int, left: int
) -> None:
    """Blend the sprite at an address into the picture at another: the brighter value wins."""
    channels, height, width = raster.channels, raster.height, raster.width
    first, last = max(0, -left), min(columns, width - left)
    count = (last - first) * channels
    if count <= 0:
        return
    for row in range(max(0, -top), min(rows, height - top)):
        source = array_at(sprite + (row * columns + first) * channels, (count,), BYTE)
        target = array_at(picture + ((top + row) * width + left + first) * channels, (count,), BYTE)
        for byte in range(count):
            target[byte] = max(target[byte], source[byte])


@inlined
def visible_box(raster: RasterRecord, c: ColliderRecord) -> tuple[int, int, int, int]:
    """Top, bottom, left and right of a part within the picture; bottom and right are exclusive."""
    top = max(0, int((raster.half_length - c.x - c.reach) * raster.rows))
    bottom = min(raster.height, int((raster.half_length - c.x + c.reach) * raster.rows) + 1)
    left = max(0, int((raster.half_width + c.z - c.reach) * raster.columns))
    right = min(raster.width, int((raster.half_width + c.z + c.reach) * raster.columns) + 1)
    return top, bottom, left, right


@internal
def light_up(ptr: Pointers, raster: RasterRecord, state: PictureStateRecord, address: int) -> int:
    """Brighten the prisms and cylinders that were hit; returns one past the lowest changed row."""
    picture = array_at(address, (ptr.pixels,), BYTE)
    board = views.boards(ptr)[state.board]
    first, lowest = board.collider_first + board.shape_first, 0
    for shape in range(LIT_BITS):
        if state.lit >> shape & 1 == 0:
            continue
        c = views.colliders(ptr)[first + shape]
        if c.kind not in (Kind.TRIANGULAR_PRISM, Kind.CYLINDER):
            continue
        top, bottom, left, right = visible_box(raster, c)
        lowest = max(lowest, bottom)
        for row in range(top, bottom):
            for column in range(left, right):
                x = raster.half_length - (row + 0.5) / raster.rows
                z = (column + 0.5) / raster.columns - raster.half_width
                outside, _, _ = distance(c, x, z)
                if outside > 0.0:
                    continue
                pixel = (row * raster.width + column) * raster.channels
                picture[pixel] = raster.red
                if raster.channels == 3:
                    picture[pixel + 1] = raster.green
                    picture[pixel + 2] = raster.blue
    return lowest


@internal
def erase_lit_parts(
    ptr: Pointers, raster: RasterRecord, state: PictureStateRecord, picture: int, background: int
) -> int:
    """Restore the background of the lit parts; returns one past the lowest changed row."""
    board = views.boards(ptr)[state.board]
    first, lowest = board.collider_first + board.shape_first, 0
    for shape in range(LIT_BITS):
        if state.lit >> shape & 1 != 0:
            top, bottom, left, right = visible_box(raster, views.colliders(ptr)[first + shape])
            restore_background(raster, background, picture, top, left, bottom - top, right - left)
            lowest = max(lowest, bottom)
    return lowest


@kernel
def count_coverage(raster: RasterRecord, c: ColliderRecord, samples: int, covered: Any) -> None:
    """Count for each pixel how many of its samples × samples points lie within a part."""
    for row in range(raster.height):
        for column in range(raster.width):
            covered[row, column] = 0
            x = raster.half_length - (row + 0.5) / raster.rows
            z = (column + 0.5) / raster.columns - raster.half_width
            reach = c.reach + 0.5 / raster.rows + 0.5 / raster.columns
            if (x - c.x) ** 2 + (z - c.z) ** 2 > reach * reach:
                continue
            for up in range(samples):
                for across in range(samples):
                    at_x = x + ((up + 0.5) / samples - 0.5) / raster.rows
                    at_z = z + ((across + 0.5) / samples - 0.5) / raster.columns
                    outside, _, _ = distance(c, at_x, at_z)
                    if outside <= 0.0:
                        covered[row, column] += 1
