"""Code for devices, levels and many balls, which worlds on plain boards do without.

A world on a plain board has a shorter record (PLAIN_WORLD), and its kernels contain no code for devices, nor
for lamps, modes and conditions, since games on such boards have the standard rules:

    @for_devices(lambda world, geometry, tick: NEVER)
    @internal
    def clock_time(world: WorldRecord, geometry: BoardGeometry, tick: float) -> float:
        ...

Called with a WORLD or BALL record, the function below the decorator is compiled; with a PLAIN_WORLD or
PLAIN_BALL record it is the one in the decorator. Whatever reads or writes a field that the shorter records do
not have must be decorated, or the compiler refuses it for plain worlds.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from numba import from_dtype as untyped_from_dtype, types

from silverball.physics.code_cache import FULL_LAYOUT, PLAIN_LAYOUT, CodeCache
from silverball.physics.kernel import as_int, inlined
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
from silverball.physics.two_codes import F, two_codes

from_dtype = cast(Callable[[Any], Any], untyped_from_dtype)
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
    return two_codes(
        otherwise,
        "plain",
        lambda types: any(map(_is_plain_type, types)),
        lambda values: any(map(_is_plain, values)),
    )


def _layout_of(argument_types: Any) -> str:
    return PLAIN_LAYOUT if any(map(_is_plain_type, argument_types)) else FULL_LAYOUT


CodeCache.layout_of = staticmethod(_layout_of)


def _is_plain_type(one: Any) -> bool:
    if isinstance(one, types.BaseTuple):
        return any(map(_is_plain_type, cast(Any, one)))
    if isinstance(one, types.Array):
        return _is_plain_type(one.dtype)
    return one in PLAIN_TYPES or PLAIN_LAYOUT in getattr(one, "fields", ())  # of addresses


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
