"""How every kernel is compiled: the one decorator, and where its machine code is kept.

Options, and why:

* ``error_model="numpy"``: a division by zero gives inf or nan instead of raising; kernels never raise.
* ``fastmath=False``: no reordered and no fused arithmetic, so that every machine gives the same bits.
* ``nogil=True``: slices of a batch run on threads.
* ``forceinline=True``, for the few small helpers of the hot loop: their tuples stay in registers.
* ``_nrt=False``: no reference counting. Kernels never allocate, and the compiler now refuses an allocation;
  with counting, every function that is given an array would pay for atomic operations, some 20 ns a call.
* ``no_cfunc_wrapper=True``: nobody passes kernels as function pointers; it saves 8 % of the compilation.
* ``no_cpython_wrapper=True``, for what only kernels call: it cannot be called from Python, and needs no code
  that unpacks arguments; it saves some 10 % of the compilation.
* the cache: Numba's own ``cache=True`` looks at the file of the cached function alone and would return stale
  code after a change of a callee in *another* file, and it trusts its files (see `code_cache.py`). Compiled
  code is therefore kept in a folder of the user's cache directory that is named after a hash of the sources
  of all packages that hold kernels, and of what else machine code depends on. The drawing has a folder of its
  own: nothing that plays calls it, so a change of a colour need not compile the physics anew.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numba.core.config
from numba import extending, types
from numba.core.registry import CPUDispatcher

from silverball.physics.code_cache import INDEX, CodeCache, discard, read_code, remove, sweep
from silverball.physics.compile_thread import run_in_compiler_thread

SETTINGS: Any = numba.core.config
PLAY = ("physics", "world", "players")
STUDY = (*PLAY, "metrics", "soak")
DRAWING = ("physics", "drawing/kernels")
AGENTS = (*PLAY, "envs")
KERNEL_PACKAGES = (*STUDY, "envs", "drawing")  # a kernel elsewhere must be added here; a test sees to it
LAST_SHARE = 0.2  # of the time of a first start: what the last kernels take; measured
KEEP_SECONDS = 30 * 24 * 3600.0
_kernels: list[Any] = []  # all of this process
_swept: set[Path] = set()  # folders of compiled code in which no file is damaged, or was when we looked


class Compiled(CPUDispatcher):
    """A function that is compiled, or loaded, on its first call, and without harm interrupted meanwhile."""

    def compile(self, signature: Any) -> Any:
        """The machine code for arguments of these types."""
        return run_in_compiler_thread(super().compile, signature)


class Internal(Compiled):
    """A compiled function without the code that would let Python call it."""

    def __call__(self, *arguments: Any) -> Any:
        """Refuse, where Numba would crash."""
        name = self.py_func.__name__
        raise TypeError(
            f"{name} is compiled for the use of other kernels alone; from Python call "
            f"{name}.py_func, which is not compiled, or decorate it with @kernel"
        )


F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile a function on its first call and keep the machine code for the next start."""
    return _compile(function)


def internal(function: F) -> F:
    """Compile a function that only kernels call."""
    return _compile(function, no_cpython_wrapper=True)


def inlined(function: F) -> F:
    """Compile a small helper of the hot loop into its callers, which are kernels."""
    return _compile(function, no_cpython_wrapper=True, forceinline=True)


def ir_inlined(function: F) -> F:
    """Put a helper into its callers before they are compiled, so that it is not compiled by itself.

    For what has one caller, or makes an array: without reference counting no compiled function returns one.
    """
    return _compile(function, inline="always")


def bind_types(function: Any, *arguments: Any) -> Callable[..., Any]:
    """A kernel without Numba's look at the types of its arguments, which takes longer than a tick does.

    Args:
        function: A kernel; it is compiled for these arguments if it has not been.
        arguments: Such as it will be called with. Whoever calls it with others reads and writes memory that
            is not theirs.
    """
    if SETTINGS.DISABLE_JIT:
        return cast(Callable[..., Any], function)
    types = tuple(cast(Any, numba).typeof(one) for one in arguments)
    found: Callable[..., Any] = function.compile(types)
    return found


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


