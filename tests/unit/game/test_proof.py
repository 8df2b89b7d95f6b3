"""Is a score believed exactly if its replay is of that game and reaches it?"""

from __future__ import annotations

from datetime import UTC, datetime

import pytest

from silverball.game.game import Game
from silverball.game.proof import prove
from silverball.game.store import Score
from silverball.table import load_table, table_digest

SEED = 5


def played(name: str, seed: int = SEED, mode: str = "arcade") -> tuple[Score, str]:
    """A game that reached some points: its score and its replay."""
    game = Game(name, seed=seed, mode=mode)
    while not game.score:
        if not game.face.on_board:
            game.create_ball()
        game.advance(left=game.tick % 100 < 50, right=game.tick % 100 > 50, ticks=10)
    game.end()
    table = load_table(name)
    now = datetime.now(UTC)
    score = Score(1, "ABC", game.score, mode, table.name, table_digest(table), seed, now, None, "", True)
    return score, game.replay.to_text()


@pytest.mark.parametrize("name", ["classic", "random"])
@pytest.mark.parametrize("mode", ["arcade", "free"])
def test_a_game_that_was_played_proves_its_score(name, mode):
    score, text = played(name, mode=mode)
    assert prove(score, text) == (True, "")


@pytest.mark.parametrize("name", ["classic", "random"])
@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"score": 1_000_001}, "its replay reaches"),
        ({"seed": SEED + 1}, f"the seed is {SEED}, not {SEED + 1}"),
        ({"mode": "free"}, "the mode is arcade, not free"),
        ({"table_digest": table_digest(load_table("rolling"))}, "the table is"),
    ],
)
def test_a_score_that_was_changed_is_not_believed(name, change, why):
    score, text = played(name)
    verified, reason = prove(score._replace(**change), text)
    assert verified is False
    assert why in reason


def test_the_replay_of_another_board_proves_nothing():
    on_random, _ = played("random")
    _, text = played("classic")
    assert prove(on_random, text) == (False, "its replay is of another game: the table is 'Classic'")


def test_a_board_of_a_recipe_that_is_not_at_hand_is_believed():
    score, text = played("random")
    assert prove(score._replace(table_digest="of a file of somebody"), text) == (True, "")


@pytest.mark.parametrize("text", ["", "nothing", "silverball replay 1\n", "\0" * 100])
def test_what_is_no_replay_proves_nothing_and_says_so_in_a_sentence(text):
    score, _ = played("classic")
    verified, why = prove(score, text)
    assert verified is False
    assert len(why.splitlines()) == 1


def test_a_replay_whose_text_was_changed_proves_nothing():
    score, text = played("classic")
    assert prove(score, text.replace("\n", "\n\n", 1))[0] is False


@pytest.mark.parametrize("key", ["physics", "rules"])
def test_a_replay_of_another_version_is_neither_true_nor_false(key):
    score, text = played("classic")
    changed = text.replace(f"{key} = ", f"{key} = 9", 1)
    assert changed != text
    verified, why = prove(score, changed)
    assert verified is None
    assert "another version" in why
