"""Boards of all kinds of parts in the soak: what they are made of, and what the checks find on them."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

from boards import table_of
from holed import hide_from_the_solver, options_of
from silverball.physics.records import NOTHING, Device, EventKind
from silverball.soak import rounds as soak_module
from silverball.soak.campaign import soak
from silverball.soak.checks import Found, check_places
from silverball.soak.crossings import has_changed_course
from silverball.soak.finding import Finding, reproduce
from silverball.soak.hostile_parts import hostile_part_table
from silverball.soak.part_boards import SECTION, part_table
from silverball.soak.regions import MAIN_REGION
from silverball.soak.rounds import SoakBatch, has_problems, play_round, round_batch
from silverball.table import SlantWall, Table, check_table, dump_table, load_table
from silverball.table.kinds import DropTarget, Gate, Hole, Level, Passage, Plunger, Rollover, Spinner, Wall
from silverball.table.table import RULE_SECTIONS
from silverball.world import WorldBatch

LINE = Rollover(start=(2.0, -2.0), end=(2.0, 2.0))
DISC = Rollover(center=(2.0, 0.0), radius=0.6)
GATE = Gate(start=(2.0, -2.0), end=(2.0, 2.0), passes="up")
FALLING = (4.05, 0.1, -10.0, 0.0)


def still(table, *balls, tick_rate: int = 60, hostile: bool = False) -> SoakBatch:
    """One quiet world with balls (x, z, vx, vz), in which nothing is done for a minute."""
    soaked = SoakBatch([table], [0], tick_rate, hostile, [False])
    soaked.drivers.states["create_at"] = 2**60
    for slot, values in enumerate(balls):
        ball = soaked.batch.state["ball"][0, slot]
        ball["x"], ball["z"], ball["vx"], ball["vz"], ball["id"] = *values, slot + 1
        if "passed_row" in ball.dtype.names:  # not in plain worlds
            ball["passed_row"] = NOTHING
    soaked.batch.state["created"] = len(balls)
    return soaked


def first_shape(soaked: SoakBatch) -> int:
    """The row of the first stationary shape of the only board."""
    return int(soaked.batch.boards.board["shape_first"][0])


def found(soaked: SoakBatch) -> Found:
    return Found(int(soaked.watches.states["found"][0]))


def kinds_of(*tables: Table) -> set[str]:
    return {section for section in SECTION.values() for table in tables if getattr(table, section)}


# What they are made of


@pytest.mark.parametrize("seed", range(8))
def test_a_random_table_of_all_parts_is_valid_and_the_same_for_the_same_seed(seed: int) -> None:
    table = part_table(seed)
    assert table == part_table(seed) != part_table(seed + 1)
    assert [problem for problem in check_table(table) if problem.is_error] == []
    assert Table.model_validate(tomllib.loads(dump_table(table))) == table


@pytest.mark.parametrize("seed", range(8))
def test_a_hostile_table_of_all_parts_can_be_written_and_read(seed: int) -> None:
    table = hostile_part_table(seed)
    assert table == hostile_part_table(seed) != hostile_part_table(seed + 1)
    assert check_table(table) != []
    assert Table.model_validate(tomllib.loads(dump_table(table))) == table


def test_every_kind_of_part_comes_up() -> None:
    kinds = set(SECTION.values()) - set(RULE_SECTIONS)
    assert kinds_of(*map(part_table, range(30))) == kinds
    assert kinds_of(*map(hostile_part_table, range(40))) == kinds


def test_half_of_the_boards_of_a_round_are_of_all_parts_where_that_is_asked_for() -> None:
    options = options_of(worlds=8)._replace(parts=True)
    names = [table.name for table in round_batch(options, 0).tables]
    assert {name.split()[0] for name in names[:4]} == {"Random"}
    assert {name.split()[0] for name in names[4:]} == {"Parts"}
    alone = round_batch(options, 0, 5)
    assert alone.tables[0].name == names[5]
    assert alone.watches.hostile.tolist() == [True]
    assert options.as_dict() != options_of(worlds=8).as_dict()


# What the checks find


@pytest.mark.parametrize("part", [LINE, DISC])
def test_a_sensor_that_a_broken_solver_does_not_see_is_reported(part) -> None:
    sound, broken = (still(table_of(part), FALLING) for _ in range(2))
    hide_from_the_solver(broken.batch, first_shape(broken))
    sound.run(40)
    broken.run(40)
    assert sound.batch.tallies[0, -1] == 1
    assert (found(sound), found(broken)) == (Found.NOTHING, Found.MISSED)


@pytest.mark.parametrize("drag", [0.0, 1.0])
def test_a_ball_that_a_spinner_slows_is_off_its_course(drag: float) -> None:
    """It may stop on the spinner's line, and fall back without a second crossing."""
    spinner = Spinner(start=(2.0, -2.0), end=(2.0, 2.0), drag=drag)
    soaked = still(table_of(spinner), (2.05, 0.1, -10.0, 0.0))
    soaked.run(1)
    log, truth = soaked.batch.logs[0], soaked.truth(0)
    assert EventKind.PASS in log["event"]["kind"][: log["count"]]
    assert has_changed_course(log, truth.board, truth.colliders, 1) == (drag > 0.0)
    assert found(soaked) == Found.NOTHING


