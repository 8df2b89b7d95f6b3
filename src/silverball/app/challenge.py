"""A challenge: how many players take turns, who plays beside them, and on which seed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from silverball.app.demo_players import BEST_PLAYER, DemoPlayerSelector
from silverball.app.menus.commands import Rivalry
from silverball.app.rival import GhostRival, PlayerRival, Rival

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.game.scores.store import Score, Store


class Challenge(NamedTuple):
    """What is more than a game for points.

    Attributes:
        seed: The seed that was asked for, such as that of a day; None: any.
        players: How many take turns.
        rival: Who plays beside the player.
    """

    seed: int | None = None
    players: int = 1
    rival: Rivalry = Rivalry.NOBODY

    @property
    def is_special(self) -> bool:
        """Whether "play again" must begin the same challenge again."""
        return self.players > 1 or self.rival is not Rivalry.NOBODY


def ghost_of(score: Score | None, store: Store) -> Rival | None:
    """The ghost of a score; None if there is no score.

    Raises:
        SilverballError: Its replay is missing or cannot be played.
    """
    from silverball.game.replay.format import Replay

    if score is None:
        return None
    replay = Replay.from_text(store.replay(score.id), f"score {score.id}")
    return GhostRival(replay, score.initials)


def planner_beside(game: GameCore, players: DemoPlayerSelector) -> Rival:
    """The planner on the same board with the same seed, or the player that stands in until it is compiled."""
    player = players.select(BEST_PLAYER.name)
    return PlayerRival(game.table, game.seed, player, players.playing.label)
