"""How players get ready in the background: never half, and never compiled in the game's own process."""

from __future__ import annotations

import time

import pytest

from silverball.app import player_warmup as rehearsal_module
from silverball.app.demo_players import BEST, PERFORMERS, STAND_IN, DemoPlayers
from silverball.app.player_warmup import Rehearsal
from silverball.app.sessions import DemoSession
from silverball.players import make_player
from silverball.table import load_table

TABLE = load_table("classic")
PATIENCE = 300.0  # [s], which only a fault takes


@pytest.fixture(autouse=True)
def at_once(monkeypatch) -> None:
    monkeypatch.setattr(rehearsal_module, "HEAD_START", 0.0)


class Compiler:
    """Compiles nothing; `ends_well` is what it tells."""

    def __init__(self, ends_well: bool) -> None:
        self.calls, self.ends_well = 0, ends_well

    def finish(self, stop, most_seconds) -> bool:
        self.calls += 1
        return self.ends_well


def test_every_performer_gets_ready():
    rehearsal_module.compile_all()
    rehearsal = Rehearsal(TABLE)
    rehearsal.wait(PATIENCE)
    assert [rehearsal.is_ready(performer.name) for performer in PERFORMERS] == [True] * len(PERFORMERS)
    assert not rehearsal.is_ready("nobody")


def test_who_closes_the_window_at_once_waits_for_nobody(monkeypatch):
    monkeypatch.setattr(rehearsal_module, "HEAD_START", PATIENCE)
    rehearsal = Rehearsal(TABLE)
    rehearsal.close()
    start = time.monotonic()
    rehearsal.wait(PATIENCE)
    assert time.monotonic() - start < PATIENCE / 2.0
    assert not rehearsal.is_ready(BEST.name)


@pytest.mark.parametrize("ends_well", [False, True])
def test_without_compiled_code_the_stand_in_goes_on(monkeypatch, ends_well):
    compiler = Compiler(ends_well)
    monkeypatch.setattr(rehearsal_module, "_compiler", compiler)
    monkeypatch.setattr(rehearsal_module, "is_there", lambda performer: not performer.kernel)
    pressed = []
    monkeypatch.setattr(rehearsal_module, "press_once", lambda performer, table: pressed.append(performer))
    rehearsal = Rehearsal(TABLE)
    rehearsal.wait(PATIENCE)
    assert compiler.calls == 1
    assert BEST not in pressed  # that would compile in this process
    assert not rehearsal.is_ready(BEST.name)
    assert rehearsal.is_ready(STAND_IN.name)


def test_a_player_that_fails_does_not_get_ready_and_stops_nobody_else(monkeypatch):
    pressed = []

    def press_once(performer, table):
        pressed.append(performer)
        if performer is BEST:
            raise ValueError("a fault")

    monkeypatch.setattr(rehearsal_module, "is_there", lambda performer: True)
    monkeypatch.setattr(rehearsal_module, "press_once", press_once)
    rehearsal = Rehearsal(TABLE)
    rehearsal.wait(PATIENCE)
    assert pressed == list(PERFORMERS)
    assert not rehearsal.is_ready(BEST.name)


def test_the_one_who_was_asked_for_takes_over_once():
    ready = {STAND_IN.name}
    cast = DemoPlayers(ready.__contains__)
    stage = DemoSession(TABLE, 1, cast.begin(BEST.name))
    assert (stage.player.name, cast.playing) == ("reflex", STAND_IN)
    assert not cast.follow(stage)
    ready.add(BEST.name)
    assert cast.follow(stage)
    assert (stage.player.name, cast.playing) == ("planner", BEST)
    planner = stage.player
    assert not cast.follow(stage)
    assert stage.player is planner  # it keeps its plan


def test_every_performer_is_a_player():
    for performer in PERFORMERS:
        assert make_player(performer.name).name == performer.name
