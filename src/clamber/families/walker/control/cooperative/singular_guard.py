"""How far the mechanism is from singular, with its slope, as a kernel.

The measure D of `families/walker/robot/two_frames.py` is zero where the mechanism is singular; with D_0 that of the same angle with
the origins on each other, sqrt(1 - D / D_0) is its nearness, at most the robot's guard. D / D_0 is smooth everywhere, so that is what
is bounded.
"""

import math

from .....compiled import inlined, kernel


@inlined
def _measure(delta, y, x_offset, y_offset, theta):
    """D and its derivatives by x, y, theta."""
    c, s = math.cos(theta), math.sin(theta)
    total, by_x, by_y, by_turn = 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        ax, ay = c * y[i, 0] - s * y[i, 1], s * y[i, 0] + c * y[i, 1]
        bx, by = c * y[j, 0] - s * y[j, 1], s * y[j, 0] + c * y[j, 1]
        dx, dy = c * y[k, 0] - s * y[k, 1], s * y[k, 0] + c * y[k, 1]
        # v = p + R B - A of the three actuators; the moment of the first, the cross product of the others
        ux, uy = x_offset + ax - delta[i, 0], y_offset + ay - delta[i, 1]
        vx, vy = x_offset + bx - delta[j, 0], y_offset + by - delta[j, 1]
        wx, wy = x_offset + dx - delta[k, 0], y_offset + dy - delta[k, 1]
        moment, cross = ax * uy - ay * ux, vx * wy - vy * wx
        total += moment * cross
        by_x += -ay * cross + moment * (wy - vy)
        by_y += ax * cross + moment * (vx - wx)
        turned = ax * ax + ay * ay - ax * ux - ay * uy
        by_turn += turned * cross + moment * (vx * dx + vy * dy - bx * wx - by * wy)
    return total, by_x, by_y, by_turn


@kernel
def guard_room(delta, y, pose, guard, slope):
    """D / D_0 less what the guard allows [-]: positive within it; -1 where every place of the angle is singular.

    Args:
        delta, y: Attachments of the frames, each in its own frame [m], shape (3, 2).
        pose: x, y [m], theta [rad] of the Y-frame in the Delta-frame, shape (3,).
        guard: Largest nearness [-].
        slope: Filled with its derivatives by the pose, shape (3,).
    """
    here, by_x, by_y, by_turn = _measure(delta, y, pose[0], pose[1], pose[2])
    centre, _, _, centre_turn = _measure(delta, y, 0.0, 0.0, pose[2])
    if centre == 0.0:
        slope[:] = 0.0
        return -1.0
    slope[0] = by_x / centre
    slope[1] = by_y / centre
    slope[2] = (by_turn - here / centre * centre_turn) / centre
    return here / centre - 1.0 + guard * guard
