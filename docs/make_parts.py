"""Draw the pictures of the table file's reference and tutorial.

    python docs/make_parts.py [KIND ...] [machine]

Each kind of part has an example, docs/parts/KIND.toml, and its picture, KIND.png. The blocks of
docs/tutorials/machine.md are the file of one table. Each picture holds the digest of the table that it shows,
and a test fails if the two differ.
"""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from pathlib import Path

from PIL import Image
from PIL.PngImagePlugin import PngInfo

from silverball.drawing import THEMES, Moment, Renderer
from silverball.drawing.kernels.stage import Art
from silverball.table import Table, parse_table, table_digest
from silverball.table.table import PART_KINDS

DOCS = Path(__file__).parent
MACHINE = "machine"
MACHINE_SIZE = (400, 640)  # [pixel]
HEAD = 'format = 2\nname = "{}"\n\n[board]\nlength = 14.0\nwidth = 9.0\ngutter = -6.5\n\n'
SIZE = (920, 1500)  # [pixel] of the whole board
LOW, HIGH = (2.5, -2.9), (6.3, 2.9)  # [u] corners (x, z) of what is shown
NEON, FLOOR = THEMES["neon"], (34, 26, 82)
THEME = replace(NEON, art=Art.PLAIN, floor=(FLOOR,) * 3, ray=FLOOR, ornament=(FLOOR,) * 2, heart=FLOOR)
"""Without the painting on the playfield, which would distract."""
COLORS = 200  # of the palette
DIGEST = "Table"
"""The key of the table's digest among the texts of a picture."""


def file_of(name: str) -> Path:
    """Return the path of the picture of a kind or of the tutorial's table."""
    return DOCS / ("tutorials" if name == MACHINE else "parts") / f"{name}.png"


def table_of(name: str) -> Table:
    """Return the table of the tutorial, or the example of a kind on a small board."""
    if name == MACHINE:
        page = (DOCS / "tutorials" / "machine.md").read_text(encoding="utf-8")
        return parse_table(
            "\n".join(re.findall(r"^```toml\n(.*?)^```", page, re.DOTALL | re.MULTILINE)), name
        )
    text = (DOCS / "parts" / f"{name}.toml").read_text(encoding="utf-8")
    return parse_table(HEAD.format(name.replace("_", " ")) + text, name)


def draw(name: str) -> None:
    """Write the picture of a kind or of the tutorial's table."""
    table, is_machine = table_of(name), name == MACHINE
    size, theme = (MACHINE_SIZE, "neon") if is_machine else (SIZE, THEME)
    renderer = Renderer(table, size, theme=theme, effects="less")
    picture = Image.fromarray(renderer.array(Moment.before(table)))
    if not is_machine:
        picture = picture.crop(renderer.camera.box(LOW[0], HIGH[0], LOW[1], HIGH[1], 0.0, 0.0))
    renderer.close()
    digest = PngInfo()
    digest.add_text(DIGEST, table_digest(table))
    picture = picture.quantize(COLORS, dither=Image.Dither.NONE)
    picture.save(file_of(name), pnginfo=digest, optimize=True)
    print(f"wrote {file_of(name).name}, {picture.width} × {picture.height}")


if __name__ == "__main__":
    for chosen in sys.argv[1:] or (*PART_KINDS, MACHINE):
        draw(chosen)
