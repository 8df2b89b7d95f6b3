"""What can a menu be told, and what can it ask for? Its buttons and its commands.

Commands are frozen dataclasses and not tuples, because two empty tuples are equal: `Quit()` must never be
taken for `Resume()`. The window matches them by class.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from silverball.app.settings import Settings
from silverball.game.view import Mode


class Button(StrEnum):
    """What works a menu; keys, gamepads and the paddles of a real machine all come down to these."""

    LEFT = "left"  # left paddle: the one before, up, less
    RIGHT = "right"  # right paddle: the next one, down, more
    START = "start"  # Space: choose
    BACK = "back"  # Esc, or both paddles held for a second: one page up


@dataclass(frozen=True)
class Play:
    """Begin a game; the menu has closed itself.

    Attributes:
        mode: Which game.
        table: As in the settings: a built-in name or a path.
        seed: Of the board; None: a new one, or the table has no random board.
    """

    mode: Mode
    table: str
    seed: int | None = None


@dataclass(frozen=True)
class WatchLast:
    """Show the last game again; the menu has closed itself."""


@dataclass(frozen=True)
class WatchScore:
    """Show the game of a high score; the menu has closed itself.

    Attributes:
        key: The `ScoreRow.key` of it.
    """

    key: str


@dataclass(frozen=True)
class WatchDemo:
    """Let the program play the chosen table and watch it; the menu has closed itself.

    Attributes:
        player: The name of the player to watch.
    """

    player: str


@dataclass(frozen=True)
class Change:
    """Use and keep these settings. They come with every step of a value, so that it can be seen and heard."""

    settings: Settings


@dataclass(frozen=True)
class ShowBoard:
    """Show the board of the chosen table that a seed makes.

    Attributes:
        seed: None: another one.
    """

    seed: int | None


@dataclass(frozen=True)
class ShowTableProblem:
    """Tell why a table cannot be played.

    Attributes:
        table: As in the settings: a path.
        problem: The first reason.
    """

    table: str
    problem: str


@dataclass(frozen=True)
class Quit:
    """End the program."""


@dataclass(frozen=True)
class Resume:
    """Go on with the paused game; the menu has closed itself."""


@dataclass(frozen=True)
class Restart:
    """Give the paused game up and begin it anew on the same board; the menu has closed itself."""


@dataclass(frozen=True)
class EndGame:
    """Give the paused game up, or put the one away that is over. The main menu is open."""


@dataclass(frozen=True)
class SaveReplay:
    """Keep the game that has just ended as a file; answer with `Menus.say`."""


@dataclass(frozen=True)
class Initials:
    """The score that has just been made belongs to these three characters; they are in the settings too."""

    text: str


@dataclass(frozen=True)
class ReplaySpeed:
    """Play the replay slower (-1) or faster (+1), by one step."""

    step: int


@dataclass(frozen=True)
class ReplayPause:
    """Hold the replay, or go on with it."""


@dataclass(frozen=True)
class ReplayJump:
    """Go back or ahead in the replay.

    Attributes:
        seconds: How far, negative for back [s].
    """

    seconds: float


@dataclass(frozen=True)
class EndReplay:
    """Watch no longer. The page from which it was opened, or the main menu, is open again."""


@dataclass(frozen=True)
class Attract:
    """Nobody is there (on), so let the program play behind the menu; or somebody has come back."""

    on: bool


Command: TypeAlias = (
    Play
    | WatchLast
    | WatchScore
    | WatchDemo
    | Change
    | ShowBoard
    | ShowTableProblem
    | Quit
    | Resume
    | Restart
    | EndGame
    | SaveReplay
    | Initials
    | ReplaySpeed
    | ReplayPause
    | ReplayJump
    | EndReplay
    | Attract
)
