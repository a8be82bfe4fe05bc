"""Which freedoms take part: named sets."""

from typing import Final, Literal

import numpy as np

from .....errors import StatedError
from .....types import Floats
from .planted_feet import Support
from .tool_chain import POSE

HEIGHT: Final = 2
"""Place of z among the freedoms."""
Freedoms = Literal["arm", "height", "levelling", "all"]
BODY: Final[dict[Freedoms, tuple[int, ...]]] = {
    "arm": (),
    "height": (HEIGHT,),
    "levelling": (HEIGHT, 4, 5),
    "all": (0, 1, 2, 3, 4, 5),
}
"""Set -> freedoms of the plate that it has beside the arm's: none; z; z, beta, gamma, all that moves while the Delta-frame stands; all."""
SUPPORT: Final[dict[Freedoms, Support]] = {"arm": "delta", "height": "delta", "levelling": "delta", "all": "y"}
"""Set -> the frame that has to stand for it: the plate slides and turns only while the Y-frame does."""


class FreedomsError(StatedError):
    """No set has so many degrees of freedom."""

    dof: int
    allowed: tuple[int, ...]

    def __str__(self) -> str:
        return f"no set has {self.dof} degrees of freedom; with this arm there are {', '.join(map(str, self.allowed))}"


def freedoms_of(dof: int, n_joints: int) -> Freedoms:
    """The set of so many degrees of freedom.

    Raises:
        FreedomsError: If there is none.
    """
    for name, body in BODY.items():
        if n_joints + len(body) == dof:
            return name
    raise FreedomsError(dof, tuple(n_joints + len(body) for body in BODY.values()))


def weights_of(freedoms: Freedoms, n_joints: int) -> Floats:
    """1 for each freedom that takes part, 0 for the others, shape (6 + joints,)."""
    out = np.zeros(POSE + n_joints)
    out[list(BODY[freedoms])] = 1.0
    out[POSE:] = 1.0
    return out
