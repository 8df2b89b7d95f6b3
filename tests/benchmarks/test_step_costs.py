"""The benchmark of the places where the step could be slow measures what it says."""

from __future__ import annotations

from silverball.benchmarks import step_costs
from silverball.table import check_table
from silverball.world import World


def test_the_crowded_table_is_a_good_table_of_202_parts() -> None:
    table = step_costs.crowded_table()
    assert check_table(table) == []
    world = World(table)
    assert len(world.hits) == 3 + 2 + 2 + 195
    world.create_ball()


def test_every_case_runs_and_takes_time() -> None:
    for name, case in step_costs._cases().items():
        assert 0.0 < case() < 1.0, name


def test_figures_have_a_name_a_size_and_a_unit(monkeypatch) -> None:
    monkeypatch.setattr(step_costs, "WORLDS", 64)
    monkeypatch.setattr(step_costs, "MANY_WORLDS", 64)
    monkeypatch.setattr(step_costs, "STARTS", 1)
    monkeypatch.setattr(step_costs, "_starts", list)
    seen = []
    figures = step_costs.measure_step_costs(1, seen.append)
    assert {"two balls", "one world", "starting"} <= set(seen)
    assert all(figure.value > 0.0 and figure.unit for figure in figures)
    assert len({figure.name for figure in figures}) == len(figures) == 7 + 3 + 2
