"""The step of the environments: actions, physics, rewards, ends and resets in one compiled call.

    the action's bits become buttons (`supply.py`) → a ball is created if requested
    → the worlds move, or games are played by rules (`game_kernels.py`)
    → for each environment: reward, next ball, end of the episode, reset if due
    → observations and counts are written

An episode ends when no hit has scored for too long (*stalled*); without this rule an agent could cradle a
ball on raised paddles forever. The remaining time is part of the observation.
"""

from __future__ import annotations

from typing import Any

from silverball.envs import pointers as views
from silverball.envs.game_kernels import (
    begin_play,
    has_ball,
    has_new_time,
    have_game_counts_changed,
    is_finished,
    note_before,
    play_worlds_or_games,
    score_of,
    weigh_growth,
    write_game,
    write_game_counts,
)
from silverball.envs.observations import BallSlot, GameSlot, PaddleSlot, PlaceSlot
from silverball.envs.pixels import PICTURE_STATE_SIZE, copy_stack, draw_first, draw_step, redraw_stack
from silverball.envs.pointers import SMALL_FLOAT, Pointers, copy_bytes
from silverball.envs.rewards import FIRST_COUNT, POINTS, SECONDS, STALLED, TERMS
from silverball.envs.sight import is_in_sight
from silverball.envs.state import (
    CONTROL,
    COUNTS,
    EPISODE,
    INFO,
    ResetMode,
    RulesRecord,
    StepFlag,
    Task,
)
from silverball.envs.supply import clear_controls, executed_buttons, write_supply
from silverball.physics.balls import create_ball
from silverball.physics.for_devices import for_devices
from silverball.physics.kernel import inlined, internal, ir_inlined, kernel
from silverball.physics.portable_math import WORD, threefry
from silverball.physics.records import (
    HEADER,
    LEFT,
    MAX_LEVELS,
    RIGHT,
    Fault,
    Motion,
    Outcome,
    WorldRecord,
)
from silverball.physics.spinner import blade_speed
from silverball.physics.step import JITTER_COLUMN, LAUNCH_COLUMN, NUDGE_COLUMN
from silverball.players.simple import holds_launch
from silverball.world.single_step import INT, array_at

BLOCK = 64  # worlds stepped before their rewards are computed, so that their records stay in the cache
EPISODE_SIZE = EPISODE.itemsize
# A world record has its counters in the order of `COUNTS`; `write_counts` appends two fields of an episode.
COUNTS_AT, COUNTS_SIZE = 8 * [name for name, _ in HEADER].index("score"), 8 * len(COUNTS)
EPISODE_COUNTS_SIZE = 8 * (len(INFO) - len(COUNTS))  # the first fields of an EPISODE record
CONTROL_SIZE = CONTROL.itemsize
BALL_WIDTH, PADDLE_WIDTH, PLACE_WIDTH = len(BallSlot), len(PaddleSlot), len(PlaceSlot)


@kernel
def run_task(addresses: Any, first: int, end: int, task: int) -> tuple[float, int]:
    """Do a task for the environments first … end − 1: the entry point from Python.

    Args:
        addresses: One ADDRESSES record.
        first: The first environment of the slice.
        end: One past its last one.
        task: A `Task`; or an action ≥ 0, with which environment 0 makes a step.

    Returns:
        The reward of the last environment that made a step, and `StepFlag` bits of its episode.
    """
    ptr = addresses[0]
    if task == Task.RESET:
        reset_envs(ptr, first, end)
    elif task == Task.OBSERVE:
        observe_envs(ptr, first, end)
    else:
        if task >= 0:
            if views.episodes(ptr)[0].over != 0:
                return 0.0, StepFlag.WAS_OVER + 0  # + 0 makes a plain integer of the member
            views.actions(ptr)[0] = task
        return step_envs(ptr, first, end)
    return 0.0, 0


@ir_inlined
def step_envs(ptr: Pointers, first: int, end: int) -> tuple[float, int]:
    """Make one step in the environments first … end − 1.

    Returns:
        The reward of the last of them, and `StepFlag` bits of its episode.
    """
    rules = views.rules(ptr)[0]
    reward, flags = 0.0, 0
    for start in range(first, end, BLOCK):
        stop = min(start + BLOCK, end)
        for index in range(start, stop):
            if rules.weighs_counts != 0:
                row = ptr.counts_before_at + (first + index - start) * COUNTS_SIZE
                copy_bytes(row, counts_at(ptr, index), COUNTS_SIZE)
                note_before(ptr, index, first + index - start)
            apply_action(ptr, rules, index)
        play_worlds_or_games(ptr, rules, start, stop)
        for index in range(start, stop):
            reward, flags = finish_step(ptr, rules, index, first + index - start)
            views.rewards(ptr)[index] = reward
            views.terminated(ptr)[index] = flags & StepFlag.TERMINATED != 0
            views.truncated(ptr)[index] = flags & StepFlag.TRUNCATED != 0
            if ptr.envs == 1 and have_counts_changed(ptr, index):
                flags |= StepFlag.COUNTS_CHANGED + 0
            observe(ptr, rules, index)
    return reward, flags


