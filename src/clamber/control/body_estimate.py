"""Where the body is, by the limbs that hold (Bevly 1997, 4.4.3). Kernel."""

import math

from ..compiled import kernel
from .leg import move_tips, place_tips


@kernel
def estimate_body(legs, q, qd, weights, holds, angle, angle_speed, with_encoder, tips, speeds, pose, twist):
    """Body pose and speed from the holding limbs.

    The angle is that of the seventh encoder, or that of the line between the tips of the first two holding limbs against the line of their
    holds (exact for any pair that is apart). The place is the mean over the holding limbs of hold less tip, by weight: a limb that takes
    over from another comes in little by little, and the pose does not jump.

    Args:
        legs: Records of `LEG`, shape (n,).
        q, qd: Joint angles and speeds, shape (n, 2).
        weights: Of the limbs that hold, 0 for others, shape (n,).
        holds: Believed places of their holds, shape (n, 2) [m].
        angle, angle_speed: Of the body by its own encoder [rad], [rad/s].
        with_encoder: Whether to use those.
        tips, speeds: Filled with the tips in the body frame and their speeds, shape (n, 2).
        pose, twist: Filled, shape (3,) [m], [rad].

    Returns:
        Number of holding limbs. With none, or one and no encoder, the pose cannot be told and is left as it was.
    """
    place_tips(legs, q, tips)
    move_tips(legs, q, qd, speeds)
    count = 0
    total = 0.0
    a = -1
    b = -1
    for i in range(legs.size):
        if weights[i] > 0.0:
            count += 1
            total += weights[i]
            if a < 0:
                a = i
            elif b < 0:
                b = i
    if count == 0 or (count == 1 and not with_encoder):
        return count
    if with_encoder:
        theta = angle
        omega = angle_speed
    else:
        dx = tips[b, 0] - tips[a, 0]
        dy = tips[b, 1] - tips[a, 1]
        ux = holds[b, 0] - holds[a, 0]
        uy = holds[b, 1] - holds[a, 1]
        theta = math.atan2(uy * dx - ux * dy, ux * dx + uy * dy)
        # nearest to the angle before, so that a turning body keeps count
        theta += 2.0 * math.pi * math.floor((pose[2] - theta) / (2.0 * math.pi) + 0.5)
        wx = speeds[b, 0] - speeds[a, 0]
        wy = speeds[b, 1] - speeds[a, 1]
        omega = -(dx * wy - dy * wx) / (dx * dx + dy * dy)
    c = math.cos(theta)
    s = math.sin(theta)
    x = 0.0
    y = 0.0
    vx = 0.0
    vy = 0.0
    for i in range(legs.size):
        if weights[i] > 0.0:
            part = weights[i] / total
            rx = c * tips[i, 0] - s * tips[i, 1]
            ry = s * tips[i, 0] + c * tips[i, 1]
            x += part * (holds[i, 0] - rx)
            y += part * (holds[i, 1] - ry)
            vx -= part * (c * speeds[i, 0] - s * speeds[i, 1] - omega * ry)
            vy -= part * (s * speeds[i, 0] + c * speeds[i, 1] + omega * rx)
    pose[0] = x
    pose[1] = y
    pose[2] = theta
    twist[0] = vx
    twist[1] = vy
    twist[2] = omega
    return count
