"""The random numbers are those of the published generator, and uniform."""

from __future__ import annotations

import numpy as np
import pytest

from silverball.physics.portable_math import threefry, uniform

ROTATIONS = (13, 15, 26, 6, 17, 29, 16, 24)


def plain_threefry(key: tuple[int, int], counter: tuple[int, int]) -> tuple[int, int]:
    """Threefry-2x32 with 20 rounds, as its authors describe it: one loop over rounds, a key every fourth."""
    keys = (*key, 0x1BD11BDA ^ key[0] ^ key[1])
    x = [(counter[i] + keys[i]) % 2**32 for i in (0, 1)]
    for number in range(20):
        x[0] = (x[0] + x[1]) % 2**32
        turned = x[1] << ROTATIONS[number % 8]
        x[1] = ((turned % 2**32) | (turned >> 32)) ^ x[0]
        if number % 4 == 3:
            added = number // 4 + 1
            x[0] = (x[0] + keys[added % 3]) % 2**32
            x[1] = (x[1] + keys[(added + 1) % 3] + added) % 2**32
    return x[0], x[1]


@pytest.mark.parametrize(
    ("key", "counter", "answer"),
    [
        ((0, 0), (0, 0), (0x6B200159, 0x99BA4EFE)),
        ((0xFFFFFFFF,) * 2, (0xFFFFFFFF,) * 2, (0x1CB996FC, 0xBB002BE7)),
        ((0x13198A2E, 0x03707344), (0x243F6A88, 0x85A308D3), (0xC4923A9C, 0x483DF7A0)),
    ],
)
def test_the_authors_known_answers_come_out(key, counter, answer) -> None:
    """Known answers of the Random123 library (kat_vectors, threefry2x32, 20 rounds)."""
    assert plain_threefry(key, counter) == answer
    assert threefry(*key, *counter) == answer


def test_it_is_the_generator_as_its_authors_describe_it() -> None:
    rng = np.random.default_rng(1)
    for words in rng.integers(0, 2**32, (2000, 4)).tolist():
        assert threefry(*words) == plain_threefry(tuple(words[:2]), tuple(words[2:]))


def test_uniform_takes_53_bits_of_the_two_words() -> None:
    for seed, draw in ((0, 0), (7, 3), (2**63 - 1, 2**40), (2**32, 1), (123456789012345, 2**33 + 5)):
        a, b = plain_threefry((seed % 2**32, seed >> 32), (draw % 2**32, draw >> 32))
        assert uniform(seed, draw) == ((a >> 5) * 2**26 + (b >> 6)) / 2**53


def test_uniform_is_uniform() -> None:
    """χ² of 64 cells of pairs of neighbouring draws, and of neighbouring seeds: 63 ± 11, so 120 is five
    sigma."""
    count = 32_000
    numbers = np.array([uniform(5, draw) for draw in range(count)])
    assert 0.0 <= numbers.min() < numbers.max() < 1.0
    assert abs(numbers.mean() - 0.5) < 5 / np.sqrt(12 * count)
    seeds = np.array([uniform(seed, 0) for seed in range(count)])
    for first, second in ((numbers[::2], numbers[1::2]), (seeds[::2], seeds[1::2])):
        cells = np.histogram2d(first, second, 8, [[0, 1], [0, 1]])[0]
        expected = count / 2 / 64
        assert ((cells - expected) ** 2 / expected).sum() < 120
