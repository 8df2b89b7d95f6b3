"""The vector environment equals many single environments."""

from __future__ import annotations

import copy
import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from silverball.envs import IDS, PinballEnv, PinballVectorEnv, engine
from silverball.table import load_table
from silverball.world.threads import thread_pool

MODES = tuple(AutoresetMode)
CLASSIC = "silverball/PinballClassic-v0"
COUNT, STEPS = 5, 400
SHORT = {"boards": 3, "time_limit": 2.0}  # episodes end often, by the gutter and by the limit


def same(one, other) -> bool:
    """Whether two nested results are equal to the bit, types and missing parts included."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, tuple) or (isinstance(one, np.ndarray) and one.dtype == object):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()
    return type(one) is type(other) and one == other


@pytest.mark.parametrize(
    "options",
    [
        SHORT,
        {"table": "classic", "balls": 3, "jitter": True, "create": "button", "time_limit": 3.0},
        {**SHORT, "observation": "dict", "reward": "time", "frame_skip": 3},
        {**SHORT, "actions": "multibinary", "tick_rate": 240, "frame_skip": 4, "stall": 1.0},
        {**SHORT, "observation": "pixels", "size": (20, 12), "stack": 3},
        {**SHORT, "observation": "pixels", "size": (20, 12), "stack": 1, "rgb": True},
    ],
    ids=str,
)
@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("zero_copy", [False, True])
def test_vector_equals_many_singles_step_for_step(mode, options, zero_copy):
    native = PinballVectorEnv(COUNT, mode, zero_copy, **options)
    singles = SyncVectorEnv([lambda: PinballEnv(**options)] * COUNT, autoreset_mode=mode)
    assert native.observation_space == singles.observation_space
    assert native.action_space == singles.action_space
    assert same(native.reset(seed=7), singles.reset(seed=7))
    singles.action_space.seed(1)
    ends = 0
    for _ in range(STEPS):
        action = singles.action_space.sample()
        one, other = native.step(action), singles.step(action)
        for mine, theirs in zip(one, other, strict=True):
            assert same(mine, theirs)
        over = one[2] | one[3]
        ends += over.sum()
        if mode is AutoresetMode.DISABLED and over.any():
            one, other = (envs.reset(options={"reset_mask": over.copy()}) for envs in (native, singles))
            assert same(one, other)
    assert ends >= COUNT


def test_mode_is_an_attribute_and_in_the_metadata():
    for mode in MODES:
        envs = gym.make_vec(CLASSIC, 2, autoreset_mode=mode)
        assert envs.autoreset_mode is envs.metadata["autoreset_mode"] is mode
    for text in ("SameStep", "SAME_STEP"):
        assert gym.make_vec(CLASSIC, 2, autoreset_mode=text).autoreset_mode is AutoresetMode.SAME_STEP
    assert PinballVectorEnv.metadata == {}, "the modes of instances must not leak into the class"


@pytest.mark.parametrize("id_", IDS)
def test_gymnasiums_make_vec_gives_the_native_one(id_):
    envs = gym.make_vec(id_, num_envs=2, **({} if id_ == CLASSIC else {"boards": 2}))
    assert type(envs) is PinballVectorEnv
    observations, _ = envs.reset(seed=0)
    assert observations in envs.observation_space
    single = gym.make(id_, **({} if id_ == CLASSIC else {"boards": 2}))
    assert envs.single_observation_space == single.observation_space


def test_with_disabled_autoreset_an_ended_episode_must_be_reset():
    envs = gym.make_vec(CLASSIC, 2, autoreset_mode=AutoresetMode.DISABLED, time_limit=1 / 60)
    envs.reset(seed=0)
    envs.step(np.zeros(2, int))
    with pytest.raises(gym.error.ResetNeeded, match="2 episodes are over"):
        envs.step(np.zeros(2, int))


@pytest.mark.parametrize("mode", MODES)
def test_a_step_before_the_first_reset_is_refused(mode):
    with pytest.raises(gym.error.ResetNeeded):
        gym.make_vec(CLASSIC, 2, autoreset_mode=mode).step(np.zeros(2, int))


def test_each_environment_can_have_a_seed_of_its_own():
    envs = gym.make_vec(CLASSIC, 3)
    first, _ = envs.reset(seed=[5, 9, 5])
    assert first[0].tolist() == first[2].tolist() != first[1].tolist()
    assert first[1].tolist() == gym.make(CLASSIC).reset(seed=9)[0].tolist()
    again, _ = envs.reset(seed=[None, 9, None])
    assert again[1].tolist() == first[1].tolist()
    assert again[0].tolist() != first[0].tolist()


@pytest.mark.parametrize("seed", [0, np.int64(0)])
def test_seed_zero_counts(seed):
    envs = gym.make_vec(CLASSIC, 2)
    assert envs.reset(seed=seed)[0].tolist() == envs.reset(seed=seed)[0].tolist()
    assert envs.reset(seed=seed)[0].tolist() != envs.reset(seed=1)[0].tolist()


def test_a_mask_begins_these_episodes_alone():
    envs = gym.make_vec(CLASSIC, 3)
    envs.reset(seed=0)
    before = envs.step(np.full(3, 3))[0]
    after, infos = envs.reset(options={"reset_mask": np.array([False, True, False])})
    assert (after != before).any(axis=1).tolist() == [False, True, False]
    assert infos["_created"].tolist() == [False, True, False]


@pytest.mark.parametrize(
    ("mask", "message"),
    [
        ([True, False], "boolean array"),
        (np.array([1, 0]), "boolean array"),
        (np.array([True]), "shape"),
        (np.array([False, False]), "at least one"),
    ],
)
def test_a_mask_that_makes_no_sense_is_refused(mask, message):
    envs = gym.make_vec(CLASSIC, 2)
    envs.reset(seed=0)
    with pytest.raises((TypeError, ValueError), match=message):
        envs.reset(options={"reset_mask": mask})


@pytest.mark.parametrize(
    "actions", [np.zeros(3, int), np.zeros(2), np.array([0, 4]), np.array([-1, 0]), np.zeros((2, 2), int), 0]
)
def test_actions_that_make_no_sense_are_refused(actions):
    envs = gym.make_vec(CLASSIC, 2)
    envs.reset(seed=0)
    with pytest.raises(ValueError, match="action"):
        envs.step(actions)


def test_steps_return_new_arrays_or_with_zero_copy_always_the_same():
    for zero_copy in (False, True):
        envs = gym.make_vec(CLASSIC, 2, zero_copy=zero_copy)
        envs.reset(seed=0)
        (first, *_), (second, *_) = (envs.step(np.zeros(2, int)) for _ in range(2))
        assert np.shares_memory(first, second) is zero_copy


@pytest.mark.parametrize(
    "options", [{"table": "classic"}, {"boards": 2, "observation": "pixels", "size": (20, 12), "stack": 3}]
)
@pytest.mark.parametrize("zero_copy", [False, True])
def test_any_number_of_threads_gives_the_same_bits(options, zero_copy, monkeypatch):
    monkeypatch.setattr(engine, "MIN_SLICE_WORK", 1)
    calls = []
    monkeypatch.setattr(engine, "thread_pool", lambda threads: calls.append(threads) or thread_pool(threads))

    def result(threads: int) -> list[bytes]:
        envs = PinballVectorEnv(40, "Disabled", zero_copy, threads, time_limit=0.3, **options)
        envs.reset(seed=1)
        random, seen = np.random.default_rng(2), []
        for _ in range(60):
            observations, _, terminated, truncated, _ = envs.step(random.integers(0, 4, 40))
            seen.append(observations.tobytes())
            mask = terminated | truncated | (random.random(40) < 0.1)
            if mask.any():
                seen.append(envs.reset(options={"reset_mask": mask})[0].tobytes())
        return seen

    alone = result(1)
    assert calls == []
    assert result(3) == alone
    assert set(calls) == {3}


@pytest.mark.parametrize("again", [copy.deepcopy, lambda envs: pickle.loads(pickle.dumps(envs))])
@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("options", [{"balls": 2}, {"observation": "pixels", "size": (20, 12), "stack": 2}])
def test_a_copy_goes_on_like_its_original_and_leaves_it_alone(again, mode, options):
    envs = PinballVectorEnv(3, mode, boards=3, max_episode_steps=90, own_boards=True, **options)
    envs.reset(seed=5)
    envs.action_space.seed(3)
    envs.mine = "kept"
    actions = np.random.default_rng(0).integers(0, 4, (200, 3))
    for action in actions[:50]:
        envs.step(action)
    before, twin = envs.save_state().tobytes(), again(envs)

    def future(one):
        told = [one.action_space.sample()]
        for action in actions:
            told.append(one.step(action))
            over = told[-1][2] | told[-1][3]
            if mode is AutoresetMode.DISABLED and over.any():
                told.append(one.reset(options={"reset_mask": over}))
        return tuple(told)

    twins = copy.deepcopy(future(twin))
    assert envs.save_state().tobytes() == before
    assert same(twins, future(envs))
    assert twin.mine == "kept"
    assert twin._engine.batch.threads == envs._engine.batch.threads


def test_an_engine_is_not_copied():
    with pytest.raises(TypeError, match="copy the environment"):
        copy.deepcopy(PinballVectorEnv(1, table="classic")._engine)


@pytest.mark.parametrize(
    "options", [{"table": "classic"}, {"table": "classic", "observation": "pixels", "stack": 1}], ids=str
)
def test_steps_write_to_given_arrays(options):
    envs, plain = (PinballVectorEnv(3, "Disabled", zero_copy, **options) for zero_copy in (True, False))
    shape = envs.observation_space.shape
    arrays = (np.zeros(shape, envs.observation_space.dtype), np.zeros(3, bool), np.zeros(3, bool))
    envs.reset(seed=1), plain.reset(seed=1)
    assert envs.write_to(*arrays)
    mask = np.array([True, False, False])
    for one in (envs, plain):
        observations, _ = one.reset(options={"reset_mask": mask})
    assert arrays[0].tolist() == observations.tolist(), "those that go on are there too"
    for action in np.random.default_rng(0).integers(0, 4, (80, 3)):
        result = [one.step(action) for one in (envs, plain)]
        assert arrays[0].tolist() == result[1][0].tolist()
    assert arrays[1].tolist() == result[1][2].tolist()


def test_arrays_that_cannot_be_written_to_are_not():
    envs = PinballVectorEnv(3, zero_copy=True, table="classic")
    envs.reset(seed=1)

    def arrays(shape=(3, 63), kind=np.float32, flags=(3,)):
        return np.zeros(shape, kind), np.zeros(flags, bool), np.zeros(flags, bool)

    still = arrays()
    still[0].flags.writeable = False
    for given in (
        still, arrays((63, 3)), arrays(kind=np.float64), arrays(flags=(3, 1)),
        (np.zeros((3, 126), np.float32)[:, ::2], *arrays()[1:]),
    ):  # fmt: skip
        assert not envs.write_to(*given)
        envs.step(np.full(3, 3))
        assert not given[0].any()
    assert not PinballVectorEnv(3, table="classic").write_to(*arrays()), "new arrays are what it returns"
    named = PinballVectorEnv(3, zero_copy=True, table="classic", observation="dict")
    assert not named.write_to(*arrays())


def test_a_picture_that_was_written_to_is_complete_again_after_a_reset():
    options = {"boards": 1, "observation": "pixels", "size": (20, 12), "stack": 2, "zero_copy": True}
    envs, other = PinballVectorEnv(2, "Disabled", **options), PinballVectorEnv(2, "Disabled", **options)
    envs.reset(seed=0)
    for _ in range(20):
        envs.step(np.zeros(2, int))[0][:] = 7
    assert envs.reset(seed=1)[0].tolist() == other.reset(seed=1)[0].tolist()
    for _ in range(20):
        assert envs.step(np.ones(2, int))[0].tolist() == other.step(np.ones(2, int))[0].tolist()


@pytest.mark.parametrize("seed", [1.5, "xy", -1, [0, 1.5], [0, -1]])
def test_an_invalid_seed_is_refused_with_a_message(seed):
    with pytest.raises(ValueError, match="seed must be an integer ≥ 0"):
        PinballVectorEnv(2, table="classic").reset(seed=seed)
    if not isinstance(seed, list):
        with pytest.raises(ValueError, match="seed must be an integer ≥ 0"):
            PinballEnv(table="classic").reset(seed=seed)


def test_invalid_actions_and_options_are_refused_with_a_message():
    with pytest.raises(TypeError, match="options must be a dict"):
        PinballVectorEnv(2, table="classic").reset(options=[1])
    envs = PinballVectorEnv(2, table="classic")
    envs.reset(seed=0)
    for actions, words in (
        ([[1], [1, 2]], "actions must be integers, got object"),
        ([0.0, 1.0], "actions must be integers, got float64"),
        ([[0, 1], [1, 0]], r"actions must have the shape \(2,\), got \(2, 2\)"),
    ):
        with pytest.raises(ValueError, match=words):
            envs.step(actions)
    bits = PinballVectorEnv(2, table="classic", actions="multibinary")
    bits.reset(seed=0)
    with pytest.raises(ValueError, match=r"every bit of the actions must be 0 or 1, got .*\b2\b"):
        bits.step([[0, 1], [2, 0]])
    with pytest.raises(ValueError, match=r"actions must have the shape \(2, 2\), got \(2, 3\)"):
        bits.step(np.zeros((2, 3), int))


def test_fewer_steps_can_be_asked_for_as_gymnasium_does():
    envs = gym.make_vec(CLASSIC, 2, max_episode_steps=3)
    envs.reset(seed=0)
    truncated = [envs.step(np.zeros(2, int))[3].all() for _ in range(3)]
    assert truncated == [False, False, True]


def test_gymnasiums_statistics_of_episodes_work():
    envs = gym.wrappers.vector.RecordEpisodeStatistics(gym.make_vec(CLASSIC, 4, time_limit=0.5))
    envs.reset(seed=0)
    lengths = [
        infos["episode"]["l"][infos["_episode"]].tolist()
        for infos in (envs.step(np.zeros(4, int))[4] for _ in range(40))
        if "episode" in infos
    ]
    assert lengths == [[30, 30, 30, 30]]


def test_all_tables_can_be_rendered():
    envs = gym.make_vec(CLASSIC, 2, render_mode="rgb_array")
    envs.reset(seed=0)
    pictures = envs.render()
    assert [picture.shape for picture in pictures] == [(680, 330, 3)] * 2
    assert (pictures[0] != pictures[1]).any()


@pytest.mark.parametrize("options", [{}, {"observation": "pixels", "stack": 1, "size": (20, 12)}], ids=str)
def test_steps_can_write_to_the_arrays_of_a_trainer(options):
    envs = gym.make_vec(CLASSIC, 3, zero_copy=True, **options)
    plain = gym.make_vec(CLASSIC, 3, **options)
    space = envs.observation_space
    mine, over, cut = np.zeros(space.shape, space.dtype), np.zeros(3, bool), np.zeros(3, bool)
    assert envs.write_to(mine, over, cut)
    envs.reset(seed=0), plain.reset(seed=0)
    ends = 0
    for _ in range(600):
        envs.step(np.zeros(3, int))
        expected, _, terminated, truncated, _ = plain.step(np.zeros(3, int))
        assert mine.tolist() == expected.tolist()
        assert (over.tolist(), cut.tolist()) == (terminated.tolist(), truncated.tolist())
        ends += terminated.sum()
    assert ends


def test_arrays_that_do_not_fit_are_left_alone():
    flags = np.zeros(3, bool)
    envs = gym.make_vec(CLASSIC, 3, zero_copy=True)
    shape = envs.observation_space.shape
    assert not envs.write_to(np.zeros(shape, np.float64), flags, flags)
    assert not envs.write_to(np.zeros((3, 7), np.float32), flags, flags)
    assert not envs.write_to(np.zeros((shape[0], 2 * shape[1]), np.float32)[:, ::2], flags, flags)
    assert not gym.make_vec(CLASSIC, 3).write_to(np.zeros(shape, np.float32), flags, flags)
    stacked = gym.make_vec(CLASSIC, 3, zero_copy=True, observation="pixels")
    assert not stacked.write_to(np.zeros(stacked.observation_space.shape, np.uint8), flags, flags)


def test_environments_can_have_boards_of_their_own():
    envs = PinballVectorEnv(5, "SameStep", own_boards=True, boards=5, board_seed=40, time_limit=1.0)
    observations, infos = envs.reset(seed=7)
    assert infos["board"].tolist() == [40, 41, 42, 43, 44]
    singles = [PinballEnv(boards=1, board_seed=40 + number, time_limit=1.0) for number in range(5)]
    for number, env in enumerate(singles):
        assert env.reset(seed=7 + number)[0].tolist() == observations[number].tolist()
    for action in np.random.default_rng(0).integers(0, 4, (200, 5)):
        observations, rewards, terminated, truncated, infos = envs.step(action)
        assert infos["board"].tolist() == [40, 41, 42, 43, 44]
        for number, env in enumerate(singles):
            observation, *rest = env.step(int(action[number]))
            assert rest[:3] == [rewards[number], terminated[number], truncated[number]]
            if terminated[number] or truncated[number]:
                observation, _ = env.reset()
            assert observation.tolist() == observations[number].tolist()


def test_tables_can_be_given_one_by_one():
    classic = load_table("classic")
    bare = classic.model_copy(update={"triangular_prism": (), "cylinder": classic.cylinder[:2]})
    envs = PinballVectorEnv(4, own_boards=True, table=[bare, "classic"])
    observations, infos = envs.reset(seed=7)
    assert infos["board"].tolist() == [0, 1, 0, 1]
    assert envs.single_observation_space == PinballEnv(table="classic").observation_space
    assert observations in envs.observation_space
    fields = {field.group.name: field for field in envs._engine.pool.fields}
    prisms, cylinders = (fields[name] for name in ("triangular_prisms", "cylinders"))
    assert not observations[0, prisms.first : prisms.end].any()
    assert observations[1, prisms.first : prisms.end].all()
    shown = observations[:2, cylinders.first : cylinders.end]
    assert shown[0, :6].tolist() == shown[1, :6].tolist()
    assert not shown[0, 6:].any()
    alone = PinballEnv(table=[bare, "classic"])
    boards = {alone.reset(seed=seed)[1]["board"] for seed in range(20)}
    assert boards == {0, 1}, "a single one draws for every episode"
    for action in np.random.default_rng(0).integers(0, 4, (300, 4)):
        envs.step(action)
    pictures = PinballVectorEnv(2, own_boards=True, table=[bare, "classic"], observation="pixels", stack=1)
    empty, full = pictures.reset(seed=7)[0].astype(int)
    assert full.sum() > empty.sum()


def test_options_of_vectors_are_refused_for_single_environments():
    with pytest.raises(ValueError, match="for each of the 5 environments, and there are 3: pass boards=5"):
        PinballVectorEnv(5, own_boards=True, boards=3)
    for name in ("own_boards", "zero_copy", "autoreset_mode", "threads"):
        with pytest.raises(TypeError, match=f"'{name}': only vector environments take it"):
            PinballEnv(table="classic", **{name: 1})


def test_tables_that_do_not_fit_together_are_refused():
    classic, rolling = load_table("classic"), load_table("rolling")
    for tables, words in (
        ([classic, rolling], "table 1 of the list .* has a different"),
        ([classic, "random"], "table 1 of the list .* is a recipe"),
        ([], "empty"),
    ):
        with pytest.raises(ValueError, match=words):
            PinballVectorEnv(2, table=tables)
    with pytest.raises(TypeError, match="a list of them, got int"):
        PinballVectorEnv(2, table=[classic, 7])
