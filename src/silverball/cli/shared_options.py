"""Options that several commands share, and the checks of their values."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from silverball.errors import OutputError, SilverballError

if TYPE_CHECKING:
    from silverball.drawing import Theme

LAST_SEED = 2**63 - 1
MOST_WORLDS = 1_000_000


def file_name(text: str) -> Path:
    """The path of a file; "film.gif/" is refused, which `Path` would silently turn into "film.gif".

    Raises:
        OutputError: The text can only name a folder.
    """
    if os.path.basename(text) in ("", ".", ".."):
        raise OutputError(f"{text or '(nothing)'}: this names a folder; give the name of a file")
    return Path(text)


def theme_named(name: str) -> Theme:
    """The theme of a name.

    Raises:
        SilverballError: There is no theme of that name.
    """
    from silverball.drawing import THEMES

    if name not in THEMES:
        raise SilverballError(f"--theme must be one of {', '.join(THEMES)}, got {name!r}")
    return THEMES[name]


TableName = Annotated[str, typer.Option("--table", help="Built-in table or table file.")]
BoardSeed = Annotated[
    int, typer.Option("--seed", min=0, max=LAST_SEED, help="Seed of the board and of all randomness on it.")
]
FirstSeed = Annotated[
    int,
    typer.Option(
        "--seed",
        min=0,
        max=LAST_SEED - MOST_WORLDS,
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
        help="Who holds the buttons: idle, random, reflex, hold, planner, trained, or a registered player.",
    ),
]
TickRate = Annotated[
    int, typer.Option("--tick-rate", min=10, max=100_000, help="Ticks per simulated second [1/s].")
]
Worlds = Annotated[
    int, typer.Option("--worlds", min=1, max=MOST_WORLDS, help="Worlds that are simulated side by side.")
]
Size = Annotated[
    int | None, typer.Option("--size", min=100, max=4320, help="Height of the picture [pixels].")
]
ThemeName = Annotated[
    str, typer.Option("--theme", help="Look of the table: neon, parlour, or clear (for colour-blind eyes).")
]
Force = Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object.")]


def check_duration(seconds: float, tick_rate: int) -> None:
    """Refuse a time that is shorter than a tick, or not a number.

    Raises:
        SilverballError: The time has no tick in it.
    """
    if not seconds * tick_rate >= 1.0:
        raise SilverballError(
            f"--seconds: {seconds:g} s is less than one tick of 1/{tick_rate} s; ask for more"
        )
