"""What may stand after --out? The name of a file, not that of a folder."""

from __future__ import annotations

import os
from pathlib import Path

from silverball.errors import OutputError


def file_name(text: str) -> Path:
    """The path that a person has typed; "film.gif/" would quietly become "film.gif" otherwise.

    Raises:
        OutputError: It can only be a folder.
    """
    if os.path.basename(text) in ("", ".", ".."):
        raise OutputError(f"{text or '(nothing)'}: this names a folder; give the name of a file")
    return Path(text)
