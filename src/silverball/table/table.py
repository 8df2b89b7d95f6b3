"""A whole table: the model `Table`, and the checks that make one of data.

Tables from files and changed copies (`Table.replace`) go through the same steps: the data are validated,
meshes are replaced by their footprints, the layout is checked, and a recipe is tried out. A constructor
validates the fields only, so that unusual boards are possible; `check_table` lists the problems of one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import BaseModel, BeforeValidator, Field, ValidationError, model_validator

from silverball.errors import Problem, TableError
from silverball.table import kinds, rulebook
from silverball.table.arcade import Arcade
from silverball.table.check import check_layout
from silverball.table.check_rules import Placed, Rulebook, rule_problems
from silverball.table.explain import explain, path_of
from silverball.table.kinds.board import LEVELS, Board
from silverball.table.kinds.part import Part
from silverball.table.model import SINCE_2, Model, Name, is_since_2, list_sections, places_of_format_2
from silverball.table.placed_parts import Layout
from silverball.table.placement import try_recipe
from silverball.table.quantity import refuse, shown
from silverball.table.recipe import RandomRecipe

FORMATS = (1, 2)  # versions of the file format
ROWS_LIMIT = 4096  # primitives of all parts of a table; real tables have 300
RULES_LIMIT = 512  # rules, and lamps, of a table; a game with everything has 200
MESHES_LIMIT = 32  # different meshes of a table; chosen: one may take a second

_AT_MOST = Field(max_length=ROWS_LIMIT)
_RULES = Field(max_length=RULES_LIMIT)

# Without these a layout cannot be measured; these are what `check` needs to know about a board.
_MEASURES = frozenset({"length", "width", "ball_radius", "wall_thickness", "gutter"})


def _known_format(value: Any) -> Any:
    if value not in FORMATS or isinstance(value, bool):
        refuse(f"must be 1 or 2, got {shown(value)}: a newer file needs a newer Silverball")
    return int(value)


class TablePart(NamedTuple):
    """One part of a table, and what it is called.

    Attributes:
        path: Its place in the file, in the messages of checks: ``paddle[1]``.
        name: Its name in events and tallies: ``paddle.left`` for the first paddle of a side, else the path.
        part: The part itself.
    """

    path: str
    name: str
    part: Part


class Table(Model):
    """A pinball table as data, immutable.

    With a `random` section it is a recipe, from which every seed makes a finished table (`generate_table`).

    Examples:
        >>> import silverball as sb
        >>> classic = sb.load_table("classic")
        >>> heavy = classic.replace(name="Heavy", board={"gravity": 12})
        >>> heavy.board.gravity, heavy.board.friction == classic.board.friction
        (12.0, True)
    """

    format: Annotated[Literal[1, 2], BeforeValidator(_known_format)] = 1
    """The version of the file format: 2 if keys of format 2 are used."""
    name: Name = "Untitled"
    """The title of the table."""
    board: Board = Board()
    """The board and its borders."""
    slant_wall: Annotated[tuple[kinds.SlantWall, ...], _AT_MOST] = ()
    """The slant walls."""
    paddle: Annotated[tuple[kinds.Paddle, ...], _AT_MOST] = ()
    """The paddles; format 1 has at most one per side."""
    triangular_prism: Annotated[tuple[kinds.TriangularPrism, ...], _AT_MOST] = ()
    """The triangular prisms."""
    cylinder: Annotated[tuple[kinds.Cylinder, ...], _AT_MOST] = ()
    """The cylinders."""
    wall: Annotated[tuple[kinds.Wall, ...], _AT_MOST, SINCE_2] = ()
    """The walls."""
    post: Annotated[tuple[kinds.Post, ...], _AT_MOST, SINCE_2] = ()
    """The posts."""
    slingshot: Annotated[tuple[kinds.Slingshot, ...], _AT_MOST, SINCE_2] = ()
    """The slingshots."""
    target: Annotated[tuple[kinds.Target, ...], _AT_MOST, SINCE_2] = ()
    """The targets that stand."""
    drop_target: Annotated[tuple[kinds.DropTarget, ...], _AT_MOST, SINCE_2] = ()
    """The drop targets."""
    rollover: Annotated[tuple[kinds.Rollover, ...], _AT_MOST, SINCE_2] = ()
    """The rollovers."""
    gate: Annotated[tuple[kinds.Gate, ...], _AT_MOST, SINCE_2] = ()
    """The gates."""
    spinner: Annotated[tuple[kinds.Spinner, ...], _AT_MOST, SINCE_2] = ()
    """The spinners."""
    hole: Annotated[tuple[kinds.Hole, ...], _AT_MOST, SINCE_2] = ()
    """The holes and drains."""
    plunger: Annotated[tuple[kinds.Plunger, ...], _AT_MOST, SINCE_2] = ()
    """The plungers."""
    passage: Annotated[tuple[kinds.Passage, ...], _AT_MOST, SINCE_2] = ()
    """The lines at which balls change their level."""
    level: Annotated[tuple[kinds.Level, ...], _AT_MOST, SINCE_2] = ()
    """The levels above the playfield."""
    lamp: Annotated[tuple[rulebook.Lamp, ...], _RULES, SINCE_2] = ()
    """The lamps that rules light."""
    counter: Annotated[tuple[rulebook.Counter, ...], _RULES, SINCE_2] = ()
    """The counters of the rules."""
    mode: Annotated[tuple[rulebook.PlayMode, ...], _RULES, SINCE_2] = ()
    """The modes of the rules."""
    rule: Annotated[tuple[rulebook.Rule, ...], _RULES, SINCE_2] = ()
    """The rules; a table without rules has the standard ones."""
    random: RandomRecipe | None = None
    """The obstacles to place at random for each seed, if any."""
    arcade: Arcade = Arcade()
    """The rules of an arcade game."""

    @model_validator(mode="after")
    def _has_the_format_of_its_keys(self) -> Table:
        """Set format 2 for a table made in Python that needs it; files must say so themselves."""
        if self.format == 1 and _needs_format_2(self):
            self.__dict__["format"] = 2  # the model is frozen, but not made yet
            self.__pydantic_fields_set__.add("format")
        return self

    def parts(self) -> tuple[TablePart, ...]:
        """Return all parts, in the order of their numbers on a board.

        The first paddle of each side, left and right, comes first, then other paddles, then the other kinds
        in the order of the fields.

        Examples:
            >>> import silverball as sb
            >>> sb.load_table("classic").parts()[0].name
            'paddle.left'
        """
        sections = list_sections(type(self))
        others = [
            TablePart(path := f"{kind}[{index}]", path, part)
            for kind, model in sections.items()
            if issubclass(model, Part) and kind != "paddle"
            for index, part in enumerate(getattr(self, kind))
        ]
        return (*self._named_paddles(), *others)

    def _named_paddles(self) -> list[TablePart]:
        first: list[TablePart] = []
        for side in ("left", "right"):
            of_side = [index for index, paddle in enumerate(self.paddle) if paddle.side == side]
            first += [TablePart(f"paddle[{i}]", f"paddle.{side}", self.paddle[i]) for i in of_side[:1]]
        known = {item.path for item in first}
        paths = [f"paddle[{index}]" for index in range(len(self.paddle))]
        return first + [
            TablePart(path, path, part)
            for path, part in zip(paths, self.paddle, strict=True)
            if path not in known
        ]

    @property
    def has_mesh(self) -> bool:
        """Whether a part names a mesh file."""
        return any(part.mesh_file is not None for _, _, part in self.parts())

    def resolved(self) -> Table:
        """Return the table with the footprints of its meshes, so that it needs no other file.

        Raises:
            TableError: A mesh cannot be read or used.
        """
        if not self.has_mesh:
            return self
        return self._with_parts({path: part.resolved() for path, _, part in self.parts()})

    def _with_parts(self, parts: Mapping[str, Part]) -> Table:
        """Return the table with other parts of the same kinds, by their paths."""
        return self.model_copy(
            update={
                kind: tuple(parts[f"{kind}[{index}]"] for index in range(len(getattr(self, kind))))
                for kind, model in list_sections(type(self)).items()
                if issubclass(model, Part)
            }
        )

    def replace(self, **changes: Any) -> Table:
        """Make a changed table, with every check that a table file gets.

        Args:
            **changes: New values by the names of the fields. A dict changes the fields that it names in the
                model that is there, at any depth: ``board={"gravity": 12}``. A model, a list of parts
                or any other value takes the place of the old one. Parts may be models or dicts.

        Returns:
            The new table; meshes that the changes name are replaced by their footprints.

        Raises:
            TableError: A name is unknown, a value is invalid, or the table cannot be played. `problems`
                lists every mistake, in the words of the table file.

        Examples:
            >>> import silverball as sb
            >>> table = sb.load_table("classic").replace(board={"gravty": 12})
            Traceback (most recent call last):
            ...
            silverball.errors.TableError: Classic: 1 problem
              board.gravty: unknown key: did you mean `gravity`?
        """
        return checked_table(_merged(self, changes), self.name, may_upgrade=True)


RULE_SECTIONS = {name: one for name, one in list_sections(Table).items() if one.__name__ in rulebook.__all__}
"""The sections of a table file that hold the rules of its game, and the model of each."""

PART_KINDS = {name: one for name, one in list_sections(Table).items() if name not in RULE_SECTIONS}
"""The sections of a table file that hold a list of parts, and the model of each."""


def check_table(table: Table) -> list[Problem]:
    """Find every problem of a table.

    Returns:
        The problems, each with its path in the file, a sentence and a severity. Tables of `load_table`,
        `generate_table` and `Table.replace` have no errors, but perhaps warnings: parts that overlap, gaps
        that a ball barely fits, places where a ball would lie forever.

    Examples:
        >>> import silverball as sb
        >>> sb.check_table(sb.load_table("classic"))
        []
        >>> outside = sb.parts.Cylinder(center=(20.0, 0.0), radius=0.5)
        >>> [(p.path, p.severity) for p in sb.check_table(sb.Table(cylinder=(outside,)))]
        [('cylinder[0].center', 'error')]
    """
    parts = [(path, part) for path, _, part in table.parts()]
    problems = _count_problems(table.board, parts) or check_layout(Layout.of(table))
    problems += _format_problems(table) if table.format == 1 else _name_problems(parts)
    problems += rule_problems(_rulebook(table, ()), parts, table.board)
    return problems if _has_error(problems) else problems + try_recipe(table)


def checked_table(
    data: Mapping[str, Any], source: str, folder: Path | None = None, *, may_upgrade: bool = False
) -> Table:
    """Make a table from the data of a table file, with every check.

    Args:
        data: The sections of the file; a section may be a dict or a model.
        source: The name of the data in messages.
        folder: Where meshes are looked for; the current folder by default.
        may_upgrade: Whether keys of format 2 are allowed without `format = 2`.

    Raises:
        TableError: The data have errors; all of them are in `problems`. Warnings are not.
    """
    table, problems = examine(data, folder, may_upgrade=may_upgrade)
    if table is None:
        raise TableError(source, [problem for problem in problems if problem.is_error])
    return table


def examine(
    data: Mapping[str, Any], folder: Path | None = None, *, may_upgrade: bool = False
) -> tuple[Table | None, list[Problem]]:
    """Return the table that the data of a table file make, or None if they have errors; and all problems."""
    table: Table | None = None
    board: Board | None = None
    recipe: RandomRecipe | None = None
    parts: list[tuple[str, Part]] = []
    levels: Iterable[int] = range(LEVELS)  # whether a part is on one of them is known for valid data only
    problems: list[Problem] = []
    broken: list[tuple[Any, ...]] = []
    try:
        table = Table.model_validate(data)
        board, recipe, parts = table.board, table.random, [(path, part) for path, _, part in table.parts()]
        levels = [level.number for level in table.level]
    except ValidationError as error:
        problems += explain(error, Table)
        broken = _broken_places(error)
        board = _valid_board(data, error)
        if board is not None:
            recipe, parts = _valid_recipe(data, error), _valid_parts(data, error)
    is_first = not may_upgrade and data.get("format", 1) == 1
    if is_first:
        problems += _format_problems(data)
    elif table is None or table.format > 1:
        problems += _name_problems(parts)
    if board is not None:
        parts, footprint_problems = _with_footprints(parts, folder or Path())
        problems += footprint_problems
        too_many = _count_problems(board, parts)
        problems += too_many or check_layout(
            Layout.of_parts(board, parts, recipe, levels, 1 if is_first else 2)
        )
        problems += rule_problems(_rulebook(data if table is None else table, broken), parts, board)
    if table is None or _has_error(problems):
        return None, problems
    if table.has_mesh:
        table = table._with_parts(dict(parts))
    recipe_problems = try_recipe(table)
    return (None if recipe_problems else table), problems + recipe_problems


def _has_error(problems: list[Problem]) -> bool:
    return any(problem.is_error for problem in problems)


def _needs_format_2(table: Table) -> bool:
    sides = [paddle.side for paddle in table.paddle]
    return len(set(sides)) < len(sides) or next(places_of_format_2(Table, table), None) is not None


def _format_problems(data: Mapping[str, Any] | Table) -> list[Problem]:
    """The keys and values of format 2 in a table of format 1, and second paddles of a side."""
    remedy = "write format = 2 at the top of the file"
    problems = []
    for place, field, value in places_of_format_2(Table, data):
        if is_since_2(field):
            message = f"is new in format 2: {remedy}"
        else:
            message = f"may be {shown(value)} in format 2 only: {remedy}"
        problems.append(Problem(path_of(place), message))
    seen: dict[Any, str] = {}
    paddles = data.paddle if isinstance(data, Table) else data.get("paddle", ())
    for index, paddle in enumerate(paddles if isinstance(paddles, list | tuple) else ()):
        side = paddle.get("side") if isinstance(paddle, Mapping) else getattr(paddle, "side", None)
        if not isinstance(side, str):
            continue
        if side in seen:
            message = f"must not be {shown(side)} again: {seen[side]} is on this side already; or {remedy}"
            problems.append(Problem(f"paddle[{index}].side", message))
        seen.setdefault(side, f"paddle[{index}]")
    return problems


def _name_problems(parts: list[tuple[str, Part]]) -> list[Problem]:
    """The names that two parts share; rules speak of parts by their names."""
    problems = []
    seen: dict[str, str] = {}
    for path, part in parts:
        if part.name in seen:
            message = f"must not be {shown(part.name)} again: {seen[part.name]} has this name already"
            problems.append(Problem(f"{path}.name", message))
        elif part.name:
            seen[part.name] = path
    return problems


def _count_problems(board: Board, parts: list[tuple[str, Part]]) -> list[Problem]:
    """Limit the number of primitives."""
    count = sum(len(part.primitives(board)) for _, part in parts)
    if count <= ROWS_LIMIT:
        return []
    message = f"has {count:,} shapes, an edge of a wall counting as one, at most {ROWS_LIMIT:,}: remove parts"
    return [Problem("", message)]


def _merged(model: BaseModel, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return the data of a model, as in a table file, with changes merged into them."""
    data = model.model_dump(exclude_defaults=True)
    for key, value in changes.items():
        current = getattr(model, key, None) if key in type(model).model_fields else None
        if isinstance(value, Mapping) and isinstance(current, BaseModel):
            data[key] = _merged(current, value)
        else:
            data[key] = _plain_data(value)
    return data


