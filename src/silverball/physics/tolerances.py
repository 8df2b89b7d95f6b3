"""All tolerances of the solver: unit, reason for the value, and what a smaller or larger one would break."""

from math import inf

NEVER = inf
"""[s] The time of an event that does not happen."""

CONTACT_GAP = 1e-13
"""[u] A gap at most this wide counts as closed; one Newton step then removes the rest. Coordinates reach 10
u, where doubles are 1.8e-15 apart, and a gap carries a few such errors. Smaller: a search may never find
its gap closed and runs into its step limit. Larger: the Newton step starts further out and grazing hits
lose digits."""

NEWTON_TIME = 1e-7
"""[s] The longest Newton step that removes the rest of a gap. In this time curvature and gravity bend a
flight by less than 1e-11 u. Longer: a flat graze would be thrown past the surface it touches. Shorter:
slow hits lose digits."""

HOP = 5e-4
"""[u] Height of the hop that a touch leaves at least, so that a ball at rest does not bounce more and more
often. Under gravity 10 u/s² a hop takes 0.02 s, 50 events a second, and is 1/1000 of a ball high: it is
invisible. Smaller: more events for a ball at rest. Larger: a ball at rest visibly trembles. Source:
chosen."""

MIN_HOP_SPEED = 1e-9
"""[u/s] The smallest speed after a touch: without gravity, a ball that has lost its speed towards a wall must
not keep a rounding error of it, or it would meet the wall forever. Rounding errors reach 1e-14 u/s.
Smaller: that happens. Larger: each touch adds half its square to the energy."""

HOP_SHARE = 0.9
"""A hop is at most this share of `hit_speed`, so that it never comes back as a hit. Source: chosen."""

MIN_ADVANCE_GAP = 2e-10
"""[u] A search that finds no step forward advances at least by the time in which the greatest acceleration
moves a ball this far. Several such advances may follow each other: in 1e8 frames on hostile boards 5e-10
led to a depth of 1.001e-9 u once, hence a fifth of the guarantee of 1e-9 u. Smaller: more null events
along a grazed, turning paddle. Larger: only the audit would see it, but the guarantee would not hold."""

FLIGHT_STEPS = 48
"""Safe steps per search; after that the search reports "no contact up to here", a null event. An ordinary
contact takes 1 to 4; a graze halves its distance every step, so 48 cover 14 digits."""

JAM_EVENTS = 64
JAM_EVENT_RATE = 6000.0
"""A ball counts as jammed after JAM_EVENTS events in one tick, plus JAM_EVENT_RATE per second of tick [1/s].
A ball at rest needs 50 a second, one carried by a paddle without restitution some 3000. Smaller: free
balls are held by mistake. Larger: a pinched ball costs more time."""

JAM_SHARE = 4
"""Both balls jam together if at least 1/JAM_SHARE of these events were contacts between them. A ball
between the other one and a wall has a share of one half, in a corner of one third. Smaller: a ball that
presses the jammed one continues to press. Larger: a ball that only lies on the jammed one is stopped with
it."""

JAM_GAP = 1e-3
"""[u] A paddle this close to a jammed ball takes part in the jam and stalls."""

MAX_CREEP = 1e-11
"""[u] depth of a jammed ball in a paddle on a coil above which the paddle turns back. Larger than the
rounding of a contact, far smaller than `MAX_DEPTH`."""

MAX_TURN_BACK = 1e-6
"""[rad] the most by which it turns back."""

MAX_PUT_BACK = 1e-10
"""[u] the most by which a ball that has sunk into a coil's paddle is put back, where the paddle cannot turn
back from it; it sinks by some 1e-11 u in a tick."""

FREE_GAP = 1e-9
"""[u] A ball is created only at this distance from everything or more, so that it starts clear."""

CROSSED_GAP = 1e-9
"""[u] A flight that starts this close to a line, or to the edge of a disc, has crossed it already; one that
starts this deep below the blocked side of a one-way part still lies on it. Rounding leaves a ball within
1e-14 u of what it crossed or met. Smaller: a ball that is set down on a line by hand crosses it again.
Larger: a flight that starts just before a line misses it."""

CREATE_TRIES = 32
"""Random places that are tried before the search turns systematic."""

PLACE_STEPS = 4
"""The systematic search tries a square of PLACE_STEPS by PLACE_STEPS points in every place."""

CAP_MARGIN = 1.0 - 4.5e-16
"""A clamped speed is multiplied by this too, so that rounding cannot leave the speed above the cap."""

SPEED_MARGIN = 1.0 + 1e-9
"""Factor on the speed cap in checks and in bounds of travel, so that rounding cannot matter."""

MIN_SLIP_SPEED = 1e-9
"""[u/s] A ball whose lowest point is slower than this rolls. Rounding leaves a slip of some 1e-15 u/s on a
ball that rolls. Smaller: a rolling ball is treated as slipping. Larger: a slow slip ends early."""

GRID_CELL = 1.0
"""[u] Longest side of a grid cell. Smaller: shorter lists, more memory. Source: measured."""

SKIN = 2.0
"""[u] A search for contacts covers this travel at most. Smaller: more searches. Larger: longer lists."""

SEARCH_TIME = 0.25
"""[s] A search for contacts covers this time at most. Source: measured."""

LOW_GRAVITY = 0.1
"""[u/s²] Under less gravity than this a search may be longer: a ball may stay in flight for hours, which must
not take a million searches. Smaller: it may. Larger: no harm, but different bits."""

MAX_SEARCH_TIME = 1e4
"""[s] Upper limit of any search. Smaller: more searches for a ball at rest without gravity. Larger: times
lose digits."""

SKIN_SHARE = 0.5
"""Where parts are close to each other, `skin` is this share of the mean distance between them. Source:
measured."""

CELL_SHARE = 0.5
"""Where parts are close to each other, a cell's side is this share of that distance. Source: measured."""

CABINET_REST = 1e-3
"""[u] A cabinet that swings by less is at rest: a seventeenth of a pixel in a picture of 1152.
Smaller: ticks are played one by one for longer. Larger: the end of a swing can be seen."""

MAX_DEPTH = 1e-9
"""[u] The guarantee: no ball is ever deeper inside anything. An externally modified state that violates it
is a fault."""
