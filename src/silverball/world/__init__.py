"""Tables come to life: `World` (one), `WorldBatch` (thousands), and what they show."""

from silverball.world.batch import WorldBatch
from silverball.world.events import Ball, Event, Paddle
from silverball.world.world import World

__all__ = ["Ball", "Event", "Paddle", "World", "WorldBatch"]
