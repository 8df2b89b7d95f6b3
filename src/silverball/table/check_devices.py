"""What holes, plungers, passages, gates and other devices need, and how many of everything a board may have.

Lines are sampled every hundredth of a unit; everything else is exact, but for arcs, which are chains of edges
within a thousandth of a unit.
"""

from __future__ import annotations

import math
from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from silverball.errors import Problem
from silverball.physics.forms import Shape
from silverball.table.geometry import Bools, Floats, Pieces, Polygon, arc_edges, border_gaps, clear_of
from silverball.table.placed_parts import Layout, PlacedPart
from silverball.table.primitive import Primitive
from silverball.table.reach import Space, resting_pieces

if TYPE_CHECKING:
    from silverball.table.kinds import Board

MAX_PADDLES = 8  # as many as a world has room for
MAX_EDGES = 16_384  # of all parts, arcs divided into edges; real tables have 1,000
MAX_SWITCHES = 62  # drop targets and held gates: the bits of one integer
MAX_CROSSINGS = 128  # drop targets, gates and passages, to bound the time of the search for ways out
SPACING = 0.01  # [u] between the points of a line that are examined
FREE = 1e-9  # [u] by which a ball may overlap a part where it comes out: rounding


def limit_problems(layout: Layout) -> list[Problem]:
    """Find what there is too much of, levels that do not exist, and speeds above the cap."""
    problems = []
    everything = [p for part in (*layout.parts, *layout.paddles) for p in part.primitives]
    edges = sum(arc_edges(p) if p.shape is Shape.ARC else 1 for p in everything)
    switches = sum(p.bank is not None or p.is_gate for p in everything)
    crossings = switches + sum(p.one_way is not None or p.passage is not None for p in everything)
    for path, what, count, most in (
        ("wall", "edges of arcs, drawn within a thousandth of a unit", edges, MAX_EDGES),
        ("paddle", "paddles", len(layout.moving()), MAX_PADDLES),
        ("", "drop targets and held gates", switches, MAX_SWITCHES),
        ("", "drop targets, gates and passages", crossings, MAX_CROSSINGS),
    ):
        if count > most:
            problems.append(Problem(path, f"has too many {what}: at most {most:,}, got {count:,}"))
    for part in (*layout.parts, *layout.paddles):
        problems += _level_problems(part, layout.levels)
        problems += _speed_problems(part, layout.board)
    return problems


def _level_problems(part: PlacedPart, known: frozenset[int]) -> list[Problem]:
    """Check that the levels of a part, of its exit and of its passage exist."""
    used = {level for p in part.primitives for level in p.levels}
    used |= {p.hold.exit_level for p in part.primitives if p.hold is not None}
    unknown = sorted(used - known)
    if not unknown:
        return []
    message = f"must be on levels of the table ({_listed(sorted(known))}), got {_listed(unknown)}"
    return [Problem(part.path, f"{message}: add a level with this number")]


def _listed(numbers: list[int]) -> str:
    return ", ".join(map(str, numbers))


def _speed_problems(part: PlacedPart, board: Board) -> list[Problem]:
    """Check that nothing sends a ball off faster than the cap."""
    problems = []
    cap = board.speed_cap
    for key, speed in sorted(
        {
            *(("kick", p.surface.kick) for p in part.primitives),
            *(("exit_velocity", math.hypot(*p.hold.exit_velocity)) for p in part.primitives if p.hold),
            *(("launch", p.launch.greatest) for p in part.primitives if p.launch),
            *(("auto_launch", p.launch.auto[1]) for p in part.primitives if p.launch and p.launch.auto),
        }
    ):
        if speed > cap:
            message = f"must be at most the speed cap of {cap:g} u/s, got {speed:g}: make it slower"
            problems.append(Problem(f"{part.path}.{key}", f"{message}, or raise board.speed_cap"))
    return problems


class _Surroundings(NamedTuple):
    """What a ball could overlap, and where it gets to."""

    layout: Layout
    pieces: Pieces  # that stand still, and paddles at rest
    polygons: list[Polygon]
    space: Space

    def is_free(self, balls: Floats, level: int, without: int = -1) -> Bools:
        """Return whether balls on a level overlap nothing but perhaps one part, bool [ball]."""
        board = self.layout.board
        others = self.pieces.on_level(level)
        others = others.only(others.part != without)
        is_free: Bools = border_gaps(balls, board).min(axis=-1) - board.ball_radius > -FREE
        is_free &= clear_of(balls, board.ball_radius, others, FREE)
        for polygon in self.polygons:
            if polygon.levels >> level & 1 and polygon.part != without:
                is_free &= ~polygon.contains(balls)
        return is_free


def device_problems(layout: Layout, space: Space) -> list[Problem]:
    """Find the holes, plungers, passages and gates that cannot do what they are there for."""
    around = _Surroundings(layout, layout.solids().joined(resting_pieces(layout)), layout.polygons(), space)
    problems = _bank_problems(layout)
    for index, part in enumerate(layout.parts):
        for primitive in part.primitives:
            if primitive.hold is not None and not primitive.hold.is_drain:
                problems += _hole_problems(part, primitive, around)
            if primitive.launch is not None:
                problems += _plunger_problems(part, primitive, around)
            if primitive.passage is not None:
                problems += _passage_problems(part, primitive, around)
            if primitive.one_way is not None and primitive.shape is Shape.CAPSULE:
                problems += _gate_problems(part, index, primitive, around)
    return problems + _unreached_levels(layout)


