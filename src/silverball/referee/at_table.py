"""What rules do at the table: kicking, locking, ejecting and launching balls, gates, banks.

Everything happens between two ticks. A gate that is to close, or a bank that is to come back, waits until
no ball is in its way. What is moved sets `touched`: the ticks after it must be played with it.
"""

from __future__ import annotations

from silverball.physics.bounce import clamp_speed
from silverball.physics.for_devices import ball_slots, for_devices, is_captured
from silverball.physics.kernel import as_int, internal
from silverball.physics.motion import clear_ball, start_flight
from silverball.physics.records import BoardGeometry, Device, Motion, WorldRecord
from silverball.physics.switches import set_switch
from silverball.referee.game_records import Book, Field, GameRecord, Op, OpRecord, Own, Play, Said
from silverball.referee.numbers import change_counter, say


@internal
def kick_ball(play: Play, field: Field, op: OpRecord) -> None:
    """Send off the ball that set off the rule."""
    world, board = field.world, field.board
    for slot in range(ball_slots(world, board)):
        ball = world.ball[slot]
        if ball.id != 0 and ball.id == play.report.ball and not is_captured(ball):
            ball.vx, ball.vz = clamp_speed(op.x, op.z, board.speed_cap)
            start_flight(ball, board, 0.0)
            play.report.touched = 1


@for_devices(lambda play, book, field: None)
@internal
def lock_ball(play: Play, book: Book, field: Field) -> None:
    """Take the ball that a hole has caught off the table; another one waits to come in its place."""
    world, game = field.world, play.game
    for slot in range(field.board.max_balls):
        ball = world.ball[slot]
        if ball.id == 0 or ball.id != play.report.ball or ball.motion != Motion.CAPTURED:
            continue
        if field.colliders[field.board.collider_first + ball.holder].role != Device.HOLE:
            continue
        for number in range(game.balls):
            if game.ball[number].id == ball.id:
                game.ball[number].id = 0
        clear_ball(ball)
        world.drained += 1
        play.report.touched = 1
        change_counter(play, book, as_int(Own.LOCKED), game.locked + 1)
        say(play, as_int(Said.BALL_LOCKED), game.locked, play.report.part)


@for_devices(lambda play, field, part: None)
@internal
def eject_balls(play: Play, field: Field, part: int) -> None:
    """Let a hole send off its ball in the next tick."""
    world, board = field.world, field.board
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id == 0 or ball.motion != Motion.CAPTURED:
            continue
        c = field.colliders[board.collider_first + ball.holder]
        if c.part == part and c.role == Device.HOLE:
            ball.due_tick, ball.due_offset = world.tick, 0.0
            world.next_clock = min(world.next_clock, world.tick)
            play.report.touched = 1


@for_devices(lambda book, field, ball: False)
@internal
def launch_by_itself(book: Book, field: Field, ball: int) -> bool:
    """Let a plunger that can launch a ball by itself do so after its delay; return whether it will."""
    world, board = field.world, field.board
    for slot in range(board.max_balls):
        lying = world.ball[slot]
        if lying.id == 0 or lying.id != ball or lying.motion != Motion.CAPTURED:
            continue
        c = field.colliders[board.collider_first + lying.holder]
        delay = book.parts[book.setup.part_first + c.part].auto_ticks
        if c.role == Device.PLUNGER and delay > 0:
            lying.due_tick, lying.due_offset = world.tick + delay, 0.0
            world.next_clock = min(world.next_clock, lying.due_tick)
            return True
    return False


@for_devices(lambda play, book, field, op: None)
@internal
def want_switches(play: Play, book: Book, field: Field, op: OpRecord) -> None:
    """Note that a bank is to come back, or that a gate is to be open or closed."""
    game = play.game
    if op.op == Op.RESET:
        game.resets |= 1 << op.target
    elif op.op == Op.OPEN:
        game.open_gates |= op.target
    else:
        game.open_gates &= ~op.target
    work_switches(play, book, field, op.target if op.op != Op.RESET else as_int(0))
    play.report.touched = 1


@for_devices(lambda play, book, field, gates: None)
@internal
def work_switches(play: Play, book: Book, field: Field, gates: int) -> None:
    """Let banks come back, and open and close the gates with these switches, as far as they can."""
    world, game = field.world, play.game
    geometry = BoardGeometry(field.board, field.colliders, field.grid)
    for bank in range(field.board.banks):
        if game.resets >> bank & 1 != 0:
            mask = book.banks[book.setup.bank_first + bank].switches
            if world.off & mask == 0 or set_switch(world, geometry, mask, False):
                game.resets &= ~(1 << bank)
                game.fallen &= ~mask
                world.banks_due &= ~(1 << bank)
    if gates == 0:
        return
    opening, closing = gates & game.open_gates & ~world.off, gates & ~game.open_gates & world.off
    if opening != 0:
        set_switch(world, geometry, opening, True)
    for bit in range(62):
        if closing >> bit & 1 != 0:
            set_switch(world, geometry, 1 << bit, False)


@for_devices(lambda game, world, gates: False)
@internal
def has_late_switches(game: GameRecord, world: WorldRecord, gates: int) -> bool:
    """Whether a gate or a bank waits until no ball is in its way; `gates` are the switches of all gates."""
    return bool(game.resets != 0 or (world.off ^ game.open_gates) & gates != 0)
