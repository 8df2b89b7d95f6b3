"""Random tables made of all kinds of parts, as a maker of tables might build them.

Each has the guides and the two paddles of a common table, a ramp or none, and dozens of parts anywhere. What
`check_table` calls an error is taken out again, so that the result is valid; warnings may stay: parts touch,
overlap and leave slits.
"""

from __future__ import annotations

import math
import random
from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from silverball.table import Board, Paddle, SlantWall, Table, TriangularPrism, check_table
from silverball.table.kinds import (
    Cylinder,
    DropTarget,
    Gate,
    Hole,
    Level,
    Passage,
    Plunger,
    Post,
    Rollover,
    Slingshot,
    Spinner,
    Target,
    Wall,
)
from silverball.table.kinds.gate import DIRECTIONS
from silverball.table.kinds.part import Part
from silverball.table.model import list_sections
from silverball.table.primitive import Point

MIN_PARTS, MAX_PARTS = 6, 30  # beside the guides and the paddles
MAX_PADDLES = 8
TIP_SHARE = 0.7  # of the speed cap: the greatest speed of a paddle's tip
CHECKS = 8  # of a table, each after taking out what the last one found
SECTION = {model: name for name, model in list_sections(Table).items()}


class Yard(NamedTuple):
    """Where parts are made: the random generator, the board and the levels there are."""

    pick: random.Random
    board: Board
    levels: int

    def place(self) -> Point:
        """A random place on the board above the paddles (x, z) [u]."""
        half = 0.5 * self.board.width
        return self.pick.uniform(-4.0, 0.5 * self.board.length), self.pick.uniform(-half, half)

    def line(self, least: float, most: float, start: Point | None = None) -> tuple[Point, Point]:
        """A line of a random direction, with a length between two bounds [u]."""
        start = self.place() if start is None else start
        turn, long = self.pick.uniform(0.0, 2.0 * math.pi), self.pick.uniform(least, most)
        return start, (start[0] + long * math.sin(turn), start[1] + long * math.cos(turn))

    def velocity(self, least: float, most: float) -> Point:
        """A velocity of a random direction, with a size between two bounds [u/s]."""
        turn, speed = self.pick.uniform(0.0, 2.0 * math.pi), self.pick.uniform(least, most)
        return speed * math.sin(turn), speed * math.cos(turn)

    def level(self) -> dict[str, Any]:
        """The level of a part: mostly the playfield, sometimes another one, or several."""
        if self.levels == 1 or self.pick.random() < 0.7:
            return {}
        if self.pick.random() < 0.3:
            return {"levels": tuple(range(self.levels))}
        return {"level": self.pick.randrange(1, self.levels)}

    def surface(self) -> dict[str, Any]:
        """How a solid part bounces."""
        pick = self.pick
        return {
            "restitution": pick.choice((0.0, 0.3, 0.7, 1.0)),
            "restitution_falloff": pick.choice((0.0, 0.0, 0.02)),
            "speed_factor": pick.choice((1.0, 1.0, 0.8, 1.2)),
            **pick.choice(({}, {}, {"friction": 0.0}, {"friction": 0.3})),
            **pick.choice(({}, {}, {"hit_speed": 1.0}, {"hit_speed": 3.0})),
            **self.level(),
        }

    def kick(self) -> float:
        """The speed of a kick [u/s], often none."""
        return self.pick.choice((0.0, 0.0, 4.0, 12.0, self.board.speed_cap))


def fast_paddle(yard: Yard, cap_share: float = TIP_SHARE, **given: Any) -> Paddle:
    """A paddle with a random shape and the keys given, whose tip keeps below a share of the speed cap."""
    pick = yard.pick
    values: dict[str, Any] = {
        "side": pick.choice(("left", "right")),
        "length": pick.uniform(0.8, 1.9),
        "button": pick.choice((None, "left", "right")),
        "profile": pick.choice(("constant", "coil")),
        "mass": pick.choice((None, 0.3, 1.0, 20.0)),
        "restitution": pick.choice((0.0, 0.5, 1.0)),
        "rest_angle": pick.uniform(-60.0, 40.0),
    }
    if pick.random() < 0.6:
        base = pick.uniform(0.1, 0.3)
        values |= {"shape": "capsule", "base_radius": base, "tip_radius": base * pick.uniform(0.4, 1.0)}
    else:
        values["base"] = pick.uniform(0.2, 0.6)
    values |= given
    values.setdefault("up_angle", values["rest_angle"] + pick.uniform(25.0, 75.0))
    slow = Paddle(**{**values, "stroke": 1.0, "return_stroke": 1.0})
    least = max(0.011, slow.tip_speed / (cap_share * yard.board.speed_cap))
    strokes = {name: min(1.0, least * pick.uniform(1.0, 2.0)) for name in ("stroke", "return_stroke")}
    return Paddle(**(values | strokes))


