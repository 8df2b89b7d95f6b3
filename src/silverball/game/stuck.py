"""Stuck balls: an automatic shove if a ball lies still or if nothing has scored for a long time.

The game checks four times a second, at ticks that depend on the tick rate alone. A ball that has not moved
between two checks is at rest, or hopping in place. A ball within reach of the paddles belongs to the player
while a button is held or was released a moment ago; but a player who holds it too long without scoring gets a
shove too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from silverball.game.rules import RuleConfig

CHECK_RATE = 4  # checks per second
STILL_DISTANCE = 0.03  # [u] a ball that stays within it lies still; hopping moves it by less than 0.001 u


class Rest(NamedTuple):
    """The place that a ball has not left, and since when.

    Attributes:
        ball: The id of the ball.
        x: Position up the table [u].
        z: Position across the table [u].
        since: The tick of that check.
    """

    ball: int
    x: float
    z: float
    since: int


class StuckTracker(NamedTuple):
    """The state that is kept from check to check.

    Attributes:
        rests: One for each ball on the board.
        released: The tick in which a button was last released.
        shoved: The tick of the last automatic shove.
    """

    rests: tuple[Rest, ...] = ()
    released: int = 0
    shoved: int = 0


def updated(tracker: StuckTracker, balls: Iterable[tuple[int, float, float]], tick: int) -> StuckTracker:
    """The tracker after a check of the balls (id, x, z) on the board."""
    before = {rest.ball: rest for rest in tracker.rests}
    rests = []
    for ball, x, z in balls:
        rest = before.get(ball)
        is_still = rest is not None and abs(x - rest.x) + abs(z - rest.z) < STILL_DISTANCE
        rests.append(rest if rest is not None and is_still else Rest(ball, x, z, tick))
    return tracker._replace(rests=tuple(rests))


def has_still_ball(tracker: StuckTracker, config: RuleConfig, tick: int) -> bool:
    """Whether a ball has lain still for as long as the table allows."""
    return any(tick - rest.since >= config.unstick_ticks for rest in tracker.rests)


def needs_shove(
    tracker: StuckTracker, config: RuleConfig, tick: int, *, held: bool, reach: float, quiet_since: int | None
) -> bool:
    """Whether the automatic shove is due now.

    Args:
        tracker: After the check of this tick.
        config: The rule settings of this game.
        tick: The present tick.
        held: Whether a button is held and moves its paddle.
        reach: No paddle reaches a ball above this x [u].
        quiet_since: The tick of the last hit that scored or of the last new ball; None: nothing on this
            table scores.
    """
    if not tracker.rests or tick - tracker.shoved < config.unstick_ticks:
        return False
    if quiet_since is not None and tick - quiet_since >= config.stall_ticks:
        return True
    is_caught = held or tick - tracker.released < config.unstick_ticks
    return any(
        tick - rest.since >= config.unstick_ticks and not (is_caught and rest.x <= reach)
        for rest in tracker.rests
    )


def shoved(tracker: StuckTracker, tick: int) -> StuckTracker:
    """The tracker after an automatic shove."""
    return tracker._replace(rests=tuple(rest._replace(since=tick) for rest in tracker.rests), shoved=tick)
