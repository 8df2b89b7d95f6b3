"""The PinBall domain: Gymnasium's contract, the published rewards, and the rules of the paper."""

from __future__ import annotations

import copy
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from silverball.benchmarks.domain_rules import DomainRules
from silverball.envs.domain.board_file import board_names, load_board
from silverball.envs.domain.board_table import SIDE, point_of, table_of
from silverball.errors import StateError, TableError

ID = "silverball/PinBallDomain-v1"
RIGHT, DOWN, LEFT, UP, NONE = range(5)


def board_file(tmp_path, text: str) -> str:
    path = tmp_path / "own.cfg"
    path.write_text(text, encoding="utf-8")
    return str(path)


@pytest.mark.parametrize("board", board_names())
def test_gymnasiums_checker_accepts_every_board(board):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gym.make(ID, board=board), skip_render_check=True)


def test_rewards_are_the_published_ones(tmp_path):
    env = gym.make(ID, board=board_file(tmp_path, "ball 0.02\nstart 0.5 0.5\ntarget 0.7 0.5 0.04\n"))
    env.reset(seed=0)
    assert env.step(NONE)[1:3] == (-1.0, False)
    rewards = [env.step(RIGHT)[1] for _ in range(4)]
    assert rewards == [-5.0] * 4
    while True:
        observation, reward, terminated, truncated, info = env.step(NONE)
        if terminated:
            break
        assert reward == -1.0
    assert (reward, truncated, info["in_target"]) == (10_000.0, False, True)
    assert np.hypot(observation[0] - 0.7, observation[1] - 0.5) == pytest.approx(0.04, abs=1e-6), "its edge"


def test_a_free_ball_moves_as_the_published_rules_move_it():
    env, rules = gym.make(ID, board="open"), DomainRules(load_board("open"))
    env.reset(seed=0)
    for action in [RIGHT, UP, UP, NONE, RIGHT, LEFT, DOWN, NONE, UP]:
        observation, reward, *_ = env.step(action)
        assert (reward, False) == rules.step(action)
        # The published ball moves in twenty roundings of doubles, and observations are float32.
        assert observation == pytest.approx(rules.state(), abs=1e-6)


def test_a_speed_is_clipped_in_each_component():
    env = gym.make(ID, board="open")
    env.reset(seed=0)
    state = env.unwrapped.save_state()
    for _ in range(14):
        observation = env.step(UP)[0]
        env.step(RIGHT)
    assert -observation[3] == pytest.approx(2.0 * 0.995, abs=1e-6)
    env.unwrapped.restore_state(state)
    assert env.unwrapped.observe().tolist() == pytest.approx([0.2, 0.9, 0.0, 0.0])


@pytest.mark.parametrize(("impulses", "after"), [([RIGHT] * 5, (-1, 0)), ([DOWN] * 5, (0, -1))])
def test_a_bounce_off_an_edge_of_the_board_is_elastic_and_exact(tmp_path, impulses, after):
    """An exact ball turns where it touches; the published one up to a move later."""
    text = "ball 0.02\nstart 0.9 0.9\ntarget 0.1 0.1 0.04\n"
    env = gym.make(ID, board=board_file(tmp_path, text))
    observation, _ = env.reset(seed=0)
    place, speed, direction = 0.9, 0.0, 1.0
    axis = 0 if impulses[0] == RIGHT else 1
    for action in [*impulses, *[NONE] * 15]:
        speed += 0.2 * direction if action != NONE else 0.0
        place += direction * speed * 0.02
        if place > 0.98:
            place, direction = 2 * 0.98 - place, -1.0
        speed *= 0.995
        observation = env.step(action)[0]
        assert observation[axis] == pytest.approx(place, abs=1e-6)
        assert observation[2 + axis] == pytest.approx(direction * speed, abs=1e-6)
    assert direction == -1.0
    assert np.sign(observation[2:]).tolist() == list(after)


def test_bounces_keep_the_speed_but_for_the_drag():
    env = gym.make(ID, board="rooms")
    env.reset(seed=3)
    for _ in range(9):
        env.step(UP), env.step(RIGHT)
    before = env.step(NONE)[0]
    for number in range(1, 200):
        observation, _, terminated, *_ = env.step(NONE)
        if terminated:
            break
        share = np.hypot(*observation[2:]) / np.hypot(*before[2:])
        assert share == pytest.approx(0.995**number, rel=1e-5)
    assert number > 50


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP", "DISABLED"])
def test_a_vector_is_its_single_environments_bit_for_bit(mode):
    options = {"board": "open", "max_steps": 70}
    envs = gym.make_vec(ID, 5, autoreset_mode=mode, threads=2, **options)
    singles = [gym.make(ID, **options) for _ in range(5)]
    rows, _ = envs.reset(seed=9)
    for number, single in enumerate(singles):
        assert (single.reset(seed=9 + number)[0] == rows[number]).all()
    over, rng = np.zeros(5, bool), np.random.default_rng(1)
    ends = 0
    for _ in range(300):
        actions = rng.integers(0, 5, 5)
        if mode == "DISABLED" and over.any():
            rows, _ = envs.reset(options={"reset_mask": over})
            for number in np.flatnonzero(over):
                assert (singles[number].reset()[0] == rows[number]).all()
        rows, rewards, terminated, truncated, infos = envs.step(actions)
        for number, single in enumerate(singles):
            if mode == "NEXT_STEP" and over[number]:
                assert (single.reset()[0] == rows[number]).all()
                assert (rewards[number], terminated[number], truncated[number]) == (0.0, False, False)
                continue
            row, *result, info = single.step(actions[number])
            assert result == [rewards[number], terminated[number], truncated[number]]
            if mode == "SAME_STEP" and (result[1] or result[2]):
                assert (infos["final_obs"][number] == row).all()
                assert infos["final_info"]["steps"][number] == info["steps"]
                row = single.reset()[0]
            assert (row == rows[number]).all()
        over = terminated | truncated
        ends += int(over.sum())
    assert ends >= 15


