"""Strict reading of untrusted JSON files.

A file must hold one object, with no key twice, no NaN or infinity and the known format; then every field is
checked by its type and bounds. An error message is one sentence: the file, and what is wrong.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, NoReturn, TypeVar

from pydantic import ConfigDict, Field, ValidationError

from silverball.errors import StateError
from silverball.table.quantity import shown
from silverball.wholefile import Unreadable, read_text

STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)
Count = Annotated[int, Field(ge=0, lt=2**63)]
Amount = Annotated[float, Field(ge=0.0)]

_Made = TypeVar("_Made")


def file_text(path: Path, limit: int, what: str) -> str:
    """The text of a file.

    Raises:
        StateError: The file cannot be read, or has more than `limit` bytes.
    """
    try:
        return read_text(path, limit, what)
    except Unreadable as error:
        raise StateError(f"{path}: {error}") from None


def parse_json(
    text: str, source: str, what: str, known_format: int, make: Callable[[dict[str, Any]], _Made]
) -> _Made:
    """Parse a JSON object and make something of its values.

    Args:
        text: The object; its key "format" is the number of its format.
        source: The name of the text in messages.
        what: What the text should be, with its article, for messages.
        known_format: The format that can be read.
        make: Called with the other values; raises ValueError or StateError for invalid ones.

    Raises:
        StateError: The text is not such an object.
    """
    try:
        values = json.loads(text, object_pairs_hook=_unique_keys, parse_constant=_refuse_constant)
        if not isinstance(values, dict) or "format" not in values:
            raise ValueError('it has no "format"')
        found = values.pop("format")
        if type(found) is int and found > known_format:
            raise StateError(
                f"{source}: this has format {shown(found)}, this program reads format {known_format}; "
                "get a newer Silverball"
            )
        if found != known_format or type(found) is not int:
            raise ValueError(f'its "format" is not {known_format}')
        return make(values)
    except RecursionError:
        reason = "its brackets are nested too deeply"
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False, include_context=False)[0]
        reason = f"{'.'.join(map(str, first['loc']))[:60]}: {first['msg']}"
    except ValueError as error:
        reason = str(error)[:200]
    raise StateError(f"{source}: this is not {what}, or a damaged one ({reason})")


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) < len(pairs):
        raise ValueError("it has a key twice")
    return values


def _refuse_constant(word: str) -> NoReturn:
    raise ValueError(f"{word} is not a number")
