"""The simple players: idle, random, reflex and hold, as kernels.

They read the state of the world and keep none themselves, so a game can be continued from any snapshot.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from silverball.physics.kernel import kernel
from silverball.physics.portable_math import sine_cosine, uniform
from silverball.physics.records import (
    MAX_BALLS,
    BoardRecord,
    ColliderRecord,
    Colliders,
    Kind,
    Part,
    WorldRecord,
)
from silverball.world import World

RANDOM_KEY = 0x5EED  # makes the random player's numbers independent of the world's
RANDOM_HOLD = 0.15  # [s] for which the random player holds or releases a button
# The three numbers of the reflex player are the best of 40 random choices, by score per minute on both
# built-in tables: balls last 40 s on average. Without looking ahead they last longer, but lie on raised
# paddles.
NEAR_SHARE = 0.45  # of the paddle's length from the pivot, where the reflex player lets the ball roll
LOOK_AHEAD = 0.02  # [s] for which the reflex player predicts the ball
STRIKE_HEIGHT = 0.8  # [u] between ball and resting paddle at which it strikes


class PlayerKind(IntEnum):
    """The player in a compiled loop: a simple one, or one that has decided before the call."""

    IDLE = 0
    RANDOM = 1
    REFLEX = 2
    HOLD = 4  # both paddles up forever
    DECIDED = 5  # a policy outside of the loop (see batch_policies.py)


class SimplePlayer:
    """A simple player for a single world.

    Args:
        name: "idle", "random", "reflex" or "hold".
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._kind = int(PlayerKind[name.upper()])

    def press(self, world: World) -> tuple[bool, bool]:
        """The buttons (left, right) to hold in the world's next tick."""
        left, right = pressed(self._kind, *world.records, 1.0 / world.tick_rate)
        return bool(left), bool(right)


@kernel
def pressed(
    player: int, world: WorldRecord, board: BoardRecord, colliders: Colliders, tick: float
) -> tuple[bool, bool]:
    """The buttons (left, right) that a simple player holds in the next tick; `player` is a PlayerKind."""
    if player == PlayerKind.RANDOM:
        turn = int(world.tick * tick / RANDOM_HOLD)
        key = world.seed ^ RANDOM_KEY
        return uniform(key, 2 * turn) < 0.5, uniform(key, 2 * turn + 1) < 0.5
    if player == PlayerKind.REFLEX:
        left = colliders[board.collider_first + Part.LEFT_PADDLE]
        right = colliders[board.collider_first + Part.RIGHT_PADDLE]
        return strikes(world, board, left, LOOK_AHEAD), strikes(world, board, right, LOOK_AHEAD)
    held = player == PlayerKind.HOLD
    return held, held


@kernel
def press_all(
    player: int, worlds: Any, boards: Any, board_of: Any, colliders: Colliders, tick: float, actions: Any
) -> None:
    """Write what a player holds in the next tick of each world into `actions`, bool [1, world, 3]."""
    for index in range(len(worlds)):
        board = boards[board_of[index]]
        left, right = pressed(player, worlds[index], board, colliders, tick)
        actions[0, index, 0], actions[0, index, 1] = left, right


@kernel
def strikes(world: WorldRecord, board: BoardRecord, c: ColliderRecord, ahead: float) -> bool:
    """Whether the reflex player lifts this paddle: a ball will be just above its outer half.

    It predicts the ball `ahead` [s], without contacts.
    """
    if c.kind != Kind.PADDLE:
        return False
    sine, cosine = sine_cosine(c.angle_rest)
    for slot in range(MAX_BALLS):
        ball = world.ball[slot]
        if ball.id == 0:
            continue
        dx = ball.x + (ball.vx + 0.5 * ball.accel_x * ahead) * ahead - c.x
        dz = (ball.z + (ball.vz + 0.5 * ball.accel_z * ahead) * ahead - c.z) * c.side
        along = dx * sine + dz * cosine  # from the pivot to the tip
        above = dx * cosine - dz * sine - board.ball_radius
        if NEAR_SHARE * c.z1 < along < c.z1 + board.ball_radius and -0.5 < above < STRIKE_HEIGHT:
            return True
    return False
