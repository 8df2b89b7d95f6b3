"""The published rules of the PinBall domain in NumPy, for comparison with the exact engine.

A step moves the ball twenty times by a twentieth of its way. After each move its overlaps with the edges of
the polygons are looked for, those only that it moves towards. One edge reflects the velocity, several
reverse it. A ball beyond an edge of the board is put back by a twentieth.

Written from the rules of the paper (see `silverball.envs.domain`) and of its published code, whose numbers
these are.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.envs.domain.board_file import DomainBoard
from silverball.envs.domain.impulses import (
    DRAG,
    IMPULSE,
    PUSH_REWARD,
    STEP_REWARD,
    TARGET_REWARD,
    Push,
)

MOVES = 20  # of a step
SPEED_LIMIT = 2.0
WIDEST = math.pi / 1.99  # [rad] between the velocity and the way to an edge; wider: the ball moves away
INSET = 0.05  # from the edge, where a ball beyond it is put
DIRECTIONS = {
    Push.RIGHT: (IMPULSE, 0.0), Push.DOWN: (0.0, IMPULSE), Push.LEFT: (-IMPULSE, 0.0),
    Push.UP: (0.0, -IMPULSE), Push.NONE: (0.0, 0.0),
}  # fmt: skip

Vector: TypeAlias = NDArray[np.float64]
"""x and y."""


class DomainRules:
    """One ball on a board, by the published rules.

    Args:
        board: The board; the ball starts at its first start.

    Examples:
        >>> from silverball.benchmarks.domain_rules import DomainRules
        >>> from silverball.envs.domain.board_file import load_board
        >>> ball = DomainRules(load_board("open"))
        >>> ball.step(0)
        (-5.0, False)
        >>> ball.state().round(3).tolist()
        [0.204, 0.9, 0.199, 0.0]
    """

    def __init__(self, board: DomainBoard) -> None:
        self._radius = board.ball_radius
        self._target, self._target_radius = np.array(board.target), board.target_radius
        self._start = np.array(board.starts[0])
        corners = [np.array(polygon) for polygon in board.polygons] or [np.zeros((0, 2))]
        self._starts = np.concatenate(corners)
        self._edges = np.concatenate([np.roll(ends, -1, axis=0) - ends for ends in corners])
        self._squares = np.sum(self._edges * self._edges, axis=1)
        self.reset()

    def reset(self) -> None:
        """Put the ball at rest where it starts."""
        self.place, self.velocity = self._start.copy(), np.zeros(2)

    def state(self) -> Vector:
        """The four numbers x, y and their velocities."""
        return np.concatenate([self.place, self.velocity])

    def step(self, action: int) -> tuple[float, bool]:
        """Make a step; return its reward, and whether the ball has reached the target."""
        self.velocity = np.clip(self.velocity + DIRECTIONS[Push(action)], -SPEED_LIMIT, SPEED_LIMIT)
        for move in range(MOVES):
            self._move()
            met = self._edges_met()
            if len(met):
                self._bounce(met)
                if len(met) == 1 and move == MOVES - 1:
                    self._move()
            if np.linalg.norm(self.place - self._target) < self._target_radius:
                return TARGET_REWARD, True
        self.velocity = self.velocity * DRAG
        self.place = np.where(self.place > 1.0, 1.0 - INSET, np.where(self.place < 0.0, INSET, self.place))
        return STEP_REWARD if action == Push.NONE else PUSH_REWARD, False

    def _move(self) -> None:
        self.place = self.place + self.velocity * (self._radius / MOVES)

    def _edges_met(self) -> NDArray[np.int64]:
        """The edges that the ball overlaps and moves towards."""
        along = np.sum((self.place - self._starts) * self._edges, axis=1) / self._squares
        to_edge = self._starts + np.clip(along, 0.0, 1.0)[:, None] * self._edges - self.place
        squares = np.sum(to_edge * to_edge, axis=1)
        near = np.flatnonzero(squares <= self._radius * self._radius)
        if not len(near):
            return near
        limit = math.cos(WIDEST) * np.linalg.norm(self.velocity) * np.sqrt(squares[near])
        towards = to_edge[near] @ self.velocity
        met: NDArray[np.int64] = near[(towards >= limit) & self.velocity.any()]
        return met

    def _bounce(self, met: NDArray[np.int64]) -> None:
        """Reflect the velocity off the only edge met, or reverse it."""
        if len(met) > 1:
            self.velocity = -self.velocity
            return
        edge = self._edges[met[0]]
        self.velocity = 2.0 * (self.velocity @ edge) / (edge @ edge) * edge - self.velocity
