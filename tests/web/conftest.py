"""Pages that the tests open, each written once, and the browser that opens them."""

from __future__ import annotations

from pathlib import Path

import pytest

import browser as browser_module
from silverball.drawing.themes import THEMES
from silverball.game.game import Game
from silverball.game.replay.format import Replay
from silverball.table import Table, load_table
from silverball.web.page import game_page, replay_page, write_page
from silverball.web.replay_inputs import recording_of

HEIGHT = 360
SECONDS = 8


@pytest.fixture(scope="module")
def browser():
    if browser_module.MISSING:
        pytest.skip(browser_module.MISSING)
    with browser_module.browser() as found:
        yield found


def arcade_replay(table: Table | str, seed: int = 3, seconds: int = SECONDS) -> Replay:
    """An arcade game with all kinds of inputs: paddles, launches, shoves until it tilts, and balls."""
    game = Game(table, seed)
    for tick in range(0, 240 * seconds, 20):
        beat = tick // 20
        if not game.view.on_board and not game.is_over and not game.view.tilted:
            game.create_ball()
        if beat % 20 == 11 or 60 <= beat < 66:
            game.jitter()
        game.step(beat % 3 == 0, beat % 5 < 2, 20, launch=beat % 7 < 4)
    return game.replay


def write_replay_page(path: Path, replay: Replay) -> Path:
    write_page(path, replay_page(replay, recording_of(replay), THEMES["neon"], HEIGHT))
    return path


def write_game_page(path: Path, table: Table | str, seed: int = 7) -> Path:
    table = load_table(table) if isinstance(table, str) else table
    write_page(path, game_page(table, seed, THEMES["neon"], HEIGHT))
    return path


@pytest.fixture(scope="session", params=["classic", "parts"])
def replay_file(request, tmp_path_factory) -> tuple[Replay, Path]:
    """A replay and its page, on a plain board and on one with devices, levels and many balls."""
    replay = arcade_replay(request.param)
    return replay, write_replay_page(tmp_path_factory.mktemp("replay") / f"{request.param}.html", replay)


@pytest.fixture(scope="session", params=["classic", "parts"])
def game_file(request, tmp_path_factory) -> Path:
    """A page in which a table is played."""
    return write_game_page(tmp_path_factory.mktemp("game") / f"{request.param}.html", request.param)
