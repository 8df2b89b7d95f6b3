"""The rules of a single game: one cheap call lets them act.

As in `world/single_step.py` the addresses of all arrays are stored once, because Numba unpacks every
argument at each call, which would take longer than the rules themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.physics.kernel import SETTINGS, bind_types, kernel
from silverball.physics.records import BOARD, COLLIDER, LOG
from silverball.referee.compile_rules import RuleBooks
from silverball.referee.game_records import (
    BANK_ROW,
    COUNTER_ROW,
    GAME,
    LAMP_ROW,
    MODE_ROW,
    OP,
    PART_ROW,
    REACH_ROW,
    REPORT,
    RULE,
    SETUP,
    Book,
    Field,
    Play,
)
from silverball.referee.judge import judge_between_steps
from silverball.world.single_step import INT, SHORT_INT, addresses_of, array_at, layout_of

FLOAT = np.dtype(np.float64)
ARRAYS = (
    "game", "report", "setup", "rules", "ops", "triggers", "listed", "parts", "lamps", "counters", "modes",
    "reaches", "banks", "world", "board", "colliders", "grid", "places", "log",
)  # fmt: skip

JUDGE_ADDRESSES = np.dtype([(name, "i8") for name in (*ARRAYS, *(f"{one}_length" for one in ARRAYS))])
"""Addresses of the arrays of a game, and their lengths."""


class SingleJudge:
    """Lets rules act on one game, in the arrays that it was made with."""

    def __init__(self, play: tuple[Any, Any], books: RuleBooks, field: tuple[Any, ...]) -> None:
        """Store the addresses.

        Args:
            play: The GAME and REPORT records, arrays of one.
            books: The compiled rules.
            field: The world, board, colliders, grid, places and log, all arrays.
        """
        arrays = (*play, books.setups, *books.book[1:], *field)
        self._arrays = dict(zip(ARRAYS, arrays, strict=True))
        self._addresses = np.zeros(1, addresses_of(self._arrays["world"].dtype, JUDGE_ADDRESSES))
        for name, array in self._arrays.items():
            self._addresses[0][name] = array.ctypes.data
            self._addresses[0][f"{name}_length"] = len(array)
        self._judge: Callable[[NDArray[Any], int, int], None] = (
            self._interpreted if SETTINGS.DISABLE_JIT else self._first
        )

    def __reduce__(self) -> Any:
        """Refuse copies: a copy would hold the addresses of the original's arrays."""
        raise TypeError("SingleJudge holds addresses and cannot be copied; copy the game that owns it")

    def judge(self, call: int, value: int = 0) -> None:
        """Let the rules act; see `referee.judge.judge`."""
        self._judge(self._addresses, int(call), value)

    def _interpreted(self, addresses: NDArray[Any], call: int, value: int) -> None:
        a = self._arrays
        book = Book(a["setup"][0], *(a[name] for name in ARRAYS[3:13]))
        field = Field(a["world"][0], a["board"][0], a["colliders"], a["grid"], a["places"], a["log"][0])
        judge_between_steps(Play(a["game"][0], a["report"][0]), book, field, call, value)

    def _first(self, addresses: NDArray[Any], call: int, value: int) -> None:
        self._judge = bound = bind_types(judge_single_game, addresses, call, value)
        bound(addresses, call, value)


@kernel
def judge_single_game(addresses: Any, call: int, value: int) -> None:
    """Let the rules act on the game at these addresses (see `JUDGE_ADDRESSES`), as `judge` does."""
    at = addresses[0]
    games, reports = array_at(at.game, (1,), GAME), array_at(at.report, (1,), REPORT)
    setups, rules = array_at(at.setup, (1,), SETUP), array_at(at.rules, (at.rules_length,), RULE)
    ops, triggers = array_at(at.ops, (at.ops_length,), OP), array_at(at.triggers, (at.triggers_length,), INT)
    listed = array_at(at.listed, (at.listed_length,), INT)
    parts = array_at(at.parts, (at.parts_length,), PART_ROW)
    lamps = array_at(at.lamps, (at.lamps_length,), LAMP_ROW)
    counters = array_at(at.counters, (at.counters_length,), COUNTER_ROW)
    modes = array_at(at.modes, (at.modes_length,), MODE_ROW)
    reaches = array_at(at.reaches, (at.reaches_length,), REACH_ROW)
    banks = array_at(at.banks, (at.banks_length,), BANK_ROW)
    worlds, logs = array_at(at.world, (1,), layout_of(at)), array_at(at.log, (1,), LOG)
    boards = array_at(at.board, (1,), BOARD)
    colliders = array_at(at.colliders, (at.colliders_length,), COLLIDER)
    grid = array_at(at.grid, (at.grid_length,), SHORT_INT)
    places = array_at(at.places, (at.places_length, 2), FLOAT)
    book = Book(setups[0], rules, ops, triggers, listed, parts, lamps, counters, modes, reaches, banks)
    field = Field(worlds[0], boards[0], colliders, grid, places, logs[0])
    judge_between_steps(Play(games[0], reports[0]), book, field, call, value)
