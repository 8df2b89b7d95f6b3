"""What is one game? A world, the log of its inputs, and what to tell the player. No window in here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from silverball.app.controls import Held
from silverball.app.inputlog import Change, InputLog
from silverball.errors import SilverballError

if TYPE_CHECKING:
    from silverball.table import Table
    from silverball.world import Event, World

TICK_RATE = 240
STILL_SECONDS = 3.0  # a ball that has not moved for so long brings a hint
STILL_DISTANCE = 0.03  # [u] a ball that stays within it lies still; it hops by less than 0.001 u


class Session:
    """One game on one board, from the first ball to the next board.

    Args:
        table: A finished table.
        seed: Of the world.
        tick_rate: Ticks per second.
    """

    def __init__(self, table: Table, seed: int, tick_rate: int = TICK_RATE) -> None:
        from silverball.world import World

        self.world: World = World(table, seed, tick_rate)
        self.log = InputLog.begin(self.world)
        self._held = {"left": False, "right": False}
        self._shove = False
        self._events: list[Event] = []
        self._resting: dict[
            int, tuple[float, float, int]
        ] = {}  # ball → where it was last seen to move, and when

    def advance(self, held: Held, ticks: int) -> None:
        """Play on.

        Args:
            held: The paddle buttons; a tap holds a paddle for one tick.
            ticks: How many ticks.

        Raises:
            FaultError: The world has stopped; the log tells how to get there.
        """
        if ticks <= 0:
            return
        if held.first == held.rest:
            self._step(held.rest, ticks)
        else:
            self._step(held.first, 1)
            if ticks > 1:
                self._step(held.rest, ticks - 1)
        self._watch_balls()

    def create_ball(self) -> None:
        """Put a ball on the board.

        Raises:
            BoardFull, NoRoom: There cannot be one more; the message says why.
        """
        self.world.create_ball()
        self._events.append(self.world.events[-1])  # before it stand those of the last step, taken already
        self.log.changes.append(Change(self.world.tick, "create"))

    def jitter(self) -> None:
        """Shove the balls at the next tick.

        Raises:
            SilverballError: There is no ball to shove.
        """
        if not self.world.balls:
            raise SilverballError("there is no ball to shove; Space brings one")
        if not self._shove:
            self._shove = True
            self.log.changes.append(Change(self.world.tick, "jitter"))

    def take_events(self) -> list[Event]:
        """What happened since this was last asked."""
        events, self._events = self._events, []
        return events

    @property
    def has_still_ball(self) -> bool:
        """Whether a ball has been lying still for three seconds."""
        limit = self.world.tick - STILL_SECONDS * self.world.tick_rate
        return any(since <= limit for _, _, since in self._resting.values())

    def _step(self, buttons: tuple[bool, bool], ticks: int) -> None:
        world = self.world
        for kind, down in zip(("left", "right"), buttons, strict=True):
            if down != self._held[kind]:
                self._held[kind] = down
                self.log.changes.append(Change(world.tick, kind, down))
        shove, self._shove = self._shove, False
        world.step(*buttons, jitter=shove, ticks=ticks)
        self._events.extend(world.events)

    def _watch_balls(self) -> None:
        world, resting = self.world, self._resting
        self._resting = {}
        for ball in world.balls:
            x, _, z = ball.position
            seen = resting.get(ball.id)
            lies = seen is not None and abs(x - seen[0]) + abs(z - seen[1]) < STILL_DISTANCE
            self._resting[ball.id] = seen if seen is not None and lies else (x, z, world.tick)
