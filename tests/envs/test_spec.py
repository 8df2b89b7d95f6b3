"""The spec of an environment, and the options it accepts."""

from __future__ import annotations

import pickle
import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec

import silverball as sb
from silverball.envs import IDS, REWARD_THRESHOLDS, PinballEnv, PinballVectorEnv, engine
from silverball.table import Cylinder, Table, load_table

CLASSIC = "silverball/PinballClassic-v0"
RANDOM = "silverball/Pinball-v0"
FEW = {"boards": 4}


def options_of(id_: str) -> dict:
    return {} if id_ == CLASSIC else FEW


@pytest.mark.parametrize("id_", IDS)
@pytest.mark.parametrize(
    "options",
    [{}, {"frame_skip": 4}, {"tick_rate": 240}, {"time_limit": 7.0}, {"time_limit": 0.01}, {"frame_skip": 7}],
    ids=str,
)
def test_the_spec_says_after_how_many_steps_an_episode_is_truncated(id_, options):
    env = gym.make(id_, **options_of(id_), **options)
    given = {"time_limit": 300.0, "tick_rate": 60, "frame_skip": 1} | IDS[id_] | options
    steps = max(1, -(-round(given["time_limit"] * given["tick_rate"], 6) // given["frame_skip"]))
    assert env.spec.max_episode_steps == steps
    assert gym.make_vec(id_, 2, **options_of(id_), **options).spec.max_episode_steps == steps


@pytest.mark.parametrize(
    ("options", "steps"), [({"time_limit": 0.5}, 30), ({"time_limit": 0.5, "frame_skip": 4}, 8)]
)
def test_an_episode_is_truncated_in_exactly_that_step(options, steps):
    env = gym.make(CLASSIC, **options)
    for _ in range(2):
        env.reset(seed=0)
        ends = [env.step(0)[3] for _ in range(env.spec.max_episode_steps)]
        assert ends == [False] * (steps - 1) + [True]


def test_without_a_time_limit_the_spec_names_none():
    assert gym.make(CLASSIC, time_limit=None).spec.max_episode_steps is None
    assert gym.make_vec(CLASSIC, 2, time_limit=None).spec.max_episode_steps is None


def test_a_shorter_limit_of_gymnasiums_own_holds_and_none_lengthens_an_episode():
    env = gym.make(CLASSIC, max_episode_steps=5)
    assert env.spec.max_episode_steps == 5
    env.reset(seed=0)
    assert [env.step(0)[3] for _ in range(5)] == [False] * 4 + [True]
    assert gym.make_vec(CLASSIC, 2, max_episode_steps=5).spec.max_episode_steps == 5
    assert gym.make_vec(CLASSIC, 2, max_episode_steps=10**9).spec.max_episode_steps == 18_000


@pytest.mark.parametrize("id_", REWARD_THRESHOLDS)
def test_the_spec_has_a_threshold_that_chance_does_not_reach(id_):
    threshold = gym.spec(id_).reward_threshold
    assert gym.make(id_, **options_of(id_)).spec.reward_threshold == threshold
    envs = gym.make_vec(id_, 32, observation="state", **options_of(id_))
    envs.reset(seed=0)
    generator, returns, plays = np.random.default_rng(0), np.zeros(32), np.ones(32, bool)
    while plays.any():
        _, rewards, terminated, truncated, _ = envs.step(generator.integers(0, 4, 32))
        returns[plays] += rewards[plays]
        plays &= ~(terminated | truncated)
    assert 0 < returns.mean() < threshold / 3


@pytest.mark.parametrize("id_", IDS)
def test_a_spec_makes_the_same_environment_again(id_):
    env = gym.make(id_, **options_of(id_), frame_skip=2, stall=None)
    for spec in (
        env.spec,
        EnvSpec.from_json(env.spec.to_json()),
        pickle.loads(pickle.dumps(env.spec)),
    ):
        again = gym.make(spec)
        assert again.unwrapped.options == env.unwrapped.options
        assert again.spec.max_episode_steps == env.spec.max_episode_steps


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["table", "list", "recipe", "path", "vector"])
def test_a_spec_with_custom_tables_goes_through_json(kind, seed, tmp_path):
    one, other = sb.generate_table(seed=seed), sb.generate_table(seed=seed + 100)
    path = tmp_path / "mine.toml"
    sb.save_table(one, path)
    table = {"table": one, "list": [one, other], "recipe": load_table("random"), "path": path, "vector": one}[
        kind
    ]
    options = {"table": table, "boards": np.int64(3), "size": (20, 10)}
    made = gym.make_vec(RANDOM, 2, **options) if kind == "vector" else gym.make(RANDOM, **options)
    spec = EnvSpec.from_json(made.spec.to_json())
    again = gym.make_vec(spec) if kind == "vector" else gym.make(spec)
    assert again.unwrapped._engine.pool.tables == made.unwrapped._engine.pool.tables
    assert (again.reset(seed=seed)[0] == made.reset(seed=seed)[0]).all()


def test_a_table_can_be_given_by_the_keys_of_its_file():
    table = {"format": 1, "name": "Mine", "cylinder": [{"center": [3.0, 1.0], "radius": 0.5}]}
    expected = Table(name="Mine", cylinder=(Cylinder(center=(3.0, 1.0), radius=0.5),))
    assert PinballEnv(table=table)._engine.pool.tables == (expected,)
    with pytest.raises(sb.TableError, match="did you mean `cylinder`"):
        PinballEnv(table={"cylindre": []})
    with pytest.raises(TypeError, match="that a table file cannot hold"):
        PinballEnv(table={"name": None})
    with pytest.raises(TypeError, match="table must be"):
        PinballEnv(table=7)


@pytest.mark.parametrize("steps", [None, -1])
@pytest.mark.parametrize("mode", [None, "sync"])
def test_no_limit_of_gymnasiums_own_leaves_that_of_the_environment(steps, mode):
    envs = gym.make_vec(CLASSIC, 2, vectorization_mode=mode, max_episode_steps=steps, time_limit=0.5)
    single = gym.make(CLASSIC, max_episode_steps=steps, time_limit=0.5)
    for env, action in ((single, 0), (envs, np.zeros(2, int))):
        env.reset(seed=0)
        ends = [bool(np.all(env.step(action)[3])) for _ in range(30)]
        assert ends == [False] * 29 + [True]
    assert single.spec.max_episode_steps == 30


@pytest.mark.parametrize("steps", [0, -2, 1.5, True, "7"])
def test_an_invalid_limit_is_refused(steps):
    with pytest.raises(ValueError, match="max_episode_steps must be"):
        gym.make_vec(CLASSIC, 2, max_episode_steps=steps)


@pytest.mark.parametrize(
    "make", [gym.make, lambda id_, **options: gym.make_vec(id_, 2, **options), PinballEnv, PinballVectorEnv]
)
@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("frameskip", "frame_skip"),
        ("rewards", "reward"),
        ("xyzzy", "expected one of"),
        ("\u202eboards", "boards"),
    ],
)
def test_an_unknown_option_is_an_unexpected_keyword_argument(make, name, hint):
    arguments = [CLASSIC] if make not in (PinballEnv, PinballVectorEnv) else []
    with pytest.raises(TypeError, match=f"unexpected keyword argument .*{hint}") as raised:
        make(*arguments, **{name: 4})
    assert f"unexpected keyword argument {name!r}" in str(raised.value)
    assert str(raised.value).isprintable()


