"""Looks: what a primitive of each finish is built of, how high it is, and which colour of a theme it has.

This table is all that the drawing knows about finishes. The footprint comes from the primitive's shape.
"""

from __future__ import annotations

from typing import NamedTuple

from silverball.drawing.kernels.stage import Material
from silverball.table.primitive import Finish


class Fill(NamedTuple):
    """What fills a closed wall.

    Attributes:
        material: How it is built.
        role: The colour of the theme.
        drop: How much lower than its edges it is [u].
    """

    material: Material
    role: str
    drop: float = 0.03


class Look(NamedTuple):
    """What a primitive of one finish looks like.

    Attributes:
        material: How it is built and painted.
        role: The field of a theme with its colour, or with the colours through which its parts cycle.
        height: Of its top above the floor of its level, for a ball of the usual size [u].
        bevel: Radius of its upper edge [u], at most its own radius.
        glow: Strength of the light on its surroundings.
        has_tube: Whether a tube of light runs along its foot.
        flashes: Whether it lights up when it is hit.
        flash_reach: How far that is visible around it [u].
        fill: What fills a closed wall of this finish.
    """

    material: Material
    role: str
    height: float
    bevel: float = 0.055
    glow: float = 0.0
    has_tube: bool = False
    flashes: bool = False
    flash_reach: float = 0.9
    fill: Fill = Fill(Material.PLAIN, "infill")


LOOKS = {
    Finish.BORDER: Look(Material.BAR, "rail", 0.36),
    Finish.WALL: Look(Material.BAR, "wall", 0.36, bevel=0.06, has_tube=True),
    Finish.METAL: Look(Material.STEEL, "metal", 0.34, bevel=0.1),
    Finish.WOOD: Look(Material.TIMBER, "timber", 0.40, bevel=0.03, fill=Fill(Material.TIMBER, "timber")),
    Finish.PLASTIC: Look(
        Material.PLASTIC, "plastics", 0.40, bevel=0.03, glow=0.3,
        fill=Fill(Material.PLASTIC, "plastics", 0.01),
    ),
    Finish.RUBBER: Look(
        Material.RUBBER, "rubber", 0.30, bevel=0.12, fill=Fill(Material.PLASTIC, "plastics", -0.10)
    ),
    Finish.PADDLE: Look(Material.PADDLE, "paddle", 0.33),
    Finish.PRISM: Look(Material.ACRYLIC, "prisms", 0.34, glow=0.75, flashes=True, flash_reach=1.9),
    Finish.BUMPER: Look(Material.BUMPER, "cylinders", 0.38, glow=1.0, flashes=True, flash_reach=1.9),
    Finish.TARGET: Look(Material.TARGET, "targets", 0.46, bevel=0.03, glow=0.35, flashes=True),
    Finish.ROLLOVER: Look(Material.INSERT, "inserts", 0.012, bevel=0.006, glow=0.5, flashes=True),
    Finish.GATE: Look(Material.STEEL, "metal", 0.58, bevel=0.03),
    Finish.SPINNER: Look(Material.BLADE, "spinner", 0.58, bevel=0.03),
    Finish.HOLE: Look(Material.PIT, "hole", 0.012, bevel=0.006, flashes=True),
    Finish.PLUNGER: Look(Material.STEEL, "metal", 0.36, bevel=0.08),
    Finish.RAMP: Look(Material.MOUTH, "mouth", 0.012, bevel=0.006, flashes=True),
}  # fmt: skip
"""One row for each finish; a test refuses a finish without one."""
