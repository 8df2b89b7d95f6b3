"""Damaged table files give clear errors: a few of those that `mutate_tables.py` makes in any number."""

from __future__ import annotations

import random

import pytest

import mutate_tables
from mutate_tables import good_texts, mutated, run
from silverball.table import load_table


def test_some_damaged_files_end_in_words_or_are_played():
    outcomes, findings, _ = run(150, seed=1)
    assert findings == []
    assert outcomes["refused"] > 50
    assert outcomes["played"] > 2


def test_some_damaged_rules_end_in_words_or_are_played():
    outcomes, findings, _ = run(60, seed=1, rules=True)
    assert findings == []
    assert outcomes["refused"] > 5
    assert outcomes["played"] > 2


@pytest.mark.slow
def test_hundreds_of_damaged_rules_end_in_words_or_are_played():
    outcomes, findings, _ = run(500, seed=2, rules=True)
    assert findings == []
    assert outcomes["played"] > 20


@pytest.mark.slow
def test_thousands_of_damaged_files_end_in_words_or_are_played():
    outcomes, findings, _ = run(1500, seed=2)
    assert findings == []
    assert outcomes["played"] > 100


def test_every_way_of_damage_changes_files():
    texts = good_texts()
    for way in mutate_tables.WAYS:
        changed = [text != way(text, random.Random(seed)) for text in texts for seed in range(5)]
        assert sum(changed) > len(changed) // 2


def test_a_file_is_the_same_for_the_same_number():
    texts = good_texts()
    assert mutated(texts, 3, 17) == mutated(texts, 3, 17) != mutated(texts, 3, 18)


def fails(how):
    def load(path):
        raise how

    return load


class Unescaped(mutate_tables.SilverballError):
    """An error that gets round the escaping of all others."""

    def __str__(self) -> str:
        return "a \x9b"


@pytest.mark.parametrize(
    ("load", "told"),
    [
        (fails(ZeroDivisionError("division by zero")), "ZeroDivisionError"),
        (fails(Unescaped()), "obeyed"),
        (fails(RecursionError()), "RecursionError"),
    ],
)
def test_what_is_wrong_is_found(monkeypatch, load, told):
    monkeypatch.setattr(
        mutate_tables, "load_table", lambda name: load(name) if hasattr(name, "parent") else load_table(name)
    )
    outcomes, findings, _ = run(3)
    assert outcomes == {"wrong": 3}
    assert all(told in found.what for found in findings)
