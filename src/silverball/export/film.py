"""How do pictures become a file? PNG for one, GIF or MP4 for many.

A file is written under a temporary name beside its place and renamed when all of it is on the disk: an
interruption or a full disk leaves nothing, and a file that was there stays as it was.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, islice
from pathlib import Path
from typing import IO, TYPE_CHECKING, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.mixdown import Soundtrack
from silverball.errors import OutputError
from silverball.export.mp4 import require_av, write_mp4
from silverball.wholefile import is_special, write_whole

if TYPE_CHECKING:
    from PIL.Image import Image

Picture: TypeAlias = NDArray[np.uint8]
"""RGB, shape [row, column, 3]; rows and columns are even, as video wants them."""

FILM_RATES = {".gif": 25, ".mp4": 60}
"""Pictures per second by ending. A GIF counts in hundredths of a second; every viewer keeps to 4 of them."""

PALETTE_PICTURES = 50  # of the beginning of a GIF, from which its colours are chosen
PALETTE_EVERY = 5
SHADE_BITS = 2  # lowest bits of a colour that make no other shade when colours are chosen
COLORS = 255  # one more is kept for "as before"
DITHER = 5.0  # [level] of the fixed pattern that hides the steps between a GIF's colours


def check_output(path: Path, endings: Iterable[str], *, force: bool = False) -> None:
    """Say at once, not after a minute of work, that a file cannot be written.

    Raises:
        OutputError: The ending is unknown, the folder is not there or not writable, or the file exists.
        MissingExtra: An MP4 needs PyAV, and it is not installed.
    """
    allowed = tuple(endings)
    if path.suffix.lower() not in allowed:
        raise OutputError(
            f"{path}: the name must end in {' or '.join(allowed)}, got {path.suffix or 'no ending'!r}"
        )
    if not path.parent.is_dir():
        raise OutputError(f"{path}: there is no folder {str(path.parent)!r}; make it first")
    if path.is_dir():
        raise OutputError(f"{path}: this is a folder; give the name of a file")
    if is_special(path):
        raise OutputError(f"{path}: this is no ordinary file; give another name")
    if path.exists() and not force:
        raise OutputError(f"{path}: this file exists; choose another name, or overwrite it with --force")
    if not os.access(path.parent, os.W_OK):
        raise OutputError(f"{path}: no permission to write into the folder {str(path.parent)!r}")
    if path.suffix.lower() == ".mp4":
        require_av()


def write_picture(path: Path, picture: Picture) -> None:
    """Write one picture as PNG.

    Raises:
        OutputError: It cannot be written.
    """
    from PIL import Image

    encoded = io.BytesIO()
    Image.fromarray(picture).save(encoded, "PNG")
    _write_whole(path, lambda place: place.write_bytes(encoded.getbuffer()))


def write_film(
    path: Path, pictures: Iterable[Picture], sound: Callable[[], Soundtrack] | None = None
) -> None:
    """Write pictures as GIF or MP4, at the rate of `FILM_RATES`.

    Args:
        path: Of the file; its ending says which.
        pictures: All of one size.
        sound: Asked after the last picture; a GIF is silent.

    Raises:
        OutputError: It cannot be written.
        MissingExtra: An MP4 needs PyAV, and it is not installed.
    """
    if path.suffix.lower() == ".gif":
        _write_whole(path, lambda place: _write_gif(place, iter(pictures)))
    else:
        _write_whole(path, lambda place: write_mp4(place, pictures, FILM_RATES[".mp4"], sound))


def _write_whole(path: Path, write: Callable[[Path], object]) -> None:
    try:
        write_whole(path, write)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written ({error.strerror or error})") from None


def _write_gif(place: Path, pictures: Iterator[Picture]) -> None:
    beginning = list(islice(pictures, PALETTE_PICTURES))
    palette = _palette(beginning[::PALETTE_EVERY])
    pattern = _pattern(beginning[0].shape)
    images = (_with_palette(picture, palette, pattern) for picture in chain(beginning, pictures))
    first = next(images)
    hundredths = 100 // FILM_RATES[".gif"]
    with open(place, "wb") as file:
        first.save(
            cast(IO[bytes], _Sink(file)),
            "GIF",
            save_all=True,
            append_images=images,
            duration=10 * hundredths,
            loop=0,
            disposal=1,
            optimize=True,
        )


def _palette(pictures: list[Picture]) -> Image:
    """The colours that suit some pictures best.

    The floor has a thousand times the pixels of a ball or a paddle and would get nearly all colours; every
    shade therefore counts by the root of its pixels.
    """
    from PIL import Image

    pixels = np.concatenate(pictures).reshape(-1, 3) >> SHADE_BITS
    shades, counts = np.unique(pixels @ np.array([1 << 16, 1 << 8, 1]), return_counts=True)
    chosen = np.repeat(shades, np.ceil(np.sqrt(counts)).astype(np.int64))
    middles = (np.stack([chosen >> 16, chosen >> 8, chosen], axis=1) & 255) << SHADE_BITS
    sample = (middles + (1 << SHADE_BITS >> 1)).astype(np.uint8)
    return Image.fromarray(sample[None]).quantize(COLORS, Image.Quantize.MEDIANCUT)


def _with_palette(picture: Picture, palette: Image, pattern: NDArray[np.int16]) -> Image:
    """A picture in the colours of a palette.

    The dither is the same in every picture, so that what does not move does not flicker, and packs well.
    """
    from PIL import Image

    dithered = np.clip(picture + pattern, 0, 255).astype(np.uint8)
    return Image.fromarray(dithered).quantize(palette=palette, dither=Image.Dither.NONE)


def _pattern(shape: tuple[int, ...]) -> NDArray[np.int16]:
    row, column = np.arange(shape[0])[:, None], np.arange(shape[1])[None, :]
    # The same evenly spread points as in canvas.to_bytes, here in whole levels around zero.
    even = (0.7548776662 * column + 0.5698402910 * row) % 1.0 - 0.5
    return np.rint(DITHER * even).astype(np.int16)[..., None]


class _Sink:
    """A file as Pillow may have it: without a descriptor, into which it would write past Python.

    Its own writing does not notice when only a part of the bytes finds room.
    """

    def __init__(self, file: IO[bytes]) -> None:
        self.write = file.write
        self.flush = file.flush
