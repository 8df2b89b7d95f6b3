"""The rules by which a table is played: its own, or the standard ones of `rulebook/standard.toml`."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib import resources

from silverball.table.table import Table


@cache
def standard_rules() -> Table:
    """Return a table that has nothing but the standard rules.

    Examples:
        >>> from silverball.table.standard_rules import standard_rules
        >>> standard_rules().rule[0].times
        ('combo_factor', 'ball_factor')
    """
    entry = resources.files("silverball.table") / "rulebook" / "standard.toml"
    return Table.model_validate(tomllib.loads(entry.read_text(encoding="utf-8")))


def rules_of(table: Table) -> Table:
    """Return the table whose lamps, counters, modes and rules a game on this one has."""
    return table if table.rule else standard_rules()
