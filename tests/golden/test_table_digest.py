"""The digest of a table stays what it was when a kind of part gets another key.

Replays and score lists name their table by it. A key that is added to a kind, a lamp or a rule is to be
marked with `SINCE_2`, which leaves its default out of the digest.
"""

from __future__ import annotations

from silverball.table import Table, table_digest

LINE = {"start": (3.0, 0.2), "end": (3.1, 1.0)}
TABLE = {
    "format": 2,
    "name": "Every kind",
    "paddle": [{"side": "left", "pivot": (-7.0, -2.5)}, {"side": "right", "pivot": (-7.0, 2.5)}],
    "slant_wall": [{"start": (1.0, -1.0), "end": (2.0, 0.5)}],
    "triangular_prism": [{"vertices": ((2.0, -1.0), (3.2, -1.4), (2.4, 0.2))}],
    "cylinder": [{"center": (5.0, 1.5), "radius": 0.6}],
    "wall": [{"points": ((1.0, -1.0), (2.0, 0.5))}],
    "post": [{"center": (2.0, 0.0)}],
    "slingshot": [{"start": (1.0, -1.0), "end": (2.2, -1.6)}],
    "target": [LINE],
    "drop_target": [LINE],
    "rollover": [LINE],
    "gate": [{**LINE, "passes": "up"}],
    "spinner": [LINE],
    "hole": [{"center": (3.0, 0.0), "exit_velocity": (-8.0, 1.0)}],
    "plunger": [{"position": (-5.0, 4.5)}],
    "passage": [{**LINE, "from": 0, "to": 1}],
    "level": [{"number": 1}],
    "lamp": [{"name": "lamp"}],
    "counter": [{"name": "counter"}],
    "mode": [{"name": "mode"}],
    "rule": [{"on_press": ("left",), "award": 10}],
}
"""One of everything, with the keys that it must have; a new kind is not added."""

DIGEST = "b5363b02bfee19954985a07d0823d21435917e9fb9930e550d840a5e6b2ed20a"


def test_the_digest_of_a_table_with_one_of_everything_is_what_it_was():
    assert table_digest(Table.model_validate(TABLE)) == DIGEST