def _bank_problems(layout: Layout) -> list[Problem]:
    """Warn of banks whose members disagree about their return."""
    times: dict[str, dict[float, str]] = defaultdict(dict)
    for part in layout.parts:
        for p in part.primitives:
            if p.bank:
                times[p.bank].setdefault(p.reset_after, part.path)
    problems = []
    for bank, given in times.items():
        if len(given) > 1:
            (first, path), (second, other) = list(given.items())[:2]
            message = f"is {second:g} s, but {first:g} s at {path} of the same bank {bank!r}: give one time"
            problems.append(Problem(f"{other}.reset_after", message, "warning"))
    return problems


def _hole_problems(part: PlacedPart, hole: Primitive, around: _Surroundings) -> list[Problem]:
    """Check that the ball that leaves a hole comes out in a free place from which it gets away."""
    assert hole.hold is not None
    place, level = hole.hold.exit, hole.hold.exit_level
    at = f"at [{place[0]:g}, {place[1]:g}] on level {level}" if level else f"at [{place[0]:g}, {place[1]:g}]"
    if not around.is_free(np.array([place]), level)[0]:
        message = f"must be a free place for a ball, but a ball {at} is inside something: move it"
        return [Problem(f"{part.path}.exit", message)]
    below = place[0] <= around.layout.board.gutter
    if not below and not around.space.reaches(place, level):
        message = f"must lead out, but a ball {at} gets neither to the gutter nor into a drain: move it"
        return [Problem(f"{part.path}.exit", message)]
    return []


def _plunger_problems(part: PlacedPart, plunger: Primitive, around: _Surroundings) -> list[Problem]:
    """Check that a ball fits on a plunger, can leave it, and gets from there to the rest of the table."""
    assert plunger.launch is not None
    (place,), level, radius = plunger.points, plunger.levels[0], around.layout.board.ball_radius
    path = f"{part.path}.position"
    if not around.is_free(np.array([place]), level)[0]:
        return [Problem(path, "must have room for a ball, but a ball on it is inside something: move it")]
    ways = np.linspace(0.0, 2.0 * radius, 21)[:, None] * np.array(plunger.launch.direction)
    if not around.is_free(np.array(place) + ways, level).all():
        return [
            Problem(path, "must have room in front of it, but a launched ball is inside something: move it")
        ]
    if place[0] > around.layout.board.gutter and not around.space.reaches(place, level):
        return [Problem(path, "must lead into play, but a launched ball has no way out of its lane: open it")]
    return []


def _passage_problems(part: PlacedPart, line: Primitive, around: _Surroundings) -> list[Problem]:
    """Check that a ball that crosses a passage arrives in a free place, from which it gets away."""
    assert line.passage is not None
    if not set(line.passage) <= around.layout.levels:
        return []  # a problem already
    balls = _along(line)
    free = [around.is_free(balls, level) for level in line.passage]
    problems = []
    for here, there, level in ((free[0], free[1], line.passage[1]), (free[1], free[0], line.passage[0])):
        into = np.nonzero(here & ~there)[0]
        if len(into):
            x, z = balls[into[len(into) // 2]]
            message = (
                f"leads into a wall: a ball that crosses it at [{x:.2f}, {z:.2f}] is inside something on "
                f"level {level}: leave a ball's radius to everything solid there"
            )
            problems.append(Problem(part.place, message))
    if not problems and not free[0].any():
        message = "has no free place for a ball anywhere along it: move it"
        problems.append(Problem(part.place, message))
    return problems


def _gate_problems(part: PlacedPart, index: int, gate: Primitive, around: _Surroundings) -> list[Problem]:
    """Check that there is room for a ball before and behind a one-way gate, and a way on."""
    assert gate.one_way is not None
    away = (gate.radius + around.layout.board.ball_radius + FREE) * np.array(gate.one_way)
    balls = _along(gate)
    for level in gate.levels:
        passes = np.ones(len(balls), dtype=bool)
        for share in (-1.0, 0.0, 1.0):
            passes &= around.is_free(balls + share * away, level, index)
        places = (balls + away)[passes].tolist()
        if any(x <= around.layout.board.gutter or around.space.reaches((x, z), level) for x, z in places):
            return []
    reason = "leads nowhere" if len(places) else "has no room for a ball before and behind it"
    return [Problem(part.place, f"{reason}: move it, or what is beside it")]


def _along(line: Primitive) -> Floats:
    """Points along a line, ends included, shape [point, 2]."""
    start, end = (np.array(point) for point in line.points)
    count = max(2, math.ceil(float(np.hypot(*(end - start))) / SPACING) + 1)
    points: Floats = start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)
    return points


def _unreached_levels(layout: Layout) -> list[Problem]:
    """Warn of parts on levels to which no passage and no hole leads."""
    found = {0}
    for part in layout.parts:
        for p in part.primitives:
            found |= set(p.passage or ())
            found |= {p.hold.exit_level} if p.hold is not None else set()
    parts = (*layout.parts, *layout.paddles)
    used = [{level for p in part.primitives for level in p.levels} for part in parts]
    return [
        Problem("", f"has parts on level {level}, to which no passage and no hole leads: add one", "warning")
        for level in sorted(set().union(*used) - found)
    ]
