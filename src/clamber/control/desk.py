"""One tick by addresses: a controller's own arrays handed over as one table, as twelve of them cost more to hand over than a tick."""

import numpy as np

from ..compiled import carray, kernel, pointer
from .drive import drive
from .kinematics import FRAME
from .moment import LINES, SQUARES
from .records import JOINT, REPORT, ROOT, SETTINGS

ARRAYS = 9
"""Addresses in a desk: joints, root, settings, memory, frames, lines, squares, torques, reports; sizes follow."""
DESK_TORQUES = 7
"""The torques among them."""
JOINTS = 9
"""Number of joints."""
LAWS = 10
"""Records of settings."""
MEMORY = 11
"""Numbers that a limb's law remembers."""
LENGTH = 12
"""Of a line of scratch."""
SIDE = 13
"""Of a square of scratch."""
DESK = 14


@kernel
def drive_at(desk, aims, states, wrenches, mounts):
    """`drive` with the arrays whose addresses are in `desk`; their owner keeps them alive."""
    n = desk[JOINTS]
    batch = states.shape[0]
    side = desk[SIDE]
    return drive(
        carray(pointer(desk[0]), n, JOINT),
        carray(pointer(desk[1]), 1, ROOT),
        carray(pointer(desk[2]), desk[LAWS], SETTINGS),
        aims,
        states,
        wrenches,
        mounts,
        carray(pointer(desk[3]), (batch, desk[MEMORY]), np.float64),
        carray(pointer(desk[4]), (2 * n, FRAME), np.float64),
        carray(pointer(desk[5]), (LINES, desk[LENGTH]), np.float64),
        carray(pointer(desk[6]), (SQUARES, side, side), np.float64),
        carray(pointer(desk[7]), (batch, n), np.float64),
        carray(pointer(desk[8]), batch, REPORT),
    )
