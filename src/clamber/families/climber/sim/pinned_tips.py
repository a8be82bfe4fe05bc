"""Limbs fixed to their holds, as in Bevly (1997), Fig. 4.17: tips that can push as well as pull, and turn about the hold."""

from collections.abc import Mapping
from typing import Any, Final

from ....types import Floats
from ..world.board import Board

PIN_SOLREF: Final = (0.002, 1.0)
"""As stiff as two physics steps of 1 ms allow: under the robot's weight a tip gives way by some hundredths of a millimetre."""
PIN_SOLIMP: Final = (0.99, 0.999, 0.0005, 0.5, 2.0)


def pin_tips(spec: Any, board: Board, pinned: Mapping[str, int], pegs: Floats | None = None) -> None:
    """Fix tips of a climber's `MjSpec` to their pegs by constraints; those pegs touch nothing any more.

    Args:
        spec: Of `climber_spec`.
        board: Its holds as believed.
        pinned: Limb -> number of the hold.
        pegs: Where the holds truly are, shape (n_holds, 2) [m]; None: as believed.
    """
    import mujoco

    places = board.positions() if pegs is None else pegs
    numbers = [hold.number for hold in board.holds]
    for limb, number in pinned.items():
        x, y = places[numbers.index(number)]
        spec.worldbody.add_site(name=f"pin {number}", pos=(x, y, 0.0))
        pin = spec.add_equality(name=f"{limb} pinned", type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE)
        pin.name1, pin.name2 = f"{limb} tip", f"pin {number}"
        pin.solref, pin.solimp = PIN_SOLREF, PIN_SOLIMP
        peg = spec.geom(f"peg {number}")
        peg.contype, peg.conaffinity = 0, 0
