"""A changed table in a replay is refused, and a forged one is found where its rule acts."""

from __future__ import annotations

import dataclasses
import random
from collections.abc import Iterator
from functools import cache

import pytest

import silverball as sb
from rule_tables import comet
from silverball.errors import StateError
from silverball.game.replay.format import Replay
from silverball.game.replay.reader import checksum
from silverball.table import Table, dump_table, load_table
from silverball.table.rulebook import Counter

RATE = 240
SEEDS = range(2)
SECONDS = 60
MOST_NOTES = 40  # counters that a table may have beside its own


def pressed(game: sb.Game, seed: int) -> sb.Game:
    """Play with random buttons and a few shoves."""
    draw = random.Random(seed)
    held = [False, False, False]
    while game.tick < SECONDS * RATE and not game.is_over:
        if game.phase is sb.Phase.READY:
            game.create_ball()
        held = [one != (draw.random() < 0.2) for one in held]
        if draw.random() < 0.01 and game.view.on_board:
            game.jitter()
        game.step(held[0], held[1], 24, launch=held[2])
    return game


@cache
def game_of(table: str, seed: int) -> Replay:
    """An honest game."""
    return pressed(sb.Game(comet() if table == "comet" else load_table(table), seed), seed).replay


def changed_tables(table: Table) -> Iterator[tuple[str, Table]]:
    """The table with each rule, lamp, counter and mode changed in turn, and what was changed."""
    for key, change in (
        ("rule", lambda row: row.replace(award=row.award + 1)),
        ("lamp", lambda row: row.replace(lasts="ball" if row.lasts == "game" else "game")),
        ("counter", lambda row: row.replace(begins=row.begins + 1)),
        ("mode", lambda row: row.replace(seconds=(row.seconds or 1.0) + 0.5)),
    ):
        rows = getattr(table, key)
        for number, row in enumerate(rows):
            new = (*rows[:number], change(row), *rows[number + 1 :])
            yield f"{key}[{number}]", table.replace(**{key: new})


def with_table(text: str, old: Table, new: Table) -> str:
    """The text of a replay with another table and a right checksum."""
    body = text[: text.rindex("checksum = ")]
    assert body.count(dump_table(old)) == 1
    body = body.replace(dump_table(old), dump_table(new))
    return f"{body}checksum = {checksum(body)}\n"


def test_any_rule_lamp_counter_or_mode_that_was_changed_in_a_replay_is_found():
    replay = game_of("silver_comet", 0)
    text = replay.to_text()
    assert Replay.from_text(text).verify().ok
    changes = list(changed_tables(replay.table))
    assert {name.split("[")[0] for name, _ in changes} == {"rule", "lamp", "counter", "mode"}
    for _, table in changes:
        with pytest.raises(StateError, match="table"):
            Replay.from_text(with_table(text, replay.table, table))


@cache
def acted(seed: int) -> frozenset[int]:
    """The rules that act in a game, by counters that they raise in a copy of the table."""
    table, found = comet(), set[int]()
    for first in range(0, len(table.rule), MOST_NOTES):
        noted = range(first, min(first + MOST_NOTES, len(table.rule)))
        notes = tuple(Counter(name=f"acts of {number}") for number in noted)
        rules = list(table.rule)
        for number in noted:
            rules[number] = rules[number].replace(add={**rules[number].add, f"acts of {number}": 1})
        game = sb.Game(table.replace(rule=tuple(rules), counter=(*table.counter, *notes)), seed)
        counters = pressed(game, seed).counters
        found |= {number for number in noted if counters[f"acts of {number}"]}
    return frozenset(found)


def test_the_games_set_off_a_quarter_of_the_rules():
    assert len(frozenset().union(*map(acted, SEEDS))) > len(comet().rule) / 4


@pytest.mark.parametrize("seed", SEEDS)
def test_a_rule_that_pays_more_is_found_in_every_game_in_which_it_acts(seed: int):
    replay = game_of("comet", seed)
    for number, rule in enumerate(replay.table.rule):
        rules = list(replay.table.rule)
        rules[number] = rule.replace(award=rule.award + 1, times=())
        forged = dataclasses.replace(replay, table=replay.table.replace(rule=tuple(rules)))
        verdict = Replay.from_text(forged.to_text()).verify()  # with the digest of the new table
        assert verdict.ok == (number not in acted(seed)), (number, verdict.message)
        assert verdict.ok or (verdict.field == "rules" and verdict.seen - verdict.tick <= RATE), verdict
