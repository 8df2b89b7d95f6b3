"""Players press the buttons: simple ones, a planner that looks ahead, a trained one, and your own.

`make_player(name)` makes one for a single `World`, `players.rollout.play` lets one play many worlds, and
`metrics.ball_time.time_balls` measures how long it keeps a ball. `register` adds a player of your own.

Examples:
    >>> import silverball as sb
    >>> class Lifter:
    ...     def press(self, world):
    ...         return True, True
    >>> sb.players.register("lifter", Lifter)
    >>> sb.players.make_player("lifter").press(sb.World("classic"))
    (True, True)
    >>> sb.players.unregister("lifter")
"""

from __future__ import annotations

from silverball.players.registry import (
    BatchPlayer,
    Player,
    PlayerError,
    make_player,
    player_names,
    register,
    registered_names,
    unregister,
)

__all__ = [
    "BatchPlayer",
    "Player",
    "PlayerError",
    "make_player",
    "player_names",
    "register",
    "registered_names",
    "unregister",
]
