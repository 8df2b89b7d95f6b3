"""What do all pages share? The settings, the tables, the scores, the time, and the stack of open pages."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Any, NamedTuple

from silverball.app.bindings import ActionBinding, keys_for, shown
from silverball.app.demo_players import DemoPlayer
from silverball.app.menus import page_layout
from silverball.app.menus.commands import Button, Change, Command
from silverball.app.settings import Settings
from silverball.drawing.dotmatrix.canvas import Dots
from silverball.drawing.dotmatrix.fonts import NORMAL
from silverball.game.view import Mode

MESSAGE_TIME = 2.5  # [s] for which a message is shown at least


class TableEntry(NamedTuple):
    """A table that can be chosen.

    Attributes:
        name: As in the settings: a built-in name or a path.
        title: What the player reads.
        about: A few words more.
        is_random: Whether every seed makes another board of it.
        problem: Why it cannot be played; empty if it can.
    """

    name: str
    title: str
    about: str = ""
    is_random: bool = False
    problem: str = ""


class ScoreRow(NamedTuple):
    """One line of a score table.

    Attributes:
        initials: Whose it is.
        score: Points.
        date: As it is to be read.
        key: What names it for `WatchScore`; empty if its game was not kept.
    """

    initials: str
    score: int
    date: str = ""
    key: str = ""


class JoystickEntry(NamedTuple):
    """A joystick that is plugged in.

    Attributes:
        guid: What its maker tells it by; its buttons are kept under it.
        title: What the player reads.
        buttons: How many it has.
    """

    guid: str
    title: str
    buttons: int


class Page(ABC):
    """One page: it answers buttons and draws itself."""

    name = "page"
    repeats = True
    """Whether a paddle button that is held counts again and again."""
    quiet = True
    """Whether the program may begin to play by itself when nobody touches anything; where not, then neither
    on the pages that are opened from here."""
    extra_patience = 0.0
    """How much longer than elsewhere that takes [s]."""
    shown_at = 0.0
    """Since when it is shown as it is [s]: texts begin to scroll then."""

    @abstractmethod
    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Answer a button."""

    @abstractmethod
    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """The page at a time, the clock being that of `context.now`; `below` is what the game shows."""

    def tick(self, context: MenuContext) -> Command | None:
        """Time has gone on."""
        return None

    def signature(self) -> Hashable:
        """What tells states of this page apart in which buttons do different things."""
        return ()


class MenuContext:
    """The shared state of all pages.

    Attributes:
        settings: As they are now.
        tables: All tables that can be chosen.
        scores: The best scores of a table and a mode, the best first.
        actions: All actions that have keys.
        themes: Names of all themes.
        seed: Of the next random board; None for a new one.
        last_seed: Of the board that was played last; None if there was none.
        has_last_game: Whether there is a last game to watch.
        demo_player: Who plays while the program plays by itself; None if it has not done so yet.
        joysticks: Those that are plugged in.
        labels: What stands on keys on the layout in use, by their names, where it is something else.
        now: The time of the last tick [s].
        idle: How long nobody has touched anything by then [s].
        pages: The open pages, the visible one last; none while the game runs.
    """

    def __init__(
        self,
        settings: Settings,
        tables: Sequence[TableEntry],
        scores: Callable[[str, Mode], Sequence[ScoreRow]],
        actions: Sequence[ActionBinding],
        themes: Sequence[str],
    ) -> None:
        self.settings = settings
        self.tables = tables
        self.scores = scores
        self.actions = actions
        self.themes = themes
        self.seed: int | None = None
        self.last_seed: int | None = None
        self.has_last_game = False
        self.demo_player: DemoPlayer | None = None
        self.joysticks: Sequence[JoystickEntry] = ()
        self.labels: Mapping[str, str] = {}
        self.now = self.idle = 0.0
        self.pages: list[Page] = []
        self._message = ("", 0.0)
        self._left: list[Page] = []  # the pages that were open when a replay began

    def open(self, page: Page) -> None:
        """Show a page on top of the others."""
        page.shown_at = self.now
        self.pages.append(page)

    def back(self) -> None:
        """Show the page below; the lowest one stays."""
        if len(self.pages) > 1:
            self.pages.pop()
            self.pages[-1].shown_at = self.now

    def close(self) -> None:
        """Show the game."""
        self.pages.clear()
        self._left.clear()

    def leave(self) -> None:
        """Show a replay, and come back to these pages after it."""
        self._left = self.pages.copy()
        self.pages.clear()

    def come_back(self) -> bool:
        """Show the pages again that a replay has hidden; False if there were none."""
        self.pages, self._left = self._left, []
        return bool(self.pages)

    def change(self, **values: Any) -> Change:
        """Change some settings."""
        return self.use(self.settings.changed(**values))

    def use(self, settings: Settings) -> Change:
        """Change the settings."""
        self.settings = settings
        return Change(settings)

    def say(self, text: str) -> None:
        """Show a message on whatever page is open."""
        self._message = (text, self.now)

    def message(self, seconds: float) -> tuple[str, float]:
        """What is to be said at a time, and for how long it has been said [s]; empty if nothing."""
        text, since = self._message
        length = max(MESSAGE_TIME, page_layout.scroll_time(NORMAL.width(text)))
        return (text, seconds - since) if since <= seconds < since + length else ("", 0.0)

    def table(self) -> TableEntry:
        """The chosen table; one that is no longer there keeps its name: nothing is chosen in secret."""
        name = self.settings.table
        return next((entry for entry in self.tables if entry.name == name), TableEntry(name, name))

    def mode(self) -> Mode:
        """The chosen game."""
        return Mode(self.settings.mode)

    def key(self, action: str) -> str:
        """The first key of an action as the display writes it."""
        for line in self.actions:
            if line.action == action and keys_for(self.settings, line):
                return self.shown(keys_for(self.settings, line)[0])
        return "?"

    def shown(self, name: str) -> str:
        """A key or button as the display writes it."""
        return shown(name, self.labels)

    def boards(self) -> list[tuple[TableEntry, Mode, Sequence[ScoreRow]]]:
        """All score tables that have scores, that of the chosen table and game first."""
        found = [
            (entry, mode, rows)
            for entry in self.tables
            for mode in (Mode.ARCADE, Mode.FREE)
            if (rows := self.scores(entry.name, mode))
        ]
        found.sort(key=lambda board: (board[0].name, board[1]) != (self.settings.table, self.settings.mode))
        return found
