"""The compiled loop of a study: plays whole games and notes what happened, until all are over.

A player decides 60 times a second, as in `marked_games`. What is noted goes into rows (one a ball, one an
event if asked) and into sums over games, all of whole numbers, so that they do not depend on the order in
which games are played.

Lengths are [u], times are counted in ticks of 1/240 s.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from silverball.metrics.game_traces import CELLS, CONTACTS, MIN_STRIKE_SPEED, TICK_RATE, is_paddle
from silverball.metrics.marked_games import STEP, held_bits, note_balls
from silverball.physics.event_log import begin_step
from silverball.physics.kernel import as_int, inlined, internal, kernel
from silverball.physics.records import (
    LOG_LENGTH,
    MAX_BALLS,
    BatchGeometry,
    BoardGeometry,
    EventKind,
    Fault,
    Lane,
    Lanes,
    Motion,
)
from silverball.physics.step import are_balls_on_board, can_step, end_step
from silverball.referee.game_records import MAX_MODES, Field, Play, Said
from silverball.referee.judge import Call, is_late, judge
from silverball.referee.run_games import (
    GameRows,
    Match,
    act,
    book_of,
    bring_what_waits,
    play_ticks,
    ticks_at_once,
)
from silverball.referee.stillness import look_for_stuck_balls

SPEED_UNIT = 1024  # speeds are summed in whole parts of 1/1024 u/s, so that sums have no rounding
DRAIN_BINS = 64  # across the board, from left to right
NO_MEETINGS = (int(EventKind.TOUCH), int(EventKind.RELEASED))  # what a shot is not aimed at
MOST_BALLS = 8  # rows that one decision may add at most
MOST_EVENTS = STEP * LOG_LENGTH  # the same for events

WATCH = np.dtype(
    [
        # Of the game: ticks with a ball in play that moves; how long a single ball has stayed in one place.
        ("ticks", "i8"), ("at_x", "f8"), ("at_z", "f8"), ("stay", "i8"), ("longest_stay", "i8"),
        ("stay_x", "f8"), ("stay_z", "f8"),  # where the longest one was
        ("balls", "i8"), ("drained", "i8"), ("drained_left", "i8"),  # turns; lost balls, also of multiballs
        ("samples", "i8"), ("samples_left", "i8"),  # balls in play at decisions, of these on the left
        ("hits", "i8"), ("strikes", "i8"), ("fast", "i8"),
        ("is_closed", "i8"),  # whether all has been written down
        # Of the turn that runs: whether there is one, what the game had when it began, where a ball was lost.
        ("in_turn", "i8"), ("began", "i8"), ("ticks_before", "i8"), ("score_before", "i8"),
        ("hits_before", "i8"), ("strikes_before", "i8"), ("drain_z", "f8"),
        ("lost_tick", "i8"),  # the tick in which a ball was lost last, or −1
        ("struck", "i8", (MAX_BALLS,)),  # whether the ball of each slot was struck, and has met nothing since
        ("mode_order", "i8", (MAX_MODES,)), ("modes_begun", "i8"),  # in which order running modes began
    ],
    align=True,
)  # fmt: skip

BALL_ROW = np.dtype(
    [
        ("game", "i8"), ("ball", "i8"),  # the seed of its game; the number of the turn, from 1
        ("tick", "i8"), ("ticks", "i8"),  # when it began; how long balls were in play
        ("is_lost", "i8"),  # 0: the game was cut short before
        ("score", "i8"), ("hits", "i8"), ("strikes", "i8"),
        ("drain_z", "f8"),  # where the last ball was lost; NaN if it was not
    ],
    align=True,
)  # fmt: skip

EVENT_ROW = np.dtype(
    [
        ("game", "i8"), ("ball", "i8"), ("tick", "i8"),  # seed; turn
        ("kind", "i8"), ("part", "i8"),  # EventKind; the part's number
        ("x", "f8"), ("z", "f8"), ("speed", "f8"),
    ],
    align=True,
)  # fmt: skip


class WatchOptions(NamedTuple):
    """How games are played and watched.

    Attributes:
        player: A `PlayerKind`, or BEGINNER.
        limit: The tick after which a game is cut short.
        keeps_events: 1: a row is written for every event.
        shown_modes: 1 for each mode of the table that counts as a cause of points [mode].
        slots: The place of each part in sums [board, part].
        held: What a player that decides elsewhere holds, bool [world, 2].
        decisions: What the beginner decided in the last ticks, bool [world, side, tick].
    """

    player: int
    limit: int
    keeps_events: int
    shown_modes: Any
    slots: Any
    held: Any
    decisions: Any


class Sheet(NamedTuple):
    """Where a slice of games writes.

    Attributes:
        counts: Rows written of `balls` and of `events`.
        balls: BALL_ROW records.
        events: EVENT_ROW records.
        place: Balls at decisions by cell [x, z].
        speed: Their speeds, in SPEED_UNIT.
        shots: The same balls, as far as they were struck and have met nothing since.
        stays: The longest stay that began in each cell [ticks].
        drains: Lost balls by the place where they left [bin from the left].
        first: What struck balls met first, by part.
        points: Points of each game by cause: parts, modes, the bonus, and others [game, cause].
    """

    counts: Any
    balls: Any
    events: Any
    place: Any
    speed: Any
    shots: Any
    stays: Any
    drains: Any
    first: Any
    points: Any


class Watched(NamedTuple):
    """A game with its notes."""

    match: Match
    note: Any
    sheet: Sheet
    slots: Any
    points: Any


@kernel
def watch_games(
    lanes: Lanes, geometries: BatchGeometry, rows: GameRows, options: WatchOptions, watch: Any, sheet: Sheet,
    span: tuple[int, int], blocks: int,
) -> bool:  # fmt: skip
    """Play the games of a span for a number of decisions each, or to their ends; False: the sheet is full."""
    first, end = span
    for index in range(first, end):
        note = watch[index]
        if note.is_closed != 0:
            continue
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
        watched = Watched(match, note, sheet, options.slots[number], sheet.points[index])
        if not watch_game(lane, geometry, watched, rows.seen, index, options, blocks):
            return False
    return True


@internal
def watch_game(
    lane: Lane, geometry: BoardGeometry, watched: Watched, seen: Any, index: int, options: WatchOptions,
    blocks: int,
) -> bool:  # fmt: skip
    """Play a game for a number of decisions, or to its end; False: the sheet is full."""
    world, board, match, note = lane.world, geometry.board, watched.match, watched.note
    decisions, held = options.decisions[index], options.held[index]
    begin_step(lane.log)
    is_able = can_step(world, geometry, lane.log, 1.0 / TICK_RATE)
    for _ in range(blocks):
        if match.play.game.over != 0 or world.tick >= options.limit or not is_able:
            break
        if is_full(watched.sheet, options.keeps_events):
            end_step(world, board, lane.log)
            return False
        bits = held_bits(options.player, world, board, geometry.colliders, decisions, held)
        is_able = play_block(lane, geometry, watched, seen, index, bits, options)
    end_step(world, board, lane.log)
    if world.fault != Fault.NONE:
        judge(match.play, match.book, match.field, as_int(Call.END), as_int(0))
    if match.play.game.over != 0 or world.tick >= options.limit:
        if note.in_turn != 0:
            close_turn(watched, as_int(0))
        note.is_closed = 1
    return True


@inlined
def is_full(sheet: Sheet, keeps_events: int) -> bool:
    """Whether the rows of another decision may not fit."""
    is_out_of_balls = sheet.counts[0] + MOST_BALLS > len(sheet.balls)
    return is_out_of_balls or (keeps_events != 0 and sheet.counts[1] + MOST_EVENTS > len(sheet.events))


@internal
def play_block(
    lane: Lane,
    geometry: BoardGeometry,
    watched: Watched,
    seen: Any,
    index: int,
    bits: int,
    options: WatchOptions,
) -> bool:
    """Play the ticks from one decision to the next, as `run_games` does; False: the world has a fault."""
    match, note = watched.match, watched.note
    game, world, report = match.play.game, lane.world, match.play.report
    done = 0
    while done < STEP and game.over == 0:
        if not are_balls_on_board(world, geometry.board):
            return False
        act(match, bits, as_int(0), 1.0 / TICK_RATE)
        if note.in_turn == 0 and game.balls > 0:
            open_turn(watched)
        was_late = is_late(match.play, match.book, match.field)
        limit = ticks_at_once(match, STEP - done, was_late)
        played, is_judged = play_ticks(lane, geometry, match, 1.0 / TICK_RATE, limit, seen, index)
        done += played
        if is_judged:
            note_events(lane, geometry, watched, options.keeps_events)
        if was_late or is_judged:
            bring_what_waits(match)
        if world.tick >= game.next_look and game.over == 0:
            look_for_stuck_balls(match.play, match.book, match.field, world.tick)
        if report.count > 0:
            note_report(watched, options.shown_modes)
        if note.in_turn != 0 and game.balls == 0:
            close_turn(watched, as_int(1))
    if game.over == 0:
        note_balls(world, game, note)
        note_places(watched)
    return True


@internal
def open_turn(watched: Watched) -> None:
    """Note what the game has when a turn begins."""
    note, game = watched.note, watched.match.play.game
    note.in_turn, note.balls, note.began = 1, note.balls + 1, watched.match.field.world.tick
    note.ticks_before, note.score_before = note.ticks, game.score
    note.hits_before, note.strikes_before, note.drain_z = note.hits, note.strikes, np.nan


@internal
def close_turn(watched: Watched, is_lost: int) -> None:
    """Write the row of a turn that has ended, or was cut short."""
    note, sheet, field = watched.note, watched.sheet, watched.match.field
    row = sheet.balls[sheet.counts[0]]
    sheet.counts[0] += 1
    row.game, row.ball, row.tick, row.is_lost = field.world.seed, note.balls, note.began, is_lost
    row.ticks, row.score = note.ticks - note.ticks_before, watched.match.play.game.score - note.score_before
    row.hits, row.strikes = note.hits - note.hits_before, note.strikes - note.strikes_before
    row.drain_z = note.drain_z if is_lost != 0 else np.nan
    note.in_turn = 0


@internal
def note_events(lane: Lane, geometry: BoardGeometry, watched: Watched, keeps_events: int) -> None:
    """Note the events of the ticks that were just played."""
    log, note, sheet = lane.log, watched.note, watched.sheet
    for number in range(log.carried, log.count):
        event = log.event[number]
        if keeps_events != 0:
            row = sheet.events[sheet.counts[1]]
            sheet.counts[1] += 1
            row.game, row.ball, row.tick = lane.world.seed, note.balls, event.tick
            row.kind, row.part, row.x, row.z = event.kind, event.part, event.x, event.z
            row.speed = event.speed
        if event.kind == EventKind.GUTTER:
            note.drained, note.drain_z = note.drained + 1, event.z
            note.drained_left += event.z < 0.0
            across = (event.z / geometry.board.half_width + 1.0) * (0.5 * DRAIN_BINS)
            sheet.drains[min(max(int(across), 0), DRAIN_BINS - 1)] += 1
        elif event.part >= 0:
            note_meeting(lane, geometry, watched, event)


@internal
def note_meeting(lane: Lane, geometry: BoardGeometry, watched: Watched, event: Any) -> None:
    """Note that a ball met a part: strikes of paddles, and what struck balls meet first."""
    note, slot = watched.note, slot_of(lane.world, event.ball)
    note.hits += event.kind == EventKind.HIT
    if slot < 0:
        return
    if is_paddle(geometry.board, event.part):
        if event.kind in CONTACTS:
            is_struck = lane.world.ball[slot].vx > MIN_STRIKE_SPEED
            note.strikes += is_struck and note.struck[slot] == 0
            note.struck[slot] = is_struck
    elif event.kind not in NO_MEETINGS:
        if note.struck[slot] != 0:
            watched.sheet.first[watched.slots[event.part]] += 1
        note.struck[slot] = 0


@internal
def slot_of(world: Any, ball: int) -> int:
    """The slot of the ball with an id; −1 if it is gone."""
    found = -1
    for slot in range(len(world.ball)):
        if ball != 0 and world.ball[slot].id == ball:
            found = slot
    return found


@internal
def note_report(watched: Watched, shown_modes: Any) -> None:
    """Add points to what made them: the bonus of a lost ball, the mode that runs, or else the part."""
    report, note, points = watched.match.play.report, watched.note, watched.points
    parts, modes = len(watched.sheet.first), len(shown_modes)
    for number in range(report.count):
        event = report.event[number]
        if event.kind == Said.BALL_LOST:
            note.lost_tick = event.tick
        elif event.kind == Said.MODE_STARTED and shown_modes[event.value] != 0:
            note.modes_begun += 1
            note.mode_order[event.value] = note.modes_begun
        elif event.kind == Said.MODE_ENDED:
            note.mode_order[event.value] = 0
        elif event.kind == Said.SCORED:
            mode = latest_mode(note, modes)
            if event.tick == note.lost_tick:
                points[parts + modes] += event.value
            elif mode >= 0:
                points[parts + mode] += event.value
            elif event.part >= 0:
                points[watched.slots[event.part]] += event.value
            else:
                points[parts + modes + 1] += event.value
    report.count = 0


@internal
def latest_mode(note: Any, modes: int) -> int:
    """The running mode that began last; −1 if none runs."""
    found, latest = -1, as_int(0)
    for mode in range(modes):
        if note.mode_order[mode] > latest:
            found, latest = mode, note.mode_order[mode]
    return found


@internal
def note_places(watched: Watched) -> None:
    """Note where the balls in play are, how fast, and how long a single one has stayed there."""
    note, sheet, field = watched.note, watched.sheet, watched.match.field
    world, board = field.world, field.board
    for slot in range(len(world.ball)):
        ball = world.ball[slot]
        if ball.id == 0 or ball.motion == Motion.CAPTURED:
            note.struck[slot] = 0
            continue
        row, column = cell_of(board.half_length, ball.x), cell_of(board.half_width, ball.z)
        speed = (ball.vx * ball.vx + ball.vz * ball.vz) ** 0.5
        sheet.place[row, column] += 1
        sheet.speed[row, column] += int(speed * SPEED_UNIT)
        sheet.shots[row, column] += note.struck[slot]
        note.samples += 1
        note.samples_left += ball.z < 0.0
        note.fast += speed > 0.5 * board.speed_cap
    if note.stay > 0:
        row, column = cell_of(board.half_length, note.at_x), cell_of(board.half_width, note.at_z)
        sheet.stays[row, column] = max(sheet.stays[row, column], note.stay)
        if note.stay == note.longest_stay:
            note.stay_x, note.stay_z = note.at_x, note.at_z


@inlined
def cell_of(half: float, place: float) -> int:
    """The row or column of a place on a map [u]."""
    return int(CELLS * (place + half))
