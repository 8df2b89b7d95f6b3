"""Holes and plungers: which balls they hold, and how fast they send them off."""

from __future__ import annotations

from silverball.physics.kernel import kernel
from silverball.physics.portable_math import sine_cosine, uniform


@kernel
def can_capture(vx: float, vz: float, capture_speed: float) -> bool:
    """Whether a hole captures a ball that enters with this velocity [u/s]; a faster ball passes over it."""
    return vx * vx + vz * vz <= capture_speed * capture_speed


@kernel
def exit_velocity(vx: float, vz: float, spread: float, seed: int, draws: int) -> tuple[float, float, int]:
    """Turn the velocity at which a hole ejects a ball by a random angle.

    Args:
        vx: The velocity without spread [u/s].
        vz: The same in z.
        spread: The greatest angle [rad]; all angles up to it are equally likely. 0 uses no random number.
        seed: The seed of the world's random generator.
        draws: Its random numbers used so far.

    Returns:
        The velocity, and the random numbers used after that.
    """
    if spread == 0.0:
        return vx, vz, draws
    sine, cosine = sine_cosine(spread * (2.0 * uniform(seed, draws) - 1.0))
    return cosine * vx + sine * vz, cosine * vz - sine * vx, draws + 1


@kernel
def launch_speed(least: float, greatest: float, charge: float, held_ticks: int, tick: float) -> float:
    """Compute the speed [u/s] at which a plunger launches a ball.

    Args:
        least: The speed after the shortest press [u/s].
        greatest: The speed after the time `charge` and longer [u/s]; in between the speed grows linearly.
        charge: The time for which the button is held for the greatest speed [s]; 0: it is always reached.
        held_ticks: Ticks for which the button was held.
        tick: The length of a tick [s].
    """
    held = held_ticks * tick
    if held >= charge:
        return greatest
    return least + (greatest - least) * (held / charge)
