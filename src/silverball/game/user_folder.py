"""Where do a user's files belong? In the user's data folder, each whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from silverball.wholefile import write_whole


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
        write_whole(path, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
    except OSError:
        return None
    return path
