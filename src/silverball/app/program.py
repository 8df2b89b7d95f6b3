"""The state of the program: the board, the session on it, the menus, and how sessions begin and end.

There is always a board. It may have a session (a game, a replay or a demo), and a menu page may be open on
the score display. The window passes in buttons and time and draws this state; this module does not depend on
it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from silverball.app.board import CurrentBoard
from silverball.app.command_handlers import execute
from silverball.app.controls import Action, PaddleInput
from silverball.app.demo_players import BEST_PLAYER, DemoPlayerSelector
from silverball.app.game_archive import GameArchive, GameResult
from silverball.app.menus import Button, Menus, ReplayStatus
from silverball.app.score_display import ScoreDisplay
from silverball.app.sessions import DemoSession, GameSession, ReplaySession, Session, why_no_single_tick
from silverball.app.settings import PlayerSettings, Settings
from silverball.app.startup import Progress, draw_line, draw_page
from silverball.errors import SilverballError
from silverball.game.mechanisms import plungers
from silverball.game.view import Mode

if TYPE_CHECKING:
    from silverball.app.catalog import Catalog, ScoreKey
    from silverball.drawing.dotmatrix.canvas import Dots
    from silverball.game.replay.format import Replay
    from silverball.game.scores.store import Store
    from silverball.table import Table

LOADING_MESSAGE = "one moment, please: the physics is being loaded"
GAME_OVER_SECONDS = 2.5  # [s] how long the end of a game is shown before a menu page opens
FILE_CHECK_INTERVAL = 0.5  # [s] between two checks whether a table file has changed
REPLAY_LOOKAHEAD = 480  # [tick] prepared per frame, so that jumps are fast
SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
NORMAL_SPEED = SPEEDS.index(1.0)


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
        session: What runs on the board; None at first and in the menus.
        menus: The pages on the score display.
        is_ready: Whether the physics is loaded.
        progress: Progress of the compilation; None while nothing is compiled.
        should_quit: Whether the program should end.
        is_replay_paused: Whether the replay is paused.
        store: Scores, settings and the last game.
        archive: Saves games in the store.
        demo_players: The player of the demo.
        result: Rank, score id and message of the last finished game.
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
        self.session: Session | None = None
        self.is_ready = self.should_quit = False
        self.progress: Progress | None = None
        self.is_replay_paused = False
        catalog.watch_file(settings.table)
        self.menus = Menus(self.settings, catalog.entries(), catalog.scores, themes=themes)
        self.display = ScoreDisplay()
        self.store, self.show_message = store, show_message
        self.archive = GameArchive(store, catalog)
        self.demo_players = DemoPlayerSelector()
        self.result = GameResult()
        self._catalog = catalog
        self._now = 0.0
        self._speed = NORMAL_SPEED
        self._pending: Callable[[], None] | None = (
            None  # the player's request, run once the physics is loaded
        )
        self._ended_at: float | None = None  # when the current game ended
        self._is_ranked = True  # whether the score of the current game may enter the high scores
        self._is_attract_demo = False  # whether the attract mode started the demo
        self._files_checked_at = 0.0
        self._game_recipe: Table | None = None  # the table that the board of the current game was made from
        self._score_key: ScoreKey | None = None  # the score list of the current game
        self.board = CurrentBoard(catalog, self.settings, self.menus.context, show_message, seed)
        self._update_last_game()

    # --- state --------------------------------------------------------------------------------------

    @property
    def speed(self) -> float:
        """Seconds of play per second of real time."""
        return SPEEDS[self._speed]

    @property
    def is_playing(self) -> bool:
        """Whether the player's buttons move the paddles now."""
        return self.has_game and not self.menus.is_open

    @property
    def is_moving(self) -> bool:
        """Whether time passes on the board."""
        if self.session is None or self.session.has_ended:
            return False
        if isinstance(self.session, GameSession):
            return not self.menus.is_open
        return not self.is_replay_paused

    @property
    def is_paused(self) -> bool:
        """Whether a game is paused."""
        return self.has_game and self.menus.is_open

    @property
    def has_game(self) -> bool:
        """Whether a game of the player is running or paused."""
        return isinstance(self.session, GameSession) and not self.session.has_ended

    @property
    def mode(self) -> Mode:
        """The mode of the current game, or else the chosen one."""
        if isinstance(self.session, GameSession):
            return self.session.game.mode
        return Mode(self.settings.current.mode)

    @property
    def is_audible(self) -> bool:
        """Whether the board makes sounds; the attract mode is silent."""
        return not self._is_attract_demo

    def dots(self, seconds: float) -> Dots:
        """Draw the score display at a time [s] of a monotonic clock."""
        below = None
        if self.session is not None:
            game, key = self.session.game, self._score_key
            best = self._catalog.best(key, game.mode) if self.session.is_played and key is not None else 0
            below = self.display.frame(game.view, seconds, best)
        if not self.menus.is_open and below is None:
            return draw_page(seconds, self.progress)
        dots = self.menus.draw(seconds, below)
        if self.progress is not None:
            draw_line(dots, self.progress)
        return dots

    # --- time ---------------------------------------------------------------------------------------

    def update(self, seconds: float) -> None:
        """Run everything that is due at a time [s] of a monotonic clock, except the session on the board."""
        self._now = seconds
        self._retry_saving(seconds)
        execute(self.menus.tick(seconds), self)
        self._check_table_files()
        session = self.session
        if isinstance(session, GameSession) and session.has_ended:
            self._finish_game(session)
        elif isinstance(session, DemoSession) and self.demo_players.switch_when_ready(session):
            self._announce_demo_player()
        elif isinstance(session, ReplaySession):
            with self.stopping_on_error():
                session.player.prepare(REPLAY_LOOKAHEAD)
                self.menus.update_replay(self._replay_status(session))

    def _retry_saving(self, seconds: float) -> None:
        """Retry pending writes to a store that another program has locked."""
        message = self.archive.retry_pending(seconds)
        if self.settings.read_when_unlocked():
            self._update_last_game()
        if message:
            self.show_message(message)

    @contextmanager
    def stopping_on_error(self) -> Iterator[None]:
        """Stop watching if the session fails: a replay may not match the game that it claims to be."""
        try:
            yield
        except SilverballError as error:
            self.show_message(str(error))
            self.stop_watching()

    def single_tick(self, held: PaddleInput) -> None:
        """Advance by one tick while the game or the replay is paused."""
        session = self.session
        if session is None or self.is_moving or session.has_ended:
            self.show_message(why_no_single_tick(session))
            return
        self._exclude_from_scores()
        with self.stopping_on_error():
            session.advance(held, 1)

    def jump(self, seconds: float) -> None:
        """Jump back or ahead in the replay."""
        session = self.session
        if isinstance(session, ReplaySession):
            target = session.player.tick + round(seconds * session.player.replay.tick_rate)
            with self.stopping_on_error():
                session.player.seek(target)

    # --- buttons ------------------------------------------------------------------------------------

    def press_menu(self, button: Button) -> None:
        """Press a button of the menus."""
        execute(self.menus.press(button), self)

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

    def create_ball(self, session: GameSession) -> None:
        """Create a ball, or ask on the display whether to spend one.

        Raises:
            SilverballError: No ball can be created; the message says why.
        """
        question = session.create_ball(self._key_label(Action.CREATE))
        if question:
            self.display.show_message(question, replace=True)
        elif plungers(session.game.table):
            self.display.show_message(f"HOLD {self._key_label(Action.LAUNCH)}, THEN LET GO", replace=True)

    def skip_game_over(self) -> None:
        """Open the page after a game now; the score must have been saved."""
        if self._ended_at is not None:
            self._ended_at = self._now - GAME_OVER_SECONDS

    def change_speed(self, step: int) -> None:
        """Play slower (-1) or faster (+1), by one step."""
        self._speed = min(max(self._speed + step, 0), self._max_speed)
        if isinstance(self.session, GameSession):
            self.show_message("normal speed" if self.speed == 1.0 else f"speed ×{self.speed:g}")
        if self.speed < 1.0:
            self._exclude_from_scores()

    @property
    def _max_speed(self) -> int:
        """The greatest index in SPEEDS that the session allows."""
        if isinstance(self.session, GameSession):
            return NORMAL_SPEED
        is_demo = isinstance(self.session, DemoSession)
        limit = self.demo_players.playing.max_speed if is_demo else SPEEDS[-1]
        return max(index for index, speed in enumerate(SPEEDS) if speed <= limit)

    def _exclude_from_scores(self) -> None:
        session = self.session
        if self._is_ranked and isinstance(session, GameSession) and session.game.mode is Mode.ARCADE:
            self._is_ranked = False
            self.show_message("slowed down: this game no longer counts for the high scores")

    def _key_label(self, action: Action) -> str:
        """The first key of an action, as the display writes it."""
        return self.menus.context.key_label(action)

    # --- sessions -----------------------------------------------------------------------------------

    def finish_loading(self) -> None:
        """Mark the physics as loaded and run the pending request."""
        self.is_ready = True
        pending, self._pending = self._pending, None
        if pending is not None:
            pending()

    def show_loading_message(self) -> None:
        """Show that the physics is still loading."""
        self.show_message(LOADING_MESSAGE)

    def cancel_pending(self) -> None:
        """Drop the pending request and return to the main menu."""
        self._pending = None
        self.menus.open_main()

    def _when_ready(self, start: Callable[[], None]) -> None:
        if self.is_ready:
            start()
        else:
            self._pending = start
            self.show_loading_message()

    def _start(self, session: Session) -> None:
        self.session = session
        is_calm = self.settings.current.effects == "less"
        self.display = ScoreDisplay(self._key_label(Action.CREATE), is_calm=is_calm)
        self._speed, self.is_replay_paused, self._is_attract_demo = NORMAL_SPEED, False, False
        self._ended_at, self._is_ranked, self.result = None, True, GameResult()

    def play(self, mode: Mode, table: str, seed: int | None = None) -> None:
        """Begin a game as soon as the physics is ready."""
        self.menus.close()
        if seed is None and self.board.is_unplayed and table == self.settings.current.table:
            seed = self.board.seed  # play on the board on screen
        if self.board.show_table(table, seed):
            self._when_ready(lambda: self.begin(mode))
        else:
            self.menus.open_main()

    def begin(self, mode: Mode) -> None:
        """Begin a game on the board on screen; the physics must be ready."""
        from silverball.game.game import Game

        self.save_last_game()
        self.menus.close()
        self.board.is_unplayed = False
        self._game_recipe = self.board.recipe  # its file may change before the game is over
        self._score_key = self._catalog.score_key(self.board.recipe)
        self._start(GameSession(Game(self.board.table, self.board.seed, mode)))

    def start_new_board(self, same_board: bool) -> None:
        """Begin a game on a new board, or on the same one again; a changed table file is read again."""
        mode = self.mode if self.session is None else self.session.game.mode
        text = self.board.renew(self.board.seed if same_board else None, self._key_label(Action.NEW_BOARD))
        if text is not None:
            self.menus.close()
            self._when_ready(lambda: self.begin(mode))
            self.show_message(text)

    def end_game(self) -> None:
        """End the player's game early: it can be watched, but its score is not ranked."""
        if isinstance(self.session, GameSession) and not self.session.has_ended:
            self.session.game.end()
            self.archive.save_last_game(self.session.game)
            self._update_last_game()
        self.session = None

    def _finish_game(self, session: GameSession) -> None:
        """Save a finished game in the first frame; open the next page after `GAME_OVER_SECONDS`."""
        if self._ended_at is None:
            recipe, initials = self._game_recipe or self.board.recipe, self.settings.current.initials
            self.result = self.archive.save_finished_game(
                session.game, recipe, initials, is_ranked=self._is_ranked
            )
            self.menus.context.has_last_game = True
            if self.result.message:
                self.show_message(self.result.message)
            self._ended_at = self._now
        elif self._now - self._ended_at >= GAME_OVER_SECONDS and not self.menus.is_open:
            self.menus.open_over(session.game.score, self.result.rank)

    def save_last_game(self) -> None:
        """Save the player's game as the last one, if a ball was created."""
        session = self.session
        if isinstance(session, GameSession) and self._ended_at is None:
            if session.has_ended:
                self._finish_game(session)
                return
            self.archive.save_last_game(session.game)
            self._update_last_game()

    def save_replay_file(self, name: str) -> Path | None:
        """Save the replay of the player's game as a file; None if it cannot be written."""
        if not isinstance(self.session, GameSession):
            return None
        return self.archive.save_replay_file(self.session.game, name)

    def _update_last_game(self) -> None:
        self.menus.context.has_last_game = self.store.last_game() is not None

    # --- replays and demos --------------------------------------------------------------------------

    def watch(self, replay: Replay) -> None:
        """Show a replay as soon as the physics is ready."""
        self._when_ready(lambda: self._start_replay(replay))

    def _start_replay(self, replay: Replay) -> None:
        from silverball.game.replay.player import ReplayPlayer

        self.save_last_game()
        self.board.show_replay(replay)
        session = ReplaySession(ReplayPlayer(replay))
        self._start(session)
        self.menus.open_transport(self._replay_status(session))

    def _replay_status(self, session: ReplaySession) -> ReplayStatus:
        player, rate = session.player, session.player.replay.tick_rate
        return ReplayStatus(
            player.tick / rate, player.ticks / rate, self.speed, self.is_replay_paused, "REPLAY"
        )

    def start_demo(self, player: str = BEST_PLAYER.name, *, is_attract: bool = False) -> None:
        """Start a demo once the physics is ready; a fallback player plays until this one is compiled."""
        self._when_ready(lambda: self._start_demo(player, is_attract))

    def _start_demo(self, player: str, is_attract: bool) -> None:
        needs_board = self.board.recipe.random is not None or self.session is not None
        if needs_board and not self.board.show_table(self.settings.current.table, None) and not is_attract:
            self.menus.reopen()
            return
        self._start(DemoSession(self.board.table, self.board.seed, self.demo_players.select(player)))
        self._is_attract_demo = is_attract
        self._announce_demo_player()

    def _announce_demo_player(self) -> None:
        """Show on the score display who plays the demo."""
        self._speed = min(self._speed, self._max_speed)
        self.display.player_label = self.demo_players.playing.label
        self.menus.context.demo_player = self.demo_players.playing

    def stop_watching(self) -> None:
        """End the demo or the replay, and show the menu page from which it was started."""
        if isinstance(self.session, ReplaySession):
            self.end_watching()
        self.session = None
        self.menus.reopen()

    def end_watching(self) -> None:
        """Remove the session and show the chosen table."""
        self.session = None
        self.board.show_table(self.settings.current.table, self.menus.context.seed)

    # --- the board ----------------------------------------------------------------------------------

    def show_board(self, seed: int | None) -> None:
        """Show the board that a seed makes of the chosen table, unless a game is running."""
        if not self.has_game:
            self.session = None
            self.board.show_table(self.settings.current.table, seed)

    def _check_table_files(self) -> None:
        """Update the list of tables, and show a message if the file of the current table has changed."""
        if self._now - self._files_checked_at < FILE_CHECK_INTERVAL:
            return
        self._files_checked_at = self._now
        is_choosing = self.menus.is_open and not self.is_paused
        if self._catalog.refresh(whole=is_choosing) and is_choosing:
            self.menus.context.tables = self._catalog.entries()
        if isinstance(self.session, ReplaySession | DemoSession):
            return  # the end of the session reads the file anyway
        key = self._key_label(Action.NEW_BOARD).replace("?", "a new game")
        self.board.check_file(key, has_session=self.session is not None)

    def _apply_settings(self, before: Settings, settings: Settings) -> None:
        self._catalog.watch_file(settings.table)
        if settings.table != before.table and not self.has_game:
            self.end_watching()
