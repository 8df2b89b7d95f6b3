"""Sessions on the board: a game of the player, a replay, or a demo that the program plays by itself.

All three have one interface: `advance` takes ticks, `game` gives the picture and the events. None depends on
the window.
"""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Protocol

from silverball.app.automatic_game import AutomaticGame
from silverball.app.controls import PaddleInput
from silverball.errors import BoardFull, NoRoom
from silverball.game.tally import Tally
from silverball.game.view import GameView, Mode, Phase

if TYPE_CHECKING:
    from silverball.app.rival import Rival
    from silverball.game.core import GameCore
    from silverball.game.game import Game
    from silverball.game.replay.player import ReplayPlayer
    from silverball.players import Player
    from silverball.table import Table

DEMO_BALLS = 2  # balls of a demo at once, if the table allows them
DEMO_SECOND_BALL_DELAY = 4.0  # [s] between the first and the second ball of a demo
DEMO_BALL_DELAY = 1.0  # [s] between two balls of a demo
NEW_BALL_LOCK = 1.0  # [s] after a new ball in arcade, in which no other can be requested
CONFIRM_WITHIN = 3.0  # [s] for the second press that confirms an extra ball


class Session(Protocol):
    """A game, replay or demo that runs on the board."""

    @property
    def game(self) -> GameCore:
        """The game on screen."""

    @property
    def is_played(self) -> bool:
        """Whether the player's buttons move the paddles."""

    @property
    def has_ended(self) -> bool:
        """Whether the session has ended: `advance` changes nothing any more."""

    def advance(self, held: PaddleInput, ticks: int) -> None:
        """Advance by a number of ticks."""


class GameSession:
    """A game of the player, or a match of several in turn.

    Args:
        game: The game.
        rival: Who plays beside the player, if anybody.

    Attributes:
        tally: What has made the points.
    """

    is_played = True

    def __init__(self, game: Game, rival: Rival | None = None) -> None:
        self.game = game
        self.rival = rival
        self.tally = Tally(game.table, game.players)
        self._created_at = 0  # the tick of the last new ball
        self._requested_at: int | None = None  # the tick of a press that awaits confirmation

    @property
    def has_ended(self) -> bool:
        """Whether the game is over."""
        return self.game.is_over

    def create_ball(self, key: str) -> str:
        """Create a ball; in arcade an extra ball beside one in play must be requested twice.

        An extra ball is one of the few balls of the game, and an accidental press must not spend it: the
        first press only asks for confirmation, and presses just after a new ball are ignored. The game
        records only the balls that were created.

        Args:
            key: The key that creates a ball, as the display writes it.

        Returns:
            A message for the score display; empty if a ball was created.

        Raises:
            SilverballError: No ball can be created; the message says why.
        """
        view, tick = self.game.view, self.game.tick
        if view.phase is Phase.PLAY and _allows_extra_ball(view):
            if tick - self._created_at < NEW_BALL_LOCK * self.game.tick_rate:
                return f"BALL {view.ball} IS IN PLAY"
            if self._requested_at is None or tick - self._requested_at > CONFIRM_WITHIN * self.game.tick_rate:
                self._requested_at = tick
                return f"{key} AGAIN: BALL {view.ball + 1} OF {view.balls}"
        self.game.create_ball()
        self._created_at, self._requested_at = tick, None
        return ""

    def advance(self, held: PaddleInput, ticks: int) -> None:
        """Advance with the buttons held; a tap holds a paddle for one tick."""
        if ticks <= 0:
            return
        launch_first, launch_rest = held.launch
        if held.first != held.rest or launch_first != launch_rest:
            self._step(held.first, 1, launch_first)
            ticks -= 1
        if ticks > 0:
            self._step(held.rest, ticks, launch_rest)

    def _step(self, held: tuple[bool, bool], ticks: int, launch: bool) -> None:
        is_in_play = self.game.phase is Phase.PLAY
        self.game.step(*held, ticks, launch=launch)
        self.tally.add(self.game.events)
        if self.rival is not None and is_in_play:
            self.rival.advance(ticks)


class DemoSession(AutomaticGame):
    """A game that the program plays for spectators: arcade on tables with rules of their own, else free play.

    Args:
        table: The board.
        seed: The seed.
        player: Presses the paddle buttons.
        is_attract: Whether the attract mode has started it.

    Attributes:
        is_attract: Whether the attract mode has started it.
    """

    is_played = False
    game: Game

    def __init__(self, table: Table, seed: int, player: Player, *, is_attract: bool = False) -> None:
        from silverball.game.game import Game

        super().__init__(Game(table, seed, Mode.ARCADE if table.rule else Mode.FREE), player)
        self.is_attract = is_attract
        self._delay = 0.0  # [s] until the next ball may be created

    @property
    def has_ended(self) -> bool:
        """Whether the game is over; free play never is."""
        return self.game.is_over

    def advance(self, held: PaddleInput, ticks: int) -> None:
        """Advance by a number of ticks; `held` is ignored."""
        for _ in range(ticks):
            if self.has_ended:
                return
            self._create_balls()
            self.play_tick()

    def _create_balls(self) -> None:
        world = self.game.world
        self._delay = max(0.0, self._delay - 1.0 / world.tick_rate)
        count, is_arcade = len(world.balls), self.game.mode is Mode.ARCADE
        most = 1 if is_arcade else min(world.table.board.max_balls, DEMO_BALLS)
        if count >= most or self._delay > 0.0 or (is_arcade and self.game.phase is not Phase.READY):
            return
        with contextlib.suppress(BoardFull, NoRoom):
            self.game.create_ball()
        self._delay = DEMO_BALL_DELAY if count == 0 else DEMO_SECOND_BALL_DELAY


class ReplaySession:
    """A replay that is watched."""

    is_played = False

    def __init__(self, player: ReplayPlayer) -> None:
        self.player = player

    @property
    def game(self) -> GameCore:
        """The game at the current moment of the replay."""
        return self.player.game

    @property
    def has_ended(self) -> bool:
        """Whether the replay is at its end."""
        return self.player.at_end

    def advance(self, held: PaddleInput, ticks: int) -> None:
        """Advance by a number of ticks; `held` is ignored."""
        self.player.advance(ticks)


def _allows_extra_ball(view: GameView) -> bool:
    """Whether the player could create one of the remaining balls of a game now."""
    return 0 < view.ball < view.balls and view.on_board < view.max_balls and not view.tilted


def why_no_single_tick(session: Session | None) -> str:
    """Return why the session cannot be advanced by a single tick now."""
    if session is not None and session.has_ended:
        return "the replay has ended" if isinstance(session, ReplaySession) else "the game is over"
    if isinstance(session, ReplaySession):
        return "single ticks are only possible while the replay is paused"
    return "single ticks are only possible while the game is paused"
