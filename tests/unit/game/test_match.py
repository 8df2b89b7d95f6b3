"""A match is one machine that is handed on after each ball; it is recorded and proven like any other game."""

from __future__ import annotations

import random
from datetime import UTC, datetime
from functools import cache

import pytest

import silverball as sb
from rule_tables import Bench, with_rules
from silverball.game.game import Game
from silverball.game.replay.player import ReplayPlayer
from silverball.game.scores.store import Score
from silverball.game.scores.verify_score import CountedGames, verify_score
from silverball.game.view import GameEventKind, Phase
from silverball.physics.records import EventKind
from silverball.table import dump_table, load_table, table_digest

RULES = """
[[lamp]]
name = "mine"
lasts = "game"
[[counter]]
name = "rank"
[[mode]]
name = "long"
seconds = 60.0
lasts = "game"
[[rule]]
on_hit = "side target"
light = "mine"
start = "long"
add = { rank = 1 }
award = 100
[[rule]]
on_hit = "spinner"
extra_ball = 1
"""


class MatchBench(Bench):
    """A match whose events a test makes up."""

    def __init__(self, players: int) -> None:
        super().__init__(with_rules(RULES))
        game = Game(self.table, 1, players=players)
        self.game, self.keeper = game, game._keeper
        self.log, self.record = game.world._batch.logs[0], game.world.records[0]
        game.create_ball()

    def hit(self, *names: str) -> None:
        for name in names:
            self.happen_to_the_game(EventKind.HIT, name)

    def drain(self) -> None:
        self.happen_to_the_game(EventKind.GUTTER)

    def happen_to_the_game(self, kind: EventKind, part: str = "") -> None:
        """An event of the ball in play, between two ticks."""
        ball = int(self.keeper.record["ball"]["id"][0])
        self.log["count"], self.log["carried"], self.log["lost"] = 1, 0, 0
        event = self.log["event"][0]
        event["kind"], event["ball"], event["tick"] = kind, ball, self.record["tick"]
        event["part"] = self.number(part)
        said = self.keeper.played((), 0)
        self.game._apply(self.game._match.pass_on(said, self.game.tick))
        self.log["count"] = 0


def start(bench: MatchBench) -> None:
    """The player who is up starts a ball, as if the board were empty."""
    bench.game._apply(bench.keeper.started(50))


def past_the_save(bench: MatchBench) -> None:
    """No ball comes back any more."""
    bench.keeper.record["ball"]["saves"] = 0


def test_each_player_has_a_score_lamps_and_modes_of_their_own():
    bench = MatchBench(3)
    past_the_save(bench)
    bench.hit("side target")
    assert bench.game.scores == (100, 0, 0)
    bench.drain()
    view = bench.game.view
    assert (view.player, view.ball, view.score, view.phase) == (2, 1, 0, Phase.READY)
    assert view.scores == (100, 0, 0)
    assert (bench.game.lamps["mine"], bench.game.modes) == ("off", {})
    assert bench.game.ranks == (1, 0, 0)
    for _ in range(2):
        start(bench)
        past_the_save(bench)
        bench.drain()
    assert (bench.game.view.player, bench.game.view.ball) == (1, 2)
    assert bench.game.lamps["mine"] == "on"


def test_time_stands_still_for_those_who_wait():
    bench = MatchBench(2)
    past_the_save(bench)
    bench.hit("side target")
    bench.drain()
    start(bench)
    bench.game.step(ticks=480)
    past_the_save(bench)
    bench.drain()
    assert bench.game.view.player == 1
    assert bench.game.modes["long"] == pytest.approx(60.0, abs=0.01)


def test_an_extra_ball_stays_with_the_player():
    bench = MatchBench(2)
    past_the_save(bench)
    bench.hit("spinner")
    bench.drain()
    assert (bench.game.view.player, bench.game.view.ball) == (1, 1)
    start(bench)
    past_the_save(bench)
    bench.drain()
    assert bench.game.view.player == 2


def test_drop_targets_come_back_for_the_next_player():
    bench = MatchBench(2)
    past_the_save(bench)
    bench.keeper.record["fallen"] = bench.keeper.books.book.banks[0]["switches"]
    bench.record["off"] = bench.keeper.books.book.banks[0]["switches"]
    bench.drain()
    assert int(bench.record["off"]) == 0
    assert int(bench.keeper.record["fallen"]) == 0


