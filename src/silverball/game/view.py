"""What does a game tell of itself? Its face, as plain values, and the news since it was last asked.

The display, the sounds and the films read these two and nothing else of a game.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple


class Mode(StrEnum):
    """Which game is played."""

    FREE = "free"  # the original: as many balls as one likes, two at a time
    ARCADE = "arcade"  # three balls, points for combos, tilt, high scores


class Phase(StrEnum):
    """Where a game stands."""

    READY = "ready"  # no ball on the board; Space brings one
    PLAY = "play"
    OVER = "over"  # the last ball is gone; nothing moves any more


class GameEventKind(StrEnum):
    """What there is to tell."""

    BALL_READY = "ball_ready"  # value: the number of the ball that comes next
    SCORED = "scored"  # value: points of one hit, everything counted in; part: which one was hit
    COMBO = "combo"  # value: hits in a row, from the second one on
    DOUBLE_ON = "double_on"  # two balls on the board: points count twice
    DOUBLE_OFF = "double_off"
    BALL_SAVED = "ball_saved"  # a ball lost in its first seconds does not count
    BALL_LOST = "ball_lost"  # value: the number of the ball that is lost
    WARNING = "warning"  # value: warnings of this ball so far; one more shove too many is a tilt
    TILT = "tilt"  # paddles are dead until the board is empty
    UNSTUCK = "un_stuck"  # a still ball was shoved by the machine
    OVER = "over"  # value: the score


class GameEvent(NamedTuple):
    """One thing that happened in a game.

    Attributes:
        kind: What happened.
        tick: When.
        value: A number that belongs to it, see `GameEventKind`.
        part: The path of the part that was hit, if one was.
    """

    kind: GameEventKind
    tick: int
    value: int = 0
    part: str = ""


class GameView(NamedTuple):
    """What there is to show of a game at one time.

    Attributes:
        mode: Which game.
        phase: Where it stands.
        score: Points so far.
        ball: The number of the present ball, from 1; in free play the balls created so far.
        balls: Balls of the whole game; 0: as many as one likes.
        on_board: Balls on the board now.
        combo: Hits in a row so far, 0 if none or the time for the next one is over.
        multiplier: By which points are multiplied now.
        save_left: How long a lost ball would still be given back [s].
        warnings: Tilt warnings of this ball so far.
        tilted: Whether the paddles are dead.
        most_balls: How many balls the table allows at once.
    """

    mode: Mode
    phase: Phase
    score: int
    ball: int
    balls: int
    on_board: int
    combo: int
    multiplier: int
    save_left: float
    warnings: int
    tilted: bool
    most_balls: int
