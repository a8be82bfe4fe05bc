"""How sure a counted share is."""

import math
from typing import Final

Z95: Final = 1.959963984540054
"""Two-sided 95 % of the normal distribution."""


def wilson_interval(hits: int, n: int, z: float = Z95) -> tuple[float, float]:
    """Interval of a share of which `hits` of `n` are known, (Wilson, JASA 22, 1927; closed form).

    On average over shares it holds what it says, also near 0 and 1, where the usual p +- z s does not.

    Args:
        hits: How many of `n`, 0 to `n`.
        n: Trials; 0 tells nothing, so the whole of 0 to 1.
        z: Standard deviations to either side.
    """
    assert 0 <= hits <= n
    if n == 0:
        return 0.0, 1.0
    share, extra = hits / n, z * z / n
    middle = (share + extra / 2.0) / (1.0 + extra)
    half = z / (1.0 + extra) * math.sqrt(share * (1.0 - share) / n + extra / (4.0 * n))
    low = 0.0 if hits == 0 else max(0.0, middle - half)
    return low, 1.0 if hits == n else min(1.0, middle + half)
