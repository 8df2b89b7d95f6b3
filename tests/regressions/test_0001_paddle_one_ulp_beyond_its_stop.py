"""A stroke that contacts of the balls cut into pieces ended one ulp beyond the stop, and the saved state
was refused."""

from __future__ import annotations

import numpy as np

from boards import PADDLES, table_of
from silverball.world import World, WorldBatch
from silverball.world.saved_world import pack


def test_no_stroke_ends_beyond_its_stop_however_it_is_cut() -> None:
    for tick_rate in (10, 20, 60):
        batch = WorldBatch(table_of(*PADDLES), count=500, tick_rate=tick_rate)
        colliders = batch.boards.collider
        rest, up = colliders["angle_rest"][3:5], colliders["angle_up"][3:5]
        rng = np.random.default_rng(0)
        for _ in range(400):
            batch.create_balls()
            held = rng.random((500, 3)) < 0.5
            held[:, 2] = False
            batch.step(held)
            angle = batch.state["paddle"]["angle"][:, :2]
            assert (rest <= angle).all()
            assert (angle <= up).all()


def test_the_state_after_such_a_stroke_can_be_restored() -> None:
    """The very tick: two balls cross the gutter line while the left paddle comes down from 17.5 degrees."""
    world = World(table_of(*PADDLES), tick_rate=20)
    record = world.records[0]
    record["ball"]["x"][:2] = -8.480318396683147, -8.611589217219262
    record["ball"]["z"][:2] = 0.06775372525586232, 4.574742322860859
    record["ball"]["vx"][:2] = -13.5, -13.0
    record["ball"]["id"][:2] = 1, 2
    record["created"] = 2
    record["paddle"]["angle"][0] = 0.30543261909900765
    world.step(right=True)
    assert world.drained == 2
    world.restore(world.save())
    assert world.save() == pack(world.records[0], world.save()[32:64].hex(), 20)
