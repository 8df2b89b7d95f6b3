"""Players in turn: a match is one machine that is handed on after each ball.

Each player has a state of the rules of their own: score, balls, lamps, counters, modes. The table is one
world, which goes on; banks of drop targets come back for the next player, and time stands still for those who
wait. A player with an extra ball stays. So a match is a game like any other: a function of table, seed,
players and inputs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from silverball.game.referee_state import TABLE_ROWS, StuckTracker, TableState
from silverball.game.rules import InPlay, RuleState
from silverball.game.view import GameEvent, GameEventKind
from silverball.referee.game_records import FOREVER, NOT_RUNNING

if TYPE_CHECKING:
    from silverball.game.scorekeeper import Scorekeeper

MAX_PLAYERS = 4
RANK = "rank"  # the counter of a table's rules that counts finished missions
ENDS_OF_TURNS = (GameEventKind.BALL_READY, GameEventKind.OVER)


class Waiting(NamedTuple):
    """A player who waits for their turn, or has played all balls.

    Attributes:
        rules: Their state of the rules.
        table: What the rules of the table keep for them; None if it has none of its own.
        since: The tick in which they began to wait.
    """

    rules: RuleState
    table: TableState | None
    since: int


class MatchState(NamedTuple):
    """The state of a match beside that of the player who is up.

    Attributes:
        up: Who is up, from 0.
        used: The balls that this player had started when the turn began.
        waiting: All players; what the one who is up has here is of their last wait.
    """

    up: int
    used: int
    waiting: tuple[Waiting, ...]

    def to_values(self) -> dict[str, Any]:
        """The state as values for JSON."""
        waiting = [
            {
                "rules": one.rules._asdict() | {"balls": [ball._asdict() for ball in one.rules.balls]},
                "table": None if one.table is None else one.table._asdict(),
                "since": one.since,
            }
            for one in self.waiting
        ]
        return {"up": self.up, "used": self.used, "waiting": waiting}

    @classmethod
    def from_values(cls, values: dict[str, Any]) -> MatchState:
        """The state of values of `to_values`.

        Raises:
            ValueError, TypeError, KeyError: They are none.
        """
        waiting = []
        for one in values["waiting"]:
            rules, table = dict(one["rules"]), one["table"]
            balls = tuple(InPlay(**ball) for ball in rules.pop("balls"))
            rules["open_gates"] = tuple(map(str, rules["open_gates"]))
            if table is not None:
                table = TableState(**table | {name: tuple(table[name]) for name, _ in TABLE_ROWS})
            waiting.append(Waiting(RuleState(**rules, balls=balls), table, int(one["since"])))
        state = cls(int(values["up"]), int(values["used"]), tuple(waiting))
        if not 0 <= state.up < len(state.waiting) <= MAX_PLAYERS:
            raise ValueError("the state is of no match")
        return state


class Match:
    """The players of a game: who is up, and the states of the others.

    Args:
        keeper: Keeps the score of the player who is up.
        players: How many there are; with one, nothing is ever handed on.
    """

    def __init__(self, keeper: Scorekeeper, players: int) -> None:
        self._keeper = keeper
        blank = Waiting(keeper.state, keeper.table_state, 0)
        self._waiting = [blank] * players
        self._used = 0
        self.up = 0

    @property
    def players(self) -> int:
        """How many players there are."""
        return len(self._waiting)

    @property
    def scores(self) -> tuple[int, ...]:
        """The points of all players."""
        return self._of_all(self._keeper.state.score, [one.rules.score for one in self._waiting])

    @property
    def ranks(self) -> tuple[int, ...]:
        """The missions that each player has finished: the table's counter `rank`; 0 without one."""
        if RANK not in self._keeper.books.counters[0]:
            return (0,) * self.players
        place = self._keeper.books.counters[0].index(RANK)
        others = [0 if one.table is None else one.table.counter[place] for one in self._waiting]
        return self._of_all(self._keeper.counters[RANK], others)

    @property
    def state(self) -> MatchState | None:
        """The state for a saved game; None with one player."""
        return MatchState(self.up, self._used, tuple(self._waiting)) if self.players > 1 else None

    def set_state(self, state: MatchState | None) -> None:
        """Go to a saved state of as many players."""
        if state is not None:
            self.up, self._used, self._waiting = state.up, state.used, list(state.waiting)

    def pass_on(self, events: tuple[GameEvent, ...], tick: int) -> tuple[GameEvent, ...]:
        """Hand the machine on if the turn is over; return the events with what that changes.

        Args:
            events: What the rules have reported.
            tick: The tick now.
        """
        if self.players == 1 or not any(event.kind in ENDS_OF_TURNS for event in events):
            return events
        state = self._keeper.state
        if not state.over and state.used <= self._used:
            return events  # an extra ball
        self._waiting[self.up] = Waiting(state, self._keeper.table_state, tick)
        following = next((one for one in self._in_order() if not self._waiting[one].rules.over), None)
        if following is None:
            best = max(self.scores)
            return tuple(e._replace(value=best) if e.kind is GameEventKind.OVER else e for e in events)
        self._resume(following, tick)
        ball = self._keeper.state.used + 1
        return (
            *(event for event in events if event.kind not in ENDS_OF_TURNS),
            GameEvent(GameEventKind.PLAYER_UP, events[-1].tick, following + 1),
            GameEvent(GameEventKind.BALL_READY, events[-1].tick, ball),
        )

    def _in_order(self) -> list[int]:
        """All players in the order of their turns, the one who was up last."""
        return [(self.up + step) % self.players for step in range(1, self.players + 1)]

    def _resume(self, player: int, tick: int) -> None:
        """Let a player go on; what happens to the table, such as fallen targets, is that of the machine."""
        keeper, one = self._keeper, self._waiting[player]
        table = one.table
        if table is not None:
            table = table._replace(
                mode_end=tuple(_later(end, tick - one.since) for end in table.mode_end),
                fallen=int(keeper.record["fallen"]),
                resets=keeper.bank_bits,
            )
        released, shoved = int(keeper.record["released"]), int(keeper.record["shoved"])
        keeper.set_state(one.rules, StuckTracker((), released, shoved), table)
        keeper.set_next_look(tick)
        keeper.work_switches()
        self.up, self._used = player, one.rules.used

    def _of_all(self, now: int, others: list[int]) -> tuple[int, ...]:
        return tuple(now if player == self.up else value for player, value in enumerate(others))


def _later(end: int, ticks: int) -> int:
    """The end of a mode that has stood still for some ticks."""
    return end if end in (NOT_RUNNING, FOREVER) else end + ticks
