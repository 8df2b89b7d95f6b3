"""The rules card: what is lit, which modes run, how far groups and counters are; or how to score at all."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from silverball.app.rule_words import OFF, RuleWords, Shot, Standing
from silverball.plain import plain

if TYPE_CHECKING:
    from silverball.app.scoring import Rule
    from silverball.table import Table

MAX_COUNTERS = 4
BAR_STEPS = 60  # positions of the bar of a mode's time


class ModeLine(NamedTuple):
    """A mode that runs.

    Attributes:
        name: Its name.
        seconds: Whole seconds left; None: without an end.
        bar: How much of its time is left, in `BAR_STEPS`.
    """

    name: str
    seconds: int | None
    bar: int


class GroupLine(NamedTuple):
    """A group of lamps: its name, and each lamp's name and state."""

    name: str
    lamps: tuple[tuple[str, str], ...]


class Card(NamedTuple):
    """The rules card as data: equal cards look alike.

    Attributes:
        modes: The modes that run.
        shots: What pays now.
        groups: Groups with a lit lamp.
        counters: Counters that have changed, and their values.
        rules: How to score, shown where nothing is lit.
        is_dim: Whether no ball is in play.
    """

    modes: tuple[ModeLine, ...] = ()
    shots: tuple[Shot, ...] = ()
    groups: tuple[GroupLine, ...] = ()
    counters: tuple[tuple[str, int], ...] = ()
    rules: tuple[Rule, ...] = ()

    @property
    def blinks(self) -> bool:
        """Whether something on it blinks."""
        return any(shot.is_blinking or shot.is_mission for shot in self.shots)


def short_labels(names: Sequence[str]) -> list[str]:
    """Return names without the last word that all of them have, as in "left arrow", "right arrow"."""
    last = {name.rpartition(" ")[2] for name in names}
    if len(last) == 1 and all(" " in name for name in names):
        return [plain(name.rpartition(" ")[0]) for name in names]
    return [plain(name) for name in names]


class CardReader:
    """Reads the card of a table in play.

    Args:
        table: A finished table.
    """

    def __init__(self, table: Table) -> None:
        self._words = RuleWords(table)
        self._begins = {counter.name: counter.begins for counter in table.counter}

    def card(self, standing: Standing, rules: Sequence[Rule]) -> Card:
        """Return the card of a game that stands like this; `rules` say how to score."""
        words = self._words
        modes = tuple(
            self._mode_line(name, left) for name, left in standing.modes.items() if name in words.modes
        )
        groups = tuple(
            GroupLine(
                plain(name),
                tuple(
                    (label, standing.lamps.get(lamp, OFF))
                    for lamp, label in zip(lamps, short_labels(lamps), strict=True)
                ),
            )
            for name, lamps in words.groups.items()
            if len(lamps) > 1 and any(standing.lamps.get(lamp, OFF) != OFF for lamp in lamps)
        )
        changed = [
            (plain(name), value)
            for name, value in standing.counters.items()
            if value != self._begins.get(name, value)
        ]
        shots = tuple(words.shots(standing))
        return Card(modes, shots, groups, tuple(changed[:MAX_COUNTERS]), () if shots else tuple(rules))

    def _mode_line(self, name: str, left: float | None) -> ModeLine:
        if left is None:
            return ModeLine(plain(name), None, BAR_STEPS)
        most = max(self._words.missions.get(name, left), left, 1e-3)
        return ModeLine(plain(name), int(left) + 1, round(BAR_STEPS * left / most))
