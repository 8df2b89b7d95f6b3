"""Shared state of all menu pages: settings, tables, scores, time, and the stack of open pages."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import NamedTuple

from silverball.app.bindings import ActionBinding, display_name, keys_for
from silverball.app.demo_players import DemoPlayer
from silverball.app.menus import page_layout
from silverball.app.menus.commands import Button, Command
from silverball.app.menus.listing import Listing
from silverball.app.settings import PlayerSettings
from silverball.drawing.dotmatrix.canvas import Dots
from silverball.drawing.dotmatrix.fonts import NORMAL
from silverball.game.view import Mode

MIN_MESSAGE_TIME = 2.5  # [s]


class TableEntry(NamedTuple):
    """A table in the list of tables.

    Attributes:
        name: A built-in name or a path, as in the settings.
        title: Its displayed name.
        description: A short description.
        is_random: Whether it makes a different board for every seed.
        problem: Why it cannot be played; empty if it can.
    """

    name: str
    title: str
    description: str = ""
    is_random: bool = False
    problem: str = ""


class ScoreRow(NamedTuple):
    """A row of a high-score list.

    Attributes:
        initials: Initials of the player.
        score: Points.
        date: The displayed date.
        key: Identifier of its replay for `WatchScore`; empty if there is no replay.
    """

    initials: str
    score: int
    date: str = ""
    key: str = ""


class Standing(NamedTuple):
    """How the player stands on a table.

    Attributes:
        title: The name of the table.
        medal: The best medal that was won; empty if there is none.
        goal: What takes the next medal, as a text; empty if there is nothing to win.
        rank: The missions finished in all games on it.
    """

    title: str
    medal: str = ""
    goal: str = ""
    rank: int = 0


class Challenges(NamedTuple):
    """What can be challenged on the chosen table.

    Attributes:
        day: The date of today as text; empty if there is no daily board.
        seed: The seed of today.
        today: The scores of today's board, best first.
        best: The best score of the table that has a replay; None if there is none.
        standings: The medals and ranks of all tables that have any.
    """

    day: str = ""
    seed: int = 0
    today: Sequence[ScoreRow] = ()
    best: ScoreRow | None = None
    standings: Sequence[Standing] = ()


class JoystickEntry(NamedTuple):
    """A connected joystick.

    Attributes:
        guid: Identifier of its model; the settings store its bindings under it.
        title: Its displayed name.
        buttons: Its number of buttons.
    """

    guid: str
    title: str
    buttons: int


class Page(ABC):
    """A menu page: it handles buttons and draws itself."""

    name = "page"
    repeats = True
    """Whether a held paddle button repeats."""
    allows_attract = True
    """Whether the attract mode may begin on this page, and on pages opened from it, after some idle time."""
    extra_idle_time = 0.0
    """Extra idle time before that [s], on top of what other pages allow."""
    shown_at = 0.0
    """Time [s] at which the page reached its current state; texts begin to scroll then."""

    @abstractmethod
    def press(self, button: Button, context: MenuContext) -> Command | None:
        """Handle a button."""

    @abstractmethod
    def draw(self, context: MenuContext, seconds: float, below: Dots) -> Dots:
        """Draw the page at a time of the clock of `context.now`; `below` is the display of the game."""

    def listing(self, context: MenuContext) -> Listing | None:
        """Return the page as data, for a list; None if it is shown as dots only."""
        return None

    def point(self, index: int, context: MenuContext) -> bool:
        """Select the row of the listing under the mouse pointer; return whether another one was selected."""
        return False

    def click(self, index: int, context: MenuContext, step: int) -> Command | None:
        """Handle a click on a row of the listing; a setting takes a step of −1 or +1."""
        return None

    def tick(self, context: MenuContext) -> Command | None:
        """Handle the passing of time."""
        return None

    def signature(self) -> Hashable:
        """Return a value that differs between states in which buttons do different things."""
        return ()


class MenuContext:
    """The shared state of all pages.

    Attributes:
        settings: The player's settings.
        tables: All tables to choose from.
        scores: The scores of a table and a mode, best first.
        actions: All actions that have keys.
        themes: Names of all themes.
        challenges: Returns what can be challenged on the chosen table.
        seed: Seed of the next random board; None draws one.
        last_seed: Seed of the random board shown last; None if there was none.
        has_last_game: Whether there is a last game to watch.
        demo_player: Who plays the demo; None before the first demo.
        joysticks: The connected joysticks.
        key_labels: Labels of keys on the current layout, by key name, where they differ from the name.
        now: The time of the last tick [s].
        idle: Time without a button up to `now` [s].
        pages: The open pages, the visible one last; none while a game is running.
    """

    def __init__(
        self,
        settings: PlayerSettings,
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
        self.challenges: Callable[[], Challenges] = Challenges
        self.seed: int | None = None
        self.last_seed: int | None = None
        self.has_last_game = False
        self.demo_player: DemoPlayer | None = None
        self.joysticks: Sequence[JoystickEntry] = ()
        self.key_labels: Mapping[str, str] = {}
        self.now = self.idle = 0.0
        self.pages: list[Page] = []
        self._message = ("", 0.0)
        self._suspended: list[Page] = []  # the pages that were open when a replay began

    @property
    def table(self) -> TableEntry:
        """The chosen table; one whose file has disappeared stays chosen under its name."""
        name = self.settings.current.table
        return next((entry for entry in self.tables if entry.name == name), TableEntry(name, name))

    @property
    def mode(self) -> Mode:
        """The chosen mode."""
        return Mode(self.settings.current.mode)

    @property
    def score_lists(self) -> list[tuple[TableEntry, Mode, Sequence[ScoreRow]]]:
        """All score lists that are not empty, the one of the chosen table and mode first."""
        settings = self.settings.current
        lists = [
            (entry, mode, rows)
            for entry in self.tables
            for mode in (Mode.ARCADE, Mode.FREE)
            if (rows := self.scores(entry.name, mode))
        ]
        lists.sort(key=lambda item: (item[0].name, item[1]) != (settings.table, settings.mode))
        return lists

    def open(self, page: Page) -> None:
        """Show a page on top of the others."""
        page.shown_at = self.now
        self.pages.append(page)

    def back(self) -> None:
        """Show the page below; the bottom page stays."""
        if len(self.pages) > 1:
            self.pages.pop()
            self.pages[-1].shown_at = self.now

    def close(self) -> None:
        """Close all pages."""
        self.pages.clear()
        self._suspended.clear()

    def suspend(self) -> None:
        """Hide all pages while a replay or a demo is shown."""
        self._suspended = self.pages.copy()
        self.pages.clear()

    def resume(self) -> bool:
        """Show the suspended pages again; return whether there were any."""
        self.pages, self._suspended = self._suspended, []
        return bool(self.pages)

    def show_message(self, text: str) -> None:
        """Show a message on the open page, whichever it is."""
        self._message = (text, self.now)

    def message(self, seconds: float) -> tuple[str, float]:
        """Return the message at a time and for how long it has been shown [s]; empty if there is none."""
        text, since = self._message
        length = max(MIN_MESSAGE_TIME, page_layout.scroll_time(NORMAL.width(text)))
        return (text, seconds - since) if since <= seconds < since + length else ("", 0.0)

    def key_label(self, action: str) -> str:
        """Return the first key of an action as the display writes it; "?" if it has none."""
        for binding in self.actions:
            if binding.action == action and (keys := keys_for(self.settings.current, binding)):
                return self.button_label(keys[0])
        return "?"

    def button_label(self, name: str) -> str:
        """Return a key or button as the display writes it."""
        return display_name(name, self.key_labels)
