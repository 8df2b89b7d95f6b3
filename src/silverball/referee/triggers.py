"""Setting off rules: finding those of a trigger whose conditions hold, and doing what they say.

The conditions of all rules of a trigger are looked at before any of them acts. What acts set off waits in a
queue.
"""

from __future__ import annotations

from silverball.physics.for_devices import for_devices
from silverball.physics.kernel import as_int, internal
from silverball.referee.acts import act
from silverball.referee.game_records import (
    MOST_MATCHES,
    MOST_TRIGGERS,
    NOT_RUNNING,
    QUEUE_LENGTH,
    Book,
    Field,
    Light,
    Op,
    OpRecord,
    Play,
    Said,
)
from silverball.referee.numbers import push, say, value_of


@internal
def set_off(play: Play, book: Book, field: Field, trigger: int) -> None:
    """Set off a trigger, and all that follows from it."""
    push(play, book, trigger)
    run_triggers(play, book, field)


@internal
def run_triggers(play: Play, book: Book, field: Field) -> None:
    """Let the rules of all waiting triggers act."""
    report = play.report
    for _ in range(MOST_TRIGGERS):
        if report.waiting == 0:
            return
        trigger = report.queue[report.head]
        report.head = (report.head + 1) % QUEUE_LENGTH
        report.waiting -= 1
        if play.game.tilted == 0 and play.game.over == 0:
            run_rules(play, book, field, trigger)
    report.waiting = 0


def do_all(play: Play, book: Book, field: Field, trigger: int) -> None:
    """Let all rules of a trigger act: the standard rules have no conditions."""
    place = book.setup.trigger_first + trigger
    for number in range(book.triggers[place], book.triggers[place + 1]):
        do_rule(play, book, field, book.listed[number])


@for_devices(do_all)
@internal
def run_rules(play: Play, book: Book, field: Field, trigger: int) -> None:
    """Let the rules of a trigger act whose conditions hold, in the order of the file."""
    place = book.setup.trigger_first + trigger
    first, end = book.triggers[place], book.triggers[place + 1]
    count = min(end - first, MOST_MATCHES)
    for number in range(count):
        play.report.match[number] = holds(play, book, book.listed[first + number])
    for number in range(count):
        if play.report.match[number] != 0:
            do_rule(play, book, field, book.listed[first + number])


@internal
def holds(play: Play, book: Book, rule: int) -> int:
    """Whether all conditions of a rule hold, 0 or 1."""
    for row in range(book.rules[rule].first_condition, book.rules[rule].first_effect):
        if not is_met(play, book, book.ops[row]):
            return 0
    return 1


@internal
def is_met(play: Play, book: Book, op: OpRecord) -> bool:
    """Whether a condition holds."""
    game, kind, target = play.game, op.op, op.target
    if kind == Op.IF_LIT:
        return bool(game.lamp[target] != Light.OFF)
    if kind == Op.IF_BLINKING:
        return bool(game.lamp[target] == Light.BLINKING)
    if kind == Op.IF_UNLIT:
        return bool(game.lamp[target] == Light.OFF)
    if kind == Op.IF_RUNNING:
        return bool(game.mode_end[target] != NOT_RUNNING)
    if kind == Op.IF_STOPPED:
        return bool(game.mode_end[target] == NOT_RUNNING)
    value = value_of(play, book, target)
    return bool(value >= op.value) if kind == Op.IF_AT_LEAST else bool(value < op.value)


@internal
def do_rule(play: Play, book: Book, field: Field, rule: int) -> None:
    """Do what a rule says, and report the combo that it has lengthened."""
    report = play.report
    report.has_combo = 0
    for row in range(book.rules[rule].first_effect, book.rules[rule].end_effect):
        act(play, book, field, book.ops[row])
    if report.has_combo != 0 and play.game.combo > 1:
        say(play, as_int(Said.COMBO), play.game.combo, report.part)