@cache
def played(table: str, players: int, seed: int = 3) -> Game:
    """A match at random, to its end."""
    game, draw = Game(table, seed, players=players), random.Random(seed)
    while not game.is_over:
        if game.phase is Phase.READY:
            game.create_ball()
        game.step(draw.random() < 0.5, draw.random() < 0.5, ticks=20, launch=game.tick % 400 < 200)
    return game


@pytest.mark.parametrize("table", ["classic", "parts"])
def test_everyone_plays_three_balls_in_turn_and_the_best_score_is_that_of_the_match(table):
    game = played(table, 2)
    events = game.take_game_events()
    ups = [event.value for event in events if event.kind is GameEventKind.PLAYER_UP]
    assert ups == [2, 1, 2, 1, 2]
    overs = [event for event in events if event.kind is GameEventKind.OVER]
    assert [event.value for event in overs] == [max(game.scores)] == [game.score]
    assert game.view.scores == game.scores
    assert all(game.scores)


@pytest.mark.parametrize("table", ["classic", "parts"])
def test_the_replay_of_a_match_verifies_and_can_be_watched_from_anywhere(table):
    replay = sb.Replay.from_text(played(table, 2).replay.to_text())
    assert replay.players == 2
    assert replay.verify().ok
    player = ReplayPlayer(replay)
    player.seek(replay.ticks // 2)
    digest, scores = player.game.digest(), player.game.scores
    player.seek(replay.ticks)
    player.seek(replay.ticks // 2)
    assert (player.game.digest(), player.game.scores) == (digest, scores)


def with_checksum(text: str) -> str:
    from silverball.game.replay.reader import checksum

    body = text[: text.rindex("checksum = ")]
    return f"{body}checksum = {checksum(body)}\n"


def test_a_match_with_another_number_of_players_is_another_game():
    text = played("classic", 2).replay.to_text()
    forged = sb.Replay.from_text(with_checksum(text.replace("players = 2", "players = 3")))
    assert not forged.verify().ok


@pytest.mark.parametrize("players", ["0", "1", "5", "two", "-1", "2.0"])
def test_a_replay_with_an_impossible_number_of_players_is_refused_in_a_sentence(players):
    text = played("classic", 2).replay.to_text()
    with pytest.raises(sb.StateError, match=r"line 9: expected an integer from 2 to 4"):
        sb.Replay.from_text(with_checksum(text.replace("players = 2", f"players = {players}")))


@pytest.mark.parametrize("players", [0, 5, 2.0, "2"])
def test_an_impossible_number_of_players_is_refused(players):
    with pytest.raises(ValueError, match="players must be 1 to 4"):
        Game("classic", players=players)


def test_free_play_has_one_player():
    with pytest.raises(ValueError, match="take turns in arcade play"):
        Game("classic", mode="free", players=2)


def test_a_state_of_another_number_of_players_is_refused():
    state = Game("classic", players=2).save()
    with pytest.raises(sb.StateError, match="a game of 2 players, this one has 1"):
        Game("classic").restore(state)


def score_of(game: Game, player: int, id: int = 1) -> Score:
    table = load_table("classic")
    return Score(
        id, "ABC", game.scores[player - 1], "arcade", table.name, table_digest(table), game.seed,
        datetime.now(UTC), None, "", True, "", player, 0,
    )  # fmt: skip


def test_a_match_proves_the_score_of_each_player_once():
    game, counted = played("classic", 2), CountedGames()
    text, table = game.replay.to_text(), dump_table(load_table("classic"))
    first, second = score_of(game, 1, 1), score_of(game, 2, 2)
    assert first.score != second.score
    assert verify_score(first, text, table, counted).verified
    assert verify_score(second, text, table, counted).verified
    again = verify_score(second._replace(id=3), text, table, counted)
    assert "the same game as score 2" in again.why


def test_the_score_of_another_player_is_not_proven():
    game = played("classic", 2)
    swapped = score_of(game, 1)._replace(player=2)
    assert "its replay reaches" in verify_score(swapped, game.replay.to_text()).why
    third = score_of(game, 1)._replace(player=3)
    assert "has 2 players" in verify_score(third, game.replay.to_text()).why
