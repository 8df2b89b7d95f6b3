"""The state of the program without a window: what is asked of it, and what runs on its machine.

There is always a board. It may have a session (a game, a replay or a demo), and a menu page may be open on
the score display. The window passes in buttons and time and draws this state; this module does not depend on
it. Whatever needs the physics waits until that is loaded.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from datetime import date
from typing import TYPE_CHECKING

from silverball.app.board import CurrentBoard
from silverball.app.challenge import Challenge
from silverball.app.command_handlers import execute
from silverball.app.controls import Action, PaddleInput
from silverball.app.demo_players import BEST_PLAYER, DemoPlayerSelector
from silverball.app.dot_game import DotGame
from silverball.app.loading import ANY_LAYOUT, Loading, Request
from silverball.app.machine import Machine
from silverball.app.menus import Button, Menus
from silverball.app.menus.commands import Rivalry
from silverball.app.moments import challenges
from silverball.app.player_games import PlayerGames, note_of
from silverball.app.score_display import ScoreDisplay
from silverball.app.sessions import DemoSession, GameSession, ReplaySession, Session, why_no_single_tick
from silverball.app.settings import PlayerSettings, Settings
from silverball.app.startup import Progress, draw_line, draw_page
from silverball.app.watching import Watching
from silverball.game.view import Mode

if TYPE_CHECKING:
    from silverball.app.catalog import Catalog
    from silverball.drawing.dotmatrix.canvas import Dots
    from silverball.game.replay.format import Replay
    from silverball.game.scores.store import Store
    from silverball.table import Table

LOADING_MESSAGE = "one moment, please: the physics is being loaded"
FILE_CHECK_INTERVAL = 0.5  # [s] between two checks whether a table file has changed


class Program:
    """The state of the program.

    Args:
        store: Scores, settings and the last game.
        settings: The settings at the start.
        catalog: The tables and scores to choose from.
        seed: Seed of the first board; None draws one.
        show_message: Shows the player a sentence.
        themes: Names of the colour themes.

    Attributes:
        settings: The player's settings.
        board: The board on screen.
        menus: The pages on the score display.
        machine: What games, replays and demos run on.
        games: The player's games.
        watching: Replays and demos.
        loading: What is loaded of the physics.
        progress: Progress of the compilation; None while nothing is compiled.
        dot_game: What is played while the physics is compiled.
        should_quit: Whether the program should end.
        store: Scores, settings and the last game.
        show_message: Shows the player a sentence.
    """

    def __init__(
        self,
        store: Store,
        settings: Settings,
        catalog: Catalog,
        seed: int | None = None,
        show_message: Callable[[str], None] = lambda text: None,
        themes: Sequence[str] = ("neon",),
    ) -> None:
        self.settings = PlayerSettings(settings, store)
        self.settings.subscribe(self._apply_settings)
        self.loading = Loading()
        self.should_quit = False
        self.progress: Progress | None = None
        catalog.watch_file(settings.table)
        self.menus = Menus(self.settings, catalog.entries(), catalog.scores, themes=themes)
        self.menus.context.challenges = lambda: challenges(
            catalog,
            self.settings.current.arcade_table,
            [entry.name for entry in self.menus.context.tables if not entry.problem],
            date.today(),
        )
        self.store, self.show_message = store, show_message
        self._catalog = catalog
        self.dot_game = DotGame(settings.dot_game_best)
        self._files_checked_at = 0.0
        self.board = CurrentBoard(catalog, self.settings, self.menus.context, show_message, seed)
        self.machine = Machine(self.board, self.settings, self.menus, show_message)
        self.watching = Watching(self.machine)
        self.games = PlayerGames(self.machine, store, catalog, self._is_player_ready)

    # --- state --------------------------------------------------------------------------------------

    @property
    def session(self) -> Session | None:
        """What runs on the board; None at first and in the menus."""
        return self.machine.session

    @session.setter
    def session(self, session: Session | None) -> None:
        self.machine.session = session

    @property
    def display(self) -> ScoreDisplay:
        """The score display of the session."""
        return self.machine.display

    @property
    def demo_players(self) -> DemoPlayerSelector:
        """The player of the demo."""
        return self.watching.demo_players

    @property
    def speed(self) -> float:
        """Seconds of play per second of real time."""
        return self.machine.speed

    @property
    def is_playing(self) -> bool:
        """Whether the player's buttons move the paddles now."""
        return self.has_game and not self.menus.is_open

    @property
    def is_moving(self) -> bool:
        """Whether time passes on the board."""
        return self.machine.is_moving

    @property
    def is_paused(self) -> bool:
        """Whether a game is paused."""
        return self.has_game and self.menus.is_open

    @property
    def has_game(self) -> bool:
        """Whether a game of the player is running or paused."""
        return self.machine.has_game

    @property
    def charges_plunger(self) -> bool:
        """Whether the button of a new ball draws the plunger back, because a ball lies on it."""
        session = self.session
        return isinstance(session, GameSession) and self.is_playing and session.game.has_ball_to_launch

    @property
    def is_compiling_for_game(self) -> bool:
        """Whether a requested game waits until the physics is compiled."""
        return self.session is None and not self.menus.is_open and self.progress is not None

    @property
    def mode(self) -> Mode:
        """The mode of the current game, or else the chosen one."""
        if isinstance(self.session, GameSession):
            return self.session.game.mode
        return Mode(self.settings.current.mode)

    @property
    def is_audible(self) -> bool:
        """Whether the board makes sounds; the attract mode is silent."""
        return not (isinstance(self.session, DemoSession) and self.session.is_attract)

    @property
    def has_attract_lights(self) -> bool:
        """Whether the lamps play the show of the attract mode, because no game lights them."""
        session = self.session
        is_lit = session is not None and session.game.mode is Mode.ARCADE and not session.has_ended
        return session is None or (self.menus.page == "attract" and not is_lit)

    @property
    def best_score(self) -> int:
        """The best score so far in the list of the player's game; 0 if there is none."""
        return self.games.best_score

    def dots(self, seconds: float) -> Dots:
        """Draw the score display at a time [s] of a monotonic clock."""
        below = None
        if self.session is not None:
            self.note_standing()
            game = self.session.game
            below = self.display.frame(game.view, seconds, self.best_score, game.modes)
        if not self.menus.is_open and below is None:
            return self.waiting_page(seconds)
        dots = self.menus.draw(seconds, below)
        if self.progress is not None:
            draw_line(dots, self.progress)
        return dots

    def waiting_page(self, seconds: float) -> Dots:
        """Draw the display while a requested game waits for the physics."""
        keys = self.machine.key_label(Action.LEFT), self.machine.key_label(Action.RIGHT)
        return draw_page(seconds, self.progress, self.dot_game, keys)

    def note_standing(self) -> None:
        """Note for the display how the rival stands, or who is up in a match."""
        self.display.note = note_of(self.session)

    # --- time ---------------------------------------------------------------------------------------

    def update(self, seconds: float) -> None:
        """Run everything that is due at a time [s] of a monotonic clock, except the session on the board."""
        self.machine.now = seconds
        if self.is_compiling_for_game:
            self.dot_game.advance(seconds)
        self._retry_saving(seconds)
        execute(self.menus.tick(seconds), self)
        self._check_table_files()
        self.games.update()
        self.watching.update()

    def _retry_saving(self, seconds: float) -> None:
        """Retry pending writes to a store that another program has locked."""
        message = self.games.archive.retry_pending(seconds)
        if self.settings.read_when_unlocked():
            self.games.update_last_game()
        if message:
            self.show_message(message)

    def stopping_on_error(self) -> AbstractContextManager[None]:
        """Stop watching if the session fails: a replay may not match the game that it claims to be."""
        return self.watching.stopping_on_error()

    def single_tick(self, held: PaddleInput) -> None:
        """Advance by one tick while the game or the replay is paused."""
        session = self.session
        if session is None or self.is_moving or session.has_ended:
            self.show_message(why_no_single_tick(session))
            return
        self.games.exclude_from_scores()
        with self.stopping_on_error():
            session.advance(held, 1)

    def change_speed(self, step: int) -> None:
        """Play slower (-1) or faster (+1), by one step."""
        self.machine.change_speed(step)
        if isinstance(self.session, GameSession):
            self.show_message("normal speed" if self.speed == 1.0 else f"speed ×{self.speed:g}")
        if self.speed < 1.0:
            self.games.exclude_from_scores()

    def _is_player_ready(self, name: str) -> bool:
        """Whether a player of the program can play without a delay; the window sets how to know."""
        return self.demo_players.is_ready(name)

    # --- buttons ------------------------------------------------------------------------------------

    def press_menu(self, button: Button) -> None:
        """Press a button of the menus."""
        execute(self.menus.press(button), self)

    def click_menu(self, index: int, step: int) -> None:
        """Click on a row of the open page; a setting takes a step of −1 or +1."""
        execute(self.menus.click(index, step), self)

    def capture(self, name: str, kind: str | None = None) -> None:
        """Pass on the key or button that the menus asked for; `kind` is the device whose name it is."""
        execute(self.menus.capture(name, kind), self)

    def lose_focus(self) -> None:
        """Pause the game, because the window no longer receives keys."""
        self.menus.release_all()
        if self.is_playing:
            self.menus.open_pause()

    def lose_gamepad(self, title: str) -> None:
        """Pause the game, because the gamepad in use was unplugged."""
        if self.is_playing:
            self.menus.open_pause()
            self.show_message(f"{title} was unplugged: the game is paused")

    # --- what needs the physics ---------------------------------------------------------------------

    @property
    def is_ready(self) -> bool:
        """Whether the physics is loaded, as far as it is needed."""
        return self.loading.is_ready

    def finish_loading(self, layout: str = ANY_LAYOUT) -> None:
        """Mark the physics of a layout of worlds as loaded, and run the request that waits for it."""
        self.keep_best_of_dots()
        request = self.loading.add(layout)
        if request is not None:
            self._when_ready(*request)

    def show_loading_message(self) -> None:
        """Show that the physics is still loading."""
        self.show_message(LOADING_MESSAGE)

    def cancel_pending(self) -> None:
        """Drop the pending request and return to the main menu."""
        self.loading.waiting = None
        self.keep_best_of_dots()
        self.menus.open_main()

    def keep_best_of_dots(self) -> None:
        """Keep the best score of the tiny game that is played meanwhile."""
        best = max(self.dot_game.best, self.dot_game.points)
        if best > self.settings.current.dot_game_best:
            self.settings.change(dot_game_best=best)

    def _when_ready(self, table: Table, start: Callable[[], None]) -> None:
        """Start something on a table as soon as its physics is loaded; until then nothing runs."""
        if self.loading.has(table):
            self.loading.waiting = None
            start()
            return
        self.games.save_last_game()
        self.session = None
        self.loading.waiting = Request(table, start)
        self.show_loading_message()

    def play(
        self,
        mode: Mode,
        table: str,
        seed: int | None = None,
        *,
        players: int = 1,
        rival: Rivalry = Rivalry.NOBODY,
    ) -> None:
        """Begin a game as soon as the physics is ready.

        Args:
            mode: Its mode.
            table: Its table.
            seed: The seed of its board; None draws one.
            players: How many take turns.
            rival: Who plays beside the player.
        """
        self.menus.close()
        challenge = Challenge(seed, players, rival)
        if self.board.show_table(table, self.games.seed_for(table, challenge)):
            self._when_ready(self.board.table, lambda: self.games.begin(mode, challenge))
        else:
            self.menus.open_main()

    def start_new_board(self, same_board: bool) -> None:
        """Begin a game on a new board, or on the same one again; a changed table file is read again."""
        mode = self.mode if self.session is None else self.session.game.mode
        key = self.machine.key_label(Action.NEW_BOARD)
        text = self.board.renew(self.board.seed if same_board else None, key)
        if text is not None:
            self.menus.close()
            self._when_ready(self.board.table, lambda: self.games.begin(mode))
            self.show_message(text)

    def watch(self, replay: Replay) -> None:
        """Show a replay as soon as the physics is ready."""

        def start() -> None:
            self.games.save_last_game()
            self.watching.start_replay(replay)

        self._when_ready(replay.table, start)

    def start_demo(self, player: str = BEST_PLAYER.name, *, is_attract: bool = False) -> None:
        """Start a demo once the physics is ready; a fallback player plays until this one is compiled."""
        table = self.board.table
        self._when_ready(table, lambda: self.watching.start_demo(player, is_attract=is_attract))

    # --- the board ----------------------------------------------------------------------------------

    def show_board(self, seed: int | None) -> None:
        """Show the board that a seed makes of the chosen table, unless a game is running."""
        if not self.has_game:
            self.session = None
            self.board.show_table(self.settings.current.table, seed)

    def _check_table_files(self) -> None:
        """Update the list of tables, and show a message if the file of the current table has changed."""
        now = self.machine.now
        if now - self._files_checked_at < FILE_CHECK_INTERVAL:
            return
        self._files_checked_at = now
        is_choosing = self.menus.is_open and not self.is_paused
        if self._catalog.refresh(whole=is_choosing) and is_choosing:
            self.menus.context.tables = self._catalog.entries()
        if isinstance(self.session, ReplaySession | DemoSession):
            return  # the end of the session reads the file anyway
        key = self.machine.key_label(Action.NEW_BOARD).replace("?", "a new game")
        self.board.check_file(key, has_session=self.session is not None)

    def _apply_settings(self, before: Settings, settings: Settings) -> None:
        self._catalog.watch_file(settings.table)
        if settings.table != before.table and not self.has_game:
            self.watching.end()
