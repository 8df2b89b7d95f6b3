"""The base of all models of a table, and the rules that many fields share."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Annotated, Any, Self, TypeAlias, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field
from pydantic.fields import FieldInfo

from silverball.table.primitive import Point
from silverball.table.quantity import POINT, Count, FixedList, Quantity, Rule

Triangle: TypeAlias = tuple[Point, Point, Point]
"""Three corners, (x, z) [u] each."""

Outline: TypeAlias = tuple[Triangle, float]
"""The three points of a convex core (x, z) and the radius around it [u]; fewer points are repeated."""

SineCosine: TypeAlias = Callable[[float], tuple[float, float]]
"""The sine and the cosine of an angle [rad]."""

Place = Annotated[Point, POINT]
Corners = Annotated[Triangle, FixedList(POINT, 3, "[[x, z], [x, z], [x, z]]")]
Restitution = Annotated[float, Quantity(0.0, 1.0)]
Falloff = Annotated[float, Quantity(0.0, 10.0, "s/u")]
SpeedFactor = Annotated[float, Quantity(0.1, 3.0)]
Friction = Annotated[float, Quantity(0.0, 2.0)]
HitSpeed = Annotated[float, Quantity(0.01, 10.0, "u/s")]
Kick = Annotated[float, Quantity(0.0, 100.0, "u/s")]
Points = Annotated[int, Count(0, 1_000_000, "points")]
Radius = Annotated[float, Quantity(0.05, 10.0, "u")]
Thickness = Annotated[float, Quantity(0.0, 1.0, "u")]
Name = Annotated[str, Field(max_length=80)]

SINCE_2 = Field(json_schema_extra={"since": 2})
"""Marks a key of format 2: a file that gives it needs `format = 2`, and its default is left out of digests,
so that those of older tables stay valid."""


def libm(angle: float) -> tuple[float, float]:
    """Return the sine and the cosine of an angle [rad] from the C library."""
    return math.sin(angle), math.cos(angle)


class Model(BaseModel):
    """The base of all models: frozen, and without unknown keys."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", use_attribute_docstrings=True, populate_by_name=True
    )

    def replace(self, **changes: Any) -> Self:
        """Make a copy with some fields changed, validated as by the constructor.

        Raises:
            ValidationError: A name is unknown, or a value has the wrong type or is out of range.

        Examples:
            >>> import silverball as sb
            >>> sb.parts.Cylinder(center=(5.0, 1.5), radius=0.6).replace(points=250).points
            250
        """
        return type(self)(**(self.model_dump(exclude_defaults=True) | changes))


def key_of(model: type[BaseModel], name: str) -> str:
    """Return the key in a file of a field of a model: its name, unless Python reserves the word."""
    return model.model_fields[name].alias or name


def field_of(model: type[BaseModel], key: str) -> FieldInfo | None:
    """Return the field of a model for a key of a file; None if there is none."""
    for name, field in model.model_fields.items():
        if key in (name, field.alias):
            return field
    return None


def is_since_2(field: FieldInfo) -> bool:
    """Whether a field is a key of format 2."""
    extra = field.json_schema_extra
    return isinstance(extra, dict) and extra.get("since") == 2


def rules_of(field: FieldInfo) -> Iterator[Rule]:
    """Yield the validation rules of a field."""
    yield from (item for item in field.metadata if isinstance(item, Rule))


def model_of(field: FieldInfo) -> type[Model] | None:
    """Return the model of a section of a file: of a field that is a model, or a list of models."""
    for kind in (field.annotation, *get_args(field.annotation)):  # `Model | None`, `tuple[Model, ...]`
        if isinstance(kind, type) and issubclass(kind, Model):
            return kind
    return None


@cache
def list_sections(root: type[BaseModel]) -> dict[str, type[Model]]:
    """Return the sections of a file that hold a list of parts, and the model of each."""
    return {
        name: model
        for name, field in root.model_fields.items()
        if get_origin(field.annotation) is tuple and (model := model_of(field)) is not None
    }


def places_of_format_2(
    model: type[BaseModel], content: Mapping[str, Any] | BaseModel
) -> Iterator[tuple[tuple[str | int, ...], FieldInfo, Any]]:
    """Yield the place of every key that needs `format = 2`, with its field and its value.

    Args:
        model: The model of the content.
        content: A section of a file, whose keys count if they are given; or a model, whose fields count if
            they differ from their defaults.
    """
    if isinstance(content, BaseModel):
        items = [
            (name, value)
            for name, field in type(content).model_fields.items()
            if (value := getattr(content, name)) != field.default
        ]
    else:
        items = list(content.items())
    for key, value in items:
        field = field_of(model, key)
        if field is None:
            continue
        section = model_of(field)
        if is_since_2(field) or any(not rule.was_allowed(value) for rule in rules_of(field)):
            yield (key,), field, value
        elif section is not None and isinstance(value, list | tuple):
            for index, item in enumerate(value):
                if isinstance(item, Mapping | BaseModel):
                    for place, inner, given in places_of_format_2(section, item):
                        yield (key, index, *place), inner, given
        elif section is not None and isinstance(value, Mapping | BaseModel):
            for place, inner, given in places_of_format_2(section, value):
                yield (key, *place), inner, given
