"""The WebAssembly module that is shipped: its bytes, and the note in it about what it was built from.

`silverball.wasm` holds the kernels of the step and of the drawing. `python -m silverball.web.build` makes it
again; a test fails as long as the kernels' sources are not those that its note names.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import NamedTuple

from silverball.errors import SilverballError
from silverball.web.wasmlink import sections

PATH = Path(__file__).with_name("silverball.wasm")
NOTE = "silverball"  # the name of the custom section
SOURCES = (
    "physics/*.py", "referee/*.py", "drawing/kernels/*.py", "world/single_step.py", "web/build.py",
    "web/exports.py", "web/wasmlink.py", "web/wrappers.py",
)  # fmt: skip
"""What the bytes of the module depend on, apart from the compiler."""


class Note(NamedTuple):
    """What a module was built from.

    Attributes:
        sources: The hash of the sources.
        numba: The version of Numba.
        llvm: The version of llvmlite.
    """

    sources: str
    numba: str
    llvm: str

    def to_bytes(self) -> bytes:
        """The note as JSON, for the module."""
        return json.dumps(self._asdict(), sort_keys=True).encode()


def source_hash() -> str:
    """The hash of the sources as they are now."""
    package = Path(__file__).resolve().parent.parent
    digest = hashlib.sha256()
    for source in sorted(path for pattern in SOURCES for path in package.glob(pattern)):
        digest.update(source.relative_to(package).as_posix().encode() + b"\0")
        digest.update(source.read_bytes() + b"\0")
    return digest.hexdigest()


def read_module(path: Path = PATH) -> bytes:
    """The bytes of the module.

    Raises:
        SilverballError: It is not there.
    """
    try:
        return path.read_bytes()
    except OSError as error:
        raise SilverballError(
            f"{path}: the module of the table in a browser cannot be read ({error.strerror}); "
            "reinstall Silverball, or build it with `python -m silverball.web.build`"
        ) from None


def read_note(module: bytes) -> Note:
    """The note in a module."""
    return Note(**json.loads(sections(module)[1][NOTE]))
