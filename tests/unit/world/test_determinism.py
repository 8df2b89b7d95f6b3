"""The same games give the same bits, however they are run.

A ladder of ways to run them, from the most similar to the most different. On every rung there are several
boards, two balls, random paddles and jitter (see `scenes.py`).
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import scenes
from patience import PATIENCE
from scenes import BEAT, SHORT, batch_of, buttons_of, create, digests_in_a_batch, played
from silverball.world import World


@pytest.fixture(scope="module")
def digests() -> list[str]:
    """The digest of each short scene, played alone, in this process."""
    return [played(scene).digest() for scene in SHORT]


def test_the_games_differ_from_each_other_and_from_their_beginnings(digests):
    """Else the equalities below would say nothing."""
    beginnings = [scene.world().digest() for scene in SHORT]
    assert len({*digests, *beginnings}) == 2 * len(SHORT)


# --- in this process -------------------------------------------------------------------------------------


def test_the_same_game_again_gives_the_same_bits(digests):
    assert [played(scene).digest() for scene in SHORT] == digests


def test_a_state_restored_at_every_tick_goes_on_with_the_same_bits(digests):
    for scene, expected in zip(SHORT, digests, strict=True):
        rng = random.Random(0)
        stray = World(scene.table(), 99, scene.tick_rate)  # its own game is overwritten at every tick
        state = scene.world().save()
        for tick, (left, right, jitter, launch) in enumerate(scene.buttons().tolist()):
            stray.restore(state)
            if tick % BEAT == 0:
                create(stray)
            stray.step(left, right, jitter, launch=launch)
            state = stray.save()
            stray.step(rng.random() < 0.5, rng.random() < 0.5, True, launch=rng.random() < 0.5)
        stray.restore(state)
        assert stray.digest() == expected


def test_a_snapshot_of_a_batch_restored_at_every_tick_goes_on_with_the_same_bits(digests):
    batch, held = batch_of(SHORT), buttons_of(SHORT)
    snapshot = batch.save()
    for tick, rows in enumerate(held):
        batch.restore(snapshot)
        if tick % BEAT == 0:
            batch.create_balls()
        batch.step(rows)
        snapshot = batch.save()
        batch.step(~rows, ticks=3)
    assert snapshot.digests() == digests


def test_worlds_that_change_places_at_every_tick_go_on_with_the_same_bits(digests):
    rng = np.random.default_rng(0)
    batch, held = batch_of(SHORT), buttons_of(SHORT)
    at = np.arange(len(SHORT))  # where each scene is now
    for tick, rows in enumerate(held):
        snapshot = batch.save(at)
        at = rng.permutation(len(SHORT))
        batch.restore(snapshot, at)
        if tick % BEAT == 0:
            batch.create_balls()
        actions = np.zeros_like(rows)
        actions[at] = rows
        batch.step(actions)
    assert batch.save(at).digests() == digests


def test_many_ticks_in_one_call_give_the_bits_of_one_at_a_time(digests):
    held = buttons_of(SHORT)
    batch = batch_of(SHORT)
    for tick, rows in enumerate(held):
        if tick % BEAT == 0:
            batch.create_balls()
        batch.step(rows)
    assert batch.digests() == digests_in_a_batch(SHORT) == digests


@pytest.mark.parametrize("count", [1, 2, 3, 23, 400])
def test_a_world_alone_is_the_same_world_in_a_batch_of_any_size_and_at_any_place(count, digests):
    which = [index % len(SHORT) for index in range(count)]
    assert digests_in_a_batch([SHORT[index] for index in which]) == [digests[index] for index in which]


@pytest.mark.parametrize("threads", [1, 2, 3, 4])
def test_the_number_of_threads_changes_no_bit(threads, digests):
    many = [*SHORT] * 20  # enough for several slices a thread
    assert digests_in_a_batch(many, threads) == digests * 20


# --- in another process ----------------------------------------------------------------------------------


def elsewhere(**environment: str) -> list[str]:
    """The digests that a new process finds."""
    run = subprocess.run(
        [sys.executable, "-W", "ignore", str(Path(scenes.__file__))],
        env=os.environ | environment, capture_output=True, text=True, check=False, timeout=PATIENCE,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def test_a_new_process_gives_the_same_bits(digests):
    assert elsewhere(PYTHONHASHSEED="123") == digests


def test_the_interpreted_run_gives_the_bits_of_the_compiled_one(digests):
    assert elsewhere(NUMBA_DISABLE_JIT="1") == digests


@pytest.mark.slow
def test_a_cold_and_then_a_warm_cache_give_the_same_bits(digests, tmp_path):
    for _ in range(2):
        assert elsewhere(SILVERBALL_CACHE=str(tmp_path)) == digests
        assert any(tmp_path.rglob("*.nbc"))


@pytest.mark.slow
def test_bounds_checks_change_no_bit(digests, tmp_path):
    """An index out of bounds would end that process with an error."""
    assert elsewhere(SILVERBALL_CACHE=str(tmp_path), NUMBA_BOUNDSCHECK="1") == digests
