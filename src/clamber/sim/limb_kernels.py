"""MuJoCo's numbers of a batch of limbs turned into what plants tell, and pushes on tips into MuJoCo's, as kernels."""

from ..compiled import kernel
from ..control.kinematics import CENTRE, place_chain


@kernel
def look_behind_gears(qpos, qvel, stride, states):
    """Fill `states` with true angles and speeds at the output, shape (batch, 2, n).

    Args:
        qpos, qvel: Of the model, shape (batch, at least stride * n).
        stride: 1, or 2 where each joint's play follows it.
        states: Filled.
    """
    for b in range(states.shape[0]):
        for j in range(states.shape[2]):
            at = stride * j
            states[b, 0, j] = qpos[b, at]
            states[b, 1, j] = qvel[b, at]
            if stride == 2:
                states[b, 0, j] += qpos[b, at + 1]
                states[b, 1, j] += qvel[b, at + 1]


@kernel
def push_tips(joints, root, states, force, frames, tip, pushed, wrenches):
    """Put a force on every tip.

    Args:
        joints: Records of `JOINT` with the payload, shape (n,): the centre of mass is that of what really moves.
        root: One record of `ROOT`, shape (1,).
        states: True joint angles and speeds, shape (batch, 2, n).
        force: On the tip, base frame, x and y [N].
        frames: Scratch, shape (n, FRAME).
        tip: Scratch, shape (12,).
        pushed: Filled: force and moment on the last link at its centre of mass, base frame, shape (batch, 6).
        wrenches: Filled: wrench of each limb on what pushes it, shape (batch, 6).
    """
    fx, fy = force
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
