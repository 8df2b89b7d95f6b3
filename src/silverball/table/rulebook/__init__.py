"""The rules of a table as data: lamps, counters, modes, and rules that say when what happens.

A rule has triggers (keys that begin with `on_`), conditions (`if_`) and effects. Each kind of section is
one file here, a model whose field descriptions are the reference (docs/rules.md is generated from them).
What names mean is checked in `table/check_rules.py`; `silverball.referee` compiles and runs them.
"""

from silverball.table.rulebook.counter import Counter
from silverball.table.rulebook.lamp import Lamp
from silverball.table.rulebook.play_mode import PlayMode
from silverball.table.rulebook.rule import Rule

__all__ = ["Counter", "Lamp", "PlayMode", "Rule"]
