"""Rules: when this happens, and that holds, do the following."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from silverball.table.model import Model, Name
from silverball.table.primitive import Point
from silverball.table.quantity import Count, FixedList, Quantity
from silverball.table.rulebook.names import NO_NUMBERS, Increments, Names, Seconds, Thresholds, Values

MOST_BALLS = 8  # of a table; as many as a world has room for

BUTTONS = ("left", "right", "launch")
MOMENTS = ("start", "launch", "drain", "save", "lost", "end", "warning", "tilt")
ANY_PART = "any"

VELOCITY = FixedList(Quantity(-100.0, 100.0, "u/s"), 2, "[vx, vz]")
Text = Annotated[str, Field(max_length=40)]


class Rule(Model):
    """A rule: each of its triggers sets it off; if all its conditions hold, all its effects happen.

    Rules act at the end of the tick, on its events in their order. For one trigger, the conditions of all
    rules are looked at first, and then the rules whose conditions hold act in the order of the file; the
    effects of a rule happen in the order of this list. What they set off in turn (a mode that ends, a
    counter that is reached) follows when all of them have acted. While the table is tilted no rule acts.
    """

    name: Name = ""
    """A sentence for people."""

    on_hit: Names = ()
    """Parts that a ball hits, crosses or falls into, or a spinner that turns: names, places such as
    `cylinder[2]`,
    banks, or `any` for every part with points."""
    on_release: Names = ()
    """Holes and plungers that have sent off a ball."""
    on_down: Names = ()
    """Banks whose last drop target has fallen."""
    on_complete: Names = ()
    """Groups whose lamps are all on now."""
    on_count: Thresholds = NO_NUMBERS
    """Counters that have reached this value from below."""
    on_start: Names = ()
    """Modes that have started."""
    on_end: Names = ()
    """Modes that have ended, by their time or by a rule."""
    on_time: Names = ()
    """Modes whose time has run out; before `on_end`."""
    on_press: Names = ()
    """Buttons that are pressed: `left`, `right` or `launch`."""
    on_ball: Names = ()
    """Moments of a ball: `start` (one starts on the empty table), `launch` (a plunger has launched it),
    `drain` (it
    has left the table; what happens now can still save it), `save` (it comes back), `lost` (others are in
    play), `end` (it was the last one in play), `warning` and `tilt`."""

    if_lit: Names = ()
    """Lamps that are on or blinking; of a group all of them."""
    if_blinking: Names = ()
    """Lamps that are blinking; of a group all of them."""
    if_unlit: Names = ()
    """Lamps that are off; of a group all of them."""
    if_running: Names = ()
    """Modes that run."""
    if_stopped: Names = ()
    """Modes that do not run."""
    if_at_least: Thresholds = NO_NUMBERS
    """Counters with this value or a greater one."""
    if_below: Thresholds = NO_NUMBERS
    """Counters with a smaller value."""

    add: Increments = NO_NUMBERS
    """Add to counters; a negative number subtracts, and none falls below 0."""
    set: Values = NO_NUMBERS
    """Set counters."""
    award: Annotated[int, Count(0, 1_000_000_000, "points")] = 0
    """Points to give, multiplied by `times`."""
    award_part: Annotated[bool, Field(strict=True)] = False
    """Whether to give the points of the part that was hit, multiplied by `times`."""
    times: Names = ()
    """Counters by whose values the points are multiplied: a value that grows, or the factors of combos."""
    light: Names = ()
    """Switch lamps on."""
    blink: Names = ()
    """Let lamps blink."""
    unlight: Names = ()
    """Switch lamps off."""
    light_next: Names = ()
    """Switch on the first lamp of a group that is not on."""
    advance: Names = ()
    """Let the next lamp of a group blink that is off, in place of the one that blinks."""
    rotate_left: Names = ()
    """Let each lamp of a group take the state of the next one, the last that of the first."""
    rotate_right: Names = ()
    """The same in the other direction."""
    start: Names = ()
    """Start modes."""
    stop: Names = ()
    """Stop modes that run."""
    extend: Seconds = NO_NUMBERS
    """[s] Lengthen modes that run and have a time."""
    save: Annotated[float, Quantity(0.0, 60.0, "s")] = 0.0
    """[s] For this time every ball in play that is lost comes back, once."""
    extra_ball: Annotated[int, Count(0, 9, "balls")] = 0
    """Extra balls: the same ball is played again."""
    kick: Annotated[Point, VELOCITY] | None = None
    """[u/s] Send off the ball that set off the rule with this velocity, [vx, vz], as a kickback does."""
    lock: Annotated[bool, Field(strict=True)] = False
    """Whether the ball that a hole has just caught is taken off the table: `locked` grows by one, and
    another ball comes
    in its place."""
    eject: Names = ()
    """Let holes send off the balls that they hold, now."""
    reset: Names = ()
    """Let banks of drop targets come back; a bank waits until no ball is in its way."""
    open: Names = ()
    """Open held gates."""
    close: Names = ()
    """Close held gates; a gate waits until no ball is in its way."""
    multiball: Annotated[int, Count(0, MOST_BALLS, "balls")] = 0
    """Bring balls until this many are in play; on a table with a plunger they lie there one after the
    other, until the player or its `auto_launch` launches them."""
    message: Text = ""
    """A text for the display."""
    cue: Text = ""
    """The name of a light show ([which there are](look.md#light-shows)), of a call ([which there
    are](sound.md#calls)), or of both."""


TRIGGERS = tuple(name for name in Rule.model_fields if name.startswith("on_"))
CONDITIONS = tuple(name for name in Rule.model_fields if name.startswith("if_"))
EFFECTS = tuple(name for name in Rule.model_fields if name not in (*TRIGGERS, *CONDITIONS, "name"))
