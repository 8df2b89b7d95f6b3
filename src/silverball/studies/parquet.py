"""The rows of a study as data frames and as Parquet files: a row a ball, a game, or an event.

Needs polars, which reads and writes Parquet by itself and scans a folder of files without loading them; the
extra `study` installs it.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from silverball.errors import MissingExtra, SilverballError
from silverball.physics.records import EventKind
from silverball.studies.result_folder import unwritable, write_file
from silverball.studies.study import Study

if TYPE_CHECKING:
    import polars

ROWS_A_FILE = 500_000
FOLDERS = {"ball": "balls", "game": "games", "event": "events"}


def require_polars() -> Any:
    """The module polars.

    Raises:
        MissingExtra: It is not installed.
    """
    try:
        import polars
    except ImportError:
        raise MissingExtra("a data frame or a Parquet file", "study") from None
    return polars


def frame(study: Study, kind: str = "ball") -> polars.DataFrame:
    """The rows of a study as one data frame.

    Args:
        study: The study, as far as it is done.
        kind: "ball", "game" or "event".

    Raises:
        MissingExtra: polars is not installed.
        SilverballError: There are no such rows: events are kept only if asked for.
    """
    found: polars.DataFrame = require_polars().concat(list(frames(study, kind)))
    return found


def frames(study: Study, kind: str) -> Iterator[polars.DataFrame]:
    """The rows of a study as a data frame for each chunk, in their order."""
    if kind not in FOLDERS:
        raise SilverballError(f"rows of a study are {', '.join(FOLDERS)}, got {kind!r}")
    if kind == "event" and not study.plan.keeps_events:
        raise SilverballError("this study has kept no events: plan it with keeps_events, or give --events")
    frame_of = require_polars().DataFrame
    for chunk in study.plan.chunks():
        if not study.folder.has(chunk.number):
            return
        columns = study.folder.read(chunk.number)
        prefix, arm = f"{kind}.", study.plan.arms[chunk.arm]
        rows = {name.removeprefix(prefix): one for name, one in columns.items() if name.startswith(prefix)}
        count = len(next(iter(rows.values())))
        if kind == "event":
            parts = columns["name.parts"]
            number = rows["part"]
            rows["part"] = np.where(number >= 0, parts[np.clip(number, 0, len(parts) - 1)], "")
            kinds = np.array(["", *(one.name.lower() for one in EventKind)])
            rows["kind"] = kinds[np.clip(rows["kind"], 0, len(kinds) - 1)]
        labels = {
            "arm": [arm.label] * count,
            "table": [arm.table.name] * count,
            "player": [arm.player] * count,
        }
        yield frame_of(labels | rows)


def write_parquet(study: Study) -> list[Path]:
    """Write the rows of a study into folders `games`, `balls` and `events`, each whole or not at all.

    Returns:
        The folders.

    Raises:
        MissingExtra: polars is not installed.
        OutputError: They cannot be written.
    """
    kinds = [kind for kind in FOLDERS if kind != "event" or study.plan.keeps_events]
    return [_write_kind(study, kind) for kind in kinds]


def _write_kind(study: Study, kind: str) -> Path:
    folder = study.folder.path / FOLDERS[kind]
    partial = folder.with_name(f".partial-{folder.name}")
    try:
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir()
        for number, rows in enumerate(_bundled(frames(study, kind))):
            write_file(partial / f"part-{number:05}.parquet", rows.write_parquet)
        shutil.rmtree(folder, ignore_errors=True)
        partial.rename(folder)
    except OSError as error:
        raise unwritable(folder, error) from None
    finally:
        shutil.rmtree(partial, ignore_errors=True)
    return folder


def _bundled(parts: Iterator[polars.DataFrame]) -> Iterator[polars.DataFrame]:
    """The same rows in frames of about ROWS_A_FILE."""
    concat = require_polars().concat
    held: list[polars.DataFrame] = []
    for part in parts:
        held.append(part)
        if sum(map(len, held)) >= ROWS_A_FILE:
            yield concat(held)
            held = []
    if held:
        yield concat(held)
