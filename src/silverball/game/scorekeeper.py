"""Who keeps the score of a game: the referee, or rules written in Python.

Both keep a GAME record and answer a game with the events that it reports. `Scorekeeper` lets the compiled
rules act (the standard ones, or those of the table); `PythonKeeper` calls `Rules` instead, and leaves to
the referee what all rules have in common: buttons, and balls that lie still.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from silverball.game.mechanisms import SCORING
from silverball.game.referee_state import (
    TableState,
    rule_state,
    set_rule_state,
    set_table_state,
    set_tracker,
    table_state,
    tracker_of,
)
from silverball.game.rules import Outcome, RuleState, ended
from silverball.game.view import GameEvent, GameEventKind
from silverball.physics.records import records
from silverball.referee.compile_rules import RuleBooks, compile_rules
from silverball.referee.game_records import FOREVER, GAME, NOT_RUNNING, REPORT, Light, Said
from silverball.referee.judge import Call
from silverball.referee.single_judge import SingleJudge

if TYPE_CHECKING:
    from silverball.game.referee_state import StuckTracker
    from silverball.game.rules import RuleConfig, Rules
    from silverball.world import Event, World

KINDS = tuple(GameEventKind[said.name] for said in Said)
OF_A_PART = (Said.SCORED, Said.COMBO, Said.BALL_LOCKED)
OF_A_MODE = (Said.MODE_STARTED, Said.MODE_ENDED)
WITH_TEXT = (Said.MESSAGE, Said.CUE)
LIGHT_NAMES = {light.value: light.name.lower() for light in Light}

_WORDS = {name: int(field[1]) // 8 for name, field in (GAME.fields or {}).items()}
_OVER, _TILTED, _NEXT_END, _NEXT_LOOK = (_WORDS[name] for name in ("over", "tilted", "next_end", "next_look"))
_REPORT_WORDS = {name: int(field[1]) // 8 for name, field in (REPORT.fields or {}).items()}
_COUNT, _TOUCHED, _LATE = (_REPORT_WORDS[name] for name in ("count", "touched", "late"))


class Scorekeeper:
    """Keeps the score of a game by compiled rules.

    Args:
        world: The world that is played.
        config: The numbers of the game.

    Attributes:
        record: The GAME record.
        books: The compiled rules.
        rows: The GAME records (one) and the compiled rules.
    """

    def __init__(self, world: World, config: RuleConfig) -> None:
        batch = world._batch
        boards = batch.boards
        self._world, self._names = world, boards.names[0]
        self.books: RuleBooks = compile_rules([world.table], [world.records[2]], [config], world.tick_rate)
        games, reports = records(1, GAME), records(1, REPORT)
        games[0] = self.books.blank[0]
        field = (batch.state, boards.board, boards.collider, boards.grid, boards.place, batch.logs)
        self._referee = SingleJudge((games, reports), self.books, field)
        self.record: Any = games[0]
        self.rows = games, self.books
        self._words: NDArray[np.int64] = _words(games)
        self._report: Any = reports[0]
        self._report_words = _words(reports)

    # --- what happens --------------------------------------------------------------------------------------

    def started(self, ball: int) -> tuple[GameEvent, ...]:
        """The player has started the ball with this id."""
        return self._judge(Call.START, ball)

    def returned(self, ball: int) -> tuple[GameEvent, ...]:
        """The first of the waiting balls is on the board again, with this id."""
        return self._judge(Call.RETURN, ball)

    def shoved(self) -> tuple[GameEvent, ...]:
        """The player has shoved the table."""
        return self._judge(Call.SHOVE)

    def pressed(self, buttons: int) -> tuple[GameEvent, ...]:
        """These buttons (bits) are held from now on."""
        return self._judge(Call.BUTTONS, buttons)

    def played(self, events: tuple[Event, ...], lost_points: int) -> tuple[GameEvent, ...]:
        """Ticks have been played, with these events and points of hits that did not fit into the log."""
        return self._judge(Call.TICKS, lost_points)

    def look_for_stuck_balls(self) -> tuple[GameEvent, ...]:
        """It is time to look for balls that lie still."""
        return self._judge(Call.STILLNESS)

    def work_switches(self) -> tuple[GameEvent, ...]:
        """Gates and banks may wait until no ball is in their way."""
        return self._judge(Call.SWITCHES)

    def end(self) -> tuple[GameEvent, ...]:
        """The game ends now, as when the player leaves it."""
        return self._judge(Call.END)

    # --- what holds ----------------------------------------------------------------------------------------

    @property
    def is_over(self) -> bool:
        """Whether the game has ended."""
        return self._words.item(_OVER) != 0

    @property
    def is_tilted(self) -> bool:
        """Whether the paddles are dead."""
        return self._words.item(_TILTED) != 0

    @property
    def has_waiting(self) -> bool:
        """Whether a ball waits to come to the board."""
        return any(ball == 0 for ball in self.record["ball"]["id"][: self.record["balls"]].tolist())

    @property
    def is_late(self) -> bool:
        """Whether a ball, a gate or a bank waits until it has room."""
        return self._report_words.item(_LATE) != 0

    @property
    def has_moved_something(self) -> bool:
        """Whether the last call moved something, so that ticks after it must be played with it."""
        return self._report_words.item(_TOUCHED) != 0

    @property
    def next_end(self) -> int:
        """The next tick in which something happens by itself."""
        return self._words.item(_NEXT_END)

    @property
    def next_look(self) -> int:
        """The tick after which balls that lie still are looked for."""
        return self._words.item(_NEXT_LOOK)

    @property
    def bank_bits(self) -> int:
        """All banks of drop targets of the table, as bits."""
        return (1 << int(self._world.records[1]["banks"])) - 1

    def set_next_look(self, tick: int) -> None:
        """Set that tick for a game that goes on from a tick."""
        every = int(self.books.setups[0]["check_ticks"])
        self.record["next_look"] = (tick // every + 1) * every

    @property
    def state(self) -> RuleState:
        """The state of the rules."""
        return rule_state(self._words)

    @property
    def tracker(self) -> StuckTracker:
        """What has been noted of balls that lie still."""
        return tracker_of(self.record)

    @property
    def table_state(self) -> TableState | None:
        """What the rules of the table keep; None if it has none of its own."""
        return table_state(self.record, self.books)

    @property
    def lamps(self) -> dict[str, str]:
        """The state of every lamp by its name: "off", "on" or "blinking"."""
        lamps = self.record["lamp"][: len(self.books.lamps[0])].tolist()
        return {name: LIGHT_NAMES[lamp] for name, lamp in zip(self.books.lamps[0], lamps, strict=True)}

    @property
    def lamp_states(self) -> tuple[int, ...]:
        """The state of every lamp in the order of the table, a `Light`."""
        return tuple(self.record["lamp"][: len(self.books.lamps[0])].tolist())

    @property
    def counters(self) -> dict[str, int]:
        """The value of every counter by its name."""
        values = self.record["counter"][: len(self.books.counters[0])].tolist()
        return dict(zip(self.books.counters[0], values, strict=True))

    @property
    def modes(self) -> dict[str, float | None]:
        """The modes that run by their names, and how long they still do [s]; None: without an end."""
        ends = self.record["mode_end"][: len(self.books.modes[0])].tolist()
        now, rate = self._world.tick, self._world.tick_rate
        return {
            name: None if end == FOREVER else max(end - now, 0) / rate
            for name, end in zip(self.books.modes[0], ends, strict=True)
            if end != NOT_RUNNING
        }

    # --- going back ----------------------------------------------------------------------------------------

    def snapshot(self) -> Any:
        """What `rewind` needs to go back to this moment."""
        return self._words.copy()

    def rewind(self, snapshot: Any) -> None:
        """Go back to a snapshot."""
        self._words[:] = snapshot

    def set_state(self, state: RuleState, tracker: StuckTracker, table: TableState | None) -> None:
        """Go to a saved state.

        Raises:
            ValueError, OverflowError, TypeError: A game cannot have it; nothing is changed.
        """
        before = self._words.copy()
        try:
            set_rule_state(self._words, state)
            set_tracker(self.record, tracker)
            set_table_state(self.record, table, self.books)
        except (ValueError, OverflowError, TypeError):
            self._words[:] = before
            raise

    def _judge(self, call: Call, value: int = 0) -> tuple[GameEvent, ...]:
        words = self._report_words
        words[_COUNT] = words[_TOUCHED] = 0
        self._referee.judge(call, value)
        count = words.item(_COUNT)
        if count == 0:
            return ()
        return tuple(self._event(*row) for row in self._report["event"][:count].tolist())

    def _event(self, said: int, tick: int, value: int, part: int) -> GameEvent:
        if said in OF_A_PART:
            return GameEvent(KINDS[said], tick, value, self._names[part] if part >= 0 else "")
        if said in OF_A_MODE:
            return GameEvent(KINDS[said], tick, 0, self.books.modes[0][value])
        if said in WITH_TEXT:
            return GameEvent(KINDS[said], tick, 0, self.books.texts[0][value])
        return GameEvent(KINDS[said], tick, value)


class PythonKeeper(Scorekeeper):
    """Keeps the score of a game by rules written in Python, whose state is a `RuleState`.

    Args:
        world: The world that is played.
        config: The numbers of the game, as the rules have made them.
        rules: The rules.
        plungers: The names of the parts that launch balls.
        points: The points of each part by its name.
    """

    def __init__(
        self,
        world: World,
        config: RuleConfig,
        rules: Rules,
        plungers: frozenset[str],
        points: dict[str, int],
    ) -> None:
        super().__init__(world, config._replace(balls=0))  # the standard rules, which do not act
        self._rules, self._config, self._plungers, self._points = rules, config, plungers, points
        self.books.setups[0]["tilts"] = 1
        self._state = RuleState()

    def started(self, ball: int) -> tuple[GameEvent, ...]:
        """The player has started the ball with this id."""
        return self._adopt(self._rules.started(self._config, self._state, self._world.tick, ball))

    def returned(self, ball: int) -> tuple[GameEvent, ...]:
        """The first of the waiting balls is on the board again, with this id."""
        super().returned(ball)  # a plunger may launch it by itself
        return self._adopt(self._rules.returned(self._config, self._state, self._world.tick, ball))

    def shoved(self) -> tuple[GameEvent, ...]:
        """The player has shoved the table."""
        events = self._adopt(self._rules.shoved(self._config, self._state, self._world.tick))
        if self._state.tilted:
            self.record["released"] = self._world.tick
        return events

    def played(self, events: tuple[Event, ...], lost_points: int) -> tuple[GameEvent, ...]:
        """Pass the events of the ticks just played to the rules, and what did not fit into the log."""
        said: tuple[GameEvent, ...] = ()
        for event in events:
            if event.kind in SCORING:
                points = self._points.get(event.part, 0)
                said += self._adopt(
                    self._rules.hit(self._config, self._state, event.tick, points, event.part)
                )
            elif event.kind == "gutter":
                said += self._drained(event.tick, event.ball)
            elif event.kind == "released" and event.part in self._plungers:
                said += self._launched(event.tick, event.ball)
        return said + self._lost(lost_points) if self._world.events_lost else said

    def _lost(self, points: int) -> tuple[GameEvent, ...]:
        tick = self._world.tick - 1
        said: tuple[GameEvent, ...] = ()
        if points > 0:
            said += self._adopt(self._rules.hit(self._config, self._state, tick, points, ""))
        on_board = {ball.id for ball in self._world.balls}
        for ball in self._state.balls:
            if ball.id and ball.id not in on_board:
                said += self._drained(tick, ball.id)
        return said

    def _drained(self, tick: int, ball: int) -> tuple[GameEvent, ...]:
        return self._adopt(self._rules.drained(self._config, self._state, tick, ball))

    def _launched(self, tick: int, ball: int) -> tuple[GameEvent, ...]:
        launched = getattr(self._rules, "launched", None)  # rules may have been written without it
        return self._adopt(launched(self._config, self._state, tick, ball)) if launched is not None else ()

    def end(self) -> tuple[GameEvent, ...]:
        """The game ends now, as when the player leaves it."""
        return self._adopt(ended(self._state, self._world.tick))

    def look_for_stuck_balls(self) -> tuple[GameEvent, ...]:
        """It is time to look for balls that lie still."""
        self.record["quiet_since"] = self._state.quiet_since
        self.record["tilted"] = self._state.tilted
        return super().look_for_stuck_balls()

    def work_switches(self) -> tuple[GameEvent, ...]:
        """Do nothing: the game works the gates that the rules name in `open_gates`."""
        return ()

    @property
    def is_over(self) -> bool:
        """Whether the game has ended."""
        return self._state.over

    @property
    def is_tilted(self) -> bool:
        """Whether the paddles are dead."""
        return self._state.tilted

    @property
    def has_waiting(self) -> bool:
        """Whether a ball waits to come to the board."""
        return bool(self._state.waiting)

    @property
    def is_late(self) -> bool:
        """Whether a ball waits until it has room."""
        return self.has_waiting

    @property
    def has_moved_something(self) -> bool:
        """Rules in Python move nothing but gates, on whose tables every tick with events is played alone."""
        return False

    @property
    def state(self) -> RuleState:
        """The state of the rules."""
        return self._state

    def snapshot(self) -> Any:
        """What `rewind` needs to go back to this moment."""
        return super().snapshot(), self._state

    def rewind(self, snapshot: Any) -> None:
        """Go back to a snapshot."""
        words, self._state = snapshot
        super().rewind(words)

    def set_state(self, state: RuleState, tracker: StuckTracker, table: TableState | None) -> None:
        """Go to a saved state."""
        set_tracker(self.record, tracker)
        self._state = state

    def _adopt(self, outcome: Outcome) -> tuple[GameEvent, ...]:
        self._state, events = outcome
        return events


def _words(rows: NDArray[Any]) -> NDArray[np.int64]:
    """The words of eight bytes of records."""
    return np.frombuffer(rows.data, np.int64)
