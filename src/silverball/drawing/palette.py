"""Which colours are there? All of them, here.

A colour is (red, green, blue), 0 to 255 each. Parts of a kind take turns through a tuple of colours, so that
neighbours differ.
"""

from __future__ import annotations

from typing import TypeAlias

Color: TypeAlias = tuple[int, int, int]

ROOM: Color = (7, 6, 13)  # around the table

FLOOR_TOP: Color = (28, 74, 104)
FLOOR_MIDDLE: Color = (33, 33, 88)
FLOOR_BOTTOM: Color = (52, 26, 84)
RAY: Color = (132, 98, 208)
GLOW: Color = (150, 92, 230)  # where the rays meet
STAR: Color = (225, 228, 255)
EMBLEM: Color = (124, 208, 255)
EMBLEM_HEART: Color = (255, 196, 92)
SHADOW: Color = (5, 3, 14)

RAIL: Color = (84, 72, 132)
SLANT_WALL: Color = (112, 92, 178)
CORNER: Color = (78, 68, 124)
APRON: Color = (46, 38, 78)
GUTTER: Color = (255, 58, 92)

PADDLE: Color = (255, 150, 34)
PADDLE_PIVOT: Color = (168, 84, 14)  # dark, so that nobody takes it for a ball

PRISMS: tuple[Color, ...] = ((246, 74, 46), (246, 74, 46), (34, 186, 246), (34, 186, 246))
CYLINDERS: tuple[Color, ...] = ((255, 196, 40), (255, 58, 130), (66, 222, 110))
LIGHT: Color = (255, 252, 240)
STEEL: Color = (222, 226, 238)

BALL_LIGHT: Color = (255, 255, 255)
BALL_MIDDLE: Color = (198, 206, 222)
BALL_DARK: Color = (58, 62, 84)
TRAIL: Color = (118, 178, 255)

PANEL: Color = (10, 8, 20)
PANEL_OUTER: Color = (255, 66, 158)
PANEL_INNER: Color = (70, 196, 255)
SCORE: Color = (255, 186, 58)
LABEL: Color = (112, 220, 255)
TEXT: Color = (236, 236, 250)
FAINT_TEXT: Color = (150, 142, 190)
KEY_FACE: Color = (52, 46, 86)
KEY_EDGE: Color = (150, 136, 214)


def in_turn(colors: tuple[Color, ...], index: int) -> Color:
    """The colour of the part with that number."""
    return colors[index % len(colors)]
