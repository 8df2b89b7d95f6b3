"""How is a file written whole or not at all?

Under another name beside its place, then renamed in one step: whatever goes wrong, an interruption included,
what was there stays as it was and nothing half-written stays behind.
"""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Callable
from pathlib import Path


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file in one step.

    Args:
        path: Where it is to be. A link stays a link, and a file that is replaced keeps its permissions.
        write: Called with the place to write to, which has the same ending.

    Raises:
        OSError: It cannot be written.
    """
    target = Path(os.path.realpath(path))
    temporary = target.with_name(f".silverball-{secrets.token_hex(8)}{target.suffix.lower()}")
    try:
        write(temporary)
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())  # some disks tell only now that they are full
        if target.exists():
            shutil.copymode(target, temporary)
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)
