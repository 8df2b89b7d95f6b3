"""The missions network of the trained player: what it sees, where it plays, and that it plays well."""

from __future__ import annotations

import numpy as np
import pytest

import silverball as sb
from silverball.errors import SilverballError
from silverball.metrics.marked_games import play_marked_games
from silverball.players import make_player
from silverball.players.batch_policies import batch_policy
from silverball.players.exact_layers import SCALE, ExactLayers, rounded_layers
from silverball.players.mission_features import feature_count, mission_features
from silverball.players.mission_policy import ACTIONS, NAMED, MissionPolicy, _chance, mission_policy
from silverball.players.simple import press_launch
from silverball.players.trained import Trained, stored_policy, ticks_per_decision
from silverball.table import load_table

COMET = load_table("silver_comet")
NAMES = {"lamps": ("a", "b"), "counters": ("c",), "modes": ("d",)}
FEATURES = feature_count(2, 1, 1, 3)


def tiny() -> MissionPolicy:
    """A policy of one layer, by hand."""
    return MissionPolicy.rounded([(np.ones((FEATURES, ACTIONS)), np.zeros(ACTIONS))], NAMES, 3, "by hand")


def played(seconds: float, count: int = 3, seed: int = 5) -> tuple[sb.GameBatch, list[np.ndarray]]:
    """Some games under the trained player, and what was held in each block of four ticks."""
    batch = sb.GameBatch(COMET, count, seed)
    policy, blocks = batch_policy("trained", batch), []
    held = np.zeros((1, count, 4), bool)
    for _ in range(round(seconds * 60)):
        policy.decide()
        held[0, :, :2] = policy.buttons
        press_launch(batch.state, batch.boards.board, batch.board_of, 1.0 / 240, held)
        blocks.append(held[0].copy())
        batch.step(held[0], ticks=4)
    return batch, blocks


def test_alone_and_in_a_batch_it_presses_the_same():
    batch, blocks = played(30.0)
    for number in range(batch.count):
        game, player = sb.Game(COMET, 5 + number), make_player("trained")
        player.watch(game)
        for block in blocks:
            if not game.is_over and game.phase is sb.Phase.READY:
                game.create_ball()
            for _ in range(4):
                pressed = player.press(game.world)
                assert pressed == tuple(block[number, :2])
                game.step(*pressed, launch=bool(block[number, 3]))
        assert game.world.digest() == batch.digests()[number]
    assert len({tuple(row) for block in blocks for row in block[:, :2].tolist()}) > 1


def test_it_plays_the_same_twice_and_decides_fifteen_times_a_second():
    first, blocks = played(10.0)
    again, _ = played(10.0)
    assert first.digests() == again.digests()
    every = ticks_per_decision(240) // 4
    changes = [k for k in range(1, len(blocks)) if (blocks[k][:, :2] != blocks[k - 1][:, :2]).any()]
    assert changes
    assert all(k % every == 0 for k in changes)


def test_it_makes_more_points_than_reflex():
    points = {
        name: play_marked_games(COMET, name, 60, seed=60_000).games["score"] for name in ("reflex", "trained")
    }
    assert points["trained"].mean() > 1.25 * points["reflex"].mean()
    assert np.median(points["trained"]) > 1.25 * np.median(points["reflex"])


def test_on_other_tables_and_in_free_play_it_asks_the_network_for_any_table():
    for game in (sb.Game("classic", 1), sb.Game(COMET, 1, "free")):
        watching, plain = Trained(), Trained()
        watching.watch(game)
        game.create_ball()
        for _ in range(480):
            pressed = watching.press(game.world)
            assert pressed == plain.press(game.world)
            game.step(*pressed)
    batch = sb.GameBatch([COMET, load_table("classic")], 2)
    policy = batch_policy("trained", batch)
    assert policy._missions.rows.tolist() == [0]


def test_of_a_batch_of_two_tables_each_is_played_by_its_network():
    both = sb.GameBatch([COMET, load_table("classic")], 2, 8)
    alone = sb.GameBatch(COMET, 1, 8), sb.GameBatch("classic", 1, 9)
    policies = [batch_policy("trained", batch) for batch in (both, *alone)]
    for _ in range(200):
        for policy, batch in zip(policies, (both, *alone), strict=True):
            policy.decide()
            held = np.zeros((1, batch.count, 4), bool)
            held[0, :, :2] = policy.buttons
            press_launch(batch.state, batch.boards.board, batch.board_of, 1.0 / 240, held)
            batch.step(held[0], ticks=ticks_per_decision(240))
    assert both.digests() == (alone[0].digests() + alone[1].digests())


