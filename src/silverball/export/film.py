"""Writes pictures to files: one as PNG, many as GIF or MP4.

A file is written under a temporary name in the same folder and renamed when it is complete. After an
interruption or on a full disk no partial file remains, and an existing file is unchanged.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, islice
from pathlib import Path
from typing import IO, TYPE_CHECKING, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from silverball.app.sound.mixdown import Soundtrack
from silverball.errors import OutputError
from silverball.export.mp4 import write_mp4
from silverball.wholefile import write_whole

if TYPE_CHECKING:
    from PIL.Image import Image

Picture: TypeAlias = NDArray[np.uint8]
"""RGB, uint8 [row, column, 3]; H.264 needs an even number of rows and columns."""

FILM_RATES = {".gif": 25, ".mp4": 60}
"""Pictures per second, by ending. GIF delays are in hundredths of a second; all viewers support 4 of them."""

PALETTE_PICTURES = 50  # first pictures of a GIF, from which its palette is chosen
PALETTE_STRIDE = 5  # only every fifth of these is used
SHADE_BITS = 2  # low bits of a colour that are ignored when the palette is chosen
COLORS = 255  # one of 256 is reserved for "unchanged"
DITHER = 5.0  # [level] amplitude of the dither


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
        path: Path of the file, ending in .gif or .mp4.
        pictures: All of the same size.
        sound: Called after the last picture, for an MP4; by default the film is silent.

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
    palette = _palette(beginning[::PALETTE_STRIDE])
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
    """Choose a palette for some pictures.

    The floor has a thousand times the pixels of a ball or a paddle and would get nearly all colours, so every
    shade is weighted by the square root of its number of pixels.
    """
    from PIL import Image

    pixels = np.concatenate(pictures).reshape(-1, 3) >> SHADE_BITS
    shades, counts = np.unique(pixels @ np.array([1 << 16, 1 << 8, 1]), return_counts=True)
    chosen = np.repeat(shades, np.ceil(np.sqrt(counts)).astype(np.int64))
    middles = (np.stack([chosen >> 16, chosen >> 8, chosen], axis=1) & 255) << SHADE_BITS
    sample = (middles + (1 << SHADE_BITS >> 1)).astype(np.uint8)
    return Image.fromarray(sample[None]).quantize(COLORS, Image.Quantize.MEDIANCUT)


def _with_palette(picture: Picture, palette: Image, pattern: NDArray[np.int16]) -> Image:
    """Convert a picture to a palette.

    The dither is the same in every picture, so still areas do not flicker, and compress well.
    """
    from PIL import Image

    dithered = np.clip(picture + pattern, 0, 255).astype(np.uint8)
    return Image.fromarray(dithered).quantize(palette=palette, dither=Image.Dither.NONE)


def _pattern(shape: tuple[int, ...]) -> NDArray[np.int16]:
    row, column = np.arange(shape[0])[:, None], np.arange(shape[1])[None, :]
    # Martin Roberts' R2 sequence, as in bake_table.to_bytes, here in whole levels around zero.
    even = (0.7548776662 * column + 0.5698402910 * row) % 1.0 - 0.5
    return np.rint(DITHER * even).astype(np.int16)[..., None]


class _Sink:
    """A file without a descriptor, so that Pillow writes through Python.

    If it wrote to a descriptor itself, Pillow would not notice partial writes.
    """

    def __init__(self, file: IO[bytes]) -> None:
        self.write = file.write
        self.flush = file.flush
