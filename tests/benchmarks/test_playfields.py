"""The peers' tables obey the same laws as ours, as well as their engines can."""

from __future__ import annotations

import math

import pytest

from silverball.benchmarks.peers import accuracy, common_tables, random_play
from silverball.benchmarks.peers.engines import FINE, OWN, PEERS, Entry
from silverball.benchmarks.peers.penetration import PenetrationMonitor, play_monitored
from silverball.benchmarks.peers.playfield import Stepping
from silverball.table import Table, load_table
from silverball.table.parts import Board

RANDOM = load_table("random")
OWN_ENTRY = OWN[0]


def entry_of(engine) -> Entry:
    pytest.importorskip(engine.imported)
    return engine.entries()[0]


@pytest.fixture(params=["Silverball", *PEERS], ids=lambda param: getattr(param, "name", param))
def entry(request) -> Entry:
    return OWN_ENTRY if request.param == "Silverball" else entry_of(request.param)


def stepped_finely(entry: Entry) -> Entry:
    return entry._replace(stepping=Stepping(FINE, entry.stepping.substeps))


def test_ten_seconds_of_random_play_keep_two_balls_on_the_board(entry):
    table = common_tables.board(RANDOM, 1)
    press, places = random_play.random_presses(600, 1), random_play.free_places(table, 1)
    game = random_play.Game(entry.build(table), press, places)
    game.run(600)
    assert game.field.ball_count == 2
    for x, z, vx, vz in game.field.balls():
        assert table.board.gutter - 1 < x < table.board.length / 2
        assert abs(z) < table.board.width / 2
        assert math.hypot(vx, vz) <= table.board.speed_cap + 1e-3  # Box2D reckons in single precision


def test_watching_changes_nothing_in_play(entry):
    table = common_tables.board(RANDOM, 2)
    press, places = random_play.random_presses(120, 2), random_play.free_places(table, 2)
    played = random_play.Game(entry.build(table), press, places)
    played.run(120)
    watched = random_play.Game(entry.build(table), press, places)
    assert play_monitored(watched, 120, PenetrationMonitor(table)) == 0
    assert watched.field.balls() == played.field.balls()
    assert watched.field.angles() == played.field.angles()


def test_a_free_ball_falls_by_the_law_of_free_fall(entry):
    # Stepping by h with the new velocity, as the peers do, lands ½·g·t·h too low after t.
    fine = stepped_finely(entry)
    field = fine.build(Table())
    field.add_ball(5.0, 1.0, 0.0, -0.5)
    for _ in range(30):
        field.frame(False, False)
    x, z, vx, vz = field.balls()[0]
    most = 0.5 * 10.0 * 0.5 * fine.stepping.step * 1.05
    assert x == pytest.approx(5.0 - 0.5 * 10.0 * 0.5**2, abs=most)
    assert z == pytest.approx(1.0 - 0.25, abs=1e-3)
    assert (vx, vz) == pytest.approx((-5.0, -0.5), abs=1e-3)


def test_a_ball_comes_back_from_the_side_with_the_share_of_the_restitution(entry):
    field = stepped_finely(entry).build(common_tables.plain(Table(board=Board(wall_restitution=0.6))))
    field.add_ball(5.0, 3.65, 0.0, 10.0)  # a unit before the right border
    for _ in range(12):
        field.frame(False, False)
    assert field.balls()[0][3] == pytest.approx(-6.0, rel=0.01)


def test_two_balls_that_meet_head_on_leave_with_the_share_of_the_restitution(entry):
    table = common_tables.plain(Table(board=Board(wall_restitution=0.6)))
    assert table.board.ball_restitution == 0.6
    field = stepped_finely(entry).build(table)
    field.add_ball(5.0, -1.0, 0.0, 5.0)
    field.add_ball(5.0, 1.0, 0.0, -5.0)
    for _ in range(15):
        field.frame(False, False)
    left, right = field.balls()
    assert right[3] - left[3] == pytest.approx(6.0, rel=0.01)
    assert right[3] + left[3] == pytest.approx(0.0, abs=0.01)


def test_paddles_rise_in_the_time_of_a_stroke_and_stop_there_mirrored(entry):
    table = common_tables.board(RANDOM, 0)
    field = stepped_finely(entry).build(table)
    rest, up = math.radians(table.paddle[0].rest_angle), math.radians(table.paddle[0].up_angle)
    assert field.angles() == pytest.approx((rest, rest), abs=1e-6)
    for _ in range(3):  # half of a stroke of 0.1 s
        field.frame(True, False)
    assert field.angles() == pytest.approx(((rest + up) / 2, rest), abs=0.01)
    for _ in range(9):
        field.frame(True, True)
    assert field.angles() == pytest.approx((up, up), abs=2e-4)
    for _ in range(12):
        field.frame(False, True)
    assert field.angles() == pytest.approx((rest, up), abs=2e-4)


def test_a_paddle_whose_stroke_is_no_whole_number_of_steps_ends_at_its_stop_all_the_same(entry):
    table = common_tables.board(RANDOM, 0)
    odd = tuple(paddle.model_copy(update={"stroke": 0.0731}) for paddle in table.paddle)
    field = entry.build(table.model_copy(update={"paddle": odd}))
    up = math.radians(odd[0].up_angle)
    for _ in range(6):
        field.frame(True, True)
        assert max(field.angles()) < up + 2e-4
    assert field.angles() == pytest.approx((up, up), abs=2e-4)


def test_a_rising_paddle_throws_a_ball_up_on_either_side(entry):
    table = common_tables.board(RANDOM, 0)
    for side in (-1.0, 1.0):
        field = stepped_finely(entry).build(table)
        field.add_ball(-6.9, side * 1.2)
        for _ in range(6):
            field.frame(side < 0.0, side > 0.0)
        assert field.balls()[0][2] > 3.0


def test_a_ball_below_the_gutter_is_gone_after_the_frame(entry):
    field = entry.build(Table())
    field.add_ball(-8.7, 0.0, -10.0, 0.0)
    field.add_ball(5.0, 0.0)
    for _ in range(6):
        field.frame(False, False)
    assert field.ball_count == 1
    assert field.balls()[0][0] > 4.0


def test_a_ball_that_is_taken_is_gone_and_the_other_stays(entry):
    field = entry.build(Table())
    field.add_ball(5.0, -1.0)
    field.add_ball(5.0, 1.0)
    field.remove_ball(0)
    assert field.ball_count == 1
    assert field.balls()[0][1] == pytest.approx(1.0)


def test_silverball_keeps_its_energy_on_the_elastic_table():
    table = common_tables.board(RANDOM, 0)
    closed = common_tables.elastic(table)
    assert common_tables.min_restitution(closed) == 1.0
    assert accuracy.drift(OWN_ENTRY.build(closed), accuracy.drift_start(table), 60) < 1e-13


def test_drift_is_the_share_of_energy_that_is_missing():
    # On an elastic table whose walls return half of the speed, energy must go.
    table = common_tables.board(RANDOM, 0)
    closed = common_tables.elastic(table)
    dull = closed.model_copy(update={"board": closed.board.model_copy(update={"wall_restitution": 0.5})})
    assert 0.05 < accuracy.drift(OWN_ENTRY.build(dull), accuracy.drift_start(table), 60) < 1.0
