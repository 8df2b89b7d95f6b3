"""The built-in rules: arcade play with balls, combos, ball save and tilt; free play with plain points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from silverball.game import tilt
from silverball.game.rules import NO_COMBOS, InPlay, Outcome, RuleConfig, RuleState, running_combo
from silverball.game.view import GameEvent, GameEventKind, Mode

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
        saves = config.saves if not state.balls else 0
        new = InPlay(ball, state.used + 1, tick + config.save_ticks if saves else 0, saves)
        after = state._replace(used=state.used + 1, balls=(*state.balls, new), quiet_since=tick)
        doubles = config.double > 1 and len(after.balls) == 2
        return after, (GameEvent(GameEventKind.DOUBLE_ON, tick, config.double),) if doubles else ()

    def returned(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """Put the first of the waiting balls into play again."""
        waiting = state.waiting[0]
        safe_until = tick + config.save_ticks if waiting.saves else 0
        balls = list(state.balls)
        balls[balls.index(waiting)] = waiting._replace(id=ball, safe_until=safe_until)
        return state._replace(balls=tuple(balls), quiet_since=tick), ()

    def hit(self, config: RuleConfig, state: RuleState, tick: int, points: int, part: str) -> Outcome:
        """Count the points of a part, multiplied; a part without points changes nothing."""
        if not points:
            return state, ()
        state = state._replace(quiet_since=tick)
        if state.tilted:
            return state, ()
        combo = running_combo(config, state, tick) + 1 if config.combo_ticks >= 0 else 0
        state = state._replace(combo=combo, combo_tick=tick)
        worth = points * self.multiplier(config, state, tick)
        events: tuple[GameEvent, ...] = (GameEvent(GameEventKind.SCORED, tick, worth, part),)
        if combo > 1:
            events += (GameEvent(GameEventKind.COMBO, tick, combo, part),)
        return state._replace(score=state.score + worth), events

    def multiplier(self, config: RuleConfig, state: RuleState, tick: int) -> int:
        """The multiplier of the combo, times that of two or more balls."""
        combo = running_combo(config, state, tick)
        factor = min(1 + max(combo - 1, 0) // config.combo_step, config.combo_limit)
        return factor * (config.double if len(state.balls) > 1 else 1)

    def drained(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """Save or lose a ball; losing the last one in play ends the turn, losing the last of all the game."""
        lost = next((in_play for in_play in state.balls if in_play.id == ball), None)
        if lost is None:
            return state, ()
        others = tuple(in_play for in_play in state.balls if in_play is not lost)
        if lost.saves and tick < lost.safe_until and not state.tilted:
            waiting = lost._replace(id=0, saves=lost.saves - 1, safe_until=0)
            saved = (GameEvent(GameEventKind.BALL_SAVED, tick, lost.number),)
            return state._replace(balls=(*others, waiting)), saved
        events: tuple[GameEvent, ...] = (GameEvent(GameEventKind.BALL_LOST, tick, lost.number),)
        if config.double > 1 and len(state.balls) > 1 and len(others) <= 1:
            events += (GameEvent(GameEventKind.DOUBLE_OFF, tick),)
        state = state._replace(balls=others)
        if others:
            return state, events
        state = state._replace(tilted=False, warnings=0, combo=0)
        if config.balls and state.used >= config.balls:
            return state._replace(over=True), (*events, GameEvent(GameEventKind.OVER, tick, state.score))
        return state, (*events, GameEvent(GameEventKind.BALL_READY, tick, state.used + 1))

    def launched(self, config: RuleConfig, state: RuleState, tick: int, ball: int) -> Outcome:
        """Let the time in which a lost ball is saved begin when it leaves the plunger."""
        balls = tuple(
            in_play._replace(safe_until=tick + config.save_ticks)
            if in_play.id == ball and in_play.safe_until
            else in_play
            for in_play in state.balls
        )
        return state._replace(balls=balls, quiet_since=tick), ()

    def shoved(self, config: RuleConfig, state: RuleState, tick: int) -> Outcome:
        """Swing the tilt bob: nothing, a warning or a tilt."""
        if state.tilted:
            return state, ()
        swing = tilt.decayed(state.swing, tick - state.swing_tick, config.tilt_decay) + tilt.SHOVE
        state = state._replace(swing=swing, swing_tick=tick)
        limits = config.tilt_warning, config.tilt_limit, config.warnings
        match tilt.shove_result(swing, state.warnings, *limits):
            case tilt.ShoveResult.TILT:
                return state._replace(tilted=True, combo=0), (GameEvent(GameEventKind.TILT, tick),)
            case tilt.ShoveResult.WARNING:
                state = state._replace(warnings=state.warnings + 1)
                return state, (GameEvent(GameEventKind.WARNING, tick, state.warnings),)
        return state, ()


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
