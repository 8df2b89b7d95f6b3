"""The shipped module: complete, small, plain WebAssembly, and built from the sources as they are."""

from __future__ import annotations

import ctypes
import math

import llvmlite.binding as llvm
import numba
import pytest

from silverball.errors import SilverballError
from silverball.web.build import build
from silverball.web.exports import exports
from silverball.web.module import NOTE, PATH, read_module, read_note, source_hash
from silverball.web.wasmlink import (
    CUSTOM,
    EXPORT,
    IMPORT,
    LinkError,
    Reader,
    link,
    sections,
    signed,
    unsigned,
)
from silverball.web.wrappers import FLOATS

LIMIT = 1_000_000  # bytes
REMEDY = "the kernels have changed; build the module again with `python -m silverball.web.build`"


def test_the_module_is_built_from_these_sources():
    assert read_note(read_module()).sources == source_hash(), REMEDY


def test_the_module_imports_nothing_and_exports_every_kernel():
    plain, custom = sections(read_module())
    assert IMPORT not in plain
    reader = Reader(plain[EXPORT])
    names = []
    for _ in range(reader.number()):
        names.append(reader.name())
        reader.byte()
        reader.number()
    assert names == [*(one.name for one in exports()), "rgba", "memory", "heap"]
    assert list(custom) == [NOTE]
    assert PATH.stat().st_size < LIMIT


@pytest.mark.slow
def test_a_fresh_build_gives_the_same_bytes(tmp_path):
    built = read_note(read_module()).numba
    if built != numba.__version__:
        pytest.skip(f"the module was built with Numba {built}, this is {numba.__version__}")
    assert build(tmp_path / "fresh.wasm") == read_module(), REMEDY


def test_a_missing_module_says_how_to_build_it(tmp_path):
    with pytest.raises(SilverballError, match=r"none\.wasm: .*`python -m silverball\.web\.build`"):
        read_module(tmp_path / "none.wasm")


@pytest.mark.parametrize("number", [0, 1, 63, 64, 127, 128, 65536, 2**31 - 1])
def test_numbers_are_read_as_they_were_written(number):
    assert Reader(unsigned(number)).number() == number
    last = signed(number)[-1]
    assert last & 0x40 == 0, "the sign of a positive number"


def test_an_object_that_needs_something_from_outside_is_refused():
    body = unsigned(1) + b"\3env" + b"\3sin" + b"\0" + unsigned(0)
    module = b"\0asm\1\0\0\0" + bytes([IMPORT]) + unsigned(len(body)) + body
    with pytest.raises(LinkError, match="sin"):
        link(module, [], {})


def test_a_file_of_another_kind_is_refused():
    with pytest.raises(LinkError, match="WebAssembly"):
        sections(b"\x7fELF" + bytes([CUSTOM]))


POWERS = (-2100, -1074, -1030, -60, 0, 9, 1030)


@pytest.fixture(scope="module")
def floats():
    """`numba_frexp` and `numba_ldexp` as the module has them, compiled for this processor."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_default_triple().create_target_machine()
    with llvm.create_mcjit_compiler(llvm.parse_assembly(FLOATS), machine) as engine:
        engine.finalize_object()
        result = ctypes.c_double
        ldexp = ctypes.CFUNCTYPE(result, result, ctypes.c_int)(engine.get_function_address("numba_ldexp"))
        pointer = ctypes.POINTER(ctypes.c_int)
        frexp = ctypes.CFUNCTYPE(result, result, pointer)(engine.get_function_address("numba_frexp"))
        yield frexp, ldexp


@pytest.mark.parametrize("power", POWERS)
@pytest.mark.parametrize("x", [1.0, -1.3, 0.7, 5e-324, 1.7e308, 0.0, math.inf])
def test_numbers_are_scaled_as_in_python(floats, x, power):
    try:
        expected = math.ldexp(x, power)
    except OverflowError:
        expected = math.copysign(math.inf, x)
    assert floats[1](x, power) == expected


@pytest.mark.parametrize("x", [1.0, -1.3, 0.7, 5e-324, -3e-310, 1.7e308, 0.0])
def test_numbers_are_taken_apart_as_in_python(floats, x):
    exponent = ctypes.c_int(77)
    assert (floats[0](x, ctypes.byref(exponent)), exponent.value) == math.frexp(x)
