"""Tables with rules, for tests: the built-in table `parts` with rules of a test, and a whole machine."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from silverball.game.game import Game
from silverball.game.view import GameEvent, GameEventKind
from silverball.physics.records import EventKind
from silverball.referee.judge import Call
from silverball.table import Table, expand
from silverball.table.file import parse_table

TABLES = Path(__file__).parent / "tables"
PARTS = (resources.files("silverball.table") / "tables" / "parts.toml").read_text(encoding="utf-8")
COMET_RULES = (TABLES / "comet_rules.toml").read_text(encoding="utf-8")


def with_rules(rules: str) -> Table:
    """The built-in table `parts` with rules (and more parts, if they name any)."""
    return parse_table(f"{PARTS}\n{rules}", "test")


def comet() -> Table:
    """A whole machine: all that a table with missions, locks and a wizard mode needs to say."""
    return with_rules(COMET_RULES)


class Bench:
    """A game whose events a test makes up: what balls would have done, told to the referee.

    The first ball has been started; nothing moves.
    """

    def __init__(self, table: Table | str, *, seed: int = 1) -> None:
        self.table = with_rules(table) if isinstance(table, str) else table
        self.game = Game(self.table, seed)
        self.keeper = self.game._keeper
        self.names = list(self.game.world.hits)
        self.log = self.game.world._batch.logs[0]
        self.record = self.game.world.records[0]
        self.said: list[GameEvent] = []
        self.game.create_ball()
        self.said += self.game.take_game_events()

    def number(self, name: str) -> int:
        return expand(self.table).named.get(name, self.names.index(name) if name in self.names else -1)

    def happen(self, kind: EventKind, part: str = "", ball: int = 1) -> None:
        """An event in the next tick."""
        self.log["count"], self.log["carried"] = 1, 0
        event = self.log["event"][0]
        event["kind"], event["ball"], event["tick"] = kind, ball, self.record["tick"]
        event["part"] = self.number(part)
        self.wait(1)

    def hit(self, *names: str) -> None:
        for name in names:
            self.happen(EventKind.HIT, name)

    def drain(self, ball: int = 1) -> None:
        self.happen(EventKind.GUTTER, "gutter", ball)

    def wait(self, ticks: int) -> None:
        """Let time pass."""
        self.record["tick"] += ticks
        self.said += self.keeper._judge(Call.TICKS)
        self.log["count"] = 0

    def press(self, buttons: int) -> None:
        self.said += self.keeper.pressed(0)
        self.said += self.keeper.pressed(buttons)

    @property
    def score(self) -> int:
        return self.game.score

    @property
    def texts(self) -> list[str]:
        """The messages so far."""
        return [event.part for event in self.said if event.kind is GameEventKind.MESSAGE]

    @property
    def kinds(self) -> list[str]:
        return [event.kind.value for event in self.said]
