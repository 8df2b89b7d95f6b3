"""A game without its recording: a world and the rules, driven by button presses, new balls and shoves.

The same table, seed, rules and inputs give the same game bit for bit, whether its ticks are played one by one
or many at once. Ticks in which no ball can leave the board are played in one call of the world; where a ball
does leave, the rules must act at that very tick, so ticks are played one by one there.

`Game` adds the recording; `replay.player` plays recordings on a `GameCore`.
"""

from __future__ import annotations

import os
from collections import deque
from typing import TYPE_CHECKING, Any

from silverball.errors import FaultError, NoRoom, SilverballError, StateError
from silverball.game.builtin_rules import BUILTIN
from silverball.game.game_world import GameWorld
from silverball.game.hit_points import HitPoints
from silverball.game.match import MAX_PLAYERS, Match
from silverball.game.mechanisms import plungers
from silverball.game.referee_state import button_bits
from silverball.game.replay import recording
from silverball.game.replay.digest import full_digest, short_digests
from silverball.game.replay.recording import MAX_TICK_RATE, MIN_TICK_RATE
from silverball.game.rule_gates import RuleGates
from silverball.game.rules import NAME_LIMIT, Rules, RuleState, is_custom_name, running_combo
from silverball.game.saved_game import GameState, pack_game, unpack_game
from silverball.game.scorekeeper import PythonKeeper, Scorekeeper
from silverball.game.view import GameEvent, GameEventKind, GameView, Mode, Phase
from silverball.physics.records import JITTER
from silverball.world import World
from silverball.world.world import NUDGE_BITS

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from silverball.referee.compile_rules import RuleBooks
    from silverball.table import Table
    from silverball.world import Event

TICK_RATE = 240
NUDGE_NAMES = {bit: name for name, bit in NUDGE_BITS.items()}
QUEUE_LIMIT = 4096  # events in a queue; if more come before they are taken, the oldest are dropped


