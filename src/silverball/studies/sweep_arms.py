"""Arms of a sweep: every table with every combination of the swept values."""

from __future__ import annotations

from itertools import product
from math import prod

from silverball.errors import SilverballError
from silverball.studies.study_plan import Arm
from silverball.studies.table_change import Sweep, changed

MOST_ARMS = 100


def swept(arms: tuple[Arm, ...], sweeps: list[Sweep]) -> tuple[Arm, ...]:
    """Every arm with every combination of values, those of the last sweep changing fastest.

    Args:
        arms: Arms without changes.
        sweeps: What is swept; none: the arms themselves.

    Raises:
        SilverballError: A path does not exist, a table with these values cannot be played, or there are too
            many combinations.
    """
    count = len(arms) * prod(len(one.values) for one in sweeps)
    if count > MOST_ARMS:
        raise SilverballError(
            f"a study compares at most {MOST_ARMS} combinations of tables, players and values, "
            f"got {count:,}: sweep fewer values"
        )
    if not sweeps:
        return arms
    found = []
    for arm in arms:
        for values in product(*(one.values for one in sweeps)):
            table, change = arm.table, tuple(zip((one.path for one in sweeps), values, strict=True))
            for path, value in change:
                table = changed(table, path, value)
            words = ", ".join(f"{path}={value:g}" for path, value in change)
            label = words if len(arms) == 1 else f"{arm.label}, {words}"
            found.append(Arm(label, table, arm.player, change))
    return tuple(found)
