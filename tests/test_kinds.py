"""Every kind of part, as `Table` lists them, through every reader: none may fall through."""

from __future__ import annotations

import importlib.util
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, get_args

import pytest

import silverball as sb
from silverball.errors import TableError
from silverball.physics.forms import Response, Shape
from silverball.table import Table, dump_table, expand, parse_table, table_digest
from silverball.table.geometry import pieces_of
from silverball.table.kinds import Level
from silverball.table.kinds.part import Part
from silverball.table.model import is_since_2
from silverball.table.placed_parts import Layout
from silverball.table.primitive import Finish, Primitive
from silverball.table.table import PART_KINDS

DOCS = Path(__file__).parents[1] / "docs"

EXAMPLES: dict[str, list[dict[str, Any]]] = {
    "slant_wall": [{"start": [1.0, -1.0], "end": [2.0, 0.5]}],
    "paddle": [
        {"side": "left", "pivot": [-7.2, -2.5]},
        {
            "side": "right",
            "pivot": [-7.2, 2.5],
            "shape": "capsule",
            "length": 1.8,
            "stroke": 0.2,
            "mass": 2.0,
        },
    ],
    "triangular_prism": [{"vertices": [[2.0, -1.0], [3.2, -1.4], [2.4, 0.2]], "kick": 2.0}],
    "cylinder": [{"center": [5.0, 1.5], "radius": 0.6, "kick": 5.0}],
    "wall": [
        {"points": [[1.0, -1.0], [2.0, 0.5, 0.4], [3.0, 0.0]], "score": 20},
        {"points": [[1.0, 1.0], [2.0, 1.0], [1.5, 2.0]], "closed": True, "kick": 4.0, "edges": [1]},
    ],
    "post": [{"center": [2.0, 0.0]}],
    "slingshot": [{"start": [1.0, -1.0], "end": [2.2, -1.6]}],
    "target": [{"start": [3.0, 0.2], "end": [3.1, 1.0]}],
    "drop_target": [
        {"start": [3.0, 0.2], "end": [3.1, 1.0]},
        {"start": [5.0, 0.2], "end": [5.1, 1.0], "bank": "one", "reset_after": 2.0},
    ],
    "rollover": [
        {"start": [3.0, 0.2], "end": [3.1, 1.0]},
        {"center": [3.0, 3.0], "radius": 0.3, "levels": [0, 1]},
    ],
    "gate": [
        {"start": [3.0, 0.2], "end": [3.1, 1.0], "passes": "down"},
        {"start": [5.0, 0.2], "end": [5.1, 1.0], "held": True, "name": "way in"},
    ],
    "spinner": [{"start": [3.0, 0.2], "end": [3.1, 1.0], "drag": 0.5}],
    "hole": [
        {"center": [3.0, 0.0], "exit_velocity": [-8.0, 1.0], "exit": [2.0, 0.0]},
        {"center": [5.0, 0.0], "drain": True},
    ],
    "plunger": [
        {"position": [-5.0, 4.5], "launch": [5.0, 18.0], "angle": 80.0},
        {"position": [-5.0, -4.5], "auto_launch": [12.0, 18.0], "auto_delay": 0.5},
    ],
    "passage": [{"start": [3.0, 0.2], "end": [3.1, 1.0], "from": 0, "to": 1}],
    "level": [{"number": 1, "gravity": [-20.0, 0.0]}],
}
"""Parts of every kind; a new kind needs an example here."""


def table_of(kind: str) -> Table:
    """A table with the examples of a kind, without the checks whether they fit together."""
    return Table.model_validate({"name": kind, kind: EXAMPLES[kind]})


# --- readers --------------------------------------------------------------------------------------------


def parsed(table: Table, kind: str) -> None:
    again = Table.model_validate(tomllib.loads(dump_table(table)))
    assert again == table
    assert dump_table(again) == dump_table(table)
    assert table_digest(again) == table_digest(table)


def format_required(table: Table, kind: str) -> None:
    """A file says `format = 2` exactly where it needs it."""
    is_new = is_since_2(Table.model_fields[kind]) or kind in ("paddle", "triangular_prism", "cylinder")
    assert table.format == (2 if is_new else 1)
    assert dump_table(table).startswith(f"format = {table.format}\n")
    if not is_new:
        return
    with pytest.raises(TableError, match="format = 2 at the top of the file") as refused:
        parse_table(dump_table(table).replace("format = 2", "format = 1", 1))
    assert all(problem.path for problem in refused.value.problems)


