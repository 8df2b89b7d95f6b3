"""The decorators that compile kernels, and the folder that caches their machine code.

Options, and why:

* ``error_model="numpy"``: a division by zero gives inf or nan instead of raising; kernels never raise.
* ``fastmath=False``: no reordered and no fused arithmetic, so that every machine gives the same bits.
* ``nogil=True``: slices of a batch run on threads.
* ``forceinline=True``, for the few small helpers of the hot loop: their tuples stay in registers.
* ``_nrt=False``: no reference counting. Kernels never allocate, and so the compiler refuses an allocation;
  with counting, every function with an array argument would pay for atomic operations, some 20 ns a call.
* ``no_cfunc_wrapper=True``: kernels are never passed as function pointers; it saves 8 % of the compilation.
* ``no_cpython_wrapper=True``, for what only kernels call: it cannot be called from Python, and needs no code
  that unpacks arguments; it saves some 10 % of the compilation.
* the linkage (see `linkage.py`): callees can be optimized freely, and helpers have no machine
  code of their own.
* the cache: Numba's own ``cache=True`` checks the file of the cached function alone and would return stale
  code after a change of a callee in *another* file, and it trusts its files (see `code_cache.py`). Compiled
  code is therefore kept in a folder of the user's cache directory whose name is a hash of the sources of all
  packages that hold kernels, and of what else machine code depends on. The drawing has its own folder: the
  simulation never calls it, so a change of a colour does not compile the physics again.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numba.core.config
import numpy as np
from llvmlite import ir
from numba import extending, types
from numba.core import cgutils as untyped_cgutils
from numba.core.cpu import CPUContext
from numba.core.registry import CPUDispatcher

from silverball.physics.code_cache import CodeCache, discard, find_code, remove, sweep
from silverball.physics.compile_thread import run_in_compiler_thread
from silverball.physics.linkage import HelperCompiler, KernelCompiler, NamedCompiler, can_link

SETTINGS: Any = numba.core.config
cgutils: Any = untyped_cgutils
# The packages whose sources the machine code of some kernels depends on.
PLAY = ("physics", "referee", "world", "players")
STUDY = (*PLAY, "metrics", "soak")
DRAWING = ("physics", "drawing/kernels")
AGENTS = (*PLAY, "envs")
KERNEL_PACKAGES = (*STUDY, "envs", "drawing")  # all packages with kernels; a test checks it
LAST_SHARE = 0.2  # share of a first start that the last kernels take; measured
KEEP_SECONDS = 30 * 24 * 3600.0
_kernels: list[Any] = []  # all kernels of this process
_swept: set[Path] = set()  # folders of compiled code whose files were checked


class Compiled(CPUDispatcher):
    """A function that is compiled or loaded on its first call, which Ctrl-C may safely interrupt."""

    def compile(self, signature: Any) -> Any:
        """Compile for arguments of these types."""
        return run_in_compiler_thread(super().compile, signature)


class Internal(Compiled):
    """A compiled function without the code that would let Python call it."""

    def __call__(self, *arguments: Any) -> Any:
        """Refuse, because Numba would crash."""
        name = self.py_func.__name__
        raise TypeError(
            f"{name} is compiled for calls by other kernels only; from Python call "
            f"{name}.py_func, which is not compiled, or decorate it with @kernel"
        )


F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile a function on its first call and cache the machine code for the next start."""
    return _compile(function)


def internal(function: F) -> F:
    """Compile a function that only kernels call."""
    return _compile(function, no_cpython_wrapper=True)


def inlined(function: F) -> F:
    """Compile a small helper of the hot loop into its callers, which are kernels."""
    return _compile(function, no_cpython_wrapper=True, forceinline=True)


def ir_inlined(function: F) -> F:
    """Insert a helper into its callers before they are compiled (Numba's ``inline="always"``).

    For helpers with one caller, or that make an array: without reference counting no compiled function can
    return one.
    """
    return _compile(function, inline="always")


