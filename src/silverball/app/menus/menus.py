"""How does a window work the menus? Buttons and time go in, dots and commands come out.

    menus = Menus(settings, tables, scores)            # the main menu is open
    menus.tick(seconds)                                # once a picture, by any clock that never goes back
    command = menus.press(Button.START)                # None, or something to do
    panel.draw(screen, menus.draw(seconds))

No clock, no window and no keyboard in here: the same presses at the same times show the same dots.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence

from silverball.app.bindings import ACTIONS, ActionLine, Kind
from silverball.app.demo_players import Performer
from silverball.app.menus import page as layout
from silverball.app.menus.attract import AttractPage
from silverball.app.menus.commands import Attract, Button, Command, EndReplay, Initials
from silverball.app.menus.desk import Desk, JoystickEntry, ScoreRow, TableEntry
from silverball.app.menus.entry import InitialsPage, LettersPage
from silverball.app.menus.front import main_page
from silverball.app.menus.game_pages import over_page, pause_page
from silverball.app.menus.remap import CapturePage
from silverball.app.menus.transport import ReplayFace, TransportPage
from silverball.app.settings import Settings
from silverball.drawing.dotmatrix.canvas import FULL, HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import NORMAL
from silverball.game.view import Mode

REPEAT_AFTER = 0.4  # [s] for which a paddle button is held before it counts again
REPEAT_EVERY = 0.09  # [s]
HURRY_AFTER, HURRY_EVERY = 4.0, 0.03  # [s] who holds it for so long has a long way to go
BACK_AFTER = 1.0  # [s] for which both paddle buttons are held to go back
IDLE = 30.0  # [s] without a button, after which the program plays by itself


class Menus:
    """All pages, worked with three buttons.

    Args:
        settings: As they are now.
        tables: All tables that can be chosen.
        scores: The best scores of a table and a mode, the best first. It is asked while pages are drawn,
            so it should answer from memory.
        actions: All actions that have keys.
        themes: Names of all themes.
    """

    def __init__(
        self,
        settings: Settings,
        tables: Sequence[TableEntry],
        scores: Callable[[str, Mode], Sequence[ScoreRow]],
        actions: Sequence[ActionLine] = ACTIONS,
        themes: Sequence[str] = ("neon",),
    ) -> None:
        self._desk = Desk(settings, tables, scores, actions, themes)
        self._down: dict[Button, float] = {}  # since when the paddle buttons are held
        self._next = 0.0  # when the button that is held counts again
        self._is_spent = False  # both were held: they do nothing more until they are released
        self._touched: float | None = None  # the last button, or the first tick of an opened page
        self.open_main()

    @property
    def settings(self) -> Settings:
        """The settings with all that was changed here."""
        return self._desk.settings

    @property
    def seed(self) -> int | None:
        """The seed that was chosen for random boards; None: another one for every game."""
        return self._desk.seed

    @property
    def is_open(self) -> bool:
        """Whether a page is shown; else the buttons are the game's."""
        return bool(self._desk.pages)

    @property
    def page(self) -> str:
        """The name of the page that is shown; empty if none is."""
        return self._desk.pages[-1].name if self._desk.pages else ""

    @property
    def wants_key(self) -> bool:
        """Whether the next key belongs to `capture`."""
        return self._wants("keys")

    @property
    def wants_pad(self) -> bool:
        """Whether the next button of a gamepad or joystick belongs to `capture`."""
        return self._wants("pad")

    @property
    def wants_text(self) -> bool:
        """Whether keys that bear letters are for `type`."""
        return bool(self._desk.pages) and isinstance(self._desk.pages[-1], LettersPage)

    @property
    def signature(self) -> Hashable:
        """What tells states apart in which buttons do different things."""
        return tuple((page.name, page.signature()) for page in self._desk.pages)

    def press(self, button: Button) -> Command | None:
        """A button went down."""
        desk = self._desk
        self._touched = desk.now
        if not desk.pages:
            return None
        if button in (Button.LEFT, Button.RIGHT):
            self._down[button] = desk.now
            self._next = desk.now + REPEAT_AFTER
        return self._pass_on(button)

    def release(self, button: Button) -> None:
        """A button came up."""
        self._down.pop(button, None)
        if not self._down:
            self._is_spent = False

    def release_all(self) -> None:
        """The window no longer hears the buttons."""
        self._down.clear()
        self._is_spent = False

    def capture(self, name: str, kind: Kind | None = None) -> Command | None:
        """The key or button that was asked for.

        Args:
            name: Its name.
            kind: Whose name that is; None: of what was asked for.
        """
        desk = self._desk
        self._touched = desk.now
        page = desk.pages[-1] if desk.pages else None
        return page.capture(desk, name, kind or page.kind) if isinstance(page, CapturePage) else None

    def type(self, written: str, key: str, *, is_button: bool) -> bool:
        """A key was pressed while a text is entered; whether it was meant for that.

        Args:
            written: What the key writes; empty if that is not known.
            key: The name of the key.
            is_button: Whether it is a button of the menus as well.
        """
        desk = self._desk
        page = desk.pages[-1] if desk.pages else None
        if not isinstance(page, LettersPage) or not page.type(written, key, desk, is_button=is_button):
            return False
        self._touched = desk.now
        return True

    def tick(self, seconds: float) -> Command | None:
        """Time has gone on: held buttons count again, and pages end by themselves.

        Args:
            seconds: By a clock that never goes back [s].
        """
        desk = self._desk
        desk.now = max(seconds, desk.now)
        if self._touched is None:
            self._touched = desk.now
        if not desk.pages:
            return None
        if self._down:
            self._touched = desk.now
        desk.idle = desk.now - self._touched
        page = desk.pages[-1]
        command = page.tick(desk)
        if command is not None or not desk.pages:
            return command
        if self._down:
            return self._held()
        if all(one.quiet for one in desk.pages) and desk.idle >= IDLE + page.extra_patience:
            return self.open_attract()
        return None

    def draw(self, seconds: float, below: Dots | None = None) -> Dots:
        """What is to be seen.

        Args:
            seconds: By the clock of `tick` [s].
            below: What the game shows; the line of a replay stands below it.
        """
        game = Dots() if below is None else below
        if not self._desk.pages:
            return game.copy()
        dots = self._desk.pages[-1].draw(self._desk, seconds, game)
        message, since = self._desk.message(seconds)
        if message:
            dots.box(0, layout.FOOT_Y - 1, WIDTH, HEIGHT - layout.FOOT_Y + 1, 0)
            light = layout.HALF if since < 0.6 and since % 0.2 < 0.1 else FULL  # it flashes to be noticed
            layout.marquee(dots, message, layout.FOOT_Y, 0, WIDTH, NORMAL, since, brightness=light)
        return dots

    def say(self, text: str) -> None:
        """Show a short message on the page that is open."""
        self._desk.say(text.upper())

    def open_main(self) -> None:
        """Show the main menu."""
        self._touched = None
        self._desk.close()
        self._desk.open(main_page(self._desk))

    def open_attract(self) -> Command:
        """Show the pages for those who only pass by; the main menu is below them."""
        self.open_main()
        self._desk.open(AttractPage())
        return Attract(True)

    def open_pause(self) -> None:
        """The game is paused."""
        self._touched = None
        self._desk.close()
        self._desk.open(pause_page(self._desk))

    def open_over(self, score: int, rank: int | None = None) -> None:
        """The game is over.

        Args:
            score: Its points.
            rank: Its place in the score table, from 1; None if it has none. With one, initials come first.
        """
        desk = self._desk
        desk.has_last_game = True
        self._touched = None
        desk.close()
        desk.open(over_page(desk, score))

        def done(text: str) -> Command:
            desk.back()
            desk.change(initials=text)
            return Initials(text)

        if rank is not None:
            desk.open(InitialsPage(score, rank, desk.settings.initials, done))

    def open_transport(self, face: ReplayFace) -> None:
        """A replay is shown."""
        self._touched = None
        self._desk.pages.clear()  # not closed: one comes back to the pages from which it was opened
        self._desk.open(TransportPage(face))

    def show_replay(self, face: ReplayFace) -> None:
        """Where the replay stands now."""
        page = self._desk.pages[-1] if self._desk.pages else None
        if isinstance(page, TransportPage):
            page.face = face

    def reopen(self) -> None:
        """Nothing more to watch: show the page from which it was opened, or the main menu."""
        self._touched = None
        if not self._desk.come_back():
            self.open_main()

    def close(self) -> None:
        """Show the game."""
        self._desk.close()

    def use(self, settings: Settings) -> None:
        """The settings were changed elsewhere, by a key for example."""
        self._desk.use(settings)

    def know(
        self,
        tables: Sequence[TableEntry] | None = None,
        last_seed: int | None = None,
        has_last_game: bool | None = None,
        performer: Performer | None = None,
        joysticks: Sequence[JoystickEntry] | None = None,
        labels: Mapping[str, str] | None = None,
    ) -> None:
        """Learn what has changed; what is None stays.

        Args:
            tables: All tables that can be chosen.
            last_seed: Of the board that is being played.
            has_last_game: Whether there is a last game to watch.
            performer: Who plays while the program plays by itself.
            joysticks: Those that are plugged in.
            labels: What stands on keys on the layout in use, by their names, where it is something else.
        """
        if tables is not None:
            self._desk.tables = tables
        if last_seed is not None:
            self._desk.last_seed = last_seed
        if has_last_game is not None:
            self._desk.has_last_game = has_last_game
        if performer is not None:
            self._desk.performer = performer
        if joysticks is not None:
            self._desk.joysticks = joysticks
        if labels is not None:
            self._desk.labels = labels

    def key(self, action: str) -> str:
        """The first key of an action as the display writes it."""
        return self._desk.key(action)

    def _wants(self, kind: str) -> bool:
        page = self._desk.pages[-1] if self._desk.pages else None
        return isinstance(page, CapturePage) and page.kind == kind

    def _pass_on(self, button: Button) -> Command | None:
        command = self._desk.pages[-1].press(button, self._desk)
        if isinstance(command, EndReplay):
            self.reopen()
        if not self._desk.pages:
            self.release_all()
        return command

    def _held(self) -> Command | None:
        """Both paddle buttons held go back once; one of them counts again and again."""
        now = self._desk.now
        if len(self._down) > 1:
            if not self._is_spent and now - max(self._down.values()) >= BACK_AFTER:
                self._is_spent = True
                return self._pass_on(Button.BACK)
            return None
        if self._is_spent or not self._desk.pages[-1].repeats or now < self._next:
            return None
        every = REPEAT_EVERY if now - max(self._down.values()) < HURRY_AFTER else HURRY_EVERY
        self._next = max(self._next + every, now)
        return self._pass_on(next(iter(self._down)))
