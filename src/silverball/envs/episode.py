"""What happens in one step of an environment? Everything, in one compiled call.

    the action's bits become buttons → a wanted ball is created → the worlds move (run_worlds)
    → for each environment: reward, the next ball, the end of the episode, a new episode if it is time
    → observations and counts are written

A ball is *stalled* when no hit gave points for too long: whoever holds both paddles up for ever, a ball lying
on them, ends the episode. How long is left is part of the observation.
"""

from __future__ import annotations

from typing import Any

from silverball.envs import pointers as the
from silverball.envs.pixels import SCENE_SIZE, film_step, show_again, show_first, wind
from silverball.envs.pointers import SMALL_FLOAT, copy_bytes
from silverball.envs.rewards import FIRST_COUNT, POINTS, SECONDS, STALLED, TERMS
from silverball.envs.slots import (
    BALLS,
    GAME,
    LAYOUT,
    PADDLES,
    BallSlot,
    GameSlot,
    PaddleSlot,
)
from silverball.envs.state import COUNTS, EPISODE, End, Mode, Task
from silverball.physics.balls import create_ball
from silverball.physics.kernel import inlined, internal, kernel, pasted
from silverball.physics.random import WORD, threefry
from silverball.physics.records import BALL_COUNT, WORLD, Fault, Outcome
from silverball.physics.step import run_worlds
from silverball.world.single_step import INT, array_at

BLOCK = 64  # worlds that are moved before they are looked at: their records stay in the cache
WORLD_SIZE, EPISODE_SIZE = WORLD.itemsize, EPISODE.itemsize
# The counters stand in a world's record in the order of `COUNTS`, the first two fields of an episode follow.
COUNTS_AT, COUNTS_SIZE = int(WORLD.fields["score"][1]), 8 * len(COUNTS)  # type: ignore[index]
BALL_WIDTH, PADDLE_WIDTH = len(BallSlot), len(PaddleSlot)


@kernel
def move(addresses: Any, first: int, end: int, task: int) -> tuple[float, int]:
    """Do something with the environments first … end − 1.

    Args:
        addresses: One ADDRESSES record.
        first: The first environment of the slice.
        end: One past its last one.
        task: A `Task`; or an action ≥ 0 for environment 0, which is then moved on alone.

    Returns:
        The reward of the last environment that was moved on, and what happened to its episode (`End`).
    """
    at = addresses[0]
    if task == Task.RESET:
        reset_envs(at, first, end)
    elif task == Task.OBSERVE:
        observe_envs(at, first, end)
    else:
        if task >= 0:
            if the.episodes(at)[0].over != 0:
                return 0.0, End.WAS_OVER + 0
            the.actions(at)[0] = task
        return step_envs(at, first, end)
    return 0.0, 0


@pasted
def step_envs(at: Any, first: int, end: int) -> tuple[float, int]:
    """Move the environments first … end − 1 on by one step.

    Returns:
        The reward of the last of them, and what happened to its episode (`End`).
    """
    rules = the.rules(at)[0]
    reward, ends = 0.0, 0
    for start in range(first, end, BLOCK):
        stop = min(start + BLOCK, end)
        for index in range(start, stop):
            if rules.weighs_counts != 0:
                row = at.counts_before_at + (first + index - start) * COUNTS_SIZE
                copy_bytes(row, at.worlds_at + index * WORLD_SIZE + COUNTS_AT, COUNTS_SIZE)
            press(at, rules, index)
        run_worlds(
            the.worlds(at), the.boards(at), the.board_of(at), the.colliders(at), the.grid(at), the.logs(at),
            the.tallies(at), the.held(at), start, stop, rules.ticks, rules.tick,
        )  # fmt: skip
        for index in range(start, stop):
            reward, ends = settle(at, rules, index, first + index - start)
            the.rewards(at)[index] = reward
            the.terminated(at)[index] = ends & End.TERMINATED != 0
            the.truncated(at)[index] = ends & End.TRUNCATED != 0
            if at.envs == 1 and has_counted(at, index):
                ends |= End.COUNTED + 0
            observe(at, rules, index)
    return reward, ends


@pasted
def reset_envs(at: Any, first: int, end: int) -> None:
    """Begin the next episode of those of the environments first … end − 1 that the mask names."""
    rules = the.rules(at)[0]
    for index in range(first, end):
        if the.masks(at)[index]:
            begin(at, rules, index)
        elif rules.redraw != 0:
            show_again(at, index)
        observe(at, rules, index)


