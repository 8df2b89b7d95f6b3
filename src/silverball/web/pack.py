"""How arrays and pictures travel in a page: packed in Python, unpacked by `page/unpack.js`.

    arrays     one after the other, each at a multiple of 16 bytes, compressed
    pictures   lossless WebP, without transparency, because a canvas would multiply it into the colours
    sheets     many small pictures on two large ones, see `Sheets`
    text       all bytes: 13 bits are two printable characters, an eighth less than base64

A sprite needs five bytes a pixel: its colour, the share of the background that remains, and its height as a
16-bit float. The first sheet holds the colours, the second one share and height as red, green and blue.
"""

from __future__ import annotations

import io
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from silverball.drawing.pictures import Sprite

ALIGNMENT = 16  # bytes
SHEET_WIDTH = 2048  # [pixel]
RAW = -15  # zlib: a deflate stream without a header
BITS = 13  # in two letters
LETTERS = "".join(chr(code) for code in range(33, 127) if chr(code) not in "&<>")  # 91, and 91² > 2¹³
LEAST_SIZE = 1  # [pixel] of a picture, also if there is nothing on it


def compress(data: bytes) -> str:
    """Bytes as text, compressed."""
    packer = zlib.compressobj(9, zlib.DEFLATED, RAW, 9)
    return to_text(packer.compress(data) + packer.flush())


def to_text(data: bytes) -> str:
    """Bytes as text: their number, a space, and two of `LETTERS` for every 13 bits, the lowest bits first.

    Nothing in it means anything in HTML.
    """
    bits = np.unpackbits(np.frombuffer(data, np.uint8), bitorder="little")
    padded = np.concatenate([bits, np.zeros(-len(bits) % BITS, np.uint8)])
    numbers = padded.reshape(-1, BITS) @ (1 << np.arange(BITS))
    pairs = np.stack([numbers % len(LETTERS), numbers // len(LETTERS)], axis=1)
    letters = np.frombuffer(LETTERS.encode("ascii"), np.uint8)
    return f"{len(data)} {letters[pairs].tobytes().decode('ascii')}"


def picture(pixels: NDArray[np.uint8]) -> str:
    """A picture, RGB [row, column, 3], as text."""
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels)).save(out, "WEBP", lossless=True, quality=90, method=4)
    return to_text(out.getvalue())


def half_bytes(heights: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Heights as 16-bit floats: the high and the low byte, uint8 [row, column, 2]."""
    bits = heights.astype(np.float16).view(np.uint16)
    return np.stack([bits >> 8, bits & 255], axis=-1).astype(np.uint8)


class ArrayPack:
    """Arrays for the module's memory.

    Attributes:
        at: Of each array the offset [byte], the length [byte] and the shape.
    """

    def __init__(self) -> None:
        self.at: dict[str, list[Any]] = {}
        self._bytes = bytearray()

    def put(self, name: str, array: NDArray[Any]) -> None:
        """Add an array."""
        array = np.ascontiguousarray(array)
        self.at[name] = [len(self._bytes), array.nbytes, list(array.shape)]
        self._bytes += array.tobytes() + b"\0" * (-array.nbytes % ALIGNMENT)

    def to_text(self) -> str:
        """All arrays as text."""
        return compress(bytes(self._bytes))


class Sheets:
    """Sprites and flashes on two large pictures.

    They stand in rows, in the order in which they are put: poses of a part look alike, and compress well side
    by side.
    """

    def __init__(self, width: int = SHEET_WIDTH) -> None:
        self._width = width
        self._column = self._row = self._next_row = 0
        self._placed: list[tuple[int, int, NDArray[np.uint8], NDArray[np.uint8] | None]] = []

    def put_sprite(self, sprite: Sprite) -> list[int]:
        """Put a sprite; return left, top, width and height in the frame, and column and row on the sheets."""
        cover = np.concatenate([sprite.remaining[:, :, None], half_bytes(sprite.height)], axis=2)
        return self._put(sprite.left, sprite.top, sprite.added, cover)

    def put_light(self, left: int, top: int, pixels: NDArray[np.uint8]) -> list[int]:
        """Put a picture of light, RGB, without share and height; return the same."""
        return self._put(left, top, pixels, None)

    def _put(
        self, left: int, top: int, colors: NDArray[np.uint8], cover: NDArray[np.uint8] | None
    ) -> list[int]:
        rows, columns = colors.shape[:2]
        if columns > self._width:
            raise ValueError(f"a sprite may be {self._width} pixels wide, this one is {columns}")
        if self._column + columns > self._width:
            self._column, self._row = 0, self._next_row
        column, row = self._column, self._row
        self._placed.append((column, row, colors, cover))
        self._column += columns
        self._next_row = max(self._next_row, row + rows)
        return [left, top, columns, rows, column, row]

    def pictures(self) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
        """The two sheets: colours, and share with height; the second one ends with the last sprite."""
        ends = [row + len(colors) for _, row, colors, _ in self._placed]
        covered = [row + len(colors) for _, row, colors, cover in self._placed if cover is not None]
        colors_sheet, cover_sheet = (
            np.zeros((max([*rows, LEAST_SIZE]), self._width, 3), np.uint8) for rows in (ends, covered)
        )
        for column, row, colors, cover in self._placed:
            rows, columns = colors.shape[:2]
            colors_sheet[row : row + rows, column : column + columns] = colors
            if cover is not None:
                cover_sheet[row : row + rows, column : column + columns] = cover
        return colors_sheet, cover_sheet