class GameCore:
    """A game on one board, from the first ball to the last, without a recording.

    Args:
        table: A table, a built-in name, or a path to a file. A recipe makes a board with the seed.
        seed: Seed of everything random, 0 to 2⁶³ − 1.
        mode: The mode, which names the built-in rules; a `Mode` or its string.
        tick_rate: Ticks per second, 10 to 1,000.
        rules: Custom rules in place of those of the mode.
        players: How many play in turn, 1 to 4; see `match`.

    Attributes:
        world: The world that is played. Read it, but change it only through the game.
        mode: The mode.
        fault: The fault of the world that ended the game, or None.

    Raises:
        TableError: The table cannot be used.
        ValueError: The mode, seed, tick rate or number of players is invalid, or the rules have a reserved
            name.
    """

    def __init__(
        self,
        table: Table | str | os.PathLike[str],
        seed: int = 0,
        mode: Mode | str = Mode.ARCADE,
        tick_rate: int = TICK_RATE,
        *,
        rules: Rules | None = None,
        players: int = 1,
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
        if not isinstance(players, int) or not 1 <= players <= MAX_PLAYERS:
            raise ValueError(f"players must be 1 to {MAX_PLAYERS}, got {players!r}")
        if players > 1 and (rules is not None or Mode(mode) is not Mode.ARCADE):
            raise ValueError("players take turns in arcade play with its own rules only; leave `players` out")
        self.mode = Mode(mode)
        self.world = World(table, seed, tick_rate)
        self.fault: str | None = None
        self._custom_rules_name = "" if rules is None else rules.name
        self._rules = BUILTIN[self.mode] if rules is None else rules
        self._config = self._rules.configure(self.world.table, self.world.tick_rate)
        self._left = self._right = self._launch = False
        self._was_stopped = False

        self._board = GameWorld(self.world)
        self._points = HitPoints(self.world)
        self._plungers = plungers(self.world.table)
        self._keeper = (
            Scorekeeper(self.world, self._config)
            if rules is None
            else PythonKeeper(self.world, self._config, rules, self._plungers, self._points.by_part)
        )
        self._match = Match(self._keeper, players)
        self._gates = RuleGates(self._board, has_own_rules=rules is not None)

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
        if ticks and not self._keeper.is_over:
            self._play_ticks(left, right, ticks, launch=launch)
        self._stale_event_count = len(self._step_events)

    def create_ball(self) -> None:
        """Start a ball: the first one, the next one, or a second one while a ball is in play.

        Raises:
            BoardFull, NoRoom: The board has no place for a ball now; nothing is changed.
            SilverballError: No ball is left, the table is tilted, or the game is over.
        """
        reason = self._rules.refusal(self._config, self._keeper.state)
        if reason:
            raise SilverballError(reason)
        ball = self.world.create_ball()
        self._record_input(recording.BALL)
        self._apply(self._keeper.started(ball.id))
        self._queue_creation()

    def jitter(self) -> bool:
        """Shove the table; the balls feel it in the next tick. A table with `nudge` is nudged up.

        Returns:
            Whether the table was shoved: False if it is tilted, or was shoved since the last tick.

        Raises:
            SilverballError: There is no ball to shove.
        """
        return self.nudge("up")

    def nudge(self, direction: str) -> bool:
        """Nudge the cabinet before the next tick; on a table without `nudge` shove the balls, as `jitter`.

        Args:
            direction: Where the cabinet is pushed: "left", "right" or "up".

        Returns:
            Whether the table was shoved, as `jitter` returns it.

        Raises:
            SilverballError: There is no ball to shove.
            ValueError: There is no such direction.
        """
        if direction not in NUDGE_BITS:
            raise ValueError(f"direction must be {', '.join(NUDGE_BITS)}, got {direction!r}")
        keeper = self._keeper
        if keeper.is_over or keeper.is_tilted or keeper.record["shove"]:
            return False
        if not self._board.ball_count:
            raise SilverballError("there is no ball to shove; create one first")
        has_nudge = self.world.has_nudge
        keeper.record["shove"] = NUDGE_BITS[direction] if has_nudge else JITTER
        self._record_input(recording.NUDGES[direction] if has_nudge else recording.SHOVE)
        self._apply(keeper.shoved())
        return True

    def end(self) -> None:
        """End the game now, as when the player leaves it."""
        if not self._keeper.is_over:
            self._was_stopped = True
            self._apply(self._keeper.end())

    # --- state ---------------------------------------------------------------------------------------------

    @property
    def view(self) -> GameView:
        """Everything that a display shows."""
        state, tick, phase = self._keeper.state, self.tick, self.phase
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
            player=self._match.up + 1,
            scores=self._match.scores if self._match.players > 1 else (),
        )

    @property
    def phase(self) -> Phase:
        """The phase of the game."""
        state = self._keeper.state
        if state.over:
            return Phase.OVER
        return Phase.PLAY if state.balls else Phase.READY

    @property
    def is_over(self) -> bool:
        """Whether the game has ended."""
        return self._keeper.is_over

    @property
    def score(self) -> int:
        """Points so far; in a match those of the player who leads."""
        return max(self._match.scores)

    @property
    def scores(self) -> tuple[int, ...]:
        """The points of every player."""
        return self._match.scores

    @property
    def ranks(self) -> tuple[int, ...]:
        """The missions that every player has finished: the counter `rank` of the table's rules."""
        return self._match.ranks

    @property
    def players(self) -> int:
        """How many players take turns."""
        return self._match.players

    @property
    def rules(self) -> Rules:
        """The rules of the game."""
        return self._rules

    @property
    def state(self) -> RuleState:
        """The state of the rules; custom rules use its `memory`."""
        return self._keeper.state

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
    def has_ball_to_launch(self) -> bool:
        """Whether a ball lies on a plunger and waits for the launch button, which draws it back."""
        return self._board.has_ball_to_launch

    @property
    def has_still_ball(self) -> bool:
        """Whether a ball has lain still for some time; in free play the player may shove it."""
        limit = self.tick - self._config.unstick_ticks
        return any(rest.since <= limit for rest in self._keeper.tracker.rests)

    @property
    def lamps(self) -> dict[str, str]:
        """The state of every lamp of the table by its name: "off", "on" or "blinking"."""
        return self._keeper.lamps

    @property
    def lamp_states(self) -> tuple[int, ...]:
        """The state of every lamp in the order of the table: 0 off, 1 on, 2 blinking."""
        return self._keeper.lamp_states

    @property
    def mode_color(self) -> str:
        """The color of the first mode that runs and has one, for the lamps that show it; else "white"."""
        colored = [mode for mode in self.world.table.mode if mode.color != "white"]
        running = self.modes if colored else {}
        return next((mode.color for mode in colored if mode.name in running), "white")

    @property
    def counters(self) -> dict[str, int]:
        """The value of every counter of the table's rules by its name."""
        return self._keeper.counters

    @property
    def modes(self) -> dict[str, float | None]:
        """The modes that run by their names, and how long they still do [s]; None: without an end."""
        return self._keeper.modes

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
        if not self._keeper.is_over:
            return "running"
        return self.fault or ("stopped" if self._was_stopped else "over")

    # --- saving --------------------------------------------------------------------------------------------

    @property
    def rules_text(self) -> str:
        """The state of the game without that of the world, as JSON."""
        keeper = self._keeper
        return GameState(
            keeper.state,
            keeper.tracker,
            self._left,
            self._right,
            int(keeper.record["shove"]),
            bool(keeper.record["auto_shove"]),
            self._custom_rules_name,
            self._launch,
            keeper.table_state,
            self._match.state,
        ).to_json()

    @property
    def short_digests(self) -> str:
        """The short digests of the state, as written to replays."""
        return short_digests(self._board.to_bytes(), self.rules_text)

    @property
    def rule_rows(self) -> tuple[NDArray[Any], RuleBooks] | None:
        """The GAME records (one) and the compiled rules, only to be read; None with rules in Python."""
        return None if self._custom_rules_name else self._keeper.rows

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
        players = 1 if saved.match is None else len(saved.match.waiting)
        if players != self.players:
            raise StateError(f"the state is of a game of {players} players, this one has {self.players}")
        keeper = self._keeper
        before = keeper.snapshot()
        try:
            keeper.set_state(saved.rules, saved.stuck, saved.table)
            self.world.restore(world)
        except (ValueError, OverflowError, TypeError) as error:
            keeper.rewind(before)
            raise StateError(f"the state is damaged: {error}") from None
        except StateError:
            keeper.rewind(before)
            raise
        self._match.set_state(saved.match)
        self._gates.adopt(keeper.state.open_gates)
        self._left, self._right, self._launch = saved.left, saved.right, saved.launch
        keeper.record["buttons"] = button_bits(saved.left, saved.right, saved.launch)
        keeper.record["shove"], keeper.record["auto_shove"] = saved.shove, saved.auto_shove
        keeper.set_next_look(self.tick)
        keeper.work_switches()
        self._was_stopped = how_ended == "stopped"
        self.fault = self.world.fault
        self._points.catch_up()
        tick = self.tick
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
        while tick < end and not self._keeper.is_over:
            count = end - tick
            if count > 1:
                count = self._ticks_at_once(
                    min(count, self._keeper.next_look - tick, self._next_second - tick)
                )
            self._play(count)
            tick = self._board.tick()
            if tick >= self._keeper.next_look and not self._keeper.is_over:
                self._apply(self._keeper.look_for_stuck_balls())
            if tick >= self._next_second:
                self._next_second = tick + self.tick_rate
                self._record_second()

    def _ticks_at_once(self, count: int) -> int:
        """How many of these ticks can be played at once, at least 1."""
        if self._keeper.is_late or self._gates.has_stuck:
            return 1  # a waiting ball may return after every tick, and a gate may close
        until_end = max(self._keeper.next_end + 1 - self._board.tick(), 1)  # what a mode does as it ends
        return min(self._board.skippable_ticks(count), until_end)

    def _press(self, left: bool, right: bool, tick: int) -> None:
        """Change the buttons before this tick."""
        if left is not self._left:
            self._record_input(recording.LEFT)
        if right is not self._right:
            self._record_input(recording.RIGHT)
        self._left, self._right = left, right
        self._apply(self._keeper.pressed(button_bits(left, right, self._launch)))

    def _press_launch(self, launch: bool) -> None:
        """Change the launch button before this tick."""
        if launch is not self._launch:
            self._record_input(recording.LAUNCH)
        self._launch = launch
        self._apply(self._keeper.pressed(button_bits(self._left, self._right, launch)))

    def _play(self, count: int) -> None:
        """Play one tick, or several in which nothing but hits can happen."""
        keeper = self._keeper
        before = (self._board.snapshot(), keeper.snapshot()) if count > 1 else None
        shove = int(keeper.record["shove"])
        jitters, nudge = shove == JITTER or bool(keeper.record["auto_shove"]), NUDGE_NAMES.get(shove)
        try:
            if keeper.is_tilted:  # the paddles are dead; a plunger is worked by hand
                self.world.step(False, False, jitters, count, self._launch, nudge=nudge)
            else:
                self.world.step(self._left, self._right, jitters, count, self._launch, nudge=nudge)
        except FaultError as error:
            self.fault = error.fault
        if self._board.has_new_events() or keeper.next_end < self._board.tick():
            events = self.world.events
            if before is not None and (
                self._gates.is_worked
                or self.world.events_lost
                or any(event.kind == "gutter" for event in events)
            ):
                self._play_singly(before, count)
                return
            lost = self._points.lost(events)
            said = keeper.played(events, lost)
            if before is not None and keeper.has_moved_something:
                self._play_singly(before, count)
                return
            self._points.pass_on(events, lost)
            self._world_queue.extend(event for event in events if event.kind != "created")
            self._apply(self._match.pass_on(said, self._board.tick()))
        keeper.record["shove"] = keeper.record["auto_shove"] = 0
        if keeper.is_late:
            self._return_balls()
            self._apply(keeper.work_switches())
        if self._gates.has_stuck:
            self._gates.work()
        if self.fault is not None:
            self._apply(keeper.end())

    def _play_singly(self, before: tuple[NDArray[np.int64], Any], count: int) -> None:
        """Go back to the snapshots before these ticks and play them one by one."""
        world, keeper = before
        self._board.rewind(world)
        self._keeper.rewind(keeper)
        self.fault = None
        self._points.catch_up()
        for _ in range(count):
            if not self._keeper.is_over:
                self._play(1)

    def _return_balls(self) -> None:
        """Put the balls that wait on the board, if there is a place for them."""
        while self._keeper.has_waiting:
            try:
                ball = self.world.create_ball()
            except (NoRoom, FaultError):
                return  # tried again in the next tick, when the other ball may have moved away
            self._apply(self._keeper.returned(ball.id))
            self._queue_creation()

    def _queue_creation(self) -> None:
        """Queue the event of the ball just created, the last one in the log of the world."""
        self._world_queue.extend(event for event in self.world.events[-1:] if event.kind == "created")

    def _apply(self, events: tuple[GameEvent, ...]) -> None:
        """Queue the events of the rules, and work the gates that rules in Python have opened or closed."""
        if self._custom_rules_name:
            self._gates.follow(self._keeper.state.open_gates)
        self._emit(events)

    def _emit(self, events: tuple[GameEvent, ...]) -> None:
        self._game_queue.extend(events)
        self._step_events.extend(events)
