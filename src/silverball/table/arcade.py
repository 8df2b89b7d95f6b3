"""The rules of an arcade game on a table."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import model_validator

from silverball.table.model import SINCE_2, Model
from silverball.table.quantity import Count, Quantity, refuse

MOST_POINTS = 1_000_000_000_000  # for a medal


class Arcade(Model):
    """The rules of an arcade game on this table; free play ignores them."""

    balls: Annotated[int, Count(1, 99, "balls")] = 3
    """Balls of a game. With three the reflex player lasts for two minutes."""
    ball_save: Annotated[float, Quantity(0.0, 60.0, "s")] = 5.0
    """[s] a ball that is lost within this time of its start is returned to the player; 0: never. A second
    ball launched while the first is in play is not. Choose a little less than an unplayed ball lasts (about
    8 s)."""
    ball_saves: Annotated[int, Count(0, 9, "times")] = 1
    """How often the same ball is returned; with 1 a returned ball is not saved again."""
    combo_window: Annotated[float, Quantity(0.0, 10.0, "s")] = 1.0
    """[s] a scoring hit within this time of the previous one continues the combo; 0: no combos. With 1 s on
    the built-in tables six hits of ten continue a combo."""
    combo_step: Annotated[int, Count(1, 100, "hits")] = 3
    """Hits that raise the factor of a combo by one: with 3 the first to third count once, the fourth to sixth
    twice, and so on."""
    combo_limit: Annotated[int, Count(1, 100)] = 5
    """The greatest factor of a combo; 1: combos are counted but pay nothing."""
    double: Annotated[int, Count(1, 100)] = 2
    """The factor while two balls are on the board. The second ball is one of the remaining balls and is not
    saved, so this rewards the risk."""
    tilt_decay: Annotated[float, Quantity(0.1, 60.0, "s")] = 1.5
    """[s] time in which the swing of the tilt bob falls to 1/e. Each shove adds 1 to the swing."""
    tilt_warning: Annotated[float, Quantity(0.0, 1000.0)] = 1.5
    """A shove that swings the bob further than this gives a warning. With 1.5 and a decay of 1.5 s a second
    shove within a second does, a single one never; below 1 every shove does."""
    tilt_limit: Annotated[float, Quantity(0.0, 1000.0)] = 2.4
    """A swing further than this is a tilt: the paddles are dead and nothing scores until the board is
    empty. With 2.4 the third of three quick shoves is a tilt."""
    warnings: Annotated[int, Count(0, 99, "warnings")] = 2
    """Warnings per ball; the next one after the last of them is a tilt."""
    un_stick: Annotated[float, Quantity(0.5, 60.0, "s")] = 3.0
    """[s] how long a ball lies still before the machine shoves it. A ball within reach of the paddles is left
    alone while a button is held: the player has caught it."""
    stall: Annotated[float, Quantity(1.0, 600.0, "s")] = 20.0
    """[s] time without a scoring hit after which the machine shoves in any case, so that a ball cannot be
    held forever; longer than any player needs to aim."""
    bronze: Annotated[int, Count(0, MOST_POINTS, "points"), SINCE_2] = 0
    """Points for a bronze medal; 0: this table has no medals. Choose what a beginner reaches."""
    silver: Annotated[int, Count(0, MOST_POINTS, "points"), SINCE_2] = 0
    """Points for a silver medal, more than for bronze. Choose what a good game reaches."""
    gold: Annotated[int, Count(0, MOST_POINTS, "points"), SINCE_2] = 0
    """Points for a gold medal, more than for silver. Choose what takes many evenings."""

    @model_validator(mode="after")
    def _rising_medals(self) -> Self:
        medals = (self.bronze, self.silver, self.gold)
        if any(medals) and not 0 < self.bronze < self.silver < self.gold:
            refuse(
                "bronze, silver and gold must be three points that rise, or all be left out, "
                f"got {', '.join(map(str, medals))}"
            )
        return self
