"""The trained player: it sees what the environments show, plays well, and presses the same everywhere."""

from __future__ import annotations

import numpy as np
import pytest

from silverball.errors import SilverballError
from silverball.players import PlayerKind, make_player
from silverball.players.ball_time import time_balls
from silverball.players.games import play
from silverball.players.sight import MIRRORED, SEEN, Raw, look, see
from silverball.players.trained import SCALE, Policy, Trained, hold_of, press_batch, stored_policy
from silverball.table import generate_table
from silverball.world import World, WorldBatch

COLUMNS = [1, 2, 3, 4, 10, 11, 12, 13, 14, 15]  # of a state observation, in the order of `Raw`
UNSEEN = 20_000  # seeds of boards that were not trained on


def tiny(first: float = 1.0) -> Policy:
    """A policy of one layer that presses by the first of what is seen."""
    weights = np.zeros((SEEN, 4))
    weights[0] = 0.0, first, 0.0, -first
    return Policy.rounded([(weights, np.zeros(4))], "by hand")


def random_rows(count: int) -> np.ndarray:
    return np.random.default_rng(4).uniform(-1.0, 1.0, (count, len(Raw)))


@pytest.mark.parametrize("table", ["random", "classic"])
def test_it_sees_what_the_environments_show(table):
    envs = pytest.importorskip("silverball.envs")
    vector = envs.PinballVectorEnv(16, table=table, boards=4)
    vector.reset(seed=1)
    random = np.random.default_rng(2)
    for _ in range(300):
        rows, *_ = vector.step(random.integers(0, 4, 16))
        batch = vector.batch
        raw = look(batch.state, batch.boards.board[batch.board_of], batch.boards.collider)
        np.testing.assert_allclose(raw, rows[:, COLUMNS], rtol=1e-6, atol=1e-7)


def test_the_mirror_answers_in_the_mirror():
    raw = random_rows(200)
    image = raw.copy()
    image[:, (Raw.Z, Raw.VZ)] *= -1.0
    image[:, Raw.LEFT_ANGLE : Raw.LEFT_HELD + 1] = raw[:, Raw.RIGHT_ANGLE :]
    image[:, Raw.RIGHT_ANGLE :] = raw[:, Raw.LEFT_ANGLE : Raw.LEFT_HELD + 1]
    seen, is_mirrored = see(raw)
    again, is_image_mirrored = see(image)
    assert (seen == again).all()
    assert (is_mirrored != is_image_mirrored).all()
    chosen = stored_policy().actions(raw)
    assert (stored_policy().actions(image) == MIRRORED[chosen]).all()
    assert len(set(chosen.tolist())) > 1


def test_sums_are_exact_in_any_order():
    raw = random_rows(64)
    policy = stored_policy()
    for row in range(0, 64, 8):
        values = [int(value) for value in np.rint(see(raw)[0][row] * SCALE)]
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
        for kind in (PlayerKind.RANDOM, PlayerKind.TRAINED)
    }
    _, _, high = points[PlayerKind.RANDOM]
    _, low, _ = points[PlayerKind.TRAINED]
    assert low > 3.0 * high


@pytest.mark.parametrize("tick_rate", [60, 240])
def test_alone_and_in_a_batch_it_presses_the_same(tick_rate):
    board = generate_table(UNSEEN)
    batch = WorldBatch([board], 3, 5, tick_rate)
    play(batch, PlayerKind.TRAINED, 6.0)
    for index in range(3):
        world, player = World(board, 5 + index, tick_rate), make_player("trained")
        for _ in range(6 * tick_rate):
            if not world.balls and world.tick % hold_of(tick_rate) == 0:
                world.create_ball()
            world.step(*player.press(world))
        assert (world.score, world.tick) == (batch.state["score"][index], batch.state["tick"][index])


def test_between_two_decisions_it_holds():
    world = World("classic", seed=3)
    player = Trained()
    world.create_ball()
    for _ in range(40):
        first = player.press(world)
        for _ in range(hold_of(world.tick_rate)):
            assert player.press(world) == first
            world.step(*first)


def test_it_looks_at_the_lowest_ball_and_rests_with_none():
    batch = WorldBatch("classic", 2)
    batch.create_balls(np.array([True, False]))
    batch.run(np.zeros((1, 2, 3), bool), 240)
    batch.create_balls(np.array([True, False]))
    raw = look(batch.state, batch.boards.board[batch.board_of], batch.boards.collider)
    lowest = batch.state["ball"]["x"][0].min() / batch.boards.board["half_length"][0]
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
def test_what_is_no_policy_is_refused_in_one_sentence(tmp_path, content):
    path = tmp_path / "p.npz"
    path.write_bytes(content)
    with pytest.raises(SilverballError, match=r"p\.npz is no policy") as caught:
        Policy.load(path)
    assert "\n" not in str(caught.value)


def test_arrays_that_do_not_fit_are_refused(tmp_path):
    path = tmp_path / "p.npz"
    np.savez(path, weights0=np.zeros((3, 4), np.int32), biases0=np.zeros(4, np.int32), command="x")
    with pytest.raises(SilverballError, match=f"expected {SEEN} at first"):
        Policy.load(path)
    np.savez(path, weights0=np.zeros((SEEN, 4), np.int32), biases0=np.full(4, 10**6), command="x")
    with pytest.raises(SilverballError, match="beyond"):
        Policy.load(path)
    np.savez(path, command="x")
    with pytest.raises(SilverballError, match="layers"):
        Policy.load(path)