@ir_inlined
def reset_envs(ptr: Pointers, first: int, end: int) -> None:
    """Begin the next episode in those of the environments first … end − 1 that are in the mask."""
    rules = views.rules(ptr)[0]
    for index in range(first, end):
        if views.reset_mask(ptr)[index]:
            begin_episode(ptr, rules, index)
        elif rules.must_redraw != 0:
            redraw_stack(ptr, index)
        observe(ptr, rules, index)


@ir_inlined
def observe_envs(ptr: Pointers, first: int, end: int) -> None:
    """Write the observations of the environments first … end − 1 again, after their states were changed."""
    rules = views.rules(ptr)[0]
    for index in range(first, end):
        if rules.draws_pictures != 0:
            redraw_stack(ptr, index)
        observe(ptr, rules, index)


@inlined
def apply_action(ptr: Pointers, rules: RulesRecord, index: int) -> None:
    """Turn the bits of an action into held buttons, and create a ball if its bit is set."""
    bits = views.actions(ptr)[index]
    if ptr.controlled != 0 and views.episodes(ptr)[index].over == 0:
        bits = executed_buttons(ptr, rules, index, bits)
    held, world, log = views.held(ptr), views.worlds(ptr)[index], views.logs(ptr)[index]
    held[0, index, 0] = bits & LEFT != 0
    held[0, index, 1] = bits & RIGHT != 0
    held[0, index, JITTER_COLUMN] = bits & rules.jitter_bit != 0
    if rules.launch_bit != 0:
        held[0, index, LAUNCH_COLUMN] = bits & rules.launch_bit != 0
    elif rules.launches_itself != 0:
        held[0, index, LAUNCH_COLUMN] = holds_launch(world, rules.tick)
    if rules.nudge_up_bit != 0:
        held[0, index, NUDGE_COLUMN] = bits & rules.nudge_left_bit != 0
        held[0, index, NUDGE_COLUMN + 1] = bits & rules.nudge_right_bit != 0
        held[0, index, NUDGE_COLUMN + 2] = bits & rules.nudge_up_bit != 0
    if bits & rules.create_bit != 0 and world.created < rules.balls and views.episodes(ptr)[index].over == 0:
        board = views.boards(ptr)[views.board_of(ptr)[index]]
        if create_ball(world, board, views.colliders(ptr), views.places(ptr), log) == Outcome.CREATED:
            views.episodes(ptr)[index].idle_steps = 0


@internal
def finish_step(ptr: Pointers, rules: RulesRecord, index: int, before: int) -> tuple[float, int]:
    """Compute the reward of a step and whether it ended the episode; create the next ball; reset if due.

    Args:
        ptr: One ADDRESSES record.
        rules: One RULES record.
        index: The environment.
        before: The row of `counts_before` with its counters.

    Returns:
        The reward, and `StepFlag` bits.
    """
    world, episode = views.worlds(ptr)[index], views.episodes(ptr)[index]
    if episode.over != 0:
        if rules.writes_terms != 0:
            for term in range(len(TERMS)):
                views.terms(ptr)[index, term] = 0.0
        if rules.mode == ResetMode.NEXT_STEP:
            begin_episode(ptr, rules, index)
            return 0.0, 0
        return 0.0, StepFlag.WAS_OVER + 0
    score, is_in_play = score_of(ptr, index), has_ball(ptr, index)
    gained = score - episode.last_score
    episode.last_score = score
    episode.steps += 1
    episode.idle_steps = 0 if gained > 0 else episode.idle_steps + 1
    flags = 0
    if is_finished(ptr, rules, index):
        flags = StepFlag.TERMINATED + 0
    elif has_new_time(ptr, rules, index):
        episode.idle_steps = 0
    if flags == 0 and episode.idle_steps >= rules.stall_steps:
        episode.stalled = 1
        flags = StepFlag.TERMINATED + 0
    if flags == 0 and (episode.steps >= rules.max_steps or world.fault != Fault.NONE):
        flags = StepFlag.TRUNCATED + 0
    seconds = rules.ticks * rules.tick if is_in_play else 0.0
    reward = rules.weights[POINTS] * gained + rules.weights[SECONDS] * seconds
    if rules.weighs_counts != 0:
        reward += weigh_counts(ptr, rules, index, before)
        if rules.writes_terms != 0:
            views.terms(ptr)[index, POINTS], views.terms(ptr)[index, SECONDS] = gained, seconds
    if rules.draws_pictures != 0:
        draw_step(ptr, index)
    if flags != 0:
        episode.over = 1
        if rules.mode == ResetMode.SAME_STEP:
            store_final(ptr, rules, index)
            begin_episode(ptr, rules, index)
    return reward, flags


