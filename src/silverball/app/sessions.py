"""What is going on on the board: somebody plays, a replay is watched, or the program plays by itself?

All three look the same from outside: ticks in, a world to draw, news to tell. No window in here.
"""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Protocol

from silverball.app.controls import Held
from silverball.errors import BoardFull, NoRoom
from silverball.game.view import GameEvent, GameView, Mode, Phase

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.game.game import Game
    from silverball.game.replay.player import ReplayPlayer
    from silverball.players import Player
    from silverball.table import Table
    from silverball.world import Event

SHOW_SECOND_BALL_AFTER = 4.0  # [s] of a ball alone, until the program brings another
SURE_AFTER = 1.0  # [s] after a ball has come in arcade, in which no other one can be asked for
SURE_WITHIN = 3.0  # [s] in which the second press must follow that spends another ball
SHOW_PAUSE = 1.0  # [s] between two balls that the program brings


class Session(Protocol):
    """What is going on on the board."""

    @property
    def game(self) -> GameCore:
        """The game that is seen."""

    @property
    def is_played(self) -> bool:
        """Whether the buttons move the paddles."""

    @property
    def has_ended(self) -> bool:
        """Whether nothing more will happen."""

    def advance(self, held: Held, ticks: int) -> None:
        """Move on by a number of ticks."""

    def take_world_events(self) -> list[Event]:
        """What happened on the board since this was last asked."""

    def take_game_events(self) -> list[GameEvent]:
        """What happened in the game since this was last asked."""


class GameSession:
    """Somebody plays a game."""

    is_played = True

    def __init__(self, game: Game) -> None:
        self.game = game
        self._launched = 0  # the tick at which a ball was brought last
        self._asked: int | None = None  # the tick of a press that would spend one more ball

    @property
    def has_ended(self) -> bool:
        """Whether the game is over."""
        return self.game.is_over

    def bring_ball(self, key: str) -> str:
        """Bring a ball; in arcade one more beside a ball in play only if it is asked for twice.

        Such a ball is one of the few of the game, and a press too many must not spend it: the first press is
        answered by a question, and just after a ball has come nothing is asked. All of that is the window's;
        the game knows only of balls that were brought.

        Args:
            key: What brings a ball, as the display writes it.

        Returns:
            What the score display must say; empty if a ball has come.

        Raises:
            SilverballError: There cannot be one more; the message says why.
        """
        face, tick = self.game.view, self.game.tick
        if face.phase is Phase.PLAY and _could_come(face):
            if tick - self._launched < SURE_AFTER * self.game.tick_rate:
                return f"BALL {face.ball} IS IN PLAY"
            if self._asked is None or tick - self._asked > SURE_WITHIN * self.game.tick_rate:
                self._asked = tick
                return f"{key} AGAIN: BALL {face.ball + 1} OF {face.balls}"
        self.game.create_ball()
        self._launched, self._asked = tick, None
        return ""

    def advance(self, held: Held, ticks: int) -> None:
        """Move on with the paddle buttons held; a tap holds a paddle for one tick."""
        if ticks <= 0:
            return
        if held.first != held.rest:
            self.game.step(*held.first, 1)
            ticks -= 1
        if ticks > 0:
            self.game.step(*held.rest, ticks)

    def take_world_events(self) -> list[Event]:
        """What happened on the board since this was last asked."""
        return list(self.game.take_world_events())

    def take_game_events(self) -> list[GameEvent]:
        """What happened in the game since this was last asked."""
        return list(self.game.take_game_events())


class DemoSession:
    """The program plays free play, for whoever looks on.

    Attributes:
        player: Who presses the buttons; another one may take over.
    """

    is_played = False
    has_ended = False

    def __init__(self, table: Table, seed: int, player: Player) -> None:
        from silverball.game.game import Game

        self.game = Game(table, seed, Mode.FREE)
        self.player = player
        self._wait = 0.0

    def advance(self, held: Held, ticks: int) -> None:
        """Move on by a number of ticks; `held` moves nothing."""
        for _ in range(ticks):
            self._bring_balls()
            self.game.step(*self.player.press(self.game.world), 1)

    def take_world_events(self) -> list[Event]:
        """What happened on the board since this was last asked."""
        return list(self.game.take_world_events())

    def take_game_events(self) -> list[GameEvent]:
        """What happened in the game since this was last asked."""
        return list(self.game.take_game_events())

    def _bring_balls(self) -> None:
        world = self.game.world
        self._wait = max(0.0, self._wait - 1.0 / world.tick_rate)
        count = len(world.balls)
        if count >= world.table.board.max_balls or self._wait > 0.0:
            return
        with contextlib.suppress(BoardFull, NoRoom):
            self.game.create_ball()
        self._wait = SHOW_PAUSE if count == 0 else SHOW_SECOND_BALL_AFTER


class ReplaySession:
    """A replay is watched."""

    is_played = False

    def __init__(self, player: ReplayPlayer) -> None:
        self.player = player

    @property
    def game(self) -> GameCore:
        """The game as it was at this moment."""
        return self.player.game

    @property
    def has_ended(self) -> bool:
        """Whether the replay has been played to its end."""
        return self.player.at_end

    def advance(self, held: Held, ticks: int) -> None:
        """Move on by a number of ticks; `held` moves nothing."""
        self.player.advance(ticks)

    def take_world_events(self) -> list[Event]:
        """What happened on the board since this was last asked."""
        return list(self.game.take_world_events())

    def take_game_events(self) -> list[GameEvent]:
        """What happened in the game since this was last asked."""
        return list(self.game.take_game_events())


def _could_come(face: GameView) -> bool:
    """Whether one of the balls left in a game of so many could come now."""
    return 0 < face.ball < face.balls and face.on_board < face.max_balls and not face.tilted


def why_no_tick(stage: Session | None) -> str:
    """Why nothing can be moved on by a single tick now."""
    if stage is not None and stage.has_ended:
        return "the game is over" if isinstance(stage, GameSession) else "the replay has ended"
    if isinstance(stage, ReplaySession):
        return "one tick at a time is for a replay that is held"
    return "one tick at a time is for a game that is paused"
