"""Episodes that are games by the rules of a table: what their step does otherwise, compiled.

Each function for games stands below what takes its place where an episode is some balls without rules
(`for_games.py`). A game serves its next ball at the end of the step in which it has lost the last one, so
that an observation shows it.
"""

from __future__ import annotations

from typing import Any

from silverball.envs import pointers as views
from silverball.envs.for_games import for_games
from silverball.envs.observations import CounterSlot, GameSlot, LampSlot, ModeSlot, PlaySlot
from silverball.envs.pointers import Pointers, copy_bytes
from silverball.envs.rewards import TERMS
from silverball.envs.state import HAPPENINGS, RulesRecord
from silverball.physics.balls import create_ball
from silverball.physics.event_log import begin_step
from silverball.physics.kernel import as_int, inlined, internal, ir_inlined, prefetch
from silverball.physics.records import (
    BatchGeometry,
    BoardGeometry,
    Fault,
    Lane,
    Lanes,
    LogRecord,
    Outcome,
    WorldRecord,
)
from silverball.physics.step import LINE, can_step, hot_lines, run_worlds
from silverball.referee.game_records import (
    FOREVER,
    NOT_RUNNING,
    Book,
    Field,
    GameRecord,
    Light,
    Play,
    ReportRecord,
    Said,
)
from silverball.referee.judge import Call, judge_between_steps
from silverball.referee.numbers import compiled_factor, running_hits
from silverball.referee.run_games import Match, play_game
from silverball.world.single_step import INT, array_at

LAMP_WIDTH, MODE_WIDTH = len(LampSlot), len(ModeSlot)
KINDS = len(HAPPENINGS)  # of happenings; the starts of each mode follow
GAME_LINES = 4  # of the cache, at the start of a game, that are read in most ticks
OWN_COUNTS = KINDS + 2  # the last columns of counts: the kinds, the present ball, and the balls in play
FIRST_TERM = len(TERMS)  # the first column of the kinds in terms


@ir_inlined
def book_of_board(ptr: Pointers, board: int) -> Book:
    """The rules of a board."""
    return Book(
        views.setups(ptr)[board],
        views.rule_rows(ptr),
        views.op_rows(ptr),
        views.trigger_rows(ptr),
        views.listed_rows(ptr),
        views.part_rows(ptr),
        views.lamp_rows(ptr),
        views.counter_rows(ptr),
        views.mode_rows(ptr),
        views.reach_rows(ptr),
        views.bank_rows(ptr),
    )


@ir_inlined
def match_at(ptr: Pointers, index: int, scratch: int) -> Match:
    """The game of an environment, with the report of another one as its scratch."""
    board = views.board_of(ptr)[index]
    return Match(
        Play(views.games(ptr)[index], views.reports(ptr)[scratch]),
        book_of_board(ptr, board),
        Field(
            views.worlds(ptr)[index],
            views.boards(ptr)[board],
            views.colliders(ptr),
            views.grid(ptr),
            views.places(ptr),
            views.logs(ptr)[index],
        ),
        as_int(1),
    )


# --- the ticks of a step


def move_worlds(ptr: Pointers, rules: RulesRecord, first: int, end: int) -> None:
    """Play the ticks of a step in the environments first … end − 1."""
    lanes = Lanes(views.worlds(ptr), views.board_of(ptr), views.logs(ptr), views.tallies(ptr))
    geometries = BatchGeometry(views.boards(ptr), views.colliders(ptr), views.grid(ptr))
    run_worlds(lanes, geometries, views.held(ptr), first, end, rules.ticks, rules.tick)


@for_games(move_worlds)
@internal
def play_worlds_or_games(ptr: Pointers, rules: RulesRecord, first: int, end: int) -> None:
    """Play the ticks of a step in the environments first … end − 1."""
    for index in range(first, end):
        if index + 1 < end:
            prefetch_game(
                views.worlds(ptr)[index + 1], views.logs(ptr)[index + 1], views.games(ptr)[index + 1]
            )
        if views.episodes(ptr)[index].over == 0:
            play_one(ptr, rules, index, first)


@inlined
def prefetch_game(world: WorldRecord, log: LogRecord, game: GameRecord) -> None:
    """Ask for the lines of the cache that the next game will need."""
    for line in range(hot_lines(world)):
        prefetch(world, line * LINE)
    prefetch(log, 0)
    for line in range(GAME_LINES):
        prefetch(game, line * LINE)


@internal
def play_one(ptr: Pointers, rules: RulesRecord, index: int, scratch: int) -> None:
    """Play the ticks of a step in one game, and note what happens."""
    match = match_at(ptr, index, scratch)
    field, report, tallies = match.field, match.play.report, views.tallies(ptr)
    lane = Lane(field.world, field.log, tallies[index], views.logs(ptr)[scratch])
    geometry = BoardGeometry(field.board, field.colliders, field.grid)
    report.count = 0
    begin_step(field.log)
    if match.play.game.over == 0 and can_step(field.world, geometry, field.log, rules.tick):
        play_game(lane, match, views.held(ptr), views.seen(ptr), index, rules.ticks, rules.tick)
    serve_ball(match)
    note_happenings(ptr, report, index)


