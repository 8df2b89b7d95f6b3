"""Shell completion of names: tables, players, themes and replays.

`silverball --install-completion` sets it up. The shell starts `silverball` for every press of Tab, so nothing
here imports the compiler, and few packages at all. Where a word has no completion here, for example the path
of a file in another folder, the shell completes file names.

Shells evaluate what they are given, so a name with characters that one could interpret is left out.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

SAFE_NAME = re.compile(r"\w[\w.+-]*")
THEME_NAMES = ("neon", "parlour", "clear")  # repeated here because the drawing imports the compiler
LAST_REPLAY = "last"


def complete_table(incomplete: str) -> list[str]:
    """The built-in tables, and the table files of the current folder."""
    built_in = Path(__file__).parents[1] / "table" / "tables"  # silverball.table takes 0.3 s to import
    return matching(sorted(path.stem for path in built_in.glob("*.toml")) + files(".toml"), incomplete)


def complete_player(incomplete: str) -> list[str]:
    """The built-in players, and those of installed packages, which are not imported."""
    from importlib.metadata import entry_points

    from silverball.players.registry import BUILT_IN, ENTRY_POINT_GROUP

    return matching([*BUILT_IN, *sorted(entry_points(group=ENTRY_POINT_GROUP).names)], incomplete)


def complete_theme(incomplete: str) -> list[str]:
    """The themes."""
    return matching(THEME_NAMES, incomplete)


def complete_replay(incomplete: str) -> list[str]:
    """The last game, and the replays of the current folder."""
    return matching([LAST_REPLAY, *files(".replay")], incomplete)


def files(ending: str) -> list[str]:
    """The names of the files in the current folder with an ending; none if it cannot be read."""
    with suppress(OSError):
        return sorted(name for name in os.listdir() if name.endswith(ending))
    return []


def matching(names: Iterable[str], incomplete: str) -> list[str]:
    """The names that continue a word and that every shell takes literally."""
    return [name for name in names if name.startswith(incomplete) and SAFE_NAME.fullmatch(name)]