@pytest.mark.parametrize("name", ["zero_copy", "threads", "own_boards", "autoreset_mode"])
def test_an_option_of_vectors_is_unexpected_in_a_single_environment(name):
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{name}'.*make_vec"):
        gym.make(CLASSIC, **{name: True})


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("zerocopy", "zero_copy"),
        ("thread", "threads"),
        ("num_env", "num_envs"),
        ("auto_reset_mode", "autoreset_mode"),
    ],
)
def test_a_vector_hints_at_its_own_options_too(name, hint):
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{name}'; did you mean '{hint}'"):
        gym.make_vec(CLASSIC, 2, **{name: 1})


# --- Gymnasium itself, and other processes


@pytest.mark.parametrize(
    ("version", "is_refused"),
    [
        ("0.26.3", True),
        ("0.29.1", True),
        ("1.0.0a2", True),
        ("1.1.0", False),
        ("2.0.0", False),
        ("0.30rc1", True),
        ("1.2rc1", False),
        ("1.10", False),
    ],
)
def test_a_gymnasium_that_is_too_old_is_named_with_the_remedy(version, is_refused):
    script = (
        f"import gymnasium; gymnasium.__version__ = {version!r}\n"
        "import silverball.errors\n"
        "try:\n import silverball.envs\n print('taken')\n"
        "except silverball.errors.MissingExtra as error: print(error)\n"
    )
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    assert (version in said and "pip install --upgrade" in said) == is_refused
    assert ("taken" in said) != is_refused


@pytest.mark.parametrize("context", ["spawn", "forkserver"])
def test_a_spawned_process_imports_by_the_long_name(context):
    """Such a process begins with an empty registry."""
    id_ = f"silverball.envs:{CLASSIC}"
    envs = gym.vector.AsyncVectorEnv([lambda: gym.make(id_)] * 2, context=context)
    here = gym.make_vec(CLASSIC, 2)
    try:
        assert envs.reset(seed=3)[0].tolist() == here.reset(seed=3)[0].tolist()
        assert envs.step(np.array([3, 0]))[0].tolist() == here.step(np.array([3, 0]))[0].tolist()
    finally:
        envs.close()


@pytest.mark.parametrize(("is_there", "folder"), [(True, "f"), (False, "f"), (False, None)])
def test_the_first_environment_says_once_that_it_is_compiled(is_there, folder, monkeypatch, capsys):
    monkeypatch.setattr(engine.SETTINGS, "DISABLE_JIT", 0)
    monkeypatch.setattr(engine, "is_compiled", lambda name, packages, layout: is_there)
    monkeypatch.setattr(engine, "cache_folder", lambda packages: folder)
    engine.announce_compilation.cache_clear()
    for _ in range(2):
        PinballEnv(table="classic")
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("compiling the environments") == (0 if is_there else 1)
    assert ("cannot be written" in said.err) == (folder is None)
