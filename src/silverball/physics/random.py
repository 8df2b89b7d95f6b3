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
PARITY = 0x1BD11BDA  # fixed by the generator's authors, against a key of zeros


@inlined
def _rotated(word: int, bits: int) -> int:
    return ((word << bits) & WORD) | (word >> (32 - bits))


@inlined
def _mixed(a: int, b: int, r0: int, r1: int, r2: int, r3: int) -> tuple[int, int]:
    """Four rounds, each:  a ← a + b,  b ← rotate(b) xor a."""
    a = (a + b) & WORD
    b = _rotated(b, r0) ^ a
    a = (a + b) & WORD
    b = _rotated(b, r1) ^ a
    a = (a + b) & WORD
    b = _rotated(b, r2) ^ a
    a = (a + b) & WORD
    b = _rotated(b, r3) ^ a
    return a, b


@kernel
def threefry(key0: int, key1: int, counter0: int, counter1: int) -> tuple[int, int]:
    """Two random 32-bit words of a key and a counter of two 32-bit words each."""
    key2 = PARITY ^ key0 ^ key1
    a = (counter0 + key0) & WORD
    b = (counter1 + key1) & WORD
    a, b = _mixed(a, b, 13, 15, 26, 6)
    a, b = (a + key1) & WORD, (b + key2 + 1) & WORD
    a, b = _mixed(a, b, 17, 29, 16, 24)
    a, b = (a + key2) & WORD, (b + key0 + 2) & WORD
    a, b = _mixed(a, b, 13, 15, 26, 6)
    a, b = (a + key0) & WORD, (b + key1 + 3) & WORD
    a, b = _mixed(a, b, 17, 29, 16, 24)
    a, b = (a + key1) & WORD, (b + key2 + 4) & WORD
    a, b = _mixed(a, b, 13, 15, 26, 6)
    return (a + key2) & WORD, (b + key0 + 5) & WORD


@kernel
def uniform(seed: int, draw: int) -> float:
    """The draw-th uniform number of a seed, in [0, 1), with 53 random bits."""
    high, low = threefry(seed & WORD, (seed >> 32) & WORD, draw & WORD, (draw >> 32) & WORD)
    return ((high >> 5) * 67108864.0 + (low >> 6)) / 9007199254740992.0
