"""Demos: arcade on a table with rules, with a player who is told the game, and one game after the other."""

from __future__ import annotations

import pytest

from evenings import NOTHING, Evening
from reading import reads
from rule_tables import comet
from silverball.app.backglass.card import Card
from silverball.app.backglass.content import TURN, ContentReader
from silverball.app.controls import Action
from silverball.app.menus.listing import Listing
from silverball.app.rival import PlayerRival
from silverball.app.sessions import DemoSession
from silverball.app.settings import Settings
from silverball.app.watching import DEMO_OVER_SECONDS
from silverball.drawing.dotmatrix.canvas import Dots
from silverball.drawing.dotmatrix.fonts import NORMAL
from silverball.game.view import Mode, Phase
from silverball.players import make_player
from silverball.table import load_table


class Listener:
    """A player that does nothing but note which games it is told."""

    name = "listener"

    def __init__(self) -> None:
        self.told: list[object] = []

    def watch(self, game) -> None:
        self.told.append(game)

    def press(self, world) -> tuple[bool, bool]:
        return False, False


@pytest.fixture
def evening(tmp_path) -> Evening:
    made = Evening(tmp_path, Settings(arcade_table="comet"), comet().replace(name="comet"))
    made.program.finish_loading()
    return made


def test_a_table_with_rules_is_played_for_points_and_one_without_is_not():
    with_rules = DemoSession(load_table("silver_comet"), 3, make_player("reflex"))
    without = DemoSession(load_table("classic"), 3, make_player("reflex"))
    assert (with_rules.game.mode, without.game.mode) == (Mode.ARCADE, Mode.FREE)
    with_rules.advance(NOTHING, 240 * 8)
    assert with_rules.game.phase is Phase.PLAY
    assert any(state != "off" for state in with_rules.game.lamps.values())
    assert with_rules.game.view.ball == 1  # one ball after the other
    assert with_rules.game.replay.verify().ok


def test_a_player_is_told_its_game_and_so_is_the_one_who_takes_over():
    table = load_table("silver_comet")
    first, second = Listener(), Listener()
    session = DemoSession(table, 3, first)
    session.player = second
    assert first.told == second.told == [session.game]
    rival = PlayerRival(table, 3, Listener(), "LISTENER")
    assert rival.player.told == [rival.game]


def test_after_the_end_of_its_game_a_demo_begins_another_one(evening):
    evening.go(31.0)
    assert evening.program.menus.page == "attract"
    first = evening.program.session
    assert first.game.mode is Mode.ARCADE
    first.game.end()
    assert not evening.program.is_moving
    evening.go(DEMO_OVER_SECONDS - 0.5)
    assert evening.program.session is first
    evening.go(1.0)
    second = evening.program.session
    assert isinstance(second, DemoSession)
    assert second is not first
    assert second.is_attract
    assert evening.program.menus.page == "attract"
    evening.go(1.0)
    assert evening.program.session is second


def test_one_button_leads_from_a_finished_demo_to_a_game(evening):
    evening.go(31.0)
    evening.program.session.game.end()
    evening.go(0.2)
    evening.tap(Action.CREATE)
    assert evening.program.is_playing


def test_the_attract_mode_shows_the_lamps_of_its_game_and_what_is_lit(evening):
    assert evening.program.has_attract_lights  # there is no game yet
    evening.go(31.0)
    assert evening.program.menus.page == "attract"
    assert not evening.program.has_attract_lights
    reader = ContentReader(evening.program)
    bodies = {type(reader.read(second).body) for second in (TURN / 2, 3 * TURN / 2)}
    assert bodies == {Listing, Card}
    evening.program.session.game.end()
    assert evening.program.has_attract_lights
    assert isinstance(reader.read(3 * TURN / 2).body, Listing)


def test_the_display_of_the_attract_mode_shows_the_score_of_its_game(evening):
    evening.go(31.0)
    page = evening.program.menus.context.pages[-1]
    below = Dots()
    below.text("1,234", 0, 0, NORMAL)
    context = evening.program.menus.context
    pictures = [page.draw(context, page.shown_at + second, below) for second in range(1, 60, 2)]
    assert 2 <= sum(reads(picture, "1,234", (NORMAL,)) for picture in pictures) < len(pictures) / 2
