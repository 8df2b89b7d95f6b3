"""What is the program doing, and what follows from a button? Games begin, pause, end and are kept.

At any time there is a board, perhaps a stage on it (somebody plays, a replay, the program itself), perhaps a
page of the menus on the score display. The window passes in actions and time, and shows what is here; no
window in here.
"""

from __future__ import annotations

import secrets
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from silverball.app.catalog import file_in_words, trouble_of, trouble_words
from silverball.app.command_handlers import execute
from silverball.app.controls import MENU_BUTTONS, PADDLES, Action, Held
from silverball.app.demo_players import BEST, DemoPlayers
from silverball.app.game_archive import Ended, GameArchive
from silverball.app.menus import Button, Menus, ReplayFace
from silverball.app.progress_bar import Progress, draw_line, draw_page
from silverball.app.score_display import Display
from silverball.app.sessions import DemoSession, GameSession, ReplaySession, Session, why_no_tick
from silverball.app.settings import Settings
from silverball.errors import BoardFull, NoRoom, SilverballError
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.table import Table

if TYPE_CHECKING:
    from silverball.app.catalog import Catalog, Key
    from silverball.drawing.dotmatrix.canvas import Dots
    from silverball.game.replay.format import Replay
    from silverball.game.scores.store import Store

SEEDS = 1_000_000  # a new board's seed is below it: short enough to tell a friend
WAIT = "one moment, please: the physics is being made ready"
OVER_SECONDS = 2.5  # for which the end of a game is shown before a page of the menus comes
LOOK_EVERY = 0.5  # [s] between two looks whether a table file has changed
SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
AS_PLAYED = SPEEDS.index(1.0)


