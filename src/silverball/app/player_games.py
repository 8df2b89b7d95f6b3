"""Games of the player: how they begin, what goes along with them, and how they end."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from silverball.app.challenge import Challenge, ghost_of, planner_beside
from silverball.app.controls import Action
from silverball.app.demo_players import DemoPlayerSelector
from silverball.app.game_archive import GameArchive, GameResult
from silverball.app.guide import Guide, PlungerReminder, launch_text
from silverball.app.menus.commands import Play, Rivalry
from silverball.app.moments import game_over
from silverball.app.rival import PlayerRival, Rival, standing
from silverball.app.sessions import GameSession
from silverball.errors import SilverballError
from silverball.game.mechanisms import plungers
from silverball.game.view import Mode

if TYPE_CHECKING:
    from silverball.app.catalog import Catalog, ScoreKey
    from silverball.app.machine import Machine
    from silverball.app.sessions import Session
    from silverball.game.game import Game
    from silverball.game.scores.store import Store
    from silverball.table import Table

GAME_OVER_SECONDS = 2.5  # [s] how long the end of a game is shown before a menu page opens
SLOWED = "slowed down: this game no longer counts for the high scores"


class PlayerGames:
    """Begins, accompanies and ends the player's games.

    Args:
        machine: What they run on.
        store: Scores, settings and the last game.
        catalog: The tables and scores.
        is_player_ready: Returns whether a player of the program, by name, can play without a delay.

    Attributes:
        archive: Saves games in the store.
        result: Rank, score id and message of the last finished game.
        guide: The hints of a first game; None after it.
        kept_rank: The missions that earlier games on the table of the current one have finished.
    """

    def __init__(
        self, machine: Machine, store: Store, catalog: Catalog, is_player_ready: Callable[[str], bool]
    ) -> None:
        self._machine, self._store, self._catalog = machine, store, catalog
        self.archive = GameArchive(store, catalog)
        self.result = GameResult()
        self.guide: Guide | None = None
        self._reminder: PlungerReminder | None = None
        self.kept_rank = 0
        self._rival_players = DemoPlayerSelector(is_player_ready)
        self._challenge = Challenge()
        self._ended_at: float | None = None  # when the current game ended
        self._is_ranked = True  # whether the score of the current game may enter the high scores
        self._recipe: Table | None = None  # the table that the board of the current game was made from
        self._score_key: ScoreKey | None = None  # the score list of the current game
        self.update_last_game()

    @property
    def best_score(self) -> int:
        """The best score so far in the list of the player's game; 0 if there is none."""
        session, key = self._machine.session, self._score_key
        if session is None or not session.is_played or key is None:
            return 0
        return self._catalog.best(key, session.game.mode)

    # --- the beginning ------------------------------------------------------------------------------

    def seed_for(self, table: str, challenge: Challenge) -> int | None:
        """Return the seed of a game to begin on a table; None draws one."""
        best = self._catalog.best_score(table) if challenge.rival is Rivalry.BEST else None
        if best is not None:
            return best.seed
        board = self._machine.board
        if challenge.seed is None and board.is_unplayed and table == self._machine.settings.current.table:
            return board.seed  # play on the board on screen
        return challenge.seed

    def begin(self, mode: Mode, challenge: Challenge = Challenge()) -> None:  # noqa: B008
        """Begin a game on the board on screen; the physics must be ready."""
        from silverball.game.game import Game

        machine, board = self._machine, self._machine.board
        self.save_last_game()
        machine.menus.close()
        board.is_unplayed = False
        self._recipe = board.recipe  # its file may change before the game is over
        self._score_key = self._catalog.score_key(board.recipe)
        self.kept_rank = self._store.rank(mode, self._score_key.digest)
        game = Game(board.table, board.seed, mode, players=challenge.players)
        session = GameSession(game, self._make_rival(challenge.rival, game))
        machine.start(session)
        self._ended_at, self._is_ranked, self.result = None, True, GameResult()
        self._challenge = challenge
        is_guided = machine.settings.current.is_guided
        self.guide = None if is_guided else Guide(game, machine.menus.context.key_label)
        self._reminder = PlungerReminder(game, machine.menus.context.key_label)
        if mode is Mode.ARCADE and plungers(game.table):
            with suppress(SilverballError):
                self.create_ball(session)  # the first ball lies on the plunger

    def begin_again(self, session: GameSession) -> None:
        """Begin the game of a session again, on the same board."""
        self.begin(session.game.mode, self._challenge)

    def _make_rival(self, rival: Rivalry, game: Game) -> Rival | None:
        """Make the rival of a game; None if there is none, or its replay cannot be played."""
        table = self._machine.settings.current.table
        try:
            if rival is Rivalry.PLANNER:
                return planner_beside(game, self._rival_players)
            if rival is not Rivalry.NOBODY:
                seed = game.seed if rival is Rivalry.TODAY else None
                return ghost_of(self._catalog.best_score(table, seed), self._store)
        except SilverballError as error:
            self._machine.show_message(str(error))
        return None

    # --- in play ------------------------------------------------------------------------------------

    def update(self) -> None:
        """Do what is due in a frame of the player's game, if there is one."""
        session = self._machine.session
        if not isinstance(session, GameSession):
            return
        if session.has_ended:
            self._finish(session)
        else:
            self._accompany(session)

    def _accompany(self, session: GameSession) -> None:
        """Do what goes along with a game: hints in the first one, and a rival whose player is compiled."""
        if isinstance(session.rival, PlayerRival) and self._rival_players.switch_when_ready(session.rival):
            session.rival.label = self._rival_players.playing.label
        self._count_bonus(session)
        if not self._machine.is_moving or self._machine.display.is_telling:
            return  # a hint replaces no answer to a button
        guides = [guide for guide in (self.guide, self._reminder) if guide is not None]
        hint = next((text for guide in guides if (text := guide.hint())), "")
        if hint:
            self._machine.display.show_message(hint)

    def _count_bonus(self, session: GameSession) -> None:
        """Count out the bonus of a ball that was just lost."""
        bonus = session.tally.take_bonus()
        if bonus:
            self._machine.display.count_bonus(bonus)

    def create_ball(self, session: GameSession) -> None:
        """Create a ball, or ask on the display whether to spend one.

        On a table with a plunger the balls of an arcade game come one after the other.

        Raises:
            SilverballError: No ball can be created; the message says why.
        """
        has_plunger = bool(plungers(session.game.table))
        if has_plunger and session.game.mode is Mode.ARCADE and session.game.view.on_board:
            return
        key, display = self._machine.key_label(Action.CREATE), self._machine.display
        question = session.create_ball(key)
        if question:
            display.show_message(question, replace=True)
        elif has_plunger:
            display.show_message(launch_text(self._machine.menus.context.key_label), replace=True)

    def exclude_from_scores(self) -> None:
        """Keep the score of the current game out of the high scores, and say so once."""
        session = self._machine.session
        if self._is_ranked and isinstance(session, GameSession) and session.game.mode is Mode.ARCADE:
            self._is_ranked = False
            self._machine.show_message(SLOWED)

    # --- the end ------------------------------------------------------------------------------------

    def end(self) -> None:
        """End the player's game early: it can be watched, but its score is not ranked."""
        session = self._machine.session
        if isinstance(session, GameSession) and not session.has_ended:
            self._end_guide()
            session.game.end()
            self.archive.save_last_game(session.game)
            self.update_last_game()
        self._machine.session = None

    def skip_game_over(self) -> None:
        """Open the page after a game now; the score must have been saved."""
        if self._ended_at is not None:
            self._ended_at = self._machine.now - GAME_OVER_SECONDS

    def _finish(self, session: GameSession) -> None:
        """Save a finished game in the first frame; open the next page after `GAME_OVER_SECONDS`."""
        machine = self._machine
        if self._ended_at is None:
            recipe, initials = self._recipe or machine.board.recipe, machine.settings.current.initials
            self.result = self.archive.save_finished_game(
                session.game, recipe, initials, is_ranked=self._is_ranked
            )
            machine.menus.context.has_last_game = True
            if self.result.message:
                machine.show_message(self.result.message)
            self._ended_at = machine.now
            self._count_bonus(session)
            self._end_guide()
        elif machine.now - self._ended_at >= GAME_OVER_SECONDS and not machine.menus.is_open:
            self._open_over(session)

    def _open_over(self, session: GameSession) -> None:
        """Show what a game came to."""
        key, mode = self._score_key, session.game.mode
        again = None
        if self._challenge.is_special:
            again = Play(mode, self._machine.settings.current.table, *self._challenge)
        rows = self._catalog.rows(key, mode) if key is not None else []
        rank = self._store.rank(mode, key.digest) if key is not None else 0
        what = game_over(session, self.result, rows, again, rank)
        self._machine.menus.open_over(session.game.score, what=what)

    def _end_guide(self) -> None:
        """Never guide again, once the first game is over."""
        if self.guide is not None:
            self.guide = None
            self._machine.settings.change(is_guided=True)

    # --- saving -------------------------------------------------------------------------------------

    def save_last_game(self) -> None:
        """Save the player's game as the last one, if a ball was created."""
        session = self._machine.session
        if isinstance(session, GameSession) and self._ended_at is None:
            if session.has_ended:
                self._finish(session)
                return
            self.archive.save_last_game(session.game)
            self.update_last_game()

    def save_replay_file(self, name: str) -> Path | None:
        """Save the replay of the player's game as a file; None if it cannot be written."""
        session = self._machine.session
        return self.archive.save_replay_file(session.game, name) if isinstance(session, GameSession) else None

    def update_last_game(self) -> None:
        """Note for the menus whether there is a last game to watch."""
        self._machine.menus.context.has_last_game = self._store.last_game() is not None


def note_of(session: Session | None) -> str:
    """Return what the display tells beside the score: how the rival stands, or who is up in a match."""
    if not isinstance(session, GameSession):
        return ""
    if session.rival is not None:
        return standing(session.rival)
    return f"PLAYER {session.game.view.player}" if session.game.players > 1 else ""
