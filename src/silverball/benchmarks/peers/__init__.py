"""How does Silverball compare with general engines on the same table?

`engine.py` says what is asked of an engine; `pymunk_table.py`, `box2d_v3_table.py`, `box2d_v2_table.py` and
`silverball_table.py` build the table in one engine each; `tables.py` makes the tables that all can play;
`play.py` measures speed, `watch.py` escapes and penetration, `accuracy.py` errors against `reference.py`,
`energy.py` the drift; `contest.py` runs it all, `report.py` and `plot.py` show it.
"""
