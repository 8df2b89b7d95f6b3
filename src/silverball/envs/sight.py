"""What an agent sees of the balls, for the option `sight`: everything, those near a paddle, or no velocities.

The distance is that from the centre of a ball to the nearest pivot of a paddle [u]. A hidden ball has the
slots of an absent one, and pictures do not show it. What a hidden ball hits still lights up in pictures,
since parts do so as well for players who do not follow the ball.
"""

from __future__ import annotations

import math
from typing import Any, Final

from silverball.envs import pointers as views
from silverball.envs.pointers import Pointers
from silverball.envs.state import RulesRecord
from silverball.physics.kernel import inlined, internal
from silverball.physics.records import BallRecord, Part
from silverball.table.quantity import Quantity, refuse

POSITIONS: Final = "positions"
"""The value of `sight` that hides the velocities of balls and paddles."""

MAX_SIGHT = 100.0  # [u] farther than the diagonal of the greatest board


def checked_sight(sight: Any) -> float | str | None:
    """None, "positions", or a distance above zero [u]."""
    if sight is None or sight == POSITIONS:
        return None if sight is None else POSITIONS
    distance = Quantity(0.0, MAX_SIGHT, f"u, {POSITIONS!r} or None").check(sight)
    return distance if distance > 0.0 else refuse(f"must be above 0 u, {POSITIONS!r} or None, got {sight!r}")


def reach_of(sight: float | str | None) -> float:
    """The distance from the paddles within which balls are seen [u]."""
    return sight if isinstance(sight, float) else math.inf


@inlined
def is_in_sight(ptr: Pointers, rules: RulesRecord, index: int, ball: BallRecord) -> bool:
    """Whether there is a ball in this slot and an agent sees it."""
    if ball.id == 0:
        return False
    return rules.reach == math.inf or is_near_paddles(ptr, rules.reach, index, ball)


@internal
def is_near_paddles(ptr: Pointers, reach: float, index: int, ball: BallRecord) -> bool:
    """Whether the centre of a ball is within a distance [u] of the pivot of a paddle."""
    board = views.boards(ptr)[views.board_of(ptr)[index]]
    first = board.collider_first + Part.FIRST_PADDLE
    for number in range(first, first + board.paddles):
        c = views.colliders(ptr)[number]
        dx, dz = ball.x - c.x, ball.z - c.z
        if dx * dx + dz * dz <= reach * reach:
            return True
    return False
