"""What is a baked picture: the arrays it consists of, and how they lie in the cache?

Nothing here needs compiled code, so a picture that was seen before is on screen before any is loaded.
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
    """What a hit of a part adds to the picture at its brightest.

    Attributes:
        left: First column.
        top: First row.
        pixels: RGB to add, uint8 [row, column, 3].
    """

    left: int
    top: int
    pixels: NDArray[np.uint8]


class BakedTable(NamedTuple):
    """A table that stands still.

    Attributes:
        pixels: RGB, uint8 [row, column, 3].
        height: Of the visible surface above the playfield [u], float32 [row, column].
        flashes: For prisms and cylinders, by their path in the table.
    """

    pixels: NDArray[np.uint8]
    height: NDArray[np.float32]
    flashes: dict[str, HitFlash]


class PaddleSprite(NamedTuple):
    """A paddle at one angle.

    Attributes:
        left: First column.
        top: First row.
        stays: How much of what is below stays, uint8 [row, column].
        added: RGB to add, uint8 [row, column, 3].
        height: Of the paddle above the playfield [u], float32; −1 where there is none.
    """

    left: int
    top: int
    stays: NDArray[np.uint8]
    added: NDArray[np.uint8]
    height: NDArray[np.float32]

    def mirrored(self, width: int) -> PaddleSprite:
        """The same on the other side of a picture of a width [pixel]."""
        return PaddleSprite(
            width - self.left - self.stays.shape[1],
            self.top,
            np.ascontiguousarray(self.stays[:, ::-1]),
            np.ascontiguousarray(self.added[:, ::-1]),
            np.ascontiguousarray(self.height[:, ::-1]),
        )


Sprites: TypeAlias = dict[tuple[str, int], PaddleSprite]
"""Paddles by side and step of their swing."""


def table_key(table: Table, camera: Camera, theme: Theme) -> str:
    """The name of the picture of a table that stands still."""
    parts = table.model_dump(include={"name", "board", "slant_wall", "triangular_prism", "cylinder"})
    return key_of("still", parts, camera.size, theme)


def empty_table_key(table: Table, camera: Camera, theme: Theme) -> str:
    """The name of the picture of the table without its obstacles."""
    return table_key(table.model_copy(update={"triangular_prism": (), "cylinder": ()}), camera, theme)


def paddle_key(table: Table, camera: Camera, theme: Theme) -> str:
    """The name of the pictures of a table's paddles; obstacles play no part in them."""
    return key_of("paddles", table.model_dump(include={"board", "slant_wall", "paddle"}), camera.size, theme)


def load_baked_table(cache: PictureCache, key: str) -> BakedTable | None:
    """A still picture from the cache, if it is there and whole."""
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


def save_baked_table(cache: PictureCache, key: str, still: BakedTable) -> None:
    """Keep a still picture."""
    arrays: dict[str, NDArray[Any]] = {"pixels": still.pixels, "height": still.height.astype(np.float16)}
    for name, flash in still.flashes.items():
        arrays["flash " + name] = flash.pixels
        arrays["at " + name] = np.array((flash.left, flash.top))
    cache.save(key, arrays)


def load_paddles(cache: PictureCache, key: str) -> Sprites:
    """The sprites of paddles from the cache, by side and step; none if they are not there."""
    arrays = cache.load(key) or {}
    sprites: Sprites = {}
    for name, at in arrays.items():
        if name.startswith("at "):
            _, side, step = name.split()
            sprites[side, int(step)] = PaddleSprite(
                int(at[0]), int(at[1]), arrays[f"stays {side} {step}"], arrays[f"added {side} {step}"],
                arrays[f"height {side} {step}"].astype(np.float32),
            )  # fmt: skip
    return sprites


def save_paddles(cache: PictureCache, key: str, sprites: Sprites) -> None:
    """Keep sprites of paddles."""
    arrays: dict[str, NDArray[Any]] = {}
    for (side, step), sprite in sprites.items():
        arrays[f"at {side} {step}"] = np.array((sprite.left, sprite.top))
        arrays[f"stays {side} {step}"] = sprite.stays
        arrays[f"added {side} {step}"] = sprite.added
        arrays[f"height {side} {step}"] = sprite.height.astype(np.float16)
    cache.save(key, arrays)
