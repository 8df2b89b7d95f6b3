"""The menus as the window uses them: buttons and time in; dots and commands out.

    menus = Menus(settings, tables, scores)            # the main menu is open
    menus.tick(seconds)                                # once a frame, by any monotonic clock
    command = menus.press(Button.START)                # None, or a command to execute
    panel.draw(screen, menus.draw(seconds))

This module has no clock, window or keyboard: the same presses at the same times draw the same dots.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence

from silverball.app.bindings import ACTIONS, ActionBinding, DeviceKind
from silverball.app.menus import page_layout
from silverball.app.menus.attract import AttractPage
from silverball.app.menus.commands import Attract, Button, Command, EndReplay, Initials
from silverball.app.menus.context import MenuContext, ScoreRow, TableEntry
from silverball.app.menus.entry import InitialsPage, LettersPage
from silverball.app.menus.game_over import GameOver, Signing, over_page
from silverball.app.menus.listing import Listing
from silverball.app.menus.pages import main_page, pause_page
from silverball.app.menus.remap import CapturePage
from silverball.app.menus.transport import ReplayStatus, TransportPage
from silverball.app.settings import PlayerSettings
from silverball.drawing.dotmatrix.canvas import FULL, HEIGHT, WIDTH, Dots
from silverball.drawing.dotmatrix.fonts import NORMAL
from silverball.game.view import Mode

REPEAT_AFTER = 0.4  # [s] for which a paddle button is held before it repeats
REPEAT_EVERY = 0.09  # [s]
FAST_REPEAT_AFTER, FAST_REPEAT_EVERY = 4.0, 0.03  # [s] for long lists
BACK_AFTER = 1.0  # [s] for which both paddle buttons are held to go back
ATTRACT_AFTER = 30.0  # [s] without a button


class Menus:
    """All menu pages, operated with three buttons.

    Args:
        settings: The player's settings.
        tables: All tables to choose from.
        scores: Returns the scores of a table and a mode, best first. It is called while pages are drawn, so
            it must be fast.
        actions: All actions that have keys.
        themes: Names of all themes.

    Attributes:
        context: The state that all pages share.
    """

    def __init__(
        self,
        settings: PlayerSettings,
        tables: Sequence[TableEntry],
        scores: Callable[[str, Mode], Sequence[ScoreRow]],
        actions: Sequence[ActionBinding] = ACTIONS,
        themes: Sequence[str] = ("neon",),
    ) -> None:
        self.context = MenuContext(settings, tables, scores, actions, themes)
        self._down: dict[Button, float] = {}  # since when the paddle buttons are held
        self._next_repeat = 0.0
        self._is_spent = False  # both were held to go back, and are ignored until both are released
        self._active_at: float | None = None  # time of the last button, or of the first tick of a page
        self.open_main()

    @property
    def is_open(self) -> bool:
        """Whether a page is shown; otherwise the buttons belong to the game."""
        return bool(self.context.pages)

    @property
    def page(self) -> str:
        """The name of the visible page; empty if there is none."""
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
        """Whether keys with letters belong to `type`."""
        return bool(self.context.pages) and isinstance(self.context.pages[-1], LettersPage)

    @property
    def signature(self) -> Hashable:
        """A value that differs between states in which buttons do different things."""
        return tuple((page.name, page.signature()) for page in self.context.pages)

    def press(self, button: Button) -> Command | None:
        """Handle a button that went down."""
        context = self.context
        self._active_at = context.now
        if not context.pages:
            return None
        if button in (Button.LEFT, Button.RIGHT):
            self._down[button] = context.now
            self._next_repeat = context.now + REPEAT_AFTER
        return self._press_page(button)

    def release(self, button: Button) -> None:
        """Handle a button that came up."""
        self._down.pop(button, None)
        if not self._down:
            self._is_spent = False

    def release_all(self) -> None:
        """Release all buttons, because the window has lost the focus."""
        self._down.clear()
        self._is_spent = False

    def capture(self, name: str, kind: DeviceKind | None = None) -> Command | None:
        """Handle the key or button that the open page asked for.

        Args:
            name: Its name.
            kind: The kind of device that the name belongs to; None: the kind that the page asked for.
        """
        context = self.context
        self._active_at = context.now
        page = context.pages[-1] if context.pages else None
        return page.capture(context, name, kind or page.kind) if isinstance(page, CapturePage) else None

    def type(self, written: str, key: str, *, is_button: bool) -> bool:
        """Handle a key that was pressed while a text is entered; return whether the text used it.

        Args:
            written: The character that the key types; empty if unknown.
            key: The name of the key.
            is_button: Whether the key is also a button of the menus.
        """
        context = self.context
        page = context.pages[-1] if context.pages else None
        if not isinstance(page, LettersPage) or not page.type(written, key, context, is_button=is_button):
            return False
        self._active_at = context.now
        return True

    @property
    def listing(self) -> Listing | None:
        """The visible page as data; None if it is shown as dots only, or none is open."""
        return self.context.pages[-1].listing(self.context) if self.context.pages else None

    def point(self, index: int) -> bool:
        """Select the row of the listing under the mouse pointer; return whether another one was selected."""
        self._active_at = self.context.now
        return bool(self.context.pages) and self.context.pages[-1].point(index, self.context)

    def click(self, index: int, step: int = 1) -> Command | None:
        """Handle a click on a row of the listing; a setting takes a step of −1 or +1."""
        self._active_at = self.context.now
        if not self.context.pages:
            return None
        return self._ended(self.context.pages[-1].click(index, self.context, step))

    def adjust(self, step: int) -> bool:
        """Change the setting of the selected row by a step; return whether it is one."""
        listing = self.listing
        if listing is None or listing.chosen < 0 or not listing.rows[listing.chosen].is_value:
            return False
        self.click(listing.chosen, step)
        return True

    def tick(self, seconds: float) -> Command | None:
        """Repeat held buttons, let pages time out, and begin the attract mode after some idle time.

        Args:
            seconds: Time of a monotonic clock [s].
        """
        context = self.context
        context.now = max(seconds, context.now)
        if self._active_at is None:
            self._active_at = context.now
        if not context.pages:
            return None
        if self._down:
            self._active_at = context.now
        context.idle = context.now - self._active_at
        page = context.pages[-1]
        command = page.tick(context)
        if command is not None or not context.pages:
            return command
        if self._down:
            return self._repeat_held()
        if (
            all(one.allows_attract for one in context.pages)
            and context.idle >= ATTRACT_AFTER + page.extra_idle_time
        ):
            return self.open_attract()
        return None

    def draw(self, seconds: float, below: Dots | None = None) -> Dots:
        """Draw the visible page.

        Args:
            seconds: Time of the clock of `tick` [s].
            below: The display of the game; the transport line of a replay is drawn below it.
        """
        game = Dots() if below is None else below
        if not self.context.pages:
            return game.copy()
        dots = self.context.pages[-1].draw(self.context, seconds, game)
        message, since = self.context.message(seconds)
        if message:
            dots.box(0, page_layout.FOOT_Y - 1, WIDTH, HEIGHT - page_layout.FOOT_Y + 1, 0)
            light = page_layout.HALF if since < 0.6 and since % 0.2 < 0.1 else FULL  # flashes at first
            page_layout.marquee(dots, message, page_layout.FOOT_Y, 0, WIDTH, NORMAL, since, brightness=light)
        return dots

    def show_message(self, text: str) -> None:
        """Show a short message on the open page."""
        self.context.show_message(text.upper())

    def open_main(self) -> None:
        """Show the main menu."""
        self._active_at = None
        self.context.close()
        self.context.open(main_page(self.context))

    def open_attract(self) -> Command:
        """Show the pages of the attract mode, with the main menu below them."""
        self.open_main()
        self.context.open(AttractPage())
        return Attract(True)

    def open_pause(self) -> None:
        """Show the pause page."""
        self._active_at = None
        self.context.close()
        self.context.open(pause_page(self.context))

    def open_over(self, score: int, rank: int | None = None, what: GameOver | None = None) -> None:
        """Show the page after a game.

        Args:
            score: Its points.
            rank: Its rank in the high scores, from 1, which asks for initials first; None without a rank.
            what: What the game came to; its `signings` take the place of `rank`.
        """
        context = self.context
        context.has_last_game = True
        self._active_at = None
        context.close()
        what = what or GameOver(signings=() if rank is None else (Signing(score, rank),))
        context.open(over_page(context, score, what))
        for signing in reversed(what.signings):
            context.open(self._initials_page(signing))

    def _initials_page(self, signing: Signing) -> InitialsPage:
        context, settings = self.context, self.context.settings

        def done(text: str) -> Command:
            context.back()
            settings.change(initials=text)
            return Initials(text, signing.player)

        return InitialsPage(signing.score, signing.rank, settings.current.initials, done, signing.player)

    def open_transport(self, status: ReplayStatus) -> None:
        """Show the transport line of a replay."""
        self._active_at = None
        self.context.pages.clear()  # not close(): the suspended pages return after the replay
        self.context.open(TransportPage(status))

    def update_replay(self, status: ReplayStatus) -> None:
        """Update the transport line with the state of the replay."""
        page = self.context.pages[-1] if self.context.pages else None
        if isinstance(page, TransportPage):
            page.status = status

    def reopen(self) -> None:
        """Show the pages that a replay or a demo has hidden, or the main menu."""
        self._active_at = None
        if not self.context.resume():
            self.open_main()

    def close(self) -> None:
        """Close all pages."""
        self.context.close()

    def _wants(self, kind: str) -> bool:
        page = self.context.pages[-1] if self.context.pages else None
        return isinstance(page, CapturePage) and page.kind == kind

    def _press_page(self, button: Button) -> Command | None:
        return self._ended(self.context.pages[-1].press(button, self.context))

    def _ended(self, command: Command | None) -> Command | None:
        """Pass on a command; the pages below a replay come back, and closed pages hold no button."""
        if isinstance(command, EndReplay):
            self.reopen()
        if not self.context.pages:
            self.release_all()
        return command

    def _repeat_held(self) -> Command | None:
        """Go back once if both paddle buttons are held; repeat a single one."""
        now = self.context.now
        if len(self._down) > 1:
            if not self._is_spent and now - max(self._down.values()) >= BACK_AFTER:
                self._is_spent = True
                return self._press_page(Button.BACK)
            return None
        if self._is_spent or not self.context.pages[-1].repeats or now < self._next_repeat:
            return None
        every = REPEAT_EVERY if now - max(self._down.values()) < FAST_REPEAT_AFTER else FAST_REPEAT_EVERY
        self._next_repeat = max(self._next_repeat + every, now)
        return self._press_page(next(iter(self._down)))
