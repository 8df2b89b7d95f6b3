"""What does a game make of what happens? Pure functions from an event to points, balls left and news.

A `RuleState` is all that the rules remember, `RuleConfig` are the table's numbers in ticks. Every function
takes both, with the tick, and gives the next standing and the news; nothing here has a state of its own or
knows
of a world. Ticks are counted from the game's beginning; the events of a tick carry its number, and what the
player or the machine does comes before the tick of its number.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Self

from silverball.game import tilt
from silverball.game.view import GameEvent, GameEventKind, Mode

if TYPE_CHECKING:
    from silverball.table import Table

RULES_VERSION = 1
"""Raised whenever the same table, seed and inputs would give another game than before by these rules."""

NO_COMBOS = -1  # ticks within which hits make a combo where none do


class RuleConfig(NamedTuple):
    """The rules of one game in ticks; see `silverball.table.Arcade` for their meaning.

    Attributes:
        mode: Which game.
        balls: Of the whole game; 0: as many as one likes.
        most_balls: On the board at once.
        save_ticks: A ball lost within so many ticks of its start is given back.
        saves: So often for one ball.
        combo_ticks: So long a combo waits for the next hit; negative: there are no combos.
        combo_step: Hits that raise the factor by one.
        combo_limit: Its greatest value.
        double: The factor while two balls are on the board.
        tilt_decay: Of the swing [tick].
        tilt_warning: A swing that is warned of.
        tilt_limit: A swing that is a tilt.
        warnings: For each ball.
        un_stick: After so many ticks a still ball is shoved.
        stall: After so many ticks without a hit that scores every ball is.
    """

    mode: Mode
    balls: int
    most_balls: int
    save_ticks: int
    saves: int
    combo_ticks: int
    combo_step: int
    combo_limit: int
    double: int
    tilt_decay: float
    tilt_warning: float
    tilt_limit: float
    warnings: int
    un_stick: int
    stall: int

    @classmethod
    def of(cls, table: Table, mode: Mode, tick_rate: int) -> Self:
        """The laws of a game on a table."""
        arcade, most = table.arcade, table.board.max_balls
        plays = mode is Mode.ARCADE
        return cls(
            mode=mode,
            balls=arcade.balls if plays else 0,
            most_balls=most,
            save_ticks=round(arcade.ball_save * tick_rate) if plays else 0,
            saves=arcade.ball_saves if plays else 0,
            combo_ticks=round(arcade.combo_window * tick_rate)
            if plays and arcade.combo_window
            else NO_COMBOS,
            combo_step=arcade.combo_step,
            combo_limit=arcade.combo_limit,
            double=arcade.double if plays else 1,
            tilt_decay=arcade.tilt_decay * tick_rate,
            tilt_warning=arcade.tilt_warning,
            tilt_limit=arcade.tilt_limit,
            warnings=arcade.warnings,
            un_stick=round(arcade.un_stick * tick_rate),
            stall=round(arcade.stall * tick_rate),
        )


class InPlay(NamedTuple):
    """A ball of the game.

    Attributes:
        id: In the world; 0 while it waits to be put back.
        number: In the game: 1, 2, 3, …
        safe_until: Lost before this tick it is given back.
        saves: How often that may still be.
    """

    id: int
    number: int
    safe_until: int
    saves: int


class RuleState(NamedTuple):
    """All that the rules remember of a game.

    Attributes:
        score: Points so far.
        used: Balls started so far.
        balls: The balls in play, with those that wait to be put back.
        combo: Hits in a row.
        combo_tick: When the last of them was.
        warnings: Of the present ball.
        swing: Of the plumb-bob after the last shove.
        swing_tick: When that was.
        tilted: Whether the paddles are dead.
        quiet_since: When there last was a hit that scores, or a new ball.
        over: Whether the game has ended.
    """

    score: int = 0
    used: int = 0
    balls: tuple[InPlay, ...] = ()
    combo: int = 0
    combo_tick: int = 0
    warnings: int = 0
    swing: float = 0.0
    swing_tick: int = 0
    tilted: bool = False
    quiet_since: int = 0
    over: bool = False

    @property
    def waiting(self) -> tuple[InPlay, ...]:
        """The balls that are to be put back."""
        return tuple(ball for ball in self.balls if ball.id == 0)


Outcome = tuple[RuleState, tuple[GameEvent, ...]]


def refusal(laws: RuleConfig, now: RuleState) -> str:
    """Why the player cannot bring a ball now, as a sentence; empty if nothing in the rules forbids it."""
    if now.over:
        return "the game is over; begin a new one to play on"
    if now.tilted:
        return "tilt: the next ball comes when the board is empty"
    if laws.balls and now.used >= laws.balls:
        return f"no ball is left: this is ball {now.used} of {laws.balls}"
    if now.waiting and len(now.balls) >= laws.most_balls:
        return "the ball that was saved comes back first; wait until there is room for it"
    return ""


def started(laws: RuleConfig, now: RuleState, tick: int, ball: int) -> Outcome:
    """The player has brought a ball, which has this id in the world; only one that comes alone is saved."""
    saves = laws.saves if not now.balls else 0
    mine = InPlay(ball, now.used + 1, tick + laws.save_ticks if saves else 0, saves)
    after = now._replace(used=now.used + 1, balls=(*now.balls, mine), quiet_since=tick)
    doubles = laws.double > 1 and len(after.balls) > 1
    return after, (GameEvent(GameEventKind.DOUBLE_ON, tick, laws.double),) if doubles else ()


def put_back(laws: RuleConfig, now: RuleState, tick: int, ball: int) -> Outcome:
    """The first of the waiting balls is on the board again, under this id."""
    back = now.waiting[0]
    safe = tick + laws.save_ticks if back.saves else 0
    balls = list(now.balls)
    balls[balls.index(back)] = back._replace(id=ball, safe_until=safe)
    return now._replace(balls=tuple(balls), quiet_since=tick), ()


def hit(laws: RuleConfig, now: RuleState, tick: int, points: int, part: str) -> Outcome:
    """A ball has hit a part that is worth points."""
    now = now._replace(quiet_since=tick)
    if now.tilted:
        return now, ()
    combo = running_combo(laws, now, tick) + 1 if laws.combo_ticks >= 0 else 0
    now = now._replace(combo=combo, combo_tick=tick)
    worth = points * multiplier(laws, now, tick)
    news: tuple[GameEvent, ...] = (GameEvent(GameEventKind.SCORED, tick, worth, part),)
    if combo > 1:
        news += (GameEvent(GameEventKind.COMBO, tick, combo, part),)
    return now._replace(score=now.score + worth), news


def running_combo(laws: RuleConfig, now: RuleState, tick: int) -> int:
    """Hits in a row so far, 0 if the time for the next one is over."""
    return now.combo if tick - now.combo_tick <= laws.combo_ticks else 0


def multiplier(laws: RuleConfig, now: RuleState, tick: int) -> int:
    """By which points are multiplied: the factor of the combo, and that of two balls."""
    combo = running_combo(laws, now, tick)
    factor = min(1 + max(combo - 1, 0) // laws.combo_step, laws.combo_limit)
    return factor * (laws.double if len(now.balls) > 1 else 1)


def drained(laws: RuleConfig, now: RuleState, tick: int, ball: int) -> Outcome:
    """A ball has left through the gutter."""
    gone = next((one for one in now.balls if one.id == ball), None)
    if gone is None:
        return now, ()
    others = tuple(one for one in now.balls if one is not gone)
    if gone.saves and tick < gone.safe_until and not now.tilted:
        waits = gone._replace(id=0, saves=gone.saves - 1, safe_until=0)
        saved = (GameEvent(GameEventKind.BALL_SAVED, tick, gone.number),)
        return now._replace(balls=(*others, waits)), saved
    news: tuple[GameEvent, ...] = (GameEvent(GameEventKind.BALL_LOST, tick, gone.number),)
    if laws.double > 1 and len(now.balls) > 1 and len(others) <= 1:
        news += (GameEvent(GameEventKind.DOUBLE_OFF, tick),)
    now = now._replace(balls=others)
    if others:
        return now, news
    now = now._replace(tilted=False, warnings=0, combo=0)
    if laws.balls and now.used >= laws.balls:
        return now._replace(over=True), (*news, GameEvent(GameEventKind.OVER, tick, now.score))
    return now, (*news, GameEvent(GameEventKind.BALL_READY, tick, now.used + 1))


def shoved(laws: RuleConfig, now: RuleState, tick: int) -> Outcome:
    """The player shoves the table; in free play that costs nothing."""
    if laws.mode is Mode.FREE or now.tilted:
        return now, ()
    swing = tilt.faded(now.swing, tick - now.swing_tick, laws.tilt_decay) + tilt.SHOVE
    verdict = tilt.judged(swing, now.warnings, laws.tilt_warning, laws.tilt_limit, laws.warnings)
    now = now._replace(swing=swing, swing_tick=tick)
    if verdict is tilt.Verdict.TILT:
        return now._replace(tilted=True, combo=0), (GameEvent(GameEventKind.TILT, tick),)
    if verdict is tilt.Verdict.WARNING:
        now = now._replace(warnings=now.warnings + 1)
        return now, (GameEvent(GameEventKind.WARNING, tick, now.warnings),)
    return now, ()


def ended(now: RuleState, tick: int) -> Outcome:
    """The game ends here, whoever wants it."""
    if now.over:
        return now, ()
    return now._replace(over=True), (GameEvent(GameEventKind.OVER, tick, now.score),)


def points_by_part(table: Table) -> dict[str, int]:
    """The points for a hit, by the path of the part, as events give it."""
    points = {f"paddle.{paddle.side}": paddle.points for paddle in table.paddle}
    for kind in ("slant_wall", "triangular_prism", "cylinder"):
        points |= {f"{kind}[{number}]": part.points for number, part in enumerate(getattr(table, kind))}
    return points
