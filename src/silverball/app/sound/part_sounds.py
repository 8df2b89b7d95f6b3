"""The sounds of finishes and events: the tables from which the voices choose.

A hit sounds like the material that was met; a ball that passes a sensor or is held sounds like the mechanism.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from silverball.game.mechanisms import primitives_by_part
from silverball.table.primitive import Finish, Primitive

if TYPE_CHECKING:
    from silverball.table import Table


class HitSound(NamedTuple):
    """The sound of a contact with a material.

    Attributes:
        name: The recipe in the sound bank.
        least: Least strength of a hit, 0 to 1: a mechanism that acts is heard even at a slow hit.
        climbs: Whether hits in a row climb the scale.
    """

    name: str
    least: float = 0.0
    climbs: bool = False


HITS: dict[Finish, HitSound] = {
    Finish.BORDER: HitSound("wall"),
    Finish.WALL: HitSound("slant_wall"),
    Finish.METAL: HitSound("metal"),
    Finish.WOOD: HitSound("wall"),
    Finish.PLASTIC: HitSound("plastic"),
    Finish.RUBBER: HitSound("rubber"),
    Finish.PADDLE: HitSound("paddle_hit"),
    Finish.PRISM: HitSound("prism", 0.15, True),
    Finish.BUMPER: HitSound("cylinder", 0.35, True),  # a cylinder kicks even on a soft touch
    Finish.TARGET: HitSound("target", 0.25, True),
    Finish.ROLLOVER: HitSound("metal"),
    Finish.GATE: HitSound("metal"),
    Finish.SPINNER: HitSound("metal"),
    Finish.HOLE: HitSound("metal"),
    Finish.PLUNGER: HitSound("metal"),
    Finish.RAMP: HitSound("plastic"),
}
"""The sound of a contact with each finish."""

BALL = HitSound("balls")
KICK = HitSound("kick", 0.4)  # a part that kicks, unless its finish has a sound of a coil already
DROP = HitSound("drop", 0.35, True)  # a target that drops


class Sound(NamedTuple):
    """The sound of an event that is not a blow.

    Attributes:
        name: The recipe in the sound bank.
        strength: 0 to 1.
    """

    name: str
    strength: float


BLOWS = frozenset({"hit", "touch", "ball_hit", "ball_touch"})
"""The events that sound like what was hit, the harder the louder."""

EVENTS: dict[str, Sound | None] = {
    "created": Sound("created", 0.8),
    "gutter": Sound("drain", 0.9),
    "jitter": Sound("shove", 0.8),
    "jam": None,
    "reset": Sound("bank_reset", 0.8),
}
"""The sounds of events that do not depend on a part."""

ONCE = frozenset({"jitter", "reset"})
"""Events that several balls or parts have at one time, and that are heard once."""

MECHANISMS: dict[str, dict[Finish, Sound]] = {
    "pass": {
        Finish.ROLLOVER: Sound("rollover", 0.7),
        Finish.GATE: Sound("gate", 0.6),
        Finish.SPINNER: Sound("gate", 0.6),  # its turns are heard as events of their own
        Finish.RAMP: Sound("ramp", 0.7),
    },
    "spin": {Finish.SPINNER: Sound("spinner", 0.6)},
    "captured": {Finish.HOLE: Sound("capture", 0.8), Finish.PLUNGER: Sound("gate", 0.4)},
    "released": {Finish.HOLE: Sound("release", 0.8), Finish.PLUNGER: Sound("launch", 0.9)},
}
"""The sounds of events by the finish of their part; a part of another finish sounds like the first."""


class PartSound(NamedTuple):
    """How a part of a table sounds.

    Attributes:
        finish: The finish of the primitive that is heard best.
        blow: The sound of a hit.
        has_coil: Whether a coil throws the ball off at a hit, which a gamepad lets the player feel.
    """

    finish: Finish
    blow: HitSound
    has_coil: bool


def event_sound(kind: str, finish: Finish | None) -> Sound | None:
    """Return the sound of an event that is not a blow; None: it has none.

    Args:
        kind: The kind of the event.
        finish: The finish of its part; None if it belongs to none.
    """
    if kind in EVENTS:
        return EVENTS[kind]
    sounds = MECHANISMS[kind]
    return next(iter(sounds.values())) if finish is None else sounds.get(finish, next(iter(sounds.values())))


def blow_sound(primitive: Primitive) -> HitSound:
    """Return the sound of a hit on a primitive: of its coil or its fall if it has one, else of its finish."""
    if primitive.bank is not None:
        return DROP
    hit = HITS[primitive.finish]
    if primitive.surface.kick > 0.0 and hit.least == 0.0:
        return KICK
    return hit


def sounds_of_parts(table: Table) -> dict[str, PartSound]:
    """Return how every part of a table sounds, by its name in events."""
    sounds: dict[str, PartSound] = {}
    for name, primitives in primitives_by_part(table).items():
        # A part of several primitives (a slingshot and its posts) sounds like the loudest of them.
        loudest = max(primitives, key=lambda primitive: blow_sound(primitive).least)
        has_coil = loudest.finish is Finish.BUMPER or loudest.surface.kick > 0.0
        sounds[name] = PartSound(loudest.finish, blow_sound(loudest), has_coil)
    return sounds
