"""Everything public about games is documented and has examples that run."""

from __future__ import annotations

import doctest
from importlib import import_module

import pytest

import silverball as sb

MODULES = {
    name: module
    for name in sb.__all__
    if (module := getattr(getattr(sb, name), "__module__", "")).startswith("silverball.game")
}


def members(thing: type) -> dict[str, object]:
    """The public methods and properties that a class has of its own package."""
    return {
        name: member
        for base in thing.__mro__
        if base.__module__.startswith("silverball.game")
        for name, member in vars(base).items()
        if not name.startswith("_") and (callable(member) or isinstance(member, (property, classmethod)))
    }


def test_games_replays_and_rules_are_public():
    assert {"Game", "GameEvent", "GameView", "Mode", "Replay", "Rules", "RuleState", "Verdict"} <= set(
        MODULES
    )


@pytest.mark.parametrize("name", MODULES)
def test_every_public_class_has_an_example_and_every_member_a_docstring(name: str):
    thing = getattr(sb, name)
    assert ">>>" in (thing.__doc__ or "")
    for member, value in members(thing).items():
        assert value.__doc__, f"{name}.{member}"


@pytest.mark.parametrize("module", sorted(set(MODULES.values())))
def test_the_examples_run(module: str):
    result = doctest.testmod(import_module(module))
    assert result.attempted > 0
    assert result.failed == 0