def test_a_crossing_at_another_place_is_reported() -> None:
    soaked = still(table_of(LINE), FALLING)
    soaked.batch.boards.collider[first_shape(soaked)]["x0"] += 0.01
    soaked.batch.boards.collider[first_shape(soaked)]["x1"] += 0.01
    soaked.run(40)
    assert found(soaked) == Found.PHANTOM


def test_a_one_way_gate_that_a_broken_solver_lets_through_is_reported() -> None:
    sound, broken, passing = (still(table_of(GATE, gravity=1.0), FALLING) for _ in range(3))
    hide_from_the_solver(broken.batch, first_shape(broken))
    passing.batch.state["ball"]["x"][0, 0], passing.batch.state["ball"]["vx"][0, 0] = 1.0, 15.0
    for soaked in (sound, broken, passing):
        soaked.run(20)
    assert sound.batch.tallies[0, -1] == 1
    assert [found(one) for one in (sound, broken, passing)] == [Found.NOTHING, Found.PASSAGE, Found.NOTHING]
    assert passing.batch.state["ball"]["x"][0, 0] > 3.0


@pytest.mark.parametrize(
    ("off", "level", "kind"), [(0, 0, Found.PENETRATION), (1, 0, Found.NOTHING), (0, 1, Found.NOTHING)]
)
def test_a_ball_may_be_where_a_target_has_fallen_or_is_on_another_level(off, level, kind) -> None:
    target = DropTarget(start=(2.0, -1.0), end=(2.0, 1.0))
    above = SlantWall(start=(5.0, 3.0), end=(6.0, 3.0), level=1)
    soaked = still(table_of(target, above), (2.0, 0.0, 0.0, 0.0), hostile=True)
    soaked.batch.state["off"], soaked.batch.state["ball"]["level"][0, 0] = off, level
    soaked.watches.states["tracker"]["region"][0, 0] = MAIN_REGION
    check_places(soaked.batch.state[0], soaked.truth(0), soaked.watches.states[0])
    assert found(soaked) == kind


