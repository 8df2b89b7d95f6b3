"""A game without its recording: a world and the rules, driven by button presses, new balls and shoves.

The same table, seed, rules and inputs give the same game bit for bit, whether its ticks are played one by one
or many at once. Ticks in which no ball can leave the board are played in one call of the world; where a ball
does leave, the rules must act at that very tick, so ticks are played one by one there.

`Game` adds the recording; `replay.player` plays recordings on a `GameCore`.
"""

from __future__ import annotations

import os
from collections import deque
from typing import TYPE_CHECKING

from silverball.errors import FaultError, NoRoom, SilverballError, StateError
from silverball.game import stuck
from silverball.game.builtin_rules import BUILTIN
from silverball.game.game_world import GameWorld
from silverball.game.mechanisms import SCORING, held_gates, plungers, points_by_part
from silverball.game.replay import recording
from silverball.game.replay.digest import full_digest, short_digests
from silverball.game.replay.recording import MAX_TICK_RATE, MIN_TICK_RATE
from silverball.game.rules import (
    NAME_LIMIT,
    Outcome,
    Rules,
    RuleState,
    ended,
    is_custom_name,
    running_combo,
)
from silverball.game.saved_game import GameState, pack_game, unpack_game
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase
from silverball.world import World

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from silverball.table import Table
    from silverball.world import Event

TICK_RATE = 240
QUEUE_LIMIT = 4096  # events in a queue; if more come before they are taken, the oldest are dropped


