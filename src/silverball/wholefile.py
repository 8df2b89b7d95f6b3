"""How is a file read or written whole, or not at all?

Reading takes ordinary files alone, of a bounded size: a pipe without a writer would wait for ever, a device
may never end. Writing goes under another name beside the file's place, then renamed in one step: whatever
goes wrong, an interruption included, what was there stays as it was and nothing half-written stays behind.
"""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import stat
from collections.abc import Callable
from pathlib import Path

STDIN = "-"  # what other programs call standard input
NOTHING = "(nothing)"  # what an empty path is called in messages
_KINDS = (
    (stat.S_ISDIR, "is a folder: give the path of {what}"),
    (
        stat.S_ISFIFO,
        "is a pipe and no ordinary file: save what comes from it, and give the path of that file",
    ),
    (stat.S_ISSOCK, "is a socket and no ordinary file: give the path of {what}"),
    (stat.S_ISCHR, "is a device and no ordinary file: give the path of {what}"),
    (stat.S_ISBLK, "is a device and no ordinary file: give the path of {what}"),
)
# A pipe is not waited for, a terminal does not become ours, and Windows changes no line ends.
_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOCTTY", "O_BINARY"))


class Unreadable(Exception):
    """A file cannot be read; the text is the rest of a sentence that begins with its path."""


def read_text(path: str | os.PathLike[str], limit: int, what: str) -> str:
    """The text of a file, without the mark that some editors put before it.

    Args:
        path: Of an ordinary file.
        limit: The most that it may have [bytes].
        what: What it should be, such as "a replay".

    Raises:
        Unreadable: It is not there, no ordinary file, too long, or no text.
    """
    try:
        content = _content(path, limit, what)
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        place = f"byte {error.start + 1:,} is no part of any character"
        raise Unreadable(f"is not UTF-8 text ({place}), so it is not {what}, or a damaged one") from None
    except FileNotFoundError:
        if os.fspath(path) == STDIN:
            reason = (
                "is no file, and standard input is not read: save it to a file, and give the path of that"
            )
        else:
            reason = "there is no such file: check the path"
        raise Unreadable(reason) from None
    except (OSError, ValueError) as error:  # ValueError: a path with a zero character in it
        reason = getattr(error, "strerror", None) or str(error)
        raise Unreadable(f"cannot be read ({reason})") from None


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file in one step.

    Args:
        path: Where it is to be. A link stays a link, and a file that is replaced keeps its permissions.
        write: Called with the place to write to, which has the same ending.

    Raises:
        OSError: It cannot be written, or something that is no ordinary file is in its place.
    """
    target = Path(os.path.realpath(path))
    if is_special(target):
        raise OSError(errno.EINVAL, "this is no ordinary file", os.fspath(path))
    temporary = target.with_name(f".silverball-{secrets.token_hex(8)}{target.suffix.lower()}")
    try:
        write(temporary)
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())  # some disks tell only now that they are full
        if target.exists():
            shutil.copymode(target, temporary)
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)


def is_missing(path: Path) -> bool:
    """Whether there is nothing at a path, so that a file can begin there; a circle of links is something."""
    try:
        os.stat(path)
    except FileNotFoundError:
        return True
    except OSError:
        pass
    return False


def is_special(path: Path) -> bool:
    """Whether there is something that a file must not replace: a folder, a pipe, a socket or a device."""
    return path.exists() and not path.is_file()


def _content(path: str | os.PathLike[str], limit: int, what: str) -> bytes:
    """The bytes of an ordinary file."""
    # Looked at before it is opened, for opening some devices does things, and then again, for it may change.
    _check_kind(os.stat(path), limit, what)
    with os.fdopen(os.open(path, _FLAGS), "rb") as file:
        _check_kind(os.fstat(file.fileno()), limit, what)
        content = file.read(limit + 1) or b""  # None: nothing yet, where reading does not wait
    if len(content) > limit:
        raise Unreadable(f"is longer than {limit:,} bytes, the most that {what} has")
    return content


def _check_kind(status: os.stat_result, limit: int, what: str) -> None:
    for is_kind, reason in _KINDS:
        if is_kind(status.st_mode):
            raise Unreadable(reason.format(what=what))
    if status.st_size > limit:
        raise Unreadable(f"is {status.st_size:,} bytes long, {what} has at most {limit:,}")