def _wall(yard: Yard) -> list[Part]:
    """A wall of some edges and arcs, open or closed."""
    pick = yard.pick
    points: list[Point] = [yard.place()]
    for _ in range(pick.randint(1, 5)):
        points.append(yard.line(0.4, 2.5, points[-1])[1])
    closed = len(points) > 2 and pick.random() < 0.4
    last = len(points) if closed else len(points) - 1
    chain = tuple(
        (x, z, pick.uniform(0.1, 1.2) * pick.choice((-1.0, 1.0)))
        if pick.random() < 0.4 and n < last
        else (x, z)
        for n, (x, z) in enumerate(points)
    )
    return [
        Wall(
            points=chain,
            closed=closed,
            thickness=pick.choice((0.0, 0.05, 0.2)),
            kick=yard.kick(),
            kick_profile=pick.choice(("flat", "parabola")),
            **yard.surface(),
        )
    ]


def _slant_wall(yard: Yard) -> list[Part]:
    start, end = yard.line(0.5, 3.0)
    return [SlantWall(start=start, end=end, kick=yard.kick(), **yard.surface())]


def _obstacle(yard: Yard) -> list[Part]:
    """A prism, a cylinder or a post."""
    pick, center = yard.pick, yard.place()
    kind = pick.randrange(3)
    if kind == 0:
        turn = pick.uniform(0.0, 120.0)
        size = pick.uniform(0.3, 1.0)
        return [TriangularPrism(center=center, size=size, rotation=turn, kick=yard.kick(), **yard.surface())]
    if kind == 1:
        radius = pick.uniform(0.2, 0.7)
        return [Cylinder(center=center, radius=radius, kick=yard.kick(), **yard.surface())]
    return [Post(center=center, radius=pick.uniform(0.02, 0.2), **yard.surface())]


def _slingshot(yard: Yard) -> list[Part]:
    start, end = yard.line(0.6, 2.2)
    kick = yard.pick.uniform(2.0, 20.0)
    return [Slingshot(start=start, end=end, kick=kick, **yard.surface())]


def _targets(yard: Yard) -> list[Part]:
    """A target, or a bank of one to four drop targets in a row."""
    pick = yard.pick
    start, end = yard.line(0.3, 0.9)
    if pick.random() < 0.3:
        return [Target(start=start, end=end, **yard.surface())]
    dx, dz, bank = end[0] - start[0], end[1] - start[1], f"bank {pick.randrange(3)}"
    surface = yard.surface()
    return [
        DropTarget(
            start=(start[0] + n * dx, start[1] + n * dz),
            end=(end[0] + n * dx, end[1] + n * dz),
            thickness=pick.choice((0.0, 0.05)),
            bank=bank,
            reset_after=pick.choice((0.05, 0.5, 2.0)),
            **surface,
        )
        for n in range(pick.randint(1, 4))
    ]


def _rollover(yard: Yard) -> list[Part]:
    if yard.pick.random() < 0.5:
        return [Rollover(center=yard.place(), radius=yard.pick.uniform(0.05, 1.0), **yard.level())]
    start, end = yard.line(0.3, 3.0)
    return [Rollover(start=start, end=end, **yard.level())]


def _gate(yard: Yard) -> list[Part]:
    """A one-way gate, or one that opens and closes."""
    pick = yard.pick
    start, end = yard.line(0.5, 2.0)
    if pick.random() < 0.3:
        name = f"gate {pick.randrange(10**9)}"
        return [Gate(start=start, end=end, held=True, name=name, **yard.surface())]
    across = abs(end[1] - start[1]) > abs(end[0] - start[0])
    passes = pick.choice([name for name, (x, _) in DIRECTIONS.items() if (x != 0.0) == across])
    return [Gate(start=start, end=end, passes=passes, **yard.surface())]  # type: ignore[arg-type]


def _spinner(yard: Yard) -> list[Part]:
    start, end = yard.line(0.6, 2.0)
    pick = yard.pick
    damping, drag = pick.choice((0.2, 2.0, 20.0)), pick.choice((0.0, 0.5, 5.0))
    return [Spinner(start=start, end=end, damping=damping, drag=drag, **yard.level())]


def _hole(yard: Yard) -> list[Part]:
    """A saucer, a subway or a drain."""
    pick = yard.pick
    common: dict[str, Any] = {
        "center": yard.place(),
        "radius": pick.uniform(0.05, 0.6),
        "capture_speed": pick.choice((3.0, 17.0, 100.0)),
    } | {key: value for key, value in yard.level().items() if key == "level"}
    if pick.random() < 0.15:
        return [Hole(drain=True, **common)]
    return [
        Hole(
            exit=pick.choice((None, yard.place())),
            exit_velocity=yard.velocity(1.0, yard.board.speed_cap),
            exit_level=pick.choice((None, pick.randrange(yard.levels))),
            hold=pick.choice((0.0, 0.01, 0.5, 2.0)),
            spread=pick.choice((0.0, 5.0, 90.0)),
            **common,
        )
    ]


def _passage(yard: Yard) -> list[Part]:
    start, end = yard.line(0.5, 3.0)
    if yard.levels == 1:
        return [Rollover(start=start, end=end)]
    here, there = yard.pick.sample(range(yard.levels), 2)
    return [Passage.model_validate({"start": start, "end": end, "from": here, "to": there})]


