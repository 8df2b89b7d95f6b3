"""Every tolerance of the solver: its unit, why it has this value, and what goes wrong with another one."""

from math import inf

NEVER = inf
"""[s] The time of a contact that does not happen."""

CONTACT_GAP = 1e-13
"""[u] A gap at most this wide counts as closed; one Newton step then removes the rest. Coordinates reach 10
u, where doubles are 1.8e-15 apart, and a gap carries a few such errors. Smaller: a search may never find
its gap closed and ends by its cap. Larger: the polish starts further out and grazing hits lose digits."""

POLISH_TIME = 1e-7
"""[s] The longest Newton step that removes the rest of a gap. In this time curvature and gravity bend a
flight by less than 1e-11 u. Longer: a flat graze would be thrown past the surface it touches. Shorter: slow
hits lose digits."""

HOP = 5e-4
"""[u] Height of the hop that a touch leaves at least, so that a resting ball does not bounce ever faster.
Under gravity 10 u/s² a hop takes 0.02 s, 50 events a second, and is 1/1000 of a ball high: nobody sees it.
Smaller: more events for a ball at rest. Larger: a ball at rest is seen to tremble. Source: chosen."""

LEAST_HOP = 1e-9
"""[u/s] And at least this speed: where nothing pulls, a ball that has lost its speed towards a wall must not
be left with a rounding of it, or it would meet the wall without end. Roundings reach 1e-14 u/s. Smaller: it
would. Larger: energy grows by half its square a touch."""

HOP_SHARE = 0.9
"""A hop is at most this share of `hit_speed`, so that it never comes back as a hit. Source: chosen."""

LEAST_ADVANCE_GAP = 2e-10
"""[u] A search that can find no step forward advances at least by the time in which the greatest
acceleration moves a ball this far. Several such advances may follow each other: in 1e8 frames on hostile
boards 5e-10 led to a depth of 1.001e-9 u once, hence a fifth of the promise of 1e-9 u. Smaller: more null
events along a grazed, turning paddle. Larger: visible only to the audit, but the promise would break."""

FLIGHT_STEPS = 48
"""Safe steps per search; then the search says "free up to here" and the ball is flown there, a null event.
An ordinary contact takes 1 to 4; a graze halves its distance every step, so 48 cover 14 digits."""

JAM_EVENTS = 64
JAM_EVENT_RATE = 6000.0
"""Events of one ball in one tick, and the more of them for every second of the tick [1/s], after which it
counts as jammed. A ball at rest needs 50 a second, one carried by a paddle without restitution some 3000.
Smaller: free balls are held by mistake. Larger: a pinched ball costs more time."""

JAM_SHARE = 4
"""The two balls are in one jam if as many of these events as one by this were meetings of theirs. A ball
between the other one and a wall has a half, in a corner a third. Smaller: a ball that presses the jammed one
goes on pressing. Larger: a ball that only lies on the jammed one is stopped with it."""

JAM_GAP = 1e-3
"""[u] A paddle this close to a jammed ball takes part in the jam and stalls."""

FREE_GAP = 1e-9
"""[u] A ball is created only where it keeps at least this distance from everything, so that it starts
clear."""

CREATE_TRIES = 32
"""Random places that are tried before the search turns systematic."""

PLACE_STEPS = 4
"""The systematic search looks at this many by this many points of every cell of the board."""

CAP_MARGIN = 1.0 - 4.5e-16
"""A clamped speed is multiplied by this too, so that rounding cannot leave it above the cap."""

CREEP = 1e-9
"""[u/s] A lowest point that moves no faster than this does not slip: the ball rolls. Rounding leaves some
1e-15 u/s of slip on a ball that rolls. Smaller: a rolling ball is taken for a slipping one. Larger: a slow
slip ends early."""

GRID_CELL = 1.0
"""[u] Side of a grid's cell, at the longest. Smaller: shorter lists, more memory. Source: measured."""

SKIN = 2.0
"""[u] A flight is searched for contacts this far ahead. Smaller: more searches. Larger: longer lists."""

SEARCH_TIME = 0.25
"""[s] And no longer than this. Source: measured."""

LIGHT = 0.1
"""[u/s²] Under less gravity than this a search may be longer: a ball may hang about for hours, and a flight
must not come to consist of a million searches. Smaller: it would. Larger: no harm, but other bits."""

LONGEST_SEARCH = 1e4
"""[s] No search is longer. Smaller: more searches for a ball at rest that nothing pulls. Larger: times lose
digits."""

SKIN_SHARE = 0.5
"""Where parts stand close, `skin` is this share of the mean distance between them. Source: measured."""

CELL_SHARE = 0.5
"""And a cell's side this share of it. Source: measured."""

DEEPEST = 1e-9
"""[u] The promise: no ball is ever deeper inside anything. A state from outside in which one is stops."""