def test_it_refuses_a_table_that_it_has_not_learnt_in_one_sentence():
    policy = tiny()
    for table, message in (("classic", "and this one has 0"), ("silver_comet", "and this one has 34 ")):
        batch = sb.GameBatch(table, 1)
        assert not policy.fits(batch.books, batch.boards.board).any()
        with pytest.raises(SilverballError, match=message) as caught:
            policy.check(batch.books, batch.boards.board)
        assert "\n" not in str(caught.value)
    fewer = COMET.replace(drop_target=COMET.drop_target[:-1])
    batch = sb.GameBatch(fewer, 1)
    assert not mission_policy().fits(batch.books, batch.boards.board).any()
    with pytest.raises(SilverballError, match="drop targets and gates"):
        mission_policy().check(batch.books, batch.boards.board)
    batch = sb.GameBatch(COMET, 1)
    mission_policy().check(batch.books, batch.boards.board)


def test_a_policy_is_the_same_after_saving_and_files_that_are_none_are_refused(tmp_path):
    policy, path = tiny(), tmp_path / "p.npz"
    policy.save(path)
    again = MissionPolicy.load(path)
    assert (again.names, again.switches, again.command) == (policy.names, 3, "by hand")
    assert all(
        (a == b).all()
        for one, two in zip(again.layers, policy.layers, strict=True)
        for a, b in zip(one, two, strict=True)
    )
    stored_policy().save(tmp_path / "other.npz")
    (tmp_path / "text.npz").write_text("not a policy")
    for name in ("other.npz", "text.npz", "none.npz"):
        with pytest.raises(SilverballError, match="is not a policy written by") as caught:
            MissionPolicy.load(tmp_path / name)
        assert "\n" not in str(caught.value)


def test_no_sum_of_the_stored_policy_can_be_rounded():
    batch, _ = played(20.0, 8)
    board = batch.boards.board[batch.board_of]
    policy = mission_policy()
    features = mission_features(batch.state, batch.games, board, batch.boards.collider, policy.sizes, 240)
    assert np.abs(features).max() <= 4.0
    greatest = np.full(features.shape[1], 8.0) * SCALE  # of features twice as large as any can be
    for weights, biases in policy.layers:
        sums = greatest @ np.abs(weights.astype(float)) + np.abs(biases) * SCALE
        assert sums.max() < 2**53
        greatest = sums / SCALE + 1.0
    assert policy.command.startswith("python examples/train_missions.py")


def test_features_are_those_that_an_environment_shows():
    envs = pytest.importorskip("silverball.envs").PinballVectorEnv(
        8, table=COMET, rules=True, balls=3, frame_skip=4, recharge=0.8, observation="dict"
    )
    seen, _ = envs.reset(seed=1)
    random, names = np.random.default_rng(2), envs.rule_names
    lamps, counters, modes = (len(names[kind]) for kind in NAMED)
    first = feature_count(0, 0, 0, 0) - 1
    for _ in range(300):
        seen, *_ = envs.step(random.integers(0, 4, 8))
        batch = envs.batch
        features = mission_features(
            batch.state, envs.games.records, batch.boards.board[batch.board_of], batch.boards.collider,
            mission_policy().sizes, batch.tick_rate, envs.charge,
        )  # fmt: skip
        shown = features[:, first:]
        assert (shown[:, :lamps] == seen["lamps"][:, :, 0]).all()
        assert (shown[:, lamps : 2 * lamps] == seen["lamps"][:, :, 1]).all()
        running = 2 * lamps + counters
        assert (shown[:, running : running + modes] == seen["modes"][:, :, 0]).all()
        standing = running + 2 * modes
        assert (shown[:, standing:-1] == seen["switches"][:, :, 0]).all()
        np.testing.assert_allclose(shown[:, -1], seen["supply"][:, 0, 0], atol=1e-6)
    assert seen["lamps"].any()


def test_actions_are_drawn_as_often_as_their_outputs_say():
    outputs = np.array([[0.5, -1.0, 0.0, -30.0]])
    network = ExactLayers(rounded_layers([(outputs, np.zeros(4))]), 1, 4)
    count = 20_000
    chance = _chance(np.full(count, 7), 16 * np.arange(count))
    assert (chance >= 0.0).all()
    assert (chance < 1.0).all()
    drawn = network.drawn(np.ones((count, 1)), chance, 2.0)
    expected = np.exp(2.0 * outputs[0]) / np.exp(2.0 * outputs[0]).sum()
    np.testing.assert_allclose(np.bincount(drawn, minlength=4) / count, expected, atol=0.015)
    other = _chance(np.full(count, 8), 16 * np.arange(count))
    assert abs(np.corrcoef(chance, other)[0, 1]) < 0.03
    assert abs(np.corrcoef(chance[1:], chance[:-1])[0, 1]) < 0.03
    assert network.drawn(np.ones((2, 1)), np.array([0.0, 1.0 - 2.0**-53]), 2.0).tolist() == [0, 2]
