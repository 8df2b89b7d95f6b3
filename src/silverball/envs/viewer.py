"""How does an environment show itself to people? As the window draws it, loaded when first asked for."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from silverball.world import WorldBatch
from silverball.world.events import read_balls, read_events, read_paddles

if TYPE_CHECKING:
    from silverball.drawing import Moment, Renderer

SIZE = (330, 680)  # width and height [pixel]
MOST_RENDERERS = 8  # kept at once; a board takes some megabytes


class Viewer:
    """Draws worlds of a batch, each on its board."""

    def __init__(self, batch: WorldBatch) -> None:
        self._batch = batch
        self._renderers: dict[int, Renderer] = {}
        self._noted: dict[int, tuple[int, int]] = {}

    def picture(self, index: int) -> NDArray[np.uint8]:
        """World `index` now, RGB [row, column, 3]."""
        batch, board = self._batch, int(self._batch.board_of[index])
        renderer = self._renderer(board)
        record = batch.state[index]
        moment = (int(record["seed"]), int(record["tick"]))
        if self._noted.get(index) != moment:
            height = batch.tables[board].board.height
            names = batch.boards.names[board]
            renderer.note(read_events(batch.logs[index], names, height), batch.tick_rate)
            self._noted[index] = moment
        return np.array(renderer.array(self._moment(index)))

    def _renderer(self, board: int) -> Renderer:
        from silverball.drawing import Renderer

        if board not in self._renderers:
            while len(self._renderers) >= MOST_RENDERERS:
                del self._renderers[next(iter(self._renderers))]
            self._renderers[board] = Renderer(self._batch.tables[board], SIZE)
        return self._renderers[board]

    def _moment(self, index: int) -> Moment:
        from silverball.drawing.moment import BallAt, Moment

        record: Any = self._batch.state[index]
        balls = tuple(BallAt(ball.id, ball.position[0], ball.position[2]) for ball in read_balls(record, 0.0))
        left, right = (math.degrees(paddle.angle) for paddle in read_paddles(record))
        time = int(record["tick"]) / self._batch.tick_rate
        return Moment(time, balls, (left, right), int(record["score"]))
