"""Balls with spin: give them one, and measure what follows."""

from __future__ import annotations

from typing import Any

from boards import edited, launched
from silverball.table import Table
from silverball.world import World

Spin = tuple[float, float, float]
"""Angular velocity about x, y, z [rad/s]."""

Start = tuple[float, float, float, float]
"""x, z [u], vx, vz [u/s] of a ball."""


def spin_balls(world: World, *spins: Spin) -> None:
    """Give the world's balls, in the order of their slots, these spins."""

    def change(record: Any) -> None:
        for slot, spin in enumerate(spins):
            for name, turn in zip(("spin_x", "spin_y", "spin_z"), spin, strict=True):
                record["ball"][name][slot] = turn

    world.restore(edited(world, change))


def spinning(table: Table, *balls: tuple[Start, Spin], tick_rate: int = 240) -> World:
    """A world with balls that spin from the start."""
    world = launched(table, *(start for start, _ in balls), tick_rate=tick_rate)
    spin_balls(world, *(spin for _, spin in balls))
    return world


def touch_speed(world: World) -> float:
    """The greatest speed [u/s] of a ball's lowest point over the playfield:  (vx + r·ω_z, vz − r·ω_x)."""
    radius = world.table.board.ball_radius
    fastest = 0.0
    for ball in world.balls:
        (vx, _, vz), (wx, _, wz) = ball.velocity, ball.spin
        fastest = max(fastest, ((vx + radius * wz) ** 2 + (vz - radius * wx) ** 2) ** 0.5)
    return fastest


def energy(world: World) -> float:
    """Kinetic, rotational and potential energy of all balls by the mass [u²/s²]:  ½v² + ⅕r²ω² + g·x."""
    board = world.table.board
    total = 0.0
    for ball in world.balls:
        (vx, _, vz), spin = ball.velocity, ball.spin
        total += 0.5 * (vx * vx + vz * vz) + board.gravity * ball.position[0]
        total += 0.2 * board.ball_radius**2 * sum(turn * turn for turn in spin)
    return total
