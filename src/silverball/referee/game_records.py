"""The records of games: what changes in one, and the rules of a table as rows of integers.

All fields are eight bytes wide. Points are whole numbers. Times are ticks from the start of the game; an
event that happens within a tick has the number of that tick.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from silverball.physics.records import MAX_BALLS

MAX_LAMPS = 128
MAX_COUNTERS = 64
MAX_MODES = 32
NOT_RUNNING = -1
FOREVER = 2**62  # the end of a mode without an end
MOST_POINTS = 10**15  # a score stops here
QUEUE_LENGTH = 64  # triggers that wait
MOST_MATCHES = 256  # rules of one trigger
MOST_TRIGGERS = 256  # that follow one event; more would be a loop
REPORT_LENGTH = 256  # events of a game that are reported at once

IN_PLAY = np.dtype(
    [
        ("id", "i8"),  # in the world; 0: it waits to come to the table
        ("number", "i8"),  # in the game: 1, 2, 3, …
        ("safe_until", "i8"), ("saves", "i8"),  # lost before this tick it comes back, so many times
    ]
)  # fmt: skip

REST = np.dtype([("ball", "i8"), ("x", "f8"), ("z", "f8"), ("since", "i8")])
"""Where a ball has been since when [tick], as far as it lies still."""

GAME = np.dtype(
    [
        # What is read in every tick comes first: the buttons that are held, as bits; a shove of the player or
        # of the machine that comes with the next tick; the next tick in which a mode ends, and the next one
        # after which balls that lie still are looked for.
        ("over", "i8"), ("tilted", "i8"), ("buttons", "i8"), ("shove", "i8"), ("auto_shove", "i8"),
        ("next_end", "i8"), ("next_look", "i8"),
        ("balls", "i8"),  # in play: the first rows of `ball`
        ("ball", IN_PLAY, (MAX_BALLS,)),
        ("score", "i8"),
        ("used", "i8"),  # balls started
        ("combo", "i8"), ("combo_tick", "i8"),  # hits in a row, and the last of them
        ("quiet_since", "i8"),  # the last hit with points, or the last new ball
        ("warnings", "i8"),
        ("swing", "f8"), ("swing_tick", "i8"),  # of the tilt bob, after the last shove
        ("rests", "i8"), ("released", "i8"), ("shoved", "i8"),  # still balls; ticks of a release, a shove
        # Drop targets that have fallen and gates that are open, as bits of switches; banks that are to come
        # back, as bits.
        ("fallen", "i8"), ("open_gates", "i8"), ("resets", "i8"),
        ("extra_balls", "i8"), ("locked", "i8"),
        ("rest", REST, (MAX_BALLS,)),
        ("mode_end", "i8", (MAX_MODES,)),  # the tick; FOREVER or NOT_RUNNING
        ("counter", "i8", (MAX_COUNTERS,)),
        ("lamp", "i8", (MAX_LAMPS,)),  # Light
    ]
)  # fmt: skip
"""All that changes in a game, without its world."""

SETUP = np.dtype(
    [
        ("balls", "i8"), ("max_balls", "i8"),
        ("save_ticks", "i8"), ("saves", "i8"),
        ("combo_ticks", "i8"), ("combo_step", "i8"), ("combo_limit", "i8"), ("double", "i8"),
        ("tilts", "i8"),  # whether there is a tilt at all
        ("tilt_decay", "f8"), ("tilt_warning", "f8"), ("tilt_limit", "f8"), ("warnings", "i8"),
        ("unstick_ticks", "i8"), ("stall_ticks", "i8"), ("auto_shove", "i8"), ("has_points", "i8"),
        ("check_ticks", "i8"),  # between two looks for balls that lie still
        ("gates", "i8"),  # the switches of all held gates
        ("parts", "i8"), ("lamps", "i8"), ("counters", "i8"), ("modes", "i8"),
        # Where this table's rows begin, and the numbers of its triggers (see `Trigger`).
        ("lamp_first", "i8"), ("counter_first", "i8"), ("mode_first", "i8"), ("part_first", "i8"),
        ("trigger_first", "i8"), ("reach_first", "i8"), ("reach_end", "i8"), ("bank_first", "i8"),
        ("hit_first", "i8"), ("release_first", "i8"), ("down_first", "i8"), ("complete_first", "i8"),
        ("start_first", "i8"), ("end_first", "i8"), ("time_first", "i8"),
    ]
)  # fmt: skip
"""The numbers of a game on one table: those of `RuleConfig`, and where its rules are."""

RULE = np.dtype([("first_condition", "i8"), ("first_effect", "i8"), ("end_effect", "i8")])
"""A rule: its conditions end where its effects begin; both are OP rows."""

OP = np.dtype([("op", "i8"), ("target", "i8"), ("value", "i8"), ("x", "f8"), ("z", "f8")])
"""A condition or an effect on one thing."""

PART_ROW = np.dtype(
    [("points", "i8"), ("switch", "i8"), ("bank", "i8"), ("is_plunger", "i8"), ("auto_ticks", "i8")]
)
"""A part of a table: its points; its switch and its bank if it is a drop target, else 0 and −1; whether it is
a plunger, and after how many ticks it launches by itself the balls that the game brings (0: it does not)."""

BANK_ROW = np.dtype([("switches", "i8")])
"""A bank of drop targets: all its switches."""

LAMP_ROW = np.dtype([("begins", "i8"), ("of_ball", "i8"), ("group", "i8"), ("first", "i8"), ("end", "i8")])
"""A lamp, its group (−1: none), and the first and the end of the group's lamps among the listed numbers."""

