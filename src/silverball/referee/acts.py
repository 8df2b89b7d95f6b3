"""The effects of rules, one OP row each."""

from __future__ import annotations

from silverball.physics.for_devices import for_devices
from silverball.physics.kernel import as_int, internal
from silverball.physics.records import MAX_BALLS
from silverball.referee.at_table import eject_balls, kick_ball, lock_ball, want_switches
from silverball.referee.game_records import Book, Field, Light, Op, OpRecord, Own, Play, Said
from silverball.referee.lamps import move_light, set_lamp
from silverball.referee.modes import extend_mode, start_mode, stop_mode
from silverball.referee.numbers import change_counter, give_points, product, say, value_of


@for_devices(lambda play, book, field, op: act_on_points(play, book, op))
@internal
def act(play: Play, book: Book, field: Field, op: OpRecord) -> None:
    """Do one effect."""
    if op.op <= Op.GIVE:
        act_on_points(play, book, op)
    elif op.op <= Op.ROTATE_RIGHT:
        act_on_lamps(play, book, op)
    elif op.op <= Op.EXTEND:
        act_on_modes(play, book, op)
    elif op.op in (Op.MESSAGE, Op.CUE):
        said = as_int(Said.MESSAGE) if op.op == Op.MESSAGE else as_int(Said.CUE)
        say(play, said, op.target, as_int(-1))
    else:
        act_on_balls(play, book, field, op)


@internal
def act_on_points(play: Play, book: Book, op: OpRecord) -> None:
    """Change a counter, or award points."""
    report = play.report
    if op.op == Op.ADD:
        change_counter(play, book, op.target, value_of(play, book, op.target) + op.value)
    elif op.op == Op.SET:
        change_counter(play, book, op.target, op.value)
    elif op.op == Op.AWARD:
        report.worth = op.value
    elif op.op == Op.AWARD_PART:
        report.worth += report.points
    elif op.op == Op.TIMES:
        report.worth = product(report.worth, value_of(play, book, op.target))
    else:
        give_points(play, report.worth)


@internal
def act_on_lamps(play: Play, book: Book, op: OpRecord) -> None:
    """Light or unlight a lamp, or move the light in its group."""
    if op.op == Op.LIGHT:
        set_lamp(play, book, op.target, as_int(Light.ON))
    elif op.op == Op.BLINK:
        set_lamp(play, book, op.target, as_int(Light.BLINKING))
    elif op.op == Op.UNLIGHT:
        set_lamp(play, book, op.target, as_int(Light.OFF))
    else:
        move_light(play, book, op.op, op.target)


@internal
def act_on_modes(play: Play, book: Book, op: OpRecord) -> None:
    """Start, stop or lengthen a mode."""
    if op.op == Op.START:
        start_mode(play, book, op.target)
    elif op.op == Op.STOP:
        stop_mode(play, book, op.target)
    else:
        extend_mode(play, book, op.target, op.value)


@internal
def act_on_balls(play: Play, book: Book, field: Field, op: OpRecord) -> None:
    """Save, kick, lock, eject or bring balls, or move what is in their way."""
    if op.op == Op.SAVE:
        save_balls(play, play.report.tick + op.value)
    elif op.op == Op.EXTRA_BALL:
        change_counter(play, book, as_int(Own.EXTRA_BALLS), play.game.extra_balls + op.value)
        say(play, as_int(Said.EXTRA_BALL), play.game.extra_balls, as_int(-1))
    elif op.op == Op.KICK:
        kick_ball(play, field, op)
    elif op.op == Op.LOCK:
        lock_ball(play, book, field)
    elif op.op == Op.EJECT:
        eject_balls(play, field, op.target)
    elif op.op == Op.MULTIBALL:
        bring_balls(play, book, op.value)
    else:
        want_switches(play, book, field, op)


@internal
def save_balls(play: Play, until: int) -> None:
    """Let every ball in play come back, once, if it is lost before a tick."""
    for number in range(play.game.balls):
        ball = play.game.ball[number]
        ball.safe_until = max(ball.safe_until, until)
        ball.saves = max(ball.saves, 1)


@internal
def bring_balls(play: Play, book: Book, wanted: int) -> None:
    """Let balls wait to come to the table until so many are in play."""
    game = play.game
    before = game.balls
    for number in range(before, min(wanted, book.setup.max_balls, MAX_BALLS)):
        ball = game.ball[number]
        ball.id, ball.number, ball.safe_until, ball.saves = 0, game.used, 0, 0
        game.balls = number + 1
    if game.balls > before:
        play.report.touched = 1
        say(play, as_int(Said.MULTIBALL), game.balls, as_int(-1))
        if book.setup.double > 1 and before == 1:
            say(play, as_int(Said.DOUBLE_ON), book.setup.double, as_int(-1))
