"""MP4 films with sound, encoded by PyAV (the libraries of FFmpeg) in one pass."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.mixdown import Soundtrack
from silverball.app.sound.synth import RATE
from silverball.errors import MissingExtra

# 0 is lossless, 23 the usual value; chosen so that thin bright lines stay clean
VIDEO_OPTIONS = {"crf": "15"}
SOUND_BIT_RATE = 160_000  # [bit/s]; a higher one makes no audible difference
CONTAINER_OPTIONS = {
    "movflags": "+faststart",  # the index comes first, so that a browser can play a partial download
    # The sound is encoded after the last picture. Until then the muxer holds the encoded pictures (less than
    # 1 MB for a second of film), so that pictures and sound of the same time lie side by side in the file.
    "max_interleave_delta": "0",
}


def require_av() -> None:
    """Check that PyAV is installed.

    Raises:
        MissingExtra: It is not installed.
    """
    try:
        import av  # noqa: F401
    except ImportError:
        raise MissingExtra("writing an MP4", "video") from None


def write_mp4(
    path: Path,
    pictures: Iterable[NDArray[np.uint8]],
    rate: int,
    sound: Callable[[], Soundtrack] | None = None,
) -> None:
    """Write pictures as an MP4 that browsers play: H.264 in yuv420p, AAC.

    Args:
        path: Path of the file, whose folder exists.
        pictures: RGB, uint8 `[row, column, 3]`, all of one size, with an even number of rows and columns.
        rate: Pictures per second.
        sound: Called after the last picture, so that it can return the sound of all pictures.

    Raises:
        OSError: The file cannot be written; a partial file may remain.
        MissingExtra: PyAV is not installed.
    """
    require_av()
    import av

    try:
        _encode(path, iter(pictures), rate, sound)
    except av.FFmpegError as error:  # not always an OSError
        raise OSError(error.errno, error.strerror) from error


def _encode(
    path: Path,
    pictures: Iterator[NDArray[np.uint8]],
    rate: int,
    sound: Callable[[], Soundtrack] | None,
) -> None:
    import av

    first = next(pictures)
    with av.open(path, "w", options=CONTAINER_OPTIONS) as film:
        video = film.add_stream("libx264", rate, options=VIDEO_OPTIONS)
        video.height, video.width = first.shape[:2]
        video.pix_fmt = "yuv420p"
        # All streams must be known before the first picture is written.
        audio = None if sound is None else film.add_stream("aac", RATE, layout="stereo")
        if audio is not None:
            audio.bit_rate = SOUND_BIT_RATE
        for number, picture in enumerate(chain([first], pictures)):
            shown = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), "rgb24")
            # The conversion that the ffmpeg program uses; the default of the library blurs colours.
            shown = shown.reformat(format="yuv420p", interpolation="BICUBIC")
            shown.pts, shown.time_base = number, Fraction(1, rate)
            film.mux(video.encode(shown))
        film.mux(video.encode())
        if audio is not None and sound is not None:
            track = sound()
            samples = np.ascontiguousarray(track.samples.reshape(1, -1))
            frame = av.AudioFrame.from_ndarray(samples, "s16", "stereo")
            frame.sample_rate, frame.time_base, frame.pts = track.rate, Fraction(1, track.rate), 0
            film.mux(audio.encode(frame))
            film.mux(audio.encode())
