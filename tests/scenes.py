"""Which games do the tests of determinism and the golden digests play?

A scene is a board, a seed, a tick rate and a length; its buttons are random but always the same. Run as a
program it prints the digests of the short scenes as JSON, for tests that compare another process with
this one.
"""

from __future__ import annotations

import contextlib
import json
import random
from collections.abc import Callable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from boards import CLASSIC, PLAYGROUND, RANDOM, full_table
from silverball.errors import BoardFull, NoRoom
from silverball.soak.hostile_parts import hostile_part_table
from silverball.soak.part_boards import part_table
from silverball.table import SlantWall, Table, generate_table, load_table
from silverball.world import World, WorldBatch

BEAT = 15
"""Ticks after which new balls come and buttons may change: in the shortest game this is 20 times."""


class Scene(NamedTuple):
    """One game: what is played, for how many ticks, the chance of a shove on a beat, and of a launch."""

    name: str
    table: Callable[[], Table]
    seed: int
    tick_rate: int = 60
    ticks: int = 1200
    jitter: float = 0.2
    launch: float = 0.0

    def buttons(self) -> np.ndarray:
        """Left, right, jitter, launch for every tick, bool [ticks, 4]."""
        rng = random.Random(self.seed)  # of the standard library: its numbers are the same in every version
        held = np.zeros((self.ticks, 4), np.bool_)
        for start in range(0, self.ticks, BEAT):
            held[start : start + BEAT, :2] = rng.random() < 0.5, rng.random() < 0.5
            held[start, 2] = rng.random() < self.jitter
            if self.launch > 0.0:
                held[start : start + BEAT, 3] = rng.random() < self.launch
        return held

    def world(self) -> World:
        """The world at its beginning."""
        return World(self.table(), self.seed, self.tick_rate)


def classic() -> Table:
    return CLASSIC


@cache
def generated(seed: int) -> Table:
    return generate_table(seed, RANDOM)


def rolling(seed: int) -> Table:
    table = generated(seed)
    rough = table.board.model_copy(update={"friction": 0.2, "rolling": True})
    return table.model_copy(update={"board": rough})


def playground() -> Table:
    return PLAYGROUND


def rolling_playground() -> Table:
    rough = PLAYGROUND.board.model_copy(update={"friction": 0.2, "rolling": True})
    return PLAYGROUND.model_copy(update={"board": rough})


@cache
def all_parts(seed: int) -> Table:
    return part_table(seed)


def jamming() -> Table:
    """A bar above the paddles, under which they press balls."""
    return full_table(SlantWall(start=(-6.0, -1.5), end=(-6.2, 1.5)))


SCENES = (
    Scene("classic", classic, seed=1),
    Scene("random board 7", lambda: generated(7), seed=2),
    Scene("random board 2^40", lambda: generated(2**40), seed=3),
    Scene("nothing loses speed", lambda: full_table(restitution=1.0), seed=4),
    Scene("steep board", lambda: full_table(gravity=30.0), seed=5),
    Scene("one ball", lambda: full_table(max_balls=1), seed=6, jitter=0.0),
    Scene("rough parts", lambda: full_table(friction=0.2), seed=11),
    Scene("rolling", lambda: full_table(friction=0.2, rolling=True), seed=12),
    Scene("too smooth to roll", lambda: full_table(friction=0.02, rolling=True), seed=13),
    Scene("jams", jamming, seed=17),
    Scene("weightless", lambda: full_table(gravity=0.0), seed=15),
    Scene("weightless and rough", lambda: full_table(gravity=0.0, friction=0.2, rolling=True), seed=16),
    Scene("slow ticks", classic, seed=7, tick_rate=10, ticks=300),
    Scene("classic as in the window", classic, seed=8, tick_rate=240, ticks=4800),
    Scene("random board 9 as in the window", lambda: generated(9), seed=9, tick_rate=240, ticks=4800),
    Scene("rolling as in the window", lambda: rolling(11), seed=14, tick_rate=240, ticks=4800),
    Scene("odd ticks", lambda: generated(10), seed=10, tick_rate=977, ticks=9000),
    Scene("devices", playground, seed=20, ticks=3600, launch=0.5),
    Scene("devices as in the window", rolling_playground, seed=19, tick_rate=240, ticks=9600, launch=0.5),
)

ALL_PARTS = (
    Scene("built-in parts", lambda: load_table("parts"), seed=30, launch=0.5),
    *(
        Scene(f"all parts {seed}", lambda seed=seed: all_parts(seed), seed=seed, launch=0.5)
        for seed in (3, 8, 10)
    ),
    *(
        Scene(f"hostile parts {seed}", lambda seed=seed: hostile_part_table(seed), seed=seed, launch=0.5)
        for seed in (1, 6, 7)
    ),
)
"""Boards of all kinds of parts; they may change with the generator, so they have no golden digests."""

SHORT = tuple(scene._replace(ticks=300) for scene in (*SCENES, *ALL_PARTS) if scene.tick_rate == 60)
"""For the ladder, which plays them over and over: 5 s each, at one tick rate, so that a batch holds them."""


def create(world: World) -> None:
    """A new ball if there is room, as `WorldBatch.create_balls` does."""
    with contextlib.suppress(BoardFull, NoRoom):
        world.create_ball()


def played(scene: Scene) -> World:
    """The world at the end of a scene, moved on one tick at a time."""
    world = scene.world()
    for tick, (left, right, jitter, launch) in enumerate(scene.buttons().tolist()):
        if tick % BEAT == 0:
            create(world)
        world.step(left, right, jitter, launch=launch)
    return world


def batch_of(scenes: Sequence[Scene], threads: int | None = None) -> WorldBatch:
    """The worlds of some scenes at their beginning, in one batch."""
    tables = {scene.name: scene.table() for scene in scenes}
    return WorldBatch(
        [tables[scene.name] for scene in scenes],
        len(scenes),
        [scene.seed for scene in scenes],
        scenes[0].tick_rate,
        threads,
    )


def buttons_of(scenes: Sequence[Scene]) -> np.ndarray:
    """The buttons of some scenes of equal length, bool [ticks, world, 4]."""
    rows = {scene.name: scene.buttons() for scene in scenes}
    return np.stack([rows[scene.name] for scene in scenes], axis=1)


def digests_in_a_batch(scenes: Sequence[Scene], threads: int | None = None) -> list[str]:
    """The digest of each scene, played in a batch, a beat at a time."""
    batch, held = batch_of(scenes, threads), buttons_of(scenes)
    for start in range(0, len(held), BEAT):
        batch.create_balls()
        rows = held[start : start + BEAT]
        batch.step(rows, len(rows))
    return batch.digests()


if __name__ == "__main__":
    print(json.dumps([played(scene).digest() for scene in SHORT]))
