"""A game with its recording, as windows, films and programs play it.

Call `create_ball`, `step` with the buttons that are held, and `jitter`; read `view`, `events` and `score`;
save the `replay`. A game has no window and no clock.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from silverball.errors import SilverballError
from silverball.game.core import TICK_RATE, GameCore
from silverball.game.replay.format import Replay
from silverball.game.replay.recording import Recorder
from silverball.game.view import Mode

if TYPE_CHECKING:
    from silverball.game.rules import Rules
    from silverball.table import Table


class Game(GameCore):
    """A game on one board, from the first ball to the last, with a recording.

    Args:
        table: A table, a built-in name, or a path to a file. A recipe makes a board with the seed.
        seed: Seed of everything random, 0 to 2⁶³ − 1. The same table, seed, rules and inputs give the same
            game bit for bit.
        mode: "arcade" (three balls, combos, tilt) or "free" (any number of balls); a `Mode` or its string.
        tick_rate: Ticks per second, 10 to 1,000.
        rules: Custom rules in place of those of the mode; see `Rules`. Such a game never enters the
            score lists.
        players: How many play in turn, 1 to 4: the machine is handed on after each ball, and each has a
            score, balls and missions of their own (`scores`). Arcade only.

    Attributes:
        world: The world that is played. Read it, but change it only through the game.
        mode: The mode.
        fault: The fault of the world that ended the game, or None.

    Raises:
        TableError: The table cannot be used.
        ValueError: A mode, seed, tick rate or number of players that does not exist, or rules with a name
            that they cannot have.

    Examples:
        >>> import silverball as sb
        >>> game = sb.Game("classic", seed=7, mode="arcade")
        >>> game.create_ball()
        >>> game.step(left=True, ticks=240)
        >>> game.view.ball, game.view.balls
        (1, 3)
        >>> game.replay.verify().ok
        True
    """

    def __init__(
        self,
        table: Table | str | os.PathLike[str],
        seed: int = 0,
        mode: Mode | str = Mode.ARCADE,
        tick_rate: int = TICK_RATE,
        *,
        rules: Rules | None = None,
        players: int = 1,
    ) -> None:
        super().__init__(table, seed, mode, tick_rate, rules=rules, players=players)
        self._recorder: Recorder | None = Recorder(self.tick_rate)

    @property
    def replay(self) -> Replay:
        """The recording so far; complete at any time, whether or not the game is over.

        Raises:
            SilverballError: The game was restored to another moment, so that its recording has a gap.
        """
        if self._recorder is None:
            raise SilverballError("this game has no replay: it was restored to another moment")
        return Replay.of(
            self.world,
            self.mode,
            lines=tuple(self._recorder.lines),
            tail=self._recorder.inputs,
            score=self.score,
            ended=self.ended,
            digest=self.digest(),
            rules=self._custom_rules_name,
            players=self.players,
        )

    def restore(self, state: bytes) -> None:
        """Go back or ahead to a saved moment, bit for bit; from then on the game has no replay.

        Events that were not taken are dropped.

        Raises:
            StateError: The bytes are damaged, or of another table, tick rate, mode or rules; nothing has
                changed.
        """
        super().restore(state)
        self._recorder = None

    def _record_input(self, kind: str) -> None:
        if self._recorder is not None:
            self._recorder.add_input(self.tick, kind)

    def _record_second(self) -> None:
        if self._recorder is not None:
            self._recorder.end_second(self.short_digests)
            if self._recorder.is_full:
                self.end()
