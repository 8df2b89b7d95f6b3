"""The game in a window: buttons in, ticks, picture and sounds out, until the player ends it.

A *beat* is: buttons → as many ticks as real time asks for. A *frame* is a beat, and then: the table → what is
written on top → the screen. Between two frames the window goes on beating, a thousand times a second, so that
a button reaches the simulation within a tick and not only with the next picture.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pygame

from silverball.app import overlay
from silverball.app.catalog import Catalog
from silverball.app.clock import TickClock
from silverball.app.controls import Action
from silverball.app.debug import DebugView
from silverball.app.framerate import FrameTimes
from silverball.app.latency import LatencyMeter
from silverball.app.listener import Listener
from silverball.app.menus import capital
from silverball.app.messages import Messages
from silverball.app.picture import Picture, fitted
from silverball.app.player_warmup import Rehearsal
from silverball.app.program import Program
from silverball.app.scoring import how_to_score
from silverball.app.screen import Screen
from silverball.app.settings import Settings
from silverball.app.sound import Sounds
from silverball.app.sound.mixdown import rolling_balls
from silverball.app.startup import Startup, compiling_words
from silverball.drawing import Moment, best_size
from silverball.drawing.themes import THEMES
from silverball.errors import SilverballError, TableError
from silverball.game.scores.store import Store
from silverball.game.user_folder import data_folder
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.app.sessions import Session
    from silverball.game.replay.format import Replay

TICK_RATE = 240
LOADING_FRAME_RATE = 20  # [1/s] while the physics is loaded, which needs the processor more
BEAT = 0.001  # [s] between two looks at the buttons
PAGE_SOUNDS = {"initials": "high_score", "attract": "attract"}
RUMBLE_SPEED = 12.0  # [u/s] of an impact that rumbles with full strength


class Window:
    """A window to play in.

    Args:
        table: A table, a built-in name, or a path to a file; None: as chosen last. A recipe makes a new board
            for every seed.
        seed: Of the first board; None draws one.
        mode: Begin this game at once; None: begin in the menu.
        replay: Begin by showing this replay.
        height: Of the window [pixel]; None: as high as fits the screen.
        without_display: Whether SDL's drivers that show nothing will do, as in tests.
        folder: Where scores, settings and replays are; None: the user's data folder.
        on_compile: Called (from a thread) if the physics has to be compiled first.
        on_ready: Called when a game can begin.

    Raises:
        NoDisplay: There is no screen.
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
        without_display: bool = False,
        folder: Path | None = None,
        on_compile: Callable[[], None] = lambda: None,
        on_ready: Callable[[], None] = lambda: None,
    ) -> None:
        self._folder = folder or data_folder()
        self.messages = Messages()
        self.store = Store(self._folder, nonblocking=True)
        try:
            self.program = self._new_program(table, seed, mode)
            self._screen = Screen("Silverball", without_display=without_display)
        except SilverballError:
            self.store.close()
            raise
        settings = self.program.settings
        self._on_ready = on_ready
        self._startup: Startup | None = Startup(self.program.table, on_compile)
        self.rehearsal: Rehearsal | None = None  # of the players that can be watched
        board = self.program.table.board
        self._screen.open(best_size(board, height) if height else fitted(board, self._screen.first_room).size)
        if settings.full_screen:
            self._screen.toggle_full()
        self._picture = Picture(self._screen.surface.get_size())
        self.sounds = Sounds(settings)
        self.sounds.open()
        self._clock = TickClock(TICK_RATE)
        self._frame_times = FrameTimes()
        self.latency = LatencyMeter()
        self.debug = DebugView()
        self.listener = Listener(self.program, self._screen, self.sounds, self.messages, self.latency)
        self._settings = settings
        self._stage: Session | None = None
        self._before: Moment | None = None  # one tick before the present one
        self._seconds = self._drawn_at = 0.0  # real time so far, and at the last picture
        self._moved_at = 0.0  # at the last picture of a stage that had not ended
        for trouble in filter(None, (self.store.warning, self.sounds.trouble)):
            self.messages.say(trouble)
        if replay is not None:
            self.program.watch(replay)
        elif mode is not None:
            self.program.play(mode, settings.table, self.program.seed)

    def _new_program(self, table: Table | str | None, seed: int | None, mode: Mode | None) -> Program:
        """The program on a table; on the default one if a table chosen long ago is no longer there."""
        settings = Settings.of(self.store.settings())
        given = {}
        if table is not None:
            name = table if isinstance(table, str) else table.name
            given = {} if isinstance(table, str) else {name: table}
            # Without a mode, the player chooses one in the menu, and it is to be on this table.
            modes = (Mode.ARCADE, Mode.FREE) if mode is None else (mode,)
            settings = settings.changed(**{f"{each}_table": name for each in modes})
        if mode is not None:
            settings = settings.changed(mode=mode)
        library = Catalog(self.store, self._folder, given)
        try:
            return Program(self.store, settings, library, seed, self.messages.say, tuple(THEMES))
        except TableError as error:
            if table is not None:
                raise
            self.messages.say(str(error))
            settings = settings.changed(table=Settings(mode=settings.mode).table)
            return Program(self.store, settings, library, seed, self.messages.say, tuple(THEMES))

    # --- the loop ---------------------------------------------------------------------------------

    def run(self, seconds: float | None = None) -> None:
        """Play until the player ends it, or for some seconds."""
        before = start = time.perf_counter()
        try:
            while not self.is_over and (seconds is None or before - start < seconds):
                due = time.perf_counter() + 1.0 / self.frame_rate
                before = self.beat_until(due, self.picture(before))
        except Exception:
            self._keep_after_crash()
            raise
        finally:
            self.close()

    def beat(self, elapsed: float) -> None:
        """Answer the buttons and play on, so many seconds after the last beat or frame."""
        self._seconds += elapsed
        self._begin_when_ready()
        for event in pygame.event.get():
            self.listener.answer(event)
        self._play(elapsed)

    def frame(self, elapsed: float) -> None:
        """One frame, so many seconds after the last beat or frame."""
        self.beat(elapsed)
        self.draw()
        self.show()

    def picture(self, before: float) -> float:
        """One picture in real time; buttons are heard before it is made and before it is shown.

        Args:
            before: When the last beat was, by `time.perf_counter` [s].

        Returns:
            When the last beat was now.
        """
        before = self._beat_since(before)
        self.draw()
        before = self._beat_since(before)
        self.show()
        return before

    def draw(self) -> None:
        """Make the picture and the sounds of this moment."""
        elapsed, self._drawn_at = self._seconds - self._drawn_at, self._seconds
        page = self.program.menus.page
        self.program.pass_time(self._seconds)
        if self.program.menus.page != page and self.program.menus.page in PAGE_SOUNDS:
            self.sounds.menu(PAGE_SOUNDS[self.program.menus.page])
            self.listener.shows_help = False  # whoever asked for it has gone, or wants to sign a score
        self._follow_settings()
        self._frame_times.add(self._seconds)
        is_watched = self.program.is_playing and bool(self._stage and self._stage.game.world.balls)
        self.messages.pass_time(elapsed, in_play=is_watched)
        self._screen.pass_time(elapsed, waits=self.program.is_paused)
        self._sound(elapsed)
        self._draw()
        self.latency.drawn()

    def show(self) -> None:
        """Hand the picture to the screen."""
        self._screen.flip()
        self.latency.shown()

    def close(self) -> None:
        """Keep the game that is played and close the window."""
        self.program.keep_last_game()
        self.program.stage = self._stage = None
        self._picture.close()
        if self.rehearsal is not None:
            self.rehearsal.close()
        self.sounds.close()
        self.listener.close()
        self._screen.close()
        if not self.store.is_spooled:
            print(f"waiting for another program that holds {self.store.path} …", file=sys.stderr)
        self.store.close()
        if self.store.exit_warning:
            print(plain(self.store.exit_warning), file=sys.stderr)

    @property
    def is_over(self) -> bool:
        """Whether the player wants to end."""
        return self.program.is_over

    @property
    def is_ready(self) -> bool:
        """Whether the physics is loaded and a game can be played."""
        return self.program.is_ready

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [pixel]."""
        return self._screen.surface.get_size()

    @property
    def is_sharp(self) -> bool:
        """Whether the table is drawn in full quality."""
        return self._picture.is_sharp

    @property
    def frame_rate(self) -> int:
        """Frames per second to aim at."""
        if not self.is_ready:
            return LOADING_FRAME_RATE
        wanted = self.program.settings.frame_rate
        return self._screen.refresh_rate if wanted == "screen" else int(wanted)

    def beat_until(self, due: float, before: float) -> float:
        """Go on beating until the next picture is due.

        Args:
            due: When, by `time.perf_counter` [s].
            before: When the last beat was.

        Returns:
            When the last beat was now.
        """
        while not self.is_over:
            before = self._beat_since(before)
            left = due - time.perf_counter()
            if left <= 0.0:
                break
            time.sleep(min(BEAT, left) if self.is_ready else left)
        return before

    def _beat_since(self, before: float) -> float:
        """A beat, when the last one was at this time; the time now."""
        now = time.perf_counter()
        self.beat(now - before)
        return now

    # --- playing ----------------------------------------------------------------------------------

    def _begin_when_ready(self) -> None:
        if self._startup is not None and self._startup.is_done:
            self._startup = None
            self.program.progress = None
            self.messages.clear()
            self._on_ready()
            self.rehearsal = Rehearsal(self.program.table)
            self.program.cast.is_ready = self.rehearsal.is_ready
            self.program.get_ready()
        elif self._startup is not None:
            self.program.progress = self._startup.progress
            if self.program.progress is not None and self.messages.strength < 1.0:
                self.messages.say(compiling_words())

    def _play(self, elapsed: float) -> None:
        program = self.program
        self._follow_stage()
        if not program.is_moving or self.listener.shows_help:
            self.listener.buttons.forget_taps()
            self.latency.forget()
            self._note_events()  # single ticks have some too
            return
        self._clock.speed = program.speed
        ticks = self._clock.advance(elapsed)
        if ticks == 0 or self._stage is None:
            return
        held = self.listener.buttons.take()
        if ticks > 1:
            program.advance(held, ticks - 1)
            held = held._replace(first=held.rest)
        self._before = Moment.of(self._stage.game.world)
        program.advance(held, 1)
        self.latency.ticked()
        self._note_events()

    def _note_events(self) -> None:
        stage, program = self._stage, self.program
        if stage is None:
            return
        world = stage.game.world
        news, events = stage.take_game_events(), stage.take_world_events()
        program.display.tell(news)
        self._picture.note(events, world.tick_rate)
        self.debug.note(events, world.tick_rate)
        if program.is_heard:
            self.sounds.tell(news)
            self.sounds.note(events, world.tick_rate, world.table.board.width)
        if stage.is_played:
            for event in events:
                if event.kind == "hit" and event.part.startswith("cylinder"):
                    self.listener.pads.rumble(min(event.speed / RUMBLE_SPEED, 1.0), 0.08)

    def _follow_stage(self) -> None:
        """Another game, replay or show has begun."""
        stage = self.program.stage
        if stage is self._stage:
            return
        self._stage, self._before = stage, None
        self._picture.forget()
        self.debug.forget()
        self._clock = TickClock(stage.game.tick_rate if stage is not None else TICK_RATE)
        if stage is not None:
            self.sounds.begin(stage.game.world.table)

    def _follow_settings(self) -> None:
        settings = self.program.settings
        if settings is self._settings:
            return
        before, self._settings = self._settings, settings
        self.listener.use(settings)
        self.sounds.change(settings)
        if settings.full_screen not in (before.full_screen, self._screen.is_full):
            self._screen.toggle_full()

    def _sound(self, elapsed: float) -> None:
        program, sounds = self.program, self.sounds
        if not program.is_moving or self.listener.shows_help or self._stage is None or not program.is_heard:
            sounds.pause()
            sounds.rolling((), elapsed, self.program.table.board.width)
            return
        sounds.resume()
        world = self._stage.game.world
        game = self._stage.game
        sounds.buttons(*((False, False) if game.view.tilted else game.held))
        balls = rolling_balls(world)
        sounds.rolling(balls, elapsed * program.speed, world.table.board.width)

    # --- drawing ----------------------------------------------------------------------------------

    def _draw(self) -> None:
        program, stage = self.program, self._stage
        moment = Moment.before(program.table)
        if stage is not None:
            moment = Moment.of(stage.game.world)
            if stage.has_ended:
                # Nothing moves any more, but what was on its way is gone soon: a lost ball, sparks, lights.
                moment = moment._replace(time=moment.time + self._seconds - self._moved_at)
            else:
                self._moved_at = self._seconds
            if self._before is not None and program.is_moving:
                moment = Moment.between(self._before, moment, self._clock.share)
        self._picture.show(program.table, program.board_seed, program.settings)
        target = self._picture.draw(moment, self._screen.surface, program.dots(self._seconds))
        renderer = self._picture.renderer
        scale, apron = self._picture.scale, self._picture.apron
        if self.listener.shows_debug and stage is not None:
            self.debug.draw(target, renderer.camera, stage.game.world)
            self.debug.draw_figures(
                target, stage.game.world, self._frame_times, self.latency, program.speed,
                self._picture.figures_area, overlay.small_text_size(scale),
            )  # fmt: skip
        if self.listener.shows_help:
            shoves = self.listener.controls.shown_keys(Action.JITTER)
            rules = how_to_score(program.table, program.mode, capital(shoves[0]) if shoves else "")
            overlay.draw_help(
                target, scale, program.seed, self.listener.controls, self.listener.help_page, rules
            )
        if self.messages.strength > 0.0:
            overlay.draw_message(target, apron, scale, self.messages.text, self.messages.strength)

    # --- what is left behind ----------------------------------------------------------------------

    def _keep_after_crash(self) -> None:
        stage = self._stage
        if stage is not None and stage.is_played:
            path = self.program.keep_file("crash")
            where = f"A replay for a report is at {plain(str(path))}." if path else "Its replay is lost."
            print(f"silverball: the game ended unexpectedly. {where}", file=sys.stderr)
