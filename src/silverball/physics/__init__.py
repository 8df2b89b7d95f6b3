"""One exact, compiled step of a pinball table.

Read `step.py` first: it is the whole simulation on one screen. `layout.py` is what it moves. `skip_ahead.py`
says for how long nothing happens; `contact.py` with `grid.py`, `flight.py`, `paddle.py` and `shapes.py` finds
the next contact; `bounce.py` and `friction.py` say what a contact does, `motion.py` how a ball moves until
then: sliding, slipping or rolling. `validation.py` looks at states that come from elsewhere; `audit.py` and
`regions.py` look for balls inside anything and share no code with the rest. Nothing in here knows of tables,
windows or players; it imports numpy and numba, and platformdirs for the place of compiled code.

`PHYSICS_VERSION` is raised whenever the same table, seed and inputs would give other bits than before.
"""

PHYSICS_VERSION = 3
