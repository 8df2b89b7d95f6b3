"""The parts of a table: one frozen model per part, whose attributes are the keys of the TOML file.

    import silverball as sb

    bumper = sb.parts.Cylinder(center=(5.0, 1.5), radius=0.6)
    table = sb.load_table("classic").replace(cylinder=[bumper], board={"gravity": 12.0})

Every field states its unit, its range and its default. Points are (x, z): x runs up the table, z to the
player's right, and the origin is the centre of the board. Lengths are in table units [u], times in seconds,
angles in degrees, counter-clockwise as the player sees the board, from +z (right) towards +x (up).

A constructor refuses unknown names and values out of range with pydantic's `ValidationError`, a `ValueError`.
`replace` makes a changed copy. Whether the parts fit together is checked by `check_table`. Other words in
use: flipper for paddle, bumper for cylinder, kicker for hole, drain for gutter, nudge for jitter.
"""

from silverball.table import kinds
from silverball.table.arcade import Arcade
from silverball.table.kinds import *  # noqa: F403
from silverball.table.recipe import RandomRecipe

__all__ = ["Arcade", "RandomRecipe"]
__all__ += kinds.__all__
