"""Validation rules for the numbers, points and intervals of a table file.

The rules are small objects in the annotations of the models::

    gravity: Annotated[float, Quantity(0.0, 100.0, "u/s²")] = 10.0

Each takes a value from TOML or Python, returns the canonical Python value (float, int, tuple), and refuses
everything else with the range, the unit and the value it got. Booleans, quoted numbers and infinities are not
numbers here. Negative zero becomes zero, so that equal tables have equal texts and digests.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from datetime import date, time
from numbers import Integral, Real
from typing import Any, Never

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

SHOWN = 40  # characters of a refused value in a message; chosen to keep it on one line


def shown(value: object) -> str:
    """Format a value for a message: as TOML would write it, and short."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "a section"
    if isinstance(value, int) and not -(10**18) < value < 10**18:
        return "an integer of more than 18 digits"
    if isinstance(value, str) and len(value) > SHOWN:
        value = value[:SHOWN]  # a megabyte of text is cut before it is quoted
    if isinstance(value, date | time):  # a datetime is a date too
        text = value.isoformat()
    elif isinstance(value, list | tuple):
        text = "[" + ", ".join(shown(item) for item in value[:SHOWN]) + "]"
    else:
        text = repr(value)
    return text if len(text) <= SHOWN else text[: SHOWN - 1] + "…"


def refuse(message: str) -> Never:
    """Refuse a value with a sentence for the person who wrote it."""
    raise PydanticCustomError("silverball", "{message}", {"message": message})


class Rule(ABC):
    """A rule for a value: `check` returns the canonical value or refuses it."""

    @abstractmethod
    def check(self, value: Any) -> Any:
        """Return the canonical value, or refuse with a sentence: what was expected, what was given."""

    @abstractmethod
    def json_schema(self) -> JsonSchemaValue:
        """Return the rule as JSON Schema, for editors and generated reference pages."""

    def was_allowed(self, value: Any) -> bool:
        """Whether a value that is allowed was so in format 1 too."""
        return True

    def __get_pydantic_core_schema__(self, _source: Any, _handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(
        self, _schema: CoreSchema, _handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return self.json_schema()


@dataclass(frozen=True)
class Quantity(Rule):
    """A finite number between two bounds (both allowed), in a unit.

    Attributes:
        low: The least value that is allowed.
        high: The greatest value that is allowed.
        unit: The unit, empty for a pure number.
        before: The bounds in format 1, if they were narrower.
    """

    low: float
    high: float
    unit: str = ""
    before: tuple[float, float] | None = None

    @property
    def span(self) -> str:
        """The range in words: ``0.02 to 1 s``."""
        return f"{self.low:g} to {self.high:g} {self.unit}".rstrip()

    def check(self, value: Any) -> float:
        """Return the value as a float inside the range."""
        if isinstance(value, bool) or not isinstance(value, Real):
            refuse(f"must be a number, {self.span}, got {shown(value)}")
        try:
            number = float(value) + 0.0  # −0.0 becomes 0.0
        except OverflowError:
            number = math.inf
        if not self.low <= number <= self.high:  # also refuses NaN
            refuse(f"must be {self.span}, got {shown(value)}")
        return number

    def json_schema(self) -> JsonSchemaValue:
        """Return the schema of a number with its bounds."""
        return {"type": "number", "minimum": self.low, "maximum": self.high, "unit": self.unit}

    def was_allowed(self, value: Any) -> bool:
        """Whether a value lies in the bounds of format 1; true for what no format allows."""
        return _was_within(self, value)


@dataclass(frozen=True)
class Count(Rule):
    """An integer between two bounds (both allowed); `before` are the bounds in format 1, if narrower."""

    low: int
    high: int
    unit: str = ""
    before: tuple[int, int] | None = None

    def check(self, value: Any) -> int:
        """Return the value as an int inside the range."""
        span = f"{self.low:,} to {self.high:,} {self.unit}".rstrip()
        if isinstance(value, bool) or not isinstance(value, Integral):
            refuse(f"must be an integer, {span}, got {shown(value)}")
        number = int(value)
        if not self.low <= number <= self.high:
            refuse(f"must be {span}, got {shown(value)}")
        return number

    def json_schema(self) -> JsonSchemaValue:
        """Return the schema of an integer with its bounds."""
        return {"type": "integer", "minimum": self.low, "maximum": self.high}

    def was_allowed(self, value: Any) -> bool:
        """Whether a value lies in the bounds of format 1; true for what no format allows."""
        return _was_within(self, value)


def _was_within(rule: Quantity | Count, value: Any) -> bool:
    if rule.before is None or isinstance(value, bool) or not isinstance(value, int | float):
        return True
    return rule.before[0] <= value <= rule.before[1] or not rule.low <= value <= rule.high


@dataclass(frozen=True)
class FixedList(Rule):
    """A list of a fixed length with one rule for its items: a point, a triangle, an area.

    Attributes:
        item: The rule for each item.
        count: The number of items.
        form: The notation in messages: ``[x, z]``.
    """

    item: Rule
    count: int
    form: str

    def check(self, value: Any) -> tuple[Any, ...]:
        """Return the checked items as a tuple."""
        if not isinstance(value, list | tuple) or len(value) != self.count:
            refuse(f"must be written {self.form}, got {shown(value)}")
        return tuple(self.item.check(item) for item in value)

    def json_schema(self) -> JsonSchemaValue:
        """Return the schema of an array of exactly that many items."""
        schema: JsonSchemaValue = {"type": "array", "items": self.item.json_schema()}
        return schema | {"minItems": self.count, "maxItems": self.count}


@dataclass(frozen=True)
class ItemList(Rule):
    """A list of one or more items of one rule.

    Attributes:
        item: The rule for each item.
        most: The greatest number of items.
        form: The notation in messages: ``[0, 2]``.
        least: The least number of items.
    """

    item: Rule
    most: int
    form: str
    least: int = 1

    def check(self, value: Any) -> tuple[Any, ...]:
        """Return the checked items as a tuple."""
        if not isinstance(value, list | tuple) or len(value) < self.least:
            refuse(f"must be written {self.form}, got {shown(value)}")
        if len(value) > self.most:
            refuse(f"must have at most {self.most:,} items, got {len(value):,}")
        return tuple(self.item.check(item) for item in value)

    def json_schema(self) -> JsonSchemaValue:
        """Return the schema of an array of so many items."""
        schema: JsonSchemaValue = {"type": "array", "items": self.item.json_schema()}
        return schema | {"minItems": self.least, "maxItems": self.most}


@dataclass(frozen=True)
class Interval(Rule):
    """Two numbers, the least and the greatest, between which a value is drawn at random."""

    item: Quantity

    def check(self, value: Any) -> tuple[float, float]:
        """Return the two bounds, in order."""
        low, high = FixedList(self.item, 2, "[least, greatest]").check(value)
        if low > high:
            refuse(f"must be written [least, greatest], got {shown(value)}: swap the two")
        return low, high

    def json_schema(self) -> JsonSchemaValue:
        """Return the schema of an array of two numbers."""
        return FixedList(self.item, 2, "[least, greatest]").json_schema()


COORDINATE = Quantity(-100.0, 100.0, "u")
POINT = FixedList(COORDINATE, 2, "[x, z]")
