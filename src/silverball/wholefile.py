"""Reading and writing files as a whole, or not at all.

Only regular files of a limited size are read: a pipe without a writer would block forever, a device may
never end. A file is written under another name in the same folder and then renamed in one step. After an
error or an interruption the old file is unchanged, and no partial file is left.
"""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import stat
from collections.abc import Callable
from pathlib import Path

STDIN = "-"  # the name of standard input for many programs
NOTHING = "(nothing)"  # an empty path in messages
_KINDS = (
    (stat.S_ISDIR, "is a folder: give the path of {what}"),
    (
        stat.S_ISFIFO,
        "is a pipe, not a regular file: save its output to a file, and give the path of that",
    ),
    (stat.S_ISSOCK, "is a socket, not a regular file: give the path of {what}"),
    (stat.S_ISCHR, "is a device, not a regular file: give the path of {what}"),
    (stat.S_ISBLK, "is a device, not a regular file: give the path of {what}"),
)
# Do not wait for a pipe, do not acquire a terminal, do not convert line ends on Windows.
_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOCTTY", "O_BINARY"))


class Unreadable(Exception):
    """A file cannot be read; the message continues a sentence that starts with its path."""


def read_text(path: str | os.PathLike[str], limit: int, what: str) -> str:
    """Read a UTF-8 text file, with or without a byte order mark.

    Args:
        path: The path of a regular file.
        limit: The largest size allowed [bytes].
        what: What it should be, for messages: "a replay".

    Raises:
        Unreadable: The file is missing, not a regular file, too long, or not text.
    """
    try:
        content = _content(path, limit, what)
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        place = f"byte {error.start + 1:,} is not part of a character"
        raise Unreadable(f"is not UTF-8 text ({place}), so it is not {what}, or it is damaged") from None
    except FileNotFoundError:
        if os.fspath(path) == STDIN:
            reason = (
                "is not a file, and standard input is not read: save it to a file, and give the path of that"
            )
        else:
            reason = "there is no such file: check the path"
        raise Unreadable(reason) from None
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        reason = getattr(error, "strerror", None) or str(error)
        raise Unreadable(f"cannot be read ({reason})") from None


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file in one step.

    Args:
        path: The path of the file. A link stays a link, and a replaced file keeps its permissions.
        write: A function that writes the file to the path it is given, which has the same ending.

    Raises:
        OSError: The file cannot be written, or something other than a regular file is in its place.
    """
    target = Path(os.path.realpath(path))
    if is_special(target):
        raise OSError(errno.EINVAL, "this is not a regular file", os.fspath(path))
    temporary = target.with_name(f".silverball-{secrets.token_hex(8)}{target.suffix.lower()}")
    try:
        write(temporary)
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())  # some disks report only now that they are full
        if target.exists():
            shutil.copymode(target, temporary)
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)


def is_missing(path: Path) -> bool:
    """Return whether there is nothing at a path; a loop of links is something."""
    try:
        os.stat(path)
    except FileNotFoundError:
        return True
    except OSError:
        pass
    return False


def is_special(path: Path) -> bool:
    """Return whether a path has something that a file must not replace: a folder, pipe, socket or device."""
    return path.exists() and not path.is_file()


def _content(path: str | os.PathLike[str], limit: int, what: str) -> bytes:
    """The bytes of a regular file."""
    # Checked before opening, because opening some devices has effects, and after, because it may change.
    _check_kind(os.stat(path), limit, what)
    with os.fdopen(os.open(path, _FLAGS), "rb") as file:
        _check_kind(os.fstat(file.fileno()), limit, what)
        content = file.read(limit + 1) or b""  # None: no data yet, if reading does not block
    if len(content) > limit:
        raise Unreadable(f"is longer than {limit:,} bytes, the limit for {what}")
    return content


def _check_kind(status: os.stat_result, limit: int, what: str) -> None:
    for is_kind, reason in _KINDS:
        if is_kind(status.st_mode):
            raise Unreadable(reason.format(what=what))
    if status.st_size > limit:
        raise Unreadable(f"is {status.st_size:,} bytes long, {what} has at most {limit:,}")
