"""Write docs/tables.md and docs/rules.md, the references of the table file, from the models of `silverball.table`.

    python docs/make_reference.py

A test fails if a page differs from what this script writes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from silverball.table import Arcade, Board, RandomRecipe, Table
from silverball.table.kinds.part import Bouncing, in_order
from silverball.table.model import is_since_2, key_of
from silverball.table.rulebook import Counter, Lamp, PlayMode, Rule
from silverball.table.rulebook.names import NameList
from silverball.table.rulebook.rule import CONDITIONS, EFFECTS, TRIGGERS
from silverball.table.table import PART_KINDS, RULE_SECTIONS

PAGE = Path(__file__).parent / "tables.md"
EXAMPLES = Path(__file__).parent / "parts"
RULES_PAGE = Path(__file__).parent / "rules.md"
RULE_EXAMPLES = {"skill_shot": "A skill shot", "lock": "Locks and a multiball", "mission": "A mission"}
HEAD = """\
# The table file

A table is a TOML file: data only, never code. `silverball check FILE` reports every problem, with its place in
the file; `silverball show --table FILE --out table.png` draws the table; `silverball play --table FILE` plays it.
[Make a table](tutorials/table.md) and [Build a whole machine](tutorials/machine.md) are the tutorials; the built-in table
`parts` has every kind of part once.

Axes: x runs up the table from the gutter to the top, z to the player's right, the origin is the centre of the
board. Points are written `[x, z]`. Angles are counter-clockwise as the player sees the board, from +z (right)
towards +x (up). Lengths are table units [u], times seconds; a real table of 1.07 m is 20 u long.

Every key below is optional unless its default is "–"; a table without paddles is allowed, but no fun. Messages
count parts from 0: `slant_wall[0]` is the first one in the file.

In Python the sections are models with the same keys, in `silverball.parts`, and `replace` makes a changed table
with the same checks:

    import silverball as sb

    table = sb.load_table("classic")
    bumper = sb.parts.Cylinder(center=(5.0, 1.5), radius=0.6, points=250)
    mine = table.replace(name="Mine", board={"gravity": 12}, cylinder=[bumper], triangular_prism=[])
    sb.save_table(mine, "mine.toml")

This page is generated from `src/silverball/table/kinds/` and `table.py`, the pictures from the examples below them by
`docs/make_parts.py`.
"""
MESHES = """\
## Obstacles from meshes

`mesh = "wedge.stl"` (or .obj, .glb; relative to the table file) takes the footprint of a 3-D mesh from above: for a
prism the largest triangle among the corners of the convex hull, for a cylinder the smallest circle around it. The axes
and units of the mesh are those of the table: x up the table, **y out of the board**, z to the right, in u; so the mesh
contains its position on the board. Only the file itself is read, up to 16 MiB and 1,100,000 vertices, counting every
instance of a mesh in a GLB. Most CAD programs use X to the right, Y up, Z for the height, and millimetres; this
converts such a model (`.venv/bin/pip install trimesh`):

    import trimesh

    wedge = trimesh.load("drawn.stl", force="mesh")
    wedge.apply_scale(20 / 1070)  # a table of 1.07 m is 20 u long
    x, z = 2.0, -1.0  # the position of its origin on the board
    wedge.apply_transform([[0, 1, 0, x], [0, 0, 1, 0], [1, 0, 0, z], [0, 0, 0, 1]])  # Y → x, Z → y, X → z
    wedge.export("wedge.stl")
"""
FORMATS = """\
## Formats

A file says which format it is written in: `format = 1`, the default, or `format = 2`. Format 2 has more kinds of parts
and more keys, which are marked below; a file that uses them must say `format = 2`. Everything of format 1 means the
same in format 2. In format 2 the names of parts are unique, because rules speak of parts by their names. A file has at
most 256 KB, and all its parts together at most 4,096 shapes, of which an edge of a wall is one.

Where it fits, the defaults of format 2 are what tables for Visual Pinball use: 1 u is 100 of its units and 1 u/s one of
its units of speed.
"""
ERRORS = """\
## Errors and warnings

