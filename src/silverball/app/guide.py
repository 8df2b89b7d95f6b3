"""The first game guides: at most three hints, each when it helps, and never again after that game.

the ball lies on the plunger        HOLD SPACE, THEN LET GO
it rolls                            HOLD A OR D … LET GO
a lamp blinks while it rolls        SHOOT THE BLINKING LIGHT
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from silverball.game.view import Phase

if TYPE_CHECKING:
    from silverball.game.core import GameCore

MOST_HINTS = 3
GAP = 4.0  # [s] between two hints
WAIT, AGAIN = 2.0, 5.0  # [s] a ball waits on the plunger before the reminder, and between two of them


class PlungerReminder:
    """Reminds, in any game, of a ball that waits on the plunger: one that was saved, or one of a multiball.

    Args:
        game: The game.
        key_label: Returns the key of an action as the display writes it.
    """

    def __init__(self, game: GameCore, key_label: Callable[[str], str]) -> None:
        self._game = game
        self._key_label = key_label
        self._next_tick: int | None = None  # None: no ball waits

    def hint(self) -> str:
        """The reminder, if a ball has waited for long; empty if not."""
        game = self._game
        if not game.has_ball_to_launch or game.is_launch_held:
            self._next_tick = None
            return ""
        if self._next_tick is None:
            self._next_tick = game.tick + round(WAIT * game.tick_rate)
        if game.tick < self._next_tick:
            return ""
        self._next_tick = game.tick + round(AGAIN * game.tick_rate)
        return launch_text(self._key_label)


def launch_text(key_label: Callable[[str], str]) -> str:
    """How a ball is launched."""
    return f"HOLD {key_label('create')}, THEN LET GO"


class Guide:
    """The hints of a first game.

    Args:
        game: The game.
        key_label: Returns the key of an action as the display writes it.

    Attributes:
        shown: How many hints have been shown.
    """

    def __init__(self, game: GameCore, key_label: Callable[[str], str]) -> None:
        self._game = game
        self._key_label = key_label
        self._done: set[str] = set()
        self._next_tick = 0
        self.shown = 0

    def hint(self) -> str:
        """The hint for this moment; empty if there is none."""
        game = self._game
        if self.shown >= MOST_HINTS or game.tick < self._next_tick or game.phase is not Phase.PLAY:
            return ""
        for name, text in self._hints():
            if name not in self._done:
                self._done.add(name)
                self.shown += 1
                self._next_tick = game.tick + round(GAP * game.tick_rate)
                return text
        return ""

    def _hints(self) -> list[tuple[str, str]]:
        """The hints that would help now."""
        game, hints = self._game, []
        rolling = [ball for ball in game.world.balls if any(ball.velocity)]
        if game.has_ball_to_launch and not rolling:
            hints.append(("launch", launch_text(self._key_label)))
        if rolling:  # said while it is still far from the paddles, so that there is time to read
            left, right = self._key_label("left"), self._key_label("right")
            hints.append(("paddles", f"HOLD {left} OR {right} … LET GO"))
            if "blinking" in game.lamps.values():
                hints.append(("light", "SHOOT THE BLINKING LIGHT"))
        return hints