def test_a_ball_that_a_hole_or_a_passage_brings_elsewhere_has_not_escaped() -> None:
    cage = [
        ((-1.0, -1.0), (1.0, -1.0)),
        ((1.0, -1.0), (1.0, 1.0)),
        ((1.0, 1.0), (-1.0, 1.0)),
        ((-1.0, 1.0), (-1.0, -1.0)),
    ]
    walls = [SlantWall(start=start, end=end) for start, end in cage]
    hole = Hole(center=(4.0, 0.0), radius=0.4, hold=0.1, exit=(0.0, 0.0), exit_velocity=(3.0, 2.0))
    held = still(table_of(*walls, hole), (5.0, 0.0, -1.0, 0.0))
    held.run(120)
    assert found(held) == Found.NOTHING
    assert abs(held.batch.state["ball"]["x"][0, 0]) < 1.0
    thrown = still(table_of(*walls), (5.0, 0.0, -1.0, 0.0))
    thrown.run(1)
    thrown.batch.state["ball"]["x"][0, 0] = 0.0
    thrown.run(1)
    assert found(thrown) == Found.ESCAPE
    up = Passage.model_validate({"start": (4.0, 2.0), "end": (4.0, -2.0), "from": 1, "to": 0})
    level = still(
        table_of(*(wall.replace(level=1) for wall in walls), up, Level(number=1)), (5.0, 0.0, -1.0, 0.0)
    )
    level.run(120)
    assert found(level) == Found.NOTHING


# How they are played


def test_all_buttons_are_pressed_and_gates_move() -> None:
    gate = Gate(start=(3.0, -1.0), end=(3.0, 1.0), held=True, name="gate")
    table = table_of(gate, Plunger(position=(0.0, 0.0)), max_balls=8, gravity=0.5)
    soaked = SoakBatch([table], [0], 60, False, [True])
    seen, off, balls = set(), set(), 0
    for _ in range(2400):
        soaked.run(1)
        action = soaked.drivers.actions[0]
        seen |= {name for name in ("left", "right", "shove", "launch", "gates", "create") if action[name]}
        off.add(int(soaked.batch.state["off"][0]))
        balls = max(balls, int((soaked.batch.state["ball"]["id"][0] != 0).sum()))
    assert seen == {"left", "right", "shove", "launch", "gates", "create"}
    assert off == {0, 1}
    assert balls == 8
    assert found(soaked) == Found.NOTHING


@pytest.mark.parametrize("hostile", [False, True])
def test_a_short_soak_of_all_parts_finds_nothing(short_rounds, hostile: bool) -> None:
    options = options_of(hostile, worlds=32, seed=11)._replace(parts=True)
    totals, places = play_round(options, 0)
    assert places == []
    assert totals.hits > 3000


def test_the_built_in_table_of_all_parts_is_sound(short_rounds) -> None:
    totals, places = play_round(options_of(worlds=8)._replace(recipe=load_table("parts")), 0)
    assert places == []
    assert totals.hits > 1000


class Blind(WorldBatch):
    """Worlds whose solver knows nothing of the rollovers of its boards."""

    def __init__(self, *arguments, **options) -> None:
        super().__init__(*arguments, **options)
        for row in np.nonzero(self.boards.collider["role"] == Device.SENSOR)[0]:
            hide_from_the_solver(self, int(row))


def test_a_finding_with_launches_is_recorded_and_reproduced(short_rounds, monkeypatch, tmp_path) -> None:
    options = options_of()._replace(recipe=load_table("parts"))
    with monkeypatch.context() as broken:
        broken.setattr(soak_module, "WorldBatch", Blind)
        log = soak(options, 1, tmp_path / "soak.json")
        assert log.totals.found["missed"] == sum(log.totals.found.values()) > 0
        findings = [Finding.from_text((tmp_path / name).read_text(), name) for name in log.findings]
        assert {reproduce(finding) for finding in findings} == {Found.MISSED}
        assert all(Finding.from_text(finding.to_text(), "") == finding for finding in findings)
    assert {reproduce(finding) for finding in findings} == {Found.NOTHING}
    assert any(type(action[4]) is int for finding in findings for action in finding.actions)


def test_a_ball_may_lie_still_on_a_table_of_which_the_check_has_warned() -> None:
    """On one without warnings it is stuck."""
    cup = Wall(points=((1.0, -0.5), (0.0, -0.5), (0.0, 0.5), (1.0, 0.5)))
    for parts, is_warned in (((cup,), True), ((), False)):
        table = load_table("classic").replace(format=2, wall=parts)
        options = options_of(worlds=2)._replace(recipe=table)
        assert has_problems(table) == is_warned
        assert round_batch(options, 0).watches.hostile.tolist() == [is_warned]
