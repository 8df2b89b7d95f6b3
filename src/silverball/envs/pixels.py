"""How is a picture of a world drawn at a million a second?

The board's background is drawn once for each board; a picture is a copy of it, then the parts that were hit in
this step in bright, the paddles and the balls as sprites. Each is blended by taking the brighter value, so that
the order does not matter. The board fills the picture: its top is the first row, its left the first column.

The last pictures of an environment lie in a ring that is longer than an observation: the window of the newest
slides along it, so that no picture is moved but when the window has come to the end.
"""

from __future__ import annotations

from math import floor
from typing import Any

from silverball.envs import arrays as the
from silverball.envs.records import LIT_BITS
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.layout import BALL_COUNT, EventKind, Kind, Part
from silverball.physics.shapes import distance

FINE = 8  # places of a ball within a pixel, along each axis, that have a sprite of their own
ANGLES = 32  # angles of a paddle that have a sprite of their own


@internal
def film_step(at: Any, index: int) -> None:
    """Write down what the next picture shows, and draw it."""
    film = the.film(at)[0]
    last = film.stack - 1
    for number in range(last):
        copy_scene(the.scenes(at)[index, number + 1], the.scenes(at)[index, number])
    look(at, index, last)
    if film.wraps != 0:
        for number in range(last):
            source = the.frames(at).shape[1] - last + number
            for pixel in range(the.frames(at).shape[2]):
                the.frames(at)[index, number, pixel] = the.frames(at)[index, source, pixel]
    scene, board = the.scenes(at)[index, last], the.board_of(at)[index]
    draw(at, scene, board, the.frames(at), index, film.at + last)


@internal
def show_first(at: Any, index: int) -> None:
    """Fill the whole window with the first picture of an episode."""
    film = the.film(at)[0]
    last = film.stack - 1
    look(at, index, last)
    the.scenes(at)[index, last].lit = 0
    for number in range(last):
        copy_scene(the.scenes(at)[index, last], the.scenes(at)[index, number])
    draw(at, the.scenes(at)[index, last], the.board_of(at)[index], the.frames(at), index, film.at + last)
    for number in range(last):
        for pixel in range(the.frames(at).shape[2]):
            the.frames(at)[index, film.at + number, pixel] = the.frames(at)[index, film.at + last, pixel]


@internal
def show_again(at: Any, index: int) -> None:
    """Draw all pictures of the window from their scenes."""
    film = the.film(at)[0]
    for number in range(film.stack):
        scene = the.scenes(at)[index, number]
        draw(at, scene, the.board_of(at)[index], the.frames(at), index, film.at + number)


@kernel
def draw_finals(addresses: Any, rows: Any, pictures: Any) -> None:
    """Draw the last observations of the episodes that ended in these environments.

    Args:
        addresses: One ADDRESSES record.
        rows: Which environments, int64 [row].
        pictures: Written, uint8 [row, stacked, pixel].
    """
    at = addresses[0]
    for row in range(len(rows)):
        index = rows[row]
        for number in range(the.film(at)[0].stack):
            scene, board = the.final_scenes(at)[index, number], the.final_boards(at)[index]
            draw(at, scene, board, pictures, row, number)


@internal
def wind(at: Any, index: int, copies: bool) -> None:
    """Copy the window of an environment to where its observation goes, if copies are wanted."""
    if copies:
        film = the.film(at)[0]
        for number in range(film.stack):
            for pixel in range(the.frames(at).shape[2]):
                the.copies(at)[index, number, pixel] = the.frames(at)[index, film.at + number, pixel]


@internal
def look(at: Any, index: int, number: int) -> None:
    """Write down what is to be seen of a world now, as its scene of that number."""
    world, scene, log = the.worlds(at)[index], the.scenes(at)[index, number], the.logs(at)[index]
    for slot in range(BALL_COUNT):
        ball = world.ball[slot]
        scene.x[slot], scene.z[slot], scene.alive[slot] = ball.x, ball.z, ball.id
        scene.angle[slot] = world.paddle[slot].angle
    lit = 0
    for number in range(log.count):
        event = log.event[number]
        shape = event.part - Part.FIRST_SHAPE
        if event.kind == EventKind.HIT and 0 <= shape < LIT_BITS:
            lit |= 1 << shape
    scene.lit = lit


@inlined
def copy_scene(scene: Any, other: Any) -> None:
    """Copy a SCENE record to another."""
    for slot in range(BALL_COUNT):
        other.x[slot], other.z[slot], other.alive[slot] = scene.x[slot], scene.z[slot], scene.alive[slot]
        other.angle[slot] = scene.angle[slot]
    other.lit = scene.lit


