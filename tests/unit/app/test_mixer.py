"""What pygame's mixer must never be the last to hold, and what may still sound after the music has ended."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
import time
from collections.abc import Iterator

import numpy as np
import pygame
import pytest

from patience import PATIENCE
from silverball.app.sound.mixer import Mixer
from silverball.app.sound.synth import RATE


@pytest.fixture
def mixer(monkeypatch) -> Iterator[Mixer]:
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    mixer = Mixer()
    yield mixer
    mixer.close()


def bar(seconds: float) -> pygame.mixer.Sound:
    return Mixer.music_bar(np.ones((round(seconds * RATE), 2), np.int16))


def until(is_reached) -> None:
    limit = time.monotonic() + PATIENCE
    while not is_reached():
        assert time.monotonic() < limit, "it was not reached"
        time.sleep(0.005)


def test_the_mixer_is_never_the_last_to_hold_a_bar(mixer):
    first, second = bar(0.2), bar(30.0)
    held_by_us = sys.getrefcount(bar(0.1)) + 1
    mixer.play_music(first)
    mixer.queue_music(second)
    assert sys.getrefcount(first) == held_by_us + 2  # the channel and the list
    until(lambda: mixer.music is second)
    assert sys.getrefcount(first) == held_by_us + 1  # the channel has let go of it, the list has not
    mixer.queue_music(bar(0.1))
    assert sys.getrefcount(first) == held_by_us
    assert sys.getrefcount(second) == held_by_us + 2


def test_a_bar_that_another_one_replaces_is_let_go_of(mixer):
    mixer.play_music(bar(30.0))
    for _ in range(20):
        mixer.queue_music(bar(0.1))
    assert len(mixer._bars) == 2


def test_music_that_fades_out_does_not_begin_the_bar_that_waits(mixer):
    waits = bar(30.0)
    mixer.play_music(bar(30.0))
    mixer.queue_music(waits)
    mixer.stop_music(20)
    heard = []
    until(lambda: heard.append(mixer.music) or mixer.music is None)
    assert waits not in heard


def test_closing_while_a_bar_waits_is_silent(mixer):
    for _ in range(5):
        mixer.play_music(bar(0.02))
        mixer.queue_music(bar(0.02))
        time.sleep(0.03)
    mixer.close()
    assert pygame.mixer.get_init() is None


@pytest.mark.parametrize("way", ["play queue", "play queue stop play", "play queue queue stop play queue"])
def test_music_that_begins_anew_while_a_bar_waits_frees_no_sound_that_plays(way):
    """In a process of its own, which would end by a segmentation fault."""
    script = f"""
        import numpy as np
        from silverball.app.sound.mixer import Mixer

        mixer = Mixer()
        samples = np.zeros((11025, 2), np.int16)
        for _ in range(30):
            for step in {way.split()}:
                if step == "stop":
                    mixer.stop_music(300)
                else:
                    getattr(mixer, f"{{step}}_music")(mixer.music_bar(samples))
                cells = [(lambda value: (lambda: value))(number) for number in range(50)]
        mixer.close()
    """
    environment = {**os.environ, "SDL_AUDIODRIVER": "dummy", "SDL_VIDEODRIVER": "dummy"}
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        env=environment,
        capture_output=True,
        timeout=PATIENCE,
    )
    assert done.returncode == 0, done.stderr
