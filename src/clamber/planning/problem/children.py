"""Where actions lead to from many stances at once."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True, slots=True)
class Children:
    """Every valid child of a batch of stances: index of the parent, code of the action, stance."""

    parent: npt.NDArray[np.int32]
    code: npt.NDArray[np.int32]
    stance: npt.NDArray[np.void]


@dataclass(frozen=True, slots=True)
class Sprouts:
    """Every valid child of a batch of stances, in slots by parent: the first `count` of each row are filled."""

    count: npt.NDArray[np.int32]
    """Children of each parent, shape (n,)."""
    code: npt.NDArray[np.int32]
    """Actions, shape (n, slots)."""
    score: npt.NDArray[np.float64]
    """Weighted features less the toll, shape (n, slots)."""
    cell: npt.NDArray[np.int64]
    """Niches, shape (n, slots)."""
    done: npt.NDArray[np.uint8]
    """Whether every goal is met, shape (n, slots)."""
    keys: npt.NDArray[np.int64]
    """Shape (n, slots, words)."""
