"""Invariances on boards of all kinds of parts: the mirror, and cutting a run into ticks.

As in `test_symmetries.py`, flights on which rounding alone decides are left out.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

from hypothesis import assume, given, settings, strategies as st

from boards import launched, mirrored, moment, place
from scenes import create
from silverball.physics.records import Part
from silverball.soak.hostile_parts import hostile_part_table
from silverball.soak.part_boards import part_table
from silverball.table import Table, expand
from silverball.world import World

SEEN = ("hit", "touch", "pass", "captured", "released", "spin", "reset", "gutter")
COUNT = 8
SAME = 1e-9
BESIDE = 1e-13  # [u] how far beside the first flight the second one starts
MIRRORED = {int(Part.LEFT_WALL): int(Part.RIGHT_WALL), int(Part.RIGHT_WALL): int(Part.LEFT_WALL)}

starts = st.tuples(
    st.floats(-4.5, 9.0), st.floats(-4.5, 4.5), st.floats(0, 2 * math.pi), st.floats(2, 16)
).map(lambda s: (s[0], s[1], s[3] * math.sin(s[2]), s[3] * math.cos(s[2])))
presses = st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=12)


@cache
def board(seed: int, hostile: bool = False) -> Table:
    """A board of all parts on which nothing is left to chance: random numbers are not mirrored."""
    table = hostile_part_table(seed) if hostile else part_table(seed)
    holes = tuple(hole.model_copy(update={"spread": 0.0}) for hole in table.hole)
    return table.model_copy(update={"hole": holes})


def seen_on(world: World, pressed: list[tuple[bool, bool]], seconds: float = 2.5) -> list[Any]:
    """The first events: time, place, kind, number of the part, ball. A button stays for 0.1 s."""
    numbers, seen = expand(world.table).numbers, []
    for tick in range(round(seconds * world.tick_rate)):
        left, right = pressed[tick * 10 // world.tick_rate % len(pressed)]
        world.step(left=left, right=right)
        assert world.fault is None
        for event in world.events:
            if event.kind in SEEN:
                where = place(event) if event.ball else (0.0, 0.0)
                number = numbers.get(event.part or "", -1)
                seen.append((moment(world, event), *where, event.kind, number, event.ball))
        if len(seen) >= COUNT:
            break
    return seen[:COUNT]


def difference(one: list[Any], other: list[Any]) -> float:
    """The largest difference of two lists of events; infinite if they are of different parts or kinds."""
    if [row[3:] for row in one] != [row[3:] for row in other]:
        return math.inf
    return max(
        (abs(x - y) for a, b in zip(one, other, strict=True) for x, y in zip(a[:3], b[:3], strict=True)),
        default=0.0,
    )


def is_tame(table: Table, start: Any, seen: list[Any], pressed: list[tuple[bool, bool]]) -> bool:
    """Whether a flight that starts a little beside meets the same, a little beside."""
    x, z, vx, vz = start
    beside = seen_on(launched(table, (x + BESIDE, z - BESIDE, vx, vz)), pressed)
    return difference(seen, beside) < 1000 * BESIDE


def in_the_mirror(number: int, one: Table, other: Table) -> int:
    """The number of the mirror image of a part: paddles of the two sides may have changed places."""
    path = expand(one).parts[number].path if number >= 0 else ""
    if path.startswith("paddle"):
        return [part.path for part in expand(other).parts].index(path)
    return MIRRORED.get(number, number)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 60), starts, presses)
def test_the_mirrored_board_with_swapped_buttons_gives_the_mirrored_path(seed, start, pressed) -> None:
    table = board(seed)
    assume(World(table).clearance(*start[:2]) > 1e-3)
    seen = seen_on(launched(table, start), pressed)
    assume(seen and is_tame(table, start, seen, pressed))
    x, z, vx, vz = start
    mirror = mirrored(table)
    image = seen_on(launched(mirror, (x, -z, vx, -vz)), [(right, left) for left, right in pressed])
    back = [
        (time, at_x, -at_z, kind, in_the_mirror(number, mirror, table), ball)
        for time, at_x, at_z, kind, number, ball in image
    ]
    assert difference(seen, back) <= SAME


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 60), st.booleans(), st.integers(0, 99))
def test_many_ticks_in_one_call_give_the_bits_of_single_ones(seed, hostile, world_seed) -> None:
    table = board(seed, hostile)
    leaping, stepping = (World(table, seed=world_seed, tick_rate=240) for _ in range(2))
    for beat in range(40):
        held = {"left": beat % 3 == 0, "right": beat % 4 == 0, "launch": beat % 5 < 3}
        is_shoved = beat % 11 == 10  # once a call
        for world in (leaping, stepping):
            create(world)
        leaping.step(ticks=24, jitter=is_shoved, **held)
        for tick in range(24):
            stepping.step(jitter=is_shoved and tick == 0, **held)
        assert leaping.digest() == stepping.digest()
