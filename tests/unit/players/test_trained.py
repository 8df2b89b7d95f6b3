"""The trained player: its features are those of the environments, it plays well and the same everywhere."""

from __future__ import annotations

import numpy as np
import pytest

from boards import LEFT, PADDLES, full_table, launched, table_of
from silverball.errors import SilverballError
from silverball.metrics.ball_time import time_balls
from silverball.players import make_player
from silverball.players.exact_layers import ROWS, SCALE
from silverball.players.features import COLUMNS, ENCODED, MIRRORED, Raw, encode, raw_features
from silverball.players.rollout import play
from silverball.players.trained import (
    Policy,
    Trained,
    press_batch,
    stored_policy,
    ticks_per_decision,
)
from silverball.table import Cylinder, generate_table
from silverball.world import World, WorldBatch

UNSEEN = 20_000  # seeds of boards that were not trained on


def tiny(first: float = 1.0) -> Policy:
    """A policy of one layer that presses by the first of what is seen."""
    weights = np.zeros((ENCODED, 4))
    weights[0] = 0.0, first, 0.0, -first
    return Policy.rounded([(weights, np.zeros(4))], "by hand")


def random_rows(count: int) -> np.ndarray:
    return np.random.default_rng(4).uniform(-1.0, 1.0, (count, len(Raw)))


@pytest.mark.parametrize("table", ["random", "classic"])
def test_its_features_are_those_of_the_environments(table):
    envs = pytest.importorskip("silverball.envs")
    vector = envs.PinballVectorEnv(16, table=table, boards=4)
    vector.reset(seed=1)
    random = np.random.default_rng(2)
    for _ in range(300):
        rows, *_ = vector.step(random.integers(0, 4, 16))
        batch = vector.batch
        raw = raw_features(batch.state, batch.boards.board[batch.board_of], batch.boards.collider)
        there = rows[:, 0] == 1.0  # else the episode is over: a lost ball is shown as zeros by both
        assert there.any()
        # The kernel multiplies by 1/size where this divides by it, then rounds to 32 bits.
        np.testing.assert_allclose(raw, rows[:, COLUMNS], rtol=6e-8, atol=1e-15)


def test_the_mirror_answers_in_the_mirror():
    raw = random_rows(200)
    image = raw.copy()
    image[:, (Raw.Z, Raw.VZ)] *= -1.0
    image[:, Raw.LEFT_ANGLE : Raw.LEFT_HELD + 1] = raw[:, Raw.RIGHT_ANGLE :]
    image[:, Raw.RIGHT_ANGLE :] = raw[:, Raw.LEFT_ANGLE : Raw.LEFT_HELD + 1]
    seen, is_mirrored = encode(raw)
    again, is_image_mirrored = encode(image)
    assert (seen == again).all()
    assert (is_mirrored != is_image_mirrored).all()
    chosen = stored_policy().actions(raw)
    assert (stored_policy().actions(image) == MIRRORED[chosen]).all()
    assert len(set(chosen.tolist())) > 1


def test_no_sum_of_the_stored_policy_can_be_rounded():
    greatest = (
        np.abs(encode(2.0 * random_rows(2000))[0]).max(axis=0) * SCALE
    )  # of numbers up to twice as large
    for weights, biases in stored_policy().layers:
        sums = greatest @ np.abs(weights.astype(float)) + np.abs(biases) * SCALE
        assert sums.max() < 2**53
        greatest = sums / SCALE + 1.0


def test_sums_are_those_of_integers():
    raw = random_rows(64)
    policy = stored_policy()
    for row in range(0, 64, 8):
        values = [int(value) for value in np.rint(encode(raw)[0][row] * SCALE)]
        for number, (weights, biases) in enumerate(policy.layers):
            if number > 0:
                values = [max(0, value) for value in values]
            sums = [
                sum(value * int(weight) for value, weight in zip(values, column, strict=True))
                + int(bias) * SCALE
                for column, bias in zip(weights.T, biases, strict=True)
            ]
            last = sums
            values = [round(one / SCALE) for one in sums]  # to even, like NumPy
        chosen = last.index(max(last))
        expected = int(MIRRORED[chosen]) if raw[row, Raw.Z] > 0.0 else chosen
        assert policy.actions(raw)[row] == policy.actions(raw[row : row + 1])[0] == expected


def test_it_makes_many_times_the_points_of_a_random_player_on_boards_never_trained_on():
    boards = [generate_table(UNSEEN + number) for number in range(60)]
    points = {
        kind: time_balls(WorldBatch(boards, len(boards), 0, 60), kind, 40.0).score
        for kind in ("random", "trained")
    }
    _, _, high = points["random"]
    _, low, _ = points["trained"]
    assert low > 3.0 * high


@pytest.mark.parametrize("tick_rate", [60, 240])
def test_alone_and_in_a_batch_it_presses_the_same(tick_rate):
    board = generate_table(UNSEEN)
    batch = WorldBatch(board, 3, 5, tick_rate)
    play(batch, "trained", 6.0)
    for index in range(3):
        world, player = World(board, 5 + index, tick_rate), make_player("trained")
        for _ in range(6 * tick_rate):
            if not world.balls and world.tick % ticks_per_decision(tick_rate) == 0:
                world.create_ball()
            world.step(*player.press(world))
        assert world.records[0].tobytes() == batch.state[index].tobytes()


def test_between_two_decisions_it_holds():
    world = World("classic", seed=3)
    player = Trained()
    world.create_ball()
    for _ in range(40):
        first = player.press(world)
        for _ in range(ticks_per_decision(world.tick_rate)):
            assert player.press(world) == first
            world.step(*first)


