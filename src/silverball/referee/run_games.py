"""Many games played together: the step of the worlds and the rules of the games in one loop.

A game is judged after every tick in which something has happened. A game of a batch is, bit for bit, the
game that `silverball.Game` plays with the same seed and the same buttons.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from silverball.physics.balls import create_ball
from silverball.physics.event_log import begin_step
from silverball.physics.kernel import as_int, inlined, internal, ir_inlined, kernel, prefetch
from silverball.physics.records import (
    JITTER,
    LAUNCH,
    NUDGE_UP,
    NUDGES,
    BatchGeometry,
    BoardGeometry,
    BoardRecord,
    Fault,
    Lane,
    Lanes,
    Outcome,
)
from silverball.physics.step import (
    LINE,
    advance,
    are_balls_on_board,
    can_step,
    end_step,
    held_buttons,
    hot_lines,
    shove,
    shove_bits,
)
from silverball.referee.game_records import Book, Field, Play, ReportRecord, SetupRecord
from silverball.referee.judge import Call, bring_waiting, is_late, is_scoring, judge, judge_buttons
from silverball.referee.stillness import look_for_stuck_balls

HOT_LINES = 2  # of a game that are read in every tick


class GameRows(NamedTuple):
    """The games of a batch.

    Attributes:
        games: GAME records [world].
        seen: Points of the hits that each game has been told of [world].
        setups: SETUP records [board].
        book: The rules of all boards, with the record of any of them.
        places: The places for new balls.
        report: A REPORT record, which the games of a slice share.
        serves: 1: the next ball of a game starts by itself, when none is in play.
    """

    games: Any
    seen: Any
    setups: Any
    book: Book
    places: Any
    report: ReportRecord
    serves: int


class Match(NamedTuple):
    """A game of a batch with its rules and its world."""

    play: Play
    book: Book
    field: Field
    serves: int


@ir_inlined
def book_of(book: Book, setup: SetupRecord) -> Book:
    """The rules with the record of one table."""
    return Book(
        setup,
        book.rules,
        book.ops,
        book.triggers,
        book.listed,
        book.parts,
        book.lamps,
        book.counters,
        book.modes,
        book.reaches,
        book.banks,
    )


@kernel
def run_games(
    lanes: Lanes,
    geometries: BatchGeometry,
    rows: GameRows,
    actions: Any,
    first: int,
    end: int,
    ticks: int,
    tick: float,
) -> None:
    """Play the games first … end − 1 for a number of ticks, as `run_worlds` advances their worlds."""
    is_continued, count = ticks < 0, abs(ticks)
    for index in range(first, end):
        lane = Lane(lanes.worlds[index], lanes.logs[index], lanes.tallies[index], lanes.logs[first])
        number = lanes.board_of[index]
        world, log, board = lane.world, lane.log, geometries.boards[number]
        geometry = BoardGeometry(board, geometries.colliders, geometries.grid)
        match = Match(
            Play(rows.games[index], rows.report),
            book_of(rows.book, rows.setups[number]),
            Field(world, board, geometries.colliders, geometries.grid, rows.places, log),
            rows.serves,
        )
        if index + 1 < end:
            prefetch_next(lanes, rows, index + 1)
        if not is_continued:
            begin_step(log)
        if count != 0 and match.play.game.over == 0 and can_step(world, geometry, log, tick):
            play_game(lane, match, actions, rows.seen, index, ticks, tick)


@inlined
def play_game(lane: Lane, match: Match, actions: Any, seen: Any, index: int, ticks: int, tick: float) -> None:
    """Play one game, which is not over and whose world can be stepped; for the arguments see `run_games`."""
    is_held, is_continued, count = actions.shape[0] == 1, ticks < 0, abs(ticks)
    game, field = match.play.game, match.field
    world, board, log = lane.world, field.board, lane.log
    geometry = BoardGeometry(board, field.colliders, field.grid)
    done = 0
    while done < count and game.over == 0 and are_balls_on_board(world, board):
        row = 0 if is_held else done
        shoves = shove_bits(actions, row, index)
        if is_held and (done > 0 or is_continued):
            shoves = 0
        act(match, held_buttons(actions, row, index), shoves, tick)
        was_late = is_late(match.play, match.book, field)
        limit = ticks_at_once(match, count - done if is_held else 1, was_late)
        played, is_judged = play_ticks(lane, geometry, match, tick, limit, seen, index)
        done += played
        if was_late or is_judged:
            bring_what_waits(match)
        if world.tick >= game.next_look and game.over == 0:
            look_for_stuck_balls(match.play, match.book, field, world.tick)
    end_step(world, board, log)
    if world.fault != Fault.NONE:
        judge(match.play, match.book, field, as_int(Call.END), as_int(0))


@inlined
def prefetch_next(lanes: Lanes, rows: GameRows, index: int) -> None:
    """Ask for the lines of the cache that a game and its world will need."""
    world = lanes.worlds[index]
    for line in range(hot_lines(world)):
        prefetch(world, line * LINE)
    prefetch(lanes.logs[index], 0)
    for line in range(HOT_LINES):
        prefetch(rows.games[index], line * LINE)


@inlined
def act(match: Match, buttons: int, shoves: int, tick: float) -> None:
    """Do what the player does before a tick: start a ball, press buttons, shove the table (bits)."""
    play, book, field, game = match.play, match.book, match.field, match.play.game
    if match.serves != 0 and game.balls == 0:
        outcome = create_ball(field.world, field.board, field.colliders, field.places, field.log)
        if outcome == Outcome.CREATED:
            judge(play, book, field, as_int(Call.START), field.world.created)
    if field.board.plungers == 0:
        buttons &= ~LAUNCH  # there is nothing to launch
    if buttons != game.buttons:
        judge_buttons(play, book, field, buttons)
    if shoves != 0 and game.tilted == 0 and has_balls(field):
        game.shove = player_shove(field.board, shoves)
        judge(play, book, field, as_int(Call.SHOVE), as_int(0))
    if game.shove != 0 or game.auto_shove != 0:
        bits = game.shove | (JITTER if game.auto_shove != 0 else 0)
        shove(field.world, field.board, field.log, bits, tick)
        game.shove, game.auto_shove = 0, 0


@inlined
def player_shove(board: BoardRecord, shoves: int) -> int:
    """The bits of what a shove does: one nudge (the jitter: up), or the jitter on a board without nudge."""
    if board.nudge == 0.0:
        return JITTER + 0
    nudges = shoves & NUDGES
    return nudges & -nudges if nudges != 0 else NUDGE_UP + 0


@inlined
def has_balls(field: Field) -> bool:
    """Whether a ball is on the board."""
    count = 0
    for slot in range(len(field.world.ball)):
        count += field.world.ball[slot].id != 0
    return count != 0


@inlined
def ticks_at_once(match: Match, limit: int, is_late: bool) -> int:
    """How many of these ticks may be played before the rules are asked again, at least 1."""
    game, now = match.play.game, match.field.world.tick
    if is_late or (match.serves != 0 and game.balls == 0):
        return 1
    return min(limit, game.next_look - now, max(game.next_end + 1 - now, 1))


@inlined
def play_ticks(
    lane: Lane, geometry: BoardGeometry, match: Match, tick: float, limit: int, seen: Any, index: int
) -> tuple[int, bool]:
    """Play one tick, or some without events; return how many, and whether the rules have acted."""
    play, book, field, log = match.play, match.book, match.field, lane.log
    game, world = play.game, lane.world
    if log.count > 0:
        begin_step(log)
    buttons = game.buttons if game.tilted == 0 else game.buttons & LAUNCH
    count = advance(lane, geometry, buttons, tick, limit)
    is_judged = log.count > log.carried or log.lost > 0 or game.next_end < world.tick
    if is_judged:
        play.report.passed = 0
        lost = lost_points(lane, book, seen[index]) if log.lost > 0 else as_int(0)
        judge(play, book, field, as_int(Call.TICKS), lost)
        seen[index] += play.report.passed
    log.done = log.count
    return count, is_judged


@internal
def bring_what_waits(match: Match) -> None:
    """Bring balls, gates and banks that wait until they have room."""
    play, book, field = match.play, match.book, match.field
    if is_late(play, book, field):
        bring_waiting(play, book, field)
        judge(play, book, field, as_int(Call.SWITCHES), as_int(0))


@internal
def lost_points(lane: Lane, book: Book, seen: int) -> int:
    """Points of the hits of a tick that did not fit into the log."""
    total, first = -seen, book.setup.part_first
    for part in range(book.setup.parts):
        total += lane.tally[part] * book.parts[first + part].points
    for number in range(lane.log.carried, lane.log.count):
        event = lane.log.event[number]
        if is_scoring(event.kind):
            total -= book.parts[first + event.part].points
    return max(total, 0)
