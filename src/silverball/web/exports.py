"""Which kernels the WebAssembly module exports, and the types of their arguments.

    step, step_plain                 what `World.step` calls, for each record of a world
    create_ball, create_ball_plain   new balls
    judge, judge_plain               the rules of a game
    relight … draw_ball              what `drawing.compose` calls

An export is named here, typed by examples of its arguments, and compiled by `build.py`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from silverball.drawing.kernels.chrome import Sphere, cast_shadow, draw_ball
from silverball.drawing.kernels.patches import add_light, add_spots, lay_over, lay_sprite, relight
from silverball.drawing.kernels.stage import STAGE
from silverball.physics.balls import create_ball
from silverball.physics.records import BOARD, COLLIDER, LOG, PLAIN_WORLD, WORLD
from silverball.referee.single_judge import JUDGE_ADDRESSES, judge_single_game
from silverball.world.single_step import addresses_of, step_single_world


class Export(NamedTuple):
    """One function of the module.

    Attributes:
        name: Its name there.
        kernel: The kernel.
        arguments: Examples of the kernel's arguments; only their types matter.
    """

    name: str
    kernel: Any
    arguments: tuple[Any, ...]


def exports() -> tuple[Export, ...]:
    """All exports, in the order in which they are compiled."""
    return (*_physics(), *_drawing())


def _physics() -> tuple[Export, ...]:
    board, log = np.zeros(1, BOARD)[0], np.zeros(1, LOG)[0]
    colliders, places = np.zeros(1, COLLIDER), np.zeros((1, 2))
    found = []
    for layout, suffix in ((WORLD, ""), (PLAIN_WORLD, "_plain")):
        world = np.zeros(1, layout)[0]
        addresses = np.zeros(1, addresses_of(layout))
        judged = np.zeros(1, addresses_of(layout, JUDGE_ADDRESSES))
        found += [
            Export(f"step{suffix}", step_single_world, (addresses, 0, 0)),
            Export(f"create_ball{suffix}", create_ball, (world, board, colliders, places, log)),
            Export(f"judge{suffix}", judge_single_game, (judged, 0, 0)),
        ]
    return tuple(found)


def _drawing() -> tuple[Export, ...]:
    pixels, shares = np.zeros((1, 1, 3), np.uint8), np.zeros((1, 1), np.uint8)
    heights, stage, inks = np.zeros((1, 1), np.float32), np.zeros(1, STAGE), np.zeros((1, 3))
    cells, boxes = np.zeros(1, np.int32), np.zeros((1, 5), np.int64)
    ball, box = Sphere(0.0, 0.0, 0.0, 0.0, 0.0, (0.0, 0.0, 0.0)), (0, 0, 0, 0)
    lamps = (shares, shares, cells, boxes, np.zeros(1, np.uint8), boxes, shares)
    return (
        Export("relight", relight, lamps),
        Export("lay_sprite", lay_sprite, (pixels, heights, 0, 0, shares, pixels, heights)),
        Export("lay_over", lay_over, (pixels, pixels, 0, 0, shares, pixels, box)),
        Export("add_light", add_light, (shares, 0, 0, shares, 0)),
        Export("add_spots", add_spots, (pixels, heights, stage, np.zeros((1, 7)), 0)),
        Export("cast_shadow", cast_shadow, (pixels, heights, stage, ball, box)),
        Export("draw_ball", draw_ball, (pixels, heights, pixels, stage, inks, ball, box)),
    )
