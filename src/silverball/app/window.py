"""The game in a window: buttons in; ticks, picture and sounds out.

An *input poll* handles the events and runs the ticks that are due in real time. A *frame* polls, draws the
table and the text on top, and shows the result. Between two frames the window polls a thousand times a
second, so that a button reaches the simulation within a tick and not only with the next frame.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pygame

from silverball.app import overlay
from silverball.app.arrangement import opening_size
from silverball.app.backglass.backglass import Backglass, places
from silverball.app.backglass.content import ContentReader
from silverball.app.bindings import upper_label
from silverball.app.cabinet_mode import CabinetMode
from silverball.app.catalog import Catalog
from silverball.app.controls import Action
from silverball.app.debug import DebugView
from silverball.app.ghost_balls import draw_ghost_balls
from silverball.app.input_handler import InputHandler
from silverball.app.overlay import Help, Messages
from silverball.app.picture import Picture
from silverball.app.player_warmup import PlayerWarmup
from silverball.app.program import Program
from silverball.app.screen import Screen
from silverball.app.sessions import GameSession
from silverball.app.settings import Settings
from silverball.app.sound import Sounds
from silverball.app.sound.mixdown import rolling_balls
from silverball.app.sound.part_sounds import PartSound, sounds_of_parts
from silverball.app.startup import Startup, compiling_message
from silverball.app.timing import FrameTimes, LatencyMeter, TickClock
from silverball.drawing import Moment, best_size
from silverball.drawing.light_shows import Running
from silverball.drawing.themes import THEMES
from silverball.errors import SilverballError, TableError
from silverball.game.scores.store import Store
from silverball.game.user_folder import data_folder
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.app.sessions import Session
    from silverball.drawing.dotmatrix.canvas import Dots
    from silverball.game.replay.format import Replay

TICK_RATE = 240
LOADING_FRAME_RATE = 20  # [1/s] while the physics is loaded, which needs the processor
DOT_GAME_FRAME_RATE = 25  # [1/s] while the game on the dots is played meanwhile
POLL_INTERVAL = 0.001  # [s]
PAGE_SOUNDS = {"initials": "high_score", "attract": "attract"}
RUMBLE_SPEED = 12.0  # [u/s] of an impact that rumbles at full strength
RUMBLE_SECONDS = 0.08
_REDRAWN_AFTER = (
    pygame.WINDOWEXPOSED,
    pygame.WINDOWSHOWN,
    pygame.WINDOWSIZECHANGED,
    pygame.WINDOWRESTORED,
    pygame.WINDOWDISPLAYCHANGED,
)
"""Events after which the window may show something else than what was drawn."""


class Window:
    """A window to play in.

    Args:
        table: A table, a built-in name, or a path to a file; None: the one chosen last. A table with random
            parts makes a new board for every seed.
        seed: Seed of the first board; None draws one.
        mode: Begin a game of this mode; None: begin in the menu.
        replay: Begin with this replay.
        height: Height of a window that is as wide as the table [pixel].
        size: Width and height of the picture [pixel]; None: by the height, or as large as fits the screen.
        cabinet: How the picture stands on the screen; None: as chosen last.
        without_display: Whether SDL drivers without output are accepted, as in tests.
        folder: Folder of scores, settings and replays; None: the user's data folder.
        on_compile: Called (from a thread) if the physics must be compiled first.
        on_ready: Called when a game can begin.

    Raises:
        NoDisplay: There is no display.
        TableError: The table has problems.
    """

    def __init__(
        self,
        table: Table | str | None = None,
        seed: int | None = None,
        *,
        mode: Mode | None = None,
        replay: Replay | None = None,
        height: int | None = None,
        size: tuple[int, int] | None = None,
        cabinet: CabinetMode | None = None,
        without_display: bool = False,
        folder: Path | None = None,
        on_compile: Callable[[], None] = lambda: None,
        on_ready: Callable[[], None] = lambda: None,
    ) -> None:
        self._folder = folder or data_folder()
        self.messages = Messages()
        self.store = Store(self._folder, nonblocking=True)
        try:
            self.program = self._new_program(table, seed, mode, cabinet)
            stands = self.program.settings.current.cabinet
            self._screen = Screen("Silverball", stands, without_display=without_display)
        except SilverballError:
            self.store.close()
            raise
        settings = self.program.settings.current
        self._on_ready = on_ready
        self._startup: Startup | None = Startup(self.program.board.table, on_compile)
        self.player_warmup: PlayerWarmup | None = None
        board = self.program.board.table.board
        if size is None:
            room = self._screen.max_initial_size
            size = best_size(board, height) if height else opening_size(board, room)
        self._screen.open(size)
        if settings.full_screen:
            self._screen.toggle_fullscreen()
        self._picture = Picture(self._screen.surface.get_size(), self._screen.second_size)
        self._backglass = Backglass()
        self._surroundings = Backglass()  # of the table, while the backglass is on a second screen
        self._content = ContentReader(self.program)
        self.sounds = Sounds(settings)
        self.sounds.open()
        self._clock = TickClock(TICK_RATE)
        self._frame_times = FrameTimes()
        self.latency = LatencyMeter()
        self.debug = DebugView()
        self.input_handler = InputHandler(
            self.program, self._screen, self.sounds, self.messages, self.latency, self._backglass.list_view
        )
        self.program.settings.subscribe(self._apply_settings)
        self._session: Session | None = None
        self._before: Moment | None = None  # the moment one tick earlier, for interpolation
        self._parts: dict[str, PartSound] = {}  # of the session's table, by path in events
        self._seconds = self._drawn_at = 0.0  # [s] real time at the last poll, and at the last frame
        self._moved_at = 0.0  # [s] real time at the last frame before the session ended
        for warning in filter(None, (self.store.warning, self.sounds.warning)):
            self.messages.show(warning)
        if replay is not None:
            self.program.watch(replay)
        elif mode is not None:
            self.program.play(mode, settings.table, self.program.board.seed)

    def _new_program(
        self, table: Table | str | None, seed: int | None, mode: Mode | None, cabinet: CabinetMode | None
    ) -> Program:
        """Create the program on a table, or on the default one if the stored table no longer exists."""
        settings = Settings.of(self.store.settings())
        given = {}  # tables made in Python, by name
        if table is not None:
            name = table if isinstance(table, str) else table.name
            given = {} if isinstance(table, str) else {name: table}
            # Without a mode, the player chooses one in the menu; it should be played on this table.
            modes = (Mode.ARCADE, Mode.FREE) if mode is None else (mode,)
            settings = settings.changed(**{f"{each}_table": name for each in modes})
        if mode is not None:
            settings = settings.changed(mode=mode)
        if cabinet is not None:
            settings = settings.changed(cabinet=cabinet)
        catalog = Catalog(self.store, self._folder, given)
        try:
            return Program(self.store, settings, catalog, seed, self.messages.show, tuple(THEMES))
        except TableError as error:
            if table is not None:
                raise
            self.messages.show(str(error))
            settings = settings.changed(table=Settings(mode=settings.mode).table)
            return Program(self.store, settings, catalog, seed, self.messages.show, tuple(THEMES))

    # --- the loop ---------------------------------------------------------------------------------

    def run(self, seconds: float | None = None) -> None:
        """Run until the player quits, or for `seconds` of real time [s]."""
        before = start = time.perf_counter()
        try:
            while not self.is_over and (seconds is None or before - start < seconds):
                due = time.perf_counter() + 1.0 / self.frame_rate
                before = self.poll_until(due, self.render_frame(before))
        except Exception:
            self._save_crash_replay()
            raise
        finally:
            self.close()

    def poll_input(self, elapsed: float) -> None:
        """Handle events and advance the session by the real time [s] since the last poll."""
        self._seconds += elapsed
        self._finish_startup()
        for event in pygame.event.get():
            if event.type in _REDRAWN_AFTER:
                self._redraw_all()
            self.input_handler.handle(event)
        self._advance_session(elapsed)

    def frame(self, elapsed: float) -> None:
        """Poll, draw and show; `elapsed` is the real time [s] since the last poll."""
        self.poll_input(elapsed)
        self.draw()
        self.show()

    def render_frame(self, before: float) -> float:
        """Render a frame in real time; buttons are polled before it is drawn and before it is shown.

        Args:
            before: Time of the last poll, by `time.perf_counter` [s].

        Returns:
            The new time of the last poll.
        """
        before = self._poll_since(before)
        self.draw()
        before = self._poll_since(before)
        self.show()
        return before

    def draw(self) -> None:
        """Draw the current moment and play its sounds."""
        elapsed, self._drawn_at = self._seconds - self._drawn_at, self._seconds
        page = self.program.menus.page
        self.program.update(self._seconds)
        if self.program.menus.page != page and self.program.menus.page in PAGE_SOUNDS:
            self.sounds.play_menu(PAGE_SOUNDS[self.program.menus.page])
            self.input_handler.shows_help = False  # it must not cover the attract mode or the initials
        self._frame_times.add(self._seconds)
        is_in_play = self.program.is_playing and bool(self._session and self._session.game.world.balls)
        self.messages.update(elapsed, in_play=is_in_play)
        self._screen.update(elapsed, is_paused=self.program.is_paused)
        self._update_sounds(elapsed)
        self._draw()
        self.latency.record_draw()

    def show(self) -> None:
        """Show the drawn frame on screen."""
        self._screen.flip()
        self.latency.record_flip()

    def close(self) -> None:
        """Save the current game and close the window."""
        self.program.games.save_last_game()
        self.program.keep_best_of_dots()
        self.program.session = self._session = None
        self._picture.close()
        if self.player_warmup is not None:
            self.player_warmup.close()
        self.sounds.close()
        self.input_handler.close()
        self._screen.close()
        if not self.store.is_spooled:
            print(f"waiting for another program that has locked {self.store.path} …", file=sys.stderr)
        self.store.close()
        if self.store.exit_warning:
            print(plain(self.store.exit_warning), file=sys.stderr)

    @property
    def is_over(self) -> bool:
        """Whether the player has quit."""
        return self.program.should_quit

    @property
    def is_ready(self) -> bool:
        """Whether the physics is loaded and a game can be played."""
        return self.program.is_ready

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture [pixel]."""
        return self._screen.surface.get_size()

    @property
    def is_sharp(self) -> bool:
        """Whether the picture has its full quality."""
        return self._picture.is_sharp

    @property
    def frame_rate(self) -> int:
        """The target number of frames per second."""
        if not self.is_ready:
            is_played = self.program.is_compiling_for_game and self.program.dot_game.is_begun
            return DOT_GAME_FRAME_RATE if is_played else LOADING_FRAME_RATE
        rate = self.program.settings.current.frame_rate
        return self._screen.refresh_rate if rate == "screen" else int(rate)

    def poll_until(self, due: float, before: float) -> float:
        """Poll repeatedly until the next frame is due.

        Args:
            due: Time of the frame, by `time.perf_counter` [s].
            before: Time of the last poll.

        Returns:
            The new time of the last poll.
        """
        while not self.is_over:
            before = self._poll_since(before)
            left = due - time.perf_counter()
            if left <= 0.0:
                break
            time.sleep(min(POLL_INTERVAL, left) if self.is_ready else left)
        return before

    def _poll_since(self, before: float) -> float:
        """Poll, given the time of the last poll; return the time now."""
        now = time.perf_counter()
        self.poll_input(now - before)
        return now

    # --- playing ----------------------------------------------------------------------------------

    def _finish_startup(self) -> None:
        if self._startup is None and self.program.loading.waiting is not None:
            self._startup = Startup(self.program.loading.waiting.table)
        if self._startup is not None and self._startup.is_done:
            startup, self._startup = self._startup, None
            self.program.progress = None
            self.messages.clear()
            self._on_ready()
            if self.player_warmup is not None:
                self.player_warmup.close()
            self.player_warmup = PlayerWarmup(startup.table)
            self.program.demo_players.is_ready = self.player_warmup.is_ready
            self.program.finish_loading(startup.layout)
        elif self._startup is not None:
            self.program.progress = self._startup.progress
            if self.program.progress is not None and self.messages.opacity < 1.0:
                self.messages.show(compiling_message())

    def _advance_session(self, elapsed: float) -> None:
        self._follow_session()
        program, session = self.program, self._session
        if session is None or not program.is_moving or self.input_handler.shows_help:
            self.input_handler.buttons.forget_taps()
            self.latency.reset()
            self._collect_events()  # a single tick may have produced some
            return
        self._clock.speed = program.speed
        ticks = self._clock.advance(elapsed)
        if ticks == 0:
            return
        held = self.input_handler.buttons.poll()
        with program.stopping_on_error():
            if ticks > 1:
                session.advance(held, ticks - 1)
                held = held.later
            self._before = Moment.of_game(session.game)
            session.advance(held, 1)
        self.latency.record_tick()
        self._collect_events()

    def _collect_events(self) -> None:
        session, program = self._session, self.program
        if session is None:
            return
        world = session.game.world
        game_events, events = session.game.take_game_events(), session.game.take_world_events()
        program.display.add_events(game_events)
        self._picture.add_events(events, world.tick_rate)
        self._picture.add_game_events(game_events, world.tick_rate)
        self.debug.add_events(events, world.tick_rate)
        if program.is_audible:
            self.sounds.play_game_events(game_events)
            self.sounds.play_events(events, world.tick_rate, world.table.board.width)
        if session.is_played:
            for event in events:
                part = self._parts.get(event.part)
                if event.kind == "hit" and part is not None and part.has_coil:
                    strength = min(event.speed / RUMBLE_SPEED, 1.0)
                    self.input_handler.gamepads.rumble(strength, RUMBLE_SECONDS)

    def _follow_session(self) -> None:
        """Reset everything that belongs to a session when another one has begun."""
        session = self.program.session
        if session is self._session:
            return
        self._session, self._before = session, None
        self._picture.reset()
        self.debug.reset()
        self._clock = TickClock(session.game.tick_rate if session is not None else TICK_RATE)
        if session is not None:
            self._parts = sounds_of_parts(session.game.world.table)
            self.sounds.begin_game(session.game.world.table)

    def _apply_settings(self, before: Settings, settings: Settings) -> None:
        self.input_handler.update_controls()
        self.sounds.apply_settings(settings)
        if settings.full_screen not in (before.full_screen, self._screen.is_fullscreen):
            self._screen.toggle_fullscreen()
        if settings.cabinet is not self._screen.cabinet:
            self._screen.change_cabinet(settings.cabinet)
            self._redraw_all()

    def _redraw_all(self) -> None:
        """Draw what is around the table anew in the next frame."""
        self._backglass.invalidate()
        self._surroundings.invalidate()

    def _update_sounds(self, elapsed: float) -> None:
        program, sounds, session = self.program, self.sounds, self._session
        is_silent = self.input_handler.shows_help or not program.is_audible
        if session is None or not program.is_moving or is_silent:
            sounds.pause()
            sounds.set_rolling((), elapsed, program.board.table.board.width)
            return
        sounds.resume()
        game = session.game
        held = (False, False) if game.view.tilted else game.held
        sounds.set_buttons(*held, game.is_launch_held)
        width = game.world.table.board.width
        sounds.set_rolling(rolling_balls(game.world), elapsed * program.speed, width)
        sounds.follow(game, elapsed)

    # --- drawing ----------------------------------------------------------------------------------

    def _draw(self) -> None:
        program, session = self.program, self._session
        moment = Moment.before(program.board.table)
        if session is not None:
            moment = Moment.of_game(session.game)
            if session.has_ended:
                # The board no longer moves, but the last animations still play: a lost ball, sparks, lights.
                moment = moment._replace(time=moment.time + self._seconds - self._moved_at)
            else:
                self._moved_at = self._seconds
            if self._before is not None and program.is_moving:
                moment = Moment.between(self._before, moment, self._clock.fraction)
        if program.has_attract_lights:
            moment = moment._replace(show=Running("attract", self._seconds))
        self._picture.show(program.board.table, program.board.random_seed, program.settings.current)
        self._picture.fit(self.size, self._screen.second_size)
        dots = self._draw_backglass()
        target = self._picture.draw(moment, self._screen.surface, dots)
        renderer = self._picture.renderer
        rival = session.rival if isinstance(session, GameSession) else None
        if rival is not None and renderer.camera.size == target.get_size():
            draw_ghost_balls(target, renderer.camera, rival)
        scale, apron = self._picture.scale, self._picture.apron
        if self.input_handler.shows_debug and session is not None:
            self.debug.draw(target, renderer.camera, session.game.world)
            self.debug.draw_figures(
                target, session.game.world, self._frame_times, self.latency, program.speed,
                self._picture.figures_area, overlay.small_text_size(scale),
            )  # fmt: skip
        if self.input_handler.shows_help and self._picture.arrangement.backglass is None:
            overlay.draw_help(target, scale, self._help)
        elif self.input_handler.shows_help:
            overlay.dim(target)
        if self.messages.opacity > 0.0:
            overlay.draw_message(target, apron, scale, self.messages.text, self.messages.opacity)

    def _draw_backglass(self) -> Dots | None:
        """Draw what is around the table; return the dots of the table's own panel if it has one."""
        surface, arrangement = self._screen.surface, self._picture.arrangement
        theme = THEMES[self.program.settings.current.theme]
        picture = None
        if arrangement.backglass is not None and self.input_handler.shows_help:
            at = places(arrangement.backglass)
            image = overlay.help_image(self._help, at.text, at.inner_body.size, has_frame=False)
            picture = image, id(image)  # the images are cached, so the same page is the same image
        if arrangement.backglass is not None:
            content = self._content.read(self._seconds, picture, self._shove_key)
            if self._screen.second is not None:
                self._surroundings.draw_around(surface, arrangement, theme)
                surface = self._screen.second.surface
            self._backglass.draw(surface, arrangement, content, self._seconds)
            return None
        self._backglass.draw_around(surface, arrangement, theme)
        return self.program.dots(self._seconds)

    @property
    def _help(self) -> Help:
        """What the help says."""
        handler = self.input_handler
        rules = self._content.rules(self._shove_key)
        return Help(handler.help_page, self.program.board.seed, handler.controls, rules)

    @property
    def _shove_key(self) -> str:
        keys = self.input_handler.controls.key_labels(Action.JITTER)
        return upper_label(keys[0]) if keys else ""

    # --- crash report ----------------------------------------------------------------------------

    def _save_crash_replay(self) -> None:
        session = self._session
        if session is not None and session.is_played:
            path = self.program.games.save_replay_file("crash")
            where = f"A replay for a report is at {plain(str(path))}." if path else "Its replay is lost."
            print(f"silverball: the game ended unexpectedly. {where}", file=sys.stderr)
