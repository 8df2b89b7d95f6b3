"""Does an environment do what wrappers and trainers of others ask of it?"""

from __future__ import annotations

import itertools
import os
import pickle
import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import wrappers
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import check_env

import silverball as sb
from silverball.envs import IDS, PinballEnv, PinballVectorEnv
from silverball.errors import NoDisplay
from silverball.table import Cylinder, Table, load_table

CLASSIC = "silverball/PinballClassic-v0"
RANDOM = "silverball/Pinball-v0"
FEW = {"boards": 4}


def options_of(id_: str) -> dict:
    return {} if id_ == CLASSIC else FEW


# --- the spec


@pytest.mark.parametrize("id_", IDS)
@pytest.mark.parametrize(
    "options",
    [{}, {"frame_skip": 4}, {"tick_rate": 240}, {"time_limit": 7.0}, {"time_limit": 0.01}, {"frame_skip": 7}],
    ids=str,
)
def test_the_spec_says_after_how_many_steps_an_episode_is_truncated(id_, options):
    env = gym.make(id_, **options_of(id_), **options)
    ticks = options.get("time_limit", 300.0) * options.get("tick_rate", 60)
    steps = max(1, -(-round(ticks, 6) // options.get("frame_skip", 1)))
    assert env.spec.max_episode_steps == steps
    assert gym.make_vec(id_, 2, **options_of(id_), **options).spec.max_episode_steps == steps


@pytest.mark.parametrize(
    ("options", "steps"), [({"time_limit": 0.5}, 30), ({"time_limit": 0.5, "frame_skip": 4}, 8)]
)
def test_an_episode_that_is_not_over_before_is_truncated_in_that_very_step(options, steps):
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


@pytest.mark.parametrize("id_", IDS)
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
def test_a_spec_with_tables_of_ones_own_goes_through_json(kind, seed, tmp_path):
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
    with pytest.raises(TypeError, match="table must hold"):
        PinballEnv(table={"name": None})
    with pytest.raises(TypeError, match="table must be"):
        PinballEnv(table=7)


# --- options


@pytest.mark.parametrize(
    "make", [gym.make, lambda id_, **options: gym.make_vec(id_, 2, **options), PinballEnv, PinballVectorEnv]
)
@pytest.mark.parametrize(
    ("name", "hint"), [("frameskip", "frame_skip"), ("rewards", "reward"), ("xyzzy", "options are")]
)
def test_an_unknown_option_is_an_unexpected_keyword_argument(make, name, hint):
    arguments = [CLASSIC] if make not in (PinballEnv, PinballVectorEnv) else []
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{name}'.*{hint}"):
        make(*arguments, **{name: 4})


@pytest.mark.parametrize("name", ["zero_copy", "threads", "own_boards", "autoreset_mode"])
def test_an_option_of_vectors_is_unexpected_in_a_single_environment(name):
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{name}'.*make_vec"):
        gym.make(CLASSIC, **{name: True})


# --- actions


TYPES = [bool, np.int8, np.uint8, np.int64, np.uint64, np.float16, np.float32, np.float64]


@pytest.mark.parametrize("kind", TYPES, ids=lambda kind: kind.__name__)
def test_bits_of_any_type_are_the_same_action(kind):
    env, same = (gym.make(CLASSIC, actions="multibinary", jitter=True) for _ in range(2))
    envs = gym.make_vec(CLASSIC, 2, actions="multibinary", jitter=True)
    env.reset(seed=0), same.reset(seed=0), envs.reset(seed=0)
    for bits in itertools.product((0, 1), repeat=3):
        action = np.array(bits, kind)
        assert env.action_space.contains(action)
        expected = same.step(np.array(bits, np.int8))[0].tolist()
        assert env.step(action)[0].tolist() == expected
        assert envs.step(np.array([bits, bits], kind))[0][0].tolist() == expected


@pytest.mark.parametrize("kind", [kind for kind in TYPES if np.issubdtype(kind, np.integer)])
def test_whole_numbers_of_any_width_are_the_same_action(kind):
    env, envs = gym.make(CLASSIC), gym.make_vec(CLASSIC, 4)
    env.reset(seed=0), envs.reset(seed=0)
    env.step(kind(3)), env.step(np.array(3, kind))
    envs.step(np.arange(4, dtype=kind))


@pytest.mark.parametrize("space", ["discrete", "multibinary"])
@pytest.mark.parametrize("seed", range(3))
def test_what_the_space_takes_the_step_takes(space, seed):
    env, envs = gym.make(CLASSIC, actions=space, create="button"), gym.make_vec(CLASSIC, 3, actions=space)
    env.reset(seed=0), envs.reset(seed=0)
    env.action_space.seed(seed), envs.action_space.seed(seed)
    for _ in range(20):
        for one, of in ((env.action_space.sample(), env), (envs.action_space.sample(), envs)):
            as_list = one.tolist() if isinstance(one, np.ndarray) else int(one)
            for action in (one, as_list):
                assert of.action_space.contains(action)
                of.step(action)
        if env.unwrapped.is_over:
            env.reset()


@pytest.mark.parametrize(
    "action",
    [
        [0.5, 0],
        [2.0, 0],
        [-1.0, 0],
        [np.nan, 0],
        [np.inf, 0],
        [0, 1, 0],
        [[0, 1]],
        ["a", "b"],
        None,
        [None, 1],
    ],
)
def test_bits_that_are_none_are_refused(action):
    env, envs = gym.make(CLASSIC, actions="multibinary"), gym.make_vec(CLASSIC, 1, actions="multibinary")
    env.reset(seed=0), envs.reset(seed=0)
    before = env.unwrapped.save_state()
    with pytest.raises(ValueError, match="action"):
        env.step(action)
    with pytest.raises(ValueError, match=r"action|bit"):
        envs.step([action])
    assert env.unwrapped.save_state() == before


# --- what Atari's wrappers and `play` ask for


@pytest.mark.parametrize(
    "options", [{}, {"jitter": True}, {"create": "button"}, {"jitter": True, "create": "button"}], ids=str
)
def test_every_action_has_a_meaning_and_keys(options):
    env = gym.make(CLASSIC, **options).unwrapped
    meanings, keys = env.get_action_meanings(), env.get_keys_to_action()
    assert len(meanings) == len(set(meanings)) == env.action_space.n
    assert meanings[:4] == ["NOOP", "LEFT", "RIGHT", "LEFT+RIGHT"]
    assert sorted(keys.values()) == list(range(env.action_space.n))
    assert keys[()] == 0
    for pressed, action in keys.items():
        held = [name for name in ("LEFT", "RIGHT", "JITTER", "CREATE") if name in meanings[action].split("+")]
        letters = {"a": "LEFT", "d": "RIGHT", "z": "JITTER", " ": "CREATE"}
        assert [letters[key] for key in pressed] == held


def test_keys_of_multibinary_actions_are_bits():
    env = gym.make(CLASSIC, actions="multibinary").unwrapped
    assert {keys: action.tolist() for keys, action in env.get_keys_to_action().items()} == {
        (): [0, 0], ("a",): [1, 0], ("d",): [0, 1], ("a", "d"): [1, 1],
    }  # fmt: skip


def test_lives_are_the_balls_that_are_not_in_the_gutter():
    env = gym.make(CLASSIC, balls=3, stall=None).unwrapped
    env.reset(seed=0)
    over = False
    while not over:
        *_, over, _, info = env.step(0)
        assert env.ale.lives() == 3 - info["drained"]
    assert env.ale.lives() == 0


# --- resets


def test_a_board_can_be_chosen_by_its_seed():
    env = gym.make(RANDOM, boards=4, board_seed=70)
    for board in (72, 70, np.int64(73)):
        observation, info = env.reset(seed=5, options={"board": board})
        assert info["board"] == board
        alone = gym.make(RANDOM, boards=1, board_seed=int(board)).reset(seed=5)[0]
        assert observation.tolist() == alone.tolist()


def test_a_chosen_board_is_for_one_episode_and_changes_no_other():
    def boards(options):
        env = gym.make(RANDOM, **FEW)
        return [
            env.reset(seed=3 if n == 0 else None, options=options if n == 2 else None)[1]["board"]
            for n in range(9)
        ]

    free, once = boards(None), boards({"board": 1})
    assert once == [*free[:2], 1, *free[3:]]


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP", "DISABLED"])
def test_a_vector_takes_a_board_for_all_or_one_for_each(mode):
    envs = gym.make_vec(RANDOM, 3, boards=4, autoreset_mode=mode)
    assert envs.reset(seed=1, options={"board": 2})[1]["board"].tolist() == [2, 2, 2]
    assert envs.reset(options={"board": np.array([3, 0, 1])})[1]["board"].tolist() == [3, 0, 1]
    mask = np.array([False, True, False])
    info = envs.reset(options={"board": 2, "reset_mask": mask})[1]
    assert info["board"][1] == 2
    envs.step(np.zeros(3, int))
    assert envs.unwrapped.batch.board_of.tolist() == [3, 2, 1]


def test_a_table_of_a_list_can_be_chosen_by_its_number():
    tables = [sb.generate_table(seed=seed) for seed in range(3)]
    env = gym.make(RANDOM, table=tables)
    assert env.reset(seed=0, options={"board": 2})[1]["board"] == 2


@pytest.mark.parametrize("board", [4, -1, 1.0, "1", True, None, [1], 2**70])
def test_a_board_that_is_not_there_is_refused(board):
    env, envs = gym.make(RANDOM, **FEW), gym.make_vec(RANDOM, 2, **FEW)
    env.reset(seed=0), envs.reset(seed=0)
    before = env.unwrapped.save_state()
    if board is None:
        env.reset(options={"board": None})  # none is chosen
        return
    for one in (env, envs):
        with pytest.raises(ValueError, match="board must be"):
            one.reset(options={"board": board})
    assert env.unwrapped.save_state() == before
    with pytest.raises(ValueError, match="only table"):
        gym.make(CLASSIC).reset(options={"board": 0})


@pytest.mark.parametrize(
    "options", [{"seed": 1}, {"boards": 3}, {"reset_mask": np.ones(1, bool)}, {7: 7}], ids=str
)
def test_an_unknown_option_of_a_reset_is_refused(options):
    env = gym.make(CLASSIC)
    with pytest.raises(ValueError, match="unknown reset option"):
        env.reset(options=options)
    if "reset_mask" not in options:
        with pytest.raises(ValueError, match="unknown reset option"):
            gym.make_vec(CLASSIC, 1).reset(options=options)
    for wrong in ("board", 7, [("board", 1)]):
        with pytest.raises(TypeError, match="options must be a dict"):
            env.reset(options=wrong)
    env.reset(options={})


def test_a_generator_that_is_set_decides_what_follows():
    def episodes(make, number):
        env = make()
        env.reset(seed=1)
        env.unwrapped.np_random = np.random.default_rng(number)
        return [env.reset()[0].tolist() for _ in range(4)]

    for make in (lambda: gym.make(CLASSIC), lambda: gym.make_vec(CLASSIC, 3)):
        assert episodes(make, 7) == episodes(make, 7) != episodes(make, 8)


def test_a_generator_that_is_set_waits_for_each_environments_own_reset():
    envs = gym.make_vec(CLASSIC, 2)
    envs.reset(seed=1)
    expected = gym.make_vec(CLASSIC, 2)
    expected.reset(seed=1)
    envs.unwrapped.np_random = np.random.default_rng(3)
    first = {"reset_mask": np.array([True, False])}
    drawn, untouched = envs.reset(options=first)[0], expected.reset(options=first)[0]
    assert drawn[0].tolist() != untouched[0].tolist()
    assert drawn[1].tolist() == untouched[1].tolist()
    second = {"reset_mask": np.array([False, True])}
    assert envs.reset(options=second)[0][1].tolist() != expected.reset(options=second)[0][1].tolist()


def test_a_seed_comes_before_a_generator_that_was_set():
    env = gym.make(CLASSIC)
    env.unwrapped.np_random = np.random.default_rng(3)
    seeded = gym.make(CLASSIC)
    assert env.reset(seed=4)[0].tolist() == seeded.reset(seed=4)[0].tolist()
    assert env.reset()[0].tolist() == seeded.reset()[0].tolist()


# --- being seen


@pytest.fixture
def _blind(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


@pytest.mark.usefixtures("_blind")
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("mode", [None, "human", "rgb_array"])
def test_gymnasiums_checker_has_no_complaint_in_any_render_mode(mode):
    env = gym.make(CLASSIC, render_mode=mode, tick_rate=10_000)
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
def test_an_environment_goes_on_without_the_window_that_somebody_closes():
    import pygame

    env = gym.make(CLASSIC, render_mode="human", tick_rate=10_000)
    env.reset(seed=0)
    pygame.event.post(pygame.Event(pygame.QUIT))
    for _ in range(3):
        env.step(0)
    assert env.unwrapped._screen.is_closed
    env.close()
    env.close()


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


# --- wrappers


WRAPPERS = {
    "time_aware": wrappers.TimeAwareObservation,
    "statistics": wrappers.RecordEpisodeStatistics,
    "stack": lambda env: wrappers.FrameStackObservation(env, 3),
    "normalize": wrappers.NormalizeObservation,
    "normalize_reward": wrappers.NormalizeReward,
    "sticky": lambda env: wrappers.StickyAction(env, 0.25),
    "limit": lambda env: wrappers.TimeLimit(env, 30),
    "flatten": wrappers.FlattenObservation,
    "rescale": lambda env: wrappers.RescaleObservation(env, np.float32(0), np.float32(1)),
    "reward": lambda env: wrappers.TransformReward(env, np.sign),
    "clip": lambda env: wrappers.ClipReward(env, -1, 1),
    "delay": lambda env: wrappers.DelayObservation(env, 2),
    "max_skip": lambda env: wrappers.MaxAndSkipObservation(env, 4),
    "autoreset": wrappers.Autoreset,
    "order": wrappers.OrderEnforcing,
    "checker": wrappers.PassiveEnvChecker,
    "dtype": lambda env: wrappers.DtypeObservation(env, np.float64),
}


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("wrap", WRAPPERS.values(), ids=WRAPPERS)
@pytest.mark.parametrize("id_", IDS)
def test_gymnasiums_wrappers_go_around_every_environment(id_, wrap):
    env = wrap(gym.make(id_, **options_of(id_)))
    observation, _ = env.reset(seed=0)
    assert env.observation_space.contains(observation)
    for _ in range(20):
        observation, reward, terminated, truncated, _ = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation)
        assert np.isfinite(reward)
        if terminated or truncated:
            env.reset()


# --- Gymnasium itself


@pytest.mark.parametrize(
    ("version", "is_refused"),
    [("0.26.3", True), ("0.29.1", True), ("1.0.0a2", True), ("1.1.0", False), ("2.0.0", False)],
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
