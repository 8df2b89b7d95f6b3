"""The feel of a table: windows of shots, and the targets that the built-in tables meet."""

from __future__ import annotations

import math

import numpy as np
import pytest

from boards import CLASSIC, PADDLES, full_table, mirrored, table_of
from silverball.metrics.feel import hits_of, measure, shares_of_cylinders, shots_as_dict
from silverball.metrics.game_traces import TICK_RATE, play_games
from silverball.metrics.shots import SHOT, Aim, Shots, shots_of
from silverball.physics.records import records
from silverball.table import Cylinder, load_table
from silverball.world import WorldBatch

AIMS = (Aim.LEFT, Aim.MIDDLE, Aim.RIGHT)


def shots_with(aims: str) -> Shots:
    """Shots of these aims, one a tick; all of them left the paddle."""
    letters = {".": Aim.NOWHERE, "L": Aim.LEFT, "M": Aim.MIDDLE, "R": Aim.RIGHT}
    shot = records(len(aims), SHOT)
    shot["launched"] = 1
    return Shots("left", False, shot, np.array([letters[letter] for letter in aims]), (), 8.0)


def test_a_window_is_the_longest_run_of_presses_without_a_gap() -> None:
    shots = shots_with("LL.LLL.M.RRRR")
    tick_ms = 1000.0 / TICK_RATE
    assert shots.window(Aim.LEFT) == (3 * tick_ms, 3 * tick_ms)
    assert shots.window(Aim.MIDDLE) == (1 * tick_ms, 7 * tick_ms)
    assert shots.window(Aim.RIGHT) == (4 * tick_ms, 9 * tick_ms)
    width, since = shots_with("LLL").window(Aim.RIGHT)
    assert width == 0.0
    assert math.isnan(since)


@pytest.mark.parametrize("held", [False, True])
def test_the_shots_of_the_right_paddle_are_those_of_the_left_one_in_the_mirror(held: bool) -> None:
    table = CLASSIC.model_copy(update={"triangular_prism": (), "cylinder": ()})
    left, right = shots_of(table, "left", held), shots_of(mirrored(table), "right", held)
    assert left is not None
    assert right is not None
    assert left.shot["launched"].sum() > 50
    # Mirror images, to rounding that some bounces on the paddle enlarge.
    same = left.shot["launched"] & right.shot["launched"] & (left.shot["speed"] > 15.0)
    np.testing.assert_allclose(
        left.shot["direction"][same == 1], -right.shot["direction"][same == 1], atol=1e-3
    )


def test_a_late_press_sends_the_ball_further_across_than_an_early_one() -> None:
    shots = shots_of(
        load_table("classic").model_copy(update={"triangular_prism": (), "cylinder": ()}), "left", True
    )
    assert shots is not None
    directions = shots.directions()
    early, late = np.array_split(directions, 2)
    assert np.median(late) > np.median(early) + 10.0


def test_without_a_guide_or_a_paddle_there_are_no_shots() -> None:
    assert shots_of(table_of(*PADDLES), "left", False) is None
    assert shots_of(table_of(CLASSIC.slant_wall[0], PADDLES[0]), "right", False) is None


@pytest.fixture(scope="module", params=["classic", "original", "random", "rolling"])
def feel(request):
    return measure(load_table(request.param), 120, seed=1, players=("idle", "reflex"))


def test_an_idle_ball_lasts_some_seconds_on_a_built_in_table(feel) -> None:
    least = 4.0 if feel.table.name == "Original" else 5.0  # that one has the brief's numbers and is not tuned
    assert least < feel.players["idle"].figures["seconds_per_ball"].value < 15.0


def test_a_reflex_ball_lasts_30_to_90_seconds_on_a_built_in_table(feel) -> None:
    assert 30.0 < feel.players["reflex"].figures["seconds_per_ball"].value < 90.0


def test_no_ball_stays_in_one_place_for_5_seconds_on_a_built_in_table(feel) -> None:
    for found in feel.players.values():
        assert found.figures["share_stuck"].value == 0.0
        assert found.cut_short == 0


def test_struck_balls_reach_the_top_and_every_cylinder_of_a_built_in_table(feel) -> None:
    found = feel.players["reflex"]
    assert found.figures["strikes_to_top"].low > 0.05
    assert all(figure.low > 0.0 for figure in found.cylinders.values())


def test_shots_to_the_left_middle_and_right_have_time_enough_on_a_built_in_table(feel) -> None:
    assert len(feel.shots) == 4
    for shots in feel.shots:
        assert all(shots.window(aim)[0] >= 25.0 for aim in AIMS), shots_as_dict(shots)["windows_ms"]


def test_the_hits_of_a_kind_are_those_of_its_parts_on_each_board() -> None:
    batch = WorldBatch([full_table(), CLASSIC, full_table()], 3)
    hits = np.arange(batch.tallies.size).reshape(batch.tallies.shape) * (
        np.arange(batch.tallies.shape[1])
        < np.array([len(batch.boards.names[row]) for row in batch.board_of])[:, None]
    )
    for kind in ("slant_wall", "triangular_prism", "cylinder"):
        expected = [
            sum(
                int(count)
                for name, count in zip(batch.boards.names[board], row, strict=False)
                if name.partition("[")[0] == kind
            )
            for row, board in zip(hits, batch.board_of, strict=True)
        ]
        assert hits_of(batch, hits, kind).tolist() == expected
        assert sum(expected) > 0


def test_cylinders_are_found_by_name_on_boards_with_other_numbers_of_parts() -> None:
    few = table_of(*PADDLES, Cylinder(center=(2.0, 0.0), radius=0.6, name="only"))
    games = play_games(WorldBatch([few, full_table()], 2, 0, TICK_RATE), "idle", longest=0.1)
    batch = WorldBatch([few, full_table()], 2, 0, TICK_RATE)
    games.reached[:] = 0
    games.game["strikes"] = 10
    for row, board in enumerate(batch.board_of):
        games.reached[row, batch.boards.names[board].index("cylinder[0]")] = 5
    assert shares_of_cylinders(batch, games)["only"].value == 0.5
