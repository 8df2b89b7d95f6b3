"""What rules make of a tick: the events of its log in their order, and the modes whose time is over.

`single_judge.py` calls `judge` for one game, `run_games.py` for many.
"""

from __future__ import annotations

from enum import IntEnum

from silverball.physics.balls import create_ball
from silverball.physics.event_log import flight_checksum, store_checksum
from silverball.physics.for_devices import ball_slots, for_devices
from silverball.physics.kernel import as_int, inlined, internal
from silverball.physics.records import LAUNCH, LEFT, RIGHT, EventKind, Outcome
from silverball.referee.at_table import has_late_switches, launch_by_itself, work_switches
from silverball.referee.game_records import NOT_RUNNING, Book, Field, Play, Said, Trigger
from silverball.referee.modes import due_mode, set_next_end
from silverball.referee.numbers import push, say
from silverball.referee.stillness import look_for_stuck_balls
from silverball.referee.triggers import run_triggers, set_off
from silverball.referee.turns import (
    drain_ball,
    end_game,
    launch_ball,
    look_at,
    return_ball,
    shove_table,
    start_ball,
)


class Call(IntEnum):
    """What `judge` is called for."""

    TICKS = 0  # ticks have been played; the value: points of hits that did not fit into the log
    START = 1  # the player has started the ball with this id
    RETURN = 2  # the first of the waiting balls has come to the table with this id
    SHOVE = 3  # the player has shoved the table
    BUTTONS = 4  # these buttons are held from now on
    STILLNESS = 5  # it is time to look for balls that lie still
    SWITCHES = 6  # gates and banks may wait until no ball is in their way
    END = 7  # the game ends, as when the player leaves it


@internal
def judge_ticks(play: Play, book: Book, field: Field, until: int, lost_points: int) -> None:
    """Let the rules act on the events in the log, and on what is due before a tick.

    Args:
        play: The game.
        book: Its rules.
        field: Its world, in which the ticks have been played.
        until: The tick before which all is due.
        lost_points: Points of hits that did not fit into the log.
    """
    log = field.log
    for number in range(log.carried, log.count):
        event = log.event[number]
        if event.kind != EventKind.CREATED:
            end_modes(play, book, field, event.tick + 1)
            look_at(play, event.tick, event.part, event.ball, as_int(0))
            judge_event(play, book, field, event.kind)
    if log.lost > 0:
        judge_lost(play, book, field, until - 1, lost_points)
    end_modes(play, book, field, until)


@internal
def judge_event(play: Play, book: Book, field: Field, kind: int) -> None:
    """Let the rules act on one event, which `look_at` has set."""
    report, part = play.report, play.report.part
    if kind == EventKind.GUTTER:
        drain_ball(play, book, field, report.ball)
    elif kind == EventKind.RELEASED:
        if book.parts[book.setup.part_first + part].is_plunger != 0:
            launch_ball(play, book, field, report.ball)
        set_off(play, book, field, book.setup.release_first + part)
    elif kind == EventKind.RESET:
        bank = book.parts[book.setup.part_first + part].bank
        if bank >= 0:
            play.game.fallen &= ~book.banks[book.setup.bank_first + bank].switches
    elif is_scoring(kind):
        report.points = book.parts[book.setup.part_first + part].points
        report.passed += report.points
        judge_hit(play, book, field, book.setup.hit_first + part)
        if kind == EventKind.HIT:
            judge_fall(play, book, field)
        elif kind == EventKind.CAPTURED:
            launch_again(play, book, field)


@internal
def launch_again(play: Play, book: Book, field: Field) -> None:
    """Let a plunger launch by itself a ball that has fallen back onto it while others are in play."""
    if play.game.balls > 1 and launch_by_itself(book, field, play.report.ball):
        play.report.touched = 1


@inlined
def is_scoring(kind: int) -> bool:
    """Whether an event gives the points of its part."""
    return kind in (EventKind.HIT, EventKind.PASS, EventKind.SPIN, EventKind.CAPTURED)


@internal
def judge_hit(play: Play, book: Book, field: Field, trigger: int) -> None:
    """Let the rules act on a hit, and note when it gives points."""
    if play.report.points != 0:
        play.game.quiet_since = play.report.tick
    set_off(play, book, field, trigger)


@for_devices(lambda play, book, field: None)
@internal
def judge_fall(play: Play, book: Book, field: Field) -> None:
    """Note a drop target that has fallen, and let the rules act if it was the last one of its bank."""
    game, part = play.game, book.parts[book.setup.part_first + play.report.part]
    if part.bank < 0 or game.fallen & part.switch != 0:
        return
    game.fallen |= part.switch
    mask = book.banks[book.setup.bank_first + part.bank].switches
    if game.fallen & mask == mask:
        set_off(play, book, field, book.setup.down_first + part.bank)