def numbered(table: Table, kind: str) -> None:
    """Every part has its number, its name and its primitives."""
    expansion = expand(table)
    parts = [part for part in expansion.parts if part.kind == kind]
    assert len(parts) == (0 if kind == "level" else len(EXAMPLES[kind]))
    for part in parts:
        assert part.primitives
        assert expansion.numbers[part.name] == expansion.parts.index(part)
        rows = expansion.rows[part.first : part.first + len(part.primitives)]
        assert [row.primitive for row in rows] == list(part.primitives)
        assert {row.part for row in rows} == {expansion.numbers[part.name]}


def made_of_known_primitives(table: Table, kind: str) -> None:
    """Each primitive has what its shape and its response need."""
    for row in expand(table).rows:
        assert_whole(row.primitive)


def assert_whole(primitive: Primitive) -> None:
    counts = {
        Shape.PLANE: 2, Shape.CIRCLE: 1, Shape.CAPSULE: 2, Shape.TRIANGLE: 3, Shape.TAPERED: 2, Shape.ARC: 2,
        Shape.LINE: 2, Shape.DISC: 1,
    }  # fmt: skip
    assert len(primitive.points) == counts[primitive.shape]
    assert isinstance(primitive.finish, Finish)
    assert primitive.levels
    assert (primitive.shape == Shape.ARC) == (primitive.bulge != 0.0)
    assert (primitive.response == Response.BOUNCE) == (primitive.shape not in (Shape.LINE, Shape.DISC))
    if primitive.response == Response.HOLD:
        assert (primitive.hold is None) != (primitive.launch is None)
    if primitive.shape in (Shape.CIRCLE, Shape.DISC, Shape.TAPERED):
        assert primitive.radius > 0.0
    assert (primitive.mover is not None) == (primitive.finish == Finish.PADDLE)


def compiled(table: Table, kind: str) -> None:
    from silverball.world.compile import part_numbers

    numbers = part_numbers(table)
    for part in expand(table).parts:
        assert part.name in numbers


def checked(table: Table, kind: str) -> None:
    """Every solid primitive has pieces to check, and every problem of the part names a place in it."""
    layout = Layout.of(table)
    for part in (*layout.parts, *layout.paddles):
        assert all(pieces_of(primitive) for primitive in part.primitives), part.path
        assert part.place.startswith(part.path)
    for problem in sb.check_table(table):
        section = problem.path.partition("[")[0].partition(".")[0]
        assert section in (*PART_KINDS, "board", ""), problem


