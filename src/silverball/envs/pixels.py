"""How is a picture of a world drawn at a million a second?

The board's background is drawn once for each board; a picture is a copy of it, then the parts that were hit
in this step in bright, the paddles and the balls as sprites. Each is blended by taking the brighter value,
so that the order does not matter. The board fills the picture: its top is the first row, its left the first
column.

The last pictures of an environment lie in a ring, and the window of the newest slides along it. Where the
window itself is the observation, the ring is longer, and the pictures move back to its beginning now and
then; where the window is copied, the ring is no longer than that and the window goes round. Where nobody
else writes to the ring, a picture is drawn by mending the old one in its place: balls and lights are taken
away and put where they are now, paddles if they have moved.
"""

from __future__ import annotations

from typing import Any

from silverball.envs import pointers as the
from silverball.envs.pointers import BYTE, copy_bytes
from silverball.envs.state import LIT_BITS, SCENE
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.records import BALL_COUNT, EventKind, Kind, Part
from silverball.physics.shapes import distance
from silverball.world.single_step import array_at

FINE = 8  # places of a ball within a pixel, along each axis, that have a sprite of their own
SCENE_SIZE = SCENE.itemsize
ANGLES = 32  # angles of a paddle that have a sprite of their own


@internal
def film_step(at: Any, index: int) -> None:
    """Write down what the next picture shows, and draw it."""
    film = the.film(at)[0]
    last = film.stack - 1
    for number in range(last):
        copy_scene(at, index, number + 1, number)
    look(at, index, last)
    if film.wraps != 0:
        for number in range(last):
            show(at, index, number)
    show(at, index, last)


@internal
def show_first(at: Any, index: int) -> None:
    """Fill the whole window with the first picture of an episode."""
    last = the.film(at)[0].stack - 1
    look(at, index, last)
    the.scenes(at)[index, last].lit = 0
    for number in range(last):
        copy_scene(at, index, last, number)
    for place in range(at.ring):  # nothing is mended of what was there, whatever has become of it
        the.drawn(at)[index, place].board = -1
    show_again(at, index)


@internal
def show_again(at: Any, index: int) -> None:
    """Draw all pictures of the window from their scenes."""
    for number in range(the.film(at)[0].stack):
        show(at, index, number)


@kernel
def draw_finals(addresses: Any, rows: Any, pictures: int) -> None:
    """Draw the last observations of the episodes that ended in these environments.

    Args:
        addresses: One ADDRESSES record.
        rows: Which environments, int64 [row].
        pictures: Address of where they go, uint8 [row, stacked, pixel].
    """
    at = addresses[0]
    for row in range(len(rows)):
        for number in range(at.stack):
            scene = the.final_scenes(at)[rows[row], number]
            draw(at, scene, pictures + (row * at.stack + number) * at.pixels)


@internal
def show(at: Any, index: int, number: int) -> None:
    """Draw a scene of an environment in its place in the ring."""
    scene, place = the.scenes(at)[index, number], place_of(at, number)
    picture, drawn = frame(at, index, place), the.drawn(at)[index, place]
    if the.rules(at)[0].mends == 0 or drawn.board != scene.board:
        draw(at, scene, picture)
    else:
        mend(at, drawn, scene, picture)
    first = at.scenes_at + (index * at.stack + number) * SCENE_SIZE
    copy_bytes(at.drawn_at + (index * at.ring + place) * SCENE_SIZE, first, SCENE_SIZE)


@inlined
def wind(at: Any, index: int) -> None:
    """Copy the window of an environment to where its observation goes."""
    target, start = at.copies_at + index * at.stack * at.pixels, the.film(at)[0].at
    straight = min(at.stack, at.ring - start)  # pictures up to the ring's end; the rest is at its start
    copy_bytes(target, frame(at, index, start), straight * at.pixels)
    copy_bytes(target + straight * at.pixels, frame(at, index, 0), (at.stack - straight) * at.pixels)


@inlined
def place_of(at: Any, number: int) -> int:
    """Where in the ring a picture of the window is."""
    place = the.film(at)[0].at + number
    return int(place if place < at.ring else place - at.ring)


