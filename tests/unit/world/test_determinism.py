"""The same bits, whichever way the same game is run."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

GAME = """
import silverball as sb
world = sb.World("classic", seed=7)
world.create_ball()
world.create_ball()
for tick in range(600):
    world.step(left=tick % 100 < 20, right=tick % 130 < 20, jitter=tick % 200 == 199)
print(world.digest(), world.score, world.tick)
"""


def played(**environment: str) -> list[str]:
    return subprocess.run(
        [sys.executable, "-W", "ignore", "-c", GAME],
        env=os.environ | environment, capture_output=True, text=True, check=True, timeout=120,
    ).stdout.split()  # fmt: skip


@pytest.fixture(scope="module")
def compiled():
    return played()


def test_a_new_process_gives_the_same_bits(compiled):
    assert played() == compiled
    assert compiled[2] == "600"


def test_the_interpreted_run_gives_the_bits_of_the_compiled_one(compiled):
    assert played(NUMBA_DISABLE_JIT="1") == compiled


@pytest.mark.slow
def test_a_cold_cache_and_bounds_checks_give_the_same_bits(compiled, tmp_path):
    assert played(SILVERBALL_CACHE=str(tmp_path / "cold")) == compiled
    assert played(SILVERBALL_CACHE=str(tmp_path / "checked"), NUMBA_BOUNDSCHECK="1") == compiled