@ir_inlined
def weigh_counts(ptr: Pointers, rules: RulesRecord, index: int, before: int) -> float:
    """Write the terms for stalling and for the increases of the counters; returns their weighted sum."""
    stalled = views.episodes(ptr)[index].stalled
    views.terms(ptr)[index, STALLED] = stalled
    reward = rules.weights[STALLED] * stalled
    counts = array_at(counts_at(ptr, index), (len(COUNTS),), INT)
    for term in range(FIRST_COUNT, len(TERMS)):
        count = term - FIRST_COUNT + 1  # counts[0] is the score, which has a term of its own
        grown = counts[count] - views.counts_before(ptr)[before, count]
        views.terms(ptr)[index, term] = grown
        reward += rules.weights[term] * grown
    return float(reward + weigh_growth(ptr, index, before))


@internal
def begin_episode(ptr: Pointers, rules: RulesRecord, index: int) -> None:
    """Begin the next episode: choose its board and seed, reset the world, create the first ball."""
    episode = views.episodes(ptr)[index]
    episode.number += 1
    key0, key1 = episode.seed & WORD, (episode.seed >> 32) & WORD
    high, low = threefry(key0, key1, episode.number & WORD, 0)
    choice, _ = threefry(key0, key1, episode.number & WORD, 1)
    board = (choice * rules.boards) >> 32 if rules.own_boards == 0 else index % rules.boards
    if views.requested_boards(ptr)[index] >= 0:
        board = views.requested_boards(ptr)[index]
    views.board_of(ptr)[index] = board
    views.worlds(ptr)[index] = views.blanks(ptr)[board]
    world, log = views.worlds(ptr)[index], views.logs(ptr)[index]
    world.seed = ((high & 0x7FFFFFFF) << 32) | low
    log.count, log.carried, log.done, log.lost = 0, 0, 0, 0
    if ptr.controlled != 0:
        clear_controls(views.controls(ptr)[index])
    episode.board_seed = views.board_seeds(ptr)[board]
    episode.stalled, episode.over, episode.steps, episode.idle_steps, episode.last_score = 0, 0, 0, 0, 0
    begin_play(ptr, rules, index)
    if rules.draws_pictures != 0:
        draw_first(ptr, index)


@internal
def store_final(ptr: Pointers, rules: RulesRecord, index: int) -> None:
    """Store the last observation and the counts of an episode before the next one begins."""
    write_counts(ptr, ptr.final_counts_at, index)
    if rules.writes_state != 0:
        write_state(ptr, rules, ptr.finals_at, index)
    if rules.draws_pictures != 0:
        size = ptr.stack * PICTURE_STATE_SIZE
        copy_bytes(ptr.final_picture_states_at + index * size, ptr.picture_states_at + index * size, size)


@inlined
def observe(ptr: Pointers, rules: RulesRecord, index: int) -> None:
    """Write the counts and the observation of an environment."""
    write_counts(ptr, ptr.counts_at, index)
    if rules.writes_state != 0:
        write_state(ptr, rules, ptr.observations_at, index)
    if rules.copies_stack != 0:
        copy_stack(ptr, index)


@inlined
def counts_at(ptr: Pointers, index: int) -> int:
    """The address of the counters of a world."""
    return int(ptr.worlds_at + index * views.worlds(ptr).itemsize + COUNTS_AT)


@inlined
def write_counts(ptr: Pointers, address: int, index: int) -> None:
    """Write the counts of the episode so far at an address, in the order of `ALL_INFO`."""
    start = address + index * ptr.info * 8
    copy_bytes(start, counts_at(ptr, index), COUNTS_SIZE)
    copy_bytes(start + COUNTS_SIZE, ptr.episodes_at + index * EPISODE_SIZE, EPISODE_COUNTS_SIZE)
    if ptr.controlled != 0:  # `action` is the first field of a CONTROL record
        copy_bytes(start + COUNTS_SIZE + EPISODE_COUNTS_SIZE, ptr.controls_at + index * CONTROL_SIZE, 8)
    write_game_counts(ptr, index, start)


@internal
def have_counts_changed(ptr: Pointers, index: int) -> bool:
    """Whether `write_counts` would change the last counts."""
    last = array_at(ptr.counts_at + index * ptr.info * 8, (ptr.info,), INT)
    counts = array_at(counts_at(ptr, index), (len(COUNTS),), INT)
    episode = views.episodes(ptr)[index]
    differs = last[len(COUNTS)] != episode.board_seed or last[len(COUNTS) + 1] != episode.stalled
    for number in range(1, len(COUNTS)):
        differs |= last[number] != counts[number]
    if ptr.controlled != 0:
        differs |= last[len(INFO)] != views.controls(ptr)[index].action
    return bool(differs or have_game_counts_changed(ptr, index, last, counts[0]))


