"""Which colours do the small pictures have? Few, and far apart: they are for agents, not for admirers.

A colour is (red, green, blue), 0 to 255 each. Parts of a kind take turns through a tuple of colours.
"""

from __future__ import annotations

from typing import TypeAlias

Color: TypeAlias = tuple[int, int, int]

FLOOR: Color = (52, 26, 84)
RAIL: Color = (84, 72, 132)
SLANT_WALL: Color = (112, 92, 178)
GUTTER: Color = (255, 58, 92)
PADDLE: Color = (255, 150, 34)
PRISMS: tuple[Color, ...] = ((246, 74, 46), (246, 74, 46), (34, 186, 246), (34, 186, 246))
CYLINDERS: tuple[Color, ...] = ((255, 196, 40), (255, 58, 130), (66, 222, 110))
LIGHT: Color = (255, 252, 240)  # of a part that was just hit
BALL: Color = (255, 255, 255)


def in_turn(colors: tuple[Color, ...], index: int) -> Color:
    """The colour of the part with that number."""
    return colors[index % len(colors)]
