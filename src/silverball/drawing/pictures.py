"""Baked pictures: the arrays they consist of, and how these are stored in the cache.

Nothing here needs compiled code, so a cached picture is on screen before any code is loaded.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.camera import Camera
from silverball.drawing.layout import Layout
from silverball.drawing.picture_cache import PictureCache, key_of
from silverball.drawing.themes import Theme


class AddedLight(NamedTuple):
    """The light that a hit of a part or a lit lamp adds to the picture, at its brightest.

    Attributes:
        left: First column.
        top: First row.
        pixels: RGB to add, uint8 [row, column, 3].
    """

    left: int
    top: int
    pixels: NDArray[np.uint8]


class BakedTable(NamedTuple):
    """A table without moving parts.

    Attributes:
        pixels: RGB, uint8 [row, column, 3].
        height: Of the visible surface above the playfield [u], float32 [row, column].
        flashes: Of the parts that light up when they are hit, by their path in the table.
        lamps: Of the lamps that lie in the playfield, in the order of the lights of the layout.
    """

    pixels: NDArray[np.uint8]
    height: NDArray[np.float32]
    flashes: dict[str, tuple[AddedLight, ...]]
    lamps: tuple[AddedLight, ...] = ()


class Sprite(NamedTuple):
    """A moving part in one pose, or an upper level.

    Attributes:
        left: First column.
        top: First row.
        remaining: Share of the background that remains, 0 to 255, uint8 [row, column].
        added: RGB to add, uint8 [row, column, 3].
        height: Of the part above the playfield [u], float32; −1 where there is none.
    """

    left: int
    top: int
    remaining: NDArray[np.uint8]
    added: NDArray[np.uint8]
    height: NDArray[np.float32]

    def mirrored(self, width: int) -> Sprite:
        """Return the mirror image on the other side of a picture of a width [pixel]."""
        return Sprite(
            width - self.left - self.remaining.shape[1],
            self.top,
            np.ascontiguousarray(self.remaining[:, ::-1]),
            np.ascontiguousarray(self.added[:, ::-1]),
            np.ascontiguousarray(self.height[:, ::-1]),
        )


Sprites: TypeAlias = dict[tuple[int, int], Sprite]
"""Sprites by the number of the moving part and its pose, or by the number of the level and 0."""


def table_key(layout: Layout, camera: Camera, theme: Theme) -> str:
    """Return the key of a table's playfield without moving parts."""
    return key_of("table", layout, camera.size, camera.has_panel, theme)


def sprites_key(layout: Layout, camera: Camera, theme: Theme) -> str:
    """Return the key of a table's moving parts, which do not depend on prisms and cylinders."""
    return key_of("sprites", layout.without_obstacles(), camera.size, camera.has_panel, theme)


def levels_key(layout: Layout, camera: Camera, theme: Theme) -> str:
    """Return the key of a table's upper levels."""
    return key_of("levels", layout, camera.size, camera.has_panel, theme)


def load_baked_table(cache: PictureCache, key: str) -> BakedTable | None:
    """Load a baked table; None if it is not cached."""
    arrays = cache.load(key)
    if arrays is None or not {"pixels", "height", "lamps", "lamp boxes"} <= arrays.keys():
        return None
    flashes: dict[str, tuple[AddedLight, ...]] = {}
    for name, pixels in arrays.items():
        if name.startswith("flash "):
            _, number, part = name.split(" ", 2)
            left, top = arrays[f"at {number}"]
            flashes[part] = (*flashes.get(part, ()), AddedLight(int(left), int(top), pixels))
    return BakedTable(arrays["pixels"], arrays["height"].astype(np.float32), flashes, _lamps(arrays))


def save_baked_table(cache: PictureCache, key: str, table: BakedTable) -> None:
    """Save a baked table."""
    arrays: dict[str, NDArray[Any]] = {"pixels": table.pixels, "height": table.height.astype(np.float16)}
    each = ((part, flash) for part, flashes in table.flashes.items() for flash in flashes)
    for number, (part, flash) in enumerate(each):
        arrays[f"flash {number} {part}"] = flash.pixels
        arrays[f"at {number}"] = np.array((flash.left, flash.top))
    arrays["lamp boxes"] = np.array(
        [(light.left, light.top, *light.pixels.shape[:2]) for light in table.lamps], np.int64
    ).reshape(-1, 4)
    arrays["lamps"] = np.concatenate(
        [np.zeros(0, np.uint8), *(light.pixels.ravel() for light in table.lamps)]
    )
    cache.save(key, arrays)


def _lamps(arrays: Mapping[str, NDArray[Any]]) -> tuple[AddedLight, ...]:
    """Return the lights of lamps: saved one after the other in one array, because opening many takes long."""
    lights, first = [], 0
    for left, top, rows, columns in arrays["lamp boxes"].tolist():
        end = first + 3 * rows * columns
        lights.append(AddedLight(left, top, arrays["lamps"][first:end].reshape(rows, columns, 3)))
        first = end
    return tuple(lights)


def load_sprites(cache: PictureCache, key: str) -> Sprites:
    """Load sprites; an empty dict if they are not cached."""
    arrays = cache.load(key) or {}
    sprites: Sprites = {}
    for name, at in arrays.items():
        if name.startswith("at "):
            _, part, pose = name.split()
            sprites[int(part), int(pose)] = Sprite(
                int(at[0]), int(at[1]), arrays[f"remaining {part} {pose}"], arrays[f"added {part} {pose}"],
                arrays[f"height {part} {pose}"].astype(np.float32),
            )  # fmt: skip
    return sprites


def save_sprites(cache: PictureCache, key: str, sprites: Sprites) -> None:
    """Save sprites."""
    arrays: dict[str, NDArray[Any]] = {}
    for (part, pose), sprite in sprites.items():
        arrays[f"at {part} {pose}"] = np.array((sprite.left, sprite.top))
        arrays[f"remaining {part} {pose}"] = sprite.remaining
        arrays[f"added {part} {pose}"] = sprite.added
        arrays[f"height {part} {pose}"] = sprite.height.astype(np.float16)
    cache.save(key, arrays)
