"""The games of environments with rules: compiled rules, and the names of what rules count."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.envs.board_pool import Pool
from silverball.envs.options import Options
from silverball.envs.state import HAPPENINGS
from silverball.physics.records import records
from silverball.referee.compile_rules import RuleBooks, compile_rules
from silverball.referee.game_records import REPORT
from silverball.referee.rule_config import RuleConfig
from silverball.table import Table
from silverball.table.standard_rules import rules_of

UNLIMITED = 10**9  # `most` of a counter that has no limit of its own
SATURATION = 10.0  # additions to an unlimited counter after which half of its scale is reached
PAR = 100_000.0  # points that are shown as one half where a table has no gold medal


class GameRules(NamedTuple):
    """The rules by which the episodes of an engine are played.

    Attributes:
        books: The compiled rules of all boards.
        scales: What the value of each counter is divided by; see `counter_scales`.
        par: Points that are shown as one half.
    """

    books: RuleBooks
    scales: NDArray[np.float64]
    par: float

    @property
    def happenings(self) -> int:
        """The number of things that are counted: the kinds, and the starts of each mode."""
        return len(HAPPENINGS) + len(self.books.modes[0])

    @property
    def own_terms(self) -> tuple[str, ...]:
        """The names of the terms of a reward that games have beyond `TERMS`, in the order of the kernels."""
        modes = (f"mode {name}" for name in self.books.modes[0])
        counters = (f"counter {name}" for name in self.books.counters[0])
        return (*HAPPENINGS, *modes, *counters)

    @property
    def names(self) -> dict[str, tuple[str, ...]]:
        """The names of the lamps, counters and modes, in the order of an observation."""
        books = self.books
        return {"lamps": books.lamps[0], "counters": books.counters[0], "modes": books.modes[0]}

    @property
    def digest(self) -> str:
        """A hash of the rules."""
        found = hashlib.sha256(self.books.setups.tobytes())
        for rows in self.books.book[1:]:
            found.update(rows.tobytes())
        return found.hexdigest()

    def arrays(self, weights: Mapping[str, float], count: int, rewarded: int) -> dict[str, NDArray[Any]]:
        """All arrays of `GAME_ARRAYS` for some environments, but the games and what has happened.

        Args:
            weights: Of the terms of a reward, some of which may be `own_terms`.
            count: The number of environments.
            rewarded: As many if their rewards weigh counts, else 0.
        """
        books, terms = self.books, self.own_terms
        names = ("rule", "op", "trigger", "listed", "part", "lamp", "counter", "mode", "reach", "bank")
        rows = {f"{name}_rows": rows for name, rows in zip(names, books.book[1:], strict=True)}
        own_weights = np.array([weights.get(name, 0.0) for name in terms])
        return {
            **rows, "setups": books.setups, "blank_games": books.blank, "counter_scales": self.scales,
            "reports": records(count, REPORT), "seen": np.zeros(count, np.int64), "game_weights": own_weights,
            "happened_before": np.zeros((rewarded, len(terms)), np.int64),
        }  # fmt: skip


def compile_games(options: Options, pool: Pool) -> GameRules:
    """Compile the rules of the boards of a pool.

    Raises:
        ValueError: The tables of a list differ in their lamps, counters or modes.
    """
    tables, rate = pool.tables, options.tick_rate
    edges = pool.boards.board[["collider_first", "collider_end"]].tolist()
    colliders = [pool.boards.collider[first:end] for first, end in edges]
    configs = [RuleConfig.of(one, rate)._replace(balls=options.balls) for one in tables]
    books = compile_rules(tables, colliders, configs, rate)
    for kind in ("lamps", "counters", "modes"):
        names = getattr(books, kind)
        if any(one != names[0] for one in names):
            raise ValueError(f"tables of a list that are played with rules=True must have the same {kind}")
    scales = [counter_scales(one) for one in tables]
    rows = np.zeros(len(books.book.counters))
    found = np.concatenate(scales)
    rows[: len(found)] = found
    return GameRules(books, rows, float(tables[0].arcade.gold or PAR))


def counter_scales(table: Table) -> NDArray[np.float64]:
    """What the value of each counter of a table is divided by for an observation.

    That is the greatest value that it can have, or else the greatest one that a rule waits for. Of a counter
    with neither it is −s: its value v is shown as v / (v + s); s is ten times the most that a rule adds.
    """
    rules, scales = rules_of(table), []
    for counter in rules.counter:
        name, awaited, added = counter.name, [0], [1]
        for rule in rules.rule:
            awaited += [values[name] for values in (rule.on_count, rule.if_at_least) if name in values]
            added += [values[name] for values in (rule.add, rule.set) if name in values]
        limit = counter.most if counter.most < UNLIMITED else max(awaited)
        scales.append(float(limit) if limit > 0 else -SATURATION * max(added))
    return np.array(scales)
