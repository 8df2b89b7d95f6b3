"""Benchmark of agents on the v1 ids: rhythms that look at nothing, players, and trained policies.

`contestants.py` lists who plays, `stored_policies.py` plays trained policies, `trials.py` lets one play a
ball in many environments, `rhythms.py` searches for the best rhythm, `lookahead.py` is a planner that plays
environments ahead, `results_table.py` makes the table of results.
"""
