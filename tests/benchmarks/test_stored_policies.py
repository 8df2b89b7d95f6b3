"""Trained policies from files: layers, convolutions, memory, what they see, and files that are none."""

from __future__ import annotations

import json

import numpy as np
import pytest

from silverball.benchmarks.agents import results_table
from silverball.benchmarks.agents.contestants import CONTESTANTS
from silverball.benchmarks.agents.stored_policies import StoredPolicy
from silverball.benchmarks.agents.trials import make_trial, play_trial
from silverball.cli.bench_agents import chosen_entrants
from silverball.errors import SilverballError

CLASSIC = "silverball/PinballClassic-v1"
UNITS, PICTURE = 8, {"observation": "pixels", "size": [16, 8], "stack": 2}


def drawn(*shape):
    return np.random.default_rng(sum(shape)).normal(size=shape).astype(np.float32)


def policy_file(path, columns, **changed):
    arrays = {
        "id": CLASSIC, "contestant": "ppo", "command": "python train", "steps": 10, "seed": 0,
        "weights0": drawn(columns, UNITS), "biases0": drawn(UNITS),
        "weights1": drawn(UNITS, 4), "biases1": drawn(4),
    }  # fmt: skip
    np.savez(path, **{name: value for name, value in (arrays | changed).items() if value is not None})
    return path


def picture_file(path, **changed):
    convolutions = {
        "filters0": drawn(3, 2, 4, 4) / 255, "offsets0": drawn(3), "stride0": 2,
        "filters1": drawn(5, 3, 2, 2), "offsets1": drawn(5), "stride1": 1,
    }  # fmt: skip
    options = {"options": json.dumps(PICTURE), "contestant": "ppo pictures"}
    return policy_file(path, 5 * 6 * 2, **(convolutions | options | changed))


def memory_file(path, columns, **changed):
    memory = {
        "memory_inputs": drawn(3 * UNITS, columns), "memory_offsets": drawn(3 * UNITS),
        "memory_states": drawn(3 * UNITS, UNITS) / 3, "memory_state_offsets": drawn(3 * UNITS) / 3,
    }  # fmt: skip
    return policy_file(path, UNITS, **(memory | changed))


def test_layers_have_tanh_between_them_and_the_greatest_output_is_pressed(tmp_path):
    envs = make_trial(CLASSIC, 4, "test", time_limit=2.0)
    columns = envs.single_observation_space.shape[0]
    policy = StoredPolicy(policy_file(tmp_path / "policy.npz", columns))
    observations, _ = envs.reset(seed=0)
    with np.load(tmp_path / "policy.npz") as file:
        hidden = np.tanh(observations @ file["weights0"] + file["biases0"])
        expected = (hidden @ file["weights1"] + file["biases1"]).argmax(axis=1)
    assert policy(envs).act(observations, 0).tolist() == expected.tolist()
    assert play_trial(policy, envs, 0).seconds.max() <= 2.0