@cache
def cache_folder(packages: tuple[str, ...] = PLAY) -> Path | None:
    """The folder for compiled code of exactly these sources; None where no folder can be written.

    Args:
        packages: Whose sources the code is made of: `PLAY`, `STUDY`, `DRAWING` or `AGENTS`.
    """
    import platformdirs

    digest = hashlib.sha256(repr((packages, *_machine())).encode())
    package = Path(__file__).resolve().parent.parent
    for source in sorted(path for name in packages for path in (package / name).rglob("*.py")):
        digest.update(source.relative_to(package).as_posix().encode())
        digest.update(source.read_bytes())
    base = os.environ.get("SILVERBALL_CACHE") or platformdirs.user_cache_dir("silverball")
    folder = Path(base) / "compiled" / digest.hexdigest()[:16]
    try:
        if not folder.is_dir():
            remove(folder)  # whatever else stands there
        folder.mkdir(parents=True, exist_ok=True)
        folder.touch()
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def is_compiled(name: str = "run_worlds", packages: tuple[str, ...] = PLAY) -> bool:
    """Whether the compiled code of a kernel is on disk; a first start compiles it and all it calls.

    Not so either if anything in its folder is damaged, when this is asked for the first time: then that, and
    this kernel as the last one, are compiled anew.
    """
    folder = cache_folder(packages)
    if folder is None:
        return False
    found = [index for index in folder.rglob(f"*.{name}-*{INDEX}") if read_code(index) is not None]
    if folder not in _swept:
        _swept.add(folder)
        if not sweep(folder):
            for index in found:
                discard(index)
            return False
    return bool(found)


def compiled_share(packages: tuple[str, ...] = PLAY) -> float:
    """How far a first start has compiled the kernels whose source this process has loaded, 0 to 1.

    Their number grows evenly in time, but for the last two or three, which contain all the others.
    """
    kernels = [one for one in _kernels if _packages_of(one.py_func.__module__) == packages]
    return (1.0 - LAST_SHARE) * sum(bool(one.overloads) for one in kernels) / max(len(kernels), 1)


def _machine() -> tuple[Any, ...]:
    """What machine code depends on besides the sources."""
    import llvmlite.binding

    processor = SETTINGS.CPU_NAME or llvmlite.binding.get_host_cpu_name()
    return sys.implementation.cache_tag, numba.__version__, processor, bool(SETTINGS.BOUNDSCHECK)


def evict_old_code() -> None:
    """Remove the machine code of sources that nobody has run for a month."""
    folder = cache_folder()
    if folder is None:
        return
    keep = (folder, *map(cache_folder, (STUDY, DRAWING, AGENTS)))
    for other in folder.parent.iterdir():
        if other not in keep and time.time() - other.stat().st_mtime > KEEP_SECONDS:
            shutil.rmtree(other, ignore_errors=True)


def _compile(function: F, **more: bool | str) -> F:
    options: dict[str, Any] = {
        "error_model": "numpy",
        "fastmath": False,
        "nogil": True,
        "_nrt": False,
        "no_cfunc_wrapper": True,
        **more,
    }
    compiled: Any = numba.njit(**options)(function)
    if isinstance(compiled, CPUDispatcher):
        compiled.__class__ = Internal if more.get("no_cpython_wrapper") else Compiled
        if more.get("inline") != "always":  # those are never compiled by themselves
            _kernels.append(compiled)
        folder = cache_folder(_packages_of(function.__module__))
        if folder is not None:
            vars(compiled)["_cache"] = CodeCache(function, folder)
    return cast(F, compiled)


def _packages_of(module: str) -> tuple[str, ...]:
    """The packages whose sources the code of a module's kernels is made of."""
    if module.startswith("silverball.drawing."):
        return DRAWING
    if module.startswith(("silverball.metrics.", "silverball.soak.")):
        return STUDY
    return AGENTS if module.startswith("silverball.envs.") else PLAY
