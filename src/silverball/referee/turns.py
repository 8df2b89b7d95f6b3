"""The balls of a game: starting, launching, saving and losing them, shoves, and the end of the game."""

from __future__ import annotations

from silverball.physics.kernel import as_int, inlined, internal
from silverball.referee.at_table import launch_by_itself
from silverball.referee.game_records import Book, Field, Play, Said, Trigger
from silverball.referee.modes import begin_modes, end_ball_states
from silverball.referee.numbers import say
from silverball.referee.tilt import SHOVE, ShoveResult, decayed, shove_result
from silverball.referee.triggers import run_triggers, set_off

compiled_decay, compiled_result = internal(decayed), internal(shove_result)


@inlined
def look_at(play: Play, tick: int, part: int, ball: int, points: int) -> None:
    """Set what the rules act on: an event at a tick, of a part (−1: none), of a ball (0: none)."""
    report = play.report
    report.tick, report.part, report.ball, report.points, report.worth = tick, part, ball, points, 0


@internal
def start_ball(play: Play, book: Book, field: Field, ball: int) -> None:
    """Count a ball that the player has started; only one that starts on an empty board is saved."""
    game, setup, tick = play.game, book.setup, play.report.tick
    is_turn = game.balls == 0
    saves = setup.saves if is_turn else 0
    new = game.ball[game.balls]
    new.id, new.number, new.saves = ball, game.used + 1, saves
    new.safe_until = tick + setup.save_ticks if saves != 0 else 0
    is_first = game.used == 0
    game.balls += 1
    game.used += 1
    game.quiet_since = tick
    if setup.double > 1 and game.balls == 2:
        say(play, as_int(Said.DOUBLE_ON), setup.double, as_int(-1))
    if is_turn:
        begin_modes(play, book, field, is_first)
        set_off(play, book, field, as_int(Trigger.START))


@internal
def return_ball(play: Play, book: Book, field: Field, ball: int) -> None:
    """Count the first of the waiting balls as one on the board again; a plunger may launch it by itself."""
    game, tick = play.game, play.report.tick
    for number in range(game.balls):
        waiting = game.ball[number]
        if waiting.id == 0:
            waiting.id = ball
            waiting.safe_until = tick + book.setup.save_ticks if waiting.saves != 0 else 0
            break
    launch_by_itself(book, field, ball)
    game.quiet_since = tick


@internal
def launch_ball(play: Play, book: Book, field: Field, ball: int) -> None:
    """Let the time in which a lost ball is saved begin when it leaves the plunger."""
    game, tick = play.game, play.report.tick
    for number in range(game.balls):
        in_play = game.ball[number]
        if in_play.id == ball and in_play.safe_until != 0:
            in_play.safe_until = tick + book.setup.save_ticks
    game.quiet_since = tick
    set_off(play, book, field, as_int(Trigger.LAUNCH))


@internal
def drain_ball(play: Play, book: Book, field: Field, ball: int) -> None:
    """Save or lose a ball that has left the board."""
    game, setup, tick = play.game, book.setup, play.report.tick
    if place_of(play, ball) < 0:
        return
    set_off(play, book, field, as_int(Trigger.DRAIN))
    lost = game.ball[place_of(play, ball)]
    number, safe_until, saves = lost.number, lost.safe_until, lost.saves
    is_saved = saves != 0 and tick < safe_until and game.tilted == 0
    remove_ball(play, place_of(play, ball))
    play.report.touched = 1
    if is_saved:
        back = game.ball[game.balls]
        back.id, back.number, back.saves, back.safe_until = 0, number, saves - 1, 0
        game.balls += 1
        say(play, as_int(Said.BALL_SAVED), number, as_int(-1))
        set_off(play, book, field, as_int(Trigger.SAVE))
        return
    say(play, as_int(Said.BALL_LOST), number, as_int(-1))
    if setup.double > 1 and game.balls == 1:
        say(play, as_int(Said.DOUBLE_OFF), as_int(0), as_int(-1))
    if game.balls > 0:
        set_off(play, book, field, as_int(Trigger.LOST))
        return
    set_off(play, book, field, as_int(Trigger.END))
    if game.balls == 0:  # no rule has brought another one
        end_turn(play, book, field)


@internal
def place_of(play: Play, ball: int) -> int:
    """The place of a ball among those in play; −1 if it is not."""
    for number in range(play.game.balls):
        if play.game.ball[number].id == ball:
            return number
    return -1


@internal
def remove_ball(play: Play, place: int) -> None:
    """Take a ball out of the list of those in play."""
    game = play.game
    for number in range(place, game.balls - 1):
        one, following = game.ball[number], game.ball[number + 1]
        one.id, one.number = following.id, following.number
        one.safe_until, one.saves = following.safe_until, following.saves
    game.balls -= 1
    last = game.ball[game.balls]
    last.id, last.number, last.safe_until, last.saves = 0, 0, 0, 0


@internal
def end_turn(play: Play, book: Book, field: Field) -> None:
    """End the turn of the ball that was the last one in play, and with the last turn the game."""
    game, setup = play.game, book.setup
    game.tilted, game.warnings, game.combo = 0, 0, 0
    end_ball_states(play, book, field)
    if game.extra_balls > 0:
        game.extra_balls -= 1
        game.used -= 1
    if setup.balls != 0 and game.used >= setup.balls:
        end_game(play)
    else:
        say(play, as_int(Said.BALL_READY), game.used + 1, as_int(-1))


@internal
def end_game(play: Play) -> None:
    """End the game now."""
    if play.game.over == 0:
        play.game.over = 1
        say(play, as_int(Said.OVER), play.game.score, as_int(-1))


@internal
def shove_table(play: Play, book: Book, field: Field) -> None:
    """Swing the tilt bob: nothing, a warning or a tilt."""
    game, setup, tick = play.game, book.setup, play.report.tick
    if game.tilted != 0 or setup.tilts == 0:
        return
    game.swing = compiled_decay(game.swing, tick - game.swing_tick, setup.tilt_decay) + SHOVE
    game.swing_tick = tick
    result = compiled_result(game.swing, game.warnings, setup.tilt_warning, setup.tilt_limit, setup.warnings)
    if result == ShoveResult.TILT:
        set_off(play, book, field, as_int(Trigger.TILT))
        game.tilted, game.combo, game.released = 1, 0, tick
        say(play, as_int(Said.TILT), as_int(0), as_int(-1))
    elif result == ShoveResult.WARNING:
        game.warnings += 1
        say(play, as_int(Said.WARNING), game.warnings, as_int(-1))
        set_off(play, book, field, as_int(Trigger.WARNING))
    run_triggers(play, book, field)