def test_convolutions_are_sums_over_patches_with_a_relu(tmp_path):
    envs = make_trial(CLASSIC, 3, "test", **PICTURE)
    observations, _ = envs.reset(seed=0)
    policy = StoredPolicy(picture_file(tmp_path / "policy.npz"))
    with np.load(tmp_path / "policy.npz") as file:
        values = observations.astype(float)
        for number, stride in enumerate((2, 1)):
            filters, offsets = file[f"filters{number}"].astype(float), file[f"offsets{number}"]
            side = filters.shape[2]
            rows, columns = ((length - side) // stride + 1 for length in values.shape[2:])
            after = np.zeros((3, len(filters), rows, columns))
            for env, out, row, column in np.ndindex(after.shape):
                top, left = row * stride, column * stride
                patch = values[env, :, top : top + side, left : left + side]
                after[env, out, row, column] = max(0.0, (patch * filters[out]).sum() + offsets[out])
            values = after
        hidden = np.tanh(values.reshape(3, -1) @ file["weights0"] + file["biases0"])
        expected = hidden @ file["weights1"] + file["biases1"]
    outputs, _ = policy.outputs(observations, policy.first_state(3))
    np.testing.assert_allclose(outputs, expected, atol=1e-4)
    assert policy(envs).act(observations, 0).tolist() == expected.argmax(axis=1).tolist()


def test_memory_is_a_gated_recurrent_unit_that_starts_empty_in_every_trial(tmp_path):
    envs = make_trial(CLASSIC, 2, "test", sight="positions")
    columns = envs.single_observation_space.shape[0]
    policy = StoredPolicy(memory_file(tmp_path / "policy.npz", columns))
    inputs = drawn(3, 2, columns)
    with np.load(tmp_path / "policy.npz") as file:
        file = {name: file[name] for name in file.files}
    state = expected = np.zeros((2, UNITS))
    for values in inputs:
        given = values @ file["memory_inputs"].T + file["memory_offsets"]
        kept = expected @ file["memory_states"].T + file["memory_state_offsets"]
        reset, update = (
            1 / (1 + np.exp(-(given + kept)[:, one * UNITS : (one + 1) * UNITS])) for one in (0, 1)
        )
        new = np.tanh(given[:, 2 * UNITS :] + reset * kept[:, 2 * UNITS :])
        expected = (1 - update) * new + update * expected
        _, state = policy.outputs(values, state)
        np.testing.assert_allclose(state, expected, atol=1e-5)
    player = policy(envs)
    first = [player.act(values, 0).tolist() for values in inputs]
    assert [player.act(values, 0).tolist() for values in inputs] != first
    again = policy(envs)
    assert [again.act(values, 0).tolist() for values in inputs] == first


def test_policies_of_one_kind_are_runs_of_one_contestant_and_see_what_they_were_trained_on(tmp_path):
    columns = make_trial(CLASSIC, 1, "test").single_observation_space.shape[0]
    hidden = json.dumps({"sight": "positions"})
    paths = [
        policy_file(tmp_path / "a.npz", columns),
        policy_file(tmp_path / "b.npz", columns, seed=1),
        picture_file(tmp_path / "c.npz"),
        memory_file(tmp_path / "d.npz", columns, options=hidden, contestant="ppo positions memory"),
    ]
    trials = results_table.play_all(CLASSIC, chosen_entrants(["idle"], paths), 3)
    assert {name: len(runs) for name, runs in trials.items()} == {
        "idle": 1, "ppo": 2, "ppo pictures": 1, "ppo positions memory": 1,
    }  # fmt: skip
    assert all(len(run.scores) == 3 for runs in trials.values() for run in runs)


def broken(tmp_path):
    """Files that are no policies."""
    (tmp_path / "text.npz").write_text("no", encoding="utf-8")
    yield tmp_path / "text.npz"
    yield policy_file(tmp_path / "part.npz", 7, steps=None)
    yield policy_file(tmp_path / "flat.npz", 7, weights0=np.zeros(7))
    yield policy_file(tmp_path / "words.npz", 7, weights1=np.array([["a", "b"]]))
    yield policy_file(tmp_path / "options.npz", 7, options="{")
    yield policy_file(tmp_path / "list.npz", 7, options="[1]")
    yield policy_file(tmp_path / "size.npz", 7, options=json.dumps({"size": "large"}))
    yield picture_file(tmp_path / "offsets.npz", offsets1=None)
    yield memory_file(tmp_path / "memory.npz", 7, memory_offsets=None)
    yield tmp_path / "none.npz"


def test_files_that_are_no_policies_are_refused(tmp_path):
    for path in broken(tmp_path):
        with pytest.raises(SilverballError, match="is not a policy written by"):
            StoredPolicy(path)
    with pytest.raises(SilverballError, match=r"--out`: it is no \.npz file"):
        StoredPolicy(tmp_path / "text.npz")
    with pytest.raises(SilverballError, match="has no layers"):
        StoredPolicy(policy_file(tmp_path / "empty.npz", 7, weights0=None))
    with pytest.raises(SilverballError, match="sets the option 'table'; expected one of observation"):
        StoredPolicy(policy_file(tmp_path / "table.npz", 7, options=json.dumps({"table": "classic"})))
    with pytest.raises(SilverballError, match="calls itself 'blind', which is the name of a player"):
        chosen_entrants(["random"], [policy_file(tmp_path / "blind.npz", 7, contestant="blind")])
    assert "blind" in CONTESTANTS


@pytest.mark.parametrize(
    "damage",
    [
        lambda path, columns: policy_file(path, columns - 1),
        lambda path, columns: policy_file(path, columns, weights1=drawn(UNITS, 3), biases1=drawn(3)),
        lambda path, columns: policy_file(path, columns, biases0=drawn(UNITS + 1)),
        lambda path, columns: picture_file(path),
        lambda path, columns: memory_file(path, columns, memory_states=drawn(3 * UNITS, UNITS + 1)),
    ],
)
def test_a_policy_that_does_not_fit_the_environment_is_refused(tmp_path, damage):
    envs = make_trial(CLASSIC, 2, "test")
    path = damage(tmp_path / "policy.npz", envs.single_observation_space.shape[0])
    with pytest.raises(SilverballError, match=f"was trained on {CLASSIC}; it does not take"):
        StoredPolicy(path)(envs)
