"""Baked pictures of one table at one size, loaded from the cache or baked and saved.

This module needs compiled code; import it only when something is baked or composed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from silverball.drawing.bake_paddles import (
    PaddleBaker,
    coarse_to_fine,
    has_mirrored_paddles,
    nearest_step,
    step_count,
)
from silverball.drawing.bake_table import bake_table, without_obstacles
from silverball.drawing.bake_threads import BakeThreads
from silverball.drawing.pictures import (
    BakedTable,
    PaddleSprite,
    empty_table_key,
    load_baked_table,
    load_paddles,
    paddle_key,
    save_baked_table,
    save_paddles,
    table_key,
)

if TYPE_CHECKING:
    from silverball.drawing.camera import Camera
    from silverball.drawing.picture_cache import PictureCache
    from silverball.drawing.themes import Theme
    from silverball.table import Paddle, Table


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
        self._table = table
        self._camera = camera
        self._theme = theme
        self._cache = cache
        self._bake_threads = bake_threads
        self._paddles: dict[str, Paddle] = {paddle.side: paddle for paddle in table.paddle}
        self._has_mirrored_paddles = has_mirrored_paddles(table, camera)
        self._key = paddle_key(table, camera, theme)
        self._sprites = load_paddles(cache, self._key)
        self._stored = len(self._sprites)
        self._baker: PaddleBaker | None = None

    def table(self) -> BakedTable:
        """Return the table without moving parts; bake it if it is not cached."""
        key = table_key(self._table, self._camera, self._theme)
        baked = load_baked_table(self._cache, key)
        if baked is None:
            empty = load_baked_table(self._cache, empty_table_key(self._table, self._camera, self._theme))
            baked = bake_table(self._table, self._camera, self._theme, self._bake_threads, empty)
            save_baked_table(self._cache, key, baked)
        return baked

    def bake_empty(self) -> None:
        """Bake the empty table, for later boards of the same recipe, if it is not cached."""
        key = empty_table_key(self._table, self._camera, self._theme)
        if load_baked_table(self._cache, key) is None:
            bare = without_obstacles(self._table)
            save_baked_table(
                self._cache, key, bake_table(bare, self._camera, self._theme, self._bake_threads)
            )

    def paddle(self, side: str, angle: float) -> PaddleSprite | None:
        """Return the sprite of a paddle at an angle [deg]; None if it is not baked yet."""
        return self._sprites.get((side, nearest_step(self._paddles[side], angle)))

    def baked_paddle(self, side: str, angle: float) -> PaddleSprite:
        """Return the sprite of a paddle at an angle [deg]; bake it if necessary."""
        step = nearest_step(self._paddles[side], angle)
        if (side, step) not in self._sprites:
            self._bake_paddle(side, step)
        return self._sprites[side, step]

    def bake_paddles(self, progress: Callable[[float], None] = lambda share: None) -> None:
        """Bake the missing sprites of the paddles, the stops first, and save them."""
        wanted = [
            (side, step)
            for side, paddle in self._paddles.items()
            for step in coarse_to_fine(step_count(paddle))
        ]
        wanted.sort(key=lambda sprite: coarse_to_fine(step_count(self._paddles[sprite[0]])).index(sprite[1]))
        for number, (side, step) in enumerate(wanted):
            if (side, step) not in self._sprites:
                self._bake_paddle(side, step)
            progress((number + 1) / len(wanted))
        self.save_paddles()

    def save_paddles(self) -> None:
        """Save the sprites baked so far."""
        if len(self._sprites) > self._stored:
            save_paddles(self._cache, self._key, self._sprites)
            self._stored = len(self._sprites)

    def _bake_paddle(self, side: str, step: int) -> None:
        if self._has_mirrored_paddles and side == "right":
            if ("left", step) not in self._sprites:
                self._bake_paddle("left", step)
            self._sprites["right", step] = self._sprites["left", step].mirrored(self._camera.size[0])
            return
        if self._baker is None:
            self._baker = PaddleBaker(self._table, self._camera, self._theme, self._bake_threads)
        self._sprites[side, step] = self._baker.bake(side, step)
