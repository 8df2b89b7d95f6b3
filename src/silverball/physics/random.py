"""The world's own random numbers: a counter, a key and a bijection between them.

Threefry-2x32 with 20 rounds turns (key, counter) into 64 random bits. There is no hidden state: the world
record holds the seed and the number of draws, so that a copy continues exactly like its original. It needs
only additions, rotations and exclusive-ors of 32-bit words, which 64-bit integers do exactly, with the JIT
and without.

Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3",
SC11 (2011).
"""

from __future__ import annotations

from silverball.physics.kernel import inlined, kernel

WORD = 0xFFFFFFFF
ROTATIONS = (13, 15, 26, 6, 17, 29, 16, 24)  # bits, round after round, then from the first again
PARITY = 0x1BD11BDA  # fixed by the generator's authors, against a key of zeros


@inlined
def _rotated(word: int, bits: int) -> int:
    return ((word << bits) & WORD) | (word >> (32 - bits))


@inlined
def _mixed(a: int, b: int, first: int) -> tuple[int, int]:
    """Four rounds, each:  a ← a + b,  b ← rotate(b) xor a."""
    for number in range(first, first + 4):
        a = (a + b) & WORD
        b = _rotated(b, ROTATIONS[number]) ^ a
    return a, b


@kernel
def threefry(key0: int, key1: int, counter0: int, counter1: int) -> tuple[int, int]:
    """Two random 32-bit words of a key and a counter of two 32-bit words each."""
    keys = (key0, key1, PARITY ^ key0 ^ key1)
    a = (counter0 + key0) & WORD
    b = (counter1 + key1) & WORD
    for four in range(1, 6):
        a, b = _mixed(a, b, 4 - 4 * (four % 2))
        a = (a + keys[four % 3]) & WORD
        b = (b + keys[(four + 1) % 3] + four) & WORD
    return a, b


@kernel
def uniform(seed: int, draw: int) -> float:
    """The draw-th uniform number of a seed, in [0, 1), with 53 random bits."""
    high, low = threefry(seed & WORD, (seed >> 32) & WORD, draw & WORD, (draw >> 32) & WORD)
    return ((high >> 5) * 67108864.0 + (low >> 6)) / 9007199254740992.0
