"""Tables come to life: `World` (one), `WorldBatch` (thousands), `Snapshot` (saved ones), and what they show.

`compile.py` turns tables into the arrays that the step reads, `single_step.py` moves a single world with
one short
call, `state.py` and `snapshot.py` know what is saved.
"""

from silverball.world.batch import WorldBatch
from silverball.world.events import BallState, Event, PaddleState
from silverball.world.snapshot import Snapshot
from silverball.world.world import World

__all__ = ["BallState", "Event", "PaddleState", "Snapshot", "World", "WorldBatch"]
