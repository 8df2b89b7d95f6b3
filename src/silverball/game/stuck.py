"""When does the machine shove the balls by itself? When one lies still, or when nothing has scored for long.

The game looks four times a second, at ticks that depend on nothing but the tick rate. A ball that is found
where it was is still: it lies, or it hops on one spot. Where the paddles reach, a ball is the player's while
a button is held or was let go a moment ago; but who holds it too long without scoring gets a shove too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from silverball.game.rules import RuleConfig

LOOKS = 4  # a second
STILL_DISTANCE = 0.03  # [u] a ball that stays within it lies still; it hops by less than 0.001 u


class Rest(NamedTuple):
    """Where a ball was last seen to move.

    Attributes:
        ball: Its id.
        x: Up the table [u].
        z: Across [u].
        since: The tick of that look.
    """

    ball: int
    x: float
    z: float
    since: int


class Watch(NamedTuple):
    """What is remembered from look to look.

    Attributes:
        rests: Of every ball on the board.
        released: When a button was last let go.
        shoved: When the machine last shoved.
    """

    rests: tuple[Rest, ...] = ()
    released: int = 0
    shoved: int = 0


def looked(watch: Watch, balls: Iterable[tuple[int, float, float]], tick: int) -> Watch:
    """The watch after a look at the balls (id, x, z) on the board."""
    before = {rest.ball: rest for rest in watch.rests}
    rests = []
    for ball, x, z in balls:
        seen = before.get(ball)
        lies = seen is not None and abs(x - seen.x) + abs(z - seen.z) < STILL_DISTANCE
        rests.append(seen if seen is not None and lies else Rest(ball, x, z, tick))
    return watch._replace(rests=tuple(rests))


def still_ball(watch: Watch, laws: RuleConfig, tick: int) -> bool:
    """Whether a ball lies still for as long as a table lets it."""
    return any(tick - rest.since >= laws.un_stick for rest in watch.rests)


def wants_shove(
    watch: Watch, laws: RuleConfig, tick: int, *, held: bool, reach: float, quiet_since: int | None
) -> bool:
    """Whether the machine shoves now.

    Args:
        watch: After the look of this tick.
        laws: Of the game.
        tick: Now.
        held: Whether a button is held and moves its paddle.
        reach: No paddle reaches a ball above this x [u].
        quiet_since: When there last was a hit that scores, or a new ball; None: nothing on this table scores.
    """
    if not watch.rests or tick - watch.shoved < laws.un_stick:
        return False
    if quiet_since is not None and tick - quiet_since >= laws.stall:
        return True
    caught = held or tick - watch.released < laws.un_stick
    return any(
        tick - rest.since >= laws.un_stick and not (caught and rest.x <= reach) for rest in watch.rests
    )


def shoved(watch: Watch, tick: int) -> Watch:
    """The watch after a shove of the machine."""
    return watch._replace(rests=tuple(rest._replace(since=tick) for rest in watch.rests), shoved=tick)
