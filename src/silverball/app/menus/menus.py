"""How does a window work the menus? PaddleButtons and time go in, dots and commands come out.

    menus = Menus(settings, tables, scores)            # the main menu is open
    menus.tick(seconds)                                # once a picture, by any clock that never goes back
    command = menus.press(Button.START)                # None, or something to do
    panel.draw(screen, menus.draw(seconds))

No clock, no window and no keyboard in here: the same presses at the same times show the same dots.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence

from silverball.app.bindings import ACTIONS, ActionBinding, Kind
from silverball.app.demo_players import DemoPlayer
from silverball.app.menus import page_layout
from silverball.app.menus.attract import AttractPage
from silverball.app.menus.commands import Attract, Button, Command, EndReplay, Initials
from silverball.app.menus.context import JoystickEntry, MenuContext, ScoreRow, TableEntry
from silverball.app.menus.entry import InitialsPage, LettersPage
from silverball.app.menus.pages import main_page, over_page, pause_page
from silverball.app.menus.remap import CapturePage
from silverball.app.menus.transport import ReplayStatus, TransportPage
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
        actions: Sequence[ActionBinding] = ACTIONS,
        themes: Sequence[str] = ("neon",),
    ) -> None:
        self.context = MenuContext(settings, tables, scores, actions, themes)
        self._down: dict[Button, float] = {}  # since when the paddle buttons are held
        self._next = 0.0  # when the button that is held counts again
        self._is_spent = False  # both were held: they do nothing more until they are released
        self._touched: float | None = None  # the last button, or the first tick of an opened page
        self.open_main()

    @property
    def settings(self) -> Settings:
        """The settings with all that was changed here."""
        return self.context.settings

    @property
    def seed(self) -> int | None:
        """The seed that was chosen for random boards; None: another one for every game."""
        return self.context.seed

    @property
    def is_open(self) -> bool:
        """Whether a page is shown; else the buttons are the game's."""
        return bool(self.context.pages)

    @property
    def page(self) -> str:
        """The name of the page that is shown; empty if none is."""
        return self.context.pages[-1].name if self.context.pages else ""

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
        return bool(self.context.pages) and isinstance(self.context.pages[-1], LettersPage)

    @property
    def signature(self) -> Hashable:
        """What tells states apart in which buttons do different things."""
        return tuple((page.name, page.signature()) for page in self.context.pages)

    def press(self, button: Button) -> Command | None:
        """A button went down."""
        context = self.context
        self._touched = context.now
        if not context.pages:
            return None
        if button in (Button.LEFT, Button.RIGHT):
            self._down[button] = context.now
            self._next = context.now + REPEAT_AFTER
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
        context = self.context
        self._touched = context.now
        page = context.pages[-1] if context.pages else None
        return page.capture(context, name, kind or page.kind) if isinstance(page, CapturePage) else None

    def type(self, written: str, key: str, *, is_button: bool) -> bool:
        """A key was pressed while a text is entered; whether it was meant for that.

        Args:
            written: What the key writes; empty if that is not known.
            key: The name of the key.
            is_button: Whether it is a button of the menus as well.
        """
        context = self.context
        page = context.pages[-1] if context.pages else None
        if not isinstance(page, LettersPage) or not page.type(written, key, context, is_button=is_button):
            return False
        self._touched = context.now
        return True

    def tick(self, seconds: float) -> Command | None:
        """Time has gone on: held buttons count again, and pages end by themselves.

        Args:
            seconds: By a clock that never goes back [s].
        """
        context = self.context
        context.now = max(seconds, context.now)
        if self._touched is None:
            self._touched = context.now
        if not context.pages:
            return None
        if self._down:
            self._touched = context.now
        context.idle = context.now - self._touched
        page = context.pages[-1]
        command = page.tick(context)
        if command is not None or not context.pages:
            return command
        if self._down:
            return self._held()
        if all(one.quiet for one in context.pages) and context.idle >= IDLE + page.extra_patience:
            return self.open_attract()
        return None

    def draw(self, seconds: float, below: Dots | None = None) -> Dots:
        """What is to be seen.

        Args:
            seconds: By the clock of `tick` [s].
            below: What the game shows; the line of a replay stands below it.
        """
        game = Dots() if below is None else below
        if not self.context.pages:
            return game.copy()
        dots = self.context.pages[-1].draw(self.context, seconds, game)
        message, since = self.context.message(seconds)
        if message:
            dots.box(0, page_layout.FOOT_Y - 1, WIDTH, HEIGHT - page_layout.FOOT_Y + 1, 0)
            light = (
                page_layout.HALF if since < 0.6 and since % 0.2 < 0.1 else FULL
            )  # it flashes to be noticed
            page_layout.marquee(dots, message, page_layout.FOOT_Y, 0, WIDTH, NORMAL, since, brightness=light)
        return dots

    def say(self, text: str) -> None:
        """Show a short message on the page that is open."""
        self.context.say(text.upper())

    def open_main(self) -> None:
        """Show the main menu."""
        self._touched = None
        self.context.close()
        self.context.open(main_page(self.context))

    def open_attract(self) -> Command:
        """Show the pages for those who only pass by; the main menu is below them."""
        self.open_main()
        self.context.open(AttractPage())
        return Attract(True)

    def open_pause(self) -> None:
        """The game is paused."""
        self._touched = None
        self.context.close()
        self.context.open(pause_page(self.context))

    def open_over(self, score: int, rank: int | None = None) -> None:
        """The game is over.

        Args:
            score: Its points.
            rank: Its place in the score table, from 1; None if it has none. With one, initials come first.
        """
        context = self.context
        context.has_last_game = True
        self._touched = None
        context.close()
        context.open(over_page(context, score))

        def done(text: str) -> Command:
            context.back()
            context.change(initials=text)
            return Initials(text)

        if rank is not None:
            context.open(InitialsPage(score, rank, context.settings.initials, done))

    def open_transport(self, face: ReplayStatus) -> None:
        """A replay is shown."""
        self._touched = None
        self.context.pages.clear()  # not closed: one comes back to the pages from which it was opened
        self.context.open(TransportPage(face))

    def show_replay(self, face: ReplayStatus) -> None:
        """Where the replay stands now."""
        page = self.context.pages[-1] if self.context.pages else None
        if isinstance(page, TransportPage):
            page.face = face

    def reopen(self) -> None:
        """Nothing more to watch: show the page from which it was opened, or the main menu."""
        self._touched = None
        if not self.context.come_back():
            self.open_main()

    def close(self) -> None:
        """Show the game."""
        self.context.close()

    def use(self, settings: Settings) -> None:
        """The settings were changed elsewhere, by a key for example."""
        self.context.use(settings)

    def know(
        self,
        tables: Sequence[TableEntry] | None = None,
        last_seed: int | None = None,
        has_last_game: bool | None = None,
        demo_player: DemoPlayer | None = None,
        joysticks: Sequence[JoystickEntry] | None = None,
        labels: Mapping[str, str] | None = None,
    ) -> None:
        """Learn what has changed; what is None stays.

        Args:
            tables: All tables that can be chosen.
            last_seed: Of the board that is being played.
            has_last_game: Whether there is a last game to watch.
            demo_player: Who plays while the program plays by itself.
            joysticks: Those that are plugged in.
            labels: What stands on keys on the layout in use, by their names, where it is something else.
        """
        if tables is not None:
            self.context.tables = tables
        if last_seed is not None:
            self.context.last_seed = last_seed
        if has_last_game is not None:
            self.context.has_last_game = has_last_game
        if demo_player is not None:
            self.context.demo_player = demo_player
        if joysticks is not None:
            self.context.joysticks = joysticks
        if labels is not None:
            self.context.labels = labels

    def key(self, action: str) -> str:
        """The first key of an action as the display writes it."""
        return self.context.key(action)

    def _wants(self, kind: str) -> bool:
        page = self.context.pages[-1] if self.context.pages else None
        return isinstance(page, CapturePage) and page.kind == kind

    def _pass_on(self, button: Button) -> Command | None:
        command = self.context.pages[-1].press(button, self.context)
        if isinstance(command, EndReplay):
            self.reopen()
        if not self.context.pages:
            self.release_all()
        return command

    def _held(self) -> Command | None:
        """Both paddle buttons held go back once; one of them counts again and again."""
        now = self.context.now
        if len(self._down) > 1:
            if not self._is_spent and now - max(self._down.values()) >= BACK_AFTER:
                self._is_spent = True
                return self._pass_on(Button.BACK)
            return None
        if self._is_spent or not self.context.pages[-1].repeats or now < self._next:
            return None
        every = REPEAT_EVERY if now - max(self._down.values()) < HURRY_AFTER else HURRY_EVERY
        self._next = max(self._next + every, now)
        return self._pass_on(next(iter(self._down)))
