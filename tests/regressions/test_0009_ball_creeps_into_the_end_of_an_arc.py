"""A rolling ball wedged between the ends of two arcs went 3e-11 u deeper into one of them in every tick.

Between straight walls with the same ends it stays where it is.
"""

from __future__ import annotations

import pytest

from boards import table_of
from silverball.physics.audit import deepest
from silverball.table.kinds import Wall
from silverball.world import World

ONE, OTHER = (4.51628899521195, -4.097490067377673), (4.142307267157215, -4.427851486252811)
"""Points a hair less than a ball apart."""
ARCS = (
    Wall(points=((*ONE, 1.0), (6.201836440338605, -2.608540731671331)), thickness=0.0, restitution=0.0),
    Wall(points=((*OTHER, 1.2939), (6.5758, -2.27818)), thickness=0.0, restitution=0.0, friction=0.0),
)
EDGES = (
    Wall(points=(ONE, (ONE[0] + 0.7, ONE[1] + 0.7)), thickness=0.0, restitution=0.0),
    Wall(points=(OTHER, (OTHER[0] - 0.5, OTHER[1] - 0.5)), thickness=0.0, restitution=0.0, friction=0.0),
)
BOARD = {"gravity": 3.0, "slope": 11.2, "friction": 0.02, "rolling": True, "gutter": -5.5, "length": 13.6}


@pytest.mark.parametrize("walls", [EDGES, ARCS])
def test_a_wedged_ball_does_not_get_deeper_tick_by_tick(walls) -> None:
    world = World(table_of(*walls, width=11.0, **BOARD), tick_rate=240)
    world.create_ball((4.340597776431, -4.275462890422), (-1.67, 1.9))
    world.step(ticks=900)
    assert world.jams > 100  # else it was not wedged
    assert deepest(*world.records) < 1e-9
