"""Themes: the colours of a table, and a few numbers for its materials and light.

A colour is (red, green, blue), 0 to 255 each, as on the screen. Parts of a kind cycle through a tuple of
colours, so that neighbours differ.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from silverball.drawing.kernels.stage import Art, Frame

Color: TypeAlias = tuple[int, int, int]


@dataclass(frozen=True)
class Theme:
    """The colours and materials of a table.

    Attributes:
        title: Its name in menus.
        art: The painting on the playfield.
        frame: The material of rails and slant walls.
        room: Background around the table.
        floor: Playfield near the player, in the middle, and at the top.
        ray: Rays of the playfield.
        glow: Light where the rays meet.
        ornament: Lines and inserts of the playfield.
        heart: Star of the emblem.
        strips: Tubes of light along the rails and along the slant walls.
        cap: Pattern on the caps of cylinders.
        cap_ground: How far the pattern goes from the cylinder's colour to `cap`, 0 to 1.
        ball: Sky overhead that a ball mirrors.
        ball_low: Sky near the horizon that a ball mirrors.
        exposure: Factor of all light.
        key: Strength of the lamp that casts shadows.
        fill: Strength of the ambient light.
        lacquer: Reflectance of the playfield.
        halo: Strength of the light that parts throw around them.
        infill: What closed walls enclose.
        metal: Guides, gates and plungers.
        timber: Parts of wood.
        plastics: Parts of plastic.
        rubber: Posts, and the rubbers of slingshots.
        targets: Faces of targets.
        inserts: Lenses of rollovers.
        spinner: Blades of spinners.
        hole: Inside of a hole.
        mouth: Arrows where balls change from one level to another.
        ramp: Floors of upper levels.
    """

    title: str
    art: Art
    room: Color
    floor: tuple[Color, Color, Color]
    ray: Color
    glow: Color
    ornament: tuple[Color, Color]
    heart: Color
    rail: Color
    wall: Color
    apron: Color
    label: Color
    strips: tuple[Color, Color]
    paddle: Color
    paddle_edge: Color
    prisms: tuple[Color, ...]
    cylinders: tuple[Color, ...]
    cap: Color
    cap_ground: float
    steel: Color
    ball_low: Color
    trail: Color
    spark: Color
    panel: Color
    panel_edges: tuple[Color, Color]
    dots: Color
    key: float
    fill: float
    lacquer: float
    halo: float
    frame: Frame = Frame.METAL
    ball: Color = (255, 255, 255)
    exposure: float = 1.0
    infill: Color = (60, 64, 92)
    metal: Color = (214, 220, 240)
    timber: Color = (150, 104, 62)
    plastics: tuple[Color, ...] = ((70, 96, 190), (150, 60, 140), (40, 130, 130))
    rubber: Color = (232, 232, 236)
    targets: tuple[Color, ...] = ((240, 60, 60), (250, 190, 40), (60, 190, 240))
    inserts: tuple[Color, ...] = ((255, 220, 90), (90, 220, 255), (255, 110, 180), (120, 240, 130))
    spinner: Color = (220, 60, 60)
    hole: Color = (70, 74, 92)
    mouth: Color = (255, 200, 60)
    ramp: Color = (120, 200, 255)


NEON = Theme(
    title="Neon",
    art=Art.COSMOS,
    room=(9, 8, 17),
    floor=((26, 14, 66), (18, 18, 72), (10, 32, 84)),
    ray=(66, 46, 176),
    glow=(150, 70, 255),
    ornament=((40, 220, 255), (255, 70, 200)),
    heart=(255, 206, 60),
    rail=(58, 62, 132),
    wall=(96, 100, 200),
    apron=(40, 38, 92),
    label=(150, 214, 255),
    strips=((255, 40, 190), (60, 120, 255)),
    paddle=(255, 214, 64),
    paddle_edge=(255, 250, 226),
    prisms=((255, 96, 30), (255, 96, 30), (0, 208, 255), (0, 208, 255)),
    cylinders=((255, 214, 40), (255, 50, 150), (40, 236, 130)),
    cap=(255, 255, 255),
    cap_ground=0.8,
    steel=(214, 220, 240),
    ball_low=(148, 168, 226),
    trail=(150, 205, 255),
    spark=(255, 226, 160),
    panel=(10, 8, 20),
    panel_edges=((255, 66, 158), (70, 196, 255)),
    dots=(255, 150, 40),
    key=1.0,
    fill=0.36,
    lacquer=0.5,
    halo=1.25,
)  # fmt: skip

PARLOUR = Theme(
    title="Parlour",
    art=Art.WOOD,
    frame=Frame.WOOD,
    room=(20, 13, 9),
    floor=((150, 84, 40), (178, 106, 52), (166, 96, 46)),
    ray=(112, 56, 24),
    glow=(255, 190, 96),
    ornament=((255, 214, 130), (44, 96, 74)),
    heart=(196, 44, 36),
    rail=(116, 48, 26),
    wall=(206, 164, 92),
    apron=(84, 34, 22),
    label=(255, 220, 150),
    strips=((255, 176, 80), (255, 150, 60)),
    paddle=(238, 226, 200),
    paddle_edge=(200, 34, 30),
    prisms=((206, 40, 34), (206, 40, 34), (20, 120, 96), (20, 120, 96)),
    cylinders=((250, 196, 60), (226, 60, 44), (36, 140, 190)),
    cap=(255, 248, 226),
    cap_ground=0.9,
    steel=(236, 206, 140),
    ball_low=(176, 160, 150),
    trail=(255, 240, 200),
    spark=(255, 236, 180),
    panel=(18, 10, 6),
    panel_edges=((226, 172, 84), (140, 70, 36)),
    dots=(255, 176, 60),
    key=1.7,
    fill=0.75,
    lacquer=0.35,
    halo=0.45,
    infill=(120, 74, 40),
    metal=(236, 206, 140),
    timber=(196, 140, 84),
    plastics=((200, 60, 44), (30, 110, 90), (226, 176, 70)),
    rubber=(246, 240, 226),
    targets=((214, 44, 36), (244, 236, 214), (30, 120, 170)),
    inserts=((255, 210, 90), (226, 60, 44), (90, 190, 120)),
    spinner=(196, 40, 34),
    hole=(64, 40, 26),
    mouth=(255, 220, 120),
    ramp=(40, 120, 170),
)

CLEAR = Theme(
    title="Clear",
    art=Art.PLAIN,
    room=(6, 7, 9),
    floor=((20, 24, 34), (24, 28, 40), (28, 34, 48)),
    ray=(34, 40, 58),
    glow=(70, 84, 120),
    ornament=((86, 100, 136), (70, 80, 110)),
    heart=(70, 82, 116),
    rail=(104, 112, 128),
    wall=(176, 182, 194),
    apron=(40, 44, 54),
    label=(220, 226, 240),
    strips=((60, 80, 140), (60, 80, 140)),
    paddle=(214, 170, 0),
    paddle_edge=(240, 200, 40),
    prisms=((0, 36, 130),),
    cylinders=((214, 44, 0),),
    cap=(255, 160, 100),
    cap_ground=0.4,
    steel=(90, 94, 105),
    ball_low=(255, 255, 255),
    trail=(255, 255, 255),
    spark=(255, 255, 255),
    panel=(6, 7, 9),
    panel_edges=((230, 234, 244), (110, 118, 136)),
    dots=(255, 214, 90),
    key=1.5,
    fill=0.7,
    lacquer=0.2,
    halo=0.5,
    infill=(66, 72, 86),
    metal=(204, 210, 222),
    timber=(120, 112, 100),
    plastics=((76, 86, 112),),
    rubber=(150, 156, 168),
    targets=((150, 40, 160),),
    inserts=((70, 150, 130),),
    spinner=(150, 40, 160),
    hole=(4, 5, 7),
    mouth=(70, 150, 130),
    ramp=(130, 150, 200),
)

THEMES = {"neon": NEON, "parlour": PARLOUR, "clear": CLEAR}


def cycled_color(colors: tuple[Color, ...], index: int) -> Color:
    """Return the colour of the part with a number; the colours repeat."""
    return colors[index % len(colors)]


def role_color(theme: Theme, role: str, number: int) -> Color:
    """Return the colour of a theme for the part with a number among those of its role."""
    value = getattr(theme, role)
    return cycled_color(value, number) if isinstance(value[0], tuple) else value


LAMP_COLORS: dict[str, Color] = {
    "white": (255, 246, 226), "yellow": (255, 210, 30), "orange": (255, 130, 16), "red": (255, 36, 30),
    "pink": (255, 70, 170), "violet": (160, 76, 255), "blue": (46, 100, 255), "cyan": (30, 214, 255),
    "green": (40, 232, 84),
}  # fmt: skip
"""The colours of lamps by their names in a table file, the same in all themes."""


def lamp_color(theme: Theme, name: str, number: int) -> Color:
    """Return the colour of a lamp; "auto" is one of the theme's inserts, by the number of its group."""
    name = "white" if name == "mode" else name
    return cycled_color(theme.inserts, number) if name == "auto" else LAMP_COLORS[name]


BALL_TINTS: tuple[Color, ...] = (
    (255, 255, 255), (255, 214, 120), (150, 220, 255), (255, 170, 200), (170, 255, 180), (210, 180, 255),
    (255, 190, 140), (190, 255, 240),
)  # fmt: skip
"""Colours of the chrome of balls on a table with more than two, by their ids."""


def ball_tint(id_: int) -> Color:
    """Return the colour of the chrome of a ball; those of eight balls in a row differ."""
    return cycled_color(BALL_TINTS, id_ - 1)


# Colours of words, keys and panels that lie over a table of any theme
ROOM: Color = (7, 6, 13)  # around the table

PANEL: Color = (10, 8, 20)
PANEL_INNER: Color = (70, 196, 255)
SCORE: Color = (255, 186, 58)
LABEL: Color = (112, 220, 255)
TEXT: Color = (236, 236, 250)
FAINT_TEXT: Color = (150, 142, 190)
KEY_FACE: Color = (52, 46, 86)
KEY_EDGE: Color = (150, 136, 214)
