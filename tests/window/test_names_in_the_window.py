"""Names from files and the database on the table, on the score display and in messages of the window."""

from __future__ import annotations

import os

import pytest

from hostile_text import NAMES, NO_TEXT, obeyed_in, toml_string
from silverball.app.overlay import Messages, draw_message
from silverball.drawing.dotmatrix.canvas import Dots
from silverball.drawing.text import line, wrapped
from silverball.game.scores.store import Store
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.table import dump_table, load_table, table_digest

MANY = "\0\x1b[31m\u202e\x9b\ufeff\U000e0001\u2028[red]"


def test_a_message_shows_what_it_repeats():
    for name in NAMES.values():
        messages = Messages()
        messages.show(f"table {name}")
        assert obeyed_in(messages.text) == set()
        assert messages.text == f"Table {plain(name, keep=chr(10))}."


def test_letters_that_a_font_refuses_are_drawn_as_their_escapes():
    import pygame

    target = pygame.Surface((300, 400))
    for name in (*NAMES.values(), "\0", "\ud800", NO_TEXT):
        assert line(name, 20, (255, 255, 255)).get_size() == line(plain(name), 20, (255, 255, 255)).get_size()
        assert obeyed_in("\n".join(wrapped(name, 20, 300))) == set()
        draw_message(target, pygame.Rect(0, 300, 300, 100), 20.0, name, 1.0)


def test_the_score_display_shows_a_box_for_what_it_has_no_dots_for():
    for name in (*NAMES.values(), "\0", NO_TEXT):
        assert Dots().text(name, 0, 0) > 0, ascii(name)


@pytest.mark.parametrize("file", ["plain.toml", f"{NO_TEXT}.toml"])
def test_a_table_of_a_hostile_name_can_be_chosen_and_played_from_any_file(open_window, tmp_path, file: str):
    folder = tmp_path / "data"
    (folder / "tables").mkdir(parents=True)
    path = os.path.join(folder, "tables", file)
    text = dump_table(load_table("classic")).replace('"Classic"', toml_string(MANY))
    with open(path, "w", encoding="utf-8") as opened:
        opened.write(text)
    os.mkfifo(folder / "tables" / "pipe.toml")
    with Store(folder) as store:
        store.add_score("ABC", 700, Mode.ARCADE, MANY, table_digest(load_table(path)), 1, "replay")
    player = open_window(path, mode=None, folder=folder)
    assert player.program.board.table.name == MANY
    player.program.settings.change(table=path)
    player.seconds(60)  # of attract mode: the title, the table and its scores
    player.window.close()
    again = open_window(None, mode=Mode.FREE, folder=folder)
    assert again.program.board.table.name == MANY  # as it was chosen last
    again.frames(10)
    again.window.messages.show(f"{again.program.board.table.name} is there")
    again.frames(2)
    assert again.says == f"{plain(MANY)} is there."
