"""The single-world fast path: one cheap call steps a world, in about a microsecond.

Numba unpacks every argument at each call: seven arrays cost some 0.6 µs, more than the tick itself. So the
addresses of a batch's arrays are stored once, in one small array, and the kernel makes views of the arrays
from it. The owner of the addresses must keep the arrays alive. The types of the arguments never change, so
Numba's dispatch on them is skipped as well (`bind_types`).
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from typing import Any, cast

import numpy as np
from numba import extending, from_dtype as untyped_from_dtype, types
from numba.core import cgutils as untyped_cgutils
from numba.np import arrayobj as untyped_arrayobj
from numpy.typing import NDArray

from silverball.physics.code_cache import FULL_LAYOUT, PLAIN_LAYOUT
from silverball.physics.kernel import SETTINGS, bind_types, kernel
from silverball.physics.records import (
    BOARD,
    COLLIDER,
    LOG,
    PLAIN_WORLD,
    WORLD,
    BoardGeometry,
    Lane,
)
from silverball.physics.step import run_held
from silverball.world.compile import Boards

cgutils, arrayobj = cast(Any, untyped_cgutils), cast(Any, untyped_arrayobj)
intrinsic: Any = extending.intrinsic
from_dtype: Any = untyped_from_dtype
INT, SHORT_INT, BOOL = np.dtype(np.int64), np.dtype(np.int32), np.dtype(np.bool_)

ADDRESSES = np.dtype(
    [
        ("world", "i8"), ("board", "i8"), ("collider", "i8"), ("grid", "i8"),
        ("log", "i8"), ("tally", "i8"),
        ("colliders", "i8"), ("numbers", "i8"), ("parts", "i8"),  # lengths: of collider, of grid, of a tally
        ("tick", "f8"),  # length of a tick [s]
    ]
)  # fmt: skip
"""Addresses of the arrays of worlds; see `addresses_of`."""


def layout_name(layout: np.dtype[Any]) -> str:
    """The name of a layout of worlds: the last field of a record of addresses, and in names of files."""
    return PLAIN_LAYOUT if layout == PLAIN_WORLD else FULL_LAYOUT


def addresses_of(layout: np.dtype[Any], addresses: np.dtype[Any] = ADDRESSES) -> np.dtype[Any]:
    """The record of the addresses of worlds in a layout: kernels see by its type which one it is."""
    fields = [(name, addresses[name]) for name in addresses.names or ()]
    return np.dtype([*fields, (layout_name(layout), "i8")])


class SingleStepper:
    """Steps the one world of a batch, in place, in the arrays that it was made with."""

    def __init__(
        self,
        boards: Boards,
        state: NDArray[Any],
        logs: NDArray[Any],
        tallies: NDArray[np.int64],
        tick: float,
    ) -> None:
        """Store the addresses of the arrays; `tick` is the length of a tick [s]."""
        named: dict[str, NDArray[Any]] = {
            "world": state,
            "board": boards.board,
            "collider": boards.collider,
            "grid": boards.grid,
            "log": logs,
            "tally": tallies,
        }
        self._arrays = list(named.values())
        self._tick = tick
        self._addresses = np.zeros(1, addresses_of(state.dtype))
        row = self._addresses[0]
        for name, array in named.items():
            row[name] = array.ctypes.data
        row["colliders"], row["numbers"], row["parts"] = (
            len(boards.collider),
            len(boards.grid),
            tallies.shape[1],
        )
        row["tick"] = tick
        self._step: Callable[[Any, int, int], int] = (
            self._interpreted_step if SETTINGS.DISABLE_JIT else self._first_step
        )

    def __reduce__(self) -> Any:
        """Refuse copies: a copy would hold the addresses of the original's arrays."""
        raise TypeError("SingleStepper holds addresses and cannot be copied; copy the World that owns it")

    def step(self, buttons: int, ticks: int) -> int:
        """Advance the world.

        Args:
            buttons: Bits LEFT, RIGHT, JITTER, LAUNCH and those of the nudges.
            ticks: The number of ticks, as `run_held` takes it.

        Returns:
            The fault of the world, 0 for none.
        """
        return self._step(self._addresses, buttons, ticks)

    def _interpreted_step(self, addresses: NDArray[Any], buttons: int, ticks: int) -> int:
        """Do a step without the compiler."""
        state, board, colliders, grid, logs, tallies = self._arrays
        lane = Lane(state[0], logs[0], tallies[0], logs[0])
        run_held(lane, BoardGeometry(board[0], colliders, grid), buttons, ticks, self._tick)
        return int(state[0]["fault"])

    def _first_step(self, addresses: NDArray[Any], buttons: int, ticks: int) -> int:
        """Compile the step at the first call, and do it."""
        self._step = step = bind_types(step_single_world, addresses, buttons, ticks)
        fault: int = step(addresses, buttons, ticks)
        return fault