def _paddle(yard: Yard) -> list[Part]:
    x, z = yard.place()
    return [fast_paddle(yard, pivot=(x, 0.85 * z))]


MAKERS: tuple[Callable[[Yard], list[Part]], ...] = (
    _wall,
    _wall,
    _slant_wall,
    _obstacle,
    _obstacle,
    _slingshot,
    _targets,
    _rollover,
    _gate,
    _spinner,
    _hole,
    _passage,
    _paddle,
)


def table_of_parts(name: str, board: Board, levels: Iterable[Level], parts: Iterable[Part]) -> Table:
    """A table of format 2 with these parts, the paddles among them up to as many as there may be."""
    lists: dict[str, list[Part]] = defaultdict(list)
    for part in parts:
        lists[SECTION[type(part)]].append(part)
    lists["paddle"] = lists["paddle"][:MAX_PADDLES]
    return Table(
        format=2,
        name=name,
        board=board,
        level=tuple(levels),
        **{section: tuple(listed) for section, listed in lists.items()},  # type: ignore[arg-type]
    )


def some_levels(pick: random.Random) -> list[Level]:
    """No level beside the playfield, or one or two with a gravity of their own."""
    gravities = (None, (-12.0, 0.0), (-3.0, 4.0), (6.0, -2.0))
    return [Level(number=n + 1, gravity=pick.choice(gravities)) for n in range(pick.choice((0, 1, 1, 2)))]


NUDGE = 5.0  # [u/s] of the boards with a nudge


def part_table(seed: int) -> Table:
    """A valid random table of all kinds of parts; the same seed always gives the same one."""
    pick = random.Random(seed)
    rubbing = pick.random() < 0.3
    board = Board(
        max_balls=pick.choice((1, 2, 3, 5, 8)),
        speed_cap=pick.choice((25.0, 40.0)),
        gravity=pick.choice((5.0, 10.0, 10.0, 15.0)),
        wall_restitution=pick.uniform(0.2, 0.9),
        friction=0.2 if rubbing else 0.0,
        rolling=rubbing and pick.random() < 0.7,
        jitter=pick.uniform(0.0, 3.0),
        nudge=NUDGE if seed % 4 == 3 else 0.0,
    )
    levels = some_levels(pick)
    yard = Yard(pick, board, 1 + len(levels))
    fixed = _lower_end(yard)
    parts = [part for _ in range(pick.randint(MIN_PARTS, MAX_PARTS)) for part in pick.choice(MAKERS)(yard)]
    return _without_errors(f"Parts {seed}", board, levels, fixed + parts, len(fixed))


def _lower_end(yard: Yard) -> list[Part]:
    """Two paddles, their guides, and a plunger in a lane or none."""
    pick = yard.pick
    right = 4.1 if (has_plunger := pick.random() < 0.5) else 4.9
    rest = pick.uniform(-30.0, -5.0)
    common = {"rest_angle": rest, "up_angle": rest + pick.uniform(40.0, 60.0), "length": 1.6}
    parts: list[Part] = [
        SlantWall(start=(-4.5, -4.9), end=(-6.87, -3.1)),
        SlantWall(start=(-4.5, right), end=(-6.87, right - 1.8)),
        fast_paddle(yard, side="left", pivot=(-7.3, -2.9), **common),
        fast_paddle(yard, side="right", pivot=(-7.3, right - 2.0), **common),
    ]
    if has_plunger:
        launch = (pick.uniform(4.0, 12.0), pick.uniform(15.0, 25.0))
        parts += [
            Wall(points=((-10.0, 4.2), (6.0, 4.2))),
            Plunger(position=(-8.0, 4.575), launch=launch, charge=pick.choice((0.05, 1.0))),
            Gate(start=(6.0, 4.2), end=(6.8, 4.85), passes="up"),
            Wall(points=((7.0, 4.9, 0.41421356), (9.9, 2.0))),
        ]
    return parts


def _without_errors(name: str, board: Board, levels: list[Level], parts: list[Part], fixed: int) -> Table:
    """The table without the parts that the check calls wrong; the first `fixed` ones stay."""
    for _ in range(CHECKS):
        table = table_of_parts(name, board, levels, parts)
        wrong = {problem.path for problem in check_table(table) if problem.severity == "error"}
        if not wrong:
            return table
        places: dict[str, Part] = {}
        for section, listed in _lists(table).items():
            places |= {f"{section}[{number}]": part for number, part in enumerate(listed)}
        bad = {id(part) for place, part in places.items() if any(_is_at(path, place) for path in wrong)}
        kept = [part for part in parts[fixed:] if id(part) not in bad]
        if len(kept) == len(parts) - fixed:  # the errors are of no part, as "no way out"
            kept = kept[: len(kept) // 2]
        parts = parts[:fixed] + kept
    return table_of_parts(name, board, levels, parts[:4])


def _lists(table: Table) -> dict[str, tuple[Part, ...]]:
    return {section: getattr(table, section) for section in SECTION.values() if section != "level"}


def _is_at(path: str, place: str) -> bool:
    return path == place or path.startswith(f"{place}.")
