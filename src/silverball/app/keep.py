"""Where are the logs of games kept? In the user's data folder, whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

LAST_GAME = "last-game.jsonl"


def data_folder() -> Path:
    """The folder for what a player keeps; the environment variable SILVERBALL_DATA names another one."""
    import platformdirs

    return Path(
        os.environ.get("SILVERBALL_DATA") or platformdirs.user_data_dir("silverball", appauthor=False)
    )


def keep(text: str, name: str, folder: Path | None = None) -> Path | None:
    """Write a text into the data folder.

    A file of that name is replaced in one step, so that there is always a whole one.

    Returns:
        Where it is, or None where nothing can be written: playing does not depend on it.
    """
    path = (folder or data_folder()) / name
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=f".{name}.", dir=path.parent)
        try:
            with open(handle, "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(temporary, path)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(temporary)
            raise
    except OSError:
        return None
    return path
