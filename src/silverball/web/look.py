"""What a page draws with: the baked pictures of a table, its moving parts, and the score panel.

`page/painter.js` composes frames from it as `drawing.compose` does, with the same kernels.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.bake_threads import BakeThreads
from silverball.drawing.build_solids import linear
from silverball.drawing.camera import Camera
from silverball.drawing.compose import UNTINTED_BALLS
from silverball.drawing.dimensions import LEVEL_RISE
from silverball.drawing.dotmatrix.fonts import FONTS, Font
from silverball.drawing.kernels.patches import TILE
from silverball.drawing.lamp_lights import lamp_boxes, lamp_tiles, tile_shape
from silverball.drawing.layout import OF_THE_MODE, PLAIN_COLOR, Layout
from silverball.drawing.light_shows import ALWAYS, EVENT_SHOWS, FOREVER, SHOWS, places_of
from silverball.drawing.moving import Motion, MovingPart, moving_parts, pose_angle
from silverball.drawing.picture_cache import PictureCache
from silverball.drawing.picture_provider import PictureProvider, mirror_images
from silverball.drawing.pictures import BakedTable
from silverball.drawing.scene import TableScene
from silverball.drawing.themes import BALL_TINTS, Theme
from silverball.plain import plain
from silverball.table import Table
from silverball.table.kinds.board import BORDERS
from silverball.web.display_words import shown_texts
from silverball.web.pack import SHEET_WIDTH, ArrayPack, Sheets, half_bytes, picture

CHARACTERS = "".join(map(chr, range(32, 127)))


class Look(NamedTuple):
    """The look of a table.

    Attributes:
        meta: Numbers and places, for JSON.
        pictures: Lossless pictures as text: `table`, `heights`, `colors` and `covers`.
        room: The colour around the table, as it is in the corner of the picture.
    """

    meta: dict[str, Any]
    pictures: dict[str, str]
    room: tuple[int, int, int]


def look_of(
    table: Table, camera: Camera, theme: Theme, numbers: dict[str, int], pack: ArrayPack,
    progress: Callable[[float], None] = lambda share: None,
) -> Look:  # fmt: skip
    """Bake a table for a page.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its colours.
        numbers: The numbers of its parts by their names in events.
        pack: Gets the arrays that the kernels read.
        progress: Called with the share of the work that is done, 0 to 1.
    """
    provider = PictureProvider(table, camera, theme, PictureCache(), BakeThreads())
    baked, levels = provider.table(), provider.levels()
    provider.bake_sprites(progress)
    layout = Layout.of(table)
    scene = TableScene(layout._replace(rows=()), camera, theme).scene
    pack.put("stage", scene.stage)
    pack.put("inks", scene.inks)
    sheets = Sheets(max(SHEET_WIDTH, camera.size[0]))
    parts = moving_parts(layout)
    moving = _moving(parts, mirror_images(parts, camera), provider, sheets, numbers)
    unit = camera.dimensions.unit
    layers: list[dict[str, Any]] = [{"level": 0, "base": 0.0}]
    for number, over in sorted(levels.items()):
        layers.append({"level": number, "base": number * LEVEL_RISE * unit, "over": sheets.put_sprite(over)})
    flashes = [
        [numbers[part], *sheets.put_light(flash.left, flash.top, flash.pixels)]
        for part, found in baked.flashes.items()
        for flash in found
    ]
    lamps = _lamps(table, layout, baked, sheets, pack)
    colors, covers = sheets.pictures()
    heights = np.concatenate([half_bytes(baked.height), np.zeros((*baked.height.shape, 1), np.uint8)], axis=2)
    is_tinted = table.board.max_balls > UNTINTED_BALLS
    meta = {
        "size": camera.size,
        "scale": camera.scale,
        "frustum": [float(number) for number in camera.frustum],
        "radius": camera.dimensions.ball,
        "holes": [row for row in range(len(layout.rows) + len(BORDERS)) if layout.is_hole(row)],
        "tints": [linear(tint) for tint in BALL_TINTS] if is_tinted else [],
        "moving": moving,
        "layers": layers,
        "flashes": flashes,
        "lamps": lamps,
        "lightShows": show_meta(),
        "trail": theme.trail,
        "spark": theme.spark,
        "panel": _panel(camera, theme, _texts(table)),
    }
    shown = {"table": baked.pixels, "heights": heights, "colors": colors, "covers": covers}
    red, green, blue = baked.pixels[0, 0].tolist()
    return Look(meta, {name: picture(pixels) for name, pixels in shown.items()}, (red, green, blue))


def _moving(
    parts: tuple[MovingPart, ...], images: dict[int, int], provider: PictureProvider, sheets: Sheets,
    numbers: dict[str, int],
) -> list[dict[str, Any]]:  # fmt: skip
    """The moving parts, each with its poses on the sheets, or with the part whose mirror image it is."""
    found = []
    for index, part in enumerate(parts):
        one: dict[str, Any] = {
            "motion": part.motion.value, "part": numbers[part.part], "number": part.number,
            "poses": part.poses, "switch": -1 if part.switch is None else part.switch,
            "level": part.level, "levels": list(part.primitive.levels), "points": part.primitive.points,
        }  # fmt: skip
        if part.motion is Motion.TURNING:
            one["rest"], one["up"] = pose_angle(part, 0), pose_angle(part, part.poses - 1)
        if part.primitive.launch is not None:
            one["charge"] = part.primitive.launch.charge
        if part.primitive.spin is not None:
            one["damping"] = part.primitive.spin.damping
        if index in images:
            one["mirrors"] = images[index]
        else:
            one["sprites"] = [
                sheets.put_sprite(provider.baked_sprite(index, pose)) for pose in range(part.poses)
            ]
        found.append(one)
    return found


def _lamps(
    table: Table, layout: Layout, baked: BakedTable, sheets: Sheets, pack: ArrayPack
) -> dict[str, Any]:
    """The lamps and their lights, the colours of the modes, and the light shows."""
    inserts = [
        {"lamp": insert.lamp, "begins": insert.begins, "isOfTheMode": insert.color == OF_THE_MODE}
        for insert in layout.inserts
    ]
    lights = [
        {
            "insert": light.insert, "color": light.color,
            "place": sheets.put_light(added.left, added.top, added.pixels),
        }
        for light, added in zip(layout.lights, baked.lamps, strict=True)
    ]  # fmt: skip
    if lights:
        tiles = tile_shape(baked)
        pack.put("lamp tiles", lamp_tiles(baked.lamps, tiles))
        pack.put("lamp boxes", lamp_boxes(baked.lamps))
        pack.put("lamp changed", np.zeros(tiles, np.uint8))
    return {
        "inserts": inserts, "lights": lights, "tile": TILE,
        "modeColors": {"ofModes": [mode.color for mode in table.mode], "plain": PLAIN_COLOR},
        "places": {order.value: places.tolist() for order, places in places_of(layout).items()},
    }  # fmt: skip


def show_meta() -> dict[str, Any]:
    """All light shows, which events begin which of them, and which of those interrupt every other one."""
    shows = {
        name: {
            "seconds": show.seconds if show.seconds < FOREVER else None, "rank": show.rank,
            "under": show.under, "repeats": show.repeats,
            "waves": [
                wave._asdict() | {"ends": wave.ends if wave.ends < FOREVER else None} for wave in show.waves
            ],
        }
        for name, show in SHOWS.items()
    }  # fmt: skip
    events = {kind.name: name for kind, name in EVENT_SHOWS.items()}
    return {"shows": shows, "ofEvents": events, "always": [kind.name for kind in ALWAYS]}


def _texts(table: Table) -> str:
    """All characters that the score display may have to show."""
    return "".join(sorted({*CHARACTERS, *plain(table.name).upper(), *"".join(shown_texts(table).values())}))


def _panel(camera: Camera, theme: Theme, characters: str) -> dict[str, Any]:
    """The score panel: its place, colours and fonts."""
    area = camera.panel
    return {
        "area": [area.x, area.y, area.width, area.height],
        "dots": theme.dots,
        "glass": theme.panel,
        "edges": theme.panel_edges,
        "fonts": {font.name: _font(font, characters) for font in FONTS},
    }


def _font(font: Font, characters: str) -> dict[str, Any]:
    """A font: of each character the width and its rows, bits from left to right."""
    glyphs = {
        character: _glyph(font.glyph(character))
        for character in dict.fromkeys([*characters, *font.glyphs])
        if font.has(character) or not character.isascii()
    }
    return {"height": font.height, "gap": font.gap, "glyphs": glyphs, "box": _glyph(font.box)}


def _glyph(rows: NDArray[np.bool_]) -> list[Any]:
    """The width of a glyph, and its rows."""
    return [rows.shape[1], [int("".join("1" if dot else "0" for dot in row) or "0", 2) for row in rows]]
