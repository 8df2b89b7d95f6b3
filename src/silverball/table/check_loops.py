"""Rules that never act because nothing leads to them, and rules that set each other off without an end."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from silverball.errors import Problem
from silverball.table.quantity import shown

if TYPE_CHECKING:
    from silverball.table.rulebook import Counter, Lamp, PlayMode, Rule

ON_EFFECTS = ("light", "light_next")
LIT_EFFECTS = ("light", "blink", "light_next", "advance")


def never_problems(
    rules: Iterable[tuple[str, Rule]],
    lamps: Mapping[str, Lamp],
    counters: Mapping[str, Counter],
    modes: Mapping[str, PlayMode],
) -> list[Problem]:
    """Find the conditions and triggers that never hold, and the modes that nobody starts."""
    rules = list(rules)
    problems = list(_mode_problems(rules, modes))
    problems += _counter_problems(rules, counters)
    lit = {name for _, rule in rules for key in LIT_EFFECTS for name in getattr(rule, key)}
    on = {name for _, rule in rules for key in ON_EFFECTS for name in getattr(rule, key)}
    blinking = {name for _, rule in rules for name in (*rule.blink, *rule.advance)}
    for path, rule in rules:
        for key, effects, begins in (
            ("if_lit", lit, ("on", "blinking")),
            ("if_blinking", blinking, ("blinking",)),
            ("on_complete", on, ("on",)),
        ):
            for name in getattr(rule, key):
                if not all(_can_be(lamp, effects, begins, lamps.values()) for lamp in _lamps_of(name, lamps)):
                    state = {"if_lit": "lit", "if_blinking": "blinking", "on_complete": "all on"}[key]
                    message = f"waits for {shown(name)} to be {state}, which no rule brings about: light it"
                    problems.append(Problem(f"{path}.{key}", message))
    return problems


def _lamps_of(name: str, lamps: Mapping[str, Lamp]) -> list[Lamp]:
    return [lamp for lamp in lamps.values() if name in (lamp.name, lamp.group)]


def _can_be(lamp: Lamp, effects: set[str], begins: tuple[str, ...], lamps: Iterable[Lamp]) -> bool:
    """Whether a lamp begins in one of these states, or gets into one by effects or by rotating its group."""
    if {lamp.name, lamp.group} & effects or lamp.begins in begins:
        return True
    return bool(lamp.group) and any(
        other.group == lamp.group and (other.begins in begins or other.name in effects) for other in lamps
    )


def _mode_problems(rules: list[tuple[str, Rule]], modes: Mapping[str, PlayMode]) -> Iterator[Problem]:
    started = {name for _, rule in rules for name in rule.start}
    used: dict[str, str] = {}
    for path, rule in rules:
        for key in ("on_start", "on_end", "on_time", "if_running"):
            for name in getattr(rule, key):
                used.setdefault(name, f"{path}.{key}")
        for key in ("on_time", "extend"):
            for name in getattr(rule, key):
                if modes[name].seconds is None:
                    message = f"needs a mode with `seconds`, which {shown(name)} does not have: give it some"
                    yield Problem(f"{path}.{key}", message)
    for number, mode in enumerate(modes.values()):
        if mode.name in started or mode.begins is not None:
            continue
        where = f", but {used[mode.name]} waits for it" if mode.name in used else ""
        message = f"is started by no rule{where}: add it to `start` of one, or give it `begins`"
        yield Problem(f"mode[{number}]", message, "error" if where else "warning")


def _counter_problems(rules: list[tuple[str, Rule]], counters: Mapping[str, Counter]) -> Iterator[Problem]:
    raised = {name for _, rule in rules for key in ("add", "set") for name in getattr(rule, key)}
    for path, rule in rules:
        for key in ("on_count", "if_at_least"):
            for name, value in getattr(rule, key).items():
                if name not in counters:
                    continue
                counter = counters[name]
                if value > counter.most:
                    message = f"asks for {value:,}, but {shown(name)} goes to {counter.most:,} only: lower it"
                    yield Problem(f"{path}.{key}", message)
                elif name not in raised and value > counter.begins:
                    message = f"waits for {shown(name)} to reach {value:,}, but no rule adds to it: add one"
                    yield Problem(f"{path}.{key}", message)


def loop_problems(rules: Iterable[tuple[str, Rule]], lamps: Mapping[str, Lamp]) -> list[Problem]:
    """Find the rules that set each other off in the same tick, round and round."""
    placed = list(rules)
    following = [
        [number for number, (_, other) in enumerate(placed) if _sets_off(rule, other, lamps)]
        for _, rule in placed
    ]
    problems, seen = [], set()
    for start in range(len(placed)):
        loop = _way_back(start, following)
        if not loop or frozenset(loop) in seen:
            continue
        seen.add(frozenset(loop))
        if _is_endless([placed[number][1] for number in loop], lamps):
            path = placed[start][0]
            way = " → ".join(placed[number][0] for number in (*loop, start))
            message = f"sets itself off without an end ({way}): take one of them out of the ring"
            problems.append(Problem(path, message))
    return problems


def _sets_off(rule: Rule, other: Rule, lamps: Mapping[str, Lamp]) -> bool:
    """Whether what a rule does can set off another one at once."""
    reaches = any(
        rule.add.get(name, 0) > 0 or rule.set.get(name, 0) >= value for name, value in other.on_count.items()
    )
    return reaches or _sets_off_anew(rule, other, lamps)


def _sets_off_anew(rule: Rule, other: Rule, lamps: Mapping[str, Lamp]) -> bool:
    """Whether it does so each time, by something else than a counter."""
    lit = {lamp.group for name in (*rule.light, *rule.light_next) for lamp in _lamps_of(name, lamps)}
    return bool(
        set(rule.start) & set(other.on_start)
        or set(rule.stop) & set(other.on_end)
        or lit & set(other.on_complete)
    )


def _is_endless(loop: list[Rule], lamps: Mapping[str, Lamp]) -> bool:
    """Whether the rules of a ring go on setting each other off: a counter that only grows is reached once."""
    return all(
        _sets_off_anew(rule, other, lamps)
        or any(_is_reached_anew(loop, number, name, value) for name, value in other.on_count.items())
        for number, (rule, other) in enumerate(zip(loop, [*loop[1:], loop[0]], strict=True))
    )


def _is_reached_anew(loop: list[Rule], number: int, name: str, value: int) -> bool:
    """Whether a rule of a ring brings a counter to a value from below, after all others have changed it."""
    count, is_reached = value, False
    for rule in (*loop[number + 1 :], *loop[: number + 1]):
        is_reached = False
        added = max(count + rule.add.get(name, 0), 0)
        for now in (added, rule.set.get(name, added)):
            is_reached = is_reached or count < value <= now
            count = now
    return is_reached


def _way_back(start: int, following: list[list[int]]) -> list[int]:
    """The shortest way from a rule back to itself; empty if there is none."""
    ways: dict[int, list[int]] = {start: [start]}
    waiting = [start]
    while waiting:
        number = waiting.pop(0)
        for next_number in following[number]:
            if next_number == start:
                return ways[number]
            if next_number not in ways:
                ways[next_number] = [*ways[number], next_number]
                waiting.append(next_number)
    return []