def _plain_data(value: Any) -> Any:
    """Models, also in lists, as the data of a file."""
    if isinstance(value, BaseModel):
        return value.model_dump(exclude_defaults=True)
    if isinstance(value, Mapping):
        return {key: _plain_data(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain_data(item) for item in value]
    return value


def _broken_places(error: ValidationError) -> list[tuple[Any, ...]]:
    return [detail["loc"] for detail in error.errors(include_url=False, include_input=False)]


def _valid_board(data: Mapping[str, Any], error: ValidationError) -> Board | None:
    """The board without its broken keys; None if it cannot be measured."""
    broken = _broken_places(error)
    if ("board",) in broken or any(place[0] == "board" and place[1] in _MEASURES for place in broken):
        return None
    bad_keys = {place[1] for place in broken if place[0] == "board"}
    # Each remaining key is valid, but perhaps not together with the default of an invalid one (`rolling`
    # needs `friction`), so the board is built without validation.
    return Board.model_construct(**{k: v for k, v in data.get("board", {}).items() if k not in bad_keys})


def _valid_recipe(data: Mapping[str, Any], error: ValidationError) -> RandomRecipe | None:
    if "random" not in data or any(place[0] == "random" for place in _broken_places(error)):
        return None
    return RandomRecipe.model_validate(data["random"])


def _valid_parts(data: Mapping[str, Any], error: ValidationError) -> list[tuple[str, Part]]:
    """The valid parts under their own paths, so that they are checked too."""
    return list(_each_valid_part(data, _broken_places(error)))


def _each_valid_part(data: Mapping[str, Any], broken: list[tuple[Any, ...]]) -> Iterator[tuple[str, Part]]:
    for kind, model in PART_KINDS.items():
        if not issubclass(model, Part) or (kind,) in broken:
            continue
        bad = {place[1] for place in broken if place[0] == kind and len(place) > 1}
        for index, item in enumerate(data.get(kind, [])):
            if index not in bad:
                yield f"{kind}[{index}]", model.model_validate(item)


def _rulebook(data: Mapping[str, Any] | Table, broken: Iterable[tuple[Any, ...]]) -> Rulebook:
    """The rules of a table, or of data of which some places are broken."""
    found: dict[str, list[Placed]] = {}
    unread: dict[str, set[str]] = {}
    for section, model in RULE_SECTIONS.items():
        found[section], unread[section] = [], set()
        items = getattr(data, section) if isinstance(data, Table) else data.get(section, ())
        bad = {place[1] if len(place) > 1 else -1 for place in broken if place[0] == section}
        for index, item in enumerate(items if isinstance(items, list | tuple) else ()):
            if index in bad or -1 in bad:
                unread[section].add(str(item.get("name", "")) if isinstance(item, Mapping) else "")
            else:
                placed = item if isinstance(item, model) else model.model_validate(item)
                found[section].append(Placed(f"{section}[{index}]", placed))
    return Rulebook(found["lamp"], found["counter"], found["mode"], found["rule"], unread)


def _with_footprints(
    parts: list[tuple[str, Part]], folder: Path
) -> tuple[list[tuple[str, Part]], list[Problem]]:
    """The parts with every mesh replaced by its footprint, without those whose mesh is unusable."""
    problems: list[Problem] = []
    known: dict[tuple[type, str], Mapping[str, Any] | TableError] = {}  # each file is read once
    kept: list[tuple[str, Part]] = []
    for path, part in parts:
        if part.mesh_file is None:
            kept.append((path, part))
            continue
        key = (type(part), part.mesh_file)
        if key not in known and len(known) >= MESHES_LIMIT:
            message = f"is one mesh too many: a table has at most {MESHES_LIMIT}: give its footprint instead"
            problems.append(Problem(f"{path}.mesh", message))
            continue
        if key not in known:
            try:
                known[key] = part.footprint(folder / part.mesh_file)
            except TableError as error:
                known[key] = error
        found = known[key]
        if isinstance(found, TableError):
            problems += [Problem(f"{path}.mesh", problem.message) for problem in found.problems]
        else:
            kept.append((path, part.model_copy(update={"mesh": None, **found})))
    return kept, problems
