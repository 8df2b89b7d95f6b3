"""Every example for agents runs."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
RUNS = {
    "train_sb3.py": (
        ("stable_baselines3", "matplotlib"),
        ("--steps", "2048", "--envs", "16", "--boards", "2"),
    ),
    "train_torch.py": (("torch",), ("--steps", "4096", "--envs", "32", "--boards", "2")),
    "collect_torchrl.py": (("torchrl",), ()),
    "train_rllib.py": (("ray", "torch"), ("--rounds", "1")),
}


def test_every_example_for_agents_is_run():
    for_agents = [*EXAMPLES.glob("train_*.py"), *EXAMPLES.glob("collect_*.py")]
    assert sorted(path.name for path in for_agents) == sorted(RUNS)


@pytest.mark.parametrize("name", RUNS)
def test_an_example_runs(name, tmp_path):
    packages, arguments = RUNS[name]
    missing = [package for package in packages if importlib.util.find_spec(package) is None]
    if missing:
        pytest.skip(f"{', '.join(missing)} is not installed")
    run = [sys.executable, str(EXAMPLES / name), *arguments]
    done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, timeout=500, check=False)
    assert done.returncode == 0, done.stderr
    assert "points" in done.stdout or "wrote" in done.stdout
