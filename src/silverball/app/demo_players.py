"""Who can be watched while the program plays by itself, and who plays until that one is ready?

`DEMO_PLAYERS` is the one list: the menu offers it, the window makes its players ready (`player_warmup.py`),
and the
first of it plays when nobody is there. To add one, add its line.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from silverball.app.sessions import DemoSession
    from silverball.players import Player


class DemoPlayer(NamedTuple):
    """A player that can be watched.

    Attributes:
        name: For `make_player`.
        label: As the score display writes it.
        hint: What it does, as the score display writes it.
        kernel: What must be compiled for it besides the physics; empty if nothing.
        fastest: At most so many seconds of play for a second of real time, since it has to think.
    """

    name: str
    label: str
    hint: str
    kernel: str = ""
    fastest: float = 16.0


DEMO_PLAYERS = (
    DemoPlayer("planner", "PLANNER", "LOOKS AHEAD", "plan_worlds", 2.0),
    DemoPlayer("trained", "TRAINED", "LEARNT BY TRIAL"),
    DemoPlayer("reflex", "REFLEX", "HITS WHAT COMES"),
)
BEST_PLAYER = DEMO_PLAYERS[0]
STAND_IN = next(
    demo_player for demo_player in DEMO_PLAYERS if demo_player.name == "reflex"
)  # ready with the physics


class DemoPlayerSelector:
    """Who plays: whoever was asked for, or the stand-in until that one is ready.

    Args:
        is_ready: Whether the player of a name can play without a wait.

    Attributes:
        asked: Who was asked for.
        playing: Who plays.
    """

    def __init__(self, is_ready: Callable[[str], bool] = lambda name: name == STAND_IN.name) -> None:
        self.is_ready = is_ready
        self.asked = self.playing = STAND_IN

    def begin(self, name: str) -> Player:
        """Ask for a player, and have one that plays at once."""
        self.asked = next(demo_player for demo_player in DEMO_PLAYERS if demo_player.name == name)
        return self._enter()

    def follow(self, session: DemoSession) -> bool:
        """Let the one who was asked for take over as soon as it is ready; whether it has just done so."""
        if self.playing is self.asked or not self.is_ready(self.asked.name):
            return False
        session.player = self._enter()
        return True

    def _enter(self) -> Player:
        from silverball.players import make_player

        self.playing = self.asked if self.is_ready(self.asked.name) else STAND_IN
        return make_player(self.playing.name)
