"""The world of a game: reads its record without copies, and knows which ticks can be played at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from silverball.physics.records import HEADER, LOG, Device, Motion
from silverball.world import World
from silverball.world.saved_world import world_bytes

SKIP_LIMIT = 64  # most ticks played at once: the event log of a world holds 56 contacts
GUTTER_MARGIN = 0.1  # [u] a ball nearer to the gutter is played tick by tick

_TICK = [name for name, _ in HEADER].index("tick")  # place in the world record, in words of eight bytes
_LOG_WORDS = {name: int(field[1]) // 8 for name, field in (LOG.fields or {}).items()}
_COUNT, _CARRIED = _LOG_WORDS["count"], _LOG_WORDS["carried"]  # places in a log


class GameWorld:
    """Fast access to the world of a game.

    Args:
        world: The world.

    Attributes:
        world: The world.
        paddle_reach: No paddle reaches a ball above this x [u].
        tick: Returns the ticks so far; a C function, because it is called twice in every tick.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self._record = world.records[0]
        self._words: NDArray[np.int64] = np.frombuffer(self._record, np.int64)
        self.tick: Callable[[], int] = partial(self._words.item, _TICK)
        log: NDArray[np.int64] = np.frombuffer(world._batch.logs, np.int64)
        self._log_word: Callable[[int], int] = log.item
        self._gate_masks: dict[str, int] = {}  # the switches of each gate, by its name in events
        self._ball_x = self._record["ball"]["x"]
        self._ball_id = self._record["ball"]["id"]
        board = world.table.board
        self._skip_floor = board.gutter + GUTTER_MARGIN
        self._ticks_per_unit = world.tick_rate / board.speed_cap
        self.paddle_reach = float(world.records[1]["paddle_top"])

    def is_gate_open(self, part: str) -> bool:
        """Whether the gate with this name in events is open."""
        mask = self._gate_masks.get(part)
        if mask is None:
            rows = self.world.records[2]
            is_gate = (rows["part"] == list(self.world.hits).index(part)) & (rows["role"] == Device.GATE)
            mask = self._gate_masks[part] = int(np.bitwise_or.reduce(rows["switch"][is_gate]))
        return int(self._record["off"]) & mask == mask

    @property
    def ball_count(self) -> int:
        """Balls on the board."""
        return int(np.count_nonzero(self._ball_id))

    @property
    def has_ball_to_launch(self) -> bool:
        """Whether a ball lies on a plunger, which will not launch it by itself."""
        if "holder" not in (self._record["ball"].dtype.names or ()):
            return False
        roles = self.world.records[2]["role"]
        balls = self._record["ball"][["id", "motion", "holder", "due_tick"]].tolist()
        return any(
            ball != 0 and motion == Motion.CAPTURED and roles[row] == Device.PLUNGER and due == 0
            for ball, motion, row, due in balls
        )

    @property
    def ball_ids(self) -> list[int]:
        """The ids of the balls on the board; 0 for an empty slot."""
        ids: list[int] = self._ball_id.tolist()
        return ids

    @property
    def places(self) -> list[tuple[int, float, float]]:
        """The balls that move on the board, not those in a hole or on a plunger: id, x [u] and z [u]."""
        balls = self._record["ball"][["id", "x", "z", "motion"]].tolist()
        return [ball[:3] for ball in balls if ball[0] and ball[3] != Motion.CAPTURED]

    def to_bytes(self) -> bytes:
        """The bytes of the record."""
        return world_bytes(self._words)

    def has_new_events(self) -> bool:
        """Whether anything has happened in the last step of the world."""
        return self._log_word(_COUNT) > self._log_word(_CARRIED)

    def skippable_ticks(self, count: int) -> int:
        """How many of these ticks can be played at once because no ball can leave the board, at least 1."""
        lowest = min(
            (x for x, ball in zip(self._ball_x.tolist(), self._ball_id.tolist(), strict=True) if ball),
            default=None,
        )
        if lowest is None:
            return count
        skippable = (lowest - self._skip_floor) * self._ticks_per_unit - 1.0
        return min(count, SKIP_LIMIT, int(skippable)) if skippable >= 1.0 else 1  # NaN gives 1 too

    def snapshot(self) -> NDArray[np.int64]:
        """The words of the record, for `rewind`."""
        return self._words.copy()

    def rewind(self, snapshot: NDArray[np.int64]) -> None:
        """Go back to a snapshot; `World.hits` still counts the hits after it."""
        before = snapshot.view(self._record.dtype)[0]
        for name in before.dtype.names:
            self._record[name] = before[name]
