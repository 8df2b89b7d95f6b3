"""Is everything public reachable from `silverball` itself?"""

from __future__ import annotations

from importlib import import_module

import pytest

import silverball as sb


@pytest.mark.parametrize("name", sb.__all__)
def test_every_public_name_is_there_and_listed(name: str):
    assert getattr(sb, name) is not None
    assert name in dir(sb)


@pytest.mark.parametrize("name", import_module("silverball.world").__all__)
def test_all_that_the_worlds_offer_is_public(name: str):
    assert getattr(sb, name) is getattr(import_module("silverball.world"), name)


def test_an_unknown_name_is_no_attribute():
    with pytest.raises(AttributeError, match="'Flipper'"):
        sb.Flipper  # noqa: B018  (reading it is the test)
