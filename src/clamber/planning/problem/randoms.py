"""Counter-based random numbers for kernels: the same draw for the same counters, on any number of threads."""

import numpy as np

from ...compiled import kernel

GOLDEN = np.uint64(0x9E3779B97F4A7C15)
MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
MIX_2 = np.uint64(0x94D049BB133111EB)
S30 = np.uint64(30)
S27 = np.uint64(27)
S31 = np.uint64(31)
S11 = np.uint64(11)
UNIT = 1.0 / 9007199254740992.0


@kernel
def scramble(x):
    """SplitMix64's finaliser (Steele, Lea, Flood 2014): every bit of the output depends on every bit of the input."""
    x = np.uint64(x) + GOLDEN
    x = (x ^ (x >> S30)) * MIX_1
    x = (x ^ (x >> S27)) * MIX_2
    return x ^ (x >> S31)


@kernel
def draw(seed, a, b, c):
    """64 random bits for three counters."""
    x = scramble(np.uint64(seed))
    x = scramble(x ^ np.uint64(a))
    x = scramble(x ^ np.uint64(b))
    return scramble(x ^ np.uint64(c))


@kernel
def unit(bits):
    """A float in [0, 1) from 64 random bits."""
    return float(bits >> S11) * UNIT


@kernel
def below(bits, n):
    """An integer in [0, n) from 64 random bits; n up to 2^32, bias under 2^-32."""
    return np.int64((bits >> np.uint64(32)) * np.uint64(n) >> np.uint64(32))
