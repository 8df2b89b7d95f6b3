"""The step of the PinBall domain: an impulse, one tick of the engine, then the drag.

    push_balls      the velocity gets the action's impulse and is clipped
    → run_worlds    the engine moves the ball for a tick, exactly, with all bounces
    → finish_steps  drag, reward, end of the episode, reset if due, observation

Velocities of the domain are in ball radii per step; `unit` is one of them on the table [u/s]. The domain's x
points to +z of the table, its y to −x.

Sizes of impulse, drag, limit and rewards are those of the paper and its published code.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from silverball.envs.domain.board_table import SIDE, SPEED_LIMIT
from silverball.envs.state import ResetMode
from silverball.physics.balls import put_ball
from silverball.physics.event_log import clear_log, store_checksum
from silverball.physics.kernel import inlined, internal, kernel
from silverball.physics.motion import start_flight
from silverball.physics.portable_math import WORD, threefry
from silverball.physics.records import BatchGeometry, EventKind, Fault, Lanes, LogRecord

IMPULSE = 0.2  # of an action, on one component of the velocity
DRAG = 0.995  # factor on the velocity, once a step
STEP_REWARD, PUSH_REWARD, TARGET_REWARD = -1.0, -5.0, 10_000.0
SLOTS = 4  # of an observation: x, y, and their velocities


class Push(IntEnum):
    """The actions: which component of the velocity gets an impulse."""

    RIGHT = 0  # x
    DOWN = 1  # y
    LEFT = 2
    UP = 3
    NONE = 4


EPISODE_OF_DOMAIN = np.dtype(
    [
        ("seed", "i8"), ("number", "i8"),  # the environment's seed, and which of its episodes this is, from 0
        ("steps", "i8"),
        ("over", "i8"), ("in_target", "i8"),  # 1: it has ended; the ball has reached the target
        ("last_x", "f8"), ("last_z", "f8"),  # where on the table the ball has entered the target [u]
    ],
    align=True,
)  # fmt: skip
"""The state of an episode beside that of its world."""

RULES_OF_DOMAIN = np.dtype([("unit", "f8"), ("max_steps", "i8"), ("mode", "i8")], align=True)
"""The speed 1 of the domain [u/s], the limit of an episode [step], and a ResetMode."""


class Arena(NamedTuple):
    """The arrays of the environments, bundled for kernels.

    Attributes:
        episodes: EPISODE_OF_DOMAIN records [env].
        rules: One RULES_OF_DOMAIN record [1].
        starts: Where balls may start on the table (x, z) [u], shape [start, 2].
        blanks: One new world [1].
        actions: `Push` numbers, int64 [env].
        masks: bool [4, env]: which episodes begin in a reset; and of the last step: terminated, truncated,
            and whether an episode has ended.
        rewards: Of the last step, float64 [env].
        observations: float32 [2, env, slot]: the present ones, and the last ones of episodes that have ended.
    """

    episodes: Any
    rules: Any
    starts: Any
    blanks: Any
    actions: Any
    masks: Any
    rewards: Any
    observations: Any


@kernel
def push_balls(lanes: Lanes, geometries: BatchGeometry, arena: Arena, first: int, end: int) -> None:
    """Give the balls of the environments first … end − 1 the impulses of their actions."""
    unit = arena.rules[0].unit
    for index in range(first, end):
        world, log = lanes.worlds[index], lanes.logs[index]
        ball, action = world.ball[0], arena.actions[index]
        if ball.id == 0:
            continue
        x_speed, y_speed = ball.vz / unit, -ball.vx / unit
        x_speed += IMPULSE * (int(action == Push.RIGHT) - int(action == Push.LEFT))
        y_speed += IMPULSE * (int(action == Push.DOWN) - int(action == Push.UP))
        ball.vz = clip(x_speed) * unit
        ball.vx = -clip(y_speed) * unit
        start_flight(ball, geometries.boards[0], 0.0)
        store_checksum(world, geometries.boards[0], log)


@kernel
def finish_steps(lanes: Lanes, geometries: BatchGeometry, arena: Arena, first: int, end: int) -> None:
    """End the step of the environments first … end − 1: drag, rewards, ends, resets and observations."""
    mode = arena.rules[0].mode
    for index in range(first, end):
        episode = arena.episodes[index]
        arena.rewards[index] = 0.0
        for row in range(1, 4):
            arena.masks[row, index] = False
        if episode.over == 0:
            end_step(lanes, geometries, arena, index)
            if episode.over != 0:
                arena.masks[3, index] = True
                if mode == ResetMode.SAME_STEP:
                    observe(lanes, arena, index, 1)
                    begin_episode(lanes, geometries, arena, index)
        elif mode == ResetMode.NEXT_STEP:
            begin_episode(lanes, geometries, arena, index)
        observe(lanes, arena, index, 0)


@kernel
def begin_episodes(lanes: Lanes, geometries: BatchGeometry, arena: Arena, first: int, end: int) -> None:
    """Begin the next episode of those of the environments first … end − 1 that are in the first mask."""
    for index in range(first, end):
        if arena.masks[0, index]:
            begin_episode(lanes, geometries, arena, index)
        observe(lanes, arena, index, 0)


@inlined
def clip(speed: float) -> float:
    """Limit a component of a velocity."""
    return min(max(speed, -SPEED_LIMIT), SPEED_LIMIT)


@internal
def end_step(lanes: Lanes, geometries: BatchGeometry, arena: Arena, index: int) -> None:
    """Apply the drag, and compute the reward of a step and whether it has ended the episode."""
    world, log, episode = lanes.worlds[index], lanes.logs[index], arena.episodes[index]
    ball, rules = world.ball[0], arena.rules[0]
    episode.steps += 1
    if world.drained > 0:
        episode.over, episode.in_target = 1, 1
        episode.last_x, episode.last_z = place_of_end(log)
        arena.rewards[index] = TARGET_REWARD
        arena.masks[1, index] = True
        return
    ball.vx *= DRAG
    ball.vz *= DRAG
    start_flight(ball, geometries.boards[0], 0.0)
    store_checksum(world, geometries.boards[0], log)
    arena.rewards[index] = STEP_REWARD if arena.actions[index] == Push.NONE else PUSH_REWARD
    if episode.steps >= rules.max_steps or world.fault != Fault.NONE:
        episode.over = 1
        arena.masks[2, index] = True


@internal
def place_of_end(log: LogRecord) -> tuple[float, float]:
    """Where the ball has fallen into the target: x and z on the table [u]."""
    for number in range(log.count):
        event = log.event[number]
        if event.kind == EventKind.GUTTER:
            return event.x, event.z
    return 0.0, 0.0


@internal
def begin_episode(lanes: Lanes, geometries: BatchGeometry, arena: Arena, index: int) -> None:
    """Begin the next episode: choose its start, and put the ball there at rest."""
    episode, log = arena.episodes[index], lanes.logs[index]
    episode.number += 1
    key0, key1 = episode.seed & WORD, (episode.seed >> 32) & WORD
    choice, _ = threefry(key0, key1, episode.number & WORD, 0)
    start = (choice * len(arena.starts)) >> 32
    lanes.worlds[index] = arena.blanks[0]
    world = lanes.worlds[index]
    world.seed = episode.number
    clear_log(log)
    put_ball(world, geometries.boards[0], log, 0, arena.starts[start, 0], arena.starts[start, 1], 0.0, 0.0)
    episode.steps, episode.over, episode.in_target, episode.last_x, episode.last_z = 0, 0, 0, 0.0, 0.0


@internal
def observe(lanes: Lanes, arena: Arena, index: int, row: int) -> None:
    """Write an observation: x, y and their velocities; a ball in the target lies where it has entered it."""
    ball, episode, unit = lanes.worlds[index].ball[0], arena.episodes[index], arena.rules[0].unit
    x, z = ball.x, ball.z
    if ball.id == 0:
        x, z = episode.last_x, episode.last_z
    slots = arena.observations[row, index]
    slots[0], slots[1] = z / SIDE + 0.5, 0.5 - x / SIDE
    slots[2], slots[3] = ball.vz / unit, 0.0 - ball.vx / unit
