"""How legs would share a load most evenly if each has to bear a little of it: the plane through the loads asks some to pull."""

import numpy as np

from ..types import Floats, Ints
from .loads import strain_of


def over_share(places: Floats, loads: Floats, stands: Ints, least: float) -> Floats:
    """By how much each standing leg carries more than its share, shape (n,) [N]; 0 for others. It adds up to no force and no moment.

    The shares are those of `strain_of` where all of these are `least` and more. A load far to one side would have the legs on the other
    pull: drawn in until they do, they would hang in the air when it swings back. So they get `least`, and the others the even rest.

    Args:
        places: Of the legs in the plate, shape (n, 2) [m].
        loads: Of the feet, shape (n,) [N].
        stands: 1 for legs that count, shape (n,).
        least: That each is to carry [N]; where fewer than three legs would have more, the load is left as it is.
    """
    over: Floats = strain_of(places, loads, stands)
    low = (stands > 0) & (loads - over < least)
    if not low.any():
        return over
    arms = np.column_stack([np.ones(len(places)), places])
    shares = np.where(stands > 0, least, 0.0)
    while True:
        free = (stands > 0) & ~low
        if free.sum() < 3:
            return np.zeros_like(loads)
        rest = arms.T @ loads - least * arms[low].sum(axis=0)
        shares[free] = arms[free] @ np.linalg.lstsq(arms[free].T @ arms[free], rest, rcond=None)[0]
        more = free & (shares < least)
        if not more.any():
            return np.where(stands > 0, loads - shares, 0.0)
        low |= more
        shares[more] = least
