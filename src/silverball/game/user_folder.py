"""The data folder of the user, and text files in it."""

from __future__ import annotations

import os
from pathlib import Path

from silverball.wholefile import write_whole

TABLES = "tables"  # subfolder of the data folder for the user's tables


def data_folder() -> Path:
    """The folder for the user's data; the environment variable SILVERBALL_DATA names another one."""
    import platformdirs

    return Path(
        os.environ.get("SILVERBALL_DATA") or platformdirs.user_data_dir("silverball", appauthor=False)
    )


def write_user_file(text: str, name: str, folder: Path | None = None) -> Path | None:
    """Write a text file, whole or not at all; a file of this name is replaced.

    Args:
        text: The content.
        name: The name of the file.
        folder: Its folder; None: the data folder.

    Returns:
        The path, or None if the file cannot be written: playing does not depend on it.
    """
    path = (folder or data_folder()) / name
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
    except OSError:
        return None
    return path
