"""Which spaces do the options make, and how do raw rows and pictures become observations of them?"""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from silverball.envs.board_pool import Pool
from silverball.envs.options import Options
from silverball.envs.slots import bounds
from silverball.envs.state import COUNTS

INFO = (*COUNTS, "board", "stalled")
"""The keys of `info`, in the order of the rows of an engine's counts."""


def observation_space(options: Options, pool: Pool) -> spaces.Space[Any]:
    """The space of one environment's observations."""
    if options.observation == "pixels":
        return spaces.Box(0, 255, picture_shape(options), np.uint8)
    boxes = {field.group.name: spaces.Box(*bounds(field)) for field in pool.fields if field.items}
    if options.observation == "dict":
        return spaces.Dict(dict[str, spaces.Space[Any]](boxes))
    low = np.concatenate([box.low.reshape(-1) for box in boxes.values()])
    high = np.concatenate([box.high.reshape(-1) for box in boxes.values()])
    return spaces.Box(low, high)


def action_space(options: Options) -> spaces.Space[Any]:
    """The space of one environment's actions."""
    count = len(options.buttons)
    return spaces.MultiBinary(count) if options.actions == "multibinary" else spaces.Discrete(1 << count)


def picture_shape(options: Options) -> tuple[int, ...]:
    """[stacked, row, column, channel]; without the axes of length one that nobody asked for."""
    stack = (options.stack,) if options.stack > 1 else ()
    return (*stack, *options.size, *((3,) if options.rgb else ()))


def shown(options: Options, pool: Pool, rows: NDArray[Any]) -> Any:
    """Raw rows [env, …] as a batch of observations; views of the rows."""
    count = len(rows)
    if options.observation == "pixels":
        return rows.reshape(count, *picture_shape(options))
    if options.observation == "state":
        return rows
    return {
        field.group.name: rows[:, field.first : field.end].reshape(count, *field.shape)
        for field in pool.fields
        if field.items
    }


def shown_one(options: Options, pool: Pool, row: NDArray[Any]) -> Any:
    """One raw row as an observation."""
    batch = shown(options, pool, row[None])
    return {name: part[0] for name, part in batch.items()} if isinstance(batch, dict) else batch[0]
