"""Where do the kernels find the arrays of the environments?

A kernel with thirty arrays as arguments would be slow to call and slow to compile. So the addresses and
lengths of all of them stand in one ADDRESSES record (see world/single_step.py), which is what the kernels
hand
each other; the functions below make the array from it where one is needed. Whoever holds the record must
hold the arrays.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numba import types

from silverball.envs.buffers import WRITTEN
from silverball.envs.state import COUNTS, EPISODE, FILM, RULES, SCENE
from silverball.physics.kernel import SETTINGS, pasted
from silverball.physics.records import BOARD, COLLIDER, LOG, WORLD
from silverball.world.single_step import BOOL, INT, SHORT_INT, array_at, cgutils, intrinsic

FLOAT, SMALL_FLOAT, BYTE = np.dtype(np.float64), np.dtype(np.float32), np.dtype(np.uint8)


@intrinsic  # type: ignore[untyped-decorator]
def _compiled_copy(typing_context: Any, target: Any, source: Any, count: Any) -> Any:
    """Copy bytes from an address to another; the two runs must not overlap."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointers = [builder.inttoptr(address, cgutils.voidptr_t) for address in arguments[:2]]
        cgutils.raw_memcpy(builder, *pointers, arguments[2], 1)
        return context.get_dummy_value()

    return types.none(types.int64, types.int64, types.int64), generate


def _interpreted_copy(target: int, source: int, count: int) -> None:
    """The same without the compiler."""
    ctypes.memmove(int(target), int(source), int(count))


copy_bytes: Any = _interpreted_copy if SETTINGS.DISABLE_JIT else _compiled_copy

ARRAYS = (
    "worlds", "boards", "board_of", "board_seeds", "colliders", "grid", "places", "logs",
    "tallies", "held", "episodes", "blanks", "layouts", "rules", "film", "actions", "masks", "wanted",
    *WRITTEN, "terms", "counts_before", "finals", "final_counts",
    "scenes", "final_scenes", "drawn", "backgrounds", "balls", "paddles",
)  # fmt: skip
LENGTHS = (
    "envs", "boards", "colliders", "numbers", "places", "parts", "columns", "layout_columns", "counts",
    "terms", "stack", "ring", "pixels", "ball_pixels", "paddle_pixels",
)  # fmt: skip
ADDRESSES = np.dtype(
    [*((f"{name}_at", "i8") for name in ARRAYS), *((name, "i8") for name in LENGTHS)], align=True
)


@pasted
def worlds(at: Any) -> Any:
    """Records [envs]."""
    return array_at(at.worlds_at, (at.envs,), WORLD)


@pasted
def boards(at: Any) -> Any:
    """Records [boards]."""
    return array_at(at.boards_at, (at.boards,), BOARD)


@pasted
def board_of(at: Any) -> Any:
    """The board of each world [envs]."""
    return array_at(at.board_of_at, (at.envs,), INT)


@pasted
def board_seeds(at: Any) -> Any:
    """The seed of each board [boards]."""
    return array_at(at.board_seeds_at, (at.boards,), INT)


@pasted
def colliders(at: Any) -> Any:
    """Of all boards [colliders]."""
    return array_at(at.colliders_at, (at.colliders,), COLLIDER)


@pasted
def grid(at: Any) -> Any:
    """Of all boards [numbers]."""
    return array_at(at.grid_at, (at.numbers,), SHORT_INT)


@pasted
def places(at: Any) -> Any:
    """Squares in which balls are created [places, 2]."""
    return array_at(at.places_at, (at.places, 2), FLOAT)


@pasted
def logs(at: Any) -> Any:
    """What happened in the last step [envs]."""
    return array_at(at.logs_at, (at.envs,), LOG)


@pasted
def tallies(at: Any) -> Any:
    """Hits of each part [envs, parts]."""
    return array_at(at.tallies_at, (at.envs, at.parts), INT)


@pasted
def held(at: Any) -> Any:
    """What run_worlds presses [1, envs, 3]."""
    return array_at(at.held_at, (1, at.envs, 3), BOOL)


@pasted
def episodes(at: Any) -> Any:
    """Records [envs]."""
    return array_at(at.episodes_at, (at.envs,), EPISODE)


