"""The small functions of the page do what their twins in Python do."""

from __future__ import annotations

import hashlib
import json
import random
import struct

import numpy as np
import pytest

from silverball.game.replay.digest import short_digests
from silverball.physics.records import PLAIN_WORLD
from silverball.web.pack import LETTERS, half_bytes, to_text
from silverball.web.waves import STEPS, decode, encode
from web.conftest import write_game_page

SIZES = (0, 1, 55, 56, 63, 64, 119, 120, 127, 128, 129, 256, 1000)
FLOATS = (
    0.0, -0.0, 1.0, -7.0, 0.1, 1e-4, 9.999e-5, 1e-5, 1.5e-7, -2.5e-300, 123456.789, 1e15, 1e16, 1.25e16, 1e22,
    5e-324,
)  # fmt: skip


@pytest.fixture(scope="module")
def page(browser, tmp_path_factory):
    """A page whose modules the tests call."""
    with browser.open(write_game_page(tmp_path_factory.mktemp("code") / "page.html", "classic")) as found:
        found.evaluate("silverball.isStopped = true")
        yield found


def data_of(size: int) -> bytes:
    return random.Random(size).randbytes(size)


@pytest.mark.parametrize("size", SIZES)
def test_bytes_are_unpacked_as_they_were(page, size):
    text = to_text(data_of(size))
    assert set(text.partition(" ")[2]) <= set(LETTERS)
    assert bytes(page.evaluate("(text) => [...modules['unpack.js'].fromText(text)]", text)) == data_of(size)


@pytest.mark.parametrize("size", SIZES)
def test_hashes_are_those_of_hashlib(page, size):
    data = data_of(size)
    sha, blake = page.evaluate(
        "(bytes) => { const data = Uint8Array.from(bytes), { sha256, blake2b } = modules['digests.js'];"
        " return [sha256(data), [...blake2b(data, 3)]]; }",
        list(data),
    )
    assert sha == hashlib.sha256(data).hexdigest()
    assert bytes(blake) == hashlib.blake2b(data, digest_size=3).digest()


def test_digests_of_a_record_are_those_of_a_replay(page):
    record = data_of(PLAIN_WORLD.itemsize)
    found = page.evaluate(
        "(bytes) => { const { shortDigests, rulesDigest } = modules['digests.js'];"
        " return shortDigests(Uint8Array.from(bytes), silverball.meta.world.groups) + rulesDigest('{}'); }",
        list(record),
    )
    assert found == short_digests(record, "{}")


def test_floats_are_written_as_python_writes_them(page):
    rng = random.Random(4)
    bits = (struct.pack("<Q", rng.getrandbits(64)) for _ in range(3000))
    numbers = [*FLOATS, *(rng.uniform(-12, 12) for _ in range(1000))]
    numbers += [x for x in (struct.unpack("<d", word)[0] for word in bits) if abs(x) < 1e308]
    texts = page.evaluate(
        "(texts) => texts.map((text) => new modules['python_json.js'].Float(Number(text)).toString())",
        [repr(number) for number in numbers],
    )
    assert texts == [json.dumps(number) for number in numbers]


def test_halves_are_rounded_to_even(page):
    numbers = [number / 4 for number in range(-40, 41)]
    assert page.evaluate("(list) => list.map(modules['poses.js'].round)", numbers) == [
        round(x) for x in numbers
    ]


def test_heights_of_16_bits_are_read_as_numpy_reads_them(page):
    heights = np.concatenate(
        [np.array([[-1.0, 0.0, 6e-8, 65504.0]]), np.random.default_rng(2).random((50, 4))]
    )
    pairs = half_bytes(heights.astype(np.float32)).reshape(-1, 2).tolist()
    found = page.evaluate(
        "(pairs) => pairs.map(([high, low]) => modules['unpack.js'].half((high << 8) | low))", pairs
    )
    assert found == heights.astype(np.float16).ravel().tolist()


def test_waves_are_unpacked_as_in_python(page):
    wave = (9000 * np.sin(np.arange(500) * 0.09) + 500 * np.random.default_rng(1).normal(size=500)).astype(
        int
    )
    packed = encode(wave.tolist())
    found = page.evaluate(
        "(bytes) => { const { sounds } = silverball.stage, context = { createBuffer: (one, count) => {"
        " const data = new Float32Array(count); return { data, getChannelData: () => data }; } };"
        " sounds.context = context; const { data } = sounds.buffer(Uint8Array.from(bytes));"
        " sounds.context = null; return [...data]; }",
        list(packed),
    )
    assert [round(32767 * value) for value in found] == decode(packed)


def test_a_packed_wave_sounds_like_the_original():
    rng = np.random.default_rng(5)
    wave = 12000 * np.sin(np.arange(4000) * 0.11) * np.exp(-np.arange(4000) / 900) + rng.normal(size=4000)
    again = np.array(decode(encode(wave.astype(int).tolist())))
    error = np.sqrt(np.mean((again - wave) ** 2)) / np.sqrt(np.mean(wave**2))
    assert error < 0.1, "20 dB below the sound"
    assert list(STEPS) == sorted(STEPS)
