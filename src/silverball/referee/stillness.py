"""Stuck balls: an automatic shove if a ball lies still or if nothing has scored for a long time.

The game looks four times a second, at ticks that depend on the tick rate alone. A ball that has not moved
between two looks is at rest, or hopping in place. A ball within reach of the paddles belongs to the player
while a button is held or was released a moment ago; but a player who holds it too long without scoring gets a
shove too.
"""

from __future__ import annotations

from silverball.physics.for_devices import ball_slots, is_captured
from silverball.physics.kernel import as_int, inlined, internal
from silverball.physics.records import LEFT, RIGHT
from silverball.referee.game_records import Book, Field, GameRecord, Play, RestRecord, Said, SetupRecord
from silverball.referee.numbers import say

CHECK_RATE = 4  # looks per second
STILL_DISTANCE = 0.03  # [u] a ball that stays within it lies still; hopping moves it by less than 0.001 u


@internal
def look_for_stuck_balls(play: Play, book: Book, field: Field, tick: int) -> None:
    """Note which balls have lain still up to this tick, and shove the table if that is due."""
    game = play.game
    game.next_look = tick + book.setup.check_ticks
    note_rests(play, field, tick)
    if book.setup.auto_shove == 0 or not needs_shove(game, book.setup, field.board.paddle_top, tick):
        return
    game.auto_shove, game.shoved = 1, tick
    for number in range(game.rests):
        game.rest[number].since = tick
    play.report.tick = tick
    say(play, as_int(Said.UNSTUCK), as_int(0), as_int(-1))


@internal
def note_rests(play: Play, field: Field, tick: int) -> None:
    """Note where the balls that move on the board are, and since when, in the order of the slots."""
    game, noted, world = play.game, play.report.rest, field.world
    before, count = game.rests, 0
    for number in range(before):
        copy_rest(game.rest[number], noted[number])
    for slot in range(ball_slots(world, field.board)):
        ball = world.ball[slot]
        if ball.id == 0 or is_captured(ball):
            continue
        rest = game.rest[count]
        rest.ball, rest.x, rest.z, rest.since = ball.id, ball.x, ball.z, tick
        for number in range(before):
            old = noted[number]
            if old.ball == ball.id and abs(ball.x - old.x) + abs(ball.z - old.z) < STILL_DISTANCE:
                copy_rest(old, rest)
        count += 1
    for number in range(count, before):
        rest = game.rest[number]
        rest.ball, rest.x, rest.z, rest.since = 0, 0.0, 0.0, 0
    game.rests = count


@inlined
def copy_rest(one: RestRecord, to: RestRecord) -> None:
    """Copy the fields of a rest."""
    to.ball, to.x, to.z, to.since = one.ball, one.x, one.z, one.since


@internal
def needs_shove(game: GameRecord, setup: SetupRecord, reach: float, tick: int) -> bool:
    """Whether the automatic shove is due; no paddle reaches a ball above the x `reach` [u]."""
    if game.rests == 0 or tick - game.shoved < setup.unstick_ticks:
        return False
    if setup.has_points != 0 and tick - game.quiet_since >= setup.stall_ticks:
        return True
    is_held = game.buttons & (LEFT | RIGHT) != 0 and game.tilted == 0
    is_caught = is_held or tick - game.released < setup.unstick_ticks
    for number in range(game.rests):
        rest = game.rest[number]
        if tick - rest.since >= setup.unstick_ticks and not (is_caught and rest.x <= reach):
            return True
    return False
