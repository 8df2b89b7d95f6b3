"""How many steps a second do environments for agents make: ours, and others that are installed?

`contestants.py` says who takes part, `contest.py` measures them, `report.py` tells what came of it.
"""
