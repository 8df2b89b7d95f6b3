"""By the time a pinched ball was held, its touches had filled the log, and the event that said so was
lost."""

from __future__ import annotations

from boards import LEFT, launched, table_of
from silverball.table import SlantWall


def test_a_jam_is_counted_and_written_down() -> None:
    paddle = LEFT.model_copy(update={"pivot": (0.0, -2.5), "up_angle": 60.0})
    world = launched(table_of(paddle, SlantWall(start=(1.0, -3.0), end=(1.0, 3.0))), (0.5, -1.4, 0.0, 0.0))
    seen = []
    for _ in range(240):
        jams = world.jams
        world.step(left=True)
        written = [event for event in world.events if event.kind == "jam"]
        assert len(written) == min(world.jams - jams, len(written) + world.events_lost)
        assert bool(written) == (world.jams > jams)
        seen += written
    assert seen
    assert all(event.ball == 1 for event in seen)
