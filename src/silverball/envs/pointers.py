"""Addresses of the environments' arrays in one ADDRESSES record, and views that turn them into arrays.

A kernel with thirty array arguments would be slow to call and to compile. Instead, one record holds the
addresses and lengths of all arrays (see world/single_step.py). Kernels pass it to each other, and a view like
`worlds(ptr)` makes an array where it is needed. The owner of the record must keep the arrays alive.
"""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numba import types
from numpy.typing import NDArray

from silverball.envs.state import CONTROL, EPISODE, PICTURE_STATE, PICTURED_BOARD, PIECE, RASTER, RULES
from silverball.physics.kernel import SETTINGS, ir_inlined
from silverball.physics.records import BOARD, COLLIDER, LOG
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
)
from silverball.world.single_step import (
    BOOL,
    INT,
    SHORT_INT,
    array_at,
    cgutils,
    intrinsic,
    layout_of,
)

FLOAT, SMALL_FLOAT, BYTE = np.dtype(np.float64), np.dtype(np.float32), np.dtype(np.uint8)

Pointers: TypeAlias = Any
"""An ADDRESSES record."""


@intrinsic  # type: ignore[untyped-decorator]
def _compiled_copy(typing_context: Any, target: Any, source: Any, count: Any) -> Any:
    """Copy bytes from one address to another; the ranges must not overlap."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointers = [builder.inttoptr(address, cgutils.voidptr_t) for address in arguments[:2]]
        cgutils.raw_memcpy(builder, *pointers, arguments[2], 1)
        return context.get_dummy_value()

    return types.none(types.int64, types.int64, types.int64), generate


def _interpreted_copy(target: int, source: int, count: int) -> None:
    """Copy bytes like `_compiled_copy`, without the compiler."""
    ctypes.memmove(int(target), int(source), int(count))


copy_bytes: Any = _interpreted_copy if SETTINGS.DISABLE_JIT else _compiled_copy


class ArrayType(NamedTuple):
    """Element type of an array, and the names of its axes; axes of one name have one length.

    The type None is that of the worlds' records: WORLD or PLAIN_WORLD.
    """

    dtype: np.dtype[Any] | None
    axes: tuple[str, ...]


def _array(dtype: np.dtype[Any] | None, *axes: str) -> ArrayType:
    return ArrayType(dtype, axes)


OUTPUTS = {
    "observations": _array(SMALL_FLOAT, "envs", "columns"),
    "rewards": _array(FLOAT, "envs"),
    "terminated": _array(BOOL, "envs"),
    "truncated": _array(BOOL, "envs"),
    "counts": _array(INT, "envs", "info"),  # see `state.ALL_INFO`
    "frames": _array(BYTE, "envs", "ring", "pixels"),  # a ring of pictures
    "copies": _array(BYTE, "envs", "copied", "pixels"),  # of the window of the ring
}
"""The arrays that a step writes its results to."""

ARRAYS = {
    **OUTPUTS,
    "worlds": _array(None, "envs"),
    "boards": _array(BOARD, "boards"),
    "board_of": _array(INT, "envs"),  # the board of each world
    "board_seeds": _array(INT, "boards"),
    "colliders": _array(COLLIDER, "colliders"),  # of all boards
    "grid": _array(SHORT_INT, "grid_numbers"),  # of all boards
    "places": _array(FLOAT, "places", "x_and_z"),  # squares in which balls are created
    "logs": _array(LOG, "envs"),  # events of the last step
    "tallies": _array(INT, "envs", "parts"),  # hits of each part
    "held": _array(BOOL, "one", "envs", "buttons"),  # the buttons for run_worlds
    "episodes": _array(EPISODE, "envs"),
    "controls": _array(CONTROL, "controlled"),  # one for each environment, or none
    "blanks": _array(None, "boards"),  # new worlds
    "layouts": _array(SMALL_FLOAT, "boards", "layout_columns"),  # obstacles, in the form of an observation
    "rules": _array(RULES, "one"),
    "raster": _array(RASTER, "one"),
    "actions": _array(INT, "envs"),
    "reset_mask": _array(BOOL, "envs"),
    "requested_boards": _array(INT, "envs"),  # of the next episode; −1: it is drawn
    "terms": _array(FLOAT, "rewarded", "terms"),  # of the last step's rewards, see `rewards.TERMS`
    "counts_before": _array(INT, "rewarded", "counters"),  # before the step; a slice uses its first rows
    "finals": _array(
        SMALL_FLOAT, "ended", "columns"
    ),  # last observations of episodes that ended in this step
    "final_counts": _array(INT, "ended", "info"),
    "picture_states": _array(PICTURE_STATE, "envs", "stack"),  # of the window, the newest last
    "final_picture_states": _array(PICTURE_STATE, "ended", "stack"),
    "drawn": _array(PICTURE_STATE, "envs", "ring"),  # what the frames show
    "backgrounds": _array(BYTE, "boards", "pixels"),  # the static parts of each board
    "ball_sprites": _array(BYTE, "ball_pixels"),
    "paddle_sprites": _array(BYTE, "paddle_pixels"),
    "pictured_boards": _array(PICTURED_BOARD, "boards"),
    "lamp_of": _array(INT, "boards", "lit_parts"),  # the lamp of each part, or −1
    "pieces": _array(PIECE, "pieces"),  # lamps, and what switches remove
    "masks": _array(BYTE, "mask_pixels"),
}
"""All arrays by name. An ADDRESSES record holds the address of each, and the length of each axis."""

GAME_ARRAYS = {
    "games": _array(GAME, "envs"),
    "blank_games": _array(GAME, "boards"),  # games that have not begun
    "reports": _array(REPORT, "envs"),  # scratch; games of a block use that of its first environment
    "seen": _array(INT, "envs"),  # points of the hits that each game was told of
    "setups": _array(SETUP, "boards"),
    "rule_rows": _array(RULE, "rule_count"),
    "op_rows": _array(OP, "op_count"),
    "trigger_rows": _array(INT, "trigger_count"),
    "listed_rows": _array(INT, "listed_count"),
    "part_rows": _array(PART_ROW, "part_count"),
    "lamp_rows": _array(LAMP_ROW, "lamp_count"),
    "counter_rows": _array(COUNTER_ROW, "counter_count"),
    "mode_rows": _array(MODE_ROW, "mode_count"),
    "reach_rows": _array(REACH_ROW, "reach_count"),
    "bank_rows": _array(BANK_ROW, "bank_count"),
    "counter_scales": _array(FLOAT, "counter_count"),  # see `game_arrays.counter_scales`
    "happened": _array(INT, "envs", "happenings"),  # events of the episode so far, see `Happening`
    "happened_before": _array(INT, "rewarded", "noted"),  # before the step; a slice uses its first rows
    "game_weights": _array(FLOAT, "noted"),  # of the growth of each happening and counter
}
"""The further arrays of environments whose episodes are games: their games, and the compiled rules."""

GAME_MARK = "games_at"
"""A field that only the addresses of such environments have (see `for_games.py`)."""


def _addresses(arrays: dict[str, ArrayType]) -> np.dtype[Any]:
    """The record of the addresses of some arrays."""
    axes = dict.fromkeys(axis for array in arrays.values() for axis in array.axes)
    return np.dtype([*((f"{name}_at", "i8") for name in arrays), *((axis, "i8") for axis in axes)])


ALL_ARRAYS = {**ARRAYS, **GAME_ARRAYS}
ADDRESSES, GAME_ADDRESSES = _addresses(ARRAYS), _addresses(ALL_ARRAYS)


def write_addresses(addresses: NDArray[Any], arrays: dict[str, NDArray[Any]]) -> None:
    """Write the addresses of all arrays, and the lengths of their axes, into an ADDRESSES record [1].

    Raises:
        ValueError: Two arrays disagree about the length of an axis.
    """
    lengths: dict[str, int] = {}
    known = ALL_ARRAYS if GAME_MARK in (addresses.dtype.names or ()) else ARRAYS
    for name, (_, axes) in known.items():
        addresses[f"{name}_at"] = arrays[name].ctypes.data
        for axis, length in zip(axes, arrays[name].shape, strict=True):
            if lengths.setdefault(axis, length) != length:
                raise ValueError(
                    f"axis {axis!r} of {name} must have the length {lengths[axis]}, got {length}"
                )
            addresses[axis] = length


def _view(name: str) -> Any:
    """The function that makes an array from an ADDRESSES record, for kernels."""
    address, (dtype, axes) = f"{name}_at", ALL_ARRAYS[name]
    if dtype is None:
        (length,) = axes

        def view(ptr: Pointers) -> Any:
            return array_at(ptr[address], (ptr[length],), layout_of(ptr))

    elif len(axes) == 1:
        (length,) = axes

        def view(ptr: Pointers) -> Any:
            return array_at(ptr[address], (ptr[length],), dtype)

    elif len(axes) == 2:
        rows, columns = axes

        def view(ptr: Pointers) -> Any:
            return array_at(ptr[address], (ptr[rows], ptr[columns]), dtype)

    else:
        first, second, third = axes

        def view(ptr: Pointers) -> Any:
            return array_at(ptr[address], (ptr[first], ptr[second], ptr[third]), dtype)

    return ir_inlined(view)


rewards, terminated, truncated = _view("rewards"), _view("terminated"), _view("truncated")
worlds, boards, board_of, board_seeds = (
    _view("worlds"),
    _view("boards"),
    _view("board_of"),
    _view("board_seeds"),
)
colliders, grid, places = _view("colliders"), _view("grid"), _view("places")
blanks, controls = _view("blanks"), _view("controls")
logs, tallies, held = _view("logs"), _view("tallies"), _view("held")
episodes, rules, raster = _view("episodes"), _view("rules"), _view("raster")
actions, reset_mask, requested_boards = _view("actions"), _view("reset_mask"), _view("requested_boards")
terms, counts_before = _view("terms"), _view("counts_before")
picture_states, final_picture_states = _view("picture_states"), _view("final_picture_states")
drawn = _view("drawn")
pictured_boards, lamp_of, pieces, masks = (
    _view("pictured_boards"),
    _view("lamp_of"),
    _view("pieces"),
    _view("masks"),
)
games, blank_games, reports, seen = _view("games"), _view("blank_games"), _view("reports"), _view("seen")
setups, rule_rows, op_rows, trigger_rows = (
    _view("setups"),
    _view("rule_rows"),
    _view("op_rows"),
    _view("trigger_rows"),
)
listed_rows, part_rows, lamp_rows = _view("listed_rows"), _view("part_rows"), _view("lamp_rows")
counter_rows, mode_rows, reach_rows = _view("counter_rows"), _view("mode_rows"), _view("reach_rows")
bank_rows, counter_scales = _view("bank_rows"), _view("counter_scales")
happened, happened_before = _view("happened"), _view("happened_before")
game_weights = _view("game_weights")
