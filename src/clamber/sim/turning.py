"""Wrenches from the tip's frame into the base frame, as a kernel."""

from ..compiled import kernel
from ..control.kinematics import place_chain


@kernel
def turn_wrenches(joints, root, states, local, frames, tip, wrenches):
    """Wrenches in the base frame from those in the tip's frame, by given joint angles.

    Args:
        joints, root: The chain.
        states: Joint angles and speeds, shape (batch, 2, n).
        local: Force and moment at the tip, in the tip's frame, shape (batch, 6).
        frames, tip: Scratch, shapes (n, FRAME) and (12,).
        wrenches: Filled, shape (batch, 6).
    """
    for b in range(states.shape[0]):
        place_chain(joints, root, states[b, 0], frames, tip)
        for start in (0, 3):
            for i in range(3):
                total = 0.0
                for k in range(3):
                    total += tip[3 + 3 * i + k] * local[b, start + k]
                wrenches[b, start + i] = total
