"""How is a replay played again? From its beginning, or from any moment, as fast as one likes.

`ReplayPlayer` owns a `Game` and gives it the recorded inputs. `seek` goes to any tick: every few seconds of
play the game is saved, so that going back costs little however long the game was.
"""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING

from silverball.errors import SilverballError
from silverball.game.game import Game
from silverball.game.replay.lines import Input, read

if TYPE_CHECKING:
    from silverball.game.replay.format import Replay

SNAPSHOT_SECONDS = 2  # of play between two saved moments; chosen: a few ms to play, 3 MB for an hour


class InputRefusedError(SilverballError):
    """A recorded input could not be given to the game: it is not the game that was recorded."""


class Playback:
    """A game that is given the inputs of a replay.

    Args:
        replay: What is played.

    Attributes:
        game: The game, at the moment that has been reached.
        replay: What is played.
        at_end: Whether all of the replay has been played.
    """

    def __init__(self, replay: Replay) -> None:
        self.replay = replay
        self.game = Game(replay.table, replay.seed, replay.mode, replay.tick_rate, record=False)
        self.at_end = False
        self._held = (False, False)
        self._second = -1  # the one that the inputs below belong to
        self._inputs: list[Input] = []
        self._next = 0
        self._begin_second(0)

    @property
    def tick(self) -> int:
        """Ticks played so far."""
        return self.game.tick

    def advance(self, ticks: int = 1) -> None:
        """Play on with the recorded inputs, at most to the end, and end there as the game did.

        Raises:
            InputRefusedError: An input could not be given to the game, so it is not the one recorded.
        """
        self.play(ticks)
        if not self.at_end and (self.tick >= self.replay.ticks or self.game.is_over):
            self.finish()

    def play(self, ticks: int) -> None:
        """Play on, but leave out what comes after the last tick."""
        rate = self.replay.tick_rate
        target = min(self.tick + max(ticks, 0), self.replay.ticks)
        while self.tick < target and not self.game.is_over:
            if self.tick // rate != self._second:
                self._begin_second(self.tick // rate)
            self._give_inputs()
            following = self._inputs[self._next].tick if self._next < len(self._inputs) else rate
            stop = min(target, self._second * rate + following)
            self.game.step(*self._held, ticks=stop - self.tick)

    def jump(self, state: bytes) -> None:
        """Go on from a moment at the beginning of a second, as `Game.save` gave it."""
        self.game.restore(state)
        self._held = self.game.held
        self.at_end = False
        self._begin_second(self.tick // self.replay.tick_rate)

    def _begin_second(self, second: int) -> None:
        lines = self.replay.lines
        line = lines[second].partition(" ")[2] if second < len(lines) else self.replay.tail
        self._second, self._inputs, self._next = second, list(read(line)), 0

    def _give_inputs(self) -> None:
        """Give the game what the player did before its next tick."""
        at = self.tick - self._second * self.replay.tick_rate
        while self._next < len(self._inputs) and self._inputs[self._next].tick == at:
            kind = self._inputs[self._next].kind
            self._next += 1
            left, right = self._held
            if kind == "L":
                self._held = (not left, right)
            elif kind == "R":
                self._held = (left, not right)
            else:
                self._act(kind)

    def _act(self, kind: str) -> None:
        what = "a new ball" if kind == "+" else "a shove"
        try:
            if kind == "+":
                self.game.create_ball()
            elif not self.game.jitter():
                raise SilverballError("the table is tilted, or was shoved already")
        except SilverballError as error:
            raise InputRefusedError(f"tick {self.tick}: {what} was recorded, but {error}") from None

    def finish(self) -> None:
        """The last tick has been played: give the inputs that came after it, and end the game."""
        if self.tick == self.replay.ticks:
            if self.tick // self.replay.tick_rate != self._second:
                self._begin_second(self.tick // self.replay.tick_rate)
            self._give_inputs()
        self.at_end = True
        if self.replay.ended == "stopped":
            self.game.end()


class ReplayPlayer(Playback):
    """A replay to watch: on, back, to any tick.

    Args:
        replay: What is watched.

    Attributes:
        game: The game at the moment that is shown. It stays the same object.
        replay: What is watched.
        at_end: Whether the end has been reached.
        ticks: How long the replay is.
    """

    def __init__(self, replay: Replay) -> None:
        super().__init__(replay)
        self.ticks = replay.ticks
        self._scout = Playback(replay)  # plays ahead and saves moments
        self._every = SNAPSHOT_SECONDS * replay.tick_rate
        self._ticks = [0]
        self._moments = [self.game.save()]

    def prepare(self, ticks: int) -> float:
        """Play some ticks ahead, unseen, so that `seek` is quick up to there.

        Call it now and then while something else is shown: an hour of play takes about a second in all.

        Args:
            ticks: How many, at most.

        Returns:
            The share of the replay that is ready, 0 to 1.
        """
        self._scout_to(self._scout.tick + ticks)
        return 1.0 if self._scout.at_end else self._scout.tick / max(self.ticks, 1)

    def seek(self, tick: int) -> None:
        """Go to the moment before this tick; beyond the end, to the end.

        Events and news of the way are dropped.
        """
        tick = min(max(tick, 0), self.ticks)
        if tick > self._ticks[-1] + self._every:
            self._scout_to(tick)
        number = bisect_right(self._ticks, tick) - 1
        if not self._ticks[number] <= self.tick <= tick:
            self.jump(self._moments[number])
        self.advance(tick - self.tick)
        self.game.take_world_events()
        self.game.take_game_events()

    def _scout_to(self, tick: int) -> None:
        scout = self._scout
        while scout.tick < tick and not scout.at_end:
            following = self._ticks[-1] + self._every
            scout.advance(min(following, tick) - scout.tick)
            if scout.tick == following and not scout.at_end:
                self._ticks.append(scout.tick)
                self._moments.append(scout.game.save())
