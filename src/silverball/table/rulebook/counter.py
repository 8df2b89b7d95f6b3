"""Counters: whole numbers that rules raise, compare and multiply by."""

from __future__ import annotations

from typing import Annotated

from silverball.table.model import Model
from silverball.table.quantity import Count
from silverball.table.rulebook.names import OwnName, Span

MOST = 1_000_000_000


class Counter(Model):
    """A whole number from 0 up: locks, letters, the value of a spinner, the bonus.

    The machine has counters of its own. `combo` (hits in a row; adding to it begins its time anew),
    `locked` (balls off the table) and `extra_balls` may be changed. The others can only be read:
    `combo_factor` and `ball_factor` (what `[arcade]` pays for a combo, and for two balls in play), `ball`
    (the number of the present ball), `balls_left` (balls after it), `in_play` (balls in play) and
    `warnings`.
    """

    name: OwnName
    """The name by which rules speak of it."""
    begins: Annotated[int, Count(0, MOST)] = 0
    """Its value at the start of a game, and of each ball if it lasts for a ball."""
    most: Annotated[int, Count(1, MOST)] = MOST
    """Its greatest value; adding more leaves it there."""
    lasts: Span = "game"
    """Whether it keeps its value until the ball is lost, or until the game is over."""
