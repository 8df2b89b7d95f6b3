"""How do pictures become an MP4? ffmpeg makes it, and how ffmpeg ended is looked at.

imageio-ffmpeg brings the program; its own writer does not tell whether the film was written in full.
"""

from __future__ import annotations

import contextlib
import os
import re
import subprocess
import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.mixdown import Soundtrack
from silverball.errors import MissingExtra

QUALITY = 15  # ffmpeg's -crf: 0 loses nothing, 23 is usual; chosen so that the thin bright lines stay clean
SOUND_QUALITY = "160k"  # bits a second: no one hears a difference to more
_NAMED = re.compile(r"^\[[^\]]*\] ")  # which part of ffmpeg speaks: "[out#0/mp4 @ 0x55…] "


def require_ffmpeg() -> Path:
    """The program ffmpeg.

    Raises:
        MissingExtra: The package that brings it is not installed.
    """
    try:
        import imageio_ffmpeg
    except ImportError:
        raise MissingExtra("writing an MP4", "video") from None
    return Path(imageio_ffmpeg.get_ffmpeg_exe())


def write_mp4(
    place: Path,
    pictures: Iterable[NDArray[np.uint8]],
    size: tuple[int, int],
    rate: int,
    sound: Callable[[], Soundtrack] | None = None,
) -> None:
    """Write pictures of a width and height [pixel] as MP4, so many per second.

    Args:
        place: Of the file.
        pictures: RGB, shape [row, column, 3].
        size: Of each.
        rate: Pictures a second.
        sound: Asked after the last picture, so that it may be made of what happened in them.

    Raises:
        OSError: The film is not whole; the message is ffmpeg's own where it gave one.
    """
    raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}", "-r", str(rate), "-i", "-"]
    as_film = ["-c:v", "libx264", "-crf", str(QUALITY), "-pix_fmt", "yuv420p"]
    data = (np.ascontiguousarray(picture).data for picture in pictures)
    if sound is None:
        _run([*raw, *as_film], data, place)
        return
    silent = place.with_name(f"{place.stem}-silent{place.suffix}")
    try:
        _run([*raw, *as_film], data, silent)
        track = sound()
        # The pictures are copied as they are; only the sound is packed now.
        with_sound = ["-i", os.fspath(silent), "-f", "s16le", "-ar", str(track.rate), "-ac", "2", "-i", "-"]
        packed = ["-map", "0:v", "-map", "1:a", "-c:v", "copy", "-c:a", "aac", "-b:a", SOUND_QUALITY]
        _run([*with_sound, *packed], [track.samples.astype("<i2").tobytes()], place)
    finally:
        silent.unlink(missing_ok=True)


def _run(arguments: list[str], data: Iterable[Any], place: Path) -> None:
    """Let ffmpeg make a film of what it is fed with."""
    process = _start(arguments, place)
    complaints: list[bytes] = []
    # Read all the time: ffmpeg would wait for ever on a full pipe.
    reader = threading.Thread(target=lambda: complaints.extend(process.stderr), daemon=True)
    reader.start()
    try:
        try:
            for piece in data:
                process.stdin.write(piece)
            process.stdin.close()
        except BrokenPipeError:
            pass  # it has given up, and says why below
        code = process.wait()
    except BaseException:
        process.kill()
        process.wait()
        raise
    finally:
        with contextlib.suppress(OSError):
            process.stdin.close()
        reader.join()
    if code != 0 or not is_whole_mp4(place):
        words = b"".join(complaints).decode(errors="replace").strip().splitlines()
        reason = _NAMED.sub("", words[-1]).strip() if words else f"it ended with code {code}"
        raise OSError(f"ffmpeg could not finish the film: {reason}")


def is_whole_mp4(place: Path) -> bool:
    """Whether a file consists of complete boxes, among them the index ("moov") that every player needs.

    Source: ISO/IEC 14496-12, section 4.2: a box begins with its length, 4 bytes, and its kind, 4 bytes; the
    length 1 says that 8 bytes with the true length follow.
    """
    whole, at, kinds = place.stat().st_size, 0, set()
    with open(place, "rb") as file:
        while at < whole:
            file.seek(at)
            head = file.read(16)
            length = int.from_bytes(head[:4])
            if length == 1:
                length = int.from_bytes(head[8:])
            if length < 8:
                return False
            kinds.add(head[4:8])
            at += length
    return at == whole and {b"moov", b"mdat"} <= kinds


def _start(arguments: list[str], place: Path) -> Any:
    return subprocess.Popen(
        [
            os.fspath(require_ffmpeg()),
            "-y",
            "-v",
            "error",
            *arguments,
            "-movflags",
            "+faststart",
            os.fspath(place),
        ],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        start_new_session=True,  # Ctrl-C is for us alone; we end ffmpeg
    )
