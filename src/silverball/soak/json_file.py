"""How does JSON become an object of ours, when the file may come from anywhere?

Strictly: one object, no key twice, no number that is none, our format, then every field by its type and
bounds.
Every refusal is one sentence that begins with the file and says what is wrong.
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
        StateError: It cannot be read, or has more than `limit` bytes.
    """
    try:
        return read_text(path, limit, what)
    except Unreadable as error:
        raise StateError(f"{path}: {error}") from None


def made_from(text: str, source: str, what: str, form: int, make: Callable[[dict[str, Any]], _Made]) -> _Made:
    """What the values of a JSON object make.

    Args:
        text: The object; its key "format" says which format it has.
        source: What to call it in messages.
        what: What it should be, such as "a finding".
        form: The format that is known.
        make: Makes it of the other values; raises ValueError or StateError for what makes no sense.

    Raises:
        StateError: The text is something else.
    """
    try:
        values = json.loads(text, object_pairs_hook=_once, parse_constant=_no_number)
        if not isinstance(values, dict) or "format" not in values:
            raise ValueError('it has no "format"')
        found = values.pop("format")
        if type(found) is int and found > form:
            raise StateError(
                f"{source}: this has format {shown(found)}, this program reads format {form}; "
                "get a newer Silverball"
            )
        if found != form or type(found) is not int:
            raise ValueError(f'its "format" is not {form}')
        return make(values)
    except RecursionError:
        reason = "its brackets are nested too deeply"
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False, include_context=False)[0]
        reason = f"{'.'.join(map(str, first['loc']))[:60]}: {first['msg']}"
    except ValueError as error:
        reason = str(error)[:200]
    raise StateError(f"{source}: this is not {what}, or a damaged one ({reason})")


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) < len(pairs):
        raise ValueError("a key stands twice in it")
    return values


def _no_number(word: str) -> NoReturn:
    raise ValueError(f"{word} is no number")
