"""The simple players: idle, random, blind, reflex and hold, as kernels.

They read the state of the world and keep none themselves, so a game can be continued from any snapshot.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from silverball.physics.for_devices import is_captured, shares_level
from silverball.physics.kernel import inlined, kernel
from silverball.physics.portable_math import sine_cosine, uniform
from silverball.physics.records import (
    LAUNCH,
    LEFT,
    RIGHT,
    BoardRecord,
    ColliderRecord,
    Colliders,
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
# The blind player is the best of 42 rhythms on `classic`. Source: docs/benchmark.md.
BLIND_RATE = 60.0  # [1/s] beats
BLIND_BEATS = 3  # of a period: in the first one both paddles are up
LAUNCH_KEY = 0xBA11  # makes the numbers of the launch button independent of the others
LAUNCH_PERIOD = 1.5  # [s] from one press of the launch button to the next
LAUNCH_LEAST, LAUNCH_SPAN = 0.3, 0.6  # of the period: the button is held for 30 to 90 % of it


class PlayerKind(IntEnum):
    """The player in a compiled loop: a simple one, or one that has decided before the call."""

    IDLE = 0
    RANDOM = 1
    REFLEX = 2
    HOLD = 4  # both paddles up forever
    DECIDED = 5  # a policy outside of the loop (see batch_policies.py)
    BLIND = 6  # both paddles up and down again in a fixed rhythm


class SimplePlayer:
    """A simple player for a single world.

    Args:
        name: "idle", "random", "blind", "reflex" or "hold".
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
        bits = struck_buttons(world, board, colliders, LOOK_AHEAD)
        return bits & LEFT != 0, bits & RIGHT != 0
    if player == PlayerKind.BLIND:
        is_up = int(world.tick * tick * BLIND_RATE + 0.5 * tick * BLIND_RATE) % BLIND_BEATS == 0
        return is_up, is_up
    held = player == PlayerKind.HOLD
    return held, held


@kernel
def holds_launch(world: WorldRecord, tick: float) -> bool:
    """Whether the launch button is held in the next tick by players that know the paddle buttons only.

    It is held and let go again and again, for a time that varies, so that balls on a plunger are launched
    at different speeds.
    """
    turn = int(world.tick * tick / LAUNCH_PERIOD)
    share = LAUNCH_LEAST + LAUNCH_SPAN * uniform(world.seed ^ LAUNCH_KEY, turn)
    return bool(world.tick * tick < (turn + share) * LAUNCH_PERIOD)


@kernel
def launch_bit(world: WorldRecord, board: BoardRecord, tick: float) -> int:
    """The bit of the launch button if it is held in the next tick; see `holds_launch`."""
    return LAUNCH if board.plungers != 0 and holds_launch(world, tick) else 0


@kernel
def press_launch(worlds: Any, boards: Any, board_of: Any, tick: float, actions: Any) -> None:
    """Write whether the launch button is held in the next tick into `actions`, bool [1, world, 4]."""
    for index in range(len(worlds)):
        bit = launch_bit(worlds[index], boards[board_of[index]], tick)
        actions[0, index, 3] = bit != 0


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
def press_reflexes(
    worlds: Any, boards: Any, board_of: Any, colliders: Colliders, ahead: float, actions: Any
) -> None:
    """Write what the reflex player holds, if it predicts balls by `ahead` [s], as `press_all` does."""
    for index in range(len(worlds)):
        bits = struck_buttons(worlds[index], boards[board_of[index]], colliders, ahead)
        actions[0, index, 0], actions[0, index, 1] = bits & LEFT != 0, bits & RIGHT != 0


@inlined
def is_button_up(world: WorldRecord, board: BoardRecord, colliders: Colliders, button: int) -> bool:
    """Whether the first paddle of a button, LEFT or RIGHT, is commanded to be up."""
    first = board.collider_first + Part.FIRST_PADDLE
    for number in range(board.paddles):
        if colliders[first + number].button == button:
            return bool(world.paddle[number].angle_commanded == colliders[first + number].angle_up)
    return False


@kernel
def struck_buttons(world: WorldRecord, board: BoardRecord, colliders: Colliders, ahead: float) -> int:
    """The bits of the buttons with a paddle that the reflex player lifts; see `strikes`."""
    bits, first = 0, board.collider_first + Part.FIRST_PADDLE
    for number in range(board.paddles):
        c = colliders[first + number]
        if bits & c.button == 0 and strikes(world, board, c, ahead):
            bits |= c.button
    return bits


@kernel
def strikes(world: WorldRecord, board: BoardRecord, c: ColliderRecord, ahead: float) -> bool:
    """Whether the reflex player lifts this paddle: a ball will be just above its outer half.

    It predicts the ball `ahead` [s], without contacts.
    """
    if c.angle_up == c.angle_rest:  # the table has no such paddle
        return False
    sine, cosine = sine_cosine(c.angle_rest)
    for slot in range(board.max_balls):
        ball = world.ball[slot]
        if ball.id == 0 or is_captured(ball) or not shares_level(c, ball):
            continue
        dx = ball.x + (ball.vx + 0.5 * ball.accel_x * ahead) * ahead - c.x
        dz = (ball.z + (ball.vz + 0.5 * ball.accel_z * ahead) * ahead - c.z) * c.side
        along = dx * sine + dz * cosine  # from the pivot to the tip
        above = dx * cosine - dz * sine - board.ball_radius
        if NEAR_SHARE * c.z1 < along < c.z1 + board.ball_radius and -0.5 < above < STRIKE_HEIGHT:
            return True
    return False
