"""The players of a demo, and the fallback that plays until the requested one is compiled.

`DEMO_PLAYERS` are the built-in ones: `player_warmup.py` compiles them, and the first one plays in the attract
mode. `demo_players` lists these and the registered players; the menu offers them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, Protocol

if TYPE_CHECKING:
    from silverball.game.core import GameCore
    from silverball.players import Player


class DemoPlayer(NamedTuple):
    """A player for demos.

    Attributes:
        name: Name for `make_player`.
        label: Its name on the score display.
        hint: A short description on the score display.
        kernel: The last kernel that is compiled for it in addition to the physics; empty if there is none.
        max_speed: Seconds of play per second of real time that it can compute.
    """

    name: str
    label: str
    hint: str
    kernel: str = ""
    max_speed: float = 16.0


DEMO_PLAYERS = (
    DemoPlayer("planner", "PLANNER", "LOOKS AHEAD", "plan_worlds", 2.0),
    DemoPlayer("trained", "TRAINED", "TRAINED BY PPO"),
    DemoPlayer("reflex", "REFLEX", "HITS EVERY BALL"),
)
REGISTERED_HINT = "YOUR OWN"  # hint of a registered player
BEST_PLAYER = DEMO_PLAYERS[0]
FALLBACK_PLAYER = next(one for one in DEMO_PLAYERS if one.name == "reflex")  # needs no kernel of its own


def demo_players() -> tuple[DemoPlayer, ...]:
    """All players for demos: `DEMO_PLAYERS`, then the players registered so far."""
    from silverball.players import registered_names

    return *DEMO_PLAYERS, *(DemoPlayer(name, name.upper(), REGISTERED_HINT) for name in registered_names())


class Played(Protocol):
    """What a player of the program plays: a demo, or the game of a rival.

    Attributes:
        player: The player, who may be replaced at any time.
    """

    player: Player


def introduce(player: Player, game: GameCore) -> None:
    """Tell a player which game it plays, if it wants to know: the planner then aims at what is lit."""
    watch = getattr(player, "watch", None)
    if watch is not None:
        watch(game)


class DemoPlayerSelector:
    """Selects the player of a demo: the requested one, or the fallback until that one is ready.

    Args:
        is_ready: Returns whether a player, by name, can play without a delay.

    Attributes:
        requested: The requested player.
        playing: The current player.
    """

    def __init__(self, is_ready: Callable[[str], bool] = lambda name: name == FALLBACK_PLAYER.name) -> None:
        self.is_ready = is_ready
        self.requested = self.playing = FALLBACK_PLAYER

    def select(self, name: str) -> Player:
        """Request a player; return it, or the fallback if it is not ready."""
        self.requested = next(one for one in demo_players() if one.name == name)
        return self._make()

    def switch_when_ready(self, session: Played) -> bool:
        """Switch to the requested player once it is ready; return whether this call switched."""
        if self.playing is self.requested or not self.is_ready(self.requested.name):
            return False
        session.player = self._make()
        return True

    def _make(self) -> Player:
        from silverball.players import make_player

        self.playing = self.requested if self.is_ready(self.requested.name) else FALLBACK_PLAYER
        return make_player(self.playing.name)