def bind_types(function: Any, *arguments: Any) -> Callable[..., Any]:
    """Compile a kernel for the types of these arguments and return it without Numba's type dispatch.

    The dispatch takes longer than a tick. A call with arguments of other types would read and write
    arbitrary memory.

    Args:
        function: A kernel.
        arguments: Examples of its arguments.
    """
    if SETTINGS.DISABLE_JIT:
        return cast(Callable[..., Any], function)
    signature = tuple(cast(Any, numba).typeof(argument) for argument in arguments)
    compiled: Callable[..., Any] = function.compile(signature)
    return compiled


@extending.intrinsic
def _compiled_as_int(typing_context: Any, value: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.cast(builder, arguments[0], signature.args[0], types.int64)

    return types.int64(value), generate


as_int: Any = int if SETTINGS.DISABLE_JIT else _compiled_as_int
"""The plain integer of an enum's member or of a literal.

To Numba each enum, and each literal argument, has a type of its own. A kernel that is called with several of
them would be compiled once for each.
"""


@extending.intrinsic
def _compiled_mixed_bits(typing_context: Any, value: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        word = context.get_value_type(types.int64)
        bits = builder.bitcast(arguments[0], word)
        return builder.add(bits, builder.lshr(bits, word(32)))

    return types.int64(value), generate


def _interpreted_mixed_bits(value: float) -> int:
    bits = int(np.asarray(value).view(np.uint64))
    return bits + (bits >> 32)


mixed_bits: Any = _interpreted_mixed_bits if SETTINGS.DISABLE_JIT else _compiled_mixed_bits
"""The bits of a 64-bit number as an integer for sums: as the upper half is added, two signs do not cancel."""


@extending.intrinsic
def _compiled_wrapped(typing_context: Any, value: Any) -> Any:
    return types.int64(types.int64), lambda context, builder, signature, arguments: arguments[0]


def _interpreted_wrapped(value: int) -> int:
    return (value + 2**63) % 2**64 - 2**63


wrapped: Any = _interpreted_wrapped if SETTINGS.DISABLE_JIT else _compiled_wrapped
"""A sum as it is when integers of 64 bits overflow; Python's do not."""


@extending.intrinsic
def _compiled_prefetch(typing_context: Any, record: Any, offset: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        if not isinstance(context, cast(Any, CPUContext)):  # of a graphics card
            return context.get_dummy_value()
        byte, number = ir.IntType(8), ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [byte.as_pointer(), number, number, number])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0")
        at = builder.gep(builder.bitcast(arguments[0], byte.as_pointer()), [arguments[1]])
        builder.call(function, [at, number(1), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(record, types.int64), generate


def _interpreted_prefetch(record: Any, offset: int) -> None:
    pass


prefetch: Any = _interpreted_prefetch if SETTINGS.DISABLE_JIT else _compiled_prefetch
"""Ask for the line of the cache at an offset [bytes] of a record, which will soon be written."""


def code_folder(packages: tuple[str, ...] = PLAY) -> Path:
    """The folder for compiled code of exactly these sources; it may not exist.

    Args:
        packages: The packages whose sources the code is made of: `PLAY`, `STUDY`, `DRAWING` or `AGENTS`.
    """
    import platformdirs

    digest = hashlib.sha256(repr((packages, *_machine())).encode())
    package = Path(__file__).resolve().parent.parent
    for source in sorted(path for name in packages for path in (package / name).rglob("*.py")):
        digest.update(source.relative_to(package).as_posix().encode())
        digest.update(source.read_bytes())
    base = os.environ.get("SILVERBALL_CACHE") or platformdirs.user_cache_dir("silverball")
    return Path(base) / "compiled" / digest.hexdigest()[:16]


@cache
def cache_folder(packages: tuple[str, ...] = PLAY) -> Path | None:
    """Make the folder for compiled code of exactly these sources; None where no folder can be written.

    Args:
        packages: As for `code_folder`.
    """
    folder = code_folder(packages)
    try:
        if not folder.is_dir():
            remove(folder)  # a file of this name, if there is one
        folder.mkdir(parents=True, exist_ok=True)
        folder.touch()
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def is_compiled(
    name: str = "step_single_world", packages: tuple[str, ...] = PLAY, *, layout: str = ""
) -> bool:
    """Whether a kernel's compiled code is on disk; otherwise a first start compiles it and all it calls.

    The first call for a folder checks its files. If one is damaged, it is discarded together with the code of
    this kernel, which is the last one compiled, and the result is False.

    Args:
        name: The kernel.
        packages: As for `code_folder`.
        layout: The layout of the worlds that it takes, "full" or "plain"; empty: any.
    """
    folder = cache_folder(packages)
    if folder is None:
        return False
    found = find_code(folder, name, layout)
    if folder not in _swept:
        _swept.add(folder)
        if not sweep(folder):
            for index in found:
                discard(index)
            return False
    return bool(found)


def compiled_counts() -> dict[Any, int]:
    """For how many sets of argument types each kernel is compiled or loaded in this process."""
    return {one: len(one.overloads) for one in _kernels}


def compiled_share(
    packages: tuple[str, ...] = PLAY, *, before: dict[Any, int] | None = None, without: tuple[str, ...] = ()
) -> float:
    """Estimate the progress of a first start: the share of loaded kernels that are compiled, 0 to 1.

    Their number grows evenly in time, except for the last two or three, which contain all the others.

    Args:
        packages: As for `code_folder`.
        before: What `compiled_counts` was when the start began.
        without: Modules whose names begin so are left out, because another process compiles them.
    """
    modules = {one: one.py_func.__module__ for one in _kernels}
    kernels = [
        one
        for one, module in modules.items()
        if _packages_of(module) == packages and not module.startswith(without)
    ]
    done = sum(len(one.overloads) > (before or {}).get(one, 0) for one in kernels)
    return (1.0 - LAST_SHARE) * done / max(len(kernels), 1)


def _machine() -> tuple[Any, ...]:
    """Everything other than the sources that machine code depends on."""
    import llvmlite.binding

    processor = SETTINGS.CPU_NAME or llvmlite.binding.get_host_cpu_name()
    return sys.implementation.cache_tag, numba.__version__, can_link, processor, bool(SETTINGS.BOUNDSCHECK)


def evict_old_code() -> None:
    """Remove the machine code of sources that have not been run for a month."""
    folder = cache_folder()
    if folder is None:
        return
    keep = (folder, *map(cache_folder, (STUDY, DRAWING, AGENTS)))
    with suppress(OSError):  # another process may remove folders at the same time
        for other in folder.parent.iterdir():
            if other not in keep and time.time() - other.stat().st_mtime > KEEP_SECONDS:
                shutil.rmtree(other, ignore_errors=True)


def _compile(function: F, **more: Any) -> F:
    options: dict[str, Any] = {
        "error_model": "numpy",
        "fastmath": False,
        "nogil": True,
        "_nrt": False,
        "no_cfunc_wrapper": True,
        **more,
    }
    is_helper = more.get("no_cpython_wrapper")
    linking = HelperCompiler if is_helper else KernelCompiler
    options.setdefault("pipeline_class", linking if can_link else NamedCompiler)
    compiled: Any = numba.njit(**options)(function)
    if isinstance(compiled, CPUDispatcher):
        compiled.__class__ = Internal if more.get("no_cpython_wrapper") else Compiled
        if more.get("inline") != "always":  # these are never compiled by themselves
            _kernels.append(compiled)
        folder = cache_folder(_packages_of(function.__module__))
        if folder is not None:
            vars(compiled)["_cache"] = CodeCache(function, folder)
    return cast(F, compiled)


def _packages_of(module: str) -> tuple[str, ...]:
    """The packages whose sources the machine code of a module's kernels depends on."""
    if module.startswith("silverball.drawing."):
        return DRAWING
    if module.startswith(("silverball.metrics.", "silverball.soak.")):
        return STUDY
    return AGENTS if module.startswith("silverball.envs.") else PLAY
