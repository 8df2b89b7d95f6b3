"""The game in a window: events in, ticks, picture out, until the player ends it.

A frame is: keys → as many ticks as real time asks for → the table → what is written on top → the screen.
"""

from __future__ import annotations

import secrets
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pygame

from silverball.app import overlay
from silverball.app.clock import TickClock
from silverball.app.controls import Action, Buttons, action_of, is_latin, meant, says_something
from silverball.app.framerate import FrameTimes
from silverball.app.keep import LAST_GAME, keep
from silverball.app.messages import Messages
from silverball.app.picture import Picture
from silverball.app.screen import Screen
from silverball.app.session import TICK_RATE, Session
from silverball.app.startup import Startup, compiling_words
from silverball.drawing import Moment, best_size
from silverball.errors import BoardFull, FaultError, NoRoom, SilverballError
from silverball.table import Table, generate_table, load_table

LOADING_FRAME_RATE = 20  # [1/s] while the physics is loaded, which needs the processor more
SEEDS = 1_000_000  # a new board's seed is below it: short enough to tell a friend


class Window:
    """A window to play in.

    Args:
        table: A table, a built-in name, or a path to a file. A recipe makes a new board for every seed.
        seed: Of the first board; None draws one.
        height: Of the window [pixel]; None: as high as fits the screen.
        without_display: Whether SDL's drivers that show nothing will do, as in tests.
        data_folder: Where the log of the last game goes; None: the user's data folder.
        on_compile: Called (from a thread) if the physics has to be compiled first.
        on_ready: Called when a game can begin.

    Raises:
        NoDisplay: There is no screen.
        TableError: The table has problems.
    """

    def __init__(
        self,
        table: Table | str = "random",
        seed: int | None = None,
        *,
        height: int | None = None,
        without_display: bool = False,
        data_folder: Path | None = None,
        on_compile: Callable[[], None] = lambda: None,
        on_ready: Callable[[], None] = lambda: None,
    ) -> None:
        self._recipe = load_table(table) if isinstance(table, str) else table
        self._screen = Screen("Silverball", without_display=without_display)
        self.seed = secrets.randbelow(SEEDS) if seed is None else seed
        self.table = self._finished()
        self._on_ready = on_ready
        self._startup: Startup | None = Startup(self.table, on_compile)
        self._screen.open(best_size(self.table.board, height or self._screen.first_height))
        self._picture = self._new_picture()
        self.session: Session | None = None
        self.messages = Messages()
        self._buttons = Buttons()
        self._clock = TickClock(TICK_RATE)
        self._frame_times = FrameTimes()
        self._data_folder = data_folder
        self._seconds = 0.0  # real time so far
        self._wants_ball = False  # Space was pressed before the physics was ready
        self.is_paused = self.shows_help = self.shows_frame_rate = self.is_over = False
        self._answers: dict[Action, Callable[[], None]] = {
            Action.CREATE: self._create_ball,
            Action.JITTER: self._jitter,
            Action.PAUSE: self._pause,
            Action.NEW_BOARD: self._new_board,
            Action.SAME_BOARD: self._same_board,
            Action.MUTE: lambda: self.messages.say("no sounds yet, so there is nothing to mute"),
            Action.HELP: self._help,
            Action.FRAME_RATE: self._show_frame_rate,
            Action.FULL_SCREEN: self._screen.toggle_full,
            Action.QUIT: self._go_back,
        }

    # --- the loop ---------------------------------------------------------------------------------

    def run(self, seconds: float | None = None) -> None:
        """Play until the player ends it, or for some seconds."""
        pacer = pygame.time.Clock()
        before = start = time.perf_counter()
        try:
            while not self.is_over and (seconds is None or before - start < seconds):
                now = time.perf_counter()
                self.frame(now - before)
                before = now
                pacer.tick(self._screen.frame_rate if self.is_ready else LOADING_FRAME_RATE)
        except Exception:
            self._keep_after_crash()
            raise
        finally:
            self.close()

    def frame(self, elapsed: float) -> None:
        """One frame, so many seconds after the one before."""
        self._seconds += elapsed
        self._frame_times.add(elapsed)
        self._begin_when_ready()
        for event in pygame.event.get():
            self._answer(event)
        self._play(elapsed)
        self.messages.pass_time(elapsed, in_play=self._is_playing and self._has_ball)
        self._draw()

    def close(self) -> None:
        """Keep the log of the last game and close the window."""
        self._keep_last_game()
        self.session = None
        self._picture.close()
        self._screen.close()

    # --- playing ----------------------------------------------------------------------------------

    @property
    def is_ready(self) -> bool:
        """Whether the physics is loaded and a game can be played."""
        return self.session is not None

    def _begin_when_ready(self) -> None:
        if self._startup is not None and self._startup.is_done:
            self._startup = None
            self.messages.clear()
            self.session = Session(self.table, self.seed)
            self._on_ready()
            if self._wants_ball:
                self._create_ball()
        elif self._startup is not None and self._startup.is_compiling and self.messages.strength < 1.0:
            self.messages.say(compiling_words())

    @property
    def _is_playing(self) -> bool:
        """Whether time goes on for the balls."""
        waits = self.is_paused or self.shows_help
        return self.session is not None and not waits and not self.session.world.fault

    @property
    def _has_ball(self) -> bool:
        return self.session is not None and bool(self.session.world.balls)

    def _play(self, elapsed: float) -> None:
        session = self.session
        if session is None or not self._is_playing:
            self._buttons.forget_taps()
            return
        ticks = self._clock.advance(elapsed)
        if ticks == 0:
            return
        try:
            session.advance(self._buttons.take(), ticks)
        except FaultError as error:
            self.messages.say(
                f"{error.fault}: this board had to stop. {self._keep_log('fault')} R makes a new one"
            )
        self._picture.note(session.take_events(), session.world.tick_rate)
        if session.has_still_ball and self.messages.strength < 1.0:  # it stays there, and is soon said again
            self.messages.say("the ball lies still: Z gives it a shove")

    def _draw(self) -> None:
        moment = Moment.before(self.table) if self.session is None else Moment.of(self.session.world)
        target = self._picture.draw(moment, self._screen.surface)
        scale, apron = self._picture.scale, self._picture.apron
        if self.shows_frame_rate:
            overlay.draw_frame_rate(target, apron, scale, self._frame_times, self.seed)
        if self.shows_help:
            overlay.draw_help(target, scale, self.seed)
        elif self.is_paused:
            overlay.draw_pause(target, scale)
        elif self.session is not None and not moment.balls:
            if self.session.world.created:
                overlay.draw_next_ball_hint(target, scale, self._seconds)
            else:
                overlay.draw_first_hint(target, scale)
        if self.messages.strength > 0.0:
            overlay.draw_message(target, apron, scale, self.messages.text, self.messages.strength)
        self._screen.flip()

    # --- answers to the player --------------------------------------------------------------------

    def _answer(self, event: pygame.Event) -> None:
        if event.type == pygame.KEYDOWN:
            self._answer_key(meant(event.key, event.scancode), event.key, event.mod)
        elif event.type == pygame.KEYUP:
            self._buttons.release(meant(event.key, event.scancode))
        elif event.type == pygame.WINDOWFOCUSLOST:
            self._buttons.release_all()
        elif event.type in (pygame.QUIT, pygame.WINDOWCLOSE):
            self._quit()

    def _answer_key(self, key: int, label: int, modifiers: int) -> None:
        action = action_of(key, modifiers)
        if action is Action.LEFT or action is Action.RIGHT:
            self._press(key, "left" if action is Action.LEFT else "right")
        elif action is not None:
            self._answers[action]()
        elif says_something(key) and not modifiers & (pygame.KMOD_CTRL | pygame.KMOD_ALT | pygame.KMOD_META):
            name = chr(label) if is_latin(label) else "this key"
            self.messages.say(f"{name} does nothing here; F1 shows the keys")

    def _press(self, key: int, side: str) -> None:
        self._buttons.press(key)
        if not self._is_playing:
            self._buttons.forget_taps()
        elif all(paddle.side != side for paddle in self.table.paddle):
            self.messages.say(f"this table has no {side} paddle")

    def _create_ball(self) -> None:
        self._wants_ball = self.session is None
        if session := self._session_in_play():
            try:
                session.create_ball()
            except BoardFull:
                count = session.world.table.board.max_balls
                self.messages.say("one ball is the most" if count == 1 else f"{count} balls are the most")
            except NoRoom:
                self.messages.say("there is no room for a ball now")

    def _jitter(self) -> None:
        if session := self._session_in_play():
            try:
                session.jitter()
            except SilverballError as reason:
                self.messages.say(str(reason))

    def _session_in_play(self) -> Session | None:
        """The session if it can take a ball or a shove now; otherwise the player is told why not."""
        if self.session is None:
            self.messages.say("one moment, please: the physics is being made ready")
        elif self.session.world.fault:
            self.messages.say("this board had to stop; R makes a new one")
        elif self.shows_help:
            self.messages.say("the game waits while the keys are shown; F1 goes on")
        elif self.is_paused:
            self.messages.say("the game is paused; P goes on")
        else:
            return self.session
        return None

    def _pause(self) -> None:
        if self.shows_help:
            self.messages.say("the game waits while the keys are shown; F1 goes on")
        else:
            self.is_paused = not self.is_paused
            self.messages.clear()  # it may tell of the state that has just ended

    def _help(self) -> None:
        self.shows_help = not self.shows_help
        self.messages.clear()

    def _show_frame_rate(self) -> None:
        self.shows_frame_rate = not self.shows_frame_rate

    def _go_back(self) -> None:
        """One step out: of the help, of the pause, of the full screen, and only then of the game."""
        if self.shows_help:
            self._help()
        elif self.is_paused:
            self._pause()
        elif self._screen.is_full:
            self._screen.toggle_full()
        else:
            self._quit()

    def _quit(self) -> None:
        self.is_over = True

    def _new_board(self) -> None:
        self._begin(secrets.randbelow(SEEDS))
        if self._recipe.random is None:
            self.messages.say(f"{self.table.name} is always the same table; the balls come at other places")
        else:
            self.messages.say(f"board {self.seed}. Shift+R plays it again")

    def _same_board(self) -> None:
        for shift in (pygame.K_LSHIFT, pygame.K_RSHIFT):  # it was meant for R, not for a paddle
            self._buttons.release(shift)
        self._begin(self.seed)
        self.messages.say(f"board {self.seed} from the start")

    def _begin(self, seed: int) -> None:
        """Begin another game."""
        self.seed = seed
        table = self._finished()
        if table != self.table:
            self.table = table
            self._picture.close()
            self._picture = self._new_picture()
        self._picture.renderer.effects.forget()
        self.is_paused = self.shows_help = False
        if self._startup is None:
            self._keep_last_game()
            self.session = Session(table, seed)

    def _finished(self) -> Table:
        return self._recipe if self._recipe.random is None else generate_table(self.seed, self._recipe)

    def _new_picture(self) -> Picture:
        board_seed = None if self._recipe.random is None else self.seed
        return Picture(self.table, self._screen.surface.get_size(), board_seed)

    # --- keeping logs -----------------------------------------------------------------------------

    def _keep_last_game(self) -> None:
        """Keep the log of the game that ends now, if anything was played."""
        if self.session is not None and self.session.world.created:
            keep(self.session.log.ended(self.session.world).to_text(), LAST_GAME, self._data_folder)

    def _keep_log(self, why: str) -> str:
        """Keep the log of a game that cannot go on, and say where."""
        assert self.session is not None
        name = time.strftime(f"{why}-%Y-%m-%d-%H%M%S.jsonl")
        path = keep(self.session.log.ended(self.session.world).to_text(), name, self._data_folder)
        return f"A log of it for a report is at {path}." if path else "Its log could not be written."

    def _keep_after_crash(self) -> None:
        if self.session is not None:
            print(f"silverball: the game ended unexpectedly. {self._keep_log('crash')}", file=sys.stderr)
