"""Games with rules of the table are functions of their inputs: saved, replayed, in batches, interpreted."""

from __future__ import annotations

import dataclasses
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import silverball as sb
from rule_tables import comet
from silverball.errors import StateError
from silverball.game.replay.format import Replay

TESTS = Path(__file__).parents[2]
RATE = 240


def buttons(tick: int) -> tuple[bool, bool, bool]:
    """Left, right and launch, held in a pattern that presses each of them often."""
    return tick % 130 < 40, tick % 170 < 60, tick % 480 < 200


def play(game: sb.Game, ticks: int, at_once: int = 1) -> sb.Game:
    """Play with the pattern, so many ticks a call; balls are started as soon as they may be."""
    end = game.tick + ticks
    while game.tick < end and not game.is_over:
        if game.phase is sb.Phase.READY and game.tick % 10 == 0:
            game.create_ball()
        left, right, launch = buttons(game.tick // 10 * 10)
        game.step(left, right, min(at_once, end - game.tick), launch=launch)
    return game


@pytest.mark.parametrize("ticks", [1, 777, 3001, 9600])
def test_a_game_goes_on_from_a_saved_moment_bit_for_bit(ticks: int):
    one = play(sb.Game(comet(), 4), ticks)
    other = sb.Game(comet(), 4)
    other.restore(one.save())
    assert (other.digest(), other.lamps, other.counters, other.modes) == (
        one.digest(), one.lamps, one.counters, one.modes,
    )  # fmt: skip
    assert play(one, 2400).digest() == play(other, 2400).digest()
    assert one.score > 0 or ticks == 1


def test_ticks_played_one_by_one_or_many_at_once_give_the_same_game():
    one, many = sb.Game(comet(), 8), sb.Game(comet(), 8)
    events: dict[int, list[object]] = {1: [], 10: []}
    for game, at_once in ((one, 1), (many, 10)):
        for _ in range(24):
            play(game, 500, at_once)
            events[at_once] += game.take_game_events()
    assert one.digest() == many.digest()
    assert events[1] == events[10]
    assert one.score > 0


def test_a_replay_of_a_table_with_rules_verifies_and_a_forged_rule_is_found():
    game = play(sb.Game(comet(), 4), 9600)
    replay = Replay.from_text(game.replay.to_text())
    assert replay.verify().ok
    rules = replay.table.rule
    richer = (rules[0].replace(award=1), *rules[1:])
    dearer = dataclasses.replace(replay, table=replay.table.replace(rule=richer))
    assert not dearer.verify().ok
    assert not dataclasses.replace(replay, score=replay.score + 1).verify().ok


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"lamp":[0', '"lamp":[7'),
        ('"lamp":[0', '"lamp":[0,0'),
        ('"counter":[', '"counter":["x",'),
        ('"mode_end":[', '"mode_end":[-2,'),
        ('"locked":0', '"locked":1e400'),
        ('"table":{', '"tables":{'),
    ],
)
def test_an_impossible_saved_state_is_refused_and_changes_nothing(old: str, new: str):
    from silverball.game.saved_game import pack_game

    game = play(sb.Game(comet(), 4), 1200)
    text = game.rules_text
    assert old in text
    before = game.digest()
    forged = pack_game(game.mode, game.ended, game.world.save(), text.replace(old, new, 1))
    with pytest.raises(StateError):
        game.restore(forged)
    assert game.digest() == before


def test_a_state_of_a_table_with_rules_is_not_one_of_a_table_without():
    plain = sb.Game("parts", 4)
    with pytest.raises(StateError):
        plain.restore(sb.Game(comet(), 4).save())


def test_games_of_a_batch_are_single_games():
    count, ticks = 5, 12_000
    batch = sb.GameBatch(comet(), count, seed=40)
    games = [sb.Game(comet(), 40 + number) for number in range(count)]
    for _ in range(ticks // 10):
        left, right, launch = buttons(int(batch.state["tick"].max()) // 10 * 10)
        batch.step(np.tile([left, right, False, launch], (count, 1)), 10)
    for game, record, digest in zip(games, batch.games, batch.digests(), strict=True):
        while game.tick < ticks and not game.is_over:
            if game.phase is sb.Phase.READY:
                game.create_ball()
            left, right, launch = buttons(game.tick // 10 * 10)
            game.step(left, right, launch=launch)
        assert game.world.digest() == digest
        assert game._keeper.record.tobytes() == record.tobytes()
    assert batch.games["score"].max() > 0
    assert batch.games["over"].any()


def test_games_of_a_batch_are_saved_and_restored():
    batch = sb.GameBatch(comet(), 3, seed=2)
    held = np.array([[True, False, False, True], [False, True, False, True], [True, True, True, True]])
    batch.step(held, 300)
    saved = batch.save_games()
    for _ in range(2):
        batch.step(held & [True, True, True, False], 1000)
        batch.step(held, 1000)
        after = batch.game_digests()
        batch.restore_games(saved)
    assert batch.game_digests() != after
    batch.restore_games(batch.save_games(1), [0, 2])
    assert len(set(batch.game_digests())) == 1
    with pytest.raises(StateError, match="other rules"):
        sb.GameBatch("parts", 3).restore_games(saved)


SCRIPT = """
import sys
sys.path.insert(0, {tests!r})
from unit.game.test_table_rules_bits import play
from rule_tables import Bench, comet
import silverball as sb
one = Bench(comet())
one.hit("lane A", "side target", "right orbit", "saucer", "left drop target", "spinner")
one.wait(12_000)
one.drain()
print(one.game.rules_text, play(sb.Game(comet(), 4), 700).digest())
"""


def test_rules_without_the_compiler_give_the_same_game():

    answers = []
    for extra in ({}, {"NUMBA_DISABLE_JIT": "1"}):
        script = SCRIPT.format(tests=str(TESTS))
        run = subprocess.run(
            [sys.executable, "-c", script],
            capture_output=True,
            text=True,
            env=os.environ | extra,
            check=False,
        )
        assert run.returncode == 0, run.stderr
        answers.append(run.stdout)
    assert answers[0] == answers[1]
