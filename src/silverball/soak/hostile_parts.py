"""Hostile boards of all kinds of parts: tables on which the devices get into each other's way.

Walls cross themselves, arcs lie inside arcs, gates stand in walls and against each other, holes lie at walls
and send balls into each other, targets come back under balls, passages lead through parts, paddles turn
about one pivot. `check_table` refuses nearly all of them. On none may a ball get inside anything.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from silverball.soak.hostile import HAIR, hostile_board
from silverball.soak.part_boards import MAKERS, Yard, fast_paddle, some_levels, table_of_parts
from silverball.table import Cylinder, SlantWall, Table, TriangularPrism
from silverball.table.kinds import (
    DropTarget,
    Gate,
    Hole,
    Passage,
    Plunger,
    Post,
    Rollover,
    Slingshot,
    Spinner,
    Target,
    Wall,
)
from silverball.table.kinds.part import Part
from silverball.table.kinds.wall import ChainPoint
from silverball.table.primitive import Point

MIN_FEATURES, MAX_FEATURES = 3, 9
MOST_SPINNERS, MOST_BANKS = 16, 16  # as many as a world has room for


def hostile_part_table(seed: int) -> Table:
    """The hostile board of all parts of a seed; the same seed always gives the same one."""
    pick = random.Random(seed)
    board = hostile_board(pick).replace(max_balls=pick.choice((1, 2, 4, 8, 8)))
    levels = some_levels(pick)
    yard = Yard(pick, board, 1 + len(levels))
    parts: list[Part] = []
    for _ in range(pick.randint(MIN_FEATURES, MAX_FEATURES)):
        parts += pick.choice(FEATURES)(yard)
    for _ in range(pick.randint(0, 6)):
        parts += pick.choice(MAKERS)(yard)
    pick.shuffle(parts)
    parts = _first(_first(parts, Spinner, MOST_SPINNERS), DropTarget, MOST_BANKS)
    return table_of_parts(f"Hostile parts {seed}", board, levels, parts)


def _first(parts: list[Part], kind: type[Part], most: int) -> list[Part]:
    """The parts without those of a kind beyond the first `most`."""
    of_kind = [part for part in parts if isinstance(part, kind)]
    beyond = {id(part) for part in of_kind[most:]}
    return [part for part in parts if id(part) not in beyond]


def _clearance(yard: Yard) -> float:
    """The width by which a lane is wider than a ball: a hair, less than nothing, or just nothing [u]."""
    return yard.pick.choice((0.0, *HAIR, *(-width for width in HAIR)))


def _off(place: Point, by: float, turn: float) -> Point:
    """The point at a distance [u] and in a direction [rad] from a place."""
    return place[0] + by * math.sin(turn), place[1] + by * math.cos(turn)


def tangle(yard: Yard) -> list[Part]:
    """A wall of edges and arcs that crosses itself, open or closed, with edges as short as a hair."""
    pick, middle = yard.pick, yard.place()
    count, closed = pick.randint(2, 9), pick.random() < 0.5
    points: list[ChainPoint] = []
    for number in range(count):
        wide = pick.choice((0.001, 0.05, 1.0, 1.0))
        x, z = middle[0] + wide * pick.gauss(0.0, 0.8), middle[1] + wide * pick.gauss(0.0, 0.8)
        bulge = pick.choice((0.0, 0.0, 1.0, 0.002, 5.0, pick.uniform(0.01, 3.0))) * pick.choice((-1.0, 1.0))
        points.append((x, z) if bulge == 0.0 or (number == count - 1 and not closed) else (x, z, bulge))
    closed = closed and (count > 2 or any(len(point) == 3 for point in points))
    if not closed:
        points[-1] = points[-1][:2]
    thickness = pick.choice((0.0, 0.0, 0.01, 0.3))
    return [
        Wall(points=tuple(points), closed=closed, thickness=thickness, kick=yard.kick(), **yard.surface())
    ]


def arcs_in_arcs(yard: Yard) -> list[Part]:
    """Arcs around one centre, a ball's width apart: a hair more, a hair less, or nothing but rounding."""
    pick, middle, turn = yard.pick, yard.place(), yard.pick.uniform(0.0, 2.0 * math.pi)
    radius, parts = pick.uniform(0.3, 0.8), []
    for _ in range(pick.randint(2, 3)):
        start, end = _off(middle, radius, turn), _off(middle, radius, turn + math.pi)
        bulge = pick.choice((1.0, -1.0, pick.uniform(0.2, 2.0)))
        thickness = pick.choice((0.0, 0.05))
        parts.append(Wall(points=((*start, bulge), end), thickness=thickness, **yard.surface()))
        radius += 2.0 * yard.board.ball_radius + 2.0 * thickness + _clearance(yard)
    return [*parts]