class GameCore:
    """A game on one board, from the first ball to the last, without a recording.

    Args:
        table: A table, a built-in name, or a path to a file. A recipe makes a board with the seed.
        seed: Seed of everything random, 0 to 2⁶³ − 1.
        mode: The mode, which names the built-in rules; a `Mode` or its string.
        tick_rate: Ticks per second, 10 to 1,000.
        rules: Custom rules in place of those of the mode.

    Attributes:
        world: The world that is played. Read it, but change it only through the game.
        mode: The mode.
        fault: The fault of the world that ended the game, or None.

    Raises:
        TableError: The table cannot be used.
        ValueError: The mode, seed or tick rate is invalid, or the rules have a reserved name.
    """

    def __init__(
        self,
        table: Table | str | os.PathLike[str],
        seed: int = 0,
        mode: Mode | str = Mode.ARCADE,
        tick_rate: int = TICK_RATE,
        *,
        rules: Rules | None = None,
    ) -> None:
        if isinstance(tick_rate, int) and not MIN_TICK_RATE <= tick_rate <= MAX_TICK_RATE:
            span = f"{MIN_TICK_RATE} to {MAX_TICK_RATE}"
            raise ValueError(f"tick_rate must be {span} ticks a second, got {tick_rate}")
        if mode not in set(Mode):
            raise ValueError(f"mode must be one of {', '.join(Mode)}, got {mode!r}")
        if rules is not None and not is_custom_name(rules.name):
            raise ValueError(
                f"custom rules need a name of 1 to {NAME_LIMIT} printable characters "
                f"that is not a mode, got {rules.name!r}"
            )
        self.mode = Mode(mode)
        self.world = World(table, seed, tick_rate)
        self.fault: str | None = None
        self._custom_rules_name = "" if rules is None else rules.name
        self._rules = BUILTIN[self.mode] if rules is None else rules
        self._config = self._rules.configure(self.world.table, self.world.tick_rate)
        self._state = RuleState()
        self._has_waiting = False  # whether a ball waits to return to the board; read in every tick
        self._stuck = stuck.StuckTracker()
        self._left = self._right = self._launch = False
        self._shove = self._auto_shove = False  # a player's or an automatic shove in the next tick
        self._was_stopped = False

        self._board = GameWorld(self.world)
        self._points = points_by_part(self.world.table)
        self._has_points = any(self._points.values())
        self._plungers = plungers(self.world.table)
        self._gates = held_gates(self.world.table)
        self._has_stuck_gate = False  # whether a gate waits to close until no ball is in its way
        self._points_seen = 0  # points of all hits passed to the rules, before multipliers

        self._check_ticks = max(self.world.tick_rate // stuck.CHECK_RATE, 1)
        self._next_check = self._check_ticks
        self._next_second = self.world.tick_rate
        self._world_queue: deque[Event] = deque(maxlen=QUEUE_LIMIT)
        self._game_queue: deque[GameEvent] = deque(maxlen=QUEUE_LIMIT)
        self._step_events: list[GameEvent] = []
        self._stale_event_count = 0  # how many of them had happened when the last step ended
        self._emit((GameEvent(GameEventKind.BALL_READY, 0, 1),))

    def __repr__(self) -> str:
        rules = self._custom_rules_name or self.mode
        return f"<Game {rules} on {self.world.table.name!r}: {self.phase}, score {self.score}>"

    # --- actions -------------------------------------------------------------------------------------------

    def step(self, left: bool = False, right: bool = False, ticks: int = 1, *, launch: bool = False) -> None:
        """Advance the game with the buttons held or released; does nothing once the game is over.

        A fault of the world ends the game; `fault` names it.

        Args:
            left: Whether the left button is held, in all ticks.
            right: Whether the right button is held, in all ticks.
            ticks: How many ticks.
            launch: Whether the launch button of the plunger is held, in all ticks.

        Raises:
            ValueError: The number of ticks is not an integer ≥ 0.
        """
        if self._stale_event_count:
            del self._step_events[: self._stale_event_count]
        if ticks < 0:
            raise ValueError(f"ticks must be an integer ≥ 0, got {ticks}")
        if ticks and not self._state.over:
            self._play_ticks(left, right, ticks, launch=launch)
        self._stale_event_count = len(self._step_events)

    def create_ball(self) -> None:
        """Start a ball: the first one, the next one, or a second one while a ball is in play.

        Raises:
            BoardFull, NoRoom: The board has no place for a ball now; nothing is changed.
            SilverballError: No ball is left, the table is tilted, or the game is over.
        """
        reason = self._rules.refusal(self._config, self._state)
        if reason:
            raise SilverballError(reason)
        ball = self.world.create_ball()
        self._record_input(recording.BALL)
        self._apply(self._rules.started(self._config, self._state, self.tick, ball.id))
        self._queue_creation()

    def jitter(self) -> bool:
        """Shove the table; the balls feel it in the next tick.

        Returns:
            Whether the table was shoved: False if it is tilted, or was shoved since the last tick.

        Raises:
            SilverballError: There is no ball to shove.
        """
        if self._state.over or self._state.tilted or self._shove:
            return False
        if not self._board.ball_count:
            raise SilverballError("there is no ball to shove; create one first")
        self._shove = True
        self._record_input(recording.SHOVE)
        self._apply(self._rules.shoved(self._config, self._state, self.tick))
        if self._state.tilted:
            self._stuck = self._stuck._replace(released=self.tick)
        return True

    def end(self) -> None:
        """End the game now, as when the player leaves it."""
        if not self._state.over:
            self._was_stopped = True
            self._apply(ended(self._state, self.tick))

    # --- state ---------------------------------------------------------------------------------------------

    @property
    def view(self) -> GameView:
        """Everything that a display shows."""
        state, tick, phase = self._state, self.tick, self.phase
        save_ticks = max((ball.safe_until - tick for ball in state.balls), default=0)
        return GameView(
            mode=self.mode,
            phase=phase,
            score=state.score,
            ball=state.used + 1 if phase is Phase.READY else state.used,
            balls=self._config.balls,
            on_board=self._board.ball_count,
            combo=running_combo(self._config, state, tick),
            multiplier=self._rules.multiplier(self._config, state, tick),
            save_left=0.0 if state.tilted else max(save_ticks, 0) / self.tick_rate,
            warnings=state.warnings,
            tilted=state.tilted,
            max_balls=self._config.max_balls,
        )

    @property
    def phase(self) -> Phase:
        """The phase of the game."""
        if self._state.over:
            return Phase.OVER
        return Phase.PLAY if self._state.balls else Phase.READY

    @property
    def is_over(self) -> bool:
        """Whether the game has ended."""
        return self._state.over

    @property
    def score(self) -> int:
        """Points so far."""
        return self._state.score

    @property
    def rules(self) -> Rules:
        """The rules of the game."""
        return self._rules

    @property
    def state(self) -> RuleState:
        """The state of the rules; custom rules use its `memory`."""
        return self._state

    @property
    def table(self) -> Table:
        """The finished table."""
        return self.world.table

    @property
    def seed(self) -> int:
        """The seed of everything random."""
        return self.world.seed

    @property
    def tick_rate(self) -> int:
        """Ticks per second."""
        return self.world.tick_rate

    @property
    def tick(self) -> int:
        """Ticks so far."""
        return self._board.tick()

    @property
    def held(self) -> tuple[bool, bool]:
        """Whether the (left, right) button was held in the last tick."""
        return self._left, self._right

    @property
    def is_launch_held(self) -> bool:
        """Whether the launch button was held in the last tick; it does nothing without a plunger."""
        return self._launch

    @property
    def has_still_ball(self) -> bool:
        """Whether a ball has lain still for some time; in free play the player may shove it."""
        return stuck.has_still_ball(self._stuck, self._config, self.tick)

    @property
    def events(self) -> tuple[GameEvent, ...]:
        """The events of the last step, and those between it and the step before it, in order.

        A loop that calls `create_ball` or `jitter`, then `step`, and then reads `events` sees every event
        once. At most the last 4,096 are kept. For what happens to balls see `take_world_events`.
        """
        return tuple(self._step_events[-QUEUE_LIMIT:])

    def take_game_events(self) -> list[GameEvent]:
        """All events of the game since the last call, in order; at most the last 4,096."""
        events = list(self._game_queue)
        self._game_queue.clear()
        return events

    def take_world_events(self) -> list[Event]:
        """All events of the world since the last call, in order; at most the last 4,096."""
        events = list(self._world_queue)
        self._world_queue.clear()
        return events

    @property
    def ended(self) -> str:
        """How the game ended: "over", "stopped" by `end`, the name of a fault; or "running"."""
        if not self._state.over:
            return "running"
        return self.fault or ("stopped" if self._was_stopped else "over")

    # --- saving --------------------------------------------------------------------------------------------

    @property
    def rules_text(self) -> str:
        """The state of the game without that of the world, as JSON."""
        return GameState(
            self._state,
            self._stuck,
            self._left,
            self._right,
            self._shove,
            self._auto_shove,
            self._custom_rules_name,
            self._launch,
        ).to_json()

    @property
    def short_digests(self) -> str:
        """The short digests of the state, as written to replays."""
        return short_digests(self._board.to_bytes(), self.rules_text)

    def digest(self) -> str:
        """A hash of the whole state: equal digests mean equal games."""
        return full_digest(self._board.to_bytes(), self.rules_text)

    def save(self) -> bytes:
        """The whole game as bytes for `restore`, without the recording."""
        return pack_game(self.mode, self.ended, self.world.save(), self.rules_text)

    def restore(self, state: bytes) -> None:
        """Go back or ahead to a saved moment, bit for bit; events that were not taken are dropped.

        Raises:
            StateError: The bytes are damaged, or of another table, tick rate, mode or rules; nothing is
                changed.
        """
        mode, how_ended, world, saved = unpack_game(state)
        if mode != self.mode:
            raise StateError(f"the state is of {mode} play, this game is {self.mode}")
        if saved.own_rules != self._custom_rules_name:
            expected, got = (name or f"of {mode} play" for name in (self._custom_rules_name, saved.own_rules))
            raise StateError(
                f"the state is of a game with the rules {got!r}, this game has the rules {expected!r}; "
                "restore it in a game with the same rules"
            )
        self.world.restore(world)
        self._state, self._stuck = saved.rules, saved.stuck
        self._has_waiting = bool(self._state.waiting)
        self._has_stuck_gate = bool(self._wanted_gates())
        self._left, self._right, self._launch = saved.left, saved.right, saved.launch
        self._shove, self._auto_shove = saved.shove, saved.auto_shove
        self._was_stopped = how_ended == "stopped"
        self.fault = self.world.fault
        self._points_seen = self._points_of_hits()
        tick = self.tick
        self._next_check = (tick // self._check_ticks + 1) * self._check_ticks
        self._next_second = (tick // self.tick_rate + 1) * self.tick_rate
        self._world_queue.clear()
        self._game_queue.clear()
        self._step_events.clear()
        self._stale_event_count = 0

    # --- hooks for a recording -----------------------------------------------------------------------------

    def _record_input(self, kind: str) -> None:
        """Called when the player acts before the next tick; `kind` as in `recording.Input`."""

    def _record_second(self) -> None:
        """Called after every whole second of play."""

    # --- playing -------------------------------------------------------------------------------------------

    def _play_ticks(self, left: bool, right: bool, ticks: int, *, launch: bool) -> None:
        """Play ticks, as many at once as the rules allow."""
        tick = self._board.tick()
        if left is not self._left or right is not self._right:
            self._press(bool(left), bool(right), tick)
        if launch is not self._launch and self._plungers:
            self._press_launch(bool(launch))
        end = tick + ticks
        while tick < end and not self._state.over:
            count = end - tick
            if count > 1:
                count = self._ticks_at_once(min(count, self._next_check - tick, self._next_second - tick))
            self._play(count)
            tick = self._board.tick()
            if tick >= self._next_check and not self._state.over:
                self._check_stuck(tick)
            if tick >= self._next_second:
                self._next_second = tick + self.tick_rate
                self._record_second()

    def _ticks_at_once(self, count: int) -> int:
        """How many of these ticks can be played at once, at least 1."""
        if self._has_waiting or self._has_stuck_gate:
            return 1  # a waiting ball may return after every tick, and a gate may close
        return self._board.skippable_ticks(count)

    def _press(self, left: bool, right: bool, tick: int) -> None:
        """Change the buttons before this tick."""
        if left is not self._left:
            self._record_input(recording.LEFT)
        if right is not self._right:
            self._record_input(recording.RIGHT)
        if (self._left and not left) or (self._right and not right):
            self._stuck = self._stuck._replace(released=tick)
        self._left, self._right = left, right

    def _press_launch(self, launch: bool) -> None:
        """Change the launch button before this tick."""
        if launch is not self._launch:
            self._record_input(recording.LAUNCH)
        self._launch = launch

    def _play(self, count: int) -> None:
        """Play one tick, or several in which nothing but hits can happen."""
        before = self._board.snapshot() if count > 1 else None
        shove = self._shove or self._auto_shove
        try:
            if self._state.tilted:  # the paddles are dead; a plunger is worked by hand
                self.world.step(False, False, shove, count, self._launch)
            else:
                self.world.step(self._left, self._right, shove, count, self._launch)
        except FaultError as error:
            self.fault = error.fault
        if self._board.has_new_events():
            events = self.world.events
            if before is not None and (
                self._gates or self.world.events_lost or any(event.kind == "gutter" for event in events)
            ):
                self._play_singly(before, count)
                return
            self._apply_world_events(events)
        self._shove = self._auto_shove = False
        if self._has_waiting:
            self._return_balls()
        if self._has_stuck_gate:
            self._work_gates()
        if self.fault is not None:
            self._apply(ended(self._state, self.tick))

    def _play_singly(self, before: NDArray[np.int64], count: int) -> None:
        """Go back to the snapshot before these ticks and play them one by one."""
        self._board.rewind(before)
        self.fault = None
        self._points_seen = self._points_of_hits()
        for _ in range(count):
            if not self._state.over:
                self._play(1)

    def _apply_world_events(self, events: tuple[Event, ...]) -> None:
        """Pass the events of the ticks just played to the rules."""
        for event in events:
            if event.kind == "created":
                continue  # queued when it was created
            self._world_queue.append(event)
            if event.kind in SCORING:
                points = self._points.get(event.part, 0)
                self._points_seen += points
                self._hit(event.tick, points, event.part)
            elif event.kind == "gutter":
                self._drain(event.tick, event.ball)
            elif event.kind == "released" and event.part in self._plungers:
                self._launched(event.tick, event.ball)
        if self.world.events_lost:
            self._apply_lost_events()

    def _apply_lost_events(self) -> None:
        """Pass the points and drained balls that did not fit into the event log to the rules."""
        tick = self.tick - 1
        lost_points = self._points_of_hits() - self._points_seen
        if lost_points > 0:
            self._points_seen += lost_points
            self._hit(tick, lost_points, "")
        on_board = self._board.ball_ids
        for ball in self._state.balls:
            if ball.id and ball.id not in on_board:
                self._drain(tick, ball.id)

    def _points_of_hits(self) -> int:
        """Points of all hits that the world has counted, before multipliers."""
        return sum(self._points.get(part, 0) * count for part, count in self.world.hits.items())

    def _return_balls(self) -> None:
        """Put saved balls back on the board, if there is a place for them."""
        while self._has_waiting:
            try:
                ball = self.world.create_ball()
            except (NoRoom, FaultError):
                return  # tried again in the next tick, when the other ball may have moved away
            self._apply(self._rules.returned(self._config, self._state, self.tick, ball.id))
            self._queue_creation()

    def _queue_creation(self) -> None:
        """Queue the event of the ball just created, the last one in the log of the world."""
        self._world_queue.extend(event for event in self.world.events[-1:] if event.kind == "created")

    def _check_stuck(self, tick: int) -> None:
        """Check whether the automatic shove is due."""
        self._next_check = tick + self._check_ticks
        self._stuck = stuck.updated(self._stuck, self._board.places, tick)
        if not self._config.auto_shove:
            return
        is_held = (self._left or self._right) and not self._state.tilted
        quiet_since = self._state.quiet_since if self._has_points else None
        reach = self._board.paddle_reach
        if stuck.needs_shove(
            self._stuck, self._config, tick, held=is_held, reach=reach, quiet_since=quiet_since
        ):
            self._auto_shove = True
            self._stuck = stuck.shoved(self._stuck, tick)
            self._emit((GameEvent(GameEventKind.UNSTUCK, tick),))

    def _hit(self, tick: int, points: int, part: str) -> None:
        self._apply(self._rules.hit(self._config, self._state, tick, points, part))

    def _drain(self, tick: int, ball: int) -> None:
        self._apply(self._rules.drained(self._config, self._state, tick, ball))

    def _launched(self, tick: int, ball: int) -> None:
        launched = getattr(self._rules, "launched", None)  # custom rules may have been written without it
        if launched is not None:
            self._apply(launched(self._config, self._state, tick, ball))

    def _apply(self, outcome: Outcome) -> None:
        """Adopt the next state and queue the events of the rules."""
        open_gates = self._state.open_gates
        self._state, events = outcome
        self._has_waiting = bool(self._state.waiting)
        if self._state.open_gates != open_gates:
            self._work_gates()
        self._emit(events)

    def _work_gates(self) -> None:
        """Open and close the gates as the rules say.

        Raises:
            SilverballError: The rules name a gate that the table does not have.
        """
        unknown = sorted(set(self._state.open_gates) - self._gates.keys())
        if unknown:
            raise SilverballError(
                f"the rules open {unknown[0]!r}, expected held gates of the table: {sorted(self._gates)}"
            )
        for part, is_open in self._wanted_gates():
            self.world.open_gate(part, is_open)
        self._has_stuck_gate = bool(self._wanted_gates())

    def _wanted_gates(self) -> list[tuple[str, bool]]:
        """The gates that are not as the rules say, and whether they are to be open."""
        wanted = [(part, name in self._state.open_gates) for name, part in self._gates.items()]
        return [(part, is_open) for part, is_open in wanted if self._board.is_gate_open(part) != is_open]

    def _emit(self, events: tuple[GameEvent, ...]) -> None:
        self._game_queue.extend(events)
        self._step_events.extend(events)
