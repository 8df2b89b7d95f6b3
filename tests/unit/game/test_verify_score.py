"""A score is proven exactly if its replay is of that game, on that table, and reaches it.

What a forger writes into the file is tried in `tests/cli/test_forged_scores.py`.
"""

from __future__ import annotations

from datetime import UTC, datetime

import pytest

from silverball.game.game import Game
from silverball.game.scores.store import Score
from silverball.game.scores.verify_score import CountedGames, verify_score
from silverball.table import Table, dump_table, load_table, table_digest

SEED = 5


def played(name: Table | str, seed: int = SEED, mode: str = "arcade") -> tuple[Score, str]:
    """A game that reached some points: its score and its replay."""
    table = load_table(name) if isinstance(name, str) else name
    game = Game(table, seed=seed, mode=mode)
    while not game.score:
        if not game.view.on_board:
            game.create_ball()
        game.step(left=game.tick % 100 < 50, right=game.tick % 100 > 50, ticks=10)
    game.end()
    now = datetime.now(UTC)
    score = Score(1, "ABC", game.score, mode, table.name, table_digest(table), seed, now, None, "", True)
    return score, game.replay.to_text()


@pytest.mark.parametrize("name", ["classic", "random"])
@pytest.mark.parametrize("mode", ["arcade", "free"])
def test_a_game_that_was_played_proves_its_score(name, mode):
    score, text = played(name, mode=mode)
    assert verify_score(score, text) == (True, "")


@pytest.mark.parametrize("name", ["classic", "random"])
@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"score": 1_000_001}, "its replay reaches"),
        ({"seed": SEED + 1}, f"the seed is {SEED}, not {SEED + 1}"),
        ({"mode": "free"}, "the mode is arcade, not free"),
        ({"table_digest": table_digest(load_table("rolling"))}, "its list is called"),
    ],
)
def test_a_changed_score_is_not_proven(name, change, why):
    score, text = played(name)
    verified, reason = verify_score(score._replace(**change), text)
    assert verified is False
    assert why in reason


def test_the_replay_of_another_board_proves_nothing():
    on_random, _ = played("random")
    _, text = played("classic")
    verified, why = verify_score(on_random, text)
    assert verified is False
    assert "another game: the table is 'Classic', not " in why


@pytest.mark.parametrize("name", ["classic", "random"])
def test_a_table_that_is_not_available_proves_nothing_and_one_that_is_kept_does(name):
    table = load_table(name).model_copy(update={"name": "Mine"})
    score, text = played(table)
    verified, why = verify_score(score, text)
    assert verified is False
    assert "not available" in why
    assert verify_score(score, text, dump_table(table)) == (True, "")


@pytest.mark.parametrize("name", ["classic", "random"])
def test_a_game_is_counted_once(name):
    (first, text), counted = played(name), CountedGames()
    assert verify_score(first, text, counted=counted).verified
    again = first._replace(id=2, initials="XYZ")
    assert verify_score(again, text, counted=counted) == (
        False,
        "it is the same game as score 1, which is counted",
    )
    other, its_text = played(name, seed=SEED + 1)
    assert verify_score(other, its_text, counted=counted).verified


def test_a_rejected_score_does_not_count_its_game():
    (score, text), counted = played("classic"), CountedGames()
    assert not verify_score(score._replace(score=score.score + 1), text, counted=counted).verified
    assert verify_score(score._replace(id=2), text, counted=counted).verified


@pytest.mark.parametrize("text", ["", "nothing", "silverball replay 1\n", "\0" * 100])
def test_text_that_is_not_a_replay_proves_nothing_and_says_so_in_a_sentence(text):
    score, _ = played("classic")
    verified, why = verify_score(score, text)
    assert verified is False
    assert len(why.splitlines()) == 1


def test_a_replay_whose_text_was_changed_proves_nothing():
    score, text = played("classic")
    assert verify_score(score, text.replace("\n", "\n\n", 1))[0] is False


@pytest.mark.parametrize("key", ["physics", "rules"])
def test_a_replay_of_another_version_is_not_proven_and_says_what_to_do(key):
    score, text = played("classic")
    changed = text.replace(f"{key} = ", f"{key} = 9", 1)
    assert changed != text
    verified, why = verify_score(score, changed)
    assert verified is False
    assert "get a newer Silverball" in why