@pasted
def layouts(at: Any) -> Any:
    """The obstacles of each board as they stand in an observation [boards, layout_columns]."""
    return array_at(at.layouts_at, (at.boards, at.layout_columns), SMALL_FLOAT)


@pasted
def rules(at: Any) -> Any:
    """One record [1]."""
    return array_at(at.rules_at, (1,), RULES)


@pasted
def film(at: Any) -> Any:
    """One record [1]."""
    return array_at(at.film_at, (1,), FILM)


@pasted
def actions(at: Any) -> Any:
    """The buttons as bits [envs]."""
    return array_at(at.actions_at, (at.envs,), INT)


@pasted
def masks(at: Any) -> Any:
    """Which environments a reset is for [envs]."""
    return array_at(at.masks_at, (at.envs,), BOOL)


@pasted
def wanted(at: Any) -> Any:
    """The board of each one's next episode [envs]; −1: it is drawn."""
    return array_at(at.wanted_at, (at.envs,), INT)


@pasted
def observations(at: Any) -> Any:
    """States as they are shown [envs, columns]."""
    return array_at(at.observations_at, (at.envs, at.columns), SMALL_FLOAT)


@pasted
def rewards(at: Any) -> Any:
    """Of the last step [envs]."""
    return array_at(at.rewards_at, (at.envs,), FLOAT)


@pasted
def terminated(at: Any) -> Any:
    """Of the last step [envs]."""
    return array_at(at.terminated_at, (at.envs,), BOOL)


@pasted
def truncated(at: Any) -> Any:
    """Of the last step [envs]."""
    return array_at(at.truncated_at, (at.envs,), BOOL)


@pasted
def counts(at: Any) -> Any:
    """The events of each episode so far, see `COUNTS` [envs, counts]."""
    return array_at(at.counts_at, (at.envs, at.counts), INT)


@pasted
def terms(at: Any) -> Any:
    """The terms of the last step's rewards, see `TERMS` [envs, terms]."""
    return array_at(at.terms_at, (at.envs, at.terms), FLOAT)


@pasted
def counts_before(at: Any) -> Any:
    """The counters of the worlds before the step [envs, len(COUNTS)]; a slice uses its first rows."""
    return array_at(at.counts_before_at, (at.envs, len(COUNTS)), INT)


@pasted
def finals(at: Any) -> Any:
    """Last observations of episodes that ended in this step [envs, columns]."""
    return array_at(at.finals_at, (at.envs, at.columns), SMALL_FLOAT)


@pasted
def final_counts(at: Any) -> Any:
    """Their counts [envs, counts]."""
    return array_at(at.final_counts_at, (at.envs, at.counts), INT)


@pasted
def scenes(at: Any) -> Any:
    """What the last pictures show, the newest last [envs, stack]."""
    return array_at(at.scenes_at, (at.envs, at.stack), SCENE)


@pasted
def final_scenes(at: Any) -> Any:
    """The same of episodes that ended in this step [envs, stack]."""
    return array_at(at.final_scenes_at, (at.envs, at.stack), SCENE)


@pasted
def drawn(at: Any) -> Any:
    """What the pictures in the ring show [envs, ring]."""
    return array_at(at.drawn_at, (at.envs, at.ring), SCENE)


@pasted
def frames(at: Any) -> Any:
    """A ring of pictures [envs, ring, pixels]."""
    return array_at(at.frames_at, (at.envs, at.ring, at.pixels), BYTE)


@pasted
def copies(at: Any) -> Any:
    """Where copies of the window go [envs, stack, pixels]."""
    return array_at(at.copies_at, (at.envs, at.stack, at.pixels), BYTE)


@pasted
def backgrounds(at: Any) -> Any:
    """The still parts of each board [boards, pixels]."""
    return array_at(at.backgrounds_at, (at.boards, at.pixels), BYTE)


@pasted
def balls(at: Any) -> Any:
    """Sprites [ball_pixels]."""
    return array_at(at.balls_at, (at.ball_pixels,), BYTE)


@pasted
def paddles(at: Any) -> Any:
    """Sprites [paddle_pixels]."""
    return array_at(at.paddles_at, (at.paddle_pixels,), BYTE)
