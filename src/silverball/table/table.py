"""A whole table: the model `Table`, and the checks that make one of data.

Tables from files and changed copies (`Table.replace`) go through the same steps: the data are validated,
meshes are replaced by their footprints, the layout is checked, and a recipe is tried out. A constructor
validates the fields only, so that unusual boards are possible; `check_table` lists the problems of one.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, TypeAlias

from pydantic import BaseModel, BeforeValidator, Field, ValidationError

from silverball.errors import Problem, TableError
from silverball.table.check import check_layout
from silverball.table.explain import explain
from silverball.table.layout import Layout
from silverball.table.parts import (
    PART_KINDS,
    Arcade,
    Board,
    Cylinder,
    Model,
    Name,
    Paddle,
    RandomRecipe,
    SlantWall,
    StationaryPart,
    TriangularPrism,
)
from silverball.table.placement import try_recipe
from silverball.table.quantity import refuse, shown

FORMAT: Literal[1] = 1  # version of the file format
PARTS_LIMIT = 256  # parts of one kind in a table; chosen: ten times a rich table, checked in a second
MESHES_LIMIT = 32  # different meshes of a table; chosen: one may take a second

_MeshPart: TypeAlias = TriangularPrism | Cylinder

# Without these a layout cannot be measured; these are what `check` needs to know about a board.
_MEASURES = frozenset({"length", "width", "ball_radius", "wall_thickness", "gutter"})


def _known_format(value: Any) -> Any:
    if value != FORMAT or isinstance(value, bool):
        refuse(f"must be {FORMAT}, got {shown(value)}: a newer file needs a newer Silverball")
    return FORMAT


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

    format: Annotated[Literal[1], BeforeValidator(_known_format)] = FORMAT
    """The version of the file format."""
    name: Name = "Untitled"
    """The title of the table."""
    board: Board = Board()
    """The board and its borders."""
    slant_wall: Annotated[tuple[SlantWall, ...], Field(max_length=PARTS_LIMIT)] = ()
    """The slant walls."""
    paddle: Annotated[tuple[Paddle, ...], Field(max_length=PARTS_LIMIT)] = ()
    """The paddles, at most one per side."""
    triangular_prism: Annotated[tuple[TriangularPrism, ...], Field(max_length=PARTS_LIMIT)] = ()
    """The triangular prisms."""
    cylinder: Annotated[tuple[Cylinder, ...], Field(max_length=PARTS_LIMIT)] = ()
    """The cylinders."""
    random: RandomRecipe | None = None
    """The obstacles to place at random for each seed, if any."""
    arcade: Arcade = Arcade()
    """The rules of an arcade game."""

    @property
    def stationary_parts(self) -> tuple[StationaryPart, ...]:
        """The parts that do not move: slant walls, triangular prisms, cylinders, in this order."""
        return (*self.slant_wall, *self.triangular_prism, *self.cylinder)

    def parts(self) -> list[tuple[str, Any]]:
        """Return all parts, each with its path in the file, in the order in which kinds are documented."""
        return [
            (f"{kind}[{index}]", part)
            for kind in PART_KINDS
            for index, part in enumerate(getattr(self, kind))
        ]

    @property
    def has_mesh(self) -> bool:
        """Whether a part names a mesh file."""
        return any(part.mesh for part in self.triangular_prism) or any(part.mesh for part in self.cylinder)

    def resolved(self) -> Table:
        """Return the table with the footprints of its meshes, so that it needs no other file.

        Raises:
            TableError: A mesh cannot be read or used.
        """
        if not self.has_mesh:
            return self
        return self.model_copy(
            update={
                "triangular_prism": tuple(part.resolved() for part in self.triangular_prism),
                "cylinder": tuple(part.resolved() for part in self.cylinder),
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
        return checked_table(_merged(self, changes), self.name)


def check_table(table: Table) -> list[Problem]:
    """Find every problem of a table.

    Returns:
        The problems, each with its path in the file, a sentence and a severity. Tables of `load_table`,
        `generate_table` and `Table.replace` have no errors, but perhaps warnings: parts that overlap, gaps
        that a ball barely fits, places where a ball can lie forever.

    Examples:
        >>> import silverball as sb
        >>> sb.check_table(sb.load_table("classic"))
        []
        >>> outside = sb.parts.Cylinder(center=(20.0, 0.0), radius=0.5)
        >>> [(p.path, p.severity) for p in sb.check_table(sb.Table(cylinder=(outside,)))]
        [('cylinder[0].center', 'error')]
    """
    problems = check_layout(Layout.of(table))
    return problems if _has_error(problems) else problems + try_recipe(table)


def checked_table(data: Mapping[str, Any], source: str, folder: Path | None = None) -> Table:
    """Make a table from the data of a table file, with every check.

    Args:
        data: The sections of the file; a section may be a dict or a model.
        source: The name of the data in messages.
        folder: Where meshes are looked for; the current folder by default.

    Raises:
        TableError: The data have errors; all of them are in `problems`. Warnings are not.
    """
    table, problems = examine(data, folder)
    if table is None:
        raise TableError(source, [problem for problem in problems if problem.is_error])
    return table


def examine(data: Mapping[str, Any], folder: Path | None = None) -> tuple[Table | None, list[Problem]]:
    """Return the table that the data of a table file make, or None if they have errors; and all problems."""
    table: Table | None = None
    problems: list[Problem] = []
    try:
        table = Table.model_validate(data)
        parts: _Parts | None = _Parts(table.board, table.parts(), table.random)
    except ValidationError as error:
        problems += explain(error, Table)
        parts = _valid_parts(data, error)
    if parts is not None:
        parts, footprint_problems = _with_footprints(parts, folder or Path())
        problems += footprint_problems
        problems += check_layout(Layout.of_parts(*parts))
    if _has_error(problems) or table is None or parts is None:
        return None, problems
    if table.has_mesh:
        found = dict(parts.parts)
        table = table.model_copy(
            update={
                kind: tuple(found[f"{kind}[{index}]"] for index in range(len(getattr(table, kind))))
                for kind in PART_KINDS
            }
        )
    recipe_problems = try_recipe(table)
    return (None if recipe_problems else table), problems + recipe_problems


def _has_error(problems: list[Problem]) -> bool:
    return any(problem.is_error for problem in problems)


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


class _Parts(NamedTuple):
    """The board, the parts with their paths in the file, and the recipe, as far as they are valid."""

    board: Board
    parts: list[tuple[str, Any]]
    random: RandomRecipe | None


def _valid_parts(data: Mapping[str, Any], error: ValidationError) -> _Parts | None:
    """The valid parts, under their own paths, so that they are checked too.

    None if the board itself cannot be measured.
    """
    broken = [detail["loc"] for detail in error.errors(include_url=False, include_input=False)]
    if ("board",) in broken or any(place[0] == "board" and place[1] in _MEASURES for place in broken):
        return None
    bad_keys = {place[1] for place in broken if place[0] == "board"}
    # Each remaining key is valid, but perhaps not together with the default of an invalid one (`rolling`
    # needs `friction`), so the board is built without validation.
    board = Board.model_construct(**{k: v for k, v in data.get("board", {}).items() if k not in bad_keys})
    valid: list[tuple[str, Any]] = []
    for kind, model in PART_KINDS.items():
        usable = (kind,) not in broken
        bad = {place[1] for place in broken if place[0] == kind and len(place) > 1}
        valid += [
            (f"{kind}[{index}]", model.model_validate(item))
            for index, item in enumerate(data.get(kind, []) if usable else [])
            if index not in bad
        ]
    recipe = None
    if "random" in data and not any(place[0] == "random" for place in broken):
        recipe = RandomRecipe.model_validate(data["random"])
    return _Parts(board, valid, recipe)


def _with_footprints(parts: _Parts, folder: Path) -> tuple[_Parts, list[Problem]]:
    """The parts with every mesh replaced by its footprint, without those whose mesh is unusable."""
    problems: list[Problem] = []
    known: dict[tuple[type, str], _MeshPart | TableError] = {}  # a file that many parts name is read once

    def resolved(part: _MeshPart) -> _MeshPart | TableError:
        assert part.mesh is not None
        key = (type(part), part.mesh)
        if key not in known and len(known) >= MESHES_LIMIT:
            message = f"is one mesh too many: a table has at most {MESHES_LIMIT}: give its footprint instead"
            return TableError(part.mesh, [Problem("mesh", message)])
        if key not in known:
            try:
                known[key] = part.resolved(folder)
            except TableError as error:
                known[key] = error
        found = known[key]
        if isinstance(found, TableError):
            return found
        place = {"vertices"} if isinstance(found, TriangularPrism) else {"center", "radius"}
        return part.model_copy(update={"mesh": None, **{key: getattr(found, key) for key in place}})

    kept: list[tuple[str, Any]] = []
    for path, part in parts.parts:
        found = part if getattr(part, "mesh", None) is None else resolved(part)
        if isinstance(found, TableError):
            problems.extend(Problem(f"{path}.mesh", problem.message) for problem in found.problems)
        else:
            kept.append((path, found))
    return parts._replace(parts=kept), problems
