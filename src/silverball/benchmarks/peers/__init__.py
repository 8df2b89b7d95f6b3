"""Comparison with general physics engines (pymunk, Box2D) on the same tables: speed and accuracy.

`playfield.py` is the interface of an engine; `pymunk_table.py`, `box2d_v3_table.py`, `box2d_v2_table.py` and
`silverball_table.py` implement it, `engines.py` lists them; `common_tables.py` makes tables that every engine
can play. `random_play.py` measures speed, `penetration.py` escapes and overlaps, `accuracy.py` position
errors against `reference.py` and the drift of energy. `comparison.py` runs everything, `report.py` prints and
plots it.
"""
