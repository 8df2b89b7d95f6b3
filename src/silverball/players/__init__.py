"""Who presses the buttons? The players: idle, random, reflex, hold and the planner, which looks ahead.

`make_player(name)` gives one for a single `World`; `silverball.players.games.play` runs any of them over many
worlds, `silverball.players.ball_time.time_balls` measures how long they keep a ball.

The soak, which presses at random to break the solver, lives here too: `hostile.py` makes its boards,
`drive.py` presses, `watch.py` looks, `soak.py` runs the rounds, `soaklog.py` and `finding.py` keep what was
found.
"""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from silverball.errors import SilverballError
from silverball.players.press import Player, PlayerKind

if TYPE_CHECKING:
    from silverball.players.planner import Planner

__all__ = ["PLAYERS", "Player", "PlayerKind", "make_player", "player_kind"]

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


def make_player(name: str) -> Player | Planner:
    """A player for a single world.

    Args:
        name: "idle" (presses nothing), "random" (holds and releases at random), "reflex" (hits what comes),
            "hold" (keeps both paddles up for ever) or "planner" (plays copies of the world ahead).
    """
    kind = player_kind(name)
    if kind == PlayerKind.PLANNER:
        from silverball.players.planner import Planner

        return Planner()
    return Player(kind)
