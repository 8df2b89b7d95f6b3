"""Is everything public reachable from `silverball` itself?"""

from __future__ import annotations

from importlib import import_module

import pytest

import silverball as sb


@pytest.mark.parametrize("name", sb.__all__)
def test_every_public_name_is_there_and_listed(name: str):
    assert getattr(sb, name) is not None
    assert name in dir(sb)


@pytest.mark.parametrize("module", ["silverball.world", "silverball.table"])
def test_a_public_name_is_that_of_its_module(module: str):
    home = import_module(module)
    shared = [name for name in sb.__all__ if name in home.__all__]
    assert len(shared) > 4
    assert all(getattr(sb, name) is getattr(home, name) for name in shared)


def test_all_that_the_worlds_package_offers_is_public():
    assert set(import_module("silverball.world").__all__) <= set(sb.__all__)


def test_an_unknown_name_is_no_attribute():
    with pytest.raises(AttributeError, match="'Flipper'"):
        sb.Flipper  # noqa: B018  (reading it is the test)
