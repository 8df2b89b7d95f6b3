"""Lamps of a game: lighting them one by one, and moving the light within a group."""

from __future__ import annotations

from silverball.physics.kernel import as_int, internal
from silverball.referee.game_records import Book, Light, Op, Play
from silverball.referee.numbers import push


@internal
def set_lamp(play: Play, book: Book, lamp: int, light: int) -> None:
    """Give a lamp a state; the last one of a group that goes on sets off what waits for the group."""
    game, setup = play.game, book.setup
    before = game.lamp[lamp]
    game.lamp[lamp] = light
    row = book.lamps[setup.lamp_first + lamp]
    if light != Light.ON or before == Light.ON or row.group < 0:
        return
    for place in range(row.first, row.end):
        if game.lamp[book.listed[place]] != Light.ON:
            return
    push(play, book, setup.complete_first + row.group)


@internal
def move_light(play: Play, book: Book, op: int, lamp: int) -> None:
    """Move the light in the group of a lamp: LIGHT_NEXT, ADVANCE, ROTATE_LEFT or ROTATE_RIGHT."""
    row = book.lamps[book.setup.lamp_first + lamp]
    if op == Op.LIGHT_NEXT:
        for place in range(row.first, row.end):
            if play.game.lamp[book.listed[place]] != Light.ON:
                set_lamp(play, book, book.listed[place], as_int(Light.ON))
                return
    elif op == Op.ADVANCE:
        advance_blinking(play, book, row.first, row.end)
    else:
        rotate(play, book, row.first, row.end, op == Op.ROTATE_LEFT)


@internal
def advance_blinking(play: Play, book: Book, first: int, end: int) -> None:
    """Let the next lamp that is off blink in place of the one that does, or else the first."""
    game, count = play.game, end - first
    blinking = -1
    for place in range(count):
        if game.lamp[book.listed[first + place]] == Light.BLINKING and blinking < 0:
            blinking = place
    for step in range(1, count + 1):
        place = (max(blinking, -1) + step) % count
        lamp = book.listed[first + place]
        if game.lamp[lamp] == Light.OFF:
            if blinking >= 0:
                game.lamp[book.listed[first + blinking]] = Light.OFF
            game.lamp[lamp] = Light.BLINKING
            return


@internal
def rotate(play: Play, book: Book, first: int, end: int, is_left: bool) -> None:
    """Let each lamp take the state of its neighbour, in a ring."""
    game = play.game
    if is_left:
        kept = game.lamp[book.listed[first]]
        for place in range(first, end - 1):
            game.lamp[book.listed[place]] = game.lamp[book.listed[place + 1]]
        game.lamp[book.listed[end - 1]] = kept
        return
    kept = game.lamp[book.listed[end - 1]]
    for place in range(end - 1, first, -1):
        game.lamp[book.listed[place]] = game.lamp[book.listed[place - 1]]
    game.lamp[book.listed[first]] = kept
