"""Sine, cosine, exponential, logarithm and random numbers with the same bits on every machine.

**Sine and cosine** use + − × only. The C library's versions differ in the last bit between systems, and a
replay would drift apart. The argument is reduced to |r| ≤ π/4 by multiples of π/2, held in three parts; then
the Taylor series is summed from its smallest term. The error is at most 1 ulp for |x| ≤ 1e4, tested against
mpmath. Source: W. J. Cody, W. Waite, "Software Manual for the Elementary Functions" (1980), ch. 8.

**Exponential and logarithm** use + − × ÷ and exact scaling by powers of 2. With x = k·ln 2 + r, |r| ≤ ½·ln 2,
eˣ = 2ᵏ·(1 + (eʳ − 1)), and eʳ − 1 is a Taylor series. With x = 2ᵏ·(1 + f), ½√2 ≤ 1 + f ≤ √2, and
s = f/(2 + f), ln x = k·ln 2 + 2·(s + s³/3 + s⁵/5 + …). The error is at most 2 ulp, tested against mpmath.
Source of the order of summation: FDLIBM (Sun Microsystems, 1993), e_exp.c, s_expm1.c, e_log.c, s_log1p.c.

**Random numbers** are counter-based: Threefry-2x32 with 20 rounds maps (key, counter) to 64 bits. There
is no hidden state. The world record holds the seed and the number of draws, so a copy continues exactly like
its original. Threefry needs only additions, rotations and exclusive-ors of 32-bit words, which 64-bit
integers do exactly, with and without the JIT. Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw,
"Parallel Random Numbers: As Easy as 1, 2, 3", SC11 (2011).
"""

from __future__ import annotations

from math import factorial, floor, frexp, inf, ldexp

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

# ln 2 = LN2_HIGH + LN2_LOW; the first has 32 bits, so that k times it is exact.
LN2_HIGH = 6.93147180369123816490e-01
LN2_LOW = 1.90821492927058770002e-10
LOG2_E = 1.4426950408889634
HALF_SQRT_2 = 0.7071067811865476
MAX_EXP = 709.782712893384  # the exponential of a greater number overflows
MIN_EXP = -745.2  # the exponential of a smaller number is 0
MIN_EXPM1 = -40.0  # below, the exponential is less than half an ulp of 1

E2, E3, E4, E5, E6, E7, E8, E9, E10, E11, E12, E13, E14 = (1.0 / factorial(n) for n in range(2, 15))
L2, L4, L6, L8, L10, L12, L14, L16, L18, L20 = (2.0 / (n + 1) for n in range(2, 21, 2))

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
def _reduced_exp(x: float) -> tuple[int, float]:
    """Compute k and eʳ − 1 with x = k·ln 2 + r, |r| ≤ ½·ln 2."""
    k = floor(x * LOG2_E + 0.5)
    high = x - k * LN2_HIGH
    low = k * LN2_LOW
    r = high - low
    rest = (high - r) - low  # what the subtraction lost
    tail = E8 + r * (E9 + r * (E10 + r * (E11 + r * (E12 + r * (E13 + r * E14)))))
    tail = E2 + r * (E3 + r * (E4 + r * (E5 + r * (E6 + r * (E7 + r * tail)))))
    return k, r + (rest + r * r * tail)


@kernel
def exp(x: float) -> float:
    """Compute the exponential of a number; inf where it overflows."""
    if x > MAX_EXP:
        return inf
    if x < MIN_EXP:
        return 0.0
    k, rest = _reduced_exp(x)
    return ldexp(1.0 + rest, k)


@kernel
def expm1(x: float) -> float:
    """Compute eˣ − 1 without cancellation for small x; inf where it overflows."""
    if x > MAX_EXP:
        return inf
    if x < MIN_EXPM1:
        return -1.0
    k, rest = _reduced_exp(x)
    if k == 0:
        return rest
    if k > 53:  # 2^k − 1 is not exact, and the 1 does not matter
        return ldexp(1.0 + rest, k) - 1.0
    power = ldexp(1.0, k)
    return (power - 1.0) + power * rest


@inlined
def _log_of_sum(x: float, rest: float) -> float:
    """Compute the logarithm of x, plus a tiny number `rest`, for finite x > 0.

    ln(1 + f) = f − (f²/2 − s·(f²/2 + R))  with  s = f/(2 + f)  and  R = 2·(s²/3 + s⁴/5 + …).
    """
    mantissa, k = frexp(x)
    if mantissa < HALF_SQRT_2:
        mantissa, k = 2.0 * mantissa, k - 1
    f = mantissa - 1.0  # exact
    s = f / (2.0 + f)
    q = s * s
    tail = q * (L12 + q * (L14 + q * (L16 + q * (L18 + q * L20))))
    tail = q * (L2 + q * (L4 + q * (L6 + q * (L8 + q * (L10 + tail)))))
    half = 0.5 * f * f
    return k * LN2_HIGH - ((half - (s * (half + tail) + (k * LN2_LOW + rest))) - f)


@kernel
def log(x: float) -> float:
    """Compute the natural logarithm of a finite number > 0."""
    return _log_of_sum(x, 0.0)


@kernel
def log1p(x: float) -> float:
    """Compute ln(1 + x) without cancellation for small x, for finite x > −1."""
    total = 1.0 + x
    lost = x - (total - 1.0) if x < 1.0 else 1.0 - (total - x)  # what the addition lost, exactly
    return _log_of_sum(total, lost / total)


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
