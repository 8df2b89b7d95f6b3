"""Each mode has its own table and begins with it."""

import pytest

from silverball.app.catalog import Catalog
from silverball.app.menus import Button
from silverball.app.program import Program
from silverball.app.settings import Settings
from silverball.game.scores.store import Store
from silverball.game.view import Mode
from silverball.table import table_names

FIRST = {"arcade": "silver_comet", "free": "original"}


@pytest.mark.parametrize("mode", list(Mode))
def test_a_newcomer_begins_on_the_table_of_the_game(mode):
    settings = Settings(mode=mode)
    assert settings.table == FIRST[mode]
    assert settings.table in table_names()


@pytest.mark.parametrize("mode", list(Mode))
def test_a_table_that_is_chosen_is_that_of_the_chosen_game_alone(mode):
    other = Mode.FREE if mode is Mode.ARCADE else Mode.ARCADE
    chosen = Settings(mode=mode).changed(table="rolling")
    assert chosen.table == Settings(mode=mode, table="rolling").table == "rolling"
    assert chosen.changed(mode=other).table == FIRST[other]
    assert chosen.changed(mode=other).changed(mode=mode).table == "rolling"


@pytest.mark.parametrize("mode", list(Mode))
def test_what_is_kept_comes_back(mode):
    chosen = Settings(mode=mode).changed(table="mine.toml", volume=3)
    assert Settings.of(chosen.model_dump(mode="json")) == chosen


def test_settings_kept_before_each_game_had_its_table_keep_the_one_that_was_chosen():
    kept = Settings.of({"mode": "free", "table": "mine.toml", "volume": 3})
    assert (kept.free_table, kept.arcade_table, kept.volume) == ("mine.toml", FIRST["arcade"], 3)
    assert Settings.of({"table": "mine.toml"}).arcade_table == "mine.toml"


@pytest.mark.parametrize("table", [5, None, ["classic"], {}])
@pytest.mark.parametrize("mode", ["free", "arcade", 7, None])
def test_a_table_that_makes_no_sense_gives_way_to_the_default(table, mode):
    kept = Settings.of({"mode": mode, "table": table})
    assert kept.table == FIRST[kept.mode]


def test_the_menu_shows_the_table_of_the_game_that_it_offers(tmp_path):
    with Store(tmp_path) as store:
        program = Program(store, Settings(), Catalog(store, tmp_path))
        assert program.board.recipe.name == "Silver Comet"
        program.press_menu(Button.RIGHT)  # from PLAY to MODE
        program.press_menu(Button.START)
        program.press_menu(Button.RIGHT)
        assert program.settings.current.mode == "free"
        assert program.board.recipe.name == "Original"
        program.press_menu(Button.RIGHT)
        assert program.board.recipe.name == "Silver Comet"
