"""Simulated tables: `World` (one), `WorldBatch` (thousands), and `Snapshot` (saved worlds)."""

from silverball.world.batch import WorldBatch
from silverball.world.events import BallState, Event, PaddleState
from silverball.world.snapshot import Snapshot
from silverball.world.world import World

__all__ = ["BallState", "Event", "PaddleState", "Snapshot", "World", "WorldBatch"]
