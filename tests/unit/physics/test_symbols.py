"""Names of compiled code: without the numbers that count a process's functions and types, they are unique.

Code that one process has cached is linked with code of another. With one name for two functions, or for two
types of records, a kernel would contain the wrong one.
"""

from __future__ import annotations

import re

import pytest

import silverball as sb
from silverball.physics.kernel import SETTINGS, _kernels

pytestmark = pytest.mark.skipif(bool(SETTINGS.DISABLE_JIT), reason="nothing is compiled")

COUNTERS = re.compile(r"B\d+v\d+|RecordILi\d+E")


def test_names_of_compiled_code_are_unique_without_the_counters_of_a_process() -> None:
    for name in ("classic", "parts"):
        sb.World(sb.load_table(name)).step()
    compiled = {  # without those that other tests have imported once more
        (one.py_func.__code__, str(result.signature.args), COUNTERS.sub("", result.fndesc.mangled_name))
        for one in _kernels
        for result in one.overloads.values()
    }
    assert len(compiled) > 40
    assert len({name for _, _, name in compiled}) == len(compiled)


def test_functions_of_one_module_have_names_of_their_own() -> None:
    """Also those that stand in for others in plain worlds, of which most were written as a lambda."""
    functions = [one.py_func for one in _kernels]
    functions += [
        cell.cell_contents
        for one in _kernels
        if (choose := getattr(one._compiler._get_implementation, "__closure__", None))
        for name, cell in zip(one._compiler._get_implementation.__code__.co_freevars, choose, strict=True)
        if name == "otherwise"
    ]
    assert len(functions) > len(_kernels)
    names = {}
    for function in functions:
        assert "<lambda>" not in function.__qualname__
        names.setdefault((function.__module__, function.__qualname__), set()).add(function.__code__)
    assert [name for name, codes in names.items() if len(codes) > 1] == []
