"""Code for environments whose episodes are games by the rules of a table.

    @for_games(read_board_score)
    @inlined
    def score_of(ptr: Pointers, index: int) -> int:
        ...

The addresses of such environments have more fields (`GAME_ARRAYS`). Called with them, the function below the
decorator is compiled; with the addresses of other environments it is the one in the decorator. So kernels as
`run_task` are compiled once for each, and without games they contain no code for them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from silverball.envs.pointers import GAME_MARK
from silverball.physics.code_cache import CodeCache
from silverball.physics.two_codes import F, two_codes

GAMES = "games-"  # begins the layout of code for games, in names of files


def for_games(otherwise: Callable[..., Any]) -> Callable[[F], F]:
    """Decorate a compiled function of the addresses of games.

    Args:
        otherwise: What takes its place in environments without games. It has the same parameters, the first
            of which are the addresses, and is not compiled itself; a kernel is compiled with its code.

    Raises:
        TypeError: The parameters differ.
    """
    return two_codes(
        otherwise, "without_games",
        lambda types: GAME_MARK not in getattr(types[0], "fields", ()),
        lambda values: GAME_MARK not in values[0].dtype.names,
    )  # fmt: skip


def _layout_of(argument_types: Any) -> str:
    """The layout of the worlds among argument types; where episodes are games it begins with "games-"."""
    layout = _layout_of_worlds(argument_types)
    has_games = any(GAME_MARK in getattr(_record_of(one), "fields", ()) for one in argument_types)
    return GAMES + layout if has_games else layout


def _record_of(one: Any) -> Any:
    return getattr(one, "dtype", one)


_layout_of_worlds = CodeCache.layout_of  # that of physics/for_devices.py, which `pointers` imports
CodeCache.layout_of = staticmethod(_layout_of)
