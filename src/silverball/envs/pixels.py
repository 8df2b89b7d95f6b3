"""Pictures of worlds, drawn in the compiled step: a million a second.

The background of each board is drawn once. A picture is a copy of it, then the drop targets and gates that
are there, the lit parts (hit in this step), the paddles and the balls as sprites. Sprites are blended with a
per-byte maximum, so that their order does not matter. The board fills the picture: its top is the first row,
its left border the first column.

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
from silverball.envs.sight import is_in_sight
from silverball.envs.state import (
    LAMP_BITS,
    LAMP_WORDS,
    PICTURE_STATE,
    PictureStateRecord,
    PieceRecord,
    RasterRecord,
)
from silverball.physics.for_devices import switches_off
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import MAX_BALLS, EventKind
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
    for word in range(LAMP_WORDS):
        views.picture_states(ptr)[index, last].lit[word] = 0
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
    if views.rules(ptr)[0].can_repair == 0 or drawn.board != state.board or drawn.off != state.off:
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
    board = views.boards(ptr)[state.board]
    for slot in range(MAX_BALLS):
        state.alive[slot] = 0
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        state.x[slot], state.z[slot], state.alive[slot] = ball.x, ball.z, 0
        if is_in_sight(ptr, rules, index, ball):
            state.alive[slot] = ball.id
    for paddle in range(board.paddles):
        turn = (world.paddle[paddle].angle - rules.rest_angle[paddle]) * rules.angle_scale[paddle]
        has_paddle = rules.angle_scale[paddle] != 0.0
        state.paddle[paddle] = int(turn * (ANGLES - 1) + 0.5) if has_paddle else -1
    state.off = switches_off(world)
    for word in range(LAMP_WORDS):
        state.lit[word] = 0
    for entry in range(log.count):
        event = log.event[entry]
        if event.part >= 0 and lights_up(event.kind):
            lamp = views.lamp_of(ptr)[state.board, event.part]
            if lamp >= 0:
                state.lit[lamp // LAMP_BITS] |= 1 << lamp % LAMP_BITS


@inlined
def lights_up(kind: int) -> bool:
    """Whether an event of a kind lights up its part."""
    return bool(kind == EventKind.HIT or EventKind.PASS <= kind <= EventKind.CAPTURED)  # and SPIN between


@internal
def draw(ptr: Pointers, state: PictureStateRecord, picture: int) -> None:
    """Draw the whole picture of a state at an address."""
    raster, board = views.raster(ptr)[0], views.boards(ptr)[state.board]
    copy_bytes(picture, ptr.backgrounds_at + state.board * ptr.pixels, ptr.pixels)
    draw_switched(ptr, raster, state, picture)
    light_up(ptr, raster, state, picture)
    draw_paddles(ptr, raster, state, picture)
    for slot in range(board.max_balls):
        if state.alive[slot] != 0:
            draw_ball(raster, ptr.ball_sprites_at, state.x[slot], state.z[slot], picture)


@internal
def repair_dirty_rects(
    ptr: Pointers, drawn: PictureStateRecord, state: PictureStateRecord, picture: int
) -> None:
    """Turn the picture of `drawn` into that of `state`, on the same board; every pixel is as `draw` makes it.

    Dirty rectangles are restored to the background, and sprites that they may have cut are drawn again.
    """
    raster, board = views.raster(ptr)[0], views.boards(ptr)[state.board]
    background = ptr.backgrounds_at + state.board * ptr.pixels
    lowest = erase_lamps(ptr, raster, drawn, picture, background)  # one past the lowest erased row
    for slot in range(board.max_balls):
        if drawn.alive[slot] != 0:
            top, left = ball_corner(raster, drawn.x[slot], drawn.z[slot])
            rows, columns = 2 * raster.ball_rows + 1, 2 * raster.ball_columns + 1
            restore_background(raster, background, picture, top, left, rows, columns)
            lowest = max(lowest, top + rows)
    has_turned, highest_paddle = False, raster.height
    for paddle in range(board.paddles):
        has_turned = has_turned or drawn.paddle[paddle] != state.paddle[paddle]
        highest_paddle = min(highest_paddle, raster.paddle_row[paddle])
    if has_turned:
        for paddle in range(board.paddles):
            top, left = raster.paddle_row[paddle], raster.paddle_column[paddle]
            rows, columns = raster.paddle_rows, raster.paddle_columns
            restore_background(raster, background, picture, top, left, rows, columns)
    lowest = max(lowest, draw_switched(ptr, raster, state, picture))
    lowest = max(lowest, light_up(ptr, raster, state, picture))
    if has_turned or lowest > highest_paddle:
        draw_paddles(ptr, raster, state, picture)
    for slot in range(board.max_balls):
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
    for paddle in range(views.boards(ptr)[state.board].paddles):
        if state.paddle[paddle] >= 0:
            number = paddle * ANGLES + state.paddle[paddle]
            sprite = ptr.paddle_sprites_at + number * rows * columns * raster.channels
            top, left = raster.paddle_row[paddle], raster.paddle_column[paddle]
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


@internal
def draw_piece(ptr: Pointers, raster: RasterRecord, piece: PieceRecord, address: int) -> int:
    """Draw a piece in its colour; returns one past its lowest row."""
    picture, mask = array_at(address, (ptr.pixels,), BYTE), views.masks(ptr)
    for row in range(piece.rows):
        for column in range(piece.columns):
            if mask[piece.mask_first + row * piece.columns + column] == 0:
                continue
            pixel = ((piece.top + row) * raster.width + piece.left + column) * raster.channels
            picture[pixel] = piece.red
            if raster.channels == 3:
                picture[pixel + 1] = piece.green
                picture[pixel + 2] = piece.blue
    return int(piece.top + piece.rows)


@internal
def draw_switched(ptr: Pointers, raster: RasterRecord, state: PictureStateRecord, picture: int) -> int:
    """Draw the parts with a switch that are not away; returns one past the lowest changed row."""
    board, lowest = views.pictured_boards(ptr)[state.board], 0
    for number in range(board.switch_first, board.piece_end):
        piece = views.pieces(ptr)[number]
        if state.off & piece.switch == 0:
            lowest = max(lowest, draw_piece(ptr, raster, piece, picture))
    return lowest


@internal
def light_up(ptr: Pointers, raster: RasterRecord, state: PictureStateRecord, picture: int) -> int:
    """Draw the lamps that are on; returns one past the lowest changed row."""
    board, lowest = views.pictured_boards(ptr)[state.board], 0
    for word in range(LAMP_WORDS):
        if state.lit[word] == 0:
            continue
        first = board.lamp_first + word * LAMP_BITS
        for bit in range(min(LAMP_BITS, board.switch_first - first)):
            if state.lit[word] >> bit & 1 != 0:
                lowest = max(lowest, draw_piece(ptr, raster, views.pieces(ptr)[first + bit], picture))
    return lowest


@internal
def erase_lamps(
    ptr: Pointers, raster: RasterRecord, state: PictureStateRecord, picture: int, background: int
) -> int:
    """Restore the background of the lamps that are on; returns one past the lowest changed row."""
    board, lowest = views.pictured_boards(ptr)[state.board], 0
    for word in range(LAMP_WORDS):
        if state.lit[word] == 0:
            continue
        first = board.lamp_first + word * LAMP_BITS
        for bit in range(min(LAMP_BITS, board.switch_first - first)):
            if state.lit[word] >> bit & 1 != 0:
                piece = views.pieces(ptr)[first + bit]
                restore_background(
                    raster, background, picture, piece.top, piece.left, piece.rows, piece.columns
                )
                lowest = max(lowest, piece.top + piece.rows)
    return lowest
