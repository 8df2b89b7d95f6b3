"""Linkage of kernels: no symbol that another module may replace, and no machine code that is never called."""

from __future__ import annotations

import numba
import pytest
from numba.core.caching import NullCache

from silverball.physics.kernel import SETTINGS, internal, kernel
from silverball.physics.linkage import can_link

pytestmark = pytest.mark.skipif(not can_link or SETTINGS.DISABLE_JIT, reason="Numba's own linkage is used")


@internal
def half(x: float) -> float:
    """Halve x until it is below 1; being recursive, it stays a function of its own."""
    return x if x < 1.0 else half(0.5 * x)


@kernel
def below_one(x: float, unused: float) -> float:
    """Halve x until it is below 1."""
    return half(x) if unused < 1.0 else 0.0


@pytest.fixture
def libraries():
    """The compiled libraries of the kernel and of its helper."""
    for function in (half, below_one):
        function._cache = NullCache()
    assert below_one(6.0, 0.0) == 0.75
    return [next(iter(function.overloads.values())).library for function in (below_one, half)]


def test_no_weak_symbol_is_left_in_a_kernel(libraries):
    linkage = {one.linkage.name for one in libraries[0].get_defined_functions()}
    assert "external" in linkage
    assert linkage <= {"external", "internal", "private"}


def test_a_helper_has_no_machine_code_of_its_own_but_can_be_linked(libraries):
    assert not list(libraries[1].get_defined_functions())
    linkable = libraries[1]._get_module_for_linking()
    assert {one.linkage.name for one in linkable.functions if not one.is_declaration} == {"linkonce_odr"}


@internal
def halvings(x: float, unused: float, count: float) -> float:
    """Count how often x is halved until it is below 1."""
    return count if x < 1.0 else halvings(0.5 * x, unused, count + 1.0)


@kernel
def count_halvings(x: float) -> float:
    """Count how often x is halved; here LLVM takes the unused argument away."""
    return halvings(x, 3.0, 0.0)


def test_code_of_others_that_calls_what_a_kernel_has_loaded_gets_its_own():
    for function in (halvings, count_halvings):
        function._cache = NullCache()

    @numba.njit
    def of_others(x: float, unused: float) -> float:
        return halvings(x, unused, 0.0)

    assert count_halvings(6.0) == 3.0
    assert of_others(6.0, 100.0) == 3.0
