"""What the card beside the table of a page must know: what pays and when, and how to score at all."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from silverball.app.rule_words import Offer, RuleWords
from silverball.app.scoring import how_to_score
from silverball.game.view import Mode
from silverball.plain import plain
from silverball.table import Table


def card_words(table: Table, modes: Sequence[Mode]) -> dict[str, Any]:
    """What `page/card.js` reads; lamps, counters and modes by their numbers.

    Args:
        table: A finished table.
        modes: The modes that can be played.
    """
    words = RuleWords(table)
    numbers = {
        "lamp": _numbers(lamp.name for lamp in table.lamp),
        "counter": _numbers(counter.name for counter in table.counter),
        "mode": _numbers(mode.name for mode in table.mode),
    }
    return {
        "offers": [_offer(offer, numbers) for offer in words.offers],
        "modes": [plain(mode.name) if mode.name in words.modes else "" for mode in table.mode],
        "counters": [[plain(counter.name), counter.begins] for counter in table.counter],
        "rules": {str(mode): [list(rule) for rule in how_to_score(table, mode)] for mode in modes},
    }


def _numbers(names: Iterable[str]) -> dict[str, int]:
    return {name: number for number, name in enumerate(names)}


def _offer(offer: Offer, numbers: dict[str, dict[str, int]]) -> dict[str, Any]:
    """An offer, without what it leaves empty, and without counters that every game has, such as `in_play`."""
    lamps, counters, modes = numbers["lamp"], numbers["counter"], numbers["mode"]
    row = {
        "where": offer.where, "phrases": offer.phrases, "otherwise": offer.otherwise, "award": offer.award,
        "isMission": offer.is_mission,
        "times": [[counters[name], add] for name, add in offer.times if name in counters],
        "unlit": [lamps[name] for name in offer.unlit],
        "lit": [lamps[name] for name in offer.lit],
        "blinking": [lamps[name] for name in offer.blinking],
        "running": [modes[name] for name in offer.running],
        "stopped": [modes[name] for name in offer.stopped],
        "atLeast": [[counters[name], value] for name, value in offer.at_least if name in counters],
        "below": [[counters[name], value] for name, value in offer.below if name in counters],
    }  # fmt: skip
    return {name: value for name, value in row.items() if value}
