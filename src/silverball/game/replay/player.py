"""Playing a replay again: from its beginning or from any moment, as fast as the machine can.

`ReplayPlayer` owns a game and applies the recorded inputs to it. `seek` goes to any tick: the game is saved
at intervals, so going back is quick however long the game was.
"""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING

from silverball.errors import SilverballError, StateError
from silverball.game.core import GameCore
from silverball.game.replay.recording import BALL, LAUNCH, LEFT, NUDGES, RIGHT, SHOVE, Input, parse_inputs

if TYPE_CHECKING:
    from silverball.game.replay.format import Replay
    from silverball.game.rules import Rules

SNAPSHOT_SECONDS = 2  # [s] of play between snapshots: replaying it takes a few ms, an hour needs 3 MB

DIRECTIONS = {kind: direction for direction, kind in NUDGES.items()}


class InputRefusedError(SilverballError):
    """The game refused a recorded input, so it is not the game that was recorded."""


class Playback:
    """A game that is played with the inputs of a replay.

    Args:
        replay: The replay.
        rules: The rules that scored it, if they are not built in.

    Attributes:
        game: The game, at the moment that has been reached.
        replay: The replay.
        at_end: Whether all of the replay has been played.

    Raises:
        StateError: The rules are missing, or are not those of the replay.
        SilverballError: The table of the replay cannot be played.
    """

    def __init__(self, replay: Replay, rules: Rules | None = None) -> None:
        check_rules(replay, rules)
        self.replay = replay
        self.game = GameCore(
            replay.table, replay.seed, replay.mode, replay.tick_rate, rules=rules, players=replay.players
        )
        self.at_end = False
        self._held, self._is_launch_held = (False, False), False
        self._second = -1  # the one that the inputs below belong to
        self._inputs: list[Input] = []
        self._next = 0
        self._begin_second(0)

    @property
    def tick(self) -> int:
        """Ticks played so far."""
        return self.game.tick

    def advance(self, ticks: int = 1) -> None:
        """Advance with the recorded inputs, at most to the end; there the game ends as recorded.

        Raises:
            InputRefusedError: The game refused an input, so it is not the game that was recorded.
        """
        self.play(ticks)
        if not self.at_end and (self.tick >= self.replay.ticks or self.game.is_over):
            self.finish()

    def play(self, ticks: int) -> None:
        """Advance with the recorded inputs, without those that come after the last tick."""
        rate = self.replay.tick_rate
        target = min(self.tick + max(ticks, 0), self.replay.ticks)
        while self.tick < target and not self.game.is_over:
            if self.tick // rate != self._second:
                self._begin_second(self.tick // rate)
            self._apply_inputs()
            following = self._inputs[self._next].tick if self._next < len(self._inputs) else rate
            stop = min(target, self._second * rate + following)
            self.game.step(*self._held, ticks=stop - self.tick, launch=self._is_launch_held)

    def jump(self, state: bytes) -> None:
        """Go to a state of `GameCore.save` that was saved at the beginning of a second."""
        self.game.restore(state)
        self._held, self._is_launch_held = self.game.held, self.game.is_launch_held
        self.at_end = False
        self._begin_second(self.tick // self.replay.tick_rate)

    def _begin_second(self, second: int) -> None:
        lines = self.replay.lines
        line = lines[second].partition(" ")[2] if second < len(lines) else self.replay.tail
        self._second, self._inputs, self._next = second, list(parse_inputs(line)), 0

    def _apply_inputs(self) -> None:
        """Apply the inputs before the next tick of the game."""
        at = self.tick - self._second * self.replay.tick_rate
        while self._next < len(self._inputs) and self._inputs[self._next].tick == at:
            kind = self._inputs[self._next].kind
            self._next += 1
            left, right = self._held
            if kind == LEFT:
                self._held = (not left, right)
            elif kind == RIGHT:
                self._held = (left, not right)
            elif kind == LAUNCH:
                self._is_launch_held = not self._is_launch_held
            else:
                self._create_or_shove(kind)

    def _create_or_shove(self, kind: str) -> None:
        what = "a new ball" if kind == BALL else "a shove"
        try:
            if kind == BALL:
                self.game.create_ball()
            elif kind != SHOVE and not self.game.world.has_nudge:
                raise SilverballError("the table cannot be nudged")
            elif not self.game.nudge(DIRECTIONS[kind]):
                raise SilverballError("the table is tilted, or was shoved already")
        except SilverballError as error:
            raise InputRefusedError(f"tick {self.tick}: {what} was recorded, but {error}") from None

    def finish(self) -> None:
        """Apply the inputs that come after the last tick, and end the game as recorded."""
        if self.tick == self.replay.ticks:
            if self.tick // self.replay.tick_rate != self._second:
                self._begin_second(self.tick // self.replay.tick_rate)
            self._apply_inputs()
        self.at_end = True
        if self.replay.ended == "stopped":
            self.game.end()


class ReplayPlayer(Playback):
    """A replay that can be watched forwards, backwards and from any tick.

    Args:
        replay: The replay.
        rules: The rules that scored it, if they are not built in.

    Attributes:
        game: The game at the moment that is shown; always the same object.
        replay: The replay.
        at_end: Whether the end has been reached.
        ticks: The length of the replay [ticks].
    """

    def __init__(self, replay: Replay, rules: Rules | None = None) -> None:
        super().__init__(replay, rules)
        self.ticks = replay.ticks
        self._scout = Playback(replay, rules)  # plays ahead and takes snapshots
        self._interval = SNAPSHOT_SECONDS * replay.tick_rate
        self._snapshot_ticks = [0]
        self._snapshots = [self.game.save()]

    def prepare(self, ticks: int) -> float:
        """Play some ticks ahead in the background, so that `seek` is quick up to there.

        Call it repeatedly while something else is shown: an hour of play takes about a second in all.

        Args:
            ticks: How many ticks, at most.

        Returns:
            The fraction of the replay that is ready, 0 to 1.
        """
        self._scout_to(self._scout.tick + ticks)
        return 1.0 if self._scout.at_end else self._scout.tick / max(self.ticks, 1)

    def seek(self, tick: int) -> None:
        """Go to the start of this tick; a tick past the end is clamped to the end.

        The events on the way are dropped.
        """
        tick = min(max(tick, 0), self.ticks)
        if tick > self._snapshot_ticks[-1] + self._interval:
            self._scout_to(tick)
        number = bisect_right(self._snapshot_ticks, tick) - 1
        if not self._snapshot_ticks[number] <= self.tick <= tick:
            self.jump(self._snapshots[number])
        self.advance(tick - self.tick)
        self.game.take_world_events()
        self.game.take_game_events()

    def _scout_to(self, tick: int) -> None:
        scout = self._scout
        while scout.tick < tick and not scout.at_end:
            following = self._snapshot_ticks[-1] + self._interval
            scout.advance(min(following, tick) - scout.tick)
            if scout.tick == following and not scout.at_end:
                self._snapshot_ticks.append(scout.tick)
                self._snapshots.append(scout.game.save())


def check_rules(replay: Replay, rules: Rules | None) -> None:
    """Check that these are the rules that scored a replay; None means the built-in ones.

    Raises:
        StateError: They are not.
    """
    given = "" if rules is None else rules.name
    if given == replay.rules:
        return
    if not replay.rules:
        raise StateError(f"this replay was scored by the built-in rules, not by {given!r}; leave `rules` out")
    if not given:
        raise StateError(
            f"this replay was scored by custom rules, {replay.rules!r}; play it in Python and pass them, "
            "as in replay.verify(rules=…)"
        )
    raise StateError(f"this replay was scored by the rules {replay.rules!r}, not by {given!r}; pass those")