`silverball check FILE` and `sb.check_table(table)` tell two severities apart. An **error** keeps a table from being
loaded: a paddle that hits something while it turns or whose tip is faster than `speed_cap`, a kick, exit or launch faster
than it, a board that a ball cannot leave, a hole whose exit is inside something or leads nowhere, a passage into a wall, a
gate or a plunger without room, a level that does not exist, too many of something. A **warning** is what real tables have
and a maker may want: parts that overlap, cross or extend beyond the board, gaps that a ball barely fits, level faces and
pockets in which a ball would lie until the table is shoved. Each is reported once for a pair of parts. With
`--strict`, warnings are errors; the boards of a recipe add none to those of the recipe itself.
"""
COMMON = """\
## Keys of all parts

Every part may have these keys beside its own, solid ones all of them, others the name and the level. (Format 2, but for
the name.)

| key | default | range | meaning |
| --- | --- | --- | --- |
"""
SHARED = ("name", "level", "levels", "speed_factor", "friction", "hit_speed", "finish")
"""Keys that are told once, for all parts, unless a kind has another default."""

NOTES = {"paddle": "Any number; in format 1 at most one per side"}


RULES_HEAD = """\
# Rules of a table

A table file may say what is to be done on it: *collect these → light that → shoot it → reward*. Rules are data, never
code: `silverball check FILE` finds the names that are not there, the rules that can never act and those that loop; a
replay holds them, and verifies with them; they run compiled, in the window and in thousands of games at once
(`GameBatch`). They need `format = 2`.

A `[[rule]]` has **triggers** (keys that begin with `on_`): any of them sets it off. It has **conditions** (`if_`): all of
them must hold. And it has **effects**: all of them happen. What it speaks of are parts and banks, by their names, and

* **lamps**, which are off, on or blinking, alone or in groups;
* **counters**, whole numbers: values that grow, letters, locks, the bonus;
* **modes**, which run or do not, and end by themselves after some seconds: missions, hurry-ups, multiballs, timers.

Where a key takes names, one may be written without a list: `light = "lock"`. Points are whole numbers. In words of the
trade: a switch or shot is a part under `on_hit`, a timer is a mode with `seconds`, a kickback is a rule with `kick`, a
lane change is `rotate_left` under `on_press`, a jackpot is an award in a mode, an end-of-ball bonus is an award under
`on_ball = "end"`, a combo is a short mode.

