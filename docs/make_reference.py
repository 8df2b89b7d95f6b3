"""Write docs/tables.md, the reference of the table file, from the models of `silverball.table`.

    python docs/make_reference.py

A test fails if the page differs from what this script writes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from silverball.table import Arcade, Board, Cylinder, Paddle, RandomRecipe, SlantWall, Table, TriangularPrism

PAGE = Path(__file__).parent / "tables.md"
HEAD = """\
# The table file

A table is a TOML file: data only, never code. `silverball check FILE` reports every problem, with its place in
the file; `silverball show --table FILE --out table.png` draws the table; `silverball play --table FILE` plays it.

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

This page is generated from `src/silverball/table/parts.py` and `table.py`.
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
SECTIONS = (
    ("[board]", Board, "once"),
    ("[[slant_wall]]", SlantWall, "any number"),
    ("[[paddle]]", Paddle, "at most one per side"),
    ("[[triangular_prism]]", TriangularPrism, "any number"),
    ("[[cylinder]]", Cylinder, "any number"),
    ("[random]", RandomRecipe, "makes the table a recipe, with a board for every seed"),
    ("[arcade]", Arcade, "once"),
)


def page() -> str:
    """Return the whole page."""
    elsewhere = ("board", "slant_wall", "paddle", "triangular_prism", "cylinder", "arcade")
    parts = [HEAD, _table("Top level", Table, "", skip=elsewhere)]
    parts += [_table(f"`{title}`", model, note) for title, model, note in SECTIONS]
    parts.append(MESHES)
    return "\n".join(parts)


def _table(title: str, model: Any, note: str, skip: tuple[str, ...] = ()) -> str:
    schema = model.model_json_schema()
    text = " ".join((model.__doc__ or "").split("\n\n", 1)[0].split())
    lines = [f"## {title}", "", f"{text} ({note[0].upper() + note[1:]}.)" if note else text, ""]
    lines += ["| key | default | range | meaning |", "| --- | --- | --- | --- |"]
    for key, field in schema["properties"].items():
        if key not in skip:
            default = _default(model.model_fields[key])
            lines.append(f"| `{key}` | {default} | {_span(field)} | {_cell(field['description'])} |")
    return "\n".join([*lines, ""])


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _default(field: Any) -> str:
    if field.is_required():
        return "–"
    value = field.default
    if value is None or value == "":
        return "none"
    if hasattr(value, "model_dump"):
        return ", ".join(f"{key} {number:g}" for key, number in value.model_dump().items())
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value).replace("(", "[").replace(")", "]")


def _span(field: dict[str, Any]) -> str:
    for choice in (field, *field.get("anyOf", ())):
        if "minimum" in choice and "maximum" in choice:
            return f"{choice['minimum']:g} to {choice['maximum']:g} {choice.get('unit', '')}".rstrip()
        if "enum" in choice:
            return " or ".join(f'"{value}"' for value in choice["enum"])
    return ""


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE}")