def documented(table: Table, kind: str) -> None:
    """The reference page has a section for the kind, with every key."""
    spec = importlib.util.spec_from_file_location("make_reference", DOCS / "make_reference.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    page = module.page()
    _, is_there, section = page.partition(f"## `[[{kind}]]`")
    assert is_there
    _, _, common = page.partition("## Keys of all parts")
    section = section.partition("\n## ")[0] + common.partition("\n## ")[0]
    for name, field in PART_KINDS[kind].model_fields.items():
        assert f"| `{field.alias or name}` |" in section


def public(table: Table, kind: str) -> None:
    """The model is in `silverball.parts`, documented, with an explained name for every field."""
    model = PART_KINDS[kind]
    assert getattr(sb.parts, model.__name__) is model
    assert model.__name__ in sb.parts.__all__


def scored(table: Table, kind: str) -> None:
    """A game knows the points, the buttons and the plungers; the help names every kind that gives points."""
    from silverball.app.scoring import how_to_score
    from silverball.game.mechanisms import paddle_buttons, plungers, points_by_part

    parts = [part for part in expand(table).parts if part.path != "board"]
    assert points_by_part(table) == {part.name: part.points for part in parts}
    assert bool(plungers(table)) == (kind == "plunger")
    assert paddle_buttons(table) == ({"left", "right"} if kind == "paddle" else set())
    hits = how_to_score(table, sb.Mode.FREE)[0].text.lower()
    assert (kind.replace("_", " ") in hits) == any(part.points for part in parts if part.kind == kind)


def heard(table: Table, kind: str) -> None:
    """Every part has the sound of a hit, and of every event that it can cause."""
    from silverball.app.sound.bank import RECIPES
    from silverball.app.sound.part_sounds import MECHANISMS, event_sound, sounds_of_parts

    sounds = sounds_of_parts(table)
    assert sounds.keys() == set(expand(table).names)
    causes = {Response.PASS: ("pass", "spin"), Response.HOLD: ("captured", "released"), Response.BOUNCE: ()}
    for row in expand(table).rows:
        part = sounds[expand(table).names[row.part]]
        assert part.blow.name in RECIPES
        for event in causes[row.primitive.response]:
            sound = event_sound(event, part.finish)
            assert sound is not None
            assert sound.name in RECIPES
            assert event == "spin" or part.finish in MECHANISMS[event]


def drawn(table: Table, kind: str) -> None:
    """Each part is seen in the baked picture, in the sketch and in the pictures for agents."""
    import numpy as np

    from silverball.drawing import Moment, Renderer
    from silverball.drawing.layout import Layout
    from silverball.drawing.sketch import SketchPainter
    from silverball.envs.board_pool import make_pool
    from silverball.envs.sprites import make_pictures

    layout, bare = Layout.of(table), Table(name=kind)
    if not layout.rows:
        assert kind == "level"
        return
    size = (150, 240)
    renderers = [Renderer(one, size) for one in (table, bare)]
    pictures = [renderer.array(Moment.before(renderer.table)).astype(int) for renderer in renderers]
    sketches = []
    for renderer in renderers:
        painter = SketchPainter(renderer.table, renderer.camera, renderer.theme)
        surface = painter.compose(Moment.before(renderer.table), renderer.effects)
        sketches.append(np.frombuffer(surface.get_buffer().raw, np.uint8).reshape(240, 150, 3).astype(int))
    camera = renderers[0].camera
    for _, primitive in layout.rows:
        x, z = np.mean(primitive.points, axis=0)
        if primitive.mover is not None:
            x, z = primitive.mover.pivot
        left, top, right, bottom = camera.box(x - 0.6, x + 0.6, z - 0.6, z + 0.6, 0.0, 1.0)
        for one, other in (pictures, sketches):
            assert np.abs(one - other)[top:bottom, left:right].max() > 20, primitive
    small = [make_pictures(make_pool(one, 1, 0), (84, 84), True) for one in (table, bare)]
    seen = small[0].backgrounds[0] != small[1].backgrounds[0]
    assert seen.any() or len(small[0].paddles) > 1 or len(small[0].pieces)


def coloured(table: Table, kind: str) -> None:
    """Each finish has a look in the picture and a colour in the pictures for agents."""
    from silverball.drawing.looks import LOOKS
    from silverball.envs.sprites import COLORS

    for row in expand(table).rows:
        assert row.primitive.finish in LOOKS
        assert row.primitive.finish in COLORS


READERS: dict[str, Callable[[Table, str], None]] = {
    "parse, write and hash": parsed,
    "the format that is required": format_required,
    "expand": numbered,
    "primitives": made_of_known_primitives,
    "compile": compiled,
    "points, buttons and help of a game": scored,
    "sounds": heard,
    "check": checked,
    "reference page": documented,
    "public names": public,
    "pictures": drawn,
    "finishes": coloured,
}
"""What reads a table; a new reader needs a line here."""


class Case(NamedTuple):
    kind: str
    reader: str


CASES = [Case(kind, reader) for kind in PART_KINDS for reader in READERS]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.kind} - {case.reader}")
def test_every_reader_reads_every_kind(case: Case) -> None:
    READERS[case.reader](table_of(case.kind), case.kind)


def test_every_kind_has_an_example_and_every_example_is_a_kind() -> None:
    assert EXAMPLES.keys() == PART_KINDS.keys()
    for model in PART_KINDS.values():
        assert issubclass(model, Part) or model is Level


def test_the_examples_use_every_shape_response_and_finish_of_parts() -> None:
    rows = [row.primitive for kind in PART_KINDS for row in expand(table_of(kind)).rows]
    assert {row.shape for row in rows} == set(Shape)
    assert {row.response for row in rows} == set(Response)
    chosen = {Finish.METAL, Finish.WOOD, Finish.PLASTIC}  # no kind has them of itself
    assert {row.finish for row in rows} == set(Finish) - chosen


def test_the_playground_has_every_kind_once_at_least() -> None:
    playground = sb.load_table("parts")
    assert playground.format == 2
    missing = [kind for kind in PART_KINDS if not getattr(playground, kind)]
    assert missing == []
    assert sb.check_table(playground) == []


@pytest.mark.parametrize("kind", PART_KINDS)
def test_none_is_a_value_only_where_it_is_the_default(kind: str):
    """A file has no null, so a part with another None could not be written."""
    for name, field in PART_KINDS[kind].model_fields.items():
        accepts_none = type(None) in get_args(field.annotation)
        assert not accepts_none or field.default is None, name
