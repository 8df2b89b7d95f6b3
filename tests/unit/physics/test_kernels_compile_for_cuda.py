"""The kernels are plain scalar functions and compile for a graphics card as they are.

The first test reads their text. The others compile them, with all they call, to PTX, the assembly of CUDA;
that needs no card, only `pip install 'numba-cuda[cu12]'`.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import silverball
from silverball.physics import balls, step
from silverball.physics.kernel import KERNEL_PACKAGES, SETTINGS
from silverball.table import Board, Table
from silverball.world import World, WorldBatch

PACKAGE = Path(silverball.__file__).parent
NOT_PLAIN = (
    *(ast.Raise, ast.Try, ast.Assert, ast.With),  # exceptions
    *(ast.List, ast.ListComp, ast.Dict, ast.DictComp, ast.Set, ast.SetComp),  # allocation
    *(ast.JoinedStr, ast.GeneratorExp, ast.Yield, ast.YieldFrom, ast.Lambda, ast.Global),  # no scalar
)
COMPUTE_CAPABILITY = (8, 0)


def kernels_in(source: str) -> Iterator[ast.FunctionDef]:
    """The functions of a source file that are compiled."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef):
            names = [ast.unparse(decorator) for decorator in node.decorator_list]
            if any(re.match(r"(kernel|internal|inlined|ir_inlined)\b", name) for name in names):
                yield node


def blemishes(kernel: ast.FunctionDef) -> list[str]:
    """What is not plain in a kernel: its lines with their text."""
    found = []
    for statement in kernel.body:
        for node in ast.walk(statement):
            called = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
            nested = isinstance(node, ast.FunctionDef)
            if nested or isinstance(node, NOT_PLAIN) or re.match(r"(print|str|np|numpy)\b", called):
                found.append(f"{kernel.name}, line {node.lineno}: {ast.unparse(node)}")
    return found


def test_no_kernel_raises_allocates_or_prints():
    kernels = [
        kernel
        for name in KERNEL_PACKAGES
        for path in sorted((PACKAGE / name).rglob("*.py"))
        for kernel in kernels_in(path.read_text(encoding="utf-8"))
    ]
    assert len(kernels) > 50
    assert [line for kernel in kernels for line in blemishes(kernel)] == []


@pytest.mark.parametrize(
    "line",
    [
        "raise ValueError",
        "assert a > 0",
        "b = [a]",
        "b = np.zeros(3)",
        "print(a)",
        "b = f'{a}'",
        "b = sum(a for _ in range(3))",
        "while a:\n        try: a = 1 / a\n        except ZeroDivisionError: break",
    ],
)
def test_what_is_not_plain_is_seen(line: str):
    (kernel,) = kernels_in(f"@kernel\ndef f(a):\n    {line}\n    return a")
    assert blemishes(kernel)


@pytest.fixture
def compile_to_ptx(monkeypatch):
    """A function that compiles a kernel for the very types that it has been called with from Python."""
    pytest.importorskip("numba_cuda", reason="numba-cuda is not installed")
    if SETTINGS.DISABLE_JIT:
        pytest.skip("nothing is compiled in an interpreted run")
    from numba import cuda

    # The callees ask the card at hand what to compile for; there need not be one.
    card = SimpleNamespace(compute_capability=COMPUTE_CAPABILITY)
    monkeypatch.setattr("numba.cuda.dispatcher.get_current_device", lambda: card)

    def compiled(kernel) -> str:
        signature = next(one for one in kernel.nopython_signatures if "next_clock" in str(one.args))
        ptx, _ = cuda.compile(kernel.py_func, signature.args, abi="numba", cc=COMPUTE_CAPABILITY)
        return ptx

    return compiled


@pytest.mark.parametrize(
    ("kernel", "product"), [(step.run_worlds, "sqrt.rn.f64"), (balls.create_ball, "st.f64")]
)
def test_a_kernel_compiles_to_ptx_that_calls_nothing_from_outside(kernel, product, compile_to_ptx):
    """Allocation, printing and exceptions would call functions of a runtime."""
    table = Table(name="many balls", format=2, board=Board(max_balls=3))  # its worlds have all fields
    World(table).create_ball()
    WorldBatch(table).step(np.zeros((1, 3), np.bool_))
    ptx = compile_to_ptx(kernel)
    assert f".target sm_{COMPUTE_CAPABILITY[0]}{COMPUTE_CAPABILITY[1]}" in ptx
    assert re.search(rf"\.visible \.func .*{kernel.py_func.__name__}", ptx)
    assert product in ptx
    assert ".extern" not in ptx
