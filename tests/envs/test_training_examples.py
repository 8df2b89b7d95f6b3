"""Every example for agents runs."""

from __future__ import annotations

import csv
import importlib.util
import re
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from patience import PATIENCE
from silverball.benchmarks.agents.stored_policies import StoredPolicy
from silverball.benchmarks.agents.trials import make_trial

EXAMPLES = Path(__file__).parents[2] / "examples"
RUNS: dict[str, tuple[tuple[str, ...], ...]] = {  # the packages that it needs, then the arguments of its runs
    "train_sb3.py": (
        ("stable_baselines3", "matplotlib"),
        ("--steps", "2048", "--envs", "16", "--boards", "2"),
    ),
    "train_torch.py": (("torch",), ("--steps", "4096", "--envs", "32", "--boards", "2")),
    "collect_torchrl.py": (("torchrl",), ()),
    "train_rllib.py": (("ray", "torch"), ("--rounds", "1")),
    "train_benchmark.py": (
        ("torch",),
        ("--steps", "8192", "--envs", "64"),
        ("--steps", "2048", "--envs", "64", "--length", "16", "--option", "observation=pixels"),
        ("--steps", "2048", "--envs", "64", "--length", "16", "--option", "sight=positions", "--memory"),
    ),
    "train_sb3_benchmark.py": (
        ("stable_baselines3", "sb3_contrib"),
        ("--steps", "6144", "--envs", "64", "--algorithm", "dqn", "--pictures"),
        ("--steps", "6144", "--envs", "64", "--algorithm", "qr-dqn"),
    ),
    "train_missions.py": (
        ("torch",),
        ("--steps", "4096", "--envs", "64", "--length", "32", "--out", "m.npz"),
    ),
    "train_domain.py": ((), ("--episodes", "60")),
}


def test_every_example_for_agents_is_run():
    for_agents = [*EXAMPLES.glob("train_*.py"), *EXAMPLES.glob("collect_*.py")]
    assert sorted(path.name for path in for_agents) == sorted(RUNS)


def skip_without_packages(name):
    """Skip the test where an example lacks a package."""
    missing = [package for package in RUNS[name][0] if importlib.util.find_spec(package) is None]
    if missing:
        pytest.skip(f"{', '.join(missing)} is not installed")


@pytest.mark.parametrize(("name", "number"), [(name, n) for name in RUNS for n in range(1, len(RUNS[name]))])
def test_an_example_runs(name, number, tmp_path):
    skip_without_packages(name)
    run = [sys.executable, str(EXAMPLES / name), *RUNS[name][number]]
    done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.returncode == 0, done.stderr
    assert re.search("points|wrote|steps, in the target", done.stdout)


def trained_outputs(example, observations):
    """The outputs of the network that an example has trained, given what its names mean at its end."""
    import torch

    with torch.no_grad():
        if "actor" in example:
            state = torch.zeros(len(observations), example["chosen"].width)
            return example["actor"](example["remember"](example["look"](observations), state)[0]).numpy()
        model, envs = example["model"], example["envs"]
        if hasattr(envs, "normalize_obs"):
            observations = envs.normalize_obs(observations)
        inputs, _ = model.policy.obs_to_tensor(observations)
        outputs = model.q_net(inputs) if hasattr(model, "q_net") else model.quantile_net(inputs).mean(1)
        return outputs.numpy()


@pytest.mark.parametrize(
    ("name", "number"),
    [(name, n) for name in RUNS if "_benchmark" in name for n in range(1, len(RUNS[name]))],
)
def test_a_stored_policy_has_the_outputs_of_the_trained_network(name, number, tmp_path, monkeypatch):
    skip_without_packages(name)
    files = ("--out", str(tmp_path / "policy.npz"), "--curve", str(tmp_path / "curve.csv"))
    monkeypatch.setattr(sys, "argv", [name, *RUNS[name][number], *files])
    example = runpy.run_path(str(EXAMPLES / name))
    policy = StoredPolicy(tmp_path / "policy.npz")
    envs = make_trial(policy.id, 16, "test", **policy.options)
    envs.reset(seed=0)
    for _ in range(10):
        observations, *_ = envs.step(np.zeros(16, int))
    outputs, _ = policy.outputs(observations, policy.first_state(16))
    expected = trained_outputs(example, observations)
    np.testing.assert_allclose(outputs, expected, atol=1e-3 * np.abs(expected).max())
    with (tmp_path / "curve.csv").open(encoding="utf-8") as file:
        assert next(csv.reader(file)) == ["steps", "seconds", "points_a_ball", "balls"]


def test_a_training_that_goes_on_from_a_policy_begins_with_its_outputs(tmp_path, monkeypatch):
    """The network sees features on a scale, and the policy takes them as they are."""
    skip_without_packages("train_missions.py")
    from silverball.players.mission_policy import mission_policy

    own = mission_policy()
    own.save(tmp_path / "own.npz")
    arguments = ("--steps", "1", "--envs", "64", "--length", "2", "--policy", str(tmp_path / "own.npz"))
    monkeypatch.setattr(sys, "argv", ["train_missions.py", *arguments, "--out", str(tmp_path / "next.npz")])
    example = runpy.run_path(str(EXAMPLES / "train_missions.py"))
    later = type(own).load(tmp_path / "next.npz")  # one update, in which only the other head has learnt
    features = example["look"]().numpy().astype(float)
    before, after = own._network.outputs(features), later._network.outputs(features)
    np.testing.assert_allclose(after, before, atol=0.02 * np.abs(before).max())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--policy", "missing.npz"), "missing.npz"),
        (("--policy", "empty.npz"), "empty.npz is not a policy"),
        (("--policy", "own.npz", "--width", "64"), "add --width 192"),
        (("--policy", "own.npz", "--init", "state.pt"), "not allowed with"),
    ],
)
def test_a_policy_that_a_training_cannot_begin_with_is_refused_in_a_sentence(
    arguments, words, tmp_path, monkeypatch, capsys
):
    skip_without_packages("train_missions.py")
    from silverball.players.mission_policy import mission_policy

    mission_policy().save(tmp_path / "own.npz")
    (tmp_path / "empty.npz").write_bytes(b"")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["train_missions.py", "--envs", "4", *arguments])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(EXAMPLES / "train_missions.py"))
    assert ended.value.code == 2
    assert words in capsys.readouterr().err