@inlined
def serve_ball(match: Match) -> None:
    """Start the next ball of a game, if none is in play."""
    field, game = match.field, match.play.game
    if game.over != 0 or game.balls != 0 or field.world.fault != Fault.NONE:
        return
    if create_ball(field.world, field.board, field.colliders, field.places, field.log) == Outcome.CREATED:
        judge_between_steps(match.play, match.book, field, as_int(Call.START), field.world.created)


@inlined
def note_happenings(ptr: Pointers, report: ReportRecord, index: int) -> None:
    """Count the reported events of a game, and which modes have started."""
    happened = views.happened(ptr)
    for number in range(report.count):
        event = report.event[number]
        happened[index, event.kind] += 1
        if event.kind == Said.MODE_STARTED:
            happened[index, KINDS + event.value] += 1
    report.count = 0


# --- what an episode is


def create_first_ball(ptr: Pointers, rules: RulesRecord, index: int) -> None:
    """Create the first ball of an episode, unless a button does."""
    if rules.creates_by_button == 0:
        board, world, log = views.board_of(ptr)[index], views.worlds(ptr)[index], views.logs(ptr)[index]
        create_ball(world, views.boards(ptr)[board], views.colliders(ptr), views.places(ptr), log)


@for_games(create_first_ball)
@internal
def begin_play(ptr: Pointers, rules: RulesRecord, index: int) -> None:
    """Begin a new game, with its first ball."""
    views.games(ptr)[index] = views.blank_games(ptr)[views.board_of(ptr)[index]]
    happened, tallies = views.happened(ptr), views.tallies(ptr)
    for number in range(happened.shape[1]):
        happened[index, number] = 0
    for part in range(tallies.shape[1]):
        tallies[index, part] = 0
    views.seen(ptr)[index] = 0
    match = match_at(ptr, index, index)
    match.play.report.count = 0
    serve_ball(match)
    note_happenings(ptr, match.play.report, index)


def score_of_world(ptr: Pointers, index: int) -> int:
    """The points of an episode so far."""
    return views.worlds(ptr)[index].score  # type: ignore[no-any-return]


@for_games(score_of_world)
@inlined
def score_of(ptr: Pointers, index: int) -> int:
    """The points of a game so far."""
    return views.games(ptr)[index].score  # type: ignore[no-any-return]


def has_ball_on_board(ptr: Pointers, index: int) -> bool:
    """Whether a ball is on the board."""
    return views.worlds(ptr)[index].created > views.worlds(ptr)[index].drained  # type: ignore[no-any-return]


@for_games(has_ball_on_board)
@inlined
def has_ball(ptr: Pointers, index: int) -> bool:
    """Whether a ball is in play."""
    return views.games(ptr)[index].balls > 0  # type: ignore[no-any-return]


def are_balls_used_up(ptr: Pointers, rules: RulesRecord, index: int) -> bool:
    """Whether all balls of an episode have drained."""
    return views.worlds(ptr)[index].drained >= rules.balls  # type: ignore[no-any-return]


@for_games(are_balls_used_up)
@inlined
def is_finished(ptr: Pointers, rules: RulesRecord, index: int) -> bool:
    """Whether a game is over by its rules."""
    return views.games(ptr)[index].over != 0  # type: ignore[no-any-return]


def bring_next_ball(ptr: Pointers, rules: RulesRecord, index: int) -> bool:
    """Create the next ball if there is none; return whether the time for a scoring hit begins anew."""
    world = views.worlds(ptr)[index]
    if world.created > world.drained or rules.creates_by_button != 0:
        return False
    board = views.boards(ptr)[views.board_of(ptr)[index]]
    create_ball(world, board, views.colliders(ptr), views.places(ptr), views.logs(ptr)[index])
    return True


@for_games(bring_next_ball)
@inlined
def has_new_time(ptr: Pointers, rules: RulesRecord, index: int) -> bool:
    """Whether the time for a scoring hit begins anew: a ball has come or was launched in this step."""
    since = views.worlds(ptr)[index].tick - views.games(ptr)[index].quiet_since
    return since <= rules.ticks  # type: ignore[no-any-return]


# --- rewards and infos


@for_games(lambda ptr, index, before: None)
@internal
def note_before(ptr: Pointers, index: int, before: int) -> None:
    """Copy what has happened and the counters into a row, before a step."""
    noted, happened, games = views.happened_before(ptr), views.happened(ptr), views.games(ptr)
    kinds = happened.shape[1]
    for number in range(kinds):
        noted[before, number] = happened[index, number]
    for number in range(kinds, noted.shape[1]):
        noted[before, number] = games[index].counter[number - kinds]


@for_games(lambda ptr, index, before: 0.0)
@internal
def weigh_growth(ptr: Pointers, index: int, before: int) -> float:
    """Write the terms of what has happened and of counters that have grown; returns their weighted sum."""
    noted, happened, games = views.happened_before(ptr), views.happened(ptr), views.games(ptr)
    terms, weights = views.terms(ptr), views.game_weights(ptr)
    kinds, reward = happened.shape[1], 0.0
    for number in range(noted.shape[1]):
        now = happened[index, number] if number < kinds else games[index].counter[number - kinds]
        grown = max(now - noted[before, number], 0)
        terms[index, FIRST_TERM + number] = grown
        reward += weights[number] * grown
    return reward


