"""What waits while another program holds the file of the scores, and where?

In a file beside it, `silverball-waiting-….json`, one for each program that has something to keep: written
whole and forced onto the disk with everything that is added, so that what waits there is kept, whatever
happens to the program. Whoever can write to the file of the scores again takes it in: the program itself, or
the next one that starts. A file may be taken in twice, as after a crash between taking in and removing it;
every score has a token, by which the second time is noticed.
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

from silverball.game.scores.score import WHOLE_NUMBERS
from silverball.wholefile import write_whole

NAME = "silverball-waiting-"
SIZE_LIMIT = 64_000_000  # [bytes] of a file that is taken in; a score takes about 10,000
_WHOLE = Field(ge=-WHOLE_NUMBERS, lt=WHOLE_NUMBERS)


class NewScore(BaseModel):
    """A score that is to be kept, with all that belongs to it.

    Attributes:
        token: Tells it from all others before it has a number.
    """

    model_config = ConfigDict(strict=True, extra="forbid")

    token: str = Field(default_factory=lambda: secrets.token_hex(16))
    initials: str
    score: int = _WHOLE
    mode: str
    table_name: str
    table_digest: str
    table_text: str
    seed: int = _WHOLE
    replay: str
    played: int = Field(ge=0, le=253_402_300_799)


class Waiting(BaseModel):
    """What waits: scores, initials by the number of a score, the last game and settings."""

    model_config = ConfigDict(strict=True, extra="forbid")

    format: Literal[1] = 1
    scores: list[NewScore] = []
    initials: dict[int, str] = {}
    last_game: str | None = None
    settings: dict[str, Any] = {}

    @property
    def is_nothing(self) -> bool:
        """Whether nothing waits."""
        return self == Waiting()


class WaitingRoom:
    """The file in which something waits.

    Args:
        folder: Where it is.

    Attributes:
        waiting: What waits; call `keep` after every change.
        is_safe: Whether all that waits is on the disk.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.path = folder / f"{NAME}{secrets.token_hex(8)}.json"
        self.waiting = Waiting()
        self.is_safe = True

    def keep(self) -> None:
        """Write down what waits."""
        text = json.dumps(self.waiting.model_dump(), indent=1)
        try:
            write_whole(self.path, lambda place: place.write_text(text, encoding="utf-8"))
            self.is_safe = True
        except OSError:
            self.is_safe = False

    def clear(self, *, keep_file: bool) -> None:
        """Nothing waits any more.

        Args:
            keep_file: Leave the file for the next start: what took its content in will not last.
        """
        self.waiting = Waiting()
        self.is_safe = True
        if not keep_file:
            with suppress(OSError):
                self.path.unlink()

    def others(self) -> Iterator[tuple[Path, Waiting | None]]:
        """What other programs have left behind, or have waiting just now; None for what cannot be read.

        Each file is renamed before it is read, so that nothing is removed that its program adds meanwhile.
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
                continue  # another program was quicker
            try:
                yield claimed, Waiting.model_validate_json(content)
            except ValidationError:
                yield claimed, None
