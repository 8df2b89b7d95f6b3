"""What the standard rules make of a state of a game, asked of the referee without a world."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from silverball.game.referee_state import rule_state, set_rule_state
from silverball.game.rules import Outcome, RuleConfig, RuleState
from silverball.game.view import GameEvent, GameEventKind
from silverball.physics.records import BOARD, COLLIDER, LOG, PLAIN_WORLD, EventKind, records
from silverball.referee.compile_rules import compile_rules, set_config
from silverball.referee.game_records import GAME, REPORT, Said
from silverball.referee.judge import Call
from silverball.referee.single_judge import SingleJudge
from silverball.table.kinds import Cylinder
from silverball.table.table import Table
from silverball.world.compile import compile_parts

KINDS = tuple(GameEventKind[said.name] for said in Said)


class ScratchGame:
    """A game on a table with one part, whose state is set before each question."""

    def __init__(self) -> None:
        self._config: RuleConfig | None = None

    def outcome(
        self, config: RuleConfig, state: RuleState, tick: int, ask: Callable[[ScratchGame], None]
    ) -> Outcome:
        """Return what the standard rules make of a state.

        Args:
            config: The numbers of the game.
            state: The state before.
            tick: The tick.
            ask: What happens.

        Raises:
            ValueError: The state is none that a game can have.
        """
        arrays, referee = self._made
        if config != self._config:
            set_config(arrays["setup"], config, 1)
            arrays["setup"]["tilts"] = 1
            self._config = config
        set_rule_state(arrays["words"], state)
        arrays["world"]["tick"], arrays["report"]["count"] = tick, 0
        self._tick, self._referee = tick, referee
        ask(self)
        after = rule_state(arrays["words"])
        said = arrays["report"]["event"][: arrays["report"]["count"]].tolist()
        events = tuple(GameEvent(KINDS[kind], when, value) for kind, when, value, _ in said)
        return after._replace(memory=state.memory, open_gates=state.open_gates), events

    def judge(self, call: Call, value: int = 0) -> None:
        """Let the rules act on something that happens between two ticks."""
        self._referee.judge(call, value)

    def hit(self, points: int) -> None:
        """Let the rules act on a hit of a part with so many points."""
        arrays, _ = self._made
        arrays["part"]["points"] = points
        self.happen(EventKind.HIT, 0)

    def happen(self, kind: EventKind, ball: int) -> None:
        """Let the rules act on an event of the part in a tick, with a ball."""
        arrays, _ = self._made
        log = arrays["log"]
        log["count"] = 1
        log["event"][0]["kind"], log["event"][0]["ball"], log["event"][0]["tick"] = kind, ball, self._tick
        log["event"][0]["part"] = arrays["number"]
        arrays["world"]["tick"] = self._tick + 1
        self._referee.judge(Call.TICKS, 0)

    @cached_property
    def _made(self) -> tuple[dict[str, Any], SingleJudge]:
        """All records by name, and the referee; made when they are first needed."""
        table = Table(cylinder=(Cylinder(center=(0.0, 0.0), radius=0.5, points=1),))
        books = compile_rules([table], [compile_parts(table)], [RuleConfig.of(table, 1)], 1)
        games, reports = records(1, GAME), records(1, REPORT)
        worlds, boards, logs = records(1, PLAIN_WORLD), records(1, BOARD), records(1, LOG)
        field = (worlds, boards, records(1, COLLIDER), np.zeros(1, np.int32), np.zeros((1, 2)), logs)
        number = next(row for row, part in enumerate(books.book.parts) if part["points"])
        books.book.parts[number]["is_plunger"] = 1
        arrays = {
            "words": np.frombuffer(games.data, np.int64), "report": reports[0], "setup": books.setups[0],
            "world": worlds[0], "log": logs[0], "part": books.book.parts[number], "number": number,
        }  # fmt: skip
        games[0] = books.blank[0]
        return arrays, SingleJudge((games, reports), books, field)


SCRATCH = ScratchGame()
"""The one scratch game of a process."""
