"""One shot: the ball drops onto a paddle, and the first named part that it hits afterwards is the shot.

    begin_shots   a goal is drawn, and the ball is put above a paddle at rest
    judge_shots   after each step: has a paddle met the ball, and which shot has it made since?

A part is hit by a bounce above the table's `hit_speed`, by a crossing of a switch, or by a fall into a hole.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from silverball.physics.balls import find_free_place, is_free, put_ball
from silverball.physics.kernel import as_int, internal, kernel
from silverball.physics.portable_math import WORD, threefry, uniform
from silverball.physics.records import BatchGeometry, BoardRecord, EventKind, Lanes, Part, WorldRecord

DROP = (1.0, 3.0)  # [u] above the pivot, in which the ball starts. Source: chosen, so that it bounces little
ALONG = 0.75  # share of the paddle, from its pivot on, above which it starts
TRIES = 32  # of places above paddles, before any free place is taken
GOAL_KEY = 0x6041  # makes the draws of goals independent of those of boards

SHOT_STATE = np.dtype(
    [
        ("goal", "i8"),  # the shot that is wanted
        ("struck", "i8"),  # 1: a paddle has met the ball
        ("made", "i8"),  # the shot that was made; −1: none
    ],
    align=True,
)
"""The state of an episode beside those of its world and its engine."""


class ShotArrays(NamedTuple):
    """The arrays of the environments, bundled for kernels.

    Attributes:
        shots: SHOT_STATE records [env].
        seeds: The seeds and numbers of the episodes, EPISODE records [env].
        shot_of: The shot that each part of the table is, int64 [part]; −1: none.
        goals: The wanted goals of the episodes that begin, int64 [env]; −1: it is drawn.
        mask: Which episodes begin, bool [env].
        count: The number of shots, int64 [1].
    """

    shots: Any
    seeds: Any
    shot_of: Any
    goals: Any
    mask: Any
    count: Any


@kernel
def begin_shots(
    lanes: Lanes, geometries: BatchGeometry, places: Any, arrays: ShotArrays, first: int, end: int
) -> None:
    """Draw a goal and put a ball above a paddle in those of the environments first … end − 1 in the mask."""
    for index in range(first, end):
        if not arrays.mask[index]:
            continue
        shot, seed = arrays.shots[index], arrays.seeds[index]
        key0, key1 = (seed.seed & WORD) ^ GOAL_KEY, (seed.seed >> 32) & WORD
        choice, _ = threefry(key0, key1, seed.number & WORD, 0)
        shot.goal = arrays.goals[index]
        if shot.goal < 0:
            shot.goal = (choice * arrays.count[0]) >> 32
        shot.struck, shot.made = 0, -1
        world, log, board = lanes.worlds[index], lanes.logs[index], geometries.boards[lanes.board_of[index]]
        is_found, x, z = place_above_paddle(world, board, geometries.colliders)
        if not is_found:
            is_found, x, z, world.draws = find_free_place(world, board, geometries.colliders, places)
        if is_found:
            put_ball(world, board, log, 0, x, z, 0.0, 0.0)


@internal
def place_above_paddle(world: WorldRecord, board: BoardRecord, colliders: Any) -> tuple[bool, float, float]:
    """Find a free place above one of the first two paddles; whether there is one, x and z [u]."""
    first = board.collider_first + Part.FIRST_PADDLE
    for _ in range(TRIES if board.paddles > 0 else 0):
        draws = world.draws
        paddle = colliders[first + int(uniform(world.seed, draws) * min(board.paddles, 2))]
        x = paddle.x + DROP[0] + (DROP[1] - DROP[0]) * uniform(world.seed, draws + 1)
        side = 1.0 if paddle.sweep_z > paddle.z else -1.0
        z = paddle.z + side * ALONG * paddle.reach * uniform(world.seed, draws + 2)
        world.draws = draws + 3
        if is_free(world, board, colliders, x, z):
            return True, x, z
    return False, 0.0, 0.0


@kernel
def judge_shots(lanes: Lanes, geometries: BatchGeometry, arrays: ShotArrays, first: int, end: int) -> None:
    """Find the shots that the last step has made in the environments first … end − 1."""
    for index in range(first, end):
        shot, log = arrays.shots[index], lanes.logs[index]
        board = geometries.boards[lanes.board_of[index]]
        last_paddle = Part.FIRST_PADDLE + board.paddles - 1
        for number in range(log.count):
            event = log.event[number]
            if shot.made >= 0 or event.part < 0:
                continue
            is_contact = event.kind in (EventKind.HIT, EventKind.TOUCH)
            if is_contact and Part.FIRST_PADDLE <= event.part <= last_paddle:
                shot.struck = 1
            elif shot.struck != 0 and arrays.shot_of[event.part] >= 0 and is_hit(event.kind):
                shot.made = as_int(arrays.shot_of[event.part])


@internal
def is_hit(kind: int) -> bool:
    """Whether an event of a kind is a hit of its part."""
    return kind in (EventKind.HIT, EventKind.PASS, EventKind.CAPTURED)
