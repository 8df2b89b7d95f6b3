"""`World.render`, `WorldBatch.render` and `Renderer.render`: pictures of worlds as arrays."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

import silverball as sb


@pytest.fixture
def world():
    world = sb.World("classic", seed=3)
    world.create_ball()
    world.step(left=True, ticks=60)
    return world


def test_a_world_is_drawn_as_rgb_bytes_of_the_height_asked_for(world):
    for height in (160, 161):
        picture = world.render(height=height)
        assert picture.dtype == np.uint8
        assert picture.shape == (height, 100, 3)
        assert picture.flags.writeable
        assert picture.std() > 10


def test_the_picture_depends_on_the_state_alone(world):
    twin = world.copy()
    picture = world.render(height=160)
    world.step(ticks=30)
    assert (world.render(height=160) != picture).any()
    assert (twin.render(height=160) == picture).all()


def test_a_renderer_without_events_draws_what_the_world_draws(world):
    renderer = sb.Renderer(world.table, height=160, theme="clear")
    assert (renderer.render(world) == world.render(height=160, theme="clear")).all()


def test_a_world_of_a_batch_is_drawn_like_the_single_world_of_its_seed():
    batch, world = sb.WorldBatch("random", 3, seed=5, tick_rate=60), sb.World("random", seed=6, tick_rate=60)
    batch.create_balls()
    world.create_ball()
    batch.step(np.zeros((3, 3), bool), ticks=30)
    world.step(ticks=30)
    assert (batch.render(1, height=160) == world.render(height=160)).all()
    assert (batch.render(2, height=160) != world.render(height=160)).any()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"theme": "dark"}, "neon, parlour, clear, or a Theme, got 'dark'"),
        ({"height": 1}, "height must be at least 2"),
        ({"size": (0, 5)}, "size must be at least 1 by 1"),
        ({"size": (5, 5), "height": 5}, "either size or height"),
    ],
)
def test_a_renderer_refuses_what_it_cannot_draw(world, options, words):
    with pytest.raises(ValueError, match=words):
        sb.Renderer(world.table, **options)


def test_no_display_is_needed():
    program = "import silverball as sb; assert sb.World('classic').render(height=160).shape == (160, 100, 3)"
    hidden = ("DISPLAY", "WAYLAND_DISPLAY")
    env = {key: value for key, value in os.environ.items() if key not in hidden}
    result = subprocess.run(
        [sys.executable, "-c", program], env=env | {"SDL_VIDEODRIVER": "no such driver"}, check=False
    )
    assert result.returncode == 0
