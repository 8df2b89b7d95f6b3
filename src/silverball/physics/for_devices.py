"""Code for devices, levels and many balls, which worlds on plain boards do without.

A world on a plain board has a shorter record (PLAIN_WORLD), and its kernels contain no code for devices:

    @for_devices(lambda world, geometry, tick: NEVER)
    @internal
    def clock_time(world: WorldRecord, geometry: BoardGeometry, tick: float) -> float:
        ...

Called with a WORLD or BALL record, the function below the decorator is compiled; with a PLAIN_WORLD or
PLAIN_BALL record it is the one in the decorator. Whatever reads or writes a field that the shorter records do
not have must be decorated, or the compiler refuses it for plain worlds.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

from numba import from_dtype as untyped_from_dtype, types

from silverball.physics.kernel import SETTINGS, as_int, inlined
from silverball.physics.records import (
    PLAIN_BALL,
    PLAIN_BALLS,
    PLAIN_PADDLES,
    PLAIN_WORLD,
    BallRecord,
    BoardRecord,
    ColliderRecord,
    Motion,
    Response,
    WorldRecord,
)

from_dtype = cast(Callable[[Any], Any], untyped_from_dtype)
F = TypeVar("F", bound=Callable[..., Any])
PLAIN = (PLAIN_WORLD, PLAIN_BALL)
PLAIN_TYPES = tuple(from_dtype(one) for one in PLAIN)


def for_devices(otherwise: Callable[..., Any]) -> Callable[[F], F]:
    """Decorate a compiled function for devices.

    Args:
        otherwise: What takes its place if an argument, or an item of a tuple among the arguments, is a record
            of a plain world. It has the same parameters; a kernel is compiled with its code.

    Raises:
        TypeError: The parameters differ.
    """

    def decorate(function: F) -> F:
        names, others = list(inspect.signature(function).parameters), inspect.signature(otherwise).parameters
        if names != list(others):
            raise TypeError(f"{function.__name__}: `otherwise` must have the parameters {names}")
        if SETTINGS.DISABLE_JIT:
            return _interpreted(function, otherwise)
        compiled = cast(Any, function)
        # Symbols have names that no two functions may share (see linkage.py), such as <lambda>.
        otherwise.__name__ = otherwise.__qualname__ = f"{function.__name__}_plain"

        def implementation(argument_types: tuple[Any, ...], _: Any) -> Callable[..., Any]:
            is_plain = any(map(_is_plain_type, argument_types))
            return otherwise if is_plain else cast(Callable[..., Any], compiled.py_func)

        # Numba asks here which Python function to compile; see `numba.core.dispatcher._FunctionCompiler`.
        compiled._compiler._get_implementation = implementation
        return function

    return decorate


def _interpreted(function: F, otherwise: Callable[..., Any]) -> F:
    @wraps(function)
    def choose(*arguments: Any) -> Any:
        return (otherwise if any(map(_is_plain, arguments)) else function)(*arguments)

    return cast(F, choose)


def _is_plain_type(one: Any) -> bool:
    if isinstance(one, types.BaseTuple):
        return any(map(_is_plain_type, cast(Any, one)))
    if isinstance(one, types.Array):
        return one.dtype in PLAIN_TYPES
    return one in PLAIN_TYPES


def _is_plain(argument: Any) -> bool:
    if isinstance(argument, tuple):
        return any(map(_is_plain, argument))
    return getattr(argument, "dtype", None) in PLAIN


@for_devices(lambda world, board: as_int(PLAIN_BALLS))
@inlined
def ball_slots(world: WorldRecord, board: BoardRecord) -> int:
    """The slots in which balls can be; in plain worlds a constant, so that loops are unrolled."""
    return int(board.max_balls)


@for_devices(lambda world, board: as_int(PLAIN_PADDLES))
@inlined
def paddle_count(world: WorldRecord, board: BoardRecord) -> int:
    """The number of paddles; in plain worlds a constant. `world` may be a ball instead."""
    return int(board.paddles)


@for_devices(lambda ball: as_int(0))
@inlined
def level_of(ball: BallRecord) -> int:
    """The level on which a ball is."""
    return int(ball.level)


@for_devices(lambda ball: False)
@inlined
def is_captured(ball: BallRecord) -> bool:
    """Whether a device holds a ball."""
    return bool(ball.motion == Motion.CAPTURED)


@for_devices(lambda world: as_int(0))
@inlined
def switches_off(world: WorldRecord) -> int:
    """The switches whose colliders are away, as bits."""
    return int(world.off)


@for_devices(lambda a, b: True)
@inlined
def are_on_one_level(a: BallRecord, b: BallRecord) -> bool:
    """Whether two balls are on the same level."""
    return bool(a.level == b.level)


@for_devices(lambda c, ball: True)
@inlined
def shares_level(c: ColliderRecord, ball: BallRecord) -> bool:
    """Whether a collider is on the level of a ball."""
    return bool(c.levels >> ball.level & 1 != 0)


@for_devices(lambda c, ball, off: True)
@inlined
def is_solid(c: ColliderRecord, ball: BallRecord, off: int) -> bool:
    """Whether a collider is there for a ball and lets it bounce; `off` has the bits of what is away."""
    return bool(c.response == Response.BOUNCE and c.levels >> ball.level & 1 != 0 and c.switch & off == 0)
