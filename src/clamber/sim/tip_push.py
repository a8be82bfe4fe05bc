"""A push on the tips of a batch of limbs as MuJoCo takes it, as a kernel: a force and its moment about the last link's centre of mass."""

from ..compiled import kernel
from ..control.kinematics import CENTRE, place_chain


@kernel
def push_tips(joints, root, states, fx, fy, frames, tip, pushed, wrenches):
    """Put the force (fx, fy) on every tip.

    Args:
        joints: Records of `JOINT` with the payload, shape (n,): the centre of mass is that of what really moves.
        root: One record of `ROOT`, shape (1,).
        states: True joint angles and speeds, shape (batch, 2, n).
        fx, fy: Force on the tip, base frame [N].
        frames: Scratch, shape (n, FRAME).
        tip: Scratch, shape (12,).
        pushed: Filled: force and moment on the last link at its centre of mass, base frame, shape (batch, 6).
        wrenches: Filled: wrench of each limb on what pushes it, shape (batch, 6).
    """
    last = joints.size - 1
    for b in range(states.shape[0]):
        place_chain(joints, root, states[b, 0], frames, tip)
        x = tip[0] - frames[last, CENTRE]
        y = tip[1] - frames[last, CENTRE + 1]
        z = tip[2] - frames[last, CENTRE + 2]
        pushed[b, 0] = fx
        pushed[b, 1] = fy
        pushed[b, 2] = 0.0
        pushed[b, 3] = -z * fy
        pushed[b, 4] = z * fx
        pushed[b, 5] = x * fy - y * fx
        wrenches[b, 0] = -fx
        wrenches[b, 1] = -fy
