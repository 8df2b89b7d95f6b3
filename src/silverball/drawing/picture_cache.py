"""The cache of baked pictures: files in the user's cache folder.

The name of a file is a digest of everything that its picture depends on, including the sources of the
drawing, so a file may be missing but is never out of date. It begins with a digest of its name and content,
so damaged or exchanged files are detected. The least recently used files are removed when there are too many.
A read-only folder, a full disk or a damaged file cost time and nothing else.
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
    """A folder of baked pictures.

    Args:
        folder: The folder; by default one in the user's cache folder.
        limit: The size of all files together [byte].
    """

    def __init__(self, folder: Path | None = None, limit: int = LIMIT) -> None:
        self.folder = folder or default_folder()
        self._limit = limit

    def load(self, key: str) -> Arrays | None:
        """Return the arrays saved under a key; None if there are none or the file is damaged."""
        path = self.folder / (key + ENDING)
        try:
            if not os.path.lexists(path):
                return None
            data = path.read_bytes() if path.is_file() else b""  # reading a pipe might never end
            digest, content = data[:DIGEST_SIZE], data[DIGEST_SIZE:]
            if digest != digest_of(key, content):
                _remove(path)
                return None
            os.utime(path)  # the least recently used files are evicted first
        except OSError:
            return None
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            return {name: file[name] for name in file.files}

    def save(self, key: str, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Save arrays under a key, if the disk allows it."""
        content = io.BytesIO()
        np.savez(content, **arrays)  # type: ignore[arg-type]  # the stubs mistake the names for options
        data = digest_of(key, content.getvalue()) + content.getvalue()
        with contextlib.suppress(OSError):
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self.folder / (key + ENDING), lambda place: place.write_bytes(data))
            self._evict()

    def _evict(self) -> None:
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
    """Return the digest with which a file begins."""
    return hashlib.sha256(key.encode() + b"\0" + content).digest()


def default_folder() -> Path:
    """Return the user's folder for baked pictures."""
    import platformdirs

    base = os.environ.get("SILVERBALL_CACHE") or platformdirs.user_cache_dir("silverball")
    return Path(base) / "pictures"


def key_of(*parts: object) -> str:
    """Return the key of a picture that depends on these values (by their `repr`) and on our sources."""
    return hashlib.sha256(repr((_sources(), parts)).encode()).hexdigest()[:32]


@cache
def _sources() -> str:
    digest = hashlib.sha256(np.__version__.encode())
    for source in (*sorted((PACKAGE / "drawing").rglob("*.py")), PACKAGE / "physics" / "shapes.py"):
        digest.update(source.read_bytes())
    return digest.hexdigest()
