"""The window of `render_mode="human"`."""

from __future__ import annotations

import os
import subprocess
import sys

import gymnasium as gym
import pytest
from gymnasium.utils.env_checker import check_env

import silverball as sb
from silverball.drawing.text import lettering
from silverball.envs import IDS, PinballEnv, PinballVectorEnv
from silverball.errors import NoDisplay
from silverball.table import load_table

CLASSIC = "silverball/PinballClassic-v0"
FEW = {"boards": 4}


def options_of(id_: str) -> dict:
    return {} if id_ == CLASSIC else FEW


@pytest.fixture
def _blind(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


@pytest.mark.usefixtures("_blind")
@pytest.mark.filterwarnings("error", "ignore:.*out of date:DeprecationWarning")
@pytest.mark.parametrize("mode", [None, "human", "rgb_array"])
@pytest.mark.parametrize("id_", IDS)
def test_gymnasiums_checker_accepts_every_render_mode(id_, mode):
    env = gym.make(id_, render_mode=mode, tick_rate=10_000, **options_of(id_))
    assert isinstance(env, PinballEnv), "no wrapper shows it"
    check_env(env)
    env.close()


@pytest.mark.usefixtures("_blind")
def test_in_the_human_mode_a_window_shows_every_step_and_nothing_else_differs():
    env, quiet = gym.make(CLASSIC, render_mode="human", tick_rate=10_000), gym.make(CLASSIC, tick_rate=10_000)
    env.reset(seed=0), quiet.reset(seed=0)
    window = env.unwrapped._screen._window
    shown = []
    for action in (3, 3, 0, 1, 2) * 20:
        assert env.step(action)[0].tolist() == quiet.step(action)[0].tolist()
        shown.append(bytes(window.get_surface().get_view("2").raw))
    assert len(set(shown)) > 50
    assert env.render() is None
    env.close()


@pytest.mark.usefixtures("_blind")
def test_closing_one_of_two_windows_keeps_the_other_open_and_key_events_unread():
    import pygame

    first, second = (gym.make(CLASSIC, render_mode="human", tick_rate=10_000) for _ in range(2))
    first.reset(seed=0), second.reset(seed=0)
    pygame.event.clear()
    pygame.event.post(pygame.Event(pygame.WINDOWCLOSE, window=second.unwrapped._screen._window))
    pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_a))
    first.step(0), second.step(0)
    assert not first.unwrapped._screen.is_closed
    assert second.unwrapped._screen.is_closed
    assert [event.key for event in pygame.event.get(pygame.KEYDOWN)] == [pygame.K_a]
    first.close(), second.close()


@pytest.mark.usefixtures("_blind")
def test_an_environment_goes_on_after_its_window_was_closed():
    import pygame

    env = gym.make(CLASSIC, render_mode="human", tick_rate=10_000)
    env.reset(seed=0)
    pygame.event.post(pygame.Event(pygame.QUIT))
    for _ in range(3):
        env.step(0)
    assert env.unwrapped._screen.is_closed
    env.close()
    env.close()


@pytest.mark.usefixtures("_blind")
def test_quitting_pygame_closes_windows_but_does_not_break_pictures():
    import pygame

    shown, drawn = (gym.make(CLASSIC, render_mode=mode) for mode in ("human", "rgb_array"))
    shown.reset(seed=0), drawn.reset(seed=0)
    before = drawn.render()
    pygame.quit()
    shown.step(0)
    assert shown.unwrapped._screen.is_closed
    again = gym.make(CLASSIC, render_mode="rgb_array", table=load_table("classic"))
    again.reset(seed=0)
    lettering.cache_clear()
    assert (again.render() == before).all()


def test_without_a_display_the_human_mode_says_what_needs_none():
    script = (
        "import gymnasium, silverball.envs, silverball\n"
        "try: gymnasium.make('silverball/PinballClassic-v0', render_mode='human').reset(seed=0)\n"
        "except silverball.errors.NoDisplay as error: print(error)\n"
    )
    without = {
        k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    }
    done = subprocess.run(
        [sys.executable, "-c", script], env=without, capture_output=True, text=True, check=True
    )
    assert "no display" in done.stdout
    assert 'render_mode="rgb_array"' in done.stdout
    assert issubclass(NoDisplay, sb.SilverballError)


def test_many_environments_have_no_human_mode():
    with pytest.raises(ValueError, match="render_mode must be 'rgb_array'"):
        PinballVectorEnv(2, render_mode="human", table="classic")
