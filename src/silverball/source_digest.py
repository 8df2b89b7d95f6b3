"""The digest of sources: which code has made a result."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path


def source_digest(packages: Iterable[str]) -> str:
    """A hash of all sources of some packages of Silverball, 16 hexadecimal digits.

    Args:
        packages: Their names, without "silverball.".
    """
    root = Path(__file__).resolve().parent
    digest = hashlib.sha256()
    for source in sorted(path for name in packages for path in (root / name).rglob("*.py")):
        digest.update(source.relative_to(root).as_posix().encode() + source.read_bytes())
    return digest.hexdigest()[:16]
