"""The interface between a game and its rules: their arguments, their state and their results.

`Rules` is a protocol of pure functions: each takes the configuration and the state, and returns the next
state and the events to report. `ArcadeRules` and `FreeRules` (`builtin_rules`) implement it; pass your own
implementation as `Game(..., rules=...)`.

Ticks count from the beginning of the game. An event that happens within a tick carries the number of that
tick; an action of the player or of the machine comes before the tick whose number it carries.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

from silverball.game.view import GameEvent, GameEventKind, Mode
from silverball.referee.combo import hits_in_a_row
from silverball.referee.rule_config import NO_COMBOS as NO_COMBOS, RuleConfig as RuleConfig  # noqa: PLC0414

if TYPE_CHECKING:
    from silverball.table import Table

RULES_VERSION = 1
"""Incremented when the built-in rules change the game for the same table, seed and inputs."""

NAME_LIMIT = 60  # characters of the name of rules


class InPlay(NamedTuple):
    """A ball in play.

    Attributes:
        id: Its id in the world; 0 while it waits to return to the board.
        number: Its number in the game: 1, 2, 3, …
        safe_until: If it is lost before this tick, it is returned.
        saves: How often it may still be returned.

    Examples:
        >>> import silverball as sb
        >>> sb.InPlay(id=4, number=1, safe_until=960, saves=1).number
        1
    """

    id: int
    number: int
    safe_until: int
    saves: int


class RuleState(NamedTuple):
    """The state of the rules in a game; it is part of saved games and of their digests.

    Attributes:
        score: Points so far, at least 0.
        used: Balls started so far.
        balls: The balls in play, including those that wait to return.
        combo: Hits in a row.
        combo_tick: The tick of the last of them.
        warnings: Tilt warnings of the present ball.
        swing: Swing of the tilt bob after the last shove.
        swing_tick: The tick of that shove.
        tilted: Whether the paddles are dead.
        quiet_since: The tick of the last hit that scored or of the last new ball: there is an automatic shove
            if this was too long ago.
        over: Whether the game has ended.
        memory: State of custom rules, a JSON value; never change it in place.
        open_gates: The names of the held gates that are open; custom rules change it. A gate closes as soon
            as no ball is in its way.

    Examples:
        >>> import silverball as sb
        >>> sb.RuleState(score=10)._replace(score=20).score
        20
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
    memory: Any = None
    open_gates: tuple[str, ...] = ()

    @property
    def waiting(self) -> tuple[InPlay, ...]:
        """The balls that wait to return to the board."""
        return tuple(ball for ball in self.balls if ball.id == 0)


Outcome: TypeAlias = tuple[RuleState, tuple[GameEvent, ...]]
"""What rules return: the next state, and the events to report."""


class Rules(Protocol):
    """The scoring of a game, as `Game(..., rules=...)` takes it.

    What a table file can say as data runs compiled, and any replay of it verifies (docs/rules.md). Rules in
    Python are slower, play one world, and a replay verifies only with them.

    All methods are pure: the same arguments give the same result, and the object holds no state of a game.
    Otherwise replays cannot be verified, and saved games continue differently. To change only some of the
    built-in rules, derive from `ArcadeRules` or `FreeRules`.

    Attributes:
        name: Written to replays and saved games; up to 60 printable characters, not the name of a mode.

    Examples:
        >>> import silverball as sb
        >>> class Cylinders(sb.ArcadeRules):
        ...     name = "only cylinders"
        ...     def hit(self, config, state, tick, points, part):
        ...         worth = 10 if part.startswith("cylinder") else 0
        ...         return super().hit(config, state, tick, worth, part)
        >>> game = sb.Game("classic", seed=7, rules=Cylinders())
        >>> game.create_ball()
        >>> game.step(ticks=2400)
        >>> game.score % 10
        0
    """

    @property
    def name(self) -> str:
        """The name of the rules."""

    def configure(self, table: Table, tick_rate: int) -> RuleConfig:
        """The numbers of a game on a table; called once, when the game is made."""

    def refusal(self, config: RuleConfig, state: RuleState) -> str:
        """Why the player cannot start a ball now, as a sentence; empty if the rules allow it."""

    def started(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """The player has started the ball with this id."""

    def returned(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """The first of the waiting balls is on the board again, with this id."""

    def hit(self, config: RuleConfig, state: RuleState, tick: int, points: int, part: str) -> Outcome:
        """A ball has hit or passed a part, has been captured by it, or has turned it once.

        Args:
            config: The rule settings of this game.
            state: The state before.
            tick: The tick of the hit.
            points: The points of the part in the table.
            part: The path of the part. Empty for hits that did not fit into the event log of the world, as
                in a jam: `points` is their sum then.
        """

    def drained(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """The ball with this id has left through the gutter or a drain."""

    def launched(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """The plunger has launched the ball with this id; only on tables with a plunger."""

    def shoved(self, config: RuleConfig, state: RuleState, tick: int) -> Outcome:
        """The player has shoved the table."""

    def multiplier(self, config: RuleConfig, state: RuleState, tick: int) -> int:
        """The present multiplier of points, for the display."""


def running_combo(config: RuleConfig, state: RuleState, tick: int) -> int:
    """Hits in a row so far; 0 if the time for the next one is over."""
    return hits_in_a_row(state.combo, state.combo_tick, config.combo_ticks, tick)


def ended(state: RuleState, tick: int) -> Outcome:
    """Return the state of a game that ends now, and its last event; independent of the rules."""
    if state.over:
        return state, ()
    return state._replace(over=True), (GameEvent(GameEventKind.OVER, tick, state.score),)


def is_custom_name(name: object) -> bool:
    """Whether custom rules may have this name."""
    if not isinstance(name, str) or name != name.strip() or not 0 < len(name) <= NAME_LIMIT:
        return False
    return name.isprintable() and name not in {str(mode) for mode in Mode}
