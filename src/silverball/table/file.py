"""Table files: loading, saving and hashing tables.

`load_table` takes the name of a built-in table or the path of a TOML file. It returns a table that has passed
every check, or raises one `TableError` with all problems. `save_table` writes only what differs from the
defaults, so files stay short; a saved table loads as an equal one. A file is data: it is parsed, bounded in
size and never executed.

A string is a path if it ends in ``.toml`` or contains a separator; else it is the name of a built-in table.
"""

from __future__ import annotations

import difflib
import functools
import hashlib
import json
import os
import re
import tomllib
from importlib import resources
from pathlib import Path
from typing import Any

import tomli_w
from pydantic import BaseModel

from silverball.errors import OutputError, Problem, TableError, UnknownTable
from silverball.plain import plain
from silverball.table.arcade import Arcade
from silverball.table.kinds import Board
from silverball.table.kinds.part import in_order
from silverball.table.model import Model, is_since_2, key_of
from silverball.table.table import PART_KINDS, RULE_SECTIONS, Table, check_table, checked_table, examine
from silverball.wholefile import NOTHING, STDIN, Unreadable, read_text, write_whole

BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")  # what needs no quotes in TOML
SIZE_LIMIT = 2**18  # [bytes] of a table file; chosen: a real table of 150 parts takes a tenth of it


def table_names() -> tuple[str, ...]:
    """Return the names of the built-in tables, in alphabetical order.

    Examples:
        >>> import silverball as sb
        >>> sb.table_names()
        ('classic', 'original', 'parts', 'random', 'rolling', 'silver_comet')
    """
    folder = resources.files("silverball.table") / "tables"
    return tuple(sorted(entry.name[:-5] for entry in folder.iterdir() if entry.name.endswith(".toml")))


def load_table(name_or_path: str | os.PathLike[str]) -> Table:
    """Load a table; a file is checked.

    Args:
        name_or_path: A built-in name (see `table_names`) or the path of a ``.toml`` file.

    Returns:
        The table; meshes that the file names are replaced by their footprints.

    Raises:
        UnknownTable: No built-in table has this name.
        TableError: The file cannot be read or has problems; all of them are in `problems`.

    Examples:
        >>> import silverball as sb
        >>> sb.load_table("classic").board.gravity
        10.0
        >>> sb.load_table("clasic")
        Traceback (most recent call last):
        ...
        silverball.errors.UnknownTable: clasic: 1 problem
          there is no built-in table of this name: did you mean "classic"? ...
    """
    text = os.fspath(name_or_path) or NOTHING
    if isinstance(name_or_path, str) and not _looks_like_path(text):
        if text not in table_names():
            raise UnknownTable(text, _no_such_name(text))
        return _built_in(text)
    return parse_table(_read(text), text, folder=Path(text).parent)


def parse_table(text: str, source: str = "table", *, folder: Path | None = None) -> Table:
    """Make a table from TOML text, with every check that a file gets.

    Args:
        text: The text of a table file.
        source: Its name in messages, for example a path.
        folder: Where its meshes are looked for; the current folder by default.

    Raises:
        TableError: The text has problems; all of them are in `problems`.
    """
    return checked_table(_parse_toml(text, source), source, folder)


def examine_table(name_or_path: str) -> tuple[Table | None, list[Problem]]:
    """Return a table as `load_table` does, or None if it has errors; and all problems, warnings included.

    Raises:
        UnknownTable: No built-in table has this name.
        TableError: The file cannot be read or is not TOML.
    """
    path = name_or_path or NOTHING
    if not _looks_like_path(path):
        table = load_table(path)
        return table, check_table(table)
    return examine(_parse_toml(_read(path), path), Path(path).parent)


