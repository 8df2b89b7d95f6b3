"""What a page must know of a compiled world: its arrays, and where the fields of its records are."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from silverball.game.replay.digest import group_spans
from silverball.physics.records import EVENT, LOG, PADDLE, PLAIN_WORLD, SPINNER, STILL_WORLD
from silverball.web.pack import ArrayPack
from silverball.world import WorldBatch
from silverball.world.single_step import addresses_of


def put_world(batch: WorldBatch, pack: ArrayPack) -> dict[str, Any]:
    """Pack the first world of a batch; return what `page/world.js` reads about it."""
    boards = batch.boards
    for name, array in {
        "world": batch.state[:1], "board": boards.board, "collider": boards.collider, "grid": boards.grid,
        "place": boards.place, "log": batch.logs[:1], "tally": batch.tallies[:1],
    }.items():  # fmt: skip
        pack.put(name, array)
    layout = boards.layout
    ball = layout["ball"]
    records = {
        "world": record_meta(layout), "paddle": record_meta(PADDLE), "log": record_meta(LOG),
        "event": record_meta(EVENT), "ball": record_meta(ball.base) | {"count": ball.shape[0]},
    }  # fmt: skip
    if layout != PLAIN_WORLD:
        records["spinner"] = record_meta(SPINNER)
    return {
        "rate": batch.tick_rate,
        "isPlain": layout == PLAIN_WORLD,
        "stillSize": min(layout.itemsize, STILL_WORLD.itemsize),
        "hasNudge": bool(boards.board["nudge"][0]),
        "addresses": list(addresses_of(layout).names or ()),
        "layout": records,
        "groups": group_spans(layout),
        "arrays": pack.at,
    }


def record_meta(layout: np.dtype[Any]) -> dict[str, Any]:
    """The size of a record, and the offsets of its fields [byte]."""
    fields = cast(Any, layout.fields)
    return {"size": layout.itemsize, "fields": {name: int(place[1]) for name, place in fields.items()}}