def test_a_ball_starts_at_each_of_several_places():
    env = gym.make(ID, board="rooms")
    places = {tuple(env.reset(seed=seed)[0][:2].round(3).tolist()) for seed in range(20)}
    assert len(places) == 2


def test_a_copy_and_a_saved_state_go_on_alike():
    env = gym.make(ID, board="steps")
    env.reset(seed=0)
    for action in [UP, RIGHT, RIGHT, UP]:
        env.step(action)
    twin, other = copy.deepcopy(env), gym.make(ID, board="steps").unwrapped
    other.restore_state(env.unwrapped.save_state())
    for action in np.random.default_rng(0).integers(0, 5, 300).tolist():
        steps = [one.step(action) for one in (env, twin, other)]
        assert steps[0][0].tolist() == steps[1][0].tolist() == steps[2][0].tolist()
        assert steps[0][1:] == steps[1][1:] == steps[2][1:]


def test_a_state_of_another_board_is_refused():
    env, other = (gym.make(ID, board=board).unwrapped for board in ("open", "wall"))
    env.reset(seed=0)
    with pytest.raises(StateError, match="of the board 'wall'"):
        other.restore_state(env.save_state())
    with pytest.raises(StateError, match="got str"):
        other.restore_state("state")


@pytest.mark.parametrize("action", [-1, 5, 1.5, None, "up"])
def test_an_invalid_action_is_refused(action):
    env = gym.make(ID)
    env.reset(seed=0)
    with pytest.raises(ValueError, match="action must be an integer from 0 to 4, got"):
        env.step(action)


def test_invalid_actions_of_a_vector_are_refused():
    envs = gym.make_vec(ID, 2)
    envs.reset(seed=0)
    with pytest.raises(ValueError, match=r"from 0 to 4, got 1 to 5"):
        envs.step([1, 5])
    with pytest.raises(ValueError, match=r"shape \(2,\), got"):
        envs.step([1, 2, 3])


def test_a_step_after_the_end_is_refused():
    env = gym.make(ID, max_steps=1)
    with pytest.raises(gym.error.ResetNeeded):
        env.step(0)
    env.reset(seed=0)
    assert env.step(0)[3]
    with pytest.raises(gym.error.ResetNeeded):
        env.step(0)


def test_a_board_is_drawn():
    env = gym.make(ID, board="rooms", render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    for _ in range(20):
        env.step(UP)
    assert first.dtype == np.uint8
    assert (first != env.render()).any()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no ball: add a line like `ball 0.02`"),
        ("ball 0.02\nstart 0.5 0.5\n", "has no target"),
        ("bal 0.02", "line 1: expected ball, target, start or polygon, got 'bal'"),
        ("ball 2 cm", "line 1: expected numbers after the first word, got 'cm'"),
        ("ball inf", "got 'inf'"),
        ("ball 0.02\nball 0.03", "line 2: a board has one ball, and this is the second"),
        ("ball 0.5", "line 1: the radius must be 0.01 to 0.2, got 0.5"),
        ("target 0.5 0.5", "line 1: expected `target x y radius`, got 2 numbers"),
        ("start 0.5", "line 1: expected `start x y x y …`, got 1 numbers"),
        ("# a comment\n\nstart 0.5 1.5", "line 3: a coordinate must be 0 to 1, got 1.5"),
        ("polygon 0 0 1 1 0 0", "line 1: a polygon must have 3 to 1000 different corners, got 2"),
        ("\x1b[31m 1", r"got '\x1b[31m'"),
    ],
)
def test_a_bad_file_is_refused_with_its_line(tmp_path, text, message):
    with pytest.raises(TableError) as caught:
        load_board(board_file(tmp_path, text))
    assert message in str(caught.value)
    assert "\x1b" not in str(caught.value)


def test_a_start_in_an_obstacle_or_in_the_target_is_refused(tmp_path):
    text = (
        "ball 0.02\ntarget 0.5 0.5 0.05\npolygon 0.1 0.1 0.3 0.1 0.3 0.3\nstart 0.5 0.52 0.2 0.1 0.01 0.5\n"
    )
    with pytest.raises(TableError) as caught:
        table_of(load_board(board_file(tmp_path, text)))
    assert [problem.path for problem in caught.value.problems] == [
        "start 0.5 0.52",
        "start 0.2 0.1",
        "start 0.01 0.5",
    ]


def test_an_unknown_board_is_refused_with_the_names():
    with pytest.raises(TableError, match="no board has this name; expected open, rooms, steps, wall"):
        gym.make(ID, board="hard")
    with pytest.raises(TableError, match="cfg"):
        gym.make(ID, board="nowhere/at_all.cfg")


def test_a_polygon_may_repeat_its_first_corner(tmp_path):
    text = "ball 0.02\ntarget 0.5 0.5 0.05\nstart 0.9 0.9\npolygon 0.1 0.1 0.3 0.1 0.3 0.3 0.1 0.1\n"
    board = load_board(board_file(tmp_path, text))
    assert board.polygons == (((0.1, 0.1), (0.3, 0.1), (0.3, 0.3)),)
    assert table_of(board).wall[1].points[0] == pytest.approx(point_of((0.1, 0.1)))
    assert point_of((1.0, 0.0)) == (0.5 * SIDE, 0.5 * SIDE)
