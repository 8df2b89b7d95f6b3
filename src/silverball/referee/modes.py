"""Modes of a game: what runs, and until which tick."""

from __future__ import annotations

from silverball.physics.for_devices import for_devices
from silverball.physics.kernel import as_int, internal
from silverball.referee.game_records import FOREVER, NOT_RUNNING, Begin, Book, Field, Play, Said
from silverball.referee.numbers import push, say


@internal
def start_mode(play: Play, book: Book, mode: int) -> None:
    """Start a mode, or let its time begin anew."""
    game, row = play.game, book.modes[book.setup.mode_first + mode]
    before = game.mode_end[mode]
    game.mode_end[mode] = play.report.tick + row.ticks if row.ticks > 0 else FOREVER
    set_next_end(play, book)
    if before == NOT_RUNNING:
        say(play, as_int(Said.MODE_STARTED), mode, as_int(-1))
        push(play, book, book.setup.start_first + mode)


@internal
def stop_mode(play: Play, book: Book, mode: int) -> None:
    """Stop a mode that runs."""
    game = play.game
    if game.mode_end[mode] == NOT_RUNNING:
        return
    game.mode_end[mode] = NOT_RUNNING
    set_next_end(play, book)
    say(play, as_int(Said.MODE_ENDED), mode, as_int(-1))
    push(play, book, book.setup.end_first + mode)


@internal
def extend_mode(play: Play, book: Book, mode: int, ticks: int) -> None:
    """Lengthen a mode that runs and has a time."""
    game = play.game
    if game.mode_end[mode] not in (NOT_RUNNING, FOREVER):
        game.mode_end[mode] += ticks
        set_next_end(play, book)


@internal
def set_next_end(play: Play, book: Book) -> None:
    """Store the next tick in which a mode ends."""
    game, first = play.game, as_int(FOREVER)
    for mode in range(book.setup.modes):
        if game.mode_end[mode] != NOT_RUNNING:
            first = min(first, game.mode_end[mode])
    game.next_end = first


@internal
def due_mode(play: Play, book: Book) -> int:
    """The mode that ends next; of several in one tick the first of the file."""
    game = play.game
    for mode in range(book.setup.modes):
        if game.mode_end[mode] == game.next_end:
            return mode
    return 0


@for_devices(lambda play, book, field, is_first: None)
@internal
def begin_modes(play: Play, book: Book, field: Field, is_first: bool) -> None:
    """Start the modes that start with each ball and, with the first, those that start with the game."""
    for mode in range(book.setup.modes):
        begins = book.modes[book.setup.mode_first + mode].begins
        if begins == Begin.BALL or (is_first and begins == Begin.GAME):
            start_mode(play, book, mode)


@for_devices(lambda play, book, field: None)
@internal
def end_ball_states(play: Play, book: Book, field: Field) -> None:
    """End the modes that last for a ball, without a trigger, and reset such lamps and counters."""
    game, setup = play.game, book.setup
    for mode in range(setup.modes):
        if book.modes[setup.mode_first + mode].of_ball != 0 and game.mode_end[mode] != NOT_RUNNING:
            game.mode_end[mode] = NOT_RUNNING
            say(play, as_int(Said.MODE_ENDED), mode, as_int(-1))
    set_next_end(play, book)
    for lamp in range(setup.lamps):
        row = book.lamps[setup.lamp_first + lamp]
        if row.of_ball != 0:
            game.lamp[lamp] = row.begins
    for number in range(setup.counters):
        counter = book.counters[setup.counter_first + number]
        if counter.of_ball != 0:
            game.counter[number] = counter.begins
