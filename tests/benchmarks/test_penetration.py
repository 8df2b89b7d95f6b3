"""Does the monitor see what it is to see, and nothing else?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from silverball.benchmarks.peers import common_tables, random_play
from silverball.benchmarks.peers.penetration import PenetrationMonitor, do_cross, play_monitored
from silverball.benchmarks.peers.playfield import Playfield, Stepping
from silverball.benchmarks.peers.silverball_table import SilverballPlayfield
from silverball.table import load_table

CLASSIC = load_table("classic")
REST = math.radians(-10.0)


class ScriptedPlayfield(Playfield):
    """A playfield whose ball and left paddle jump to given places in each frame."""

    def __init__(self, ways, angles=(REST, REST)):
        super().__init__(common_tables.plain(CLASSIC), Stepping(1))
        self.ways, self.turns = list(ways), list(angles)
        self.here, self.angle, self.taken = self.ways.pop(0), self.turns.pop(0), []

    def step(self, left, right):
        self.here, self.angle = self.ways.pop(0), self.turns.pop(0)

    def finish_frame(self):
        pass

    def add_ball(self, x, z, vx=0.0, vz=0.0):
        raise AssertionError("the ball is never replaced")

    def remove_ball(self, index):
        self.taken.append(index)

    def balls(self):
        return [(*self.here, 0.0, 0.0)]

    def angles(self):
        return self.angle, REST

    @property
    def ball_count(self):
        return 2  # so that the game puts no other


def measured(*ways, angles=(REST, REST)):
    field = ScriptedPlayfield(ways, angles)
    game = random_play.Game(field, np.zeros((1, 2), bool), [(0.0, 0.0)])
    monitor = PenetrationMonitor(field.table)
    escapes = play_monitored(game, len(ways) - 1, monitor)
    return escapes, monitor.depth, field.taken


def test_a_ball_that_stays_clear_is_not_reported():
    assert measured((0.0, 0.0), (-0.2, 0.1)) == (0, 0.0, [])


def test_a_ball_across_a_border_has_escaped_and_is_taken_off():
    assert measured((0.0, 4.5), (0.0, 5.2)) == (1, 0.25, [0])


def test_a_ball_0_1_deep_in_a_border_is_deep_but_has_not_escaped():
    # It touches the right border at 5 − 0.1 − 0.25.
    escapes, depth, _ = measured((0.0, 4.0), (0.0, 4.75))
    assert escapes == 0
    assert depth == pytest.approx(0.1, abs=1e-12)


def test_a_ball_whose_centre_is_in_a_cylinder_has_escaped():
    assert measured((5.0, 0.0), (6.4, 0.3)) == (1, 0.25, [0])


def test_a_ball_that_jumps_through_a_slant_wall_has_escaped():
    start, end = CLASSIC.slant_wall[0].start, CLASSIC.slant_wall[0].end
    middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    nx, nz = CLASSIC.slant_wall[0].inward_normal(CLASSIC.board)
    above, below = ((middle[0] + s * nx, middle[1] + s * nz) for s in (0.4, -0.4))
    assert measured(above, below) == (1, 0.0, [0])


def test_a_ball_that_jumps_through_a_resting_paddle_has_escaped():
    assert measured((-6.8, -1.5), (-8.0, -1.5)) == (1, 0.0, [0])


def test_a_paddle_that_jumps_through_a_resting_ball_has_let_it_escape():
    assert measured((-6.8, -1.5), (-6.8, -1.5), angles=(REST, math.radians(45.0))) == (1, 0.0, [0])


def test_a_ball_that_falls_past_the_tip_has_not_escaped():
    assert measured((-7.0, -0.1), (-7.8, -0.1))[0] == 0


def test_ways_cross_only_where_both_do():
    assert do_cross(((0.0, -1.0), (0.0, 1.0)), ((-1.0, 0.0), (1.0, 0.0)))
    assert not do_cross(((0.0, -1.0), (0.0, -0.5)), ((-1.0, 0.0), (1.0, 0.0)))
    assert not do_cross(((2.0, -1.0), (2.0, 1.0)), ((-1.0, 0.0), (1.0, 0.0)))


def test_silverball_lets_no_ball_in_and_none_out():
    table = common_tables.board(load_table("random"), 3)
    game = random_play.Game(
        SilverballPlayfield(table, Stepping(1)),
        random_play.random_presses(600, 3),
        random_play.free_places(table, 3),
    )
    monitor = PenetrationMonitor(table)
    assert play_monitored(game, 600, monitor) == 0
    assert monitor.depth <= 1e-9
    assert game.field.ball_count == random_play.BALLS