@pytest.mark.parametrize("ticks", [8, 45])
def test_it_has_no_state_and_continues_from_any_snapshot(ticks):
    world, player = launched(full_table(), (-3.0, -1.5, -6.0, 1.0)), make_player("trained")
    for _ in range(ticks):
        world.step(*player.press(world))
    saved = world.save()
    presses = []
    for other in (player, make_player("trained")):
        world.restore(saved)
        presses.append([])
        for _ in range(240):
            presses[-1].append(other.press(world))
            world.step(*presses[-1][-1])
    assert presses[0] == presses[1]
    assert len(set(presses[0])) > 1


def test_it_decides_fifteen_times_a_second_at_any_tick_rate():
    assert [ticks_per_decision(rate) for rate in (10, 15, 60, 240, 1000)] == [1, 1, 4, 16, 67]


def test_obstacles_do_not_change_its_presses():
    crowd = [
        Cylinder(center=(x, z), radius=0.3) for x in (-2.0, 0.0, 2.0, 4.0, 6.0) for z in (-3.0, 0.0, 3.0)
    ]
    pressed = set()
    for x, z, vx in ((-6.0, -1.5, -4.0), (-6.5, 1.0, -1.0), (3.0, 0.0, 2.0), (-6.3, -1.2, -6.0)):
        ball = (x, z, vx, 0.5)
        bare, crowded = launched(table_of(*PADDLES), ball), launched(table_of(*PADDLES, *crowd), ball)
        assert make_player("trained").press(bare) == make_player("trained").press(crowded)
        pressed.add(make_player("trained").press(bare))
    assert len(pressed) > 1


@pytest.mark.parametrize("paddles", [(), (LEFT,)], ids=["none", "left"])
def test_the_features_of_a_missing_paddle_are_zero(paddles):
    batch = WorldBatch(table_of(*paddles), 2, 1, tick_rate=60)
    batch.step_unchecked(np.ones((1, 2, 3), bool), 5)
    with np.errstate(all="raise"):
        raw = raw_features(batch.state, batch.boards.board[batch.board_of], batch.boards.collider)
    assert (raw[:, Raw.RIGHT_ANGLE :] == 0.0).all()
    assert (raw[:, Raw.LEFT_ANGLE : Raw.RIGHT_ANGLE] != 0.0).any() == bool(paddles)
    assert play(batch, "trained", 5.0).created > 0


def test_its_features_are_those_of_the_lowest_ball_and_zero_without_one():
    batch = WorldBatch("classic", 2, tick_rate=60)
    batch.create_balls(np.array([True, False]))
    batch.step_unchecked(np.zeros((1, 2, 3), bool), 240)
    batch.create_balls(np.array([True, False]))
    raw = raw_features(batch.state, batch.boards.board[batch.board_of], batch.boards.collider)
    lowest = batch.state["ball"]["x"][0, :2].min() / batch.boards.board["half_length"][0]
    assert raw[0, Raw.X] == lowest
    assert (raw[1, : Raw.VZ + 1] == 0.0).all()
    assert press_batch(batch).shape == (2, 2)


def test_a_policy_is_the_same_after_saving(tmp_path):
    policy = tiny()
    policy.save(tmp_path / "p.npz")
    again = Policy.load(tmp_path / "p.npz")
    raw = random_rows(50)
    assert again.command == "by hand"
    assert (again.actions(raw) == policy.actions(raw)).all()
    assert (tiny(-1.0).actions(raw) != policy.actions(raw)).any()


def test_the_stored_policy_says_how_it_was_made():
    assert stored_policy().command.startswith("python examples/train_sb3.py")


@pytest.mark.parametrize(
    "content", [b"", b"not a zip", b"PK\x03\x04 broken"], ids=["empty", "text", "broken zip"]
)
def test_a_file_that_is_not_a_policy_is_refused_in_one_sentence(tmp_path, content):
    path = tmp_path / "p.npz"
    path.write_bytes(content)
    with pytest.raises(SilverballError, match=r"p\.npz is not a policy") as caught:
        Policy.load(path)
    assert "\n" not in str(caught.value)


def test_arrays_that_do_not_fit_are_refused(tmp_path):
    path = tmp_path / "p.npz"
    np.savez(path, weights0=np.zeros((3, 4), np.int32), biases0=np.zeros(4, np.int32), command="x")
    with pytest.raises(SilverballError, match=f"expected {ENCODED} at first"):
        Policy.load(path)
    np.savez(
        path, weights0=np.zeros((ENCODED, 4), np.int32), biases0=np.full(4, 10**6, np.int32), command="x"
    )
    with pytest.raises(SilverballError, match="beyond"):
        Policy.load(path)
    np.savez(path, weights0=np.full((ENCODED, 4), np.nan), biases0=np.zeros(4, np.int32), command="x")
    with pytest.raises(SilverballError, match="32-bit integers"):
        Policy.load(path)
    np.savez(path, command="x")
    with pytest.raises(SilverballError, match="layers"):
        Policy.load(path)


def test_many_rows_give_the_same_actions_as_one_by_one():
    raw = np.random.default_rng(0).uniform(-1.0, 1.0, (2 * ROWS + 7, len(Raw)))
    bits = stored_policy().actions(raw)
    assert bits.tolist() == [int(stored_policy().actions(row[None])[0]) for row in raw]
    assert len(set(bits.tolist())) > 1
    assert stored_policy().actions(raw[:0]).shape == (0,)
