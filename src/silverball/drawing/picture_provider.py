"""Who sees to it that a picture is there? The store is asked first, else it is baked and stored.

This is the first module of the drawing that needs compiled code, so it is imported only when something is
baked or composed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from silverball.drawing.bake_paddles import PaddleBaker, in_turns, is_mirrored, step_count, step_of
from silverball.drawing.bake_table import bake_still, without_obstacles
from silverball.drawing.bake_threads import Workshop
from silverball.drawing.pictures import (
    PaddleSprite,
    Still,
    empty_key,
    load_paddles,
    load_still,
    paddle_key,
    save_paddles,
    save_still,
    still_key,
)

if TYPE_CHECKING:
    from silverball.drawing.camera import Camera
    from silverball.drawing.picture_cache import Store
    from silverball.drawing.themes import Theme
    from silverball.table import Paddle, Table


class Studio:
    """Makes the pictures of one table at one size.

    Args:
        table: A finished table.
        camera: The view of it.
        theme: Its look.
        store: Where pictures are kept.
        workshop: Who bakes.
    """

    def __init__(self, table: Table, camera: Camera, theme: Theme, store: Store, workshop: Workshop) -> None:
        self._table = table
        self._camera = camera
        self._theme = theme
        self._store = store
        self._workshop = workshop
        self._paddles: dict[str, Paddle] = {paddle.side: paddle for paddle in table.paddle}
        self._is_mirrored = is_mirrored(table, camera)
        self._key = paddle_key(table, camera, theme)
        self._sprites = load_paddles(store, self._key)
        self._stored = len(self._sprites)
        self._baker: PaddleBaker | None = None

    def still(self) -> Still:
        """The table when nothing moves."""
        key = still_key(self._table, self._camera, self._theme)
        still = load_still(self._store, key)
        if still is None:
            empty = load_still(self._store, empty_key(self._table, self._camera, self._theme))
            still = bake_still(self._table, self._camera, self._theme, self._workshop, empty)
            save_still(self._store, key, still)
        return still

    def bake_empty(self) -> None:
        """Bake the empty table for the boards to come, if that is still to be done."""
        key = empty_key(self._table, self._camera, self._theme)
        if load_still(self._store, key) is None:
            bare = without_obstacles(self._table)
            save_still(self._store, key, bake_still(bare, self._camera, self._theme, self._workshop))

    def paddle(self, side: str, angle: float) -> PaddleSprite | None:
        """The sprite of a paddle at an angle [deg] if it has been baked."""
        return self._sprites.get((side, step_of(self._paddles[side], angle)))

    def baked_paddle(self, side: str, angle: float) -> PaddleSprite:
        """The sprite of a paddle at an angle [deg]; it is baked if need be."""
        step = step_of(self._paddles[side], angle)
        if (side, step) not in self._sprites:
            self._bake_paddle(side, step)
        return self._sprites[side, step]

    def bake_paddles(self, progress: Callable[[float], None] = lambda share: None) -> None:
        """Bake all that is missing of the paddles, the stops first, and store them."""
        wanted = [
            (side, step) for side, paddle in self._paddles.items() for step in in_turns(step_count(paddle))
        ]
        wanted.sort(key=lambda sprite: in_turns(step_count(self._paddles[sprite[0]])).index(sprite[1]))
        for number, (side, step) in enumerate(wanted):
            if (side, step) not in self._sprites:
                self._bake_paddle(side, step)
            progress((number + 1) / len(wanted))
        self.save_paddles()

    def save_paddles(self) -> None:
        """Store what has been baked of the paddles."""
        if len(self._sprites) > self._stored:
            save_paddles(self._store, self._key, self._sprites)
            self._stored = len(self._sprites)

    def _bake_paddle(self, side: str, step: int) -> None:
        if self._is_mirrored and side == "right":
            if ("left", step) not in self._sprites:
                self._bake_paddle("left", step)
            self._sprites["right", step] = self._sprites["left", step].mirrored(self._camera.size[0])
            return
        if self._baker is None:
            self._baker = PaddleBaker(self._table, self._camera, self._theme, self._workshop)
        self._sprites[side, step] = self._baker.bake(side, step)
