"""The buttons of the menus, and the commands with which menus ask the program to act.

Commands are frozen dataclasses, not tuples, because two empty tuples are equal and `Quit()` must never equal
`Resume()`. `command_handlers.py` dispatches on their class.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from silverball.game.view import Mode


class Button(StrEnum):
    """The buttons that operate a menu; keys, gamepads and real paddle buttons are all mapped to these."""

    LEFT = "left"  # left paddle: previous, up, less
    RIGHT = "right"  # right paddle: next, down, more
    START = "start"  # Space: choose
    BACK = "back"  # Esc, or both paddles held for a second: to the page below


class Rivalry(StrEnum):
    """Who plays beside the player."""

    NOBODY = ""
    BEST = "best"  # the best game of the table
    TODAY = "today"  # the best game of the day
    PLANNER = "planner"


@dataclass(frozen=True)
class Play:
    """Begin a game; the menu has closed itself.

    Attributes:
        mode: Mode of the game.
        table: A built-in name or a path, as in the settings.
        seed: Seed of the board; None: a new one, or the table has no random parts.
        players: How many take turns.
        rival: Who plays beside the player.
    """

    mode: Mode
    table: str
    seed: int | None = None
    players: int = 1
    rival: Rivalry = Rivalry.NOBODY


@dataclass(frozen=True)
class WatchLast:
    """Replay the last game; the menu has closed itself."""


@dataclass(frozen=True)
class WatchScore:
    """Replay the game of a high score; the menu has closed itself.

    Attributes:
        key: Its `ScoreRow.key`.
    """

    key: str


@dataclass(frozen=True)
class WatchDemo:
    """Start a demo on the chosen table; the menu has closed itself.

    Attributes:
        player: Name of the player to watch.
    """

    player: str


@dataclass(frozen=True)
class ShowBoard:
    """Show the board that a seed makes of the chosen table.

    Attributes:
        seed: Seed of the board; None draws one.
    """

    seed: int | None


@dataclass(frozen=True)
class ShowTableProblem:
    """Show why a table cannot be played.

    Attributes:
        table: A path, as in the settings.
        problem: The first problem.
    """

    table: str
    problem: str


@dataclass(frozen=True)
class Quit:
    """End the program."""


@dataclass(frozen=True)
class Resume:
    """Continue the paused game; the menu has closed itself."""


@dataclass(frozen=True)
class Restart:
    """Abandon the paused game and restart on the same board; the menu has closed itself."""


@dataclass(frozen=True)
class EndGame:
    """Abandon the paused game, or remove one that is over. The main menu is open."""


@dataclass(frozen=True)
class SaveReplay:
    """Save the game that has just ended as a file; report with `Menus.show_message`."""


@dataclass(frozen=True)
class Initials:
    """Put these three initials, already saved in the settings, on the latest score.

    Attributes:
        text: The initials.
        player: Whose score it is in a match, from 1; 0 with one player.
    """

    text: str
    player: int = 0


@dataclass(frozen=True)
class ReplaySpeed:
    """Play the replay slower (-1) or faster (+1), by one step."""

    step: int


@dataclass(frozen=True)
class ReplayPause:
    """Pause the replay, or continue it."""


@dataclass(frozen=True)
class ReplayJump:
    """Jump back or ahead in the replay.

    Attributes:
        seconds: The distance [s]; negative jumps back.
    """

    seconds: float


@dataclass(frozen=True)
class EndReplay:
    """Stop watching. The page from which the replay was opened, or the main menu, is open again."""


@dataclass(frozen=True)
class Attract:
    """Start the attract mode, in which a demo plays behind the menu, or end it."""

    on: bool


Command: TypeAlias = (
    Play
    | WatchLast
    | WatchScore
    | WatchDemo
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
