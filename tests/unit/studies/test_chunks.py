"""Chunks of a study: pure functions of their seeds, that say what has happened in the games."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from silverball.game.game_batch import GameBatch
from silverball.metrics.marked_games import play_marked_games
from silverball.players.registry import register
from silverball.studies.chunk import Columns, run_chunk
from silverball.studies.played_game import replay_of
from silverball.studies.study_plan import Chunk, Plan, arms_of
from silverball.table import Table, load_table


def chunk(table: str | Table, player: str, first: int = 0, games: int = 12, longest: float = 30.0) -> Chunk:
    loaded = load_table(table) if isinstance(table, str) else table
    return Chunk(0, 0, loaded, player, first, games, longest, False)


def same(a: Columns, b: Columns) -> bool:
    return a.keys() == b.keys() and all(a[name].tobytes() == b[name].tobytes() for name in a)


def check_games(table: str, player: str, longest: float = 30.0) -> Columns:
    """The games are those of a batch with marks, and the sums are what their parts sum up to."""
    found = run_chunk(chunk(table, player, longest=longest))
    marked = play_marked_games(load_table(table), player, 12, longest=longest)
    assert found["game.score"].tolist() == marked.games["score"].tolist()
    assert found["game.ticks"].tolist() == marked.mark["ticks"].tolist()
    assert found["game.longest_stay"].tolist() == marked.mark["longest_stay"].tolist()
    assert found["sum.hits"].tolist() == marked.hits.sum(axis=0).tolist()
    assert found["sum.points"].sum() == found["game.score"].sum() == found["ball.score"].sum()
    assert found["sum.place"].sum() == found["game.samples"].sum()
    assert found["sum.drains"].sum() == found["game.drained"].sum()
    assert found["ball.ticks"].sum() == found["game.ticks"].sum()
    assert (found["sum.shots"] <= found["sum.place"]).all()
    assert found["sum.first"].sum() <= found["game.strikes"].sum()
    return found


@pytest.mark.parametrize(
    ("player", "longest"), [("idle", 30.0), ("reflex", 30.0), ("beginner", 30.0), ("trained", 3.0)]
)
def test_the_games_of_a_chunk_are_those_of_a_batch(player: str, longest: float):
    found = check_games("classic", player, longest)
    assert found["sum.stays"].max() == found["game.longest_stay"].max()
    assert found["game.hits"].min() > 0


@pytest.mark.slow
@pytest.mark.parametrize("player", ["idle", "reflex"])
def test_the_games_of_a_table_with_rules_and_devices_are_those_of_a_batch(player: str):
    check_games("silver_comet", player)


def test_a_chunk_does_not_depend_on_threads_or_on_how_games_are_split():
    whole = run_chunk(chunk("classic", "reflex"), threads=1)
    assert same(whole, run_chunk(chunk("classic", "reflex"), threads=3))
    parts = [run_chunk(chunk("classic", "reflex", first, 6)) for first in (0, 6)]
    for name, values in whole.items():
        if name.startswith(("game.", "ball.")):
            assert values.tobytes() == np.concatenate([part[name] for part in parts]).tobytes()
        elif name == "sum.stays":
            assert (values == np.maximum(parts[0][name], parts[1][name])).all()
        elif name.startswith("sum."):
            assert (values == parts[0][name] + parts[1][name]).all()


def test_a_recipe_has_a_board_for_each_game():
    found = run_chunk(chunk("random", "reflex", 5, 4))
    one = run_chunk(chunk("random", "reflex", 7, 1))
    assert found["game.score"][2] == one["game.score"][0]
    assert len(set(found["game.score"].tolist())) == 4


def test_events_are_kept_if_asked_and_change_nothing():
    asked = chunk("classic", "reflex", games=3)._replace(keeps_events=True)
    found, plain = run_chunk(asked), run_chunk(chunk("classic", "reflex", games=3))
    assert same({name: one for name, one in found.items() if not name.startswith("event.")}, plain)
    assert (found["event.kind"] == 1).sum() == found["game.hits"].sum()
    assert (np.diff(found["event.game"]) >= 0).all()


def test_rows_that_fill_their_sheet_are_all_kept(monkeypatch):
    asked = chunk("classic", "reflex", games=6)._replace(keeps_events=True)
    expected = run_chunk(asked, threads=1)
    monkeypatch.setattr("silverball.studies.chunk.BALLS_A_GAME", 0)
    monkeypatch.setattr("silverball.studies.chunk.EVENT_BLOCKS", 1)
    assert same(expected, run_chunk(asked, threads=1))
    assert len(expected["ball.game"]) > 8
    assert len(expected["event.game"]) > 400


@dataclass
class Flutter:
    """A player of its own: presses the left button every other tick."""

    turn: int = 0

    def press(self, world: object) -> tuple[bool, bool]:
        self.turn += 1
        return self.turn % 2 == 0, False


def test_a_registered_player_plays_a_chunk_whatever_its_size(monkeypatch):
    from silverball.players import registry

    monkeypatch.setattr(registry, "_registered", dict(registry._registered))
    register("flutter", Flutter)
    whole = run_chunk(chunk("classic", "flutter", games=3, longest=5.0))
    one = run_chunk(chunk("classic", "flutter", 2, 1, longest=5.0))
    assert whole["game.score"][2] == one["game.score"][0]


@pytest.mark.parametrize("player", ["reflex", "beginner"])
def test_a_game_of_a_study_is_recorded_as_it_was_played(player: str):
    found = run_chunk(chunk("classic", player, 3, 1, longest=20.0))
    replay = replay_of(load_table("classic"), player, 3, 20.0)
    assert replay.score == found["game.score"][0]
    assert replay.verify().ok


def test_the_chunks_of_a_plan_cover_its_games_once_for_each_arm():
    tables = [("classic", load_table("classic")), ("original", load_table("original"))]
    plan = Plan(arms_of(tables, ["idle", "reflex"]), games=777, seed=5)
    chunks = list(plan.chunks())
    assert [one.number for one in chunks] == list(range(plan.chunk_count()))
    for number, arm in enumerate(plan.arms):
        of_arm = [one for one in chunks if one.arm == number]
        seeds = [seed for one in of_arm for seed in range(one.first_seed, one.first_seed + one.games)]
        assert seeds == list(range(5, 782))
        assert {one.player for one in of_arm} == {arm.player}


def test_a_batch_of_games_is_what_its_kernel_gets():
    batch = GameBatch("classic", 2)
    assert batch.game_rows().games is batch.games