@internal
def draw(at: Any, scene: Any, board: int, frames: Any, index: int, number: int) -> None:
    """Draw a scene on a board as the picture `number` of environment `index`."""
    film, rules = the.film(at)[0], the.rules(at)[0]
    for pixel in range(frames.shape[2]):
        frames[index, number, pixel] = the.backgrounds(at)[board, pixel]
    if scene.lit != 0:
        first = the.boards(at)[board].collider_first + Part.FIRST_SHAPE
        for shape in range(LIT_BITS):
            if scene.lit >> shape & 1:
                light_up(film, the.colliders(at)[first + shape], frames, index, number)
    size = film.paddle_rows * film.paddle_columns * film.channels
    for side in range(2):
        if size == 0 or rules.per_angle[side] == 0.0:
            continue
        turn = (scene.angle[side] - rules.rest[side]) * rules.per_angle[side]
        sprite = (side * ANGLES + int(turn * (ANGLES - 1) + 0.5)) * size
        row, column = film.paddle_row[side], film.paddle_column[side]
        stamp(
            film,
            the.paddles(at),
            sprite,
            film.paddle_rows,
            film.paddle_columns,
            frames,
            index,
            number,
            row,
            column,
        )
    for slot in range(BALL_COUNT):
        if scene.alive[slot] != 0:
            draw_ball(film, the.balls(at), scene.x[slot], scene.z[slot], frames, index, number)


@inlined
def draw_ball(film: Any, sprites: Any, x: float, z: float, frames: Any, index: int, number: int) -> None:
    """Draw a ball at (x, z) with the sprite of its place within the pixel."""
    row, column = (film.half_length - x) * film.rows, (film.half_width + z) * film.columns
    whole_row, whole_column = floor(row), floor(column)
    fine = int((row - whole_row) * FINE) * FINE + int((column - whole_column) * FINE)
    rows, columns = 2 * film.ball_rows + 1, 2 * film.ball_columns + 1
    sprite = fine * rows * columns * film.channels
    top, left = whole_row - film.ball_rows, whole_column - film.ball_columns
    stamp(film, sprites, sprite, rows, columns, frames, index, number, top, left)


@internal
def stamp(
    film: Any, sprites: Any, sprite: int, rows: int, columns: int, frames: Any, index: int, number: int,
    top: int, left: int,
) -> None:  # fmt: skip
    """Put a sprite, which begins at `sprite`, onto a picture: of two values the brighter one stays."""
    channels = film.channels
    from_row, to_row = max(0, -top), min(rows, film.height - top)
    from_byte, to_byte = max(0, -left) * channels, min(columns, film.width - left) * channels
    for row in range(from_row, to_row):
        source = sprite + row * columns * channels
        target = ((top + row) * film.width + left) * channels
        for byte in range(from_byte, to_byte):
            frames[index, number, target + byte] = max(
                frames[index, number, target + byte], sprites[source + byte]
            )


@internal
def light_up(film: Any, c: Any, frames: Any, index: int, number: int) -> None:
    """Show a prism or cylinder in bright."""
    if c.kind not in (Kind.TRIANGULAR_PRISM, Kind.CYLINDER):
        return
    top = max(0, int((film.half_length - c.x - c.reach) * film.rows))
    bottom = min(film.height, int((film.half_length - c.x + c.reach) * film.rows) + 1)
    left = max(0, int((film.half_width + c.z - c.reach) * film.columns))
    right = min(film.width, int((film.half_width + c.z + c.reach) * film.columns) + 1)
    for row in range(top, bottom):
        for column in range(left, right):
            x = film.half_length - (row + 0.5) / film.rows
            z = (column + 0.5) / film.columns - film.half_width
            outside, _, _ = distance(c, x, z)
            if outside > 0.0:
                continue
            pixel = (row * film.width + column) * film.channels
            frames[index, number, pixel] = film.red
            if film.channels == 3:
                frames[index, number, pixel + 1] = film.green
                frames[index, number, pixel + 2] = film.blue


@kernel
def cover(film: Any, c: Any, samples: int, covered: Any) -> None:
    """Write for each pixel how many of samples × samples points in it lie within a still part [row, column]."""
    for row in range(film.height):
        for column in range(film.width):
            covered[row, column] = 0
            x = film.half_length - (row + 0.5) / film.rows
            z = (column + 0.5) / film.columns - film.half_width
            far = c.reach + 0.5 / film.rows + 0.5 / film.columns
            if (x - c.x) ** 2 + (z - c.z) ** 2 > far * far:
                continue
            for up in range(samples):
                for across in range(samples):
                    at_x = x + ((up + 0.5) / samples - 0.5) / film.rows
                    at_z = z + ((across + 0.5) / samples - 0.5) / film.columns
                    outside, _, _ = distance(c, at_x, at_z)
                    if outside <= 0.0:
                        covered[row, column] += 1
