"""Baked pictures: the arrays they consist of, and how these are stored in the cache.

Nothing here needs compiled code, so a cached picture is on screen before any code is loaded.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.camera import Camera
from silverball.drawing.picture_cache import PictureCache, key_of
from silverball.drawing.themes import Theme
from silverball.table import Table


class HitFlash(NamedTuple):
    """The light that a hit of a part adds to the picture, at its brightest.

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
        flashes: Of prisms and cylinders, by their path in the table.
    """

    pixels: NDArray[np.uint8]
    height: NDArray[np.float32]
    flashes: dict[str, HitFlash]


class PaddleSprite(NamedTuple):
    """A paddle at one angle.

    Attributes:
        left: First column.
        top: First row.
        remaining: Share of the background that remains, 0 to 255, uint8 [row, column].
        added: RGB to add, uint8 [row, column, 3].
        height: Of the paddle above the playfield [u], float32; −1 where there is none.
    """

    left: int
    top: int
    remaining: NDArray[np.uint8]
    added: NDArray[np.uint8]
    height: NDArray[np.float32]

    def mirrored(self, width: int) -> PaddleSprite:
        """Return the mirror image on the other side of a picture of a width [pixel]."""
        return PaddleSprite(
            width - self.left - self.remaining.shape[1],
            self.top,
            np.ascontiguousarray(self.remaining[:, ::-1]),
            np.ascontiguousarray(self.added[:, ::-1]),
            np.ascontiguousarray(self.height[:, ::-1]),
        )


Sprites: TypeAlias = dict[tuple[str, int], PaddleSprite]
"""Sprites by side and step of the swing."""


def table_key(table: Table, camera: Camera, theme: Theme) -> str:
    """Return the key of a table without moving parts."""
    parts = table.model_dump(include={"name", "board", "slant_wall", "triangular_prism", "cylinder"})
    return key_of("still", parts, camera.size, theme)


def empty_table_key(table: Table, camera: Camera, theme: Theme) -> str:
    """Return the key of the table without prisms and cylinders."""
    return table_key(table.model_copy(update={"triangular_prism": (), "cylinder": ()}), camera, theme)


def paddle_key(table: Table, camera: Camera, theme: Theme) -> str:
    """Return the key of a table's paddles, which do not depend on prisms and cylinders."""
    return key_of("paddles", table.model_dump(include={"board", "slant_wall", "paddle"}), camera.size, theme)


def load_baked_table(cache: PictureCache, key: str) -> BakedTable | None:
    """Load a baked table; None if it is not cached."""
    arrays = cache.load(key)
    if arrays is None or not {"pixels", "height"} <= arrays.keys():
        return None
    flashes = {
        name.removeprefix("flash "): HitFlash(
            int(arrays["at " + name[6:]][0]), int(arrays["at " + name[6:]][1]), pixels
        )
        for name, pixels in arrays.items()
        if name.startswith("flash ")
    }
    return BakedTable(arrays["pixels"], arrays["height"].astype(np.float32), flashes)


def save_baked_table(cache: PictureCache, key: str, table: BakedTable) -> None:
    """Save a baked table."""
    arrays: dict[str, NDArray[Any]] = {"pixels": table.pixels, "height": table.height.astype(np.float16)}
    for name, flash in table.flashes.items():
        arrays["flash " + name] = flash.pixels
        arrays["at " + name] = np.array((flash.left, flash.top))
    cache.save(key, arrays)


def load_paddles(cache: PictureCache, key: str) -> Sprites:
    """Load the sprites of paddles; an empty dict if they are not cached."""
    arrays = cache.load(key) or {}
    sprites: Sprites = {}
    for name, at in arrays.items():
        if name.startswith("at "):
            _, side, step = name.split()
            sprites[side, int(step)] = PaddleSprite(
                int(at[0]), int(at[1]), arrays[f"remaining {side} {step}"], arrays[f"added {side} {step}"],
                arrays[f"height {side} {step}"].astype(np.float32),
            )  # fmt: skip
    return sprites


def save_paddles(cache: PictureCache, key: str, sprites: Sprites) -> None:
    """Save the sprites of paddles."""
    arrays: dict[str, NDArray[Any]] = {}
    for (side, step), sprite in sprites.items():
        arrays[f"at {side} {step}"] = np.array((sprite.left, sprite.top))
        arrays[f"remaining {side} {step}"] = sprite.remaining
        arrays[f"added {side} {step}"] = sprite.added
        arrays[f"height {side} {step}"] = sprite.height.astype(np.float16)
    cache.save(key, arrays)
