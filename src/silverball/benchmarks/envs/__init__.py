"""Benchmark of environments for agents: steps per second of Silverball's and of installed other ones.

`environments.py` lists the candidates, `measure.py` times them, `rate_table.py` formats the result.
"""
