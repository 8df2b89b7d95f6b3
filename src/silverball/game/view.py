"""The view of a game as plain values, and the events that it reports.

The score display, the sounds, films and programs of your own read nothing else of a game.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple


class Mode(StrEnum):
    """The two built-in games; where a mode is expected, its string will do.

    Examples:
        >>> import silverball as sb
        >>> sb.Mode("free") is sb.Mode.FREE
        True
    """

    FREE = "free"  # the original game: any number of balls, two at a time, points without combos
    ARCADE = "arcade"  # three balls, combos, ball save, tilt and high scores


class Phase(StrEnum):
    """The phase of a game.

    Examples:
        >>> import silverball as sb
        >>> sb.Game("classic", seed=7).phase is sb.Phase.READY
        True
    """

    READY = "ready"  # no ball is in play; `create_ball` starts one
    PLAY = "play"
    OVER = "over"  # the game has ended; nothing moves any more


class GameEventKind(StrEnum):
    """The kinds of game events.

    Examples:
        >>> import silverball as sb
        >>> sb.GameEventKind.TILT.value
        'tilt'
    """

    BALL_READY = "ball_ready"  # value: the number of the next ball
    SCORED = "scored"  # value: the points of one hit, multiplier included; part: the part that was hit
    COMBO = "combo"  # value: hits in a row, from the second on
    DOUBLE_ON = "double_on"  # a second ball is in play: points are multiplied; value: the multiplier
    DOUBLE_OFF = "double_off"
    BALL_SAVED = "ball_saved"  # a ball lost in its first seconds comes back; value: its number
    BALL_LOST = "ball_lost"  # value: the number of the ball
    WARNING = "warning"  # value: tilt warnings of this ball so far
    TILT = "tilt"  # the paddles are dead until the board is empty
    UNSTUCK = "unstuck"  # the machine has shoved a ball that lay still
    OVER = "over"  # value: the score
    # Of tables with rules of their own:
    MESSAGE = "message"  # part: a text for the display
    CUE = "cue"  # part: the name of a sound or a show
    MODE_STARTED = "mode_started"  # part: the name of the mode
    MODE_ENDED = "mode_ended"
    EXTRA_BALL = "extra_ball"  # value: the extra balls to come
    BALL_LOCKED = "ball_locked"  # value: the balls that are locked; part: the hole
    MULTIBALL = "multiball"  # value: the balls in play
    # Of a match of several players:
    PLAYER_UP = "player_up"  # the machine is handed on; value: the number of the next player


class GameEvent(NamedTuple):
    """One event of a game.

    Attributes:
        kind: The kind of event.
        tick: The tick in which it happened.
        value: A number that belongs to it; see `GameEventKind`.
        part: The path of the part that was hit, such as "cylinder[0]"; of rules of the table also a text, a
        cue or
            the name of a mode. Empty for other events.

    Examples:
        >>> import silverball as sb
        >>> game = sb.Game("classic", seed=7)
        >>> game.events[0].kind
        <GameEventKind.BALL_READY: 'ball_ready'>
    """

    kind: GameEventKind
    tick: int
    value: int = 0
    part: str = ""


class GameView(NamedTuple):
    """Everything that a display of a game shows, at one moment.

    Attributes:
        mode: The mode of the game.
        phase: The phase of the game.
        score: Points so far.
        ball: The number of the present ball, from 1; in free play the balls created so far.
        balls: Balls of the whole game; 0 means any number.
        on_board: Balls on the board now.
        combo: Hits in a row so far; 0 if there are none or the time for the next one is over.
        multiplier: The present multiplier of points.
        save_left: How long a lost ball would still be returned [s].
        warnings: Tilt warnings of this ball so far.
        tilted: Whether the paddles are dead.
        max_balls: The most balls that the table allows at once.
        player: The number of the player who is up, from 1; `score`, `ball` and the like are theirs.
        scores: The points of all players; empty with one player.

    Examples:
        >>> import silverball as sb
        >>> view = sb.Game("classic", seed=7).view
        >>> view.ball, view.balls, view.score
        (1, 3, 0)
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
    max_balls: int
    player: int = 1
    scores: tuple[int, ...] = ()
