"""What the score display of a page must know of a table's rules: what they say, and how important it is."""

from __future__ import annotations

from typing import Any

from silverball.app.announcements import TableWords
from silverball.game.tally import part_labels
from silverball.plain import plain
from silverball.table import Table


def display_words(table: Table, numbers: dict[str, int]) -> dict[str, Any]:
    """What `page/announcements.js` and `page/tally.js` read of a table's rules.

    Args:
        table: A finished table.
        numbers: The numbers of its parts by their names in events.
    """
    words, labels = TableWords.of(table), part_labels(table)
    names = sorted(numbers, key=numbers.__getitem__)
    return {
        "messages": {text: int(rank) for text, rank in words.messages.items()},
        "cues": {text: int(rank) for text, rank in words.cues.items()},
        "announced": sorted(words.announced),
        "shown": shown_texts(table),
        "labels": [labels.get(name, "") for name in names],
        "unshown": [mode.name for mode in table.mode if not mode.is_shown],
    }


def shown_texts(table: Table) -> dict[str, str]:
    """Messages, cues and modes as the display writes them."""
    texts = {mode.name for mode in table.mode}
    texts |= {text for rule in table.rule for text in (rule.message, rule.cue) if text}
    return {text: plain(text).upper() for text in sorted(texts)}
