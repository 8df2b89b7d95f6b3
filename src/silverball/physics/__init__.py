"""One exact, compiled step of a pinball table.

Read `step.py` first: it is the whole simulation on one screen. `layout.py` is what it moves, `shapes.py` and
`flight.py` find the next contact, `bounce.py` says what a contact does. Nothing in here knows of tables,
windows or players; it imports math, numpy and numba only.

`PHYSICS_VERSION` is raised whenever the same table, seed and inputs would give other bits than before.
"""

PHYSICS_VERSION = 2