def save_table(table: Table, path: str | os.PathLike[str]) -> None:
    """Write a table to a file; on any error, an existing file stays unchanged.

    Args:
        table: The table to write.
        path: The path of the file, ending in ``.toml``.

    Raises:
        OutputError: The file cannot be written; the message says why.

    Examples:
        >>> import silverball as sb
        >>> heavy = sb.load_table("classic").replace(name="Heavy", board={"gravity": 12})
        >>> sb.save_table(heavy, "heavy.toml")
        >>> sb.load_table("heavy.toml") == heavy
        True
    """
    target = Path(os.path.realpath(path))
    if target.suffix != ".toml":
        raise OutputError(f"{os.fspath(path)}: a table file ends in .toml, for example {target.stem}.toml")
    if not target.parent.is_dir():
        raise OutputError(
            f"{os.fspath(path)}: the folder {str(target.parent)!r} does not exist; create it first"
        )
    text = dump_table(table)
    try:
        write_whole(target, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
    except OSError as error:
        raise OutputError(f"{os.fspath(path)}: cannot be written ({error.strerror or error})") from error


def dump_table(table: Table) -> str:
    """Return the text of a table file: one key per line, one block per part, without defaults."""
    blocks = ["\n".join([f"format = {table.format}", f"name = {_literal(table.name)}"])]
    if table.board != Board():
        blocks.append(_block("[board]", table.board))
    for kind in (*PART_KINDS, *RULE_SECTIONS):
        blocks += [_block(f"[[{kind}]]", part) for part in getattr(table, kind)]
    if table.random is not None:
        blocks.append(_block("[random]", table.random))
    if table.arcade != Arcade():
        blocks.append(_block("[arcade]", table.arcade))
    return "\n\n".join(blocks) + "\n"


def table_digest(table: Table) -> str:
    """Return a SHA-256 of all values of a table, defaults included, as a hex string.

    Equal tables have equal digests, on any machine and in any process. A mesh counts by its footprint.

    Raises:
        TableError: A mesh cannot be read.
    """
    data = _digest_data(table.resolved())
    if table.arcade == Arcade():
        del data["arcade"]  # so that digests from before it existed stay valid
    text = json.dumps(data, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def _digest_data(value: Any) -> Any:
    """All values of a model, without the keys of format 2 that have their defaults."""
    if isinstance(value, BaseModel):
        return {
            name: _digest_data(getattr(value, name))
            for name, field in type(value).model_fields.items()
            if not (is_since_2(field) and getattr(value, name) == field.default)
        }
    return [_digest_data(item) for item in value] if isinstance(value, tuple) else value


@functools.cache
def _built_in(name: str) -> Table:
    """Read a built-in table, once: tables are immutable. Its layout is checked by the tests, not here."""
    entry = resources.files("silverball.table") / "tables" / f"{name}.toml"
    return Table.model_validate(_parse_toml(entry.read_text(encoding="utf-8"), name))


def _looks_like_path(text: str) -> bool:
    separators = [separator for separator in ("/", os.sep, os.altsep) if separator]
    return text == STDIN or text.endswith(".toml") or any(separator in text for separator in separators)


def _no_such_name(name: str) -> str:
    names = table_names()
    close = difflib.get_close_matches(name.lower()[:60], names, n=1, cutoff=0.5)
    guess = f': did you mean "{close[0]}"?' if close else "."
    known = " and ".join([", ".join(names[:-1]), names[-1]])
    return f"there is no built-in table of this name{guess} Built in are {known}; a file ends in .toml"


def _read(path: str) -> str:
    """Return the text of a table file, or raise a `TableError` with the reason why it cannot be read."""
    try:
        return read_text(path, SIZE_LIMIT, "a table file")
    except Unreadable as error:
        raise _unreadable(path, str(error)) from None


def _unreadable(path: str, reason: str) -> TableError:
    return TableError(path, [Problem("", reason)])


def _parse_toml(text: str, source: str) -> dict[str, Any]:
    if not text.strip():
        example = 'it starts with  format = 1  and  name = "..."'
        raise _unreadable(source, f"is empty: a table file is TOML text, and {example}")
    try:
        return tomllib.loads(text)
    except RecursionError as error:
        raise _unreadable(source, "is not a table file: its brackets are nested too deeply") from error
    except ValueError as error:  # TOMLDecodeError, and numbers of more than 4,300 digits
        raise _unreadable(source, f"is not valid TOML: {str(error)[:200]}") from error


def _block(head: str, model: Model) -> str:
    """One section: its header, then the keys whose values differ from the defaults, positions first."""
    kind, values = type(model), model.model_dump(exclude_defaults=True)
    keys = [name for name in in_order(kind) if name in values]
    return "\n".join([head, *(f"{key_of(kind, name)} = {_literal(values[name])}" for name in keys)])


def _literal(value: Any) -> str:
    """A value as TOML on one line; tomli_w would put every number of a list on its own line."""
    if isinstance(value, tuple | list):
        return "[" + ", ".join(_literal(item) for item in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_literal(item)}" for key, item in value.items()) + " }"
    text = tomli_w.dumps({"value": value}).removeprefix("value = ").rstrip("\n")
    # A printed file must not control the terminal; tomli_w escapes only what TOML demands.
    return "".join(letter if plain(letter) == letter else f"\\U{ord(letter):08x}" for letter in text)


def _key(name: str) -> str:
    """A name as a key of TOML, in quotes if it needs them."""
    return name if BARE_KEY.fullmatch(name) else _literal(name)
