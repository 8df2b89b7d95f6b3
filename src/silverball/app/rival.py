"""Who plays beside you on the same seed: the best game so far as a ghost, or a player of the program.

A rival's time runs while you have a ball in play, and the waits between its balls are left out. So its score
is the one that it had after as much play, and whoever pauses loses nothing.
"""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Protocol

from silverball.app.automatic_game import AutomaticGame
from silverball.errors import BoardFull, NoRoom, SilverballError
from silverball.game.view import Mode, Phase

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.game.replay.format import Replay
    from silverball.players import Player
    from silverball.table import Table

SKIPPED_AT_ONCE = 2400  # [tick] of waiting that are left out in one call


class Rival(Protocol):
    """Somebody who plays beside the player.

    Attributes:
        label: Who it is, as the display writes it.
    """

    label: str

    @property
    def game(self) -> GameCore:
        """The game of the rival."""

    def advance(self, ticks: int) -> None:
        """Advance by ticks in which the player has a ball in play."""


class GhostRival:
    """A recorded game.

    Args:
        replay: The game.
        label: Whose it is.
    """

    def __init__(self, replay: Replay, label: str) -> None:
        from silverball.game.replay.player import Playback

        self.label = label
        self._playback = Playback(replay)
        self._is_stopped = False

    @property
    def game(self) -> GameCore:
        """The recorded game at this moment."""
        return self._playback.game

    def advance(self, ticks: int) -> None:
        """Advance the recorded game; one that does not match its record stops."""
        if self._is_stopped:
            return
        try:
            skipped = 0
            while self.game.phase is Phase.READY and skipped < SKIPPED_AT_ONCE and not self._playback.at_end:
                self._playback.advance(1)
                skipped += 1
            is_first = skipped > 0 and self.game.phase is Phase.PLAY  # one tick of the ball has been played
            self._playback.advance(ticks - is_first)
        except SilverballError:
            self._is_stopped = True


class PlayerRival(AutomaticGame):
    """A player of the program, who plays an arcade game on the same board with the same seed.

    Args:
        table: The board.
        seed: The seed.
        player: Presses the paddle buttons; may be replaced at any time.
        label: Its name.
    """

    def __init__(self, table: Table, seed: int, player: Player, label: str) -> None:
        from silverball.game.core import GameCore

        super().__init__(GameCore(table, seed, Mode.ARCADE), player)
        self.label = label

    def advance(self, ticks: int) -> None:
        """Play some ticks; a new ball comes at once."""
        game = self.game
        for _ in range(ticks):
            if game.is_over:
                return
            if game.phase is Phase.READY:
                with contextlib.suppress(BoardFull, NoRoom):
                    game.create_ball()
            self.play_tick()
            game.take_game_events()
            game.take_world_events()


def standing(rival: Rival) -> str:
    """How the rival stands, in the words of the display."""
    return f"{rival.label} {rival.game.score:,}" + (" DONE" if rival.game.is_over else "")


def outcome(score: int, rival: Rival) -> str:
    """How it ended, once the player's game is over."""
    its = rival.game.score
    if score > its:
        return f"{score - its:,} MORE THAN {rival.label}" if rival.game.is_over else f"AHEAD OF {rival.label}"
    return f"LEVEL WITH {rival.label}" if score == its else f"{its - score:,} BEHIND {rival.label}"
