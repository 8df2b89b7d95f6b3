"""What does an environment remember besides its world, and what are its rules in numbers?

An *episode* is one flat record per environment, all fields eight bytes wide, like the world's. *Rules* are
the options as numbers, *film* is what the drawing of pictures needs.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from silverball.physics.records import BALL_COUNT


class Mode(IntEnum):
    """When does an environment whose episode has ended begin a new one?"""

    DISABLED = 0  # when `reset` asks for it
    NEXT_STEP = 1  # in the next step, whose action is ignored
    SAME_STEP = 2  # at once; the last observation is kept apart


class End(IntEnum):
    """What a step says of the last environment that it moved, as bits."""

    TERMINATED = 1
    TRUNCATED = 2
    WAS_OVER = 4  # the episode had already ended before
    COUNTED = 8  # the counts differ from those of the step before; of an only environment alone


class Task(IntEnum):
    """What the one compiled call of the environments is to do; an action ≥ 0 is a task too."""

    STEP = -1  # by the actions in their array
    RESET = -2  # those of the mask
    OBSERVE = -3  # write observations anew, after states were changed


COUNTS = (
    "score", "created", "drained", "wall_hits", "slant_wall_hits", "paddle_hits", "triangular_prism_hits",
    "cylinder_hits", "ball_hits", "touches", "jams",
)  # fmt: skip
"""The counters of a WORLD record that `info` carries: totals of the episode so far."""

EPISODE = np.dtype(
    [
        ("board_seed", "i8"),  # of the board, or −1: it was not made from a seed
        ("stalled", "i8"),  # 1: it ended because no scoring hit was made for too long
        ("over", "i8"),  # 1: it has ended
        ("steps", "i8"),
        ("quiet", "i8"),  # steps since the last scoring hit or the last new ball
        ("scored", "i8"),  # the score at the end of the last step
        ("key", "i8"), ("number", "i8"),  # the environment's seed, and which of its episodes this is, from 0
    ],
    align=True,
)  # fmt: skip

SCENE = np.dtype(
    [
        ("board", "i8"),  # −1: nothing has been drawn
        ("x", "f8", (BALL_COUNT,)), ("z", "f8", (BALL_COUNT,)), ("alive", "i8", (BALL_COUNT,)),
        ("paddle", "i8", (2,)),  # the numbers of their sprites; −1: there is no such paddle
        ("lit", "i8"),  # bit i: the shape i of the board was hit in this step
    ],
    align=True,
)  # fmt: skip
"""What one picture shows; pictures are drawn from nothing else, so that they can be drawn again."""

LIT_BITS = 62  # shapes that can light up

RULES = np.dtype(
    [
        ("ticks", "i8"), ("tick", "f8"),  # of a step; the length of one [s]
        ("balls", "i8"), ("by_button", "i8"),  # balls of an episode; 1: a button creates them
        ("weights", "f8", (len(COUNTS) + 2,)),  # of the terms of a reward, see `rewards.TERMS`
        ("weighs_counts", "i8"), ("writes_terms", "i8"),  # 1: counts have weights; a callable needs terms
        ("stall", "i8"), ("limit", "i8"),  # steps
        ("jitter_bit", "i8"), ("create_bit", "i8"),  # 0: there is no such button
        ("boards", "i8"), ("own_boards", "i8"),  # 1: environment i plays board i, in turn if there are fewer
        ("mode", "i8"),
        ("per_x", "f8"), ("per_z", "f8"), ("per_speed", "f8"), ("per_quiet", "f8"), ("per_ball", "f8"),
        ("rest", "f8", (2,)), ("up", "f8", (2,)),  # angles of the paddles [rad]
        ("per_angle", "f8", (2,)), ("per_turn", "f8", (2,)),
        # What is observed: 1 for each thing that is to be written.
        ("state", "i8"), ("layout", "i8"), ("pictures", "i8"),
        ("copies", "i8"),  # 1: the window of pictures is copied
        ("mends", "i8"),  # 1: nobody else writes to the pictures, so that what has moved can be mended
        ("redraw", "i8"),  # 1: the pictures lie in a new array, so that none of them can stay as it is
    ],
    align=True,
)  # fmt: skip

FILM = np.dtype(
    [
        ("height", "i8"), ("width", "i8"), ("channels", "i8"),
        ("rows", "f8"), ("columns", "f8"),  # pixels per u
        ("half_length", "f8"), ("half_width", "f8"),
        ("stack", "i8"),  # pictures of an observation
        ("at", "i8"), ("wraps", "i8"),  # where the window begins; 1: the pictures must be moved there first
        ("ball_rows", "i8"), ("ball_columns", "i8"),  # from the middle of its sprite to the end
        ("paddle_row", "i8", (2,)), ("paddle_column", "i8", (2,)),  # first pixel of the sprites
        ("paddle_rows", "i8"), ("paddle_columns", "i8"),
        ("red", "i8"), ("green", "i8"), ("blue", "i8"),  # of a part that lights up; red alone if grey
    ],
    align=True,
)  # fmt: skip
