"""Everything public is reachable from `silverball`, documented, and shown in an example that runs."""

from __future__ import annotations

import doctest
import re
from importlib import import_module
from pathlib import Path
from types import FunctionType, ModuleType

import pytest

import silverball as sb
from silverball.errors import SilverballError

DOCS = Path(__file__).parents[2] / "docs"
NAMES = [name for name in sb.__all__ if not name.startswith("__")]
ERRORS = [
    name
    for name in NAMES
    if isinstance(getattr(sb, name), type) and issubclass(getattr(sb, name), SilverballError)
]
MODULES = sorted(
    {"silverball.world.compile"}
    | {
        value.__name__ if isinstance(value := getattr(sb, name), ModuleType) else value.__module__
        for name in NAMES
    }
)


@pytest.mark.parametrize("name", sb.__all__)
def test_every_public_name_is_there_and_listed(name: str):
    assert getattr(sb, name) is not None
    assert name in dir(sb)


@pytest.mark.parametrize("name", import_module("silverball.world").__all__)
def test_all_that_the_worlds_offer_is_public(name: str):
    assert getattr(sb, name) is getattr(import_module("silverball.world"), name)


@pytest.mark.parametrize("name", sb.parts.__all__)
def test_every_part_is_documented_with_its_fields(name: str):
    part = getattr(sb.parts, name)
    assert part.__doc__
    assert all(field.description for field in part.model_fields.values())


def members(thing: object) -> dict[str, object]:
    """The public methods and properties of a class, those of our own base classes included."""
    bases = thing.__mro__ if isinstance(thing, type) else ()
    return {
        name: member
        for base in reversed(bases)
        if base.__module__.startswith("silverball.")
        for name, member in vars(base).items()
        if not name.startswith("_")
        and isinstance(member, FunctionType | classmethod | staticmethod | property)
    }


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_is_documented_with_all_its_members(name: str):
    value = getattr(sb, name)
    assert value.__doc__
    assert [member for member, what in members(value).items() if not what.__doc__] == []


def test_inherited_members_are_walked_too():
    assert {"step", "replay"} <= set(members(sb.Game))


@pytest.mark.parametrize("name", [name for name in NAMES if name not in ERRORS and name != "parts"])
def test_every_public_name_has_an_example(name: str):
    assert doctest.DocTestFinder(recurse=False).find(getattr(sb, name), name)[0].examples


@pytest.mark.parametrize("module", MODULES)
def test_the_examples_of_a_module_are_true(module: str, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some examples write files
    assert doctest.testmod(import_module(module), optionflags=doctest.ELLIPSIS).failed == 0


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_has_a_place_in_the_site(name: str):
    pages = (path.read_text(encoding="utf-8") for path in DOCS.rglob("*.md"))
    assert any(re.search(rf"^::: silverball\.(errors\.)?{name}$", page, re.MULTILINE) for page in pages)


def test_an_unknown_name_is_not_an_attribute():
    with pytest.raises(AttributeError, match="'Flipper'"):
        sb.Flipper  # noqa: B018  (reading it is the test)