@internal
def write_state(ptr: Pointers, rules: RulesRecord, address: int, index: int) -> None:
    """Write the state observation of an environment into an array [env, column] at an address."""
    row = array_at(address + index * ptr.columns * 4, (ptr.columns,), SMALL_FLOAT)
    world, episode = views.worlds(ptr)[index], views.episodes(ptr)[index]
    for slot in range(rules.balls_shown):
        ball, start = world.ball[slot], BALL_WIDTH * slot
        is_alive = 1.0 if is_in_sight(ptr, rules, index, ball) else 0.0
        row[start + BallSlot.ALIVE] = is_alive
        row[start + BallSlot.X] = is_alive * ball.x * rules.x_scale
        row[start + BallSlot.Z] = is_alive * ball.z * rules.z_scale
        row[start + BallSlot.VX] = is_alive * ball.vx * rules.speed_scale
        row[start + BallSlot.VZ] = is_alive * ball.vz * rules.speed_scale
    for slot in range(rules.paddles_shown):
        number, start = rules.paddle_of[slot], rules.paddles_at + PADDLE_WIDTH * slot
        if number < 0:
            row[start + PaddleSlot.ANGLE], row[start + PaddleSlot.TURN] = 0.0, 0.0
            row[start + PaddleSlot.HELD] = 0.0
            continue
        paddle = world.paddle[number]
        row[start + PaddleSlot.ANGLE] = (paddle.angle - rules.rest_angle[number]) * rules.angle_scale[number]
        row[start + PaddleSlot.TURN] = paddle.angular_velocity * rules.turn_scale[number]
        held = paddle.angle_commanded == rules.raised_angle[number] and rules.angle_scale[number] != 0.0
        row[start + PaddleSlot.HELD] = 1.0 if held else 0.0
    if rules.hides_velocities != 0:
        hide_velocities(rules, row)
    row[rules.game_at + GameSlot.PATIENCE] = max(0.0, 1.0 - episode.idle_steps * rules.idle_scale)
    row[rules.game_at + GameSlot.LEFT] = (rules.balls - world.created) * rules.ball_scale
    if rules.shows_devices != 0:
        write_devices(ptr, rules, world, row, index)
    if rules.recharge_ticks != 0:
        write_supply(views.controls(ptr)[index], rules, world, row)
    write_game(ptr, rules, row, index)
    size = ptr.layout_columns * 4
    target = address + (index * ptr.columns + rules.layout_at) * 4
    copy_bytes(target, ptr.layouts_at + views.board_of(ptr)[index] * size, size)


@internal
def hide_velocities(rules: RulesRecord, row: Any) -> None:
    """Set the velocities of balls and paddles in a row of an observation to 0."""
    for slot in range(rules.balls_shown):
        row[BALL_WIDTH * slot + BallSlot.VX], row[BALL_WIDTH * slot + BallSlot.VZ] = 0.0, 0.0
    for slot in range(rules.paddles_shown):
        row[rules.paddles_at + PADDLE_WIDTH * slot + PaddleSlot.TURN] = 0.0


@for_devices(lambda ptr, rules, world, row, index: None)
@internal
def write_devices(ptr: Pointers, rules: RulesRecord, world: WorldRecord, row: Any, index: int) -> None:
    """Write the slots of levels, holes, switches, spinners and plungers into a row of an observation."""
    board = views.boards(ptr)[views.board_of(ptr)[index]]
    for slot in range(rules.places_shown):
        ball, start = world.ball[slot], rules.places_at + PLACE_WIDTH * slot
        is_alive = 1.0 if is_in_sight(ptr, rules, index, ball) else 0.0
        row[start + PlaceSlot.LEVEL] = is_alive * ball.level / (MAX_LEVELS - 1)
        row[start + PlaceSlot.HELD] = is_alive if ball.motion == Motion.CAPTURED else 0.0
    for number in range(min(rules.switches_shown, board.switches)):
        row[rules.switches_at + number] = 0.0 if world.off >> number & 1 != 0 else 1.0
    for number in range(min(rules.spinners_shown, board.spinners)):
        c = views.colliders(ptr)[board.collider_first + board.spinner_row[number]]
        spinner = world.spinner[number]
        elapsed = (world.tick - spinner.tick) * rules.tick - spinner.offset
        speed = blade_speed(spinner.speed, c.damping, max(elapsed, 0.0)) * c.blade * rules.speed_scale
        row[rules.spinners_at + number] = min(max(speed, -1.0), 1.0)
    if rules.plungers_shown != 0:
        row[rules.plunger_at] = min(world.launch_held * rules.charge_scale, 1.0)
