"""One exact, compiled step of a pinball table.

Read `step.py` first: it is the whole simulation on one screen. Then:

* `records.py`: the records that the step reads and writes
* `skip_ahead.py`: the number of ticks without events
* `contact.py`, on `broad_phase.py`, `flight.py`, `paddle.py` and `shapes.py`: the next contact of a ball
* `bounce.py`, `friction.py`: the effect of a contact on a ball
* `motion.py`: how a ball moves between contacts: sliding, slipping or rolling
* `devices.py`, on `crossing.py` and `spinner.py`: what parts do apart from bouncing balls: sensors, passages
  between levels, spinners, and when they act by themselves
* `captures.py`, on `holes.py`: holes and plungers; `switches.py`: drop targets and gates; `one_way.py`
* `jams.py`: balls that bounce between things too often in a tick
* `balls.py`: creating, shoving and separating balls
* `validation.py`: checks of states that were modified externally
* `audit.py`: an independent check for balls inside parts; it shares no code with the solver
* `kernel.py`, with `code_cache.py` and `compile_thread.py`: how kernels are compiled and cached

The physics knows nothing of tables, windows or players. It imports numpy and numba, and platformdirs for the
cache of compiled code.

`PHYSICS_VERSION` is incremented when a change gives different bits for the same table, seed and inputs.
"""

PHYSICS_VERSION = 4
