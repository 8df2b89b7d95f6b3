"""A table's rules in words: what is to be shot, what it brings, and what is lit just now.

All words are the table's own: names of parts, lamps, modes and counters, and messages. Nothing here plays
the rules; it reads what the referee keeps and asks which conditions hold.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from silverball.plain import plain
from silverball.table import Table
from silverball.table.rulebook import Rule
from silverball.table.rulebook.rule import ANY_PART

MOST_NAMED = 3  # parts named in one line
OFF, BLINKING = "off", "blinking"
SHOT = " shot"  # at the end of a timer's name


class Standing(NamedTuple):
    """How a game stands, as `GameCore` tells it.

    Attributes:
        lamps: The state of every lamp by its name: "off", "on" or "blinking".
        counters: The value of every counter by its name.
        modes: The modes that run, and how long they still do [s]; None: without an end.
    """

    lamps: Mapping[str, str]
    counters: Mapping[str, int]
    modes: Mapping[str, float | None]


class Shot(NamedTuple):
    """Something that pays now.

    Attributes:
        where: What is to be shot.
        what: What it brings.
        is_blinking: Whether its lamp blinks.
        is_mission: Whether it belongs to a mode that runs.
        points: What it awards now.
    """

    where: str
    what: str
    is_blinking: bool = False
    is_mission: bool = False
    points: int = 0


class Offer(NamedTuple):
    """A shot that pays while conditions hold, in words.

    Attributes:
        where: What is to be shot.
        phrases: What it brings beside points.
        otherwise: What is said if it brings neither of them.
        is_mission: Whether it belongs to a mode.
        award: The points that it awards, times the counters.
        times: Counters that multiply them, and what is added to each before.
        unlit: Lamps that must be off.
        lit: Lamps that must be on or blink.
        blinking: Lamps that must blink.
        running: Modes that must run.
        stopped: Modes that must not.
        at_least: The least values of counters.
        below: Values that counters must be below.
    """

    where: str
    phrases: tuple[str, ...]
    otherwise: str
    is_mission: bool
    award: int
    times: tuple[tuple[str, int], ...]
    unlit: tuple[str, ...]
    lit: tuple[str, ...]
    blinking: tuple[str, ...]
    running: tuple[str, ...]
    stopped: tuple[str, ...]
    at_least: tuple[tuple[str, int], ...]
    below: tuple[tuple[str, int], ...]

    def holds(self, standing: Standing) -> bool:
        """Whether all conditions hold."""
        lamps, counters, modes = standing
        return (
            all(lamps.get(lamp, OFF) == OFF for lamp in self.unlit)
            and all(lamps.get(lamp, OFF) != OFF for lamp in self.lit)
            and all(lamps.get(lamp, OFF) == BLINKING for lamp in self.blinking)
            and all(mode in modes for mode in self.running)
            and all(mode not in modes for mode in self.stopped)
            and all(counters.get(name, value) >= value for name, value in self.at_least)
            and all(counters.get(name, 0) < value for name, value in self.below)
        )

    def shot(self, standing: Standing) -> Shot:
        """Return the shot, with the points that it would award now."""
        points = self.award * math.prod(standing.counters.get(name, 1) + add for name, add in self.times)
        is_blinking = any(standing.lamps.get(lamp) == BLINKING for lamp in (*self.blinking, *self.lit))
        what = _joined(self.phrases, points, self.otherwise)
        return Shot(self.where, what, is_blinking, self.is_mission, points)


class RuleWords:
    """The words of one table's rules.

    Args:
        table: A finished table.

    Attributes:
        groups: The lamps of each group, in the order of the file.
        missions: The modes with a time that rules start, and their seconds.
        offers: What pays beyond ordinary hits, and when.
    """

    def __init__(self, table: Table) -> None:
        self.groups: dict[str, tuple[str, ...]] = {}
        for lamp in table.lamp:
            if lamp.group:
                self.groups[lamp.group] = (*self.groups.get(lamp.group, ()), lamp.name)
        self.missions = {mode.name: mode.seconds for mode in table.mode if mode.seconds and mode.is_shown}
        self.modes = tuple(mode.name for mode in table.mode if mode.is_shown)
        self._timers = frozenset(mode.name for mode in table.mode if not mode.is_shown)
        self._rules = table.rule
        self._shots = [rule for rule in table.rule if self._where(rule) and _is_conditional(rule)]
        self.offers = tuple(map(self._offer, self._shots))

    def shots(self, standing: Standing) -> list[Shot]:
        """Return what pays now beyond ordinary hits, what belongs to a mode first, then what blinks."""
        found: dict[tuple[str, str], Shot] = {}
        for offer in self.offers:
            if offer.holds(standing):
                shot = offer.shot(standing)
                found.setdefault((shot.where, shot.what), shot)
        return sorted(
            found.values(), key=lambda shot: (not shot.is_mission, not shot.is_blinking, -shot.points)
        )

    def goals(self) -> list[str]:
        """Return the missions in words: what begins them, and what wins each that a single shot wins."""
        alike: dict[str, list[str]] = {}
        wins = []
        for mode, seconds in self.missions.items():
            begins = [self._where(rule) for rule in self._rules if mode in rule.start and self._where(rule)]
            won = [rule for rule in self._rules if self._wins(rule, mode)]
            if begins or won:
                how = f"{begins[0]}, then {seconds:g} s" if begins else f"{seconds:g} s"
                alike.setdefault(how, []).append(plain(mode))
            if won:
                wins.append(f"in {plain(mode)} {self._where(won[0])} brings {won[0].award:,}")
        return [f"{' · '.join(modes)}: {how}" for how, modes in alike.items()] + wins

    def _wins(self, rule: Rule, mode: str) -> bool:
        return mode in rule.if_running and bool(rule.award) and bool(self._where(rule))

    def lit_shots(self) -> list[str]:
        """Return what lamps promise: the shots that pay while lit, together if they pay alike."""
        alike: dict[str, list[str]] = {}
        for rule in self._shots:
            told = self.missions.keys() & {*rule.if_running, *rule.start}
            what = _joined(self._phrases(rule, ""), rule.award, _lights(rule) or plain(rule.message))
            if (rule.if_lit or rule.if_blinking) and what and not told:
                alike.setdefault(what, []).append(self._where(rule))
        return [f"{', '.join(dict.fromkeys(shots))}: {what}" for what, shots in alike.items()]

    def multiballs(self) -> list[str]:
        """Return what starts several balls."""
        lines = [
            f"{trigger}: {rule.multiball} balls"
            for rule in self._rules
            if rule.multiball > 1 and (trigger := self._where(rule) or _names(rule.on_count))
        ]
        return list(dict.fromkeys(lines))

    def _where(self, rule: Rule) -> str:
        """Return what sets off a rule, in words; empty if it is nothing to shoot.

        A timer that hits start stands for a shot of several switches, such as round an orbit.
        """
        if rule.on_hit == (ANY_PART,):
            return "everything"
        timers = [name.removesuffix(SHOT) for name in rule.on_start if name in self._timers]
        return _names((*rule.on_hit, *rule.on_down, *timers))

    def _lamps(self, names: Iterable[str]) -> tuple[str, ...]:
        """Return the lamps that names mean: themselves, or all of a group."""
        return tuple(lamp for name in names for lamp in self.groups.get(name, (name,)))

    def _offer(self, rule: Rule) -> Offer:
        """Return what a rule offers, in words, and when it does."""
        is_mission = any(mode in self.missions for mode in rule.if_running)
        names = (*rule.if_blinking, *rule.if_lit)
        where, title = self._where(rule), plain(names[0]) if names else ""
        if title.startswith(where):  # the arrow of the shot itself
            title = ""
        if not title and is_mission and not rule.award:
            title = plain(rule.message)
        return Offer(
            where=where,
            phrases=self._phrases(rule, title),
            otherwise=_lights(rule) or plain(rule.message or rule.name or rule.cue),
            is_mission=is_mission,
            award=rule.award,
            times=tuple((name, rule.add.get(name, 0)) for name in rule.times),
            unlit=self._lamps(rule.if_unlit),
            lit=self._lamps(rule.if_lit),
            blinking=self._lamps(rule.if_blinking),
            running=rule.if_running,
            stopped=rule.if_stopped,
            at_least=tuple(rule.if_at_least.items()),
            below=tuple(rule.if_below.items()),
        )

    def _phrases(self, rule: Rule, title: str) -> tuple[str, ...]:
        """Return a title and what a rule brings beside points."""
        phrases = [title] if title else []
        phrases += [plain(mode) for mode in rule.start if mode in self.modes]
        if rule.lock:
            phrases.append("locks the ball")
        if rule.multiball > 1:
            phrases.append(f"{rule.multiball} balls")
        if rule.extra_ball:
            phrases.append("extra ball")
        if rule.kick is not None:
            phrases.append("kickback")
        return tuple(dict.fromkeys(phrases))


def _lights(rule: Rule) -> str:
    """Return what a rule lights; empty if it is nothing."""
    lights = (*rule.light, *rule.blink)
    return f"lights {_names(lights)}" if lights else ""


def _joined(phrases: tuple[str, ...], points: int, otherwise: str) -> str:
    """Return phrases and points as one line, or something else if there are neither."""
    return " · ".join((*phrases, f"{points:,}") if points else phrases) or otherwise


def _is_conditional(rule: Rule) -> bool:
    """Whether a rule waits for a lamp or a mode, and brings something."""
    brings = (
        rule.award or rule.start or rule.lock or rule.multiball or rule.extra_ball or rule.kick
        or rule.light or rule.blink or rule.message
    )  # fmt: skip
    return bool(brings) and bool(rule.if_lit or rule.if_blinking or rule.if_running)


def _names(names: Sequence[str] | Mapping[str, int]) -> str:
    named = [plain(name) for name in names]
    if len(named) > MOST_NAMED:
        return ", ".join(named[:MOST_NAMED]) + ", …"
    return " or ".join([", ".join(named[:-1]), named[-1]]) if len(named) > 1 else "".join(named)
