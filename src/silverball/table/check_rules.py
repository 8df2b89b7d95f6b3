"""Checks of the rules of a table: names that are not there, rules that never act, and rules that loop.

What a single key holds is validated by the models (`rulebook/`). Here it is looked at what keys name, in
this order: the lamps, counters and modes themselves; what each rule names; whether it can act; whether
rules set each other off without an end.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from silverball.errors import Problem
from silverball.table.check_loops import loop_problems, never_problems
from silverball.table.kinds.board import BORDERS, Board
from silverball.table.kinds.part import Part
from silverball.table.quantity import shown
from silverball.table.rulebook.rule import ANY_PART, BUTTONS, EFFECTS, MOMENTS, TRIGGERS, Rule

LIMITS = {"lamp": 128, "counter": 48, "mode": 32, "rule": 256}  # of a game's record, and of one trigger
CHANGEABLE = ("combo", "locked", "extra_balls")
READABLE = ("combo_factor", "ball_factor", "ball", "balls_left", "in_play", "warnings")
LAMP_KEYS = ("if_lit", "if_blinking", "if_unlit", "light", "blink", "unlight")
GROUP_KEYS = ("on_complete", "light_next", "advance", "rotate_left", "rotate_right")
MODE_KEYS = ("on_start", "on_end", "on_time", "if_running", "if_stopped", "start", "stop", "extend")
COUNTER_KEYS = ("on_count", "if_at_least", "if_below", "add", "set", "times")
LENS_KEYS = ("shape", "size", "angle", "color")
COVERED = 0.8  # of the larger lens's radius: lamps nearer to each other than this cover each other
BALL_TRIGGERS = ("on_hit", "on_release")


class Placed(NamedTuple):
    """A section of the file with its place, in messages."""

    path: str
    item: Any


class Rulebook(NamedTuple):
    """The rules of a table, as far as they are valid.

    Attributes:
        lamps: The lamps.
        counters: The counters.
        modes: The modes.
        rules: The rules.
        unread: The names of sections that are not valid by themselves, by the kind of section.
    """

    lamps: list[Placed]
    counters: list[Placed]
    modes: list[Placed]
    rules: list[Placed]
    unread: Mapping[str, Collection[str]]

    @property
    def is_whole(self) -> bool:
        """Whether all sections are valid by themselves."""
        return not any(self.unread.values())


class _Names(NamedTuple):
    """What rules can name, by the sort of thing."""

    parts: frozenset[str]
    releasing: frozenset[str]  # holes and plungers
    holes: frozenset[str]
    banks: frozenset[str]
    gates: frozenset[str]
    lamps: frozenset[str]
    groups: frozenset[str]
    counters: frozenset[str]
    modes: frozenset[str]


def rule_problems(book: Rulebook, parts: Iterable[tuple[str, Part]], board: Board) -> list[Problem]:
    """Find every problem of the rules of a table.

    Args:
        book: The rules.
        parts: The parts of the table, by their places.
        board: Its board.
    """
    names = _names(book, parts, board)
    problems = _limit_problems(book) + _state_problems(book, board)
    for path, rule in book.rules:
        found = list(_name_problems(path, rule, names))
        problems += found + list(_rule_problems(path, rule, board))
    if not problems and book.is_whole:
        lamps = {placed.item.name: placed.item for placed in book.lamps}
        counters = {placed.item.name: placed.item for placed in book.counters}
        modes = {placed.item.name: placed.item for placed in book.modes}
        problems += never_problems(book.rules, lamps, counters, modes) + loop_problems(book.rules, lamps)
    return problems


def _names(book: Rulebook, parts: Iterable[tuple[str, Part]], board: Board) -> _Names:
    found: dict[str, set[str]] = {key: set() for key in ("parts", "releasing", "holes", "banks", "gates")}
    found["parts"] |= {f"board.{border}" for border in BORDERS}
    seen_sides: set[str] = set()
    for path, part in parts:
        side = getattr(part, "side", None)
        is_first = path.startswith("paddle") and side not in seen_sides
        place = f"paddle.{side}" if is_first else path
        seen_sides |= {side} if is_first and side else set()
        called = {place, part.name} - {""}
        found["parts"] |= called
        for one in part.primitives(board):
            if one.launch is not None or (one.hold is not None and not one.hold.is_drain):
                found["releasing"] |= called
            if one.hold is not None and not one.hold.is_drain:
                found["holes"] |= called
            if one.is_gate:
                found["gates"] |= called
            if one.bank is not None:
                found["banks"] |= {one.bank} if one.bank else called
    groups = {placed.item.group for placed in book.lamps} - {""}
    return _Names(
        **{key: frozenset(names) for key, names in found.items()},
        lamps=frozenset({placed.item.name for placed in book.lamps} | set(book.unread["lamp"])),
        groups=frozenset(groups),
        counters=frozenset({placed.item.name for placed in book.counters} | set(book.unread["counter"])),
        modes=frozenset({placed.item.name for placed in book.modes} | set(book.unread["mode"])),
    )


def _limit_problems(book: Rulebook) -> list[Problem]:
    problems = []
    for section, items in zip(LIMITS, (book.lamps, book.counters, book.modes, book.rules), strict=True):
        if len(items) > LIMITS[section]:
            message = f"must not be more than {LIMITS[section]}, got {len(items)}: remove some"
            problems.append(Problem(section, message))
    return problems


def _state_problems(book: Rulebook, board: Board) -> list[Problem]:
    """The lamps, counters and modes by themselves."""
    problems = [*_twice(book.lamps), *_twice(book.counters), *_twice(book.modes)]
    groups = {placed.item.group for placed in book.lamps} - {""}
    for path, lamp in book.lamps:
        if lamp.name in groups:
            message = f"must not be {shown(lamp.name)}, the name of a group: call one of them otherwise"
            problems.append(Problem(f"{path}.name", message))
        if lamp.center is not None:
            x, z = lamp.center
            if abs(x) > board.length / 2 or abs(z) > board.width / 2:
                message = f"must lie on the board, got [{x:g}, {z:g}]: move it"
                problems.append(Problem(f"{path}.center", message))
    problems += _hidden_lamps(book.lamps)
    for path, counter in book.counters:
        if counter.name in (*CHANGEABLE, *READABLE):
            message = f"must not be {shown(counter.name)}, a counter of the machine: call it otherwise"
            problems.append(Problem(f"{path}.name", message))
        if counter.begins > counter.most:
            message = f"must be at most `most`, {counter.most:,}, got {counter.begins:,}: lower it"
            problems.append(Problem(f"{path}.begins", message))
    if (book.lamps or book.counters or book.modes) and not book.rules and book.is_whole:
        first = (book.lamps or book.counters or book.modes)[0].path
        message = "is of no use: the table has no rules, so the standard ones are played; add a [[rule]]"
        problems.append(Problem(first, message, "warning"))
    return problems


def _hidden_lamps(lamps: list[Placed]) -> Iterator[Problem]:
    """Lamps of which nothing is seen: without a place, or with another one on top."""
    seen: list[Placed] = []
    for path, lamp in lamps:
        if lamp.center is None:
            for key in LENS_KEYS:
                if getattr(lamp, key) != type(lamp).model_fields[key].default:
                    message = "is of no use without a place: add `center`, or remove it"
                    yield Problem(f"{path}.{key}", message, "warning")
            continue
        for other_path, other in seen:
            gap = math.dist(lamp.center, other.center)
            if gap < COVERED * max(lamp.size, other.size):
                message = (
                    f"is {gap:.2g} u from that of {other_path}, so one covers the other: move one of them"
                )
                yield Problem(f"{path}.center", message, "warning")
                break
        seen.append(Placed(path, lamp))


def _twice(items: list[Placed]) -> Iterator[Problem]:
    seen: dict[str, str] = {}
    for path, item in items:
        if item.name in seen:
            message = f"must not be {shown(item.name)} again: {seen[item.name]} has this name already"
            yield Problem(f"{path}.name", message)
        seen.setdefault(item.name, path)


def _name_problems(path: str, rule: Rule, names: _Names) -> Iterator[Problem]:
    """What a rule names and the table does not have."""
    lit = names.lamps | names.groups
    hit = names.parts | names.banks | {ANY_PART}
    read = names.counters | {*CHANGEABLE, *READABLE}
    wanted: list[tuple[tuple[str, ...], frozenset[str], str]] = [
        (("on_hit",), hit, "a part, a bank or `any`"),
        (("on_release",), names.releasing, "a hole or a plunger"),
        (("on_down", "reset"), names.banks, "a bank of drop targets"),
        (("on_press",), frozenset(BUTTONS), "a button"),
        (("on_ball",), frozenset(MOMENTS), "a moment of a ball"),
        (LAMP_KEYS, lit, "a lamp or a group of lamps"),
        (GROUP_KEYS, names.groups, "a group of lamps"),
        (MODE_KEYS, names.modes, "a mode"),
        (COUNTER_KEYS, read, "a counter"),
        (("eject",), names.holes, "a hole that holds balls"),
        (("open", "close"), names.gates, "a held gate"),
    ]
    for keys, known, what in wanted:
        for key in keys:
            for name in getattr(rule, key):
                if name not in known:
                    yield Problem(f"{path}.{key}", _missing(name, known, what))
                elif key in ("add", "set", "on_count") and name in READABLE:
                    message = f"must not be {shown(name)}, which the machine sets: use your own [[counter]]"
                    yield Problem(f"{path}.{key}", message)


def _missing(name: str, known: Collection[str], what: str) -> str:
    close = difflib.get_close_matches(name, sorted(known), n=1, cutoff=0.6)
    if close:
        remedy = f"did you mean {shown(close[0])}?"
    elif not known:
        remedy = "the table has none; add one"
    else:
        listed = sorted(known)[:8]
        remedy = f"there is {', '.join(map(shown, listed))}{' and more' if len(known) > len(listed) else ''}"
    return f"must name {what}, got {shown(name)}: {remedy}"


def _rule_problems(path: str, rule: Rule, board: Board) -> Iterator[Problem]:
    """A rule by itself: without triggers or effects, with effects that its triggers do not allow."""
    if not any(getattr(rule, key) for key in TRIGGERS):
        yield Problem(path, 'needs a trigger, for example on_hit = "any": without one it never acts')
    acts = [key for key in EFFECTS if key != "times" and getattr(rule, key) not in ((), {}, 0, 0.0, "", None)]
    acts = [key for key in acts if getattr(rule, key) is not False]
    if not acts:
        yield Problem(path, "needs an effect, for example award = 1000: without one it does nothing")
    if rule.times and not (rule.award or rule.award_part):
        yield Problem(f"{path}.times", "multiplies nothing: add `award` or `award_part`, or remove it")
    if rule.award_part and not rule.on_hit:
        yield Problem(f"{path}.award_part", "needs a part that was hit: add `on_hit`, or use `award`")
    has_ball = any(getattr(rule, key) for key in BALL_TRIGGERS)
    if rule.kick is not None and not has_ball:
        yield Problem(f"{path}.kick", "needs a ball: add `on_hit` or `on_release`")
    if rule.lock and not rule.on_hit:
        yield Problem(f"{path}.lock", "needs a ball in a hole: add `on_hit` with the name of a hole")
    if rule.kick is not None and rule.kick[0] ** 2 + rule.kick[1] ** 2 > board.speed_cap**2:
        message = f"must be at most the speed cap of {board.speed_cap:g} u/s, got [{rule.kick[0]:g}, "
        yield Problem(f"{path}.kick", f"{message}{rule.kick[1]:g}]: make it slower, or raise board.speed_cap")
    if rule.multiball > board.max_balls:
        message = f"must be at most board.max_balls, {board.max_balls}, got {rule.multiball}"
        yield Problem(f"{path}.multiball", f"{message}: raise board.max_balls")
    if rule.multiball == 1:
        yield Problem(f"{path}.multiball", "must be 2 or more, got 1: one ball is in play already")
    yield from _contradictions(path, rule)


def _contradictions(path: str, rule: Rule) -> Iterator[Problem]:
    """Conditions that exclude each other."""
    for one, other in (("if_lit", "if_unlit"), ("if_blinking", "if_unlit"), ("if_running", "if_stopped")):
        for name in set(getattr(rule, one)) & set(getattr(rule, other)):
            message = f"and `{other}` both name {shown(name)}, so the rule never acts: remove one of them"
            yield Problem(f"{path}.{one}", message)
    for name in set(rule.if_at_least) & set(rule.if_below):
        if rule.if_at_least[name] >= rule.if_below[name]:
            message = (
                f"asks for {shown(name)} from {rule.if_at_least[name]:,} up, and `if_below` for less than "
                f"{rule.if_below[name]:,}, so the rule never acts: change one of them"
            )
            yield Problem(f"{path}.if_at_least", message)
