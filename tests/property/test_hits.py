"""The first contact is one, and none is earlier: brute force over all parts, with the twin's shapes.

The flight up to the first contact is known in closed form: gravity alone, or 5/7 of it where the ball rolls
from the start. It is sampled finely, and every part is checked in every sample.
"""

from __future__ import annotations

import math

from hypothesis import assume, event, given, settings, strategies as st

from boards import CONTACTS, full_table, moment, place
from oracle import Twin
from silverball.table import Table, generate_table
from silverball.world import World
from spinning import spinning

SAMPLES = 300
SECONDS = 0.8
ROUNDING = 1e-13
"""[u] Places of 10 u and their differences, some ten operations."""

starts = st.tuples(
    st.floats(-8.5, 9.0), st.floats(-4.6, 4.6), st.floats(0, 2 * math.pi), st.floats(0, 21)
).map(lambda s: (s[0], s[1], s[3] * math.sin(s[2]), s[3] * math.cos(s[2])))
held = st.fixed_dictionaries({"left": st.booleans(), "right": st.booleans()})


class Flight:
    """A ball's free flight on a table whose buttons are held from the start."""

    def __init__(self, table: Table, start, pull: float, buttons) -> None:
        self.table, self.start, self.pull, self.buttons = table, start, pull, buttons
        self.twin = Twin(table, [start])

    def at(self, t: float) -> tuple[float, float]:
        """Where the ball is."""
        x, z, vx, vz = self.start
        return x + vx * t - self.pull * t * t / 2, z + vz * t

    def gaps(self, t: float) -> dict[str, float]:
        """The gap [u] between the ball and every part; that of the gutter is the way to its line."""
        x, z = self.at(t)
        board = self.table.board
        angles = {paddle.side: self.angle(paddle, t) for paddle in self.table.paddle}
        gaps = {
            shape.path: shape.nearest(x, z)[0] - board.ball_radius
            for shape in self.twin.shapes(angles, self.buttons)
        }
        edge = board.width / 2 - board.wall_thickness - board.ball_radius
        gaps |= {"board.left": z + edge, "board.right": edge - z, "gutter": x - board.gutter}
        return gaps | {"board.top": board.length / 2 - board.wall_thickness - board.ball_radius - x}

    def angle(self, paddle, t: float) -> float:
        """The angle of a paddle that was at rest [rad]."""
        rest, up = math.radians(paddle.rest_angle), math.radians(paddle.up_angle)
        return min(up, rest + (up - rest) / paddle.stroke * t) if self.buttons[paddle.side] else rest

    def check(self, world: World) -> None:
        """The world's first contact is a root of its part's gap, and until then every gap is open."""
        met = next((e for e in world.events if e.kind in (*CONTACTS, "gutter")), None)
        end = SECONDS if met is None else moment(world, met)
        for sample in range(SAMPLES):
            t = end * sample / SAMPLES
            gaps = self.gaps(t)
            part = min(gaps, key=gaps.__getitem__)
            assert gaps[part] > -ROUNDING, f"inside {part} by {-gaps[part]} u {end - t} s before {met}"
        if met is None:
            event("no contact")
            return
        event(met.part.split("[")[0])
        gaps = self.gaps(end)
        # A graze may end at a gap of 1e-13; a paddle turns with up to 10 rad/s.
        assert abs(gaps[met.part]) <= 3e-13
        assert min(gaps.values()) > -3e-13
        assert math.dist(place(met), self.at(end)) <= ROUNDING


def first_seconds(table: Table, start, spin, buttons) -> World:
    """A world after some time in one step, so that its log begins with the first contact."""
    world = spinning(table, (start, spin), tick_rate=60)
    world.step(**buttons, ticks=round(SECONDS * 60))
    return world


@settings(max_examples=60)
@given(st.integers(0, 60), starts, held)
def test_a_contact_is_a_root_and_none_is_earlier(board, start, buttons) -> None:
    table = generate_table(board) if board else full_table()
    assume(World(table).clearance(*start[:2]) > 1e-6 and start[0] > -8.7)
    flight = Flight(table, start, table.board.gravity, buttons)
    flight.check(first_seconds(table, start, (0.0, 0.0, 0.0), buttons))


@settings(max_examples=40)
@given(st.integers(0, 60), starts, held, st.floats(0.1, 2.0))
def test_the_same_holds_for_a_ball_that_rolls(board, start, buttons, friction) -> None:
    table = generate_table(board) if board else full_table()
    table = table.model_copy(
        update={"board": table.board.model_copy(update={"friction": friction, "rolling": True})}
    )
    assume(World(table).clearance(*start[:2]) > 1e-6 and start[0] > -8.7)
    radius = table.board.ball_radius
    spin = (start[3] / radius, 7.0, -start[2] / radius)
    flight = Flight(table, start, 5 / 7 * table.board.gravity, buttons)
    flight.check(first_seconds(table, start, spin, buttons))
