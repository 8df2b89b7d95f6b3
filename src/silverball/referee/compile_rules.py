"""Compiling rules: from the models of a table to rows of integers.

The rows of several tables follow each other in shared arrays; the SETUP record of a table says where its
own begin. Names are resolved here; `table.check_rules` has seen to it that they are there, and what a table
made in Python names without having it is refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from silverball.errors import Problem, TableError
from silverball.physics.records import Device, records
from silverball.referee.game_records import (
    BANK_ROW,
    COUNTER_ROW,
    FOREVER,
    GAME,
    LAMP_ROW,
    MODE_ROW,
    NOT_RUNNING,
    OP,
    PART_ROW,
    REACH_ROW,
    RULE,
    SETUP,
    Begin,
    Book,
    Light,
    Op,
    Own,
    Trigger,
)
from silverball.referee.rule_config import RuleConfig
from silverball.referee.stillness import CHECK_RATE
from silverball.table import Table
from silverball.table.expand import expand
from silverball.table.rulebook import Rule
from silverball.table.rulebook.rule import ANY_PART, BUTTONS, MOMENTS
from silverball.table.standard_rules import rules_of, standard_rules

LIGHTS = {"off": Light.OFF, "on": Light.ON, "blinking": Light.BLINKING}
BEGINS = {None: Begin.NEVER, "ball": Begin.BALL, "game": Begin.GAME}
PRESSED = dict(zip(BUTTONS, (Trigger.LEFT, Trigger.RIGHT, Trigger.PLUNGER), strict=True))
OWN_COUNTERS = {one.name.lower(): int(one) for one in Own if one is not Own.COUNT}
ON_LAMPS = {"light": Op.LIGHT, "blink": Op.BLINK, "unlight": Op.UNLIGHT}
IN_GROUPS = {
    "light_next": Op.LIGHT_NEXT, "advance": Op.ADVANCE, "rotate_left": Op.ROTATE_LEFT,
    "rotate_right": Op.ROTATE_RIGHT,
}  # fmt: skip
CONDITION_LAMPS = {"if_lit": Op.IF_LIT, "if_blinking": Op.IF_BLINKING, "if_unlit": Op.IF_UNLIT}

Action = tuple[int, int, int, float, float]


class RuleBooks(NamedTuple):
    """The compiled rules of some tables.

    Attributes:
        setups: SETUP records [table].
        book: Their rules, with the SETUP record of the first table.
        texts: For each table the messages and cues of its rules, which reported events number.
        modes: For each table the names of its modes.
        lamps: For each table the names of its lamps.
        counters: For each table the names of its counters.
        is_own: Whether each table has rules of its own.
        blank: A game that has not begun, for each table: GAME records [table].
    """

    setups: NDArray[Any]
    book: Book
    texts: tuple[tuple[str, ...], ...]
    modes: tuple[tuple[str, ...], ...]
    lamps: tuple[tuple[str, ...], ...]
    counters: tuple[tuple[str, ...], ...]
    is_own: tuple[bool, ...]
    blank: NDArray[Any]


class _Rows:
    """Rows of all tables, as they are appended."""

    def __init__(self) -> None:
        self.rules: list[tuple[int, ...]] = []
        self.ops: list[Action] = []
        self.triggers: list[int] = []
        self.listed: list[int] = []
        self.parts: list[tuple[int, ...]] = []
        self.lamps: list[tuple[int, ...]] = []
        self.counters: list[tuple[int, ...]] = []
        self.modes: list[tuple[int, ...]] = []
        self.reaches: list[tuple[int, ...]] = []
        self.banks: list[tuple[int, ...]] = []


def ticks_of(seconds: float, tick_rate: int) -> int:
    """The whole number of ticks that is nearest to a time, at least 1."""
    return max(round(seconds * tick_rate), 1)


class _Numbers:
    """The numbers of what the rules of a table name."""

    def __init__(self, table: Table, rules: Table, colliders: Any, tick_rate: int) -> None:
        expansion = expand(table)
        self.parts = expansion.numbers | expansion.named
        self.part_rows = [[part.points, 0, -1, 0, 0] for part in expansion.parts]
        self.banks: dict[str, int] = {}
        self.bank_switches: list[int] = []
        self.gates: dict[int, int] = {}
        for row, (number, primitive) in zip(colliders, expansion.rows, strict=True):
            part, role = self.part_rows[number], int(row["role"])
            if role == Device.DROP_TARGET:
                bank = self.banks.setdefault(str(primitive.bank), int(row["number"]))
                self.bank_switches += [0] * (bank + 1 - len(self.bank_switches))
                self.bank_switches[bank] |= int(row["switch"])
                part[1], part[2] = part[1] | int(row["switch"]), bank
            elif role == Device.GATE:
                self.gates[number] = self.gates.get(number, 0) | int(row["switch"])
            part[3] |= int(role == Device.PLUNGER)
            if primitive.launch is not None and primitive.launch.auto is not None:
                part[4] = ticks_of(primitive.launch.auto_delay, tick_rate)
        self.lamps = {lamp.name: number for number, lamp in enumerate(rules.lamp)}
        self.groups: dict[str, list[int]] = {}
        for number, lamp in enumerate(rules.lamp):
            if lamp.group:
                self.groups.setdefault(lamp.group, []).append(number)
        own = {counter.name: Own.COUNT + number for number, counter in enumerate(rules.counter)}
        self.counters = OWN_COUNTERS | own
        self.modes = {mode.name: number for number, mode in enumerate(rules.mode)}

    def bank(self, name: str) -> int:
        """The number of a bank, or of the bank of a target."""
        return self.banks[name] if name in self.banks else int(self.part_rows[self.parts[name]][2])

    def hit_parts(self, name: str) -> list[int]:
        """The parts that a name means: one, those of a bank, or all with points."""
        if name == ANY_PART:
            return [number for number, row in enumerate(self.part_rows) if row[0] > 0]
        if name in self.parts:
            return [self.parts[name]]
        return [number for number, row in enumerate(self.part_rows) if row[2] == self.banks[name]]

    def lamps_of(self, name: str) -> list[int]:
        """The lamps that a name means: one, or those of a group."""
        return self.groups[name] if name in self.groups else [self.lamps[name]]


class _Compiler:
    """Compiles the rules of one table into the rows of all."""

    def __init__(self, rows: _Rows, table: Table, colliders: Any, config: RuleConfig, tick_rate: int) -> None:
        self.rows, self.tick_rate, self.config = rows, tick_rate, config
        self.rules = rules_of(table) if config.balls else standard_rules()
        self.numbers = _Numbers(table, self.rules, colliders, tick_rate)
        self.texts: list[str] = []
        self.triggers: dict[int, list[int]] = {}
        self.reaches: list[tuple[int, int, int]] = []
        parts, modes = len(self.numbers.part_rows), len(self.rules.mode)
        sizes = {
            "hit": parts, "release": parts, "down": len(self.numbers.bank_switches),
            "complete": len(self.numbers.groups), "start": modes, "end": modes, "time": modes,
        }  # fmt: skip
        self.firsts, self.trigger_count = {}, int(Trigger.FIRST_OWN)
        for name, size in sizes.items():
            self.firsts[name] = self.trigger_count
            self.trigger_count += size

    def compile(self, setup: Any) -> None:
        """Append all rows, and write where they are into a SETUP record."""
        rows, numbers = self.rows, self.numbers
        for name, own_rows in (
            ("lamp", rows.lamps), ("counter", rows.counters), ("mode", rows.modes), ("part", rows.parts),
            ("bank", rows.banks), ("trigger", rows.triggers), ("reach", rows.reaches),
        ):  # fmt: skip
            setup[f"{name}_first"] = len(own_rows)
        for name, first in self.firsts.items():
            setup[f"{name}_first"] = first
        setup["parts"] = len(numbers.part_rows)
        setup["lamps"], setup["counters"] = len(self.rules.lamp), len(self.rules.counter)
        setup["modes"] = len(self.rules.mode)
        set_config(setup, self.config, self.tick_rate)
        setup["has_points"] = any(row[0] for row in numbers.part_rows)
        setup["gates"] = sum(numbers.gates.values())
        rows.parts += [tuple(row) for row in numbers.part_rows]
        rows.banks += [(switches,) for switches in numbers.bank_switches]
        self._append_states()
        for number, rule in enumerate(self.rules.rule, len(rows.rules)):
            self._listen(rule, number)
        for rule in self.rules.rule:
            conditions, effects = list(self._conditions(rule)), list(self._effects(rule))
            first = len(rows.ops)
            rows.ops += conditions + effects
            rows.rules.append((first, first + len(conditions), len(rows.ops)))
        rows.reaches += self.reaches
        setup["reach_end"] = len(rows.reaches)
        for trigger in range(self.trigger_count):
            rows.triggers.append(len(rows.listed))
            rows.listed += self.triggers.get(trigger, [])
        rows.triggers.append(len(rows.listed))

    def _append_states(self) -> None:
        """Append the rows of lamps, counters and modes."""
        rows, rules = self.rows, self.rules
        spans: dict[str, tuple[int, int, int]] = {}
        for number, (group, lamps) in enumerate(self.numbers.groups.items()):
            spans[group] = (number, len(rows.listed), len(rows.listed) + len(lamps))
            rows.listed += lamps
        for lamp in rules.lamp:
            begins = int(LIGHTS[lamp.begins])
            rows.lamps.append((begins, lamp.lasts == "ball", *spans.get(lamp.group, (-1, 0, 0))))
        for counter in rules.counter:
            begins = min(counter.begins, counter.most)
            rows.counters.append((begins, counter.lasts == "ball", counter.most))
        for mode in rules.mode:
            ticks = 0 if mode.seconds is None else ticks_of(mode.seconds, self.tick_rate)
            rows.modes.append((ticks, int(BEGINS[mode.begins]), mode.lasts == "ball"))

    def _listen(self, rule: Rule, number: int) -> None:
        """Append a rule to the list of each of its triggers."""
        numbers, firsts = self.numbers, self.firsts
        heard = [firsts["hit"] + part for name in rule.on_hit for part in numbers.hit_parts(name)]
        heard += [int(Trigger.ANY_HIT)] * (ANY_PART in rule.on_hit)
        heard += [firsts["release"] + numbers.parts[name] for name in rule.on_release]
        heard += [firsts["down"] + numbers.bank(name) for name in rule.on_down]
        heard += [firsts["complete"] + list(numbers.groups).index(name) for name in rule.on_complete]
        for key, names in (("start", rule.on_start), ("end", rule.on_end), ("time", rule.on_time)):
            heard += [firsts[key] + numbers.modes[name] for name in names]
        heard += [int(PRESSED[name]) for name in rule.on_press]
        heard += [MOMENTS.index(name) for name in rule.on_ball]
        heard += [self._reach(numbers.counters[name], value) for name, value in rule.on_count.items()]
        for trigger in dict.fromkeys(heard):
            self.triggers.setdefault(trigger, []).append(number)

    def _reach(self, counter: int, value: int) -> int:
        """The trigger by a counter that reaches a value."""
        for known_counter, known_value, trigger in self.reaches:
            if (known_counter, known_value) == (counter, value):
                return trigger
        self.reaches.append((counter, value, self.trigger_count))
        self.trigger_count += 1
        return self.trigger_count - 1

    def _conditions(self, rule: Rule) -> Iterable[Action]:
        for key, op in CONDITION_LAMPS.items():
            for name in getattr(rule, key):
                yield from (_action(op, lamp) for lamp in self.numbers.lamps_of(name))
        for op, names in ((Op.IF_RUNNING, rule.if_running), (Op.IF_STOPPED, rule.if_stopped)):
            yield from (_action(op, self.numbers.modes[name]) for name in names)
        for op, values in ((Op.IF_AT_LEAST, rule.if_at_least), (Op.IF_BELOW, rule.if_below)):
            yield from (_action(op, self.numbers.counters[name], value) for name, value in values.items())

    def _effects(self, rule: Rule) -> Iterable[Action]:
        """Yield the effects in the order of the keys."""
        counters, modes = self.numbers.counters, self.numbers.modes
        yield from (_action(Op.ADD, counters[name], value) for name, value in rule.add.items())
        yield from (_action(Op.SET, counters[name], value) for name, value in rule.set.items())
        if rule.award or rule.award_part:
            yield _action(Op.AWARD, value=rule.award)
            yield from [_action(Op.AWARD_PART)] * rule.award_part
            yield from (_action(Op.TIMES, counters[name]) for name in rule.times)
            yield _action(Op.GIVE)
        for key, op in ON_LAMPS.items():
            for name in getattr(rule, key):
                yield from (_action(op, lamp) for lamp in self.numbers.lamps_of(name))
        for key, op in IN_GROUPS.items():
            yield from (_action(op, self.numbers.groups[name][0]) for name in getattr(rule, key))
        yield from (_action(Op.START, modes[name]) for name in rule.start)
        yield from (_action(Op.STOP, modes[name]) for name in rule.stop)
        yield from (
            _action(Op.EXTEND, modes[name], value * self.tick_rate) for name, value in rule.extend.items()
        )
        yield from self._ball_effects(rule)
        for op, text in ((Op.MESSAGE, rule.message), (Op.CUE, rule.cue)):
            if text:
                yield _action(op, len(self.texts))
                self.texts.append(text)

    def _ball_effects(self, rule: Rule) -> Iterable[Action]:
        numbers = self.numbers
        if rule.save:
            yield _action(Op.SAVE, value=ticks_of(rule.save, self.tick_rate))
        if rule.extra_ball:
            yield _action(Op.EXTRA_BALL, value=rule.extra_ball)
        if rule.kick is not None:
            yield int(Op.KICK), 0, 0, *rule.kick
        if rule.lock:
            yield _action(Op.LOCK)
        yield from (_action(Op.EJECT, numbers.parts[name]) for name in rule.eject)
        yield from (_action(Op.RESET, numbers.bank(name)) for name in rule.reset)
        yield from (_action(Op.OPEN, numbers.gates[numbers.parts[name]]) for name in rule.open)
        yield from (_action(Op.CLOSE, numbers.gates[numbers.parts[name]]) for name in rule.close)
        if rule.multiball:
            yield _action(Op.MULTIBALL, value=rule.multiball)


def _action(op: Op, target: int = 0, value: int = 0) -> Action:
    return int(op), int(target), int(value), 0.0, 0.0


def set_config(setup: Any, config: RuleConfig, tick_rate: int) -> None:
    """Write the numbers of a game into a SETUP record."""
    for name in RuleConfig._fields:
        setup[name] = getattr(config, name)
    setup["check_ticks"] = max(tick_rate // CHECK_RATE, 1)
    setup["tilts"] = config.balls != 0  # free play has any number of balls, and no tilt


def compile_rules(
    tables: Sequence[Table], colliders: Sequence[Any], configs: Sequence[RuleConfig], tick_rate: int
) -> RuleBooks:
    """Compile the rules of finished tables.

    Args:
        tables: The tables.
        colliders: Their compiled rows, COLLIDER records of each table.
        configs: The numbers of a game on each. Games with any number of balls, as in free play, have the
        standard
            rules.
        tick_rate: Ticks per second.

    Raises:
        TableError: A rule names what is not there, or there is too much of something.
    """
    rows, setups = _Rows(), records(len(tables), SETUP)
    compilers = []
    for setup, table, one, config in zip(setups, tables, colliders, configs, strict=True):
        compiler = _Compiler(rows, table, one, config, tick_rate)
        try:
            compiler.compile(setup)
        except KeyError as error:
            message = f"names {error.args[0]!r}, which this table does not have"
            raise TableError(table.name, [Problem("rule", message)]) from None
        compilers.append(compiler)
    book = Book(
        setups[0], _records(rows.rules, RULE), _records(rows.ops, OP), np.array(rows.triggers, np.int64),
        np.array([*rows.listed, 0], np.int64), _records(rows.parts, PART_ROW), _records(rows.lamps, LAMP_ROW),
        _records(rows.counters, COUNTER_ROW), _records(rows.modes, MODE_ROW),
        _records(rows.reaches, REACH_ROW), _records(rows.banks, BANK_ROW),
    )  # fmt: skip
    return RuleBooks(
        setups,
        book,
        tuple(tuple(one.texts) for one in compilers),
        tuple(tuple(mode.name for mode in one.rules.mode) for one in compilers),
        tuple(tuple(lamp.name for lamp in one.rules.lamp) for one in compilers),
        tuple(tuple(counter.name for counter in one.rules.counter) for one in compilers),
        tuple(one.rules is not standard_rules() for one in compilers),
        _blank_games(compilers, setups),
    )


def _records(rows: Sequence[tuple[Any, ...]], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Rows as records; at least one, because kernels take no empty arrays of records by their type alone."""
    found = records(max(len(rows), 1), dtype)
    for number, row in enumerate(rows):
        found[number] = tuple(row)
    return found


def _blank_games(compilers: Sequence[_Compiler], setups: NDArray[Any]) -> NDArray[Any]:
    games = records(len(compilers), GAME)
    games["mode_end"], games["next_end"] = NOT_RUNNING, FOREVER
    games["next_look"] = setups["check_ticks"]
    for game, compiler in zip(games, compilers, strict=True):
        for number, lamp in enumerate(compiler.rules.lamp):
            game["lamp"][number] = LIGHTS[lamp.begins]
        for number, counter in enumerate(compiler.rules.counter):
            game["counter"][number] = min(counter.begins, counter.most)
    return games