@inlined
def frame(at: Any, index: int, number: int) -> int:
    """The address of a picture in the ring."""
    return int(at.frames_at + (index * at.ring + number) * at.pixels)


@inlined
def copy_scene(at: Any, index: int, number: int, to: int) -> None:
    """Copy a scene of an environment to another place among its scenes."""
    first = at.scenes_at + index * at.stack * SCENE_SIZE
    copy_bytes(first + to * SCENE_SIZE, first + number * SCENE_SIZE, SCENE_SIZE)


@internal
def look(at: Any, index: int, number: int) -> None:
    """Write down what is to be seen of a world now, as its scene of that number."""
    world, scene, log = the.worlds(at)[index], the.scenes(at)[index, number], the.logs(at)[index]
    rules = the.rules(at)[0]
    scene.board = the.board_of(at)[index]
    for slot in range(BALL_COUNT):
        ball = world.ball[slot]
        scene.x[slot], scene.z[slot], scene.alive[slot] = ball.x, ball.z, ball.id
    for side in range(2):
        turn = (world.paddle[side].angle - rules.rest[side]) * rules.per_angle[side]
        is_there = rules.per_angle[side] != 0.0
        scene.paddle[side] = int(turn * (ANGLES - 1) + 0.5) if is_there else -1
    lit = 0
    for entry in range(log.count):
        event = log.event[entry]
        shape = event.part - Part.FIRST_SHAPE
        if event.kind == EventKind.HIT and 0 <= shape < LIT_BITS:
            lit |= 1 << shape
    scene.lit = lit


@internal
def draw(at: Any, scene: Any, picture: int) -> None:
    """Draw a scene as the picture at this address, whatever is there."""
    film = the.film(at)[0]
    copy_bytes(picture, at.backgrounds_at + scene.board * at.pixels, at.pixels)
    if scene.lit != 0:
        light_up(at, film, scene, picture)
    draw_paddles(at, film, scene, picture)
    for slot in range(BALL_COUNT):
        if scene.alive[slot] != 0:
            draw_ball(film, at.balls_at, scene.x[slot], scene.z[slot], picture)


@internal
def mend(at: Any, drawn: Any, scene: Any, picture: int) -> None:
    """Make the picture of a scene from that of another one of the same board; no pixel differs from `draw`'s.

    What may have been hurt thereby is drawn again.
    """
    film = the.film(at)[0]
    empty = at.backgrounds_at + scene.board * at.pixels
    lowest = 0  # one past the lowest row where a paddle may have been hurt
    if drawn.lit != 0:
        lowest = darken(at, film, drawn, picture, empty)
    for slot in range(BALL_COUNT):
        if drawn.alive[slot] != 0:
            top, left = ball_corner(film, drawn.x[slot], drawn.z[slot])
            rows, columns = 2 * film.ball_rows + 1, 2 * film.ball_columns + 1
            take_away(film, empty, picture, top, left, rows, columns)
            lowest = max(lowest, top + rows)
    has_turned = drawn.paddle[0] != scene.paddle[0] or drawn.paddle[1] != scene.paddle[1]
    if has_turned:
        for side in range(2):
            top, left = film.paddle_row[side], film.paddle_column[side]
            take_away(film, empty, picture, top, left, film.paddle_rows, film.paddle_columns)
    if scene.lit != 0:
        lowest = max(lowest, light_up(at, film, scene, picture))
    if has_turned or lowest > min(film.paddle_row[0], film.paddle_row[1]):
        draw_paddles(at, film, scene, picture)
    for slot in range(BALL_COUNT):
        if scene.alive[slot] != 0:
            draw_ball(film, at.balls_at, scene.x[slot], scene.z[slot], picture)


@inlined
def take_away(film: Any, empty: int, picture: int, top: int, left: int, rows: int, columns: int) -> None:
    """Put a box of the empty board's picture back, as far as it lies within the picture."""
    first, last = max(0, left) * film.channels, min(film.width, left + columns) * film.channels
    if last <= first:
        return
    for row in range(max(0, top), min(film.height, top + rows)):
        start = row * film.width * film.channels + first
        copy_bytes(picture + start, empty + start, last - first)


