"""Small soaks, and solvers that are broken on purpose: what a soak must find, it has to be shown.

Compile-time data of the solver alone are spoilt; the watch has its own.
"""

from __future__ import annotations

from silverball.soak.rounds import Options
from silverball.table import load_table
from silverball.world import WorldBatch


def options_of(hostile: bool = False, worlds: int = 4, seed: int = 3, tick_rate: int = 60) -> Options:
    """A soak of random boards, or of hostile ones."""
    return Options(load_table("random"), seed, worlds, tick_rate, hostile)


def hide_from_the_solver(batch: WorldBatch, part: int) -> None:
    """Move a collider to where no ball ever comes."""
    row = batch.boards.collider[part]
    shape = row["button"] == 0  # a paddle's corners are counted from its pivot
    for name in ("x", "x0", "x1", "x2") if shape else ("x",):
        row[name] += 1000.0


class Holed(WorldBatch):
    """Worlds whose solver knows nothing of the first cylinder of each board."""

    def __init__(self, *arguments, **options) -> None:
        super().__init__(*arguments, **options)
        for number, names in enumerate(self.boards.names):
            first = self.boards.board["collider_first"][number]
            hide_from_the_solver(self, first + names.index("cylinder[0]"))


class Narrow(WorldBatch):
    """Worlds whose solver takes the board for narrower than it is, and stops where that is not true."""

    def __init__(self, *arguments, **options) -> None:
        super().__init__(*arguments, **options)
        self.boards.board["half_width"] = 3.0
