"""Who presses the buttons? Simple players, the planner, which looks ahead, and one that was trained.

`make_player(name)` makes one for a single `World`; `players.rollout.play` runs any of them over many worlds,
`metrics.ball_time.time_balls` measures how long they keep a ball.
"""

from __future__ import annotations

import difflib

from silverball.errors import SilverballError
from silverball.players.simple import KernelPlayer, Player, PlayerKind

__all__ = ["PLAYERS", "KernelPlayer", "Player", "PlayerKind", "make_player", "player_kind"]

PLAYERS = tuple(kind.name.lower() for kind in PlayerKind)
"""The names of all players."""


def player_kind(name: str) -> PlayerKind:
    """The player of a name.

    Raises:
        SilverballError: There is no player of that name.
    """
    if name in PLAYERS:
        return PlayerKind[name.upper()]
    near = difflib.get_close_matches(name, PLAYERS, 1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise SilverballError(f"no player is called {name!r}, there are {', '.join(PLAYERS)}{hint}")


def make_player(name: str) -> Player:
    """A player for a single world.

    Args:
        name: "idle" (presses nothing), "random" (holds and releases at random), "reflex" (hits what comes),
            "hold" (keeps both paddles up for ever), "planner" (plays copies of the world ahead) or "trained"
            (asks a small network).
    """
    kind = player_kind(name)
    if kind == PlayerKind.TRAINED:
        from silverball.players.trained import Trained

        return Trained()
    if kind == PlayerKind.PLANNER:
        from silverball.players.planner import Planner

        return Planner()
    return KernelPlayer(kind)