@pasted
def observe_envs(at: Any, first: int, end: int) -> None:
    """Write the observations of the environments first … end − 1 anew, after their state was changed."""
    rules = the.rules(at)[0]
    for index in range(first, end):
        if rules.pictures != 0:
            show_again(at, index)
        observe(at, rules, index)


@inlined
def press(at: Any, rules: Any, index: int) -> None:
    """Turn an action into buttons, and create a ball if it asks for one."""
    bits = the.actions(at)[index]
    the.held(at)[0, index, 0] = bits & 1 != 0
    the.held(at)[0, index, 1] = bits & 2 != 0
    the.held(at)[0, index, 2] = bits & rules.jitter_bit != 0
    world = the.worlds(at)[index]
    if bits & rules.create_bit != 0 and world.created < rules.balls and the.episodes(at)[index].over == 0:
        board = the.boards(at)[the.board_of(at)[index]]
        if (
            create_ball(world, board, the.colliders(at), the.places(at), the.logs(at)[index])
            == Outcome.CREATED
        ):
            the.episodes(at)[index].quiet = 0


@internal
def settle(at: Any, rules: Any, index: int, before: int) -> tuple[float, int]:
    """What the last step was worth, and whether it ended the episode; a new one begins where it is time.

    Args:
        at: One ADDRESSES record.
        rules: One RULES record.
        index: The environment.
        before: The row of its counters from before the step.

    Returns:
        The reward, and `End` bits.
    """
    world, episode = the.worlds(at)[index], the.episodes(at)[index]
    if episode.over != 0:
        if rules.writes_terms != 0:
            for term in range(len(TERMS)):
                the.terms(at)[index, term] = 0.0
        if rules.mode == Mode.NEXT_STEP:
            begin(at, rules, index)
            return 0.0, 0
        return 0.0, End.WAS_OVER + 0
    gained = world.score - episode.scored
    episode.scored = world.score
    episode.steps += 1
    episode.quiet = 0 if gained > 0 else episode.quiet + 1
    ends, plays = 0, world.created > world.drained
    if world.drained >= rules.balls:
        ends = End.TERMINATED + 0
    elif not plays and rules.by_button == 0:
        board = the.boards(at)[the.board_of(at)[index]]
        create_ball(world, board, the.colliders(at), the.places(at), the.logs(at)[index])
        episode.quiet = 0
    if ends == 0 and episode.quiet >= rules.stall:
        episode.stalled = 1
        ends = End.TERMINATED + 0
    if ends == 0 and (episode.steps >= rules.limit or world.fault != Fault.NONE):
        ends = End.TRUNCATED + 0
    seconds = rules.ticks * rules.tick if plays else 0.0
    reward = rules.weights[POINTS] * gained + rules.weights[SECONDS] * seconds
    if rules.weighs_counts != 0:
        reward += reward_of_counts(at, rules, index, before)
        if rules.writes_terms != 0:
            the.terms(at)[index, POINTS], the.terms(at)[index, SECONDS] = gained, seconds
    if rules.pictures != 0:
        film_step(at, index)
    if ends != 0:
        episode.over = 1
        if rules.mode == Mode.SAME_STEP:
            keep_final(at, rules, index)
            begin(at, rules, index)
    return reward, ends


@internal
def reward_of_counts(at: Any, rules: Any, index: int, before: int) -> float:
    """The part of a reward that a stall and the growth of counts make; writes these terms too."""
    stalled = the.episodes(at)[index].stalled
    the.terms(at)[index, STALLED] = stalled
    reward = rules.weights[STALLED] * stalled
    counts = array_at(at.worlds_at + index * WORLD_SIZE + COUNTS_AT, (len(COUNTS),), INT)
    for term in range(FIRST_COUNT, len(TERMS)):
        count = term - FIRST_COUNT + 1
        grown = counts[count] - the.counts_before(at)[before, count]
        the.terms(at)[index, term] = grown
        reward += rules.weights[term] * grown
    return float(reward)


