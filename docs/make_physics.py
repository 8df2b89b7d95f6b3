"""Draw the picture of docs/physics.md: `python docs/make_physics.py`.

A ball falls past a cylinder and grazes it; the dots are the steps with which the solver approaches the
contact. It needs matplotlib: `.venv/bin/pip install '.[bench]'`.
"""

from __future__ import annotations

from math import hypot, sqrt
from pathlib import Path

PICTURE = Path(__file__).with_name("physics_steps.svg")
GRAVITY, RADIUS = 10.0, 0.25 + 0.6  # [u/s²], of the ball and the cylinder together [u]
START, VELOCITY = (4.0, 0.75), (-3.0, -0.2)  # the cylinder is at the origin; x up, z to the right
CLOSED = 1e-13  # [u]


def gap_and_normal(time: float) -> tuple[float, float, float]:
    """The gap [u] between ball and cylinder, and the normal (x, z) that points to the ball."""
    x = START[0] + VELOCITY[0] * time - 0.5 * GRAVITY * time * time
    z = START[1] + VELOCITY[1] * time
    away = hypot(x, z)
    return away - RADIUS, x / away, z / away


def steps_to_contact() -> list[tuple[float, float]]:
    """The times [s] and gaps [u] of the safe steps, the contact last."""
    time, steps = 0.0, []
    while True:
        gap, nx, nz = gap_and_normal(time)
        steps.append((time, gap))
        if gap <= CLOSED:
            return steps
        rate = nx * (VELOCITY[0] - GRAVITY * time) + nz * VELOCITY[1]
        gap_accel = -nx * GRAVITY
        time += 2.0 * gap / (sqrt(rate * rate - 2.0 * gap_accel * gap) - rate)


def draw() -> None:
    """Write the picture."""
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams["svg.hashsalt"] = "silverball"
    from matplotlib import pyplot as plt

    steps = steps_to_contact()
    figure, (wide, close) = plt.subplots(1, 2, figsize=(8.0, 3.2))
    times = [steps[-1][0] * 1.06 * index / 400 for index in range(401)]
    wide.plot(times, [gap_and_normal(time)[0] for time in times], color="tab:blue", label="gap D(t)")
    wide.plot(*zip(*steps, strict=True), "o", color="tab:red", label="safe steps")
    wide.axhline(0.0, color="0.6", linewidth=0.8)
    wide.set(xlabel="time [s]", ylabel="gap [u]", title="A ball approaches a cylinder")
    wide.legend()
    close.semilogy([max(gap, 1e-17) for _, gap in steps[:-1]], "o-", color="tab:red")
    close.axhline(CLOSED, color="0.6", linewidth=0.8)
    close.set(xlabel="step", ylabel="gap [u]", title="The gap left after each step")
    close.xaxis.get_major_locator().set_params(integer=True)
    figure.tight_layout()
    figure.savefig(PICTURE, metadata={"Date": None})
    print(PICTURE.name, len(steps) - 1, "steps")


if __name__ == "__main__":
    draw()
