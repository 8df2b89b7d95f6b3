"""Tables come to life: `World` (one), `WorldBatch` (thousands), `Snapshot` (saved ones), and what they show.

`compile.py` turns tables into the arrays that the step reads, `alone.py` moves a single world with one short
call, `state.py` and `snapshot.py` know what is saved.
"""

from silverball.world.batch import WorldBatch
from silverball.world.events import Ball, Event, Paddle
from silverball.world.snapshot import Snapshot
from silverball.world.world import World

__all__ = ["Ball", "Event", "Paddle", "Snapshot", "World", "WorldBatch"]