@internal
def begin(at: Any, rules: Any, index: int) -> None:
    """Begin the next episode: another board, another seed, a world in which nothing has happened yet."""
    episode = the.episodes(at)[index]
    episode.number += 1
    key0, key1 = episode.key & WORD, (episode.key >> 32) & WORD
    high, low = threefry(key0, key1, episode.number & WORD, 0)
    choice, _ = threefry(key0, key1, episode.number & WORD, 1)
    which = (choice * rules.boards) >> 32 if rules.own_boards == 0 else index % rules.boards
    if the.wanted(at)[index] >= 0:
        which = the.wanted(at)[index]
    the.board_of(at)[index] = which
    copy_bytes(at.worlds_at + index * WORLD_SIZE, at.blanks_at + which * WORLD_SIZE, WORLD_SIZE)
    world, log = the.worlds(at)[index], the.logs(at)[index]
    world.seed = ((high & 0x7FFFFFFF) << 32) | low
    log.count, log.lost = 0, 0
    episode.board_seed = the.board_seeds(at)[which]
    episode.stalled, episode.over, episode.steps, episode.quiet, episode.scored = 0, 0, 0, 0, 0
    if rules.by_button == 0:
        create_ball(world, the.boards(at)[which], the.colliders(at), the.places(at), log)
    if rules.pictures != 0:
        show_first(at, index)


@internal
def keep_final(at: Any, rules: Any, index: int) -> None:
    """Keep what the last observation and the counts of an episode are made of, before the next begins."""
    write_counts(at, at.final_counts_at, index)
    if rules.state != 0:
        write_state(at, rules, at.finals_at, index)
    if rules.pictures != 0:
        size = at.stack * SCENE_SIZE
        copy_bytes(at.final_scenes_at + index * size, at.scenes_at + index * size, size)


@inlined
def observe(at: Any, rules: Any, index: int) -> None:
    """Write what an environment shows."""
    write_counts(at, at.counts_at, index)
    if rules.state != 0:
        write_state(at, rules, at.observations_at, index)
    if rules.copies != 0:
        wind(at, index)


@inlined
def write_counts(at: Any, address: int, index: int) -> None:
    """Write the events of the episode so far, in the order of `COUNTS`, then the board's seed and a stall."""
    start = address + index * at.counts * 8
    copy_bytes(start, at.worlds_at + index * WORLD_SIZE + COUNTS_AT, COUNTS_SIZE)
    copy_bytes(start + COUNTS_SIZE, at.episodes_at + index * EPISODE_SIZE, 16)


@internal
def has_counted(at: Any, index: int) -> bool:
    """Whether what `write_counts` would write differs from what is there."""
    there = array_at(at.counts_at + index * at.counts * 8, (at.counts,), INT)
    counts = array_at(at.worlds_at + index * WORLD_SIZE + COUNTS_AT, (len(COUNTS),), INT)
    episode = the.episodes(at)[index]
    differs = there[len(COUNTS)] != episode.board_seed or there[len(COUNTS) + 1] != episode.stalled
    for number in range(len(COUNTS)):
        differs |= there[number] != counts[number]
    return bool(differs)


@internal
def write_state(at: Any, rules: Any, address: int, index: int) -> None:
    """Write a state observation among those at an address, slot by slot as `slots.py` has them."""
    row = array_at(address + index * at.columns * 4, (at.columns,), SMALL_FLOAT)
    world, episode = the.worlds(at)[index], the.episodes(at)[index]
    for slot in range(BALL_COUNT):
        ball, start = world.ball[slot], BALLS + BALL_WIDTH * slot
        there = 0.0 if ball.id == 0 else 1.0
        row[start + BallSlot.ALIVE] = there
        row[start + BallSlot.X] = there * ball.x * rules.per_x
        row[start + BallSlot.Z] = there * ball.z * rules.per_z
        row[start + BallSlot.VX] = there * ball.vx * rules.per_speed
        row[start + BallSlot.VZ] = there * ball.vz * rules.per_speed
    for side in range(2):
        paddle, start = world.paddle[side], PADDLES + PADDLE_WIDTH * side
        row[start + PaddleSlot.ANGLE] = (paddle.angle - rules.rest[side]) * rules.per_angle[side]
        row[start + PaddleSlot.TURN] = paddle.angular_velocity * rules.per_turn[side]
        held = paddle.angle_commanded == rules.up[side] and rules.per_angle[side] != 0.0
        row[start + PaddleSlot.HELD] = 1.0 if held else 0.0
    row[GAME + GameSlot.PATIENCE] = max(0.0, 1.0 - episode.quiet * rules.per_quiet)
    row[GAME + GameSlot.LEFT] = (rules.balls - world.created) * rules.per_ball
    if rules.layout != 0:
        size = at.layout_columns * 4
        target = address + (index * at.columns + LAYOUT) * 4
        copy_bytes(target, at.layouts_at + the.board_of(at)[index] * size, size)
