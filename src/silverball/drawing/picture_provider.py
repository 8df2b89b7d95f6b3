"""Baked pictures of one table at one size, loaded from the cache or baked and saved.

This module needs compiled code; import it only when something is baked or composed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from silverball.drawing.bake_levels import bake_level
from silverball.drawing.bake_sprites import SpriteBaker
from silverball.drawing.bake_table import bake_table
from silverball.drawing.bake_threads import BakeThreads
from silverball.drawing.layout import Layout
from silverball.drawing.moving import MovingPart, coarse_to_fine, mirrored, moving_parts, visible
from silverball.drawing.pictures import (
    BakedTable,
    Sprite,
    levels_key,
    load_baked_table,
    load_sprites,
    save_baked_table,
    save_sprites,
    sprites_key,
    table_key,
)

if TYPE_CHECKING:
    from silverball.drawing.camera import Camera
    from silverball.drawing.picture_cache import PictureCache
    from silverball.drawing.themes import Theme
    from silverball.table import Table


class PictureProvider:
    """Provides the baked pictures of one table at one size.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its colours.
        cache: Where pictures are kept.
        bake_threads: The threads that bake.
    """

    def __init__(
        self, table: Table, camera: Camera, theme: Theme, cache: PictureCache, bake_threads: BakeThreads
    ) -> None:
        self._layout = Layout.of(table)
        self._camera = camera
        self._theme = theme
        self._cache = cache
        self._bake_threads = bake_threads
        self._parts = moving_parts(self._layout)
        self._mirrored = mirror_images(self._parts, camera)
        self._key = sprites_key(self._layout, camera, theme)
        self._sprites = load_sprites(cache, self._key)
        self._stored = len(self._sprites)
        self._baker: SpriteBaker | None = None

    def table(self) -> BakedTable:
        """Return the playfield without moving parts; bake it if it is not cached."""
        key = table_key(self._layout, self._camera, self._theme)
        baked = load_baked_table(self._cache, key)
        if baked is None:
            empty = load_baked_table(self._cache, self._empty_key())
            baked = bake_table(self._layout, self._camera, self._theme, self._bake_threads, empty)
            save_baked_table(self._cache, key, baked)
        return baked

    def levels(self) -> dict[int, Sprite]:
        """Return the upper levels by their numbers; bake them if they are not cached."""
        numbers = self._layout.levels[1:]
        if not numbers:
            return {}
        key = levels_key(self._layout, self._camera, self._theme)
        sprites = load_sprites(self._cache, key)
        if not sprites.keys() >= {(number, 0) for number in numbers}:
            sprites = {
                (number, 0): bake_level(self._layout, number, self._camera, self._theme, self._bake_threads)
                for number in numbers
            }
            save_sprites(self._cache, key, sprites)
        return {number: sprites[number, 0] for number in numbers}

    def bake_empty(self) -> None:
        """Bake the empty table, for later boards of the same recipe, if it is not cached."""
        if load_baked_table(self._cache, self._empty_key()) is None:
            bare = self._layout.without_obstacles()
            save_baked_table(
                self._cache,
                self._empty_key(),
                bake_table(bare, self._camera, self._theme, self._bake_threads),
            )

    def _empty_key(self) -> str:
        return table_key(self._layout.without_obstacles(), self._camera, self._theme)

    def sprite(self, part: int, pose: int) -> Sprite | None:
        """Return the sprite of a moving part in a pose; None if it is not baked yet."""
        return self._sprites.get((part, pose))

    def baked_sprite(self, part: int, pose: int) -> Sprite:
        """Return the sprite of a moving part in a pose; bake it if necessary."""
        if (part, pose) not in self._sprites:
            self._bake_sprite(part, pose)
        return self._sprites[part, pose]

    def bake_sprites(self, progress: Callable[[float], None] = lambda share: None) -> None:
        """Bake the missing sprites, those of the outermost poses first, and save them."""
        ordered = (
            (place, number, pose)
            for number, part in enumerate(self._parts)
            for place, pose in enumerate(coarse_to_fine(part.poses))
        )
        wanted = sorted(ordered, key=lambda sprite: sprite[0])
        for count, (_, number, pose) in enumerate(wanted):
            self.baked_sprite(number, pose)
            progress((count + 1) / len(wanted))
        self.save_sprites()

    def save_sprites(self) -> None:
        """Save the sprites baked so far."""
        if len(self._sprites) > self._stored:
            save_sprites(self._cache, self._key, self._sprites)
            self._stored = len(self._sprites)

    def _bake_sprite(self, part: int, pose: int) -> None:
        image = self._mirrored.get(part)
        if image is not None:
            self._sprites[part, pose] = self.baked_sprite(image, pose).mirrored(self._camera.size[0])
            return
        if self._baker is None:
            self._baker = SpriteBaker(self._layout, self._camera, self._theme, self._bake_threads)
        self._sprites[part, pose] = self._baker.bake(self._parts[part], pose)


def mirror_images(parts: tuple[MovingPart, ...], camera: Camera) -> dict[int, int]:
    """Return for each paddle that is the mirror image of an earlier one, and looks so, the earlier one."""
    if abs(2.0 * camera.frustum.across - camera.size[0]) > 1e-6:
        return {}
    images: dict[int, int] = {}
    for number, part in enumerate(parts):
        image = mirrored(part.primitive)
        for earlier in range(number):
            if image is not None and earlier not in images and visible(parts[earlier].primitive) == image:
                images[number] = earlier
                break
    return images
