"""Copies of a world are independent, and a world refuses arguments that it cannot use."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import silverball as sb


@pytest.fixture
def world():
    world = sb.World("classic", seed=3)
    world.create_ball()
    world.step(left=True, ticks=100)
    return world


@pytest.mark.parametrize(
    "copied",
    [sb.World.copy, copy.copy, copy.deepcopy, lambda world: pickle.loads(pickle.dumps(world))],
    ids=["World.copy", "copy.copy", "copy.deepcopy", "pickle"],
)
def test_a_copy_continues_exactly_like_its_original_and_leaves_it_alone(world, copied):
    before = world.digest()
    other = copied(world)
    assert (other.digest(), other.hits) == (before, world.hits)
    other.step(right=True, ticks=50)
    assert world.digest() == before
    world.step(right=True, ticks=50)
    assert other.digest() == world.digest()


def test_a_copied_batch_goes_its_own_way():
    batch = sb.WorldBatch("classic", 3)
    batch.create_balls()
    other = copy.deepcopy(batch)
    other.step(np.zeros((3, 3), bool), ticks=10)
    assert (batch.state["tick"].tolist(), other.state["tick"].tolist()) == ([0] * 3, [10] * 3)


def test_a_world_takes_a_path_as_well_as_a_name(tmp_path):
    path = Path(tmp_path) / "mine.toml"
    sb.save_table(sb.load_table("classic"), path)
    assert sb.World(path).digest() == sb.World("classic").digest()


@pytest.mark.parametrize("table", [5, None, ["classic"], object()])
def test_what_is_no_table_is_refused_in_words(table):
    with pytest.raises(TypeError, match="must be a Table"):
        sb.World(table)


def test_a_ball_can_be_put_where_another_was_reported(world):
    place = world.balls[0].position
    assert sb.World("classic").create_ball(position=place).position == place
    with pytest.raises(ValueError, match="y = 1"):
        sb.World("classic").create_ball(position=(place[0], 2.0, place[2]))


def test_a_velocity_without_a_position_is_refused(world):
    with pytest.raises(ValueError, match="needs a position"):
        world.create_ball(velocity=(5.0, 0.0))


def test_the_seed_is_that_of_the_state():
    world, other = sb.World("classic", seed=1), sb.World("classic", seed=2)
    world.restore(other.save())
    assert world.seed == 2


def test_equal_places_have_equal_digests_whatever_the_sign_of_their_zeros():
    worlds = [sb.World("classic"), sb.World("classic")]
    worlds[0].create_ball(position=(0.0, 0.0))
    worlds[1].create_ball(position=(0.0, -0.0))
    assert worlds[0].digest() == worlds[1].digest()


def test_parts_that_make_no_sense_are_refused_with_their_paths():
    prism = sb.load_table("classic").triangular_prism[0]
    flat = prism.model_copy(update={"vertices": ((0.0, 0.0), (1.0, 1.0), (2.0, 2.0))})
    wall = sb.load_table("classic").slant_wall[0]
    point = wall.model_copy(update={"end": wall.start})
    table = sb.load_table("classic").model_copy(
        update={"slant_wall": (wall, point), "triangular_prism": (flat,)}
    )
    with pytest.raises(sb.TableError) as refusal:
        sb.World(table)
    assert [problem.path for problem in refusal.value.problems] == ["slant_wall[1]", "triangular_prism[0]"]
