"""Arcade games of the built-in players come to the same points, messages and ends in a page as in Python."""

from __future__ import annotations

import hashlib
import json
from contextlib import suppress

import pytest

from silverball.drawing.themes import THEMES
from silverball.errors import NoRoom
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.game.replay.player import Playback
from silverball.players import make_player
from silverball.table import Table, load_table
from silverball.web.page import game_page, write_page
from silverball.web.replay_inputs import SIZE

PLAYERS = ("reflex", "random", "hold", "idle")
LONGEST = 180  # [s] of a game
BEAT = 12  # ticks between two looks of a player
FEW, MANY = 3, 125  # games of a player on a table
LOOK = 60  # ticks between two looks whether a ball waits for the player's launch
FOLLOW = """([replay, seed, look]) => {
  const { page, stage, meta, makeGame } = silverball, { Follower } = modules["follow.js"];
  silverball.isStopped = true;
  silverball.followed ??= makeGame(modules["game.js"].Game, stage.world, "arcade");
  stage.world.seed = seed;
  const follower = new Follower(silverball.followed, replay, true), said = [], waits = [];
  const take = () => said.push(...follower.game.takeEvents().map(({ kind, tick, value, text }) =>
    [kind, tick, text === undefined ? value : 0, text ?? ""]));
  while (!follower.isAtEnd) {
    follower.advance(look);
    take();
    waits.push(follower.game.hasBallToLaunch);
  }
  const { score, ended } = follower.game;
  return [score, ended, follower.differs, JSON.stringify([said, waits])];
}"""


def game_of(table: Table, name: str, seed: int) -> Replay:
    """An arcade game that a player plays, to its end or for `LONGEST`."""
    player, game = make_player(name, seed), Game(table, seed)
    while not game.is_over and game.tick < LONGEST * game.tick_rate:
        if not game.view.on_board and not game.view.tilted:
            with suppress(NoRoom):
                game.create_ball()
        game.step(*player.press(game.world), BEAT, launch=game.tick % 300 < 200)
        if game.tick % 1500 < BEAT and game.view.on_board:
            game.nudge(("left", "right", "up")[seed % 3])
    return game.replay


def as_in_the_page(replay: Replay) -> dict:
    return {
        "ticks": replay.ticks, "inputs": [*(line[SIZE:].strip() for line in replay.lines), replay.tail],
        "digests": [line[:SIZE] for line in replay.lines], "ended": replay.ended, "score": replay.score,
        "digest": replay.digest, "players": 1,
    }  # fmt: skip


def said_in(replay: Replay) -> list[list]:
    """All that the rules report, and whether a ball waits for the launch button, as Python plays it."""
    playback, said, waits = Playback(replay), [], []
    while playback.game.tick < replay.ticks:
        playback.play(min(LOOK, replay.ticks - playback.game.tick))
        said += playback.game.take_game_events()
        waits.append(playback.game.has_ball_to_launch)
    return [[[one.kind.name, one.tick, one.value, _text(one)] for one in said], waits]


def _text(event) -> str:
    return event.part if event.kind.name in ("MESSAGE", "CUE", "MODE_STARTED", "MODE_ENDED") else ""


def compare(browser, folder, name: str, games: int) -> None:
    table = load_table(name)
    path = folder / f"{name}.html"
    write_page(path, game_page(table, 0, THEMES["neon"], 120, has_sounds=False))
    ends, seen = set(), set()
    with browser.open(path) as page:
        for seed in range(games):
            for player in PLAYERS:
                replay = game_of(table, player, seed)
                score, ended, differs, said = page.evaluate(FOLLOW, [as_in_the_page(replay), seed, LOOK])
                where = f"{name}, {player}, seed {seed}"
                assert (score, ended, differs) == (replay.score, replay.ended, 0), where
                expected = said_in(replay)
                assert json.loads(said) == expected, where
                ends.add(ended)
                seen.add(hashlib.sha256(said.encode()).digest())
    assert "over" in ends
    assert len(seen) > games, "the games differ"


@pytest.mark.parametrize("name", ["classic", "silver_comet"])
def test_games_of_built_in_players_are_scored_as_in_python(browser, tmp_path, name):
    compare(browser, tmp_path, name, FEW)


@pytest.mark.campaign
@pytest.mark.parametrize("name", ["classic", "silver_comet"])
def test_a_thousand_games_are_scored_as_in_python(browser, tmp_path, name):
    compare(browser, tmp_path, name, MANY)
