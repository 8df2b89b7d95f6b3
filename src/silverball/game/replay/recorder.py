"""How is a game written down while it is played? One line for every second, see `replay_lines`."""

from __future__ import annotations

from silverball.game.replay.lines import written

PLAY_LIMIT = 4_000_000  # characters of all lines: a day of lively play; robots come to hours
SECONDS_LIMIT = 86_400  # of one game


class Recorder:
    """Writes down what the player does.

    Attributes:
        lines: The full seconds so far: digests and inputs.
        inputs: Those of the second that has begun.
    """

    def __init__(self, tick_rate: int) -> None:
        self.lines: list[str] = []
        self.inputs = ""
        self._tick_rate = tick_rate
        self._last = 0  # the tick of the last input, or of the second's beginning
        self._size = 0

    def note(self, tick: int, kind: str) -> None:
        """The player does something before this tick: "L", "R" (a button changes), "+" or "!"."""
        self.inputs += written(kind, tick - self._last)
        self._last = tick

    def end_second(self, digests: str) -> None:
        """A second has been played, which ended in a state of these digests."""
        line = f"{digests} {self.inputs}" if self.inputs else digests
        self.lines.append(line)
        self._size += len(line) + 1
        self.inputs = ""
        self._last = len(self.lines) * self._tick_rate

    @property
    def is_full(self) -> bool:
        """Whether no more can be written down; a game ends then."""
        return len(self.lines) >= SECONDS_LIMIT or self._size + len(self.inputs) >= PLAY_LIMIT
