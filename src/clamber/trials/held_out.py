"""Seeds that no tuning may use: success rates that are published come from them."""

from collections.abc import Sequence
from typing import Final

from ..errors import StatedError

FIRST_HELD_OUT: Final = 1_000_006_000
"""From here on. Every seed below is a training seed, whether it has been used or not; the five thousand from 1 000 000 000 on
were held out until false alarms of fault detection were found among the first of each and mended, the thousand from 1 000 005 000 on
until misses among them were looked at."""


class HeldOutError(StatedError):
    """Seeds are used for what they are not meant for."""

    says = "seeds {first} to {last} {problem}"
    first: int
    last: int
    problem: str


def are_held_out(seeds: Sequence[int]) -> bool:
    """Whether a range of seeds is held out, whole; of none it is not.

    Raises:
        HeldOutError: If some are and some are not, so that a rate would be of neither.
    """
    if not seeds:
        return False
    held = sum(seed >= FIRST_HELD_OUT for seed in (min(seeds), max(seeds)))
    if held == 1:
        raise HeldOutError(
            min(seeds),
            max(seeds),
            f"are partly held out: take them all below {FIRST_HELD_OUT} (training) or all from there on (held out)",
        )
    return held == 2


def check_training(seeds: Sequence[int]) -> None:
    """See to it that seeds may be learned from.

    Raises:
        HeldOutError: If any of them is held out.
    """
    if any(seed >= FIRST_HELD_OUT for seed in seeds):
        raise HeldOutError(
            min(seeds),
            max(seeds),
            f"are held out for rates, and nothing may be tuned on them: take seeds below {FIRST_HELD_OUT}",
        )


def seeds_in_words(seeds: Sequence[int]) -> str:
    """Such as "seeds 1 to 24: training"."""
    kind = "held out, no tuning has used them" if are_held_out(seeds) else "training"
    return f"seeds {min(seeds)} to {max(seeds)}: {kind}"
