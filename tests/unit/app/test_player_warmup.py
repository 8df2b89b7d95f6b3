"""Players warmed up in the background: never half ready, and never compiled in the game's own process."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import pytest

from patience import PATIENCE
from silverball.app import player_warmup as warmup_module
from silverball.app.demo_players import BEST_PLAYER, DEMO_PLAYERS, FALLBACK_PLAYER, DemoPlayerSelector
from silverball.app.player_warmup import PlayerWarmup
from silverball.app.sessions import DemoSession
from silverball.players import make_player
from silverball.table import load_table

TABLE = load_table("classic")


@pytest.fixture(autouse=True)
def at_once(monkeypatch) -> None:
    monkeypatch.setattr(warmup_module, "START_DELAY", 0.0)


class Compiler:
    """Compiles nothing; `ends_well` is what it tells."""

    def __init__(self, ends_well: bool) -> None:
        self.calls, self.ends_well = 0, ends_well

    def finish(self, stop, most_seconds) -> bool:
        self.calls += 1
        return self.ends_well


def test_every_demo_player_gets_ready():
    warmup_module.compile_all()
    player_warmup = PlayerWarmup(TABLE)
    player_warmup.wait(PATIENCE)
    assert [player_warmup.is_ready(demo_player.name) for demo_player in DEMO_PLAYERS] == [True] * len(
        DEMO_PLAYERS
    )
    assert not player_warmup.is_ready("nobody")


@pytest.mark.campaign
@pytest.mark.parametrize("first", warmup_module.TABLES.values())
def test_what_is_compiled_for_one_table_is_not_taken_for_what_another_one_needs(tmp_path, first):
    """A player that is ready never compiles in the process of the game, which would stand still."""
    code = f"""
from silverball.app.demo_players import BEST_PLAYER
from silverball.app.player_warmup import TABLES, is_compiled_on_disk, warm_up_player
from silverball.table import load_table
for table in ({first!r}, *(set(TABLES.values()) - {{{first!r}}})):
    print(is_compiled_on_disk(BEST_PLAYER))
    warm_up_player(BEST_PLAYER, load_table(table))
print(is_compiled_on_disk(BEST_PLAYER))
"""
    environment = os.environ | {"SILVERBALL_CACHE": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=True,
    )
    assert done.stdout.split() == ["False", "False", "True"]


def test_closing_the_window_right_after_the_start_does_not_wait(monkeypatch):
    monkeypatch.setattr(warmup_module, "START_DELAY", PATIENCE)
    player_warmup = PlayerWarmup(TABLE)
    player_warmup.close()
    start = time.monotonic()
    player_warmup.wait(PATIENCE)
    assert time.monotonic() - start < PATIENCE / 2.0
    assert not player_warmup.is_ready(BEST_PLAYER.name)


@pytest.mark.parametrize("ends_well", [False, True])
def test_without_compiled_code_the_fallback_player_goes_on(monkeypatch, ends_well):
    compiler = Compiler(ends_well)
    monkeypatch.setattr(warmup_module, "_compiler", compiler)
    monkeypatch.setattr(warmup_module, "is_compiled_on_disk", lambda demo_player: not demo_player.kernel)
    pressed = []
    monkeypatch.setattr(
        warmup_module, "warm_up_player", lambda demo_player, table: pressed.append(demo_player)
    )
    player_warmup = PlayerWarmup(TABLE)
    player_warmup.wait(PATIENCE)
    assert compiler.calls == 1
    assert BEST_PLAYER not in pressed  # that would compile in this process
    assert not player_warmup.is_ready(BEST_PLAYER.name)
    assert player_warmup.is_ready(FALLBACK_PLAYER.name)


def test_a_player_that_fails_does_not_get_ready_and_stops_no_other(monkeypatch, unregistered):
    pressed = []

    def warm_up_player(demo_player, table):
        pressed.append(demo_player)
        if demo_player is BEST_PLAYER:
            raise ValueError("a fault")

    monkeypatch.setattr(warmup_module, "is_compiled_on_disk", lambda demo_player: True)
    monkeypatch.setattr(warmup_module, "warm_up_player", warm_up_player)
    player_warmup = PlayerWarmup(TABLE)
    player_warmup.wait(PATIENCE)
    assert pressed == list(DEMO_PLAYERS)
    assert not player_warmup.is_ready(BEST_PLAYER.name)


def test_the_requested_player_takes_over_once():
    ready = {FALLBACK_PLAYER.name}
    selector = DemoPlayerSelector(ready.__contains__)
    session = DemoSession(TABLE, 1, selector.select(BEST_PLAYER.name))
    assert (session.player.name, selector.playing) == ("reflex", FALLBACK_PLAYER)
    assert not selector.switch_when_ready(session)
    ready.add(BEST_PLAYER.name)
    assert selector.switch_when_ready(session)
    assert (session.player.name, selector.playing) == ("planner", BEST_PLAYER)
    planner = session.player
    assert not selector.switch_when_ready(session)
    assert session.player is planner  # it keeps its plan


def test_every_demo_player_is_a_player():
    names = [one.name for one in DEMO_PLAYERS]
    assert [make_player(name).name for name in names] == names
