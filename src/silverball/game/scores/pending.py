"""Pending data: what cannot be written while another program holds the score file, spooled to another one.

Each program with pending data has a spool file `silverball-waiting-….json`, written whole and flushed to the
disk with every change, so that nothing is lost if the program dies. The next program that can write the score
file imports the spool: the same program or one that starts later. A spool may be imported twice, as after a
crash between the import and the removal of the spool; the token of each score detects this.
"""

from __future__ import annotations

import json
import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from silverball.game.match import MAX_PLAYERS
from silverball.game.scores.sqlite_file import INTEGER_LIMIT
from silverball.wholefile import write_whole

NAME = "silverball-waiting-"
SIZE_LIMIT = 64_000_000  # [bytes] of a spool that is imported; a score takes about 10,000
_INTEGER = Field(ge=-INTEGER_LIMIT, lt=INTEGER_LIMIT)


class NewScore(BaseModel):
    """A score to be saved, with everything that belongs to it.

    Attributes:
        token: Identifies the score until it has a number.
    """

    model_config = ConfigDict(strict=True, extra="forbid")

    token: str = Field(default_factory=lambda: secrets.token_hex(16))
    initials: str
    score: int = _INTEGER
    mode: str
    table_name: str
    table_digest: str
    table_text: str
    seed: int = _INTEGER
    replay: str
    played: int = Field(ge=0, le=253_402_300_799)
    player: int = Field(default=1, ge=1, le=MAX_PLAYERS)
    rank: int = Field(default=0, ge=0, lt=INTEGER_LIMIT)


class Pending(BaseModel):
    """Pending data: new scores, initials by the number of a score, the last game and settings."""

    model_config = ConfigDict(strict=True, extra="forbid")

    format: Literal[1] = 1
    scores: list[NewScore] = []
    initials: dict[int, str] = {}
    last_game: str | None = None
    settings: dict[str, Any] = {}

    @property
    def is_empty(self) -> bool:
        """Whether nothing is pending."""
        return self == Pending()


class Spool:
    """The spool file of this program, and access to those of others.

    Args:
        folder: The folder of the score file.

    Attributes:
        path: The spool file.
        pending: The pending data; call `write` after every change.
        is_written: Whether all pending data is on the disk.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.path = folder / f"{NAME}{secrets.token_hex(8)}.json"
        self.pending = Pending()
        self.is_written = True

    def write(self) -> None:
        """Write the pending data to the spool file; `is_written` says whether that succeeded."""
        text = json.dumps(self.pending.model_dump(), indent=1)
        try:
            write_whole(self.path, lambda place: place.write_text(text, encoding="utf-8"))
            self.is_written = True
        except OSError:
            self.is_written = False

    def clear(self, *, keep_file: bool) -> None:
        """Discard the pending data, which was imported.

        Args:
            keep_file: Leave the spool file for the next start, because the import was not persistent.
        """
        self.pending = Pending()
        self.is_written = True
        if not keep_file:
            with suppress(OSError):
                self.path.unlink()

    def claim_others(self) -> Iterator[tuple[Path, Pending | None]]:
        """The spools of other programs, those still running included; None for one that cannot be read.

        Each is renamed before it is read, so that data which its program adds meanwhile goes to a new file.
        """
        for path in sorted(self._folder.glob(f"{NAME}*.json")):
            if path == self.path:
                continue
            claimed = path.with_name(f"{NAME}{secrets.token_hex(8)}.json")
            try:
                if not stat.S_ISREG(path.lstat().st_mode) or path.lstat().st_size > SIZE_LIMIT:
                    continue
                os.rename(path, claimed)
                content = claimed.read_bytes()
            except OSError:
                continue  # another program has claimed it first
            try:
                yield claimed, Pending.model_validate_json(content)
            except ValidationError:
                yield claimed, None