@internal
def judge_lost(play: Play, book: Book, field: Field, tick: int, points: int) -> None:
    """Let the rules act on hits and lost balls that did not fit into the log."""
    if points > 0:
        look_at(play, tick, as_int(-1), as_int(0), points)
        play.report.passed += points
        judge_hit(play, book, field, as_int(Trigger.ANY_HIT))
    number = 0
    while number < play.game.balls:
        ball = play.game.ball[number].id
        if ball == 0 or is_on_board(field, ball):
            number += 1
            continue
        look_at(play, tick, as_int(-1), ball, as_int(0))
        drain_ball(play, book, field, ball)


@internal
def is_on_board(field: Field, ball: int) -> bool:
    """Whether the ball with this id is on the board."""
    is_found = False
    for slot in range(ball_slots(field.world, field.board)):
        is_found = is_found or field.world.ball[slot].id == ball
    return is_found


@for_devices(lambda play, book, field, until: None)
@internal
def end_modes(play: Play, book: Book, field: Field, until: int) -> None:
    """End the modes whose time is over before a tick, in the order of their times."""
    game, setup = play.game, book.setup
    while setup.modes > 0 and game.next_end < until and game.over == 0:
        mode = due_mode(play, book)
        look_at(play, game.next_end, as_int(-1), as_int(0), as_int(0))
        game.mode_end[mode] = NOT_RUNNING
        set_next_end(play, book)
        say(play, as_int(Said.MODE_ENDED), mode, as_int(-1))
        push(play, book, setup.time_first + mode)
        push(play, book, setup.end_first + mode)
        run_triggers(play, book, field)


@inlined
def judge_buttons(play: Play, book: Book, field: Field, buttons: int) -> None:
    """Let the rules act on buttons (bits) that are held from now on."""
    game = play.game
    pressed, released = buttons & ~game.buttons, game.buttons & ~buttons
    if released & (LEFT | RIGHT) != 0:
        game.released = field.world.tick
    game.buttons = buttons
    for bit, trigger in ((LEFT, Trigger.LEFT), (RIGHT, Trigger.RIGHT), (LAUNCH, Trigger.PLUNGER)):
        if pressed & bit != 0:
            push(play, book, as_int(trigger))
    if play.report.waiting != 0:
        look_at(play, field.world.tick, as_int(-1), as_int(0), as_int(0))
        run_triggers(play, book, field)


@for_devices(lambda play, book, field: None)
@internal
def judge_switches(play: Play, book: Book, field: Field) -> None:
    """Work gates and banks that wait until no ball is in their way."""
    gates = book.setup.gates
    if has_late_switches(play.game, field.world, gates):
        work_switches(play, book, field, gates)


@internal
def judge(play: Play, book: Book, field: Field, call: int, value: int) -> None:
    """Let the rules act on something that happens between two ticks, or on the ticks that have been played.

    Args:
        play: The game.
        book: Its rules.
        field: Its world.
        call: What it is, a `Call`.
        value: What belongs to it: the id of a ball, the bits of the buttons, or lost points.
    """
    tick = field.world.tick
    if call != Call.TICKS:
        look_at(play, tick, as_int(-1), as_int(0), as_int(0))
    if call == Call.TICKS:
        judge_ticks(play, book, field, tick, value)
    elif call == Call.START:
        start_ball(play, book, field, value)
    elif call == Call.RETURN:
        return_ball(play, book, field, value)
    elif call == Call.SHOVE:
        shove_table(play, book, field)
    elif call == Call.BUTTONS:
        judge_buttons(play, book, field, value)
    elif call == Call.STILLNESS:
        look_for_stuck_balls(play, book, field, tick)
    elif call == Call.SWITCHES:
        judge_switches(play, book, field)
    else:
        end_game(play)


@internal
def judge_between_steps(play: Play, book: Book, field: Field, call: int, value: int) -> None:
    """Judge between two calls that step the world: if its log knew the state, it knows the new one.

    Otherwise the next step would validate the state, as one that was changed from outside.
    """
    is_known = flight_checksum(field.world, field.board) == field.log.checksum
    judge(play, book, field, call, value)
    if is_known:
        store_checksum(field.world, field.board, field.log)
    play.report.late = is_late(play, book, field)


@inlined
def is_late(play: Play, book: Book, field: Field) -> bool:
    """Whether a ball, a gate or a bank waits until it has room."""
    return has_waiting(play) or has_late_switches(play.game, field.world, book.setup.gates)


@inlined
def has_waiting(play: Play) -> bool:
    """Whether a ball waits to come to the table."""
    is_found = False
    for number in range(play.game.balls):
        is_found = is_found or play.game.ball[number].id == 0
    return is_found


@internal
def bring_waiting(play: Play, book: Book, field: Field) -> None:
    """Bring the balls to the table that wait for it, as far as there is a place for them."""
    while has_waiting(play):
        outcome = create_ball(field.world, field.board, field.colliders, field.places, field.log)
        if outcome != Outcome.CREATED:
            return
        look_at(play, field.world.tick, as_int(-1), field.world.created, as_int(0))
        return_ball(play, book, field, field.world.created)