A table without rules has the standard ones, below; with rules of its own it has only those. Ball save, tilt and
un-sticking belong to every table and have their numbers in `[arcade]` ([The table file](tables.md#arcade)). Free play
has the standard rules always, and no combos.
"""
RULES_EXAMPLES = """\
## Three examples

Each is a whole set of rules for the built-in table `parts`: put it behind the text of that table.
"""
STANDARD = """\
## The standard rules

`src/silverball/table/rulebook/standard.toml`:

```toml
{text}```
"""


def rules_page() -> str:
    """Return the page of the rules."""
    folder = Path(RULES_PAGE).parent / "rules"
    parts = [RULES_HEAD]
    for name, model in zip(RULE_SECTIONS, (Lamp, Counter, PlayMode), strict=False):
        parts.append(_table(f"`[[{name}]]`", model, "Any number", is_marked=False))
    groups = {
        "Triggers": TRIGGERS,
        "Conditions": CONDITIONS,
        "Effects, in the order in which they happen": EFFECTS,
    }
    others = tuple(name for name in Rule.model_fields if name != "name")
    parts.append(_table("`[[rule]]`", Rule, "Any number", skip=others, is_marked=False))
    for title, keys in groups.items():
        rows = [_row(Rule, name, is_marked=False) for name in keys]
        head = [f"### {title}", "", "| key | default | range | meaning |", "| --- | --- | --- | --- |"]
        parts.append("\n".join([*head, *rows, ""]))
    parts.append(RULES_EXAMPLES)
    for name, title in RULE_EXAMPLES.items():
        text = (folder / f"{name}.toml").read_text(encoding="utf-8")
        parts.append(f"### {title}\n\n```toml\n{text}```\n")
    standard = Path(__file__).parents[1] / "src/silverball/table/rulebook/standard.toml"
    parts.append(STANDARD.format(text=standard.read_text(encoding="utf-8")))
    return "\n".join(parts)


def page() -> str:
    """Return the page of the table file."""
    skipped = (*PART_KINDS, *RULE_SECTIONS, "board", "arcade")
    parts = [HEAD, FORMATS, ERRORS, _table("Top level", Table, skip=skipped)]
    parts.append(_table("`[board]`", Board, "Once"))
    rows = [_row(Bouncing, name, is_marked=False) for name in in_order(Bouncing) if name in SHARED]
    parts.append(COMMON + "\n".join(rows) + "\n")
    for kind, model in PART_KINDS.items():
        is_new = is_since_2(Table.model_fields[kind])
        note = NOTES.get(kind, "Any number; format 2" if is_new else "Any number")
        shared = [name for name in SHARED if _is_as_in_all(model, name)]
        shown = _example(kind)
        parts.append(_table(f"`[[{kind}]]`", model, note, shown, skip=tuple(shared), is_marked=not is_new))
    parts.append(_table("`[random]`", RandomRecipe, "Makes the table a recipe, with a board for every seed"))
    parts.append(_table("`[arcade]`", Arcade, "Once"))
    parts.append(MESHES)
    return "\n".join(parts)


def _is_as_in_all(model: Any, name: str) -> bool:
    """Whether a field means in a kind what it means in all of them."""
    field, common = model.model_fields.get(name), Bouncing.model_fields[name]
    return field is not None and (field.default, is_since_2(field)) == (common.default, is_since_2(common))


def _example(kind: str) -> str:
    """The picture of a kind, and the lines of a file that it shows."""
    text = (EXAMPLES / f"{kind}.toml").read_text(encoding="utf-8")
    return f"![{kind.replace('_', ' ')}]({EXAMPLES.name}/{kind}.png)\n\n```toml\n{text}```\n"


def _table(
    title: str,
    model: Any,
    note: str = "",
    shown: str = "",
    skip: tuple[str, ...] = (),
    is_marked: bool = True,
) -> str:
    text = "\n\n".join(" ".join(paragraph.split()) for paragraph in (model.__doc__ or "").split("\n\n")[:2])
    text = text.partition(" Examples:")[0].rstrip()
    lines = [f"## {title}", "", f"{text} ({note}.)" if note else text, ""]
    lines += [shown] if shown else []
    lines += ["| key | default | range | meaning |", "| --- | --- | --- | --- |"]
    lines += [_row(model, name, is_marked) for name in in_order(model) if name not in skip]
    return "\n".join([*lines, ""])


def _row(model: Any, name: str, is_marked: bool) -> str:
    """One key; `is_marked`: keys of format 2 say so."""
    field, key = model.model_fields[name], key_of(model, name)
    schema = model.model_json_schema()["properties"][key]
    mark = " (Format 2.)" if is_marked and is_since_2(field) else ""
    return f"| `{key}` | {_default(field)} | {_span(schema)} | {_cell(schema['description'])}{mark} |"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _default(field: Any) -> str:
    if field.is_required():
        return "–"
    value = field.default
    has_names = any(isinstance(rule, NameList) for rule in field.metadata)
    if value is None or value in ("", {}) or (value == () and has_names):
        return "none"
    if hasattr(value, "model_dump"):
        return ", ".join(f"{key} {number:g}" for key, number in value.model_dump().items())
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value).replace("(", "[").replace(")", "]")


def _span(field: dict[str, Any]) -> str:
    for choice in (field, *field.get("anyOf", ())):
        if "form" in choice:
            span = _span(choice.get("additionalProperties", {}))
            return f"{choice['form']}: {span}" if span else str(choice["form"])
        if "minimum" in choice and "maximum" in choice:
            return f"{choice['minimum']:,.10g} to {choice['maximum']:,.10g} {choice.get('unit', '')}".rstrip()
        if "enum" in choice:
            return " or ".join(f'"{v}"' if isinstance(v, str) else str(v) for v in choice["enum"])
    return ""


if __name__ == "__main__":
    for path, text in ((PAGE, page()), (RULES_PAGE, rules_page())):
        path.write_text(text, encoding="utf-8")
        print(f"wrote {path}")
