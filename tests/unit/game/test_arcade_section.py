"""The arcade section of table files: rules are read, written and checked, and absent rules change nothing."""

from __future__ import annotations

import pytest

from silverball.errors import TableError
from silverball.game.game import Game
from silverball.table import (
    Arcade,
    dump_table,
    generate_table,
    load_table,
    parse_table,
    table_digest,
    table_names,
)

TEXT = 'format = 1\nname = "Mine"\n\n[arcade]\nballs = 5\nball_save = 8.0\n'


DIGESTS = {
    "classic": "668a71504423109c2a3f170e83b16b187a458b05e82b78f653e3376a15ea58b4",
    "original": "9ffb643750a89d124e9e9c9035ca56596c3abdde5d7ce0e80c4e420fd7363ee8",
    "random": "746ffccea3163e5226697f0bae56630a907c97fa8ae0e50a685414525bbb2cb7",
    "rolling": "3e49eaa04f578cf9a3758299b6455d8d4e2e0ae3648be489d03b68a3860527a6",
}
"""Digests from before format 2 and its keys; they are in replays, saved games and scores."""


@pytest.mark.parametrize("name", DIGESTS)
def test_a_table_keeps_its_digest_whatever_keys_are_new(name: str):
    assert table_digest(load_table(name)) == DIGESTS[name]


@pytest.mark.parametrize("name", sorted(set(table_names()) - {"silver_comet"}))  # which has medals
def test_default_rules_are_not_in_the_text(name: str):
    table = load_table(name)
    assert table.arcade == Arcade()
    assert "arcade" not in dump_table(table)


def test_rules_round_trip_through_the_file_and_only_non_defaults_are_written():
    table = parse_table(TEXT)
    assert (table.arcade.balls, table.arcade.ball_save, table.arcade.warnings) == (5, 8.0, Arcade().warnings)
    assert dump_table(table) == TEXT
    assert table_digest(table) != table_digest(parse_table('format = 1\nname = "Mine"\n'))


def test_a_section_of_defaults_equals_no_section():
    spelt_out = parse_table(f'format = 1\nname = "Mine"\n[arcade]\nballs = {Arcade().balls}\n')
    assert table_digest(spelt_out) == table_digest(parse_table('format = 1\nname = "Mine"\n'))


def test_every_board_of_a_recipe_has_the_recipes_rules():
    recipe = load_table("random").model_copy(update={"arcade": Arcade(balls=7)})
    assert generate_table(3, recipe).arcade.balls == 7
    assert Game(recipe, 3).view.balls == 7


@pytest.mark.parametrize(
    ("line", "path", "hint"),
    [
        ("bals = 3", "arcade.bals", "`balls`"),
        ("balls = 0", "arcade.balls", "must be 1 to 99 balls, got 0"),
        ("ball_save = -1", "arcade.ball_save", "must be 0 to 60 s, got -1"),
        ("warnings = 1.5", "arcade.warnings", "must be an integer"),
        ("points = 3", "arcade.points", "belongs in a part"),
        ("gravity = 3", "arcade.gravity", "belongs in [board]"),
        ("un_stick = 0", "arcade.un_stick", "0.5 to 60 s"),
    ],
)
def test_an_invalid_rule_is_reported_with_its_path_and_a_hint(line: str, path: str, hint: str):
    with pytest.raises(TableError) as caught:
        parse_table(f"format = 1\n[arcade]\n{line}\n")
    (problem,) = caught.value.problems
    assert problem.path == path
    assert hint in problem.message


def test_a_rule_in_the_wrong_section_is_reported_with_the_right_one():
    with pytest.raises(TableError, match=r"`combo_limit` belongs in \[arcade\]"):
        parse_table("format = 1\n[board]\ncombo_limit = 3\n")
