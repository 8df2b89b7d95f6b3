"""Soak campaigns: rounds until enough frames are done, with progress in one file and a file for each finding.

After every round the totals are written to a file, whole or not at all. The same soak continues from there,
so an interruption costs one round. The file belongs to the options and to the exact code of the physics:
totals of different programs must not be added up.
"""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import asdict, field, fields
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import AfterValidator, Field, InstanceOf
from pydantic.dataclasses import dataclass

from silverball.errors import OutputError, StateError
from silverball.physics.kernel import KERNEL_PACKAGES
from silverball.soak.finding import record_finding
from silverball.soak.json_file import STRICT, Count, file_text, parse_json
from silverball.soak.rounds import FindingPlace, Options, Totals, play_round
from silverball.source_digest import source_digest
from silverball.table.quantity import shown
from silverball.wholefile import STDIN, is_missing, write_whole

FORMAT = 1
MAX_FINDINGS = 100  # a soak ends after these: the solver is broken, more of them add nothing
MAX_FILES = 20  # findings that are written to files, for the same reason
SIZE_LIMIT = 2**20  # [bytes] of a log: a hundred times its usual size
DESCRIPTION = "a progress file of a soak"


def _file_name(name: str) -> str:
    if not name.endswith(".json") or Path(name).name != name or "\0" in name:
        raise ValueError("must be the name of a file")
    return name


@dataclass(config=STRICT)
class SoakLog:
    """What a soak has done so far.

    Attributes:
        options: `Options.as_dict()`.
        code: The hash of the code that did it.
        rounds: Rounds done.
        totals: Totals of these rounds.
        findings: The names of the files of findings, in the folder of the log.
    """

    options: dict[str, Any]
    code: str
    rounds: Count = 0
    totals: Totals = field(default_factory=Totals)
    # InstanceOf, because a file name may hold bytes that are not text, which pydantic refuses as a string.
    findings: Annotated[
        list[Annotated[InstanceOf[str], AfterValidator(_file_name)]], Field(max_length=MAX_FILES)
    ] = field(default_factory=list)

    def to_text(self) -> str:
        """The log as JSON."""
        return json.dumps({"format": FORMAT} | asdict(self), indent=1) + "\n"

    @classmethod
    def from_text(cls, text: str, source: str) -> Self:
        """Read a log.

        Raises:
            StateError: The text is not the log of a soak.
        """
        return parse_json(text, source, DESCRIPTION, FORMAT, cls._of)

    @classmethod
    def _of(cls, values: dict[str, Any]) -> Self:
        totals = values.get("totals")
        if not isinstance(totals, dict):
            raise ValueError("it has no totals")
        for kind, given in ((cls, values), (Totals, totals)):
            for part in fields(kind):  # a log that was begun has them all
                if part.name not in given:
                    raise ValueError(f"it has no {part.name}")
        return cls(**values | {"totals": Totals(**totals)})


def code_digest() -> str:
    """The hash of all sources that decide what a soak does."""
    return source_digest((*KERNEL_PACKAGES, "table"))


def log_name(options: Options) -> str:
    """The default file name of a soak: other options or other code give another name."""
    described = json.dumps([options.as_dict(), code_digest()]).encode()
    return (
        f"soak-{'hostile' if options.hostile else 'random'}-{hashlib.sha256(described).hexdigest()[:12]}.json"
    )


def load_or_begin(options: Options, path: Path) -> SoakLog:
    """The log in a file, or that of a new soak if there is no such file.

    Raises:
        StateError: The file is of another soak, or not a log.
    """
    if is_missing(path) and str(path) != STDIN:
        return SoakLog(options.as_dict(), code_digest())
    log = SoakLog.from_text(file_text(path, SIZE_LIMIT, DESCRIPTION), str(path))
    for key, value in options.as_dict().items():
        if log.options.get(key) != value:
            raise StateError(
                f"{path}: this soak was begun with {key} {shown(log.options.get(key))}, not {shown(value)}; "
                "give the same options, or another --progress file"
            )
    if log.code != code_digest():
        raise StateError(
            f"{path}: this soak was begun with another version of the code; begin a new one with another "
            "--progress file"
        )
    return log


Played = tuple[Totals, list[FindingPlace]]
RoundSource = Callable[[Options, int], Generator[Played]]
"""Plays the rounds of a soak from one on, without end, and yields each in its order."""


def soak(
    options: Options,
    frames: int,
    path: Path,
    progress: Callable[[int], None] | None = None,
    rounds: RoundSource | None = None,
) -> SoakLog:
    """Soak until a number of frames is done, continuing from the log in a file.

    Args:
        options: The options of the soak.
        frames: Frames to do in total, earlier runs included; the last round is completed.
        path: The file of the log; its folder is created.
        progress: Called from time to time with the frames done.
        rounds: What plays the rounds; None: this process, one after the other.

    Returns:
        The log; fewer frames are done only after `MAX_FINDINGS` findings.

    Raises:
        StateError: The file is of another soak.
        OutputError: The file cannot be written.
    """
    log = load_or_begin(options, path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _unwritable(path, error) from None

    def report(done: int) -> None:
        if progress is not None:
            progress(log.totals.frames + done)

    def here(options: Options, first: int) -> Generator[Played]:
        return (play_round(options, number, report) for number in itertools.count(first))

    with closing((rounds or here)(options, log.rounds)) as played:
        while log.totals.frames < frames and sum(log.totals.found.values()) < MAX_FINDINGS:
            totals, places = next(played)
            for place in places[: max(0, MAX_FILES - len(log.findings))]:
                finding = record_finding(options, place)
                name = f"{path.stem}-{finding.kind}-{place.round}-{place.world}.json"
                _write(path.with_name(name), finding.to_text())
                log.findings.append(name)
            log.totals.add(totals)
            log.rounds += 1
            _write(path, log.to_text())
            report(0)
    return log


def _write(path: Path, text: str) -> None:
    try:
        write_whole(path, lambda place: place.write_text(text, encoding="utf-8", newline="\n"))
    except OSError as error:
        raise _unwritable(path, error) from None


def _unwritable(path: Path, error: OSError) -> OutputError:
    return OutputError(f"{path}: cannot be written ({error.strerror or error}); give another --progress file")
