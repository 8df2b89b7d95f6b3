"""Who can be watched while the program plays by itself, and who plays until that one is ready?

`PERFORMERS` are the built-in ones: the window makes them ready (`player_warmup.py`), and the first of them
plays when nobody is there. `performers` lists these and the registered players; the menu offers them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from silverball.app.sessions import DemoSession
    from silverball.players import Player


class Performer(NamedTuple):
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


PERFORMERS = (
    Performer("planner", "PLANNER", "LOOKS AHEAD", "plan_worlds", 2.0),
    Performer("trained", "TRAINED", "LEARNT BY TRIAL"),
    Performer("reflex", "REFLEX", "HITS WHAT COMES"),
)
HINT = "YOUR OWN"  # what a registered player does, as the score display writes it
BEST = PERFORMERS[0]
STAND_IN = next(performer for performer in PERFORMERS if performer.name == "reflex")  # ready with the physics


def performers() -> tuple[Performer, ...]:
    """Everyone who can be watched: `PERFORMERS`, then the players registered so far."""
    from silverball.players import registered_names

    return *PERFORMERS, *(Performer(name, name.upper(), HINT) for name in registered_names())


class DemoPlayers:
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
        self.asked = next(performer for performer in performers() if performer.name == name)
        return self._enter()

    def follow(self, stage: DemoSession) -> bool:
        """Let the one who was asked for take over as soon as it is ready; whether it has just done so."""
        if self.playing is self.asked or not self.is_ready(self.asked.name):
            return False
        stage.player = self._enter()
        return True

    def _enter(self) -> Player:
        from silverball.players import make_player

        self.playing = self.asked if self.is_ready(self.asked.name) else STAND_IN
        return make_player(self.playing.name)
