"""Where are baked pictures kept for the next time? In files of the user's cache directory.

A file is named after everything that its picture depends on, the drawing's own sources included, so it can be
missing but never out of date; it begins with a digest of its name and its content, so a damaged one, or
another one in its place, is never used. The oldest go when there are too many. A folder that cannot be
written, a full disk or a damaged file cost time and nothing else.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import shutil
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.wholefile import write_whole

LIMIT = 256_000_000  # bytes of all pictures together
ENDING = ".picture"
DIGEST_SIZE = 32  # bytes
PACKAGE = Path(__file__).resolve().parent.parent

Arrays = dict[str, NDArray[Any]]


class PictureCache:
    """A folder of pictures.

    Args:
        folder: Where they lie; None: in the user's cache directory.
        limit: Bytes that they may take together.
    """

    def __init__(self, folder: Path | None = None, limit: int = LIMIT) -> None:
        self.folder = folder or usual_folder()
        self._limit = limit

    def load(self, key: str) -> Arrays | None:
        """What was saved under a key; None if there is nothing, or nothing whole."""
        path = self.folder / (key + ENDING)
        try:
            if not os.path.lexists(path):
                return None
            kept = path.read_bytes() if path.is_file() else b""  # a pipe would wait for ever
            digest, content = kept[:DIGEST_SIZE], kept[DIGEST_SIZE:]
            if digest != digest_of(key, content):
                _remove(path)
                return None
            os.utime(path)  # the pictures that are looked at stay longest
        except OSError:
            return None
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            return {name: file[name] for name in file.files}

    def save(self, key: str, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Keep arrays under a key, if that is possible."""
        content = io.BytesIO()
        np.savez(content, **arrays)  # type: ignore[arg-type]  # the stubs take the names for options
        kept = digest_of(key, content.getvalue()) + content.getvalue()
        with contextlib.suppress(OSError):
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self.folder / (key + ENDING), lambda place: place.write_bytes(kept))
            self._forget_oldest()

    def _forget_oldest(self) -> None:
        files = [(path.stat(), path) for path in self.folder.glob("*" + ENDING)]
        total = sum(stat.st_size for stat, _ in files)
        for stat, path in sorted(files, key=lambda file: file[0].st_mtime):
            if total <= self._limit:
                break
            _remove(path)
            total -= stat.st_size


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink()


def digest_of(key: str, content: bytes) -> bytes:
    """What a file begins with."""
    return hashlib.sha256(key.encode() + b"\0" + content).digest()


def usual_folder() -> Path:
    """The user's folder for pictures."""
    import platformdirs

    base = os.environ.get("SILVERBALL_CACHE") or platformdirs.user_cache_dir("silverball")
    return Path(base) / "pictures"


def key_of(*parts: object) -> str:
    """The name of a picture that depends on these values, which `repr` tells in full, and on our sources."""
    return hashlib.sha256(repr((_sources(), parts)).encode()).hexdigest()[:32]


@cache
def _sources() -> str:
    digest = hashlib.sha256(np.__version__.encode())
    for source in (*sorted((PACKAGE / "drawing").rglob("*.py")), PACKAGE / "physics" / "shapes.py"):
        digest.update(source.read_bytes())
    return digest.hexdigest()
