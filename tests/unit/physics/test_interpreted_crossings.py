"""The kernels of crossings, one-way parts, spinners and holes give the same bits without the JIT."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from flights import disc, random_flight, segment
from patience import PATIENCE
from silverball.physics import crossing, holes, one_way, portable_math, spinner

TESTS = Path(__file__).parents[2]


def results() -> list[str]:
    """What each kernel returns for some hundred random arguments, to the bit."""
    rng = np.random.default_rng(4)
    found = []

    def add(result) -> None:
        found.append(" ".join(float(n).hex() for n in np.atleast_1d(result)))

    for _ in range(100):
        kind = str(rng.choice(["gravity", "any", "none"]))
        ball = random_flight(rng, kind, rng.normal(0.0, 0.3, (2, 2)))
        line = segment(*rng.normal(0.0, 0.7, (2, 2)).tolist(), 0.05)
        add(crossing.line_crossing(line, ball, 0.0, False, 1.5))
        add(crossing.disc_entry(disc(0.0, 0.1, 0.3), ball, 0.0, False, 1.5))
        add(one_way.time_to_one_way(line, ball, 0.25, 0.0, 1.5))
        x, y = rng.normal(0.0, 10.0, 2).tolist()
        for function in (portable_math.exp, portable_math.expm1):
            add(function(x))
        for function in (portable_math.log, portable_math.log1p):
            add(function(math.exp(x)))
        add(spinner.blade_speed(x, 0.3, abs(y)))
        add(spinner.blade_angle(0.2, x, 0.3, abs(y), 0))
        add(spinner.time_of_turn(0.2, x, 0.3, 2))
        add(spinner.remaining_turns(0.2, x, 0.3, 0))
        add(spinner.slowed_by_blade(x, y, 1.0))
        add(holes.can_capture(x, y, 10.0))
        add(holes.exit_velocity(x, y, 0.3, 5, 17))
        add(holes.launch_speed(1.0, 20.0, 0.7, int(abs(10.0 * y)), 1 / 240))
    return found


def test_the_interpreted_run_gives_the_bits_of_the_compiled_one() -> None:
    run = subprocess.run(
        [sys.executable, "-W", "error", str(Path(__file__))],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(TESTS)},
        capture_output=True, text=True, check=False, timeout=PATIENCE,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert json.loads(run.stdout) == results()


if __name__ == "__main__":
    print(json.dumps(results()))