@for_games(lambda ptr, index, start: None)
@internal
def write_game_counts(ptr: Pointers, index: int, start: int) -> None:
    """Write the further counts of a game, and its score, into a row of counts at an address."""
    row, first = array_at(start, (ptr.info,), INT), ptr.info - OWN_COUNTS
    game = views.games(ptr)[index]
    row[0] = game.score
    copy_bytes(start + first * 8, ptr.happened_at + index * ptr.happenings * 8, KINDS * 8)
    row[first + KINDS], row[first + KINDS + 1] = game.used, game.balls


def are_counts_other(ptr: Pointers, index: int, last: Any, score: int) -> bool:
    """Whether `write_counts` would change the score."""
    return last[0] != score  # type: ignore[no-any-return]


@for_games(are_counts_other)
@internal
def have_game_counts_changed(ptr: Pointers, index: int, last: Any, score: int) -> bool:
    """Whether `write_counts` would change the score or the further counts of a game."""
    game, happened, first = views.games(ptr)[index], views.happened(ptr), ptr.info - OWN_COUNTS
    differs = last[0] != game.score
    for number in range(KINDS):
        differs |= last[first + number] != happened[index, number]
    differs |= last[first + KINDS] != game.used
    return bool(differs or last[first + KINDS + 1] != game.balls)


# --- observations


@for_games(lambda ptr, rules, row, index: None)
@internal
def write_game(ptr: Pointers, rules: RulesRecord, row: Any, index: int) -> None:
    """Write the slots of a game, its lamps, counters and modes into a row of an observation."""
    game, world = views.games(ptr)[index], views.worlds(ptr)[index]
    board = views.boards(ptr)[views.board_of(ptr)[index]]
    setup = views.setups(ptr)[views.board_of(ptr)[index]]
    row[rules.game_at + GameSlot.LEFT] = max(setup.balls - game.used, 0) * rules.ball_scale
    start = rules.play_at
    row[start + PlaySlot.SCORE] = game.score / (game.score + rules.par)
    row[start + PlaySlot.BALL] = min(game.used * rules.ball_scale, 1.0)
    row[start + PlaySlot.IN_PLAY] = min(game.balls / board.max_balls, 1.0)
    row[start + PlaySlot.SAVED] = saved_share(game, world.tick, setup.save_ticks)
    row[start + PlaySlot.WARNINGS] = min(game.warnings / max(setup.warnings, 1), 1.0)
    row[start + PlaySlot.TILTED] = 1.0 if game.tilted != 0 else 0.0
    row[start + PlaySlot.EXTRA_BALLS] = game.extra_balls / (game.extra_balls + 1.0)
    row[start + PlaySlot.LOCKED] = game.locked / (game.locked + 1.0)
    hits = running_hits(game, setup, world.tick)
    factor = compiled_factor(hits, setup.combo_step, setup.combo_limit)
    row[start + PlaySlot.COMBO] = (factor - 1.0) / max(setup.combo_limit - 1.0, 1.0)
    for lamp in range(setup.lamps):
        at, state = rules.lamps_at + LAMP_WIDTH * lamp, game.lamp[lamp]
        row[at + LampSlot.LIT] = 0.0 if state == Light.OFF else 1.0
        row[at + LampSlot.BLINKING] = 1.0 if state == Light.BLINKING else 0.0
    for number in range(setup.counters):
        scale = views.counter_scales(ptr)[setup.counter_first + number]
        row[rules.counters_at + number + CounterSlot.VALUE] = counter_share(game.counter[number], scale)
    for mode in range(setup.modes):
        at, end = rules.modes_at + MODE_WIDTH * mode, game.mode_end[mode]
        ticks = views.mode_rows(ptr)[setup.mode_first + mode].ticks
        row[at + ModeSlot.RUNNING] = 0.0 if end == NOT_RUNNING else 1.0
        row[at + ModeSlot.LEFT] = time_share(end, world.tick, ticks)


@inlined
def saved_share(game: GameRecord, tick: int, save_ticks: int) -> float:
    """The time in which a lost ball comes back as a share of `save_ticks`, of the ball that has the most."""
    left = 0
    for number in range(game.balls):
        if game.ball[number].saves != 0:
            left = max(left, game.ball[number].safe_until - tick)
    return min(left / max(save_ticks, 1), 1.0)


@inlined
def counter_share(value: int, scale: float) -> float:
    """The value of a counter as a share; `scale` as in `game_arrays.counter_scales`."""
    return min(value / scale, 1.0) if scale > 0.0 else value / (value - scale)


@inlined
def time_share(end: int, tick: int, ticks: int) -> float:
    """The time left of a mode that ends in a tick, as a share of its time [ticks]."""
    if end == NOT_RUNNING:
        return 0.0
    if end == FOREVER:
        return 1.0
    return min(max(end - tick, 0) / max(ticks, 1), 1.0)
