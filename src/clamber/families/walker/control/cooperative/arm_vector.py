"""The arm in the plate's frame: the vector to its tool by its joints, as a kernel (the last factor of equation 8).

The arm's first moment of mass has the same form, with other lengths (`arm_moment.py`), so this kernel serves both.
"""

import math

from .....compiled import kernel


@kernel
def arm_vector(links, out, up, joints, a, da, dda):
    """The vector from the plate's origin to the tool, plate frame, and its derivatives.

    Args:
        links: Lengths of the pitching links [m], shape (n,).
        out: From the axis of joint 0 to that of joint 1, outwards [m].
        up: From the plate to the axis of joint 1 [m].
        joints: Angles [rad], shape (n + 1,): the turning joint, then the pitching ones.
        a: Filled with the vector [m], shape (3,).
        da: Filled with its first derivatives [m/rad], shape (n + 1, 3).
        dda: Filled with its second derivatives [m/rad^2], shape (n + 1, n + 1, 3).
    """
    n = links.size
    c0, s0 = math.cos(joints[0]), math.sin(joints[0])
    total = 0.0
    for i in range(n):
        total += joints[i + 1]
    # from the tip inwards: everything beyond joint j moves with it
    reach, rise = 0.0, 0.0
    for i in range(n - 1, -1, -1):
        reach += links[i] * math.cos(total)
        rise += links[i] * math.sin(total)
        total -= joints[i + 1]
        da[i + 1, 0] = -rise * c0
        da[i + 1, 1] = -rise * s0
        da[i + 1, 2] = reach
        for j in range(i + 1):
            # the inner of two pitching joints is carried by the outer one's part only
            dda[i + 1, j + 1, 0] = -reach * c0
            dda[i + 1, j + 1, 1] = -reach * s0
            dda[i + 1, j + 1, 2] = -rise
            for k in range(3):
                dda[j + 1, i + 1, k] = dda[i + 1, j + 1, k]
        dda[0, i + 1, 0] = rise * s0
        dda[0, i + 1, 1] = -rise * c0
        dda[0, i + 1, 2] = 0.0
        for k in range(3):
            dda[i + 1, 0, k] = dda[0, i + 1, k]
    reach += out
    a[0] = reach * c0
    a[1] = reach * s0
    a[2] = rise + up
    da[0, 0] = -reach * s0
    da[0, 1] = reach * c0
    da[0, 2] = 0.0
    dda[0, 0, 0] = -reach * c0
    dda[0, 0, 1] = -reach * s0
    dda[0, 0, 2] = 0.0
