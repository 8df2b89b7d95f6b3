"""Options that several commands share, and the checks of their values."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from silverball.cli.completion import complete_player, complete_table, complete_theme
from silverball.errors import OutputError, SilverballError
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.drawing import Theme

LAST_SEED = 2**63 - 1
MAX_WORLDS = 1_000_000


def file_name(text: str) -> Path:
    """The path of a file; rejects "film.gif/", which `Path` would silently turn into "film.gif".

    Raises:
        OutputError: The text can only name a folder.
    """
    if os.path.basename(text) in ("", ".", ".."):
        raise OutputError(f"{text or '(nothing)'}: this names a folder; give the name of a file")
    return Path(text)


def check_output(path: Path, endings: tuple[str, ...] = (), *, force: bool = False) -> None:
    """Check that a file can be written, before a minute of work is lost.

    Args:
        path: The file to write.
        endings: The endings that its name may have; empty: any.
        force: Whether an existing file may be overwritten.

    Raises:
        OutputError: The ending is not allowed, the folder is missing or not writable, or the file exists.
        MissingExtra: An MP4 needs PyAV, and it is not installed.
    """
    from silverball.wholefile import is_special

    shown, folder = plain(str(path)), plain(str(path.parent))
    if endings and path.suffix.lower() not in endings:
        ending = path.suffix or "no ending"
        raise OutputError(f"{shown}: the name must end in {' or '.join(endings)}, got {ending!r}")
    if not path.absolute().parent.is_dir():
        raise OutputError(f"{shown}: the folder {folder!r} does not exist; create it first")
    if path.is_dir():
        raise OutputError(f"{shown}: this is a folder; give the name of a file")
    if is_special(path):
        raise OutputError(f"{shown}: this is not a regular file; give another name")
    if path.exists() and not force:
        raise OutputError(f"{shown}: this file exists; choose another name, or overwrite it with --force")
    if not os.access(path.absolute().parent, os.W_OK):
        raise OutputError(f"{shown}: no permission to write into the folder {folder!r}")
    if path.suffix.lower() == ".mp4" and endings:
        from silverball.export.mp4 import require_av

        require_av()


def theme_named(name: str) -> Theme:
    """The theme of a name.

    Raises:
        SilverballError: There is no theme of that name.
    """
    from silverball.drawing import THEMES

    if name not in THEMES:
        raise SilverballError(f"--theme must be one of {', '.join(THEMES)}, got {name!r}")
    return THEMES[name]


TableName = Annotated[
    str, typer.Option("--table", help="Built-in table or table file.", autocompletion=complete_table)
]
BoardSeed = Annotated[
    int, typer.Option("--seed", min=0, max=LAST_SEED, help="Seed of the board and of all randomness on it.")
]
FirstSeed = Annotated[
    int,
    typer.Option(
        "--seed",
        min=0,
        max=LAST_SEED - MAX_WORLDS,
        help="Seed of the first board and world; the others get the seeds after it.",
    ),
]
Seconds = Annotated[
    float, typer.Option("--seconds", min=0.01, max=1e9, help="Simulated seconds per world [s].")
]
PlayerName = Annotated[
    str,
    typer.Option(
        "--player",
        help="The player: idle, random, blind, reflex, hold, planner, trained, or a registered one.",
        autocompletion=complete_player,
    ),
]
TickRate = Annotated[
    int, typer.Option("--tick-rate", min=10, max=100_000, help="Ticks per simulated second [1/s].")
]
Worlds = Annotated[
    int, typer.Option("--worlds", min=1, max=MAX_WORLDS, help="Worlds that are simulated side by side.")
]
Size = Annotated[
    int | None, typer.Option("--size", min=100, max=4320, help="Height of the picture [pixels].")
]
ThemeName = Annotated[
    str,
    typer.Option(
        "--theme",
        help="Look of the table: neon, parlour, or clear (for colour-blind eyes).",
        autocompletion=complete_theme,
    ),
]
Music = Annotated[bool, typer.Option("--music/--no-music", help="Whether an MP4 has music.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object.")]


def check_duration(seconds: float, tick_rate: int) -> None:
    """Check that a duration lasts at least one tick.

    Raises:
        SilverballError: It is shorter than a tick, or NaN.
    """
    if not seconds * tick_rate >= 1.0:
        raise SilverballError(f"--seconds: {seconds:g} s is less than one tick of 1/{tick_rate} s; use more")