def gates_in_walls(yard: Yard) -> list[Part]:
    """One-way gates along a wall, across it, just before it, and one against the other."""
    pick = yard.pick
    start, end = yard.line(0.3, 2.5)
    by = pick.choice((0.0, *HAIR, 2.0 * yard.board.ball_radius))
    directions = ["up", "down"] if abs(end[1] - start[1]) > abs(end[0] - start[0]) else ["left", "right"]
    beside = pick.uniform(0.0, 2.0 * math.pi)
    parts: list[Part] = [
        Gate(
            start=_off(start, by * n, beside),
            end=_off(end, by * n, beside),
            passes=passes,  # type: ignore[arg-type]
            thickness=pick.choice((0.0, 0.05, 0.3)),
            **yard.surface(),
        )
        for n, passes in enumerate(pick.sample(directions, pick.randint(1, 2)))
    ]
    if pick.random() < 0.5:
        cross = yard.line(0.5, 2.0, start) if pick.random() < 0.5 else (start, end)
        parts.append(SlantWall(start=cross[0], end=cross[1], thickness=0.0, **yard.surface()))
    if pick.random() < 0.3:
        name = f"gate {pick.randrange(10**9)}"
        parts.append(Gate(start=start, end=end, held=True, name=name, **yard.surface()))
    return parts


def holes_at_walls(yard: Yard) -> list[Part]:
    """A hole with a wall, a post or a gate in it or at its edge, that lets balls out through all of them."""
    pick, center = yard.pick, yard.place()
    radius = pick.uniform(0.05, 1.5)
    edge = _off(center, radius + pick.choice((0.0, yard.board.ball_radius, *HAIR)), pick.uniform(0.0, 6.3))
    hole = Hole(
        center=center,
        radius=radius,
        capture_speed=pick.choice((0.1, 5.0, 200.0)),
        hold=pick.choice((0.0, 1e-4, 0.3)),
        exit=pick.choice((None, edge)),
        exit_velocity=yard.velocity(0.0, yard.board.speed_cap),
        spread=pick.choice((0.0, 90.0)),
    )
    end = yard.line(0.3, 2.0, edge)[1]
    other = pick.choice(
        (
            SlantWall(start=edge, end=end, thickness=pick.choice((0.0, 0.1))),
            Post(center=edge, radius=0.05),
            Target(start=edge, end=end),
            DropTarget(start=edge, end=end, reset_after=0.05),
        )
    )
    return [hole, other]


def exits_side_by_side(yard: Yard) -> list[Part]:
    """Holes that send their balls to one place, or into each other, at once and without an end."""
    pick, place = yard.pick, yard.place()
    centers = [
        _off(place, pick.choice((*HAIR, 0.3, 1.0)), pick.uniform(0.0, 6.3)) for _ in range(pick.randint(2, 5))
    ]
    parts: list[Part] = []
    for number, center in enumerate(centers):
        apart = 2.0 * yard.board.ball_radius + _clearance(yard)
        out = pick.choice(
            (place, centers[number - 1], _off(centers[number - 1], apart, pick.uniform(0.0, 6.3)))
        )
        velocity = pick.choice(((0.0, 0.0), (0.01, 0.0), yard.velocity(1.0, yard.board.speed_cap)))
        parts.append(
            Hole(
                center=center,
                radius=pick.choice((0.05, 0.2, 1.0)),
                capture_speed=200.0,
                hold=pick.choice((0.0, 0.0, 0.01, 0.2)),
                exit=out,
                exit_velocity=velocity,
                exit_level=pick.randrange(yard.levels),
            )
        )
    return parts


def targets_under_balls(yard: Yard) -> list[Part]:
    """Drop targets over each other that come back at once, and a cradle that rolls balls onto them."""
    pick = yard.pick
    start, end = yard.line(0.2, 1.5)
    parts: list[Part] = []
    for _ in range(pick.randint(1, 4)):
        by = pick.choice((0.0, *HAIR, 0.3))
        thickness = pick.choice((0.0, 0.05, 0.4))
        parts.append(
            DropTarget(
                start=_off(start, by, pick.uniform(0.0, 6.3)),
                end=_off(end, by, pick.uniform(0.0, 6.3)),
                thickness=thickness,
                bank=pick.choice(("", "over each other")),
                reset_after=pick.choice((0.05, 0.05, 0.5)),
                hit_speed=pick.choice((0.01, 1.0)),
                restitution=pick.choice((0.0, 1.0)),
            )
        )
    if pick.random() < 0.6:
        low = (min(start[0], end[0]) - 0.5, 0.5 * (start[1] + end[1]))
        parts += [SlantWall(start=low, end=_off(low, 1.5, turn)) for turn in (0.8, math.pi - 0.8)]
    return parts


