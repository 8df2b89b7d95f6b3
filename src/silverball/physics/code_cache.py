"""The cache of machine code on disk, which detects damaged files and has them compiled again.

Numba's own cache unpickles whatever its files hold and runs it. This one unpickles a file only if it is, bit
for bit, what was written, and reports damage once. A function has two files for each set of argument types:

    NAME.LAYOUT-TYPES.nbi   the index: the SHA-256 of the code
    NAME.SHA-256.nbc        the code; its SHA-256 covers the name of the index too

Each file is renamed into its place when it is complete, the code first. So processes that write at the same
time never mix two versions, and a file that was emptied, cut short, changed or exchanged is detected.
"""

from __future__ import annotations

import contextlib
import hashlib
import logging
import os
import pickle
import secrets
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numba
from numba.core.caching import FunctionCache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps as untyped_dumps

Base, Result, dumps = cast(Any, FunctionCache), cast(Any, CompileResult), cast(Any, untyped_dumps)
INDEX, CODE = ".nbi", ".nbc"
FULL_LAYOUT, PLAIN_LAYOUT = "full", "plain"  # of world records; see `for_devices.py`


class Damage:
    """Damage found in this process.

    Attributes:
        message: A sentence about it; empty if there was none.
    """

    message = ""

    @classmethod
    def report(cls, folder: Path) -> None:
        """Log a warning the first time damage is found."""
        if not cls.message:
            cls.message = f"compiled code in {str(folder)!r} was damaged and is compiled again"
            logging.getLogger("silverball").warning("silverball: %s", cls.message)


class CodeCache(Base):  # type: ignore[misc,valid-type]
    """The compiled code of one function, with the interface that Numba expects.

    Args:
        function: The Python function that is compiled.
        folder: The folder of all compiled code of these sources.

    Attributes:
        layout_of: The layout of the worlds among argument types, a part of the names of files; a hook for
            `for_devices.py`, which knows the types.
    """

    layout_of: Callable[[Any], str] = staticmethod(lambda types: FULL_LAYOUT)

    def __init__(self, function: Any, folder: Path) -> None:
        # Numba's constructor is not called: it would look for a folder of its own.
        package, _, module = function.__module__.rpartition(".")
        version = f"py{sys.version_info[0]}{sys.version_info[1]}"
        name = f"{module}.{function.__qualname__}-{function.__code__.co_firstlineno}.{version}"
        self._py_func = function
        self._folder = folder / (package.removeprefix("silverball.") or "main")
        self._name = "".join(letter for letter in name if letter not in "<>")
        self._enabled = True

    @property
    def cache_path(self) -> str:
        """The folder of this function's files."""
        return str(self._folder)

    def flush(self) -> None:
        """Discard all versions of this function."""
        for index in self._folder.glob(f"{self._name}.*{INDEX}"):
            discard(index)

    def load_overload(self, signature: Any, target_context: Any) -> Any:
        """Load the code for these types; None if there is none that can be trusted."""
        target_context.refresh()
        if not self._enabled:
            return None
        key = self._index_key(signature, target_context.codegen())
        index = self._index(key)
        if not os.path.lexists(index):
            return None
        content = read_code(index)
        if content is None:
            if os.path.lexists(index):  # otherwise another process has just cleared the cache
                Damage.report(self._folder.parent)
                discard(index)
            return None
        saved_key, code = pickle.loads(content)
        return Result._rebuild(target_context, *code) if saved_key == key else None

    def save_overload(self, signature: Any, code: Any) -> None:
        """Save code if possible; on a full disk the next start compiles again."""
        if not self._enabled or code.library.has_dynamic_globals:
            return
        key = self._index_key(signature, code.codegen)
        content = dumps((key, code._reduce()))
        index = self._index(key)
        digest = code_digest(index, content)
        with contextlib.suppress(OSError):
            if not self._folder.is_dir():
                remove(self._folder)  # a file of this name, if there is one
            self._folder.mkdir(parents=True, exist_ok=True)
            write(code_path(index, digest), content)
            write(index, digest.encode())

    def _index(self, key: Any) -> Path:
        types = hashlib.sha256(repr((numba.__version__, str(key))).encode()).hexdigest()[:16]
        return self._folder / f"{self._name}.{CodeCache.layout_of(key[0])}-{types}{INDEX}"


def find_code(folder: Path, function: str, layout: str = "") -> list[Path]:
    """Find the indexes of a function in a folder of compiled code, those of damaged code left out.

    Args:
        folder: The folder.
        function: Its name.
        layout: The layout of the worlds that it takes, "full" or "plain"; empty: any.
    """
    pattern = f"*.{function}-*.{layout}-*{INDEX}" if layout else f"*.{function}-*{INDEX}"
    try:
        return [index for index in folder.rglob(pattern) if read_code(index) is not None]
    except OSError:
        return []  # it cannot be listed, or another process clears it


def sweep(folder: Path) -> bool:
    """Discard damaged files in a folder of compiled code; return whether all were intact.

    An index that has disappeared is not damaged: another process clears the cache, indexes first.
    """
    try:
        damaged = [
            index
            for index in folder.rglob(f"*{INDEX}")
            if read_code(index) is None and os.path.lexists(index)
        ]
    except OSError:
        return True  # it cannot be listed; each file is checked again before it is used
    for index in damaged:
        discard(index)
    if damaged:
        Damage.report(folder)
    return not damaged


def read_code(index: Path) -> bytes | None:
    """Read the code that an index names; None if either file is not what was written."""
    digest = read_file(index)
    if digest is None or len(digest) != hashlib.sha256().digest_size * 2 or not digest.isalnum():
        return None
    name = digest.decode("ascii", "replace")
    content = read_file(code_path(index, name))
    return content if content is not None and code_digest(index, content) == name else None


def read_file(path: Path) -> bytes | None:
    """Read a file; None if it is not a regular file, or cannot be read."""
    try:
        return path.read_bytes() if path.is_file() else None  # a pipe would block forever
    except OSError:
        return None


def code_digest(index: Path, content: bytes) -> str:
    """Compute the digest that identifies this code together with its index."""
    return hashlib.sha256(index.name.encode() + b"\0" + content).hexdigest()


def code_path(index: Path, digest: str) -> Path:
    """The path of the file with the code of a digest."""
    function = index.name.removesuffix(INDEX).rpartition(".")[0]
    return index.with_name(f"{function}.{digest[:32]}{CODE}")


def discard(index: Path) -> None:
    """Remove an index, or whatever has its name, and the code that it names."""
    digest = read_file(index)
    if digest and digest.isalnum() and digest.isascii():
        remove(code_path(index, digest.decode()))
    remove(index)


def remove(path: Path) -> None:
    """Remove a file or a folder, if possible."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        with contextlib.suppress(OSError):
            path.unlink(missing_ok=True)


def write(path: Path, content: bytes) -> None:
    """Write a file in one step, by renaming a temporary one."""
    temporary = path.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        temporary.write_bytes(content)
        if path.is_dir():
            remove(path)  # nothing can be renamed onto a folder
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