class Program:
    """What is going on.

    Args:
        store: What is kept.
        settings: As they were kept.
        library: The tables and scores that can be chosen.
        seed: Of the first board; None draws one.
        say: Tells the player a sentence.
        themes: Names of the colours there are.

    Attributes:
        settings: As they are now.
        table: The board that is seen, finished.
        seed: That it was made with.
        recipe: What it was made of.
        stage: What goes on on it; None before anything does.
        menus: The pages on the score display.
        is_ready: Whether the physics is loaded.
        progress: How far it is compiled; None while nothing is.
        is_over: Whether the program is to end.
        is_held: Whether a replay stands still.
        store: What is kept.
        keeper: Keeps games in it.
        cast: Who plays when the program plays by itself.
        ended: What has become of the game that was over last.
        say: Tells the player a sentence.
    """

    def __init__(
        self,
        store: Store,
        settings: Settings,
        library: Catalog,
        seed: int | None = None,
        say: Callable[[str], None] = lambda text: None,
        themes: Sequence[str] = ("neon",),
    ) -> None:
        self.settings = settings
        self.stage: Session | None = None
        self.is_ready = self.is_over = False
        self.progress: Progress | None = None
        self.is_held = False
        library.choose(settings.table)
        self.menus = Menus(settings, library.entries(), library.scores, themes=themes)
        self.menus.know(has_last_game=store.last_game() is not None)
        self.display = Display()
        self.store, self.say = store, say
        self.keeper = GameArchive(store, library)
        self.cast = DemoPlayers()
        self._library = library
        self._now = 0.0
        self._speed = AS_PLAYED
        self._wish: Callable[[], None] | None = None  # waits for the physics
        self._ended_at: float | None = None  # when the game that is played was over
        self._counts = True  # whether its score is for the scores
        self.ended = Ended()
        self._is_shown_off = False  # the program plays because nobody is there
        self._is_fresh = True  # nobody has played on this board yet
        self._looked = 0.0  # when the table files were looked at
        self._played: Table | None = None  # of what the board of the game was made
        self._key: Key | None = None  # under which its score is listed
        self._is_blind = store.is_unreadable  # the settings are not known yet
        self._see(library.recipe(settings.table), seed)

    # --- what there is to see -----------------------------------------------------------------------

    @property
    def speed(self) -> float:
        """Seconds of play per second of real time."""
        return SPEEDS[self._speed]

    @property
    def is_playing(self) -> bool:
        """Whether somebody's paddles move now."""
        return isinstance(self.stage, GameSession) and not self.menus.is_open and not self.stage.has_ended

    @property
    def is_moving(self) -> bool:
        """Whether time goes on on the board."""
        if self.stage is None or self.stage.has_ended:
            return False
        if isinstance(self.stage, GameSession):
            return not self.menus.is_open
        return not self.is_held

    @property
    def is_paused(self) -> bool:
        """Whether a game waits for its player."""
        return isinstance(self.stage, GameSession) and self.menus.is_open and not self.stage.has_ended

    @property
    def has_game(self) -> bool:
        """Whether a game is played, paused or not, and not over."""
        return isinstance(self.stage, GameSession) and not self.stage.has_ended

    @property
    def mode(self) -> Mode:
        """The game that is played, or the one that is chosen."""
        return self.stage.game.mode if isinstance(self.stage, GameSession) else Mode(self.settings.mode)

    @property
    def is_heard(self) -> bool:
        """Whether the board makes sounds: not while it only shows off."""
        return not self._is_shown_off

    @property
    def board_seed(self) -> int | None:
        """The seed of the board, None if it is always the same."""
        return None if self.recipe.random is None else self.seed

    def dots(self, seconds: float) -> Dots:
        """What the score display shows."""
        below = None
        if self.stage is not None:
            is_played, mode = self.stage.is_played, self.stage.game.mode
            best = self._library.best(self._key, mode) if is_played and self._key is not None else 0
            below = self.display.frame(self.stage.game.view, seconds, best)
        if not self.menus.is_open and below is None:
            return draw_page(seconds, self.progress)
        dots = self.menus.draw(seconds, below)
        if self.progress is not None:
            draw_line(dots, self.progress)
        return dots

    # --- time ---------------------------------------------------------------------------------------

    def pass_time(self, seconds: float) -> None:
        """Real time has gone on.

        Args:
            seconds: By a clock that never goes back [s].
        """
        self._now = seconds
        self._try_to_save(seconds)
        execute(self.menus.tick(seconds), self)
        self._look_at_files()
        stage = self.stage
        if isinstance(stage, GameSession) and stage.has_ended:
            self._after_the_end(stage)
        if isinstance(stage, DemoSession) and self.cast.follow(stage):
            self._announce()
        # A replay is played a little ahead, so that a jump is quick.
        if isinstance(stage, ReplaySession) and self._goes_on(lambda: stage.player.prepare(480)):
            self.menus.show_replay(self._replay_face(stage))

    def _try_to_save(self, seconds: float) -> None:
        """Save what waits for another program that held the file of the scores."""
        words = self.keeper.pass_time(seconds)
        if self._is_blind and not self.store.has_pending:
            self._is_blind = False
            here = {"table": self.settings.table, "mode": self.settings.mode}
            self._take(Settings.of(self.store.settings()).changed(**here))
            self.menus.use(self.settings)
            self.menus.know(has_last_game=self.store.last_game() is not None)
        if words:
            self.say(words)

    def advance(self, held: Held, ticks: int) -> None:
        """Move what goes on on the board by a number of ticks."""
        stage = self.stage
        if stage is not None and self.is_moving:
            self._goes_on(lambda: stage.advance(held, ticks))

    def single_tick(self, held: Held) -> None:
        """Move on by one tick while the game waits."""
        stage = self.stage
        if stage is None or self.is_moving or stage.has_ended:
            self.say(why_no_tick(stage))
            return
        self._no_longer_counts()
        self._goes_on(lambda: stage.advance(held, 1))

    def jump(self, seconds: float) -> None:
        """Go back or ahead in the replay that is watched."""
        stage = self.stage
        if isinstance(stage, ReplaySession):
            target = stage.player.tick + round(seconds * stage.player.replay.tick_rate)
            self._goes_on(lambda: stage.player.seek(target))

    def _goes_on(self, move: Callable[[], object]) -> bool:
        """Whether what moves the stage went well; a replay that is not the game it says is put away."""
        try:
            move()
        except SilverballError as error:
            self.say(str(error))
            self._stop_watching()
            return False
        return True

    # --- buttons ------------------------------------------------------------------------------------

    def press(self, action: Action, *, again: bool = False) -> None:
        """A key or gamepad button went down.

        Args:
            action: What it asks for; full screen, help, debug view and mute are the window's.
            again: Whether shift is held: the same board instead of a new one.
        """
        if action is Action.SLOWER or action is Action.FASTER:
            self.change_speed(-1 if action is Action.SLOWER else 1)
        elif self.menus.is_open:
            if action in MENU_BUTTONS:
                self.press_menu(MENU_BUTTONS[action])
            elif self.menus.page == "attract":
                self.press_menu(Button.BACK)  # any button will do
            elif action is Action.NEW_BOARD and isinstance(self.stage, GameSession):
                self._new_board(again)
            elif action is Action.JITTER and self.is_paused:
                self.say("the game is paused")
        elif self.stage is None:
            self._press_while_waiting(action)
        elif isinstance(self.stage, GameSession):
            self._press_in_play(action, again, self.stage)
        else:
            self._stop_watching()  # the program plays; whoever touches anything wants the menu

    def release(self, action: Action) -> None:
        """A key or gamepad button came up."""
        if action in MENU_BUTTONS:
            self.menus.release(MENU_BUTTONS[action])

    def press_menu(self, button: Button) -> None:
        """A button of the menus went down."""
        execute(self.menus.press(button), self)

    def capture(self, name: str, kind: str | None = None) -> None:
        """The key or button that the menus have asked for, and whose name that is."""
        execute(self.menus.capture(name, kind), self)

    def lose_focus(self) -> None:
        """The window no longer hears the keys: a game with a ball on the board waits."""
        self.menus.release_all()
        if self.is_playing:
            self.menus.open_pause()

    def lose_gamepad(self, title: str) -> None:
        """The gamepad or joystick that somebody plays with is gone: the game waits."""
        if self.is_playing:
            self.menus.open_pause()
            self.say(f"{title} is gone: the game waits")

    def set(self, **values: Any) -> None:
        """Change settings otherwise than in the menus, by a key for example."""
        self.use(self.settings.changed(**values))
        self.menus.use(self.settings)

    def _press_while_waiting(self, action: Action) -> None:
        """For the physics: what was chosen begins as soon as it is ready, unless the player goes back."""
        if action is Action.BACK:
            self._wish = None
            self.menus.open_main()
        else:
            self.say(WAIT)

    def _press_in_play(self, action: Action, again: bool, stage: GameSession) -> None:
        if stage.has_ended and action in (Action.CREATE, Action.BACK, Action.PAUSE):
            if self._ended_at is not None:  # its score is kept
                self._ended_at = self._now - OVER_SECONDS  # seen enough
        elif action is Action.CREATE:
            self._try(lambda: self._bring_ball(stage))
        elif action is Action.JITTER:
            self._try(stage.game.jitter)
        elif action is Action.PAUSE or action is Action.BACK:
            self.menus.open_pause()
        elif action is Action.NEW_BOARD:
            self._new_board(again)
        elif action in PADDLES and all(paddle.side != str(action) for paddle in self.table.paddle):
            self.say(f"this table has no {action} paddle")

    def _bring_ball(self, stage: GameSession) -> None:
        question = stage.bring_ball(self._key_of(Action.CREATE))
        if question:
            self.display.say(question, at_once=True)

    def _try(self, do: Callable[[], object]) -> None:
        try:
            do()
        except BoardFull:
            count = self.table.board.max_balls
            self.say("one ball is the most" if count == 1 else f"{count} balls are the most")
        except NoRoom:
            self.say("there is no room for a ball now")
        except SilverballError as reason:
            self.say(str(reason))

    def change_speed(self, step: int) -> None:
        """Slower (-1) or faster (+1), by one step."""
        self._speed = min(max(self._speed + step, 0), self._fastest)
        if isinstance(self.stage, GameSession):
            self.say("as fast as ever" if self.speed == 1.0 else f"{self.speed:g} of the speed")
        if self.speed < 1.0:
            self._no_longer_counts()

    @property
    def _fastest(self) -> int:
        """The place in SPEEDS beyond which nothing is made faster."""
        if isinstance(self.stage, GameSession):
            return AS_PLAYED
        most = self.cast.playing.fastest if isinstance(self.stage, DemoSession) else SPEEDS[-1]
        return max(place for place, speed in enumerate(SPEEDS) if speed <= most)

    def _no_longer_counts(self) -> None:
        stage = self.stage
        if self._counts and isinstance(stage, GameSession) and stage.game.mode is Mode.ARCADE:
            self._counts = False
            self.say("slowed down, this game no longer counts for the scores")

    # --- games --------------------------------------------------------------------------------------

    def get_ready(self) -> None:
        """The physics is loaded: do what somebody has asked for meanwhile."""
        self.is_ready = True
        wish, self._wish = self._wish, None
        if wish is not None:
            wish()

    def play(self, mode: Mode, table: str, seed: int | None = None) -> None:
        """Begin a game as soon as the physics is ready."""
        self.menus.close()
        if seed is None and self._is_fresh and table == self.settings.table:
            seed = self.seed  # the board that is seen is the one that is played
        if self._look_at(table, seed):
            self._when_ready(lambda: self.begin(mode))
        else:
            self.menus.open_main()

    def watch(self, replay: Replay) -> None:
        """Show a replay as soon as the physics is ready."""
        self._when_ready(lambda: self._show_replay(replay))

    def keep_last_game(self) -> None:
        """Keep the replay of the game that is played, if anything was played."""
        stage = self.stage
        if isinstance(stage, GameSession) and self._ended_at is None:
            if stage.has_ended:
                self._after_the_end(stage)
                return
            self.keeper.last_game(stage.game)
            self.menus.know(has_last_game=self.store.last_game() is not None)

    def give_up(self, stage: GameSession) -> None:
        """The player ends a game: it can be watched, but its score is not for the scores."""
        stage.game.end()
        self.keeper.last_game(stage.game)
        self.menus.know(has_last_game=self.store.last_game() is not None)

    def keep_file(self, what: str) -> Path | None:
        """Keep the replay of the game that is played as a file; where it is, None if it cannot be written."""
        return self.keeper.file(self.stage.game, what) if isinstance(self.stage, GameSession) else None

    def _when_ready(self, do: Callable[[], None]) -> None:
        if self.is_ready:
            do()
        else:
            self._wish = do
            self.say(WAIT)

    def _look_at(self, table: str, seed: int | None) -> bool:
        """Show another board; False, told why, and the old one, if it cannot be used."""
        try:
            self._see(self._library.recipe(table), seed)
        except SilverballError as error:
            self.say(trouble_of(table, error))
            return False
        return True

    def _see(self, recipe: Table, seed: int | None) -> None:
        """Show the board that a seed makes of a table, None drawing one."""
        seed = secrets.randbelow(SEEDS) if seed is None else seed
        self.table: Table = self._library.finished(recipe, seed)
        self.recipe: Table = recipe
        self.seed = seed
        self._is_fresh = True
        if recipe.random is not None:
            self.menus.know(last_seed=seed)

    def begin(self, mode: Mode) -> None:
        """Begin a game on the board that is seen; the physics is ready."""
        from silverball.game.game import Game

        self.keep_last_game()
        self.menus.close()
        self._is_fresh = False
        self._played = self.recipe  # its file may say something else before the game is over
        self._key = self._library.key(self.recipe)
        self._start(GameSession(Game(self.table, self.seed, mode)))

    def _start(self, stage: Session) -> None:
        self.stage = stage
        self.display = Display(self._key_of(Action.CREATE), is_calm=self.settings.effects == "less")
        self._speed, self.is_held, self._is_shown_off = AS_PLAYED, False, False
        self._ended_at, self._counts, self.ended = None, True, Ended()

    def _key_of(self, action: Action) -> str:
        """The first key of an action, as the display writes it."""
        return self.menus.key(action)

    def _new_board(self, again: bool) -> None:
        stage, before = self.stage, self.recipe
        mode = stage.game.mode if stage is not None else Mode(self.settings.mode)
        seed = self.seed if again else None
        words = ""
        try:
            self._see(self._library.recipe(self.settings.table), seed)
        except SilverballError as error:
            words = f"{trouble_of(self.settings.table, error)}. This is the table as it was"
            if not self._look_at_kept(before, seed):
                return
        self.menus.close()
        self._when_ready(lambda: self.begin(mode))
        self.say(words or self._board_words(before, again))

    def _look_at_kept(self, recipe: Table, seed: int | None) -> bool:
        """Show another board of a table that is at hand; False if no board comes of this seed."""
        try:
            self._see(recipe, seed)
        except SilverballError as error:
            self.say(str(error))
            return False
        return True

    def _board_words(self, before: Table, again: bool) -> str:
        """What there is to say of the board that has just been made."""
        news = f"{file_in_words(self.settings.table)} was read again" if self.recipe != before else ""
        if self.recipe.random is not None:
            key = self._key_of(Action.NEW_BOARD)
            words = (
                f"board {self.seed} from the start"
                if again
                else f"board {self.seed}. Shift+{key} plays it again"
            )
            return f"{news}: {words}" if news else words
        return news or f"{plain(self.table.name)} is always the same table; the balls come at other places"

    def _look_at_files(self) -> None:
        """Learn of table files that have come, gone or changed; tell if it is the one that is played."""
        if self._now - self._looked < LOOK_EVERY:
            return
        self._looked = self._now
        is_choosing = self.menus.is_open and not self.is_paused
        if self._library.look(whole=is_choosing) and is_choosing:
            self.menus.know(tables=self._library.entries())
        if isinstance(self.stage, ReplaySession | DemoSession):
            return  # when that is over, the file is read in any case
        reading = self._library.news()
        if reading is None or reading.table == self.recipe:
            return
        if self.stage is None:
            self._look_at(self.settings.table, self.seed)
            return
        file, key = (
            file_in_words(self.settings.table),
            self._key_of(Action.NEW_BOARD).replace("?", "a new game"),
        )
        if reading.table is not None:
            self.say(f"{file} has changed: {key} plays the new one")
        else:
            self.say(
                f"{trouble_words(self.settings.table, reading.problem)}. {key} plays the table as it was"
            )

    def _after_the_end(self, stage: GameSession) -> None:
        """Keep a game that is over at once, and show what comes after it when it has been seen."""
        if self._ended_at is None:
            self.ended = self.keeper.ended(
                stage.game, self._played or self.recipe, self.settings.initials, counts=self._counts
            )
            self.menus.know(has_last_game=True)
            if self.ended.words:
                self.say(self.ended.words)
            self._ended_at = self._now
        elif self._now - self._ended_at >= OVER_SECONDS and not self.menus.is_open:
            self.menus.open_over(stage.game.score, self.ended.rank)

    def _show_replay(self, replay: Replay) -> None:
        from silverball.game.replay.player import ReplayPlayer

        self.keep_last_game()
        self.recipe = self.table = replay.table
        self.seed = replay.seed
        stage = ReplaySession(ReplayPlayer(replay))
        self._start(stage)
        self.menus.open_transport(self._replay_face(stage))

    def show_off(self, player: str = BEST.name, *, nobody_there: bool = False) -> None:
        """Let the program play, as soon as the physics is ready; a stand-in plays until the player is."""
        self._when_ready(lambda: self._show_off(player, nobody_there))

    def _show_off(self, player: str, nobody_there: bool) -> None:
        wants_board = self.recipe.random is not None or self.stage is not None
        if wants_board and not self._look_at(self.settings.table, None) and not nobody_there:
            self.menus.reopen()
            return
        self._start(DemoSession(self.table, self.seed, self.cast.begin(player)))
        self._is_shown_off = nobody_there
        self._announce()

    def _announce(self) -> None:
        """Tell on the score display who plays while the program plays by itself."""
        self._speed = min(self._speed, self._fastest)
        self.display.performer = self.cast.playing.label
        self.menus.know(performer=self.cast.playing)

    def _stop_watching(self) -> None:
        if isinstance(self.stage, ReplaySession):
            self.end_watching()
        self.stage = None
        self.menus.reopen()

    def _replay_face(self, stage: ReplaySession) -> ReplayFace:
        player, rate = stage.player, stage.player.replay.tick_rate
        return ReplayFace(player.tick / rate, player.ticks / rate, self.speed, self.is_held, "REPLAY")

    def watch_text(self, text: str, source: str) -> None:
        """Show a replay, or tell why it cannot be played."""
        from silverball.game.replay.format import Replay

        try:
            self.watch(Replay.from_text(text, source))
        except SilverballError as error:
            self._refuse(error)

    def watch_score(self, number: int) -> None:
        """Show the game of a score, or tell why it cannot be played."""
        try:
            self.watch_text(self.store.replay(number), f"score {number}")
        except SilverballError as error:
            self._refuse(error)

    def end_watching(self) -> None:
        """Nobody watches any longer: the chosen table is seen again."""
        self.stage = None
        self._look_at(self.settings.table, self.menus.seed)

    def see_board(self, seed: int | None) -> None:
        """Show the board that a seed makes, unless a game is played."""
        if not self.has_game:
            self.stage = None
            self._look_at(self.settings.table, seed)

    def use(self, settings: Settings) -> None:
        """Use other settings and keep them."""
        changed = settings.table != self.settings.table
        values, before = settings.model_dump(mode="json"), self.settings.model_dump(mode="json")
        if self._is_blind:  # the others must stay what they are
            values = {name: value for name, value in values.items() if value != before[name]}
        self._take(settings)
        self.store.save_settings(values)
        if changed and not self.has_game:
            self.end_watching()

    def _take(self, settings: Settings) -> None:
        self.settings = settings
        self._library.choose(settings.table)

    def _refuse(self, error: SilverballError) -> None:
        self.say(str(error))
        self.menus.reopen()