def passages_through_parts(yard: Yard) -> list[Part]:
    """Passages that cross each other and lead through parts of one level, the other, or both."""
    pick, place = yard.pick, yard.place()
    if yard.levels == 1:
        return rollovers_at_a_point(yard)
    parts: list[Part] = []
    for _ in range(pick.randint(1, 4)):
        start = _off(place, pick.choice((*HAIR, 0.5)), pick.uniform(0.0, 6.3))
        end = yard.line(0.2, 3.0, start)[1]
        here, there = pick.sample(range(yard.levels), 2)
        parts.append(Passage.model_validate({"start": start, "end": end, "from": here, "to": there}))
    level = pick.choice(({"level": 0}, {"level": 1}, {"levels": (0, 1)}))
    size = pick.uniform(0.1, 0.8)
    parts.append(
        pick.choice(
            (
                TriangularPrism(center=place, size=size, **level),
                Cylinder(center=place, radius=size, kick=yard.kick(), **level),
                Wall(points=((*place, 1.0), _off(place, size, 1.0)), closed=True, **level),
                fast_paddle(yard, pivot=place, **level),
            )
        )
    )
    return parts


def paddles_over_each_other(yard: Yard) -> list[Part]:
    """Paddles about one pivot, or just beside it, that turn against each other, some on obstacles."""
    pick, pivot = yard.pick, yard.place()
    parts: list[Part] = []
    for _ in range(pick.randint(2, 4)):
        at = _off(pivot, pick.choice((0.0, 0.0, *HAIR, 0.5)), pick.uniform(0.0, 6.3))
        rest = pick.uniform(-120.0, 60.0)
        given = {"rest_angle": rest, "up_angle": min(120.0, rest + pick.uniform(10.0, 200.0))}
        parts.append(fast_paddle(yard, pivot=at, length=pick.uniform(0.4, 2.5), **given, **yard.level()))
    if pick.random() < 0.5:
        at = _off(pivot, pick.uniform(0.0, 2.0), pick.uniform(0.0, 6.3))
        parts.append(Post(center=at, radius=pick.choice((0.02, 0.3))))
    return parts


def slingshots_face_to_face(yard: Yard) -> list[Part]:
    """Two slingshots, a ball's width apart, that kick it from one to the other."""
    pick = yard.pick
    start, end = yard.line(0.3, 2.0)
    turn = math.atan2(end[0] - start[0], end[1] - start[1]) + 0.5 * math.pi
    thickness, post = pick.choice((0.0, 0.05)), pick.choice((0.02, 0.12))
    apart = 2.0 * (yard.board.ball_radius + thickness) + _clearance(yard)
    return [
        Slingshot(
            start=_off(start, by, turn),
            end=_off(end, by, turn),
            kick=pick.choice((1.0, yard.board.speed_cap)),
            hit_speed=0.01,
            thickness=thickness,
            post_radius=post,
            restitution=1.0,
        )
        for by in (0.0, apart)
    ]


def rollovers_at_a_point(yard: Yard) -> list[Part]:
    """Lines and circles that cross and touch in one point, and spinners that stop what crosses them."""
    pick, place = yard.pick, yard.place()
    parts: list[Part] = []
    for _ in range(pick.randint(2, 7)):
        kind = pick.randrange(3)
        if kind == 0:
            radius = pick.choice((0.05, 0.3, 1.0))
            parts.append(Rollover(center=_off(place, radius, pick.uniform(0.0, 6.3)), radius=radius))
            continue
        start, end = place, yard.line(0.1, 2.0, place)[1]
        if pick.random() < 0.5:
            start = (2.0 * place[0] - end[0], 2.0 * place[1] - end[1])
        if kind == 1:
            parts.append(Rollover(start=start, end=end))
        else:
            drag, damping = pick.choice((0.0, 1.0, 20.0)), pick.choice((0.05, 50.0))
            parts.append(Spinner(start=start, end=end, drag=drag, damping=damping, height=0.05))
    return parts


def tight_plunger(yard: Yard) -> list[Part]:
    """A plunger in a lane as wide as a ball, or against a wall, and perhaps a second one in its way."""
    pick, place = yard.pick, yard.place()
    angle = pick.choice((90.0, pick.uniform(-180.0, 180.0)))
    side = yard.board.ball_radius + 0.5 * _clearance(yard)
    along, across = math.radians(angle), math.radians(angle) + 0.5 * math.pi
    walls: list[Part] = []
    for by in (-side, side):
        start = _off(place, by, across)
        walls.append(SlantWall(start=start, end=_off(start, pick.uniform(0.5, 2.0), along), thickness=0.0))
    plungers = [place, _off(place, pick.choice((*HAIR, 1.0)), along)][: pick.randint(1, 2)]
    return [
        *walls[: pick.randint(0, 2)],
        *(
            Plunger(position=at, launch=(0.5, yard.board.speed_cap), charge=0.05, angle=angle)
            for at in plungers
        ),
    ]


FEATURES: tuple[Callable[[Yard], list[Part]], ...] = (
    tangle,
    tangle,
    arcs_in_arcs,
    gates_in_walls,
    gates_in_walls,
    holes_at_walls,
    exits_side_by_side,
    targets_under_balls,
    passages_through_parts,
    paddles_over_each_other,
    slingshots_face_to_face,
    rollovers_at_a_point,
    tight_plunger,
)
