"""Sine, cosine and random numbers with the same bits on every machine.

**Sine and cosine** use + − × only. The C library's versions differ in the last bit between systems, and a
replay would drift apart. The argument is reduced to |r| ≤ π/4 by multiples of π/2, held in three parts; then
the Taylor series is summed from its smallest term. The error is at most 1 ulp for |x| ≤ 1e4, tested against
mpmath. Source: W. J. Cody, W. Waite, "Software Manual for the Elementary Functions" (1980), ch. 8.

**Random numbers** are counter-based: Threefry-2x32 with 20 rounds maps (key, counter) to 64 bits. There
is no hidden state. The world record holds the seed and the number of draws, so a copy continues exactly like
its original. Threefry needs only additions, rotations and exclusive-ors of 32-bit words, which 64-bit
integers do exactly, with and without the JIT. Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw,
"Parallel Random Numbers: As Easy as 1, 2, 3", SC11 (2011).
"""

from __future__ import annotations

from math import factorial, floor

from silverball.physics.kernel import inlined, kernel

# π/2 = HALF_PI_1 + HALF_PI_2 + HALF_PI_3; the first two have 33 bits or fewer, so that k times them is exact.
HALF_PI_1 = 1.5707963267341256141662597656250
HALF_PI_2 = 6.0771005063039659765627e-11
HALF_PI_3 = 2.02226624879595063154e-21
TWO_OVER_PI = 0.63661977236758134308

S3, S5, S7, S9, S11, S13, S15, S17 = (
    (-1.0) ** ((n - 1) // 2) / factorial(n) for n in (3, 5, 7, 9, 11, 13, 15, 17)
)
C4, C6, C8, C10, C12, C14, C16, C18 = (
    (-1.0) ** (n // 2) / factorial(n) for n in (4, 6, 8, 10, 12, 14, 16, 18)
)

WORD = 0xFFFFFFFF
ROTATIONS = (13, 15, 26, 6, 17, 29, 16, 24)  # bits, round after round, then from the first again
PARITY = 0x1BD11BDA  # fixed by the generator's authors, against a key of zeros


@inlined
def _sine(r: float, rest: float) -> float:
    """Compute sine of r + rest, |r| ≤ π/4, |rest| tiny:  r − r³/6 + …,  and  rest·cos r ≈ rest·(1 − r²/2)."""
    q = r * r
    tail = q * (S7 + q * (S9 + q * (S11 + q * (S13 + q * (S15 + q * S17)))))
    return r + (r * q * (S3 + q * (S5 + tail)) + rest * (1.0 - 0.5 * q))


@inlined
def _cosine(r: float, rest: float) -> float:
    """Compute cosine of r + rest, |r| ≤ π/4:  1 − r²/2 + r⁴/24 − …, plus the rounding error of 1 − r²/2."""
    q = r * r
    half = 0.5 * q
    head = 1.0 - half
    tail = q * q * (C4 + q * (C6 + q * (C8 + q * (C10 + q * (C12 + q * (C14 + q * (C16 + q * C18)))))))
    return head + (((1.0 - head) - half) + (tail - r * rest))


@kernel
def sine_cosine(x: float) -> tuple[float, float]:
    """Compute sine and cosine of an angle [rad], |x| ≤ 1e4."""
    if abs(x) <= 0.7853981633974483:  # π/4: nothing to reduce; the same bits as below
        return _sine(x, 0.0), _cosine(x, 0.0)
    turns = floor(x * TWO_OVER_PI + 0.5)
    a = x - turns * HALF_PI_1  # exact: both are multiples of the same small unit
    b = turns * HALF_PI_2
    r = a - b
    rest = ((a - r) - b) - turns * HALF_PI_3  # what the last subtraction lost
    quadrant = int(turns) & 3
    if quadrant == 0:
        return _sine(r, rest), _cosine(r, rest)
    if quadrant == 1:
        return _cosine(r, rest), -_sine(r, rest)
    if quadrant == 2:
        return -_sine(r, rest), -_cosine(r, rest)
    return -_cosine(r, rest), _sine(r, rest)


@inlined
def _rotate(word: int, bits: int) -> int:
    return ((word << bits) & WORD) | (word >> (32 - bits))


@inlined
def _mix(a: int, b: int, first: int) -> tuple[int, int]:
    """Apply four rounds, each:  a ← a + b,  b ← rotate(b) xor a."""
    for number in range(first, first + 4):
        a = (a + b) & WORD
        b = _rotate(b, ROTATIONS[number]) ^ a
    return a, b


@kernel
def threefry(key0: int, key1: int, counter0: int, counter1: int) -> tuple[int, int]:
    """Compute two random 32-bit words from a key and a counter of two 32-bit words each."""
    keys = (key0, key1, PARITY ^ key0 ^ key1)
    a = (counter0 + key0) & WORD
    b = (counter1 + key1) & WORD
    for group in range(1, 6):  # of four rounds
        a, b = _mix(a, b, 4 - 4 * (group % 2))
        a = (a + keys[group % 3]) & WORD
        b = (b + keys[(group + 1) % 3] + group) & WORD
    return a, b


@kernel
def uniform(seed: int, draw: int) -> float:
    """Compute the draw-th uniform number of a seed, in [0, 1), with 53 random bits."""
    high, low = threefry(seed & WORD, (seed >> 32) & WORD, draw & WORD, (draw >> 32) & WORD)
    return ((high >> 5) * 67108864.0 + (low >> 6)) / 9007199254740992.0
