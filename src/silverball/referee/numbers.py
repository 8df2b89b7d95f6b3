"""What rules count with: reports, points, and the values of counters."""

from __future__ import annotations

from silverball.physics.kernel import as_int, inlined, internal
from silverball.referee.combo import factor_of_combo, hits_in_a_row
from silverball.referee.game_records import (
    MOST_POINTS,
    QUEUE_LENGTH,
    REPORT_LENGTH,
    Book,
    GameRecord,
    Own,
    Play,
    Said,
    SetupRecord,
)


@internal
def say(play: Play, kind: int, value: int, part: int) -> None:
    """Report an event at the tick that is looked at, or count it as lost."""
    report = play.report
    if report.count >= REPORT_LENGTH:
        report.lost += 1
        return
    event = report.event[report.count]
    event.kind, event.tick, event.value, event.part = kind, report.tick, value, part
    report.count += 1


@inlined
def push(play: Play, book: Book, trigger: int) -> None:
    """Let a trigger wait for its turn, if any rule listens to it."""
    report, first = play.report, book.setup.trigger_first
    if book.triggers[first + trigger] == book.triggers[first + trigger + 1] or report.waiting >= QUEUE_LENGTH:
        return
    report.queue[(report.head + report.waiting) % QUEUE_LENGTH] = trigger
    report.waiting += 1


compiled_hits, compiled_factor = internal(hits_in_a_row), internal(factor_of_combo)


@internal
def running_hits(game: GameRecord, setup: SetupRecord, tick: int) -> int:
    """Hits in a row of a game."""
    return compiled_hits(game.combo, game.combo_tick, setup.combo_ticks, tick)


@inlined
def ball_factor(game: GameRecord, setup: SetupRecord) -> int:
    """What points pay while two or more balls are in play."""
    return int(setup.double) if game.balls > 1 else 1


@internal
def value_of(play: Play, book: Book, number: int) -> int:
    """The value of a counter: one of the machine (`Own`), or one of the table."""
    game, setup = play.game, book.setup
    if number >= Own.COUNT:
        return int(game.counter[number - Own.COUNT])
    if number == Own.COMBO:
        return running_hits(game, setup, play.report.tick)
    if number == Own.LOCKED:
        return int(game.locked)
    if number == Own.EXTRA_BALLS:
        return int(game.extra_balls)
    if number == Own.COMBO_FACTOR:
        hits = running_hits(game, setup, play.report.tick)
        return compiled_factor(hits, setup.combo_step, setup.combo_limit)
    if number == Own.BALL_FACTOR:
        return ball_factor(game, setup)
    if number == Own.BALL:
        return int(game.used)
    if number == Own.BALLS_LEFT:
        return max(int(setup.balls - game.used), 0)
    return int(game.balls) if number == Own.IN_PLAY else int(game.warnings)


@internal
def change_counter(play: Play, book: Book, number: int, value: int) -> None:
    """Give a counter a value, as far as it goes, and set off what waits for it."""
    game, setup = play.game, book.setup
    before = value_of(play, book, number)
    value = max(value, 0)
    if number >= Own.COUNT:
        place = number - Own.COUNT
        value = min(value, book.counters[setup.counter_first + place].most)
        game.counter[place] = value
    elif number == Own.COMBO:
        value = value if setup.combo_ticks >= 0 else 0
        game.combo, game.combo_tick = value, play.report.tick
        play.report.has_combo = 1
    elif number == Own.LOCKED:
        game.locked = value
    else:
        game.extra_balls = value
    for row in range(setup.reach_first, setup.reach_end):
        reach = book.reaches[row]
        if reach.counter == number and before < reach.value <= value:
            push(play, book, reach.trigger)


@inlined
def product(worth: int, factor: int) -> int:
    """Multiply points by a number ≥ 0, up to the greatest score there is."""
    if worth > 0 and factor > MOST_POINTS // worth:
        return as_int(MOST_POINTS)
    return worth * factor


@internal
def give_points(play: Play, worth: int) -> None:
    """Add points to the score."""
    game = play.game
    if worth == 0:
        return
    if game.score > MOST_POINTS - worth:
        game.score = max(game.score, MOST_POINTS)
    else:
        game.score += worth
    say(play, as_int(Said.SCORED), worth, play.report.part)
