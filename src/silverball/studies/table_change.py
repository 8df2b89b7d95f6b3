"""Changes one number of a table by its path, with every check that a table file gets.

A path is written as in messages about tables: `board.gravity`, `paddle[0].length`, `random.gap`. Without
the number of a part all parts of its kind are changed: `paddle.length`. The name of a part stands for its
number: `paddle.left.length`, `cylinder.jackpot.points`. A number at the end is one of a list:
`cylinder[2].center[0]`.
"""

from __future__ import annotations

import math
import re
from typing import Any, NamedTuple

from pydantic import BaseModel

from silverball.errors import SilverballError, TableError
from silverball.table import Table

STEP = re.compile(r"([^.\[\]]+)|\[(\d{1,4})\]")
MOST_VALUES = 50
EXAMPLE = "for example paddle.length=1.8:2.4:7 or board.gravity=8,10,12"


class Sweep(NamedTuple):
    """Values for one number of a table.

    Attributes:
        path: Its path.
        values: The values, whole numbers as int.
    """

    path: str
    values: tuple[float, ...]


def parse_sweep(text: str) -> Sweep:
    """Read a sweep: `PATH=FROM:TO:HOW_MANY` or `PATH=VALUE,VALUE,…`.

    Raises:
        SilverballError: The text is something else, or has too many values.

    Examples:
        >>> from silverball.studies.table_change import parse_sweep
        >>> parse_sweep("paddle.length=1.8:2.4:3").values
        (1.8, 2.1, 2.4)
    """
    path, is_there, given = text.partition("=")
    try:
        if not is_there or not path.strip():
            raise ValueError
        if ":" in given:
            low, high, many = given.split(":")
            values = _between(float(low), float(high), int(many))
        else:
            values = tuple(float(value) for value in given.split(","))
        if not all(map(math.isfinite, values)):
            raise ValueError
    except ValueError:
        raise SilverballError(
            f"--sweep: expected PATH=FROM:TO:HOW_MANY or PATH=VALUE,VALUE, {EXAMPLE}, got {text!r}"
        ) from None
    if not 2 <= len(set(values)) == len(values) <= MOST_VALUES:
        raise SilverballError(
            f"--sweep: expected 2 to {MOST_VALUES} different values, {EXAMPLE}, got {text!r}"
        )
    return Sweep(path.strip(), tuple(int(value) if value.is_integer() else value for value in values))


def _between(low: float, high: float, many: int) -> tuple[float, ...]:
    """Evenly spaced values, rounded to ten digits, so that 0.1 steps look like it."""
    if not 2 <= many <= MOST_VALUES:
        raise ValueError
    return tuple(float(f"{low + (high - low) * step / (many - 1):.10g}") for step in range(many))


def changed(table: Table, path: str, value: float) -> Table:
    """The table with another value in one place, or in the same place of all parts of a kind.

    Args:
        table: The table.
        path: The place.
        value: The value.

    Raises:
        SilverballError: There is no such place, or a table with this value cannot be played; says which.

    Examples:
        >>> from silverball import load_table
        >>> from silverball.studies.table_change import changed
        >>> changed(load_table("classic"), "board.gravity", 12.0).board.gravity
        12.0
    """
    steps = [name or int(number) for name, number in STEP.findall(path)]
    if len(steps) < 2 or "".join(f"[{s}]" if isinstance(s, int) else f".{s}" for s in steps)[1:] != path:
        raise SilverballError(f"{path}: expected the path of a number of a table, {EXAMPLE}")
    section, rest = str(steps[0]), steps[1:]
    current = getattr(table, section, None) if section in Table.model_fields else None
    if not isinstance(current, BaseModel | tuple) or current == ():
        there = [name for name in Table.model_fields if isinstance(getattr(table, name), BaseModel | tuple)]
        known = ", ".join(name for name in there if getattr(table, name) != ())
        raise SilverballError(f"{path}: this table has no {section!r}; it has {known}")
    if isinstance(current, BaseModel):
        changes: Any = _with(_data(current), current, rest, value, path)
    else:
        chosen, rest = _chosen(current, rest, path)
        changes = [
            _with(_data(part), part, rest, value, path) if number in chosen else _data(part)
            for number, part in enumerate(current)
        ]
    try:
        return table.replace(**{section: changes})
    except TableError as error:
        problem = error.problems[0]
        place = f"{problem.path}: " if problem.path and problem.path != path else ""
        raise SilverballError(f"{path} = {value:g}: {place}{problem.message}") from None


def number_at(table: Table, path: str) -> float | int | None:
    """The number that is changed at a path, of the first part that it means; None if none is written there.

    Examples:
        >>> from silverball import load_table
        >>> from silverball.studies.table_change import number_at
        >>> number_at(load_table("classic"), "paddle.left.pivot[0]")
        -7.2
    """
    steps = [name or int(number) for name, number in STEP.findall(path)]
    current: Any = getattr(table, str(steps[0]), None) if steps else None
    rest = steps[1:]
    if isinstance(current, tuple) and current and rest:
        chosen, rest = _chosen(current, rest, path)
        current = current[min(chosen)]
    for step in rest:
        if isinstance(step, int):
            current = current[step] if isinstance(current, tuple) and step < len(current) else None
        else:
            current = getattr(current, step, None)
    return current if isinstance(current, int | float) and not isinstance(current, bool) else None


def _data(part: BaseModel) -> dict[str, Any]:
    return part.model_dump(exclude_defaults=True)


def _chosen(parts: tuple[Any, ...], steps: list[Any], path: str) -> tuple[set[int], list[Any]]:
    """The numbers of the parts that a path means, and what follows in it."""
    first = steps[0]
    if isinstance(first, int):
        if first >= len(parts):
            raise SilverballError(f"{path}: there are {len(parts)} of these, numbered from 0, got [{first}]")
        return {first}, steps[1:]
    if len(steps) > 1 and isinstance(steps[1], str):
        named = {number for number, part in enumerate(parts) if first in (_name(part), _side(part))}
        if not named:
            names = sorted(filter(None, {*map(_name, parts), *map(_side, parts)}))
            known = f"; there are {', '.join(names)}" if names else ""
            raise SilverballError(f"{path}: there is no part named {first!r}{known}")
        return named, steps[1:]
    return set(range(len(parts))), steps


def _name(part: Any) -> str:
    return str(getattr(part, "name", ""))


def _side(part: Any) -> str:
    return str(getattr(part, "side", ""))


def _with(data: dict[str, Any], model: BaseModel, steps: list[Any], value: float, path: str) -> Any:
    """The data of a model with a value in it."""
    if not steps or isinstance(steps[0], int):
        raise SilverballError(f"{path}: expected the path of a number, {EXAMPLE}")
    key, *rest = steps
    if not rest:
        return data | {key: value}
    current = getattr(model, key, None)
    if isinstance(current, BaseModel):
        return data | {key: _with(_data(current), current, rest, value, path)}
    return data | {key: _in_list(current, rest, value, path)}


def _in_list(current: Any, steps: list[Any], value: float, path: str) -> Any:
    """A list with a value in it."""
    if not steps:
        return value
    step, *rest = steps
    if not isinstance(current, tuple) or not isinstance(step, int) or step >= len(current):
        raise SilverballError(f"{path}: there is no such place in this table")
    return [_in_list(one, rest, value, path) if n == step else one for n, one in enumerate(current)]
