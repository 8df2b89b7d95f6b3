"""`silverball tables`: lists the built-in tables."""

from __future__ import annotations

from silverball.cli.console import print_lines


def tables() -> None:
    """List the built-in tables.

    Example: `silverball tables`
    """
    from silverball.table import load_table, table_names

    for name in table_names():
        table = load_table(name)
        obstacles = f"{len(table.triangular_prism)} triangular prisms, {len(table.cylinder)} cylinders"
        if table.random is not None:
            recipe = table.random
            counts = f"{recipe.triangular_prisms} triangular prisms, {recipe.cylinders} cylinders"
            obstacles = f"{counts}, placed at random for every seed"
        print_lines(f"{name:10} {obstacles}")
