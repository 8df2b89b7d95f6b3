"""Where hit_speed was below the hop speed, a ball at rest on a cylinder hopped, hit, scored and flew away."""

from __future__ import annotations

import pytest

from boards import launched, table_of
from silverball.table import Cylinder


@pytest.mark.parametrize(("hit_speed", "gravity"), [(0.05, 10.0), (0.2, 10.0), (0.2, 100.0), (0.5, 100.0)])
def test_a_ball_at_rest_on_a_cylinder_scores_nothing_and_stays(hit_speed: float, gravity: float) -> None:
    table = table_of(Cylinder(center=(0, 0), radius=1), hit_speed=hit_speed, gravity=gravity)
    world = launched(table, (1.25 + 1e-7, 0.0, 0.0, 0.0))
    highest = 0.0
    for _ in range(2400):
        world.step()
        highest = max(highest, world.balls[0].position[0])
    assert world.score == 0
    assert highest <= 1.25 + 5e-4 + 2e-7


def test_two_balls_at_rest_on_one_another_score_no_ball_hits() -> None:
    table = table_of(Cylinder(center=(0, 0), radius=1))
    world = launched(table, (1.25 + 1e-7, 0.0, 0.0, 0.0), (1.75 + 2e-7, 0.0, 0.0, 0.0))
    world.step(ticks=2400)
    assert int(world.records[0]["ball_hits"]) == 0
    assert world.balls[1].position[0] <= 1.75 + 3e-3
