"""How much energy does an engine lose or gain where none can be lost or gained?

One ball bounces with restitution 1 on a closed random board, under gravity. What it has at the end is the
mean over the last ten seconds of ½v² + g·(x − floor), looked at once a second; the true value is that of the
start.
"""

from __future__ import annotations

import statistics

from silverball.benchmarks.peers import tables
from silverball.benchmarks.peers.engine import FRAME_RATE, Playfield
from silverball.benchmarks.peers.play import free_places
from silverball.table import Table

PUSH = (3.0, 4.0)  # vx, vz [u/s] at the start
SECONDS = 1000
LAST = 10  # [s]


def energy(table: Table, ball: tuple[float, float, float, float]) -> float:
    """Kinetic and potential energy of a ball of mass 1, from the floor up [u²/s²]."""
    x, _, vx, vz = ball
    return 0.5 * (vx * vx + vz * vz) + table.board.gravity * (x - tables.FLOOR)


def start(table: Table) -> tuple[float, float, float, float]:
    """Where the ball starts on the closed form of an open table, and how fast: x, z [u], vx, vz [u/s]."""
    return (*free_places(table, 0, 1)[0], *PUSH)


def drift(field: Playfield, ball: tuple[float, float, float, float], seconds: int = SECONDS) -> float:
    """The relative error of the energy after so many seconds on a closed table; 1 if the ball is lost.

    Args:
        field: A closed table, without a ball.
        ball: Of the start.
        seconds: How long [s].
    """
    field.put_ball(*ball)
    truth = energy(field.table, ball)
    seen = []
    for second in range(seconds):
        for _ in range(FRAME_RATE * field.stepping.steps):
            field.step(False, False)
        if second >= seconds - LAST:
            balls = field.balls()
            seen.append(energy(field.table, balls[0]) if balls else 0.0)
    return abs(statistics.mean(seen) / truth - 1.0)