@internal
def draw_paddles(at: Any, film: Any, scene: Any, picture: int) -> None:
    """Draw both paddles, as far as they are there."""
    rows, columns = film.paddle_rows, film.paddle_columns
    for side in range(2):
        if scene.paddle[side] >= 0:
            number = side * ANGLES + scene.paddle[side]
            sprite = at.paddles_at + number * rows * columns * film.channels
            stamp(film, sprite, rows, columns, picture, film.paddle_row[side], film.paddle_column[side])


@inlined
def ball_corner(film: Any, x: float, z: float) -> tuple[int, int]:
    """The first row and column of a ball's sprite."""
    row, column = (film.half_length - x) * film.rows, (film.half_width + z) * film.columns
    return int(row) - film.ball_rows, int(column) - film.ball_columns  # never negative on the board


@inlined
def draw_ball(film: Any, sprites: int, x: float, z: float, picture: int) -> None:
    """Draw a ball at (x, z) with the sprite of its place within the pixel."""
    row, column = (film.half_length - x) * film.rows, (film.half_width + z) * film.columns
    whole_row, whole_column = int(row), int(column)  # never negative on the board
    fine = int((row - whole_row) * FINE) * FINE + int((column - whole_column) * FINE)
    rows, columns = 2 * film.ball_rows + 1, 2 * film.ball_columns + 1
    sprite = sprites + fine * rows * columns * film.channels
    stamp(film, sprite, rows, columns, picture, whole_row - film.ball_rows, whole_column - film.ball_columns)


@internal
def stamp(film: Any, sprite: int, rows: int, columns: int, picture: int, top: int, left: int) -> None:
    """Put the sprite at an address onto the picture at another: of two values the brighter one stays."""
    channels, height, width = film.channels, film.height, film.width
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
def box_of(film: Any, c: Any) -> tuple[int, int, int, int]:
    """The rows and columns, from … to before, in which a part lies, within the picture."""
    top = max(0, int((film.half_length - c.x - c.reach) * film.rows))
    bottom = min(film.height, int((film.half_length - c.x + c.reach) * film.rows) + 1)
    left = max(0, int((film.half_width + c.z - c.reach) * film.columns))
    right = min(film.width, int((film.half_width + c.z + c.reach) * film.columns) + 1)
    return top, bottom, left, right


@internal
def light_up(at: Any, film: Any, scene: Any, address: int) -> int:
    """Show the prisms and cylinders that were hit in bright; one past the lowest row that changed."""
    picture = array_at(address, (at.pixels,), BYTE)
    first, lowest = the.boards(at)[scene.board].collider_first + Part.FIRST_SHAPE, 0
    for shape in range(LIT_BITS):
        if scene.lit >> shape & 1 == 0:
            continue
        c = the.colliders(at)[first + shape]
        if c.kind not in (Kind.TRIANGULAR_PRISM, Kind.CYLINDER):
            continue
        top, bottom, left, right = box_of(film, c)
        lowest = max(lowest, bottom)
        for row in range(top, bottom):
            for column in range(left, right):
                x = film.half_length - (row + 0.5) / film.rows
                z = (column + 0.5) / film.columns - film.half_width
                outside, _, _ = distance(c, x, z)
                if outside > 0.0:
                    continue
                pixel = (row * film.width + column) * film.channels
                picture[pixel] = film.red
                if film.channels == 3:
                    picture[pixel + 1] = film.green
                    picture[pixel + 2] = film.blue
    return lowest


@internal
def darken(at: Any, film: Any, scene: Any, picture: int, empty: int) -> int:
    """Take away the light of the parts that were hit; one past the lowest row that this has changed."""
    first, lowest = the.boards(at)[scene.board].collider_first + Part.FIRST_SHAPE, 0
    for shape in range(LIT_BITS):
        if scene.lit >> shape & 1 != 0:
            top, bottom, left, right = box_of(film, the.colliders(at)[first + shape])
            take_away(film, empty, picture, top, left, bottom - top, right - left)
            lowest = max(lowest, bottom)
    return lowest


@kernel
def cover(film: Any, c: Any, samples: int, covered: Any) -> None:
    """Count for each pixel how many of samples × samples points in it lie within a still part."""
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
