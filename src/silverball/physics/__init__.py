"""One exact, compiled step of a pinball table.

Read `step.py` first: it is the whole simulation on one screen. Then:

* `records.py`: the records that the step reads and writes
* `skip_ahead.py`: the number of ticks without events
* `contact.py`, on `broad_phase.py`, `flight.py`, `paddle.py` and `shapes.py`: the next contact of a ball
* `bounce.py`, `friction.py`: the effect of a contact on a ball
* `motion.py`: how a ball moves between contacts: sliding, slipping or rolling
* `devices.py`, on `crossing.py`, `one_way.py`, `spinner.py` and `holes.py`: what parts do apart from bouncing
  balls: sensors, passages between levels, spinners, holes, plungers, drop targets and gates
* `balls.py`: creating, shoving and separating balls
* `validation.py`: checks of states that were modified externally
* `audit.py`: an independent check for balls inside parts; it shares no code with the solver
* `kernel.py`, with `code_cache.py` and `compile_thread.py`: how kernels are compiled and cached

The physics knows nothing of tables, windows or players. It imports numpy and numba, and platformdirs for the
cache of compiled code.

`PHYSICS_VERSION` is incremented when a change gives different bits for the same table, seed and inputs.
"""

PHYSICS_VERSION = 4