@intrinsic  # type: ignore[untyped-decorator]
def _compiled_array_at(typing_context: Any, address: Any, shape: Any, dtype: Any) -> Any:
    """A view of an address as an array of a shape and a type; `numba.carray` needs reference counting."""
    array_type = types.Array(dtype.dtype, len(shape), "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = context.make_array(array_type)(context, builder)
        lengths = cgutils.unpack_tuple(builder, arguments[1])
        size = context.get_constant(types.intp, context.get_abi_sizeof(context.get_data_type(dtype.dtype)))
        strides = [size]
        for length in reversed(lengths[1:]):
            strides.insert(0, builder.mul(strides[0], length))
        data = builder.inttoptr(arguments[0], array.data.type)
        arrayobj.populate_array(array, data, lengths, strides, size, None)
        return array._getvalue()

    return array_type(address, shape, dtype), generate


def _interpreted_array_at(address: int, shape: tuple[int, ...], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Make the same array without the compiler."""
    size = math.prod(shape) * dtype.itemsize
    memory: Any = (ctypes.c_char * size).from_address(int(address))
    array: NDArray[Any] = np.frombuffer(memory, dtype).reshape(shape)
    return array.view(np.recarray) if dtype.names else array


array_at: Any = _interpreted_array_at if SETTINGS.DISABLE_JIT else _compiled_array_at


@intrinsic  # type: ignore[untyped-decorator]
def _compiled_layout_of(typing_context: Any, addresses: Any) -> Any:
    """The record of the worlds at some addresses, as `array_at` takes it."""
    record = from_dtype(PLAIN_WORLD if PLAIN_LAYOUT in addresses.fields else WORLD)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.get_dummy_value()

    return types.DType(record)(addresses), generate


def _interpreted_layout_of(addresses: Any) -> np.dtype[Any]:
    """Return the same without the compiler."""
    return PLAIN_WORLD if PLAIN_LAYOUT in addresses.dtype.names else WORLD


layout_of: Any = _interpreted_layout_of if SETTINGS.DISABLE_JIT else _compiled_layout_of


@kernel
def step_single_world(addresses: Any, buttons: int, ticks: int) -> int:
    """Advance the world at these addresses (see `ADDRESSES`) as `run_held` does, and return its fault."""
    at = addresses[0]
    worlds, logs = array_at(at.world, (1,), layout_of(at)), array_at(at.log, (1,), LOG)
    tallies, boards = array_at(at.tally, (1, at.parts), INT), array_at(at.board, (1,), BOARD)
    colliders = array_at(at.collider, (at.colliders,), COLLIDER)
    grid = array_at(at.grid, (at.numbers,), SHORT_INT)
    lane = Lane(worlds[0], logs[0], tallies[0], logs[0])
    run_held(lane, BoardGeometry(boards[0], colliders, grid), buttons, ticks, at.tick)
    return int(worlds[0].fault)
