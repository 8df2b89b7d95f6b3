"""`silverball tables`: lists the built-in tables."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from silverball.cli.console import print_lines

if TYPE_CHECKING:
    from silverball.table import Table

FRAME = ("paddle", "slant_wall", "wall", "passage")  # what every table has, or what only leads balls


def tables() -> None:
    """List the built-in tables.

    Example: `silverball tables`
    """
    from silverball.table import load_table, table_names

    for name in table_names():
        table = load_table(name)
        if table.random is not None:
            recipe = table.random
            counts = {"triangular_prism": recipe.triangular_prisms, "cylinder": recipe.cylinders}
            print_lines(f"{name:10} {_listed(counts)}, placed at random for every seed")
        else:
            print_lines(f"{name:10} {_listed(_obstacles(table))}")


def _obstacles(table: Table) -> Counter[str]:
    """The number of parts of each kind that a ball is meant to meet."""
    kinds = (path.partition("[")[0] for path, _, _ in table.parts())
    return Counter(kind for kind in kinds if kind not in FRAME)


def _listed(counts: dict[str, int]) -> str:
    return ", ".join(
        f"{count} {kind.replace('_', ' ')}{'' if count == 1 else 's'}" for kind, count in counts.items()
    )
