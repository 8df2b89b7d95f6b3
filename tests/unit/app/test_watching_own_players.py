"""Registered players under WATCH: offered in the menu, watched once they are ready, stopped if they fail."""

from __future__ import annotations

import pytest

from evenings import Evening
from own_players import LEFTY, Swatter, install
from silverball.app import player_warmup
from silverball.app.demo_players import DEMO_PLAYERS, REGISTERED_HINT, demo_players
from silverball.app.player_warmup import PlayerWarmup
from silverball.players import player_names, register
from silverball.table import load_table

pytestmark = pytest.mark.usefixtures("unregistered")


class Failing:
    """A player that cannot play."""

    def press(self, world):
        raise ZeroDivisionError("no luck")


@pytest.fixture
def evening(tmp_path):
    made = Evening(tmp_path / "scores")
    made.program.finish_loading()
    made.program.demo_players.is_ready = lambda name: True
    made.program.menus.close()
    yield made
    made.store.close()


def test_registered_players_are_offered_after_the_built_in_ones() -> None:
    register("swatter", Swatter)
    *first, last = demo_players()
    assert tuple(first) == DEMO_PLAYERS
    assert (last.name, last.label, last.hint) == ("swatter", "SWATTER", REGISTERED_HINT)


def test_a_registered_player_is_watched_once_it_is_ready(evening, site) -> None:
    install(site, "left-hand", "lefty = left_hand:Lefty", LEFTY)
    assert demo_players() == DEMO_PLAYERS
    player_names()  # as the window does in its thread
    evening.program.start_demo("lefty")
    evening.go(0.5)
    assert evening.program.session.player.name == "lefty"
    assert evening.program.display.player_label == "LEFTY"
    assert evening.program.session.game.tick > 0


def test_a_watched_player_that_fails_brings_the_menu_back_and_its_sentence(evening) -> None:
    register("mine", Failing)
    evening.program.start_demo("mine")
    evening.go(0.5)
    assert evening.program.session is None
    assert evening.program.menus.is_open


def test_the_window_gets_registered_players_ready_and_tells_of_one_that_fails(monkeypatch, site) -> None:
    monkeypatch.setattr(player_warmup, "START_DELAY", 0.0)
    monkeypatch.setattr(player_warmup, "is_compiled_on_disk", lambda player: not player.kernel)
    monkeypatch.setattr(PlayerWarmup, "_compile", lambda self: False)
    install(site, "left-hand", "lefty = left_hand:Lefty", LEFTY)
    register("mine", Failing)

    def rehearsed() -> PlayerWarmup:
        rehearsal = PlayerWarmup(load_table("classic"))
        rehearsal.wait(300.0)
        return rehearsal

    with pytest.warns(UserWarning, match=r"'mine': press\(\) raised .*; the player 'reflex' plays instead"):
        rehearsal = rehearsed()
    assert rehearsal.is_ready("lefty")
    assert not rehearsal.is_ready("mine")
