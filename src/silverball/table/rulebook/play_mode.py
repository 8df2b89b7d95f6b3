"""Modes: what runs for a time, as a mission, a hurry-up or a multiball; a timer is one too."""

from __future__ import annotations

from typing import Annotated, Literal

from silverball.table.model import SINCE_2, Model
from silverball.table.quantity import Quantity
from silverball.table.rulebook.names import OwnName, Span

SHOWN_SECONDS = 10.0
"""A mode that runs for less is a timer of the rules, of which a player is not told."""

ModeColor = Literal["white", "yellow", "orange", "red", "pink", "violet", "blue", "cyan", "green"]


class PlayMode(Model):
    """A mode: it runs or it does not. With `seconds` it is a timer, and ends by itself.

    When it is started again while it runs, its time begins anew. When the last ball in play is lost, a mode
    that lasts for a ball ends without a trigger.
    """

    name: OwnName
    """The name by which rules speak of it; a display shows it unless it runs for less than 10 s."""
    seconds: Annotated[float, Quantity(0.1, 600.0, "s")] | None = None
    """[s] how long it runs; without it, until a rule stops it."""
    begins: Span | None = None
    """Whether it starts by itself with each ball, or with the game."""
    color: Annotated[ModeColor, SINCE_2] = "white"
    """The light of lamps with `color = "mode"` while it runs."""
    lasts: Span = "ball"
    """Whether it ends with the ball, or goes on until the game is over."""

    @property
    def is_shown(self) -> bool:
        """Whether a player is told when it starts and how long it runs."""
        return self.begins is None and (self.seconds is None or self.seconds >= SHOWN_SECONDS)
