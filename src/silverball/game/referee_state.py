"""The state of a game as the referee keeps it, a GAME record, and as plain values."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.game.rules import InPlay, RuleState
from silverball.physics.records import LAUNCH, LEFT, MAX_BALLS, RIGHT
from silverball.referee.game_records import FOREVER, GAME, IN_PLAY, NOT_RUNNING, Light

if TYPE_CHECKING:
    from silverball.referee.compile_rules import RuleBooks

SAME_NAMES = ("score", "used", "combo", "combo_tick", "warnings", "swing", "swing_tick", "quiet_since")
FLAGS = ("tilted", "over")
TABLE_FIELDS = ("fallen", "open_gates", "resets", "extra_balls", "locked")
TABLE_ROWS = (("lamp", "lamps"), ("counter", "counters"), ("mode_end", "modes"))
NUMBER_LIMIT = 2**62
_AT = {name: int(field[1]) // 8 for name, field in (GAME.fields or {}).items()}  # places in words
_BALL_WORDS = IN_PLAY.itemsize // 8
_END = 1 + max(_AT[name] for name in (*SAME_NAMES, *FLAGS, "balls"))


class Rest(NamedTuple):
    """The place that a ball has not left, and since when.

    Attributes:
        ball: The id of the ball.
        x: Position up the table [u].
        z: Position across the table [u].
        since: The tick of that look.
    """

    ball: int
    x: float
    z: float
    since: int


class StuckTracker(NamedTuple):
    """What the look for balls that lie still has noted.

    Attributes:
        rests: One for each ball on the board.
        released: The tick in which a button was last released.
        shoved: The tick of the last automatic shove.
    """

    rests: tuple[Rest, ...] = ()
    released: int = 0
    shoved: int = 0


class TableState(NamedTuple):
    """What the rules of a table keep, beside what all games have.

    Attributes:
        lamp: The state of every lamp, a `Light`.
        counter: The value of every counter.
        mode_end: The tick in which each mode ends; −1: it does not run.
        fallen: The switches of the drop targets that have fallen, as bits.
        open_gates: The switches of the gates that rules have opened, as bits.
        resets: The banks that are to come back, as bits.
        extra_balls: Extra balls to be played.
        locked: Balls that are locked.
    """

    lamp: tuple[int, ...]
    counter: tuple[int, ...]
    mode_end: tuple[int, ...]
    fallen: int
    open_gates: int
    resets: int
    extra_balls: int
    locked: int


def rule_state(words: NDArray[np.int64]) -> RuleState:
    """The state of the rules that all games have, from the words of a GAME record."""
    found = words[:_END].tolist()
    first = _AT["ball"]
    places = range(first, first + _BALL_WORDS * found[_AT["balls"]], _BALL_WORDS)
    values: dict[str, Any] = {name: found[_AT[name]] for name in SAME_NAMES}
    values |= {name: bool(found[_AT[name]]) for name in FLAGS}
    values["swing"] = words[_AT["swing"] : _AT["swing"] + 1].view(np.float64).item()
    return RuleState(balls=tuple(InPlay(*found[at : at + _BALL_WORDS]) for at in places), **values)


def tracker_of(game: Any) -> StuckTracker:
    """What the look for balls that lie still has noted."""
    rests = tuple(Rest(*row) for row in game["rest"][: game["rests"]].tolist())
    return StuckTracker(rests, int(game["released"]), int(game["shoved"]))


def table_state(game: Any, books: RuleBooks) -> TableState | None:
    """What the rules of the table keep; None if it has none of its own."""
    setup = books.setups[0]
    if not books.is_own[0]:
        return None
    values: dict[str, Any] = {name: tuple(game[name][: setup[count]].tolist()) for name, count in TABLE_ROWS}
    return TableState(**values | {name: int(game[name]) for name in TABLE_FIELDS})


def set_rule_state(words: NDArray[np.int64], state: RuleState) -> None:
    """Write the state that all games have into the words of a GAME record.

    Raises:
        ValueError, OverflowError, TypeError: A game cannot have it.
    """
    count = len(state.balls)
    if count > MAX_BALLS:
        raise ValueError(f"a game has at most {MAX_BALLS} balls in play, got {count}")
    values = words[:_END].tolist()
    for name in (*SAME_NAMES, *FLAGS):
        values[_AT[name]] = _whole(getattr(state, name)) if name != "swing" else 0
    first = _AT["ball"]
    balls = [_whole(value) for ball in state.balls for value in ball]
    values[first : first + len(balls)] = balls
    for place in range(first + len(balls), first + _BALL_WORDS * MAX_BALLS):
        values[place] = 0
    values[_AT["balls"]] = count
    swing = float(_number(state.swing))
    words[:_END] = values
    words[_AT["swing"] : _AT["swing"] + 1].view(np.float64)[0] = swing


def set_tracker(game: Any, tracker: StuckTracker) -> None:
    """Write what has been noted of balls that lie still into a GAME record.

    Raises:
        ValueError, OverflowError, TypeError: A game cannot have it.
    """
    if len(tracker.rests) > MAX_BALLS:
        raise ValueError(f"a game has at most {MAX_BALLS} balls that lie still, got {len(tracker.rests)}")
    game["rest"] = 0
    for place, rest in enumerate(tracker.rests):
        game["rest"][place] = tuple(map(_number, rest))
    game["rests"] = len(tracker.rests)
    game["released"], game["shoved"] = _number(tracker.released), _number(tracker.shoved)


def set_table_state(game: Any, state: TableState | None, books: RuleBooks) -> None:
    """Write what the rules of the table keep into a GAME record.

    Raises:
        ValueError, OverflowError, TypeError: A game on this table cannot have it.
    """
    setup = books.setups[0]
    if (state is None) == books.is_own[0]:
        raise ValueError("the state is not of a game with the rules of this table")
    if state is None:
        return
    for name, count in TABLE_ROWS:
        values = [int(_number(value)) for value in getattr(state, name)]
        if len(values) != setup[count] or not all(NOT_RUNNING <= value <= FOREVER for value in values):
            raise ValueError(f"the state has other {count} than the table")
        game[name][: len(values)] = values
    if any(value not in set(Light) for value in state.lamp) or any(value < 0 for value in state.counter):
        raise ValueError("the state has a lamp or a counter that no game has")
    for name in TABLE_FIELDS:
        game[name] = max(int(_number(getattr(state, name))), 0)
    running = [end for end in state.mode_end if end != NOT_RUNNING]
    game["next_end"] = min(running, default=FOREVER)


def button_bits(left: bool, right: bool, launch: bool) -> int:
    """The bits of the buttons that are held."""
    return LEFT * bool(left) | RIGHT * bool(right) | LAUNCH * bool(launch)


def _whole(value: Any) -> int:
    """A whole number that a record can hold."""
    number = operator.index(value)
    if not -NUMBER_LIMIT <= number <= NUMBER_LIMIT:
        raise ValueError(f"must be a whole number of at most 62 bits, got {value!r}")
    return number


def _number(value: Any) -> int | float:
    """A number that a record can hold."""
    if not isinstance(value, int | float) or not -NUMBER_LIMIT <= value <= NUMBER_LIMIT:
        raise ValueError(f"must be a number, got {value!r}")
    return value
