"""Records of the compiled step: the state of an episode, the rules, and the contents of pictures.

All fields are eight bytes wide. An environment's state is its WORLD or PLAIN_WORLD record (see
`physics.records`), its EPISODE record and the PICTURE_STATE records of its last pictures. RULES and RASTER
hold the options as numbers.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, TypeAlias

import numpy as np

from silverball.physics.records import MAX_BALLS, MAX_PADDLES
from silverball.referee.game_records import Said


class ResetMode(IntEnum):
    """When an environment whose episode has ended begins a new one (Gymnasium's `AutoresetMode`)."""

    DISABLED = 0  # only by `reset`
    NEXT_STEP = 1  # in the next step, which ignores its action
    SAME_STEP = 2  # in the step that ends it; the last observation is stored separately


class StepFlag(IntEnum):
    """Bits that a step returns for the last environment that it moved."""

    TERMINATED = 1
    TRUNCATED = 2
    WAS_OVER = 4  # the episode had already ended before the step
    COUNTS_CHANGED = 8  # only for an engine of one environment


class Task(IntEnum):
    """Tasks of `run_task`; a number ≥ 0 is a step of the only environment with this action."""

    STEP = -1  # by the actions in their array
    RESET = -2  # the environments in the mask
    OBSERVE = -3  # write the observations again, after states were changed


COUNTS = (
    "score", "created", "drained", "wall_hits", "slant_wall_hits", "paddle_hits", "triangular_prism_hits",
    "cylinder_hits", "ball_hits", "touches", "jams",
)  # fmt: skip
"""The counters of a world record that `info` carries: totals of the episode so far."""

INFO = (*COUNTS, "board", "stalled")
"""The keys of `info`, in the order of the columns of an engine's counts."""

ALL_INFO = (*INFO, "action")
"""The same with the action that was executed, which environments with `sticky` or `recharge` add."""

HAPPENINGS = tuple(said.name.lower() for said in Said)
"""What happens in a game by its rules, as `silverball.GameEventKind` has it."""

GAME_COUNTS = (*HAPPENINGS, "ball", "balls_in_play")
"""The further keys of `info` where episodes are games: how often each of these has happened, the number of
the present ball, and the balls in play. The score is then that of the game."""

CONTROL = np.dtype([("action", "i8"), ("ready", "i8")], align=True)
"""The buttons held in the last step, and the tick from which a paddle can be lifted again."""

EPISODE = np.dtype(
    [
        ("board_seed", "i8"),  # −1: the board was not made from a seed
        ("stalled", "i8"),  # 1: it ended because no hit had scored for too long
        ("over", "i8"),  # 1: it has ended
        ("steps", "i8"),
        ("idle_steps", "i8"),  # since the last scoring hit or the last new ball
        ("last_score", "i8"),  # the score at the end of the last step
        ("seed", "i8"), ("number", "i8"),  # the environment's seed, and which of its episodes this is, from 0
    ],
    align=True,
)  # fmt: skip

LAMP_BITS, LAMP_WORDS = 62, 4
LAMPS = LAMP_BITS * LAMP_WORDS  # parts that can light up

PICTURE_STATE = np.dtype(
    [
        ("board", "i8"),  # −1: nothing has been drawn
        ("off", "i8"),  # the switches whose parts are away
        ("lit", "i8", (LAMP_WORDS,)),  # bit i of word j: lamp i + j · LAMP_BITS is on
        ("paddle", "i8", (MAX_PADDLES,)),  # the numbers of their sprites; −1: there is no such paddle
        ("x", "f8", (MAX_BALLS,)), ("z", "f8", (MAX_BALLS,)), ("alive", "i8", (MAX_BALLS,)),
    ],
    align=True,
)  # fmt: skip
"""Everything that one picture shows; a picture can be drawn again from it."""

PICTURED_BOARD = np.dtype(
    [("lamp_first", "i8"), ("switch_first", "i8"), ("piece_end", "i8")],  # this board's pieces
    align=True,
)

PIECE = np.dtype(
    [
        ("top", "i8"), ("left", "i8"), ("rows", "i8"), ("columns", "i8"),  # its box
        ("mask_first", "i8"),  # its first pixel in the masks
        ("red", "i8"), ("green", "i8"), ("blue", "i8"),  # its colour; only red if grey
        ("switch", "i8"),  # the bit of WORLD.off that removes it; 0: it is always there
    ],
    align=True,
)  # fmt: skip
"""A lamp, or a part that a switch removes: pixels of one colour."""

RULES = np.dtype(
    [
        ("ticks", "i8"), ("tick", "f8"),  # of a step; the length of one [s]
        ("balls", "i8"), ("creates_by_button", "i8"),  # balls of an episode; 1: a button creates them
        ("weights", "f8", (len(COUNTS) + 2,)),  # of the terms of a reward, see `rewards.TERMS`
        ("weighs_counts", "i8"), ("writes_terms", "i8"),  # 1: counts have weights; a callable needs terms
        ("stall_steps", "i8"), ("max_steps", "i8"),
        # Bits of actions; 0: there is no such button.
        ("jitter_bit", "i8"), ("create_bit", "i8"), ("launch_bit", "i8"),
        ("nudge_left_bit", "i8"), ("nudge_right_bit", "i8"), ("nudge_up_bit", "i8"),
        ("boards", "i8"), ("own_boards", "i8"),  # 1: environment i plays board i, modulo their number
        ("mode", "i8"),  # a ResetMode
        # Factors that scale quantities to −1 … 1.
        ("x_scale", "f8"), ("z_scale", "f8"), ("speed_scale", "f8"), ("idle_scale", "f8"),
        ("ball_scale", "f8"), ("angle_scale", "f8", (MAX_PADDLES,)), ("turn_scale", "f8", (MAX_PADDLES,)),
        ("rest_angle", "f8", (MAX_PADDLES,)), ("raised_angle", "f8", (MAX_PADDLES,)),  # of the paddles [rad]
        ("reach", "f8"), ("hides_velocities", "i8"),  # [u] from paddles, within which balls are seen
        # The layout of a state observation: items of these groups, and the first columns of the others.
        ("balls_shown", "i8"), ("paddles_shown", "i8"),
        ("paddle_of", "i8", (MAX_PADDLES,)),  # the paddle that each slot shows; −1: there is none
        ("paddles_at", "i8"), ("game_at", "i8"), ("layout_at", "i8"),
        ("sticky_below", "i8"),  # of 2³² equally likely numbers: those that repeat the last action
        ("recharge_ticks", "i8"), ("supply_at", "i8"),  # between two strokes; the column of the charge
        # The groups of devices, which most tables do not have: 1 if there is any; their items and columns.
        ("shows_devices", "i8"), ("places_shown", "i8"), ("places_at", "i8"),
        ("switches_shown", "i8"), ("switches_at", "i8"), ("spinners_shown", "i8"), ("spinners_at", "i8"),
        ("plungers_shown", "i8"), ("plunger_at", "i8"), ("charge_scale", "f8"),  # per tick of the button
        ("launches_itself", "i8"),  # 1: plungers launch without a button
        # The groups of games by rules, and the score that is shown as a half.
        ("play_at", "i8"), ("lamps_at", "i8"), ("counters_at", "i8"), ("modes_at", "i8"), ("par", "f8"),
        # Flags: 1 if a step writes these.
        ("writes_state", "i8"), ("draws_pictures", "i8"),
        ("copies_stack", "i8"),  # 1: the window of pictures is copied
        ("can_repair", "i8"),  # 1: only the kernels write to the pictures, so that dirty rectangles suffice
        ("must_redraw", "i8"),  # 1: the pictures lie in a new array, so that each must be drawn
    ],
    align=True,
)  # fmt: skip

RASTER = np.dtype(
    [
        ("height", "i8"), ("width", "i8"), ("channels", "i8"),
        ("rows", "f8"), ("columns", "f8"),  # pixels per u
        ("half_length", "f8"), ("half_width", "f8"),
        ("stack", "i8"),  # pictures of an observation
        ("start", "i8"), ("wraps", "i8"),  # of the window in the ring; 1: it moves to the ring's start
        ("ball_rows", "i8"), ("ball_columns", "i8"),  # from the middle of its sprite to the edge
        ("paddle_row", "i8", (MAX_PADDLES,)), ("paddle_column", "i8", (MAX_PADDLES,)),  # of the sprites
        ("paddle_rows", "i8"), ("paddle_columns", "i8"),
        ("red", "i8"), ("green", "i8"), ("blue", "i8"),  # of a part that is lit; only red if grey
    ],
    align=True,
)  # fmt: skip
"""Size and resolution of pictures and of the sprites in them."""

# Records are `Any` to mypy; these names say which record a kernel takes.
RulesRecord: TypeAlias = Any
ControlRecord: TypeAlias = Any
RasterRecord: TypeAlias = Any
PictureStateRecord: TypeAlias = Any
PieceRecord: TypeAlias = Any