COUNTER_ROW = np.dtype([("begins", "i8"), ("of_ball", "i8"), ("most", "i8")])
MODE_ROW = np.dtype([("ticks", "i8"), ("begins", "i8"), ("of_ball", "i8")])
"""A mode: how long it runs (0: without an end), Begin, whether it ends with the ball."""

REACH_ROW = np.dtype([("counter", "i8"), ("value", "i8"), ("trigger", "i8")])
"""A trigger by a counter that reaches a value."""

REPORTED = np.dtype([("kind", "i8"), ("tick", "i8"), ("value", "i8"), ("part", "i8")])

REPORT = np.dtype(
    [
        ("count", "i8"), ("lost", "i8"),
        ("event", REPORTED, (REPORT_LENGTH,)),
        # What the rules act on: the event, and the triggers that wait.
        ("tick", "i8"), ("part", "i8"), ("ball", "i8"), ("points", "i8"), ("worth", "i8"),
        ("queue", "i8", (QUEUE_LENGTH,)), ("head", "i8"), ("waiting", "i8"), ("has_combo", "i8"),
        ("match", "i8", (MOST_MATCHES,)),
        ("rest", REST, (MAX_BALLS,)),
        ("touched", "i8"),  # whether something was moved, so that no tick may follow unasked
        ("late", "i8"),  # whether a ball, a gate or a bank waits until it has room
        ("passed", "i8"),  # points of the hits that were passed to the rules
    ]
)  # fmt: skip
"""What a call reports, and its scratch; not part of the state."""

GameRecord: TypeAlias = Any  # GAME
SetupRecord: TypeAlias = Any  # SETUP
ReportRecord: TypeAlias = Any  # REPORT
OpRecord: TypeAlias = Any  # OP
RestRecord: TypeAlias = Any  # REST


class Light(IntEnum):
    """The state of a lamp."""

    OFF = 0
    ON = 1
    BLINKING = 2


class Begin(IntEnum):
    """When a mode starts by itself."""

    NEVER = 0
    BALL = 1
    GAME = 2


class Trigger(IntEnum):
    """The first triggers of every table. Those of parts, groups, banks, modes and counters follow."""

    START = 0
    LAUNCH = 1
    DRAIN = 2
    SAVE = 3
    LOST = 4
    END = 5
    WARNING = 6
    TILT = 7
    LEFT = 8
    RIGHT = 9
    PLUNGER = 10
    ANY_HIT = 11
    FIRST_OWN = 12


class Own(IntEnum):
    """The counters of the machine; those of a table follow."""

    COMBO = 0
    LOCKED = 1
    EXTRA_BALLS = 2
    COMBO_FACTOR = 3
    BALL_FACTOR = 4
    BALL = 5
    BALLS_LEFT = 6
    IN_PLAY = 7
    WARNINGS = 8
    COUNT = 9


WRITABLE = (Own.COMBO, Own.LOCKED, Own.EXTRA_BALLS)


class Op(IntEnum):
    """What an OP row asks or does; the target is the number of what it names, of a group that of a lamp."""

    IF_LIT = 0
    IF_BLINKING = 1
    IF_UNLIT = 2
    IF_RUNNING = 3
    IF_STOPPED = 4
    IF_AT_LEAST = 5
    IF_BELOW = 6
    ADD = 10
    SET = 11
    AWARD = 12  # the value begins what is awarded
    AWARD_PART = 13
    TIMES = 14
    GIVE = 15  # what has been awarded and multiplied
    LIGHT = 16
    BLINK = 17
    UNLIGHT = 18
    LIGHT_NEXT = 19
    ADVANCE = 20
    ROTATE_LEFT = 21
    ROTATE_RIGHT = 22
    START = 23
    STOP = 24
    EXTEND = 25
    SAVE = 26
    EXTRA_BALL = 27
    KICK = 28
    LOCK = 29
    EJECT = 30
    RESET = 31
    OPEN = 32
    CLOSE = 33
    MULTIBALL = 34
    MESSAGE = 35
    CUE = 36


class Said(IntEnum):
    """The kinds of reported events; `game/view.py` names them."""

    BALL_READY = 0
    SCORED = 1
    COMBO = 2
    DOUBLE_ON = 3
    DOUBLE_OFF = 4
    BALL_SAVED = 5
    BALL_LOST = 6
    WARNING = 7
    TILT = 8
    UNSTUCK = 9
    OVER = 10
    MESSAGE = 11
    CUE = 12
    MODE_STARTED = 13
    MODE_ENDED = 14
    EXTRA_BALL = 15
    BALL_LOCKED = 16
    MULTIBALL = 17


class Book(NamedTuple):
    """The compiled rules of a table: what kernels read.

    Attributes:
        setup: The SETUP record of the table.
        rules: RULE rows.
        ops: OP rows, the conditions and the effects of each rule.
        triggers: Where the rules of each trigger begin in `listed`, one more than there are triggers.
        listed: Numbers of rules by trigger, and of lamps by group.
        parts: PART_ROW rows.
        lamps: LAMP_ROW rows.
        counters: COUNTER_ROW rows.
        modes: MODE_ROW rows.
        reaches: REACH_ROW rows.
        banks: BANK_ROW rows.
    """

    setup: SetupRecord
    rules: Any
    ops: Any
    triggers: Any
    listed: Any
    parts: Any
    lamps: Any
    counters: Any
    modes: Any
    reaches: Any
    banks: Any


class Play(NamedTuple):
    """A game, and what is reported of it: what kernels write."""

    game: GameRecord
    report: ReportRecord


class Field(NamedTuple):
    """Where a game is played: a world, its board, colliders, grids, places for balls, and the log."""

    world: Any
    board: Any
    colliders: Any
    grid: Any
    places: Any
    log: Any
