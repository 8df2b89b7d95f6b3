"""The built-in rules: arcade play with balls, combos, ball save and tilt; free play with plain points.

A game with built-in rules is scored by the referee (`scorekeeper.py`). The classes here are for rules of
one's own that change only some of them: each function asks the referee what the standard rules make of a
state.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from silverball.game.rules import NO_COMBOS, Outcome, RuleConfig, RuleState, running_combo
from silverball.game.scratch_game import SCRATCH
from silverball.game.view import Mode
from silverball.physics.records import EventKind
from silverball.referee.combo import factor_of_combo
from silverball.referee.judge import Call

if TYPE_CHECKING:
    from silverball.game.rules import Rules
    from silverball.table import Table


class ArcadeRules:
    """Arcade play: a few balls, combos, double points for two or more balls, ball save, and tilt.

    Derive from it to change some of the rules; see `Rules`.

    Examples:
        >>> import silverball as sb
        >>> rules = sb.ArcadeRules()
        >>> config = rules.configure(sb.load_table("classic"), tick_rate=240)
        >>> state, events = rules.hit(config, sb.RuleState(), tick=0, points=100, part="cylinder[0]")
        >>> state.score, [event.kind.value for event in events]
        (100, ['scored'])
    """

    name: str = Mode.ARCADE.value

    def configure(self, table: Table, tick_rate: int) -> RuleConfig:
        """The numbers of the table's `[arcade]` section."""
        return RuleConfig.of(table, tick_rate)

    def refusal(self, config: RuleConfig, state: RuleState) -> str:
        """Why the player cannot start a ball now, as a sentence; empty if the rules allow it."""
        if state.over:
            return "the game is over; begin a new one to play on"
        if state.tilted:
            return "tilt: the next ball comes when the board is empty"
        if config.balls and state.used >= config.balls:
            return f"no ball is left: this is ball {state.used} of {config.balls}"
        if state.waiting and len(state.balls) >= config.max_balls:
            return "the ball that was saved comes back first; wait until there is a free place"
        return ""

    def started(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """Start a ball; only a ball that starts on an empty board is saved."""
        return SCRATCH.outcome(config, state, tick, lambda game: game.judge(Call.START, ball))

    def returned(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """Put the first of the waiting balls into play again."""
        return SCRATCH.outcome(config, state, tick, lambda game: game.judge(Call.RETURN, ball))

    def hit(self, config: RuleConfig, state: RuleState, tick: int, points: int, part: str) -> Outcome:
        """Count the points of a part, multiplied; a part without points changes nothing."""
        if not points:
            return state, ()
        state, events = SCRATCH.outcome(config, state, tick, lambda game: game.hit(points))
        return state, tuple(event._replace(part=part) for event in events)

    def multiplier(self, config: RuleConfig, state: RuleState, tick: int) -> int:
        """The multiplier of the combo, times that of two or more balls."""
        combo = running_combo(config, state, tick)
        factor = factor_of_combo(combo, config.combo_step, config.combo_limit)
        return factor * (config.double if len(state.balls) > 1 else 1)

    def drained(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """Save or lose a ball; losing the last one in play ends the turn, losing the last of all the game."""
        return SCRATCH.outcome(config, state, tick, lambda game: game.happen(EventKind.GUTTER, ball))

    def launched(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """Let the time in which a lost ball is saved begin when it leaves the plunger."""
        return SCRATCH.outcome(config, state, tick, lambda game: game.happen(EventKind.RELEASED, ball))

    def shoved(self, config: RuleConfig, state: RuleState, tick: int) -> Outcome:
        """Swing the tilt bob: nothing, a warning or a tilt."""
        return SCRATCH.outcome(config, state, tick, lambda game: game.judge(Call.SHOVE))


class FreeRules(ArcadeRules):
    """Free play: any number of balls and free shoves; no combos, no ball save, no tilt.

    Examples:
        >>> import silverball as sb
        >>> sb.FreeRules().configure(sb.load_table("classic"), tick_rate=240).balls
        0
    """

    name = Mode.FREE.value

    def configure(self, table: Table, tick_rate: int) -> RuleConfig:
        """The numbers of the table, without the limits of arcade play."""
        return RuleConfig.of(table, tick_rate)._replace(
            balls=0, save_ticks=0, saves=0, combo_ticks=NO_COMBOS, double=1, auto_shove=False
        )

    def shoved(self, config: RuleConfig, state: RuleState, tick: int) -> Outcome:
        """Ignore a shove: free play has no tilt."""
        return state, ()


BUILTIN: dict[Mode, Rules] = {Mode.ARCADE: ArcadeRules(), Mode.FREE: FreeRules()}
"""The rules of each mode."""
