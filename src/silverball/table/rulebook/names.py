"""What the keys of rules hold: names of things of the table, and numbers by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from silverball.table.quantity import Count, Rule as ValueRule, refuse, shown

NAME_LENGTH = 80
MOST_NAMES = 64  # of one key

OwnName = Annotated[str, Field(min_length=1, max_length=NAME_LENGTH)]
Span = Literal["ball", "game"]
"""How long a state lasts: until the last ball in play is lost, or until the game is over."""


class Numbers(dict[str, int]):
    """Numbers by name, in the order of the names; hashable, because tables are."""

    def __hash__(self) -> int:  # type: ignore[override]
        """Hash the pairs."""
        return hash(tuple(self.items()))

    @classmethod
    def __get_pydantic_core_schema__(cls, _source: Any, _handler: GetCoreSchemaHandler) -> CoreSchema:
        """Be a plain dict to pydantic."""
        return core_schema.dict_schema()


def _checked_name(value: object) -> str:
    if not isinstance(value, str):
        refuse(f"must be a name in quotes, or a list of them, got {shown(value)}")
    if not 0 < len(value) <= NAME_LENGTH:
        refuse(f"must be a name of 1 to {NAME_LENGTH} characters, got {shown(value)}")
    return value


@dataclass(frozen=True)
class NameList(ValueRule):
    """One name, or a list of different ones."""

    def check(self, value: Any) -> tuple[str, ...]:
        """Return the names as a tuple."""
        names = tuple(map(_checked_name, value if isinstance(value, list | tuple) else [value]))
        if len(names) > MOST_NAMES:
            refuse(f"must have at most {MOST_NAMES} names, got {len(names)}")
        for index, name in enumerate(names):
            if name in names[:index]:
                refuse(f"must not name {shown(name)} twice")
        return names

    def json_schema(self) -> JsonSchemaValue:
        """Return the schema of a list of texts."""
        return {"type": "array", "items": {"type": "string"}, "form": "names"}


@dataclass(frozen=True)
class NumberOf(ValueRule):
    """Whole numbers by name, as `{ locks = 2 }`.

    Attributes:
        number: The rule for each number.
    """

    number: Count

    def check(self, value: Any) -> Numbers:
        """Return the numbers, sorted by name, so that equal tables have equal rules."""
        if not isinstance(value, Mapping) or not value:
            refuse(f"must be written {{ name = number }}, got {shown(value)}")
        if len(value) > MOST_NAMES:
            refuse(f"must have at most {MOST_NAMES} names, got {len(value)}")
        for name in value:
            _checked_name(name)
        return Numbers((name, self.number.check(value[name])) for name in sorted(value))

    def __get_pydantic_core_schema__(self, _source: Any, _handler: GetCoreSchemaHandler) -> CoreSchema:
        as_dict = core_schema.plain_serializer_function_ser_schema(dict)
        return core_schema.no_info_plain_validator_function(self.check, serialization=as_dict)

    def json_schema(self) -> JsonSchemaValue:
        """Return the schema of an object with numbers."""
        return {
            "type": "object",
            "additionalProperties": self.number.json_schema(),
            "form": "{ name = number }",
        }


Names = Annotated[tuple[str, ...], NameList()]
Increments = Annotated[Numbers, NumberOf(Count(-1_000_000_000, 1_000_000_000))]
Values = Annotated[Numbers, NumberOf(Count(0, 1_000_000_000))]
Thresholds = Annotated[Numbers, NumberOf(Count(1, 1_000_000_000))]
Seconds = Annotated[Numbers, NumberOf(Count(1, 600, "s"))]
NO_NUMBERS = Numbers()
