"""Numbers left in an empty slot, from outside, kept a world from moving, without a fault."""

from __future__ import annotations

import numpy as np

from boards import table_of
from silverball.world import WorldBatch


def test_what_stands_in_an_empty_slot_does_not_matter() -> None:
    batch = WorldBatch(table_of(), 2, tick_rate=60)
    batch.state["ball"]["x"][0, 1] = 50.0
    batch.step(np.zeros((2, 3), np.bool_), ticks=10)
    assert batch.state["tick"].tolist() == [10, 10]
    assert batch.state["fault"].tolist() == [0, 0]
