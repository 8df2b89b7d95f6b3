"""The boards that the tests play on, and how a test looks at a flight.

Nothing in here computes physics: every law is worked out in the test that checks it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from silverball.table import (
    Board,
    Cylinder,
    Paddle,
    SlantWall,
    Table,
    TriangularPrism,
    load_table,
    table_digest,
)
from silverball.table.kinds import Passage, Plunger, Wall
from silverball.table.model import list_sections
from silverball.world import Event, World
from silverball.world.saved_world import pack

LEFT = Paddle(side="left", pivot=(-7.2, -2.5))
RIGHT = Paddle(side="right", pivot=(-7.2, 2.5))
PADDLES = (LEFT, RIGHT)
FIRST_SHAPE = 5
"""Row of the first stationary shape on a board: after three borders and two paddles."""
TABLES = Path(__file__).with_name("tables")
"""Tables that stay as they are, so that tuning the built-in ones changes no golden digest and no test."""
CLASSIC = load_table(TABLES / "classic.toml")
RANDOM = load_table(TABLES / "random.toml")
PLAYGROUND = load_table(TABLES / "playground.toml")
"""Every kind of part, and room for five balls."""
CONTACTS = ("hit", "touch", "ball_hit", "ball_touch")


def table_of(*parts: Any, **board: Any) -> Table:
    """A table of these parts; nothing checks whether they fit together."""
    lists = {
        key: tuple(part for part in parts if type(part) is kind) for key, kind in list_sections(Table).items()
    }
    is_old = {type(part) for part in parts} <= {SlantWall, Paddle, TriangularPrism, Cylinder}
    return Table(format=1 if is_old else 2, name="of a test", board=Board(**board), **lists)


def full_table(*more: Any, boost: float = 1.25, restitution: float | None = None, **board: Any) -> Table:
    """Two paddles, four guides, four prisms and three cylinders."""
    prisms = (
        ((2.0, -1.0), (3.2, -1.4), (2.4, 0.2)),
        ((-1.0, -3.0), (0.2, -3.4), (-0.6, -2.2)),
        ((-1.0, 3.1), (0.2, 3.4), (-0.6, 2.2)),
        ((5.0, 3.0), (6.2, 3.4), (5.4, 2.2)),
    )
    parts = [
        SlantWall(start=(-4.5, -5.0), end=(-6.88, -2.76)),
        SlantWall(start=(-6.88, 2.76), end=(-4.5, 5.0)),
        SlantWall(start=(8.0, -5.0), end=(10.0, -3.0)),
        SlantWall(start=(8.0, 5.0), end=(10.0, 3.0)),
        *PADDLES,
        *(TriangularPrism(vertices=vertices) for vertices in prisms),
        Cylinder(center=(5.0, 0.9), radius=0.6, speed_factor=boost),
        Cylinder(center=(5.2, -2.0), radius=0.6, speed_factor=boost),
        Cylinder(center=(0.0, 0.5), radius=0.6, speed_factor=boost),
        *more,
    ]
    if restitution is not None:
        parts = [
            part.model_copy(
                update={"restitution": restitution, "restitution_falloff": 0.0}
                | ({"speed_factor": boost} if isinstance(part, TriangularPrism | Cylinder) else {})
            )
            for part in parts
        ]
        board |= {"wall_restitution": restitution, "ball_restitution": restitution}
    return table_of(*parts, **board)


def mirrored(table: Table) -> Table:
    """The same table in the mirror: every z changes its sign, and the paddles change sides."""
    return table.model_copy(
        update={
            section: tuple(mirrored_part(part) for part in getattr(table, section))
            for section in list_sections(Table)
        }
    )


def mirrored_part(part: Any) -> Any:
    """The same part in the mirror; one that is round or a triangle is given by its centre or its corners."""
    other = {"left": "right", "right": "left"}
    values = {name: getattr(part, name) for name in type(part).model_fields}
    changes: dict[str, Any] = {
        name: (values[name][0], -values[name][1])
        for name in ("start", "end", "pivot", "center", "exit", "exit_velocity", "position", "gravity")
        if values.get(name) is not None
    }
    changes |= {
        name: other.get(values[name], values[name]) for name in ("side", "button", "passes") if name in values
    }
    if isinstance(part, Passage):  # what was to the left of it is to the right
        changes["start"], changes["end"] = changes["end"], changes["start"]
    if isinstance(part, Plunger):
        changes["angle"] = 180.0 - part.angle
    if isinstance(part, Wall):
        changes["points"] = tuple((x, -z, *(-bulge for bulge in rest)) for x, z, *rest in part.points)
    if isinstance(part, Cylinder):
        x, z, radius = part.circle()
        changes |= {"center": (x, -z), "radius": radius, "mesh": None}
    if isinstance(part, TriangularPrism):
        corners = tuple((x, -z) for x, z in part.corners())
        dropped = {"center", "size", "rotation", "mesh", "vertices"}
        return TriangularPrism(vertices=corners, **part.model_dump(exclude=dropped, exclude_defaults=True))
    return part.model_copy(update=changes)


def launched(
    table: Table, *balls: tuple[float, float, float, float], tick_rate: int = 240, seed: int = 0
) -> World:
    """A world with balls (x, z, vx, vz)."""
    world = World(table, seed=seed, tick_rate=tick_rate)
    for x, z, vx, vz in balls:
        world.create_ball((x, z), (vx, vz))
    return world


def edited(world: World, change: Callable[[Any], None]) -> bytes:
    """The world's saved state with its record changed by hand, its checksum right."""
    record = world.records[0].copy()
    change(record)
    return pack(record, table_digest(world.table), world.tick_rate)


def contacts(world: World, ticks: int, **buttons: bool) -> Iterator[Event]:
    """The contacts of balls in the next ticks, one by one, as they happen."""
    for _ in range(ticks):
        world.step(**buttons)
        assert world.events_lost == 0
        yield from (event for event in world.events if event.kind in CONTACTS)


def first_contact(world: World, ticks: int = 1000, **buttons: bool) -> Event:
    """The first contact of a ball; the world stands at the end of its tick."""
    return next(contacts(world, ticks, **buttons))


def moment(world: World, event: Event) -> float:
    """When an event happened [s]."""
    return event.tick / world.tick_rate + event.offset


def place(item: Any) -> tuple[float, float]:
    """The (x, z) of a ball or an event [u]."""
    return item.position[0], item.position[2]


def speed_of(ball: Any) -> tuple[float, float]:
    """The (vx, vz) of a ball [u/s]."""
    return ball.velocity[0], ball.velocity[2]
