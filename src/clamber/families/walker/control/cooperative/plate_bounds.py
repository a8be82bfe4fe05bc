"""What bounds the plate's pose: actuators' and legs' lengths, the mechanism's singularity, balance; values and gradients, as kernels.

How far the mechanism is from singular, with its slope, as a kernel.

The measure D of `families/walker/robot/two_frames.py` is zero where the mechanism is singular; with D_0 that of the same angle with
the origins on each other, sqrt(1 - D / D_0) is its nearness, at most the robot's guard. D / D_0 is smooth everywhere, so that is what
is bounded.
"""

import math

from .....compiled import inlined, kernel
from ...robot.two_frames import actuator_lengths, length_jacobian
from .planted import ALPHA, BETA, GAMMA, Z, heading_change
from .planted_feet import ACTUATOR, BALANCE, GUARD, LEG


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


DELTA_STANDS, Y_STANDS, BOTH_STAND = 0, 1, 2


@inlined
def y_in_delta(footing, q, turn, place):
    """Offset and twist of the Y-frame in the Delta-frame into place[0:3] [m, m, rad]."""
    if footing.support != Y_STANDS:
        place[0] = footing.offset[0]
        place[1] = footing.offset[1]
        place[2] = footing.twist
        return
    for i in range(2):
        total = 0.0
        for j in range(3):
            total += turn[j, i] * (footing.anchor[j] - q[j])
        place[i] = total
    place[2] = footing.heading - q[ALPHA] + heading_change(q[BETA], q[GAMMA])


@kernel
def bound_values(footing, q, w, values):
    """Every bounded quantity at a configuration.

    Args:
        footing: Record of `PLANTED_FEET`.
        q: Freedoms, shape (m,).
        w: A `Scratch` with R and the arm's first moment; its `y_place` is left with the Y-frame's offset and twist in the Delta-frame.
        values: Filled, shape (N_ROWS,): lengths [m]; room to the singularity's guard [-]; distances inside the support's edges [m].
    """
    turn, s, place, slope = w.turn, w.s, w.y_place, w.slope
    y_in_delta(footing, q, turn, place)
    px, py = place[0], place[1]
    c, sine = math.cos(place[2]), math.sin(place[2])
    actuator_lengths(footing.attachments[0], footing.attachments[1], px, py, place[2], values)
    values[GUARD] = guard_room(footing.attachments[0], footing.attachments[1], place, footing.guard, slope)
    cb, sb, cg, sg = math.cos(q[BETA]), math.sin(q[BETA]), math.cos(q[GAMMA]), math.sin(q[GAMMA])
    for frame in range(2):
        for i in range(3):
            x, y = footing.feet[frame, i, 0], footing.feet[frame, i, 1]
            if frame == 1:
                x, y = px + c * x - sine * y, py + sine * x + c * y
            values[LEG + 3 * frame + i] = (q[Z] - footing.heights[frame, i] - sb * x + cb * sg * y) / (cb * cg)
    total = footing.mass_frames + footing.mass_arm
    mx = (s[0] + footing.mass_frames * footing.share_y * px) / total
    my = (s[1] + footing.mass_frames * footing.share_y * py) / total
    mz = (s[2] + footing.mass_frames * footing.mass_height) / total
    gx = q[0] + turn[0, 0] * mx + turn[0, 1] * my + turn[0, 2] * mz
    gy = q[1] + turn[1, 0] * mx + turn[1, 1] * my + turn[1, 2] * mz
    for k in range(footing.n_edges):
        values[BALANCE + k] = footing.edges[k, 0] * gx + footing.edges[k, 1] * gy - footing.edges[k, 2]


@kernel
def bound_gradients(footing, q, w):
    """Derivatives of `bound_values` by the freedoms of a plate that moves freely (`along_feet` makes those of a planted one).

    Args:
        footing, q: As there.
        w: A `Scratch` after it; its `gradients` are filled.
    """
    m, turn, turn_1, s, ds, place = q.size, w.turn, w.turn_1, w.s, w.ds, w.y_place
    moved, slope, lengths, by_place, gradients = w.moved, w.slope, w.lengths, w.by_place, w.gradients
    gradients[:] = 0.0
    moved[:] = 0.0
    cb, sb, cg, sg = math.cos(q[BETA]), math.sin(q[BETA]), math.cos(q[GAMMA]), math.sin(q[GAMMA])
    if footing.support == Y_STANDS:
        for i in range(2):
            for j in range(3):
                moved[i, j] = -turn[j, i]
                for k in range(3):
                    moved[i, 3 + k] += turn_1[k, j, i] * (footing.anchor[j] - q[j])
        moved[2, ALPHA] = -1.0
        moved[2, BETA] = sg / (1.0 + cb * cg)
        moved[2, GAMMA] = sb / (1.0 + cb * cg)
    px, py = place[0], place[1]
    c, sine = math.cos(place[2]), math.sin(place[2])
    delta, y_points = footing.attachments[0], footing.attachments[1]
    length_jacobian(delta, y_points, px, py, place[2], lengths, by_place)
    guard_room(delta, y_points, place, footing.guard, slope)
    for k in range(6):
        for i in range(3):
            for j in range(3):
                gradients[ACTUATOR + i, k] += by_place[i, j] * moved[j, k]
            gradients[GUARD, k] += slope[i] * moved[i, k]
    for frame in range(2):
        for i in range(3):
            row = LEG + 3 * frame + i
            x, y = footing.feet[frame, i, 0], footing.feet[frame, i, 1]
            if frame == 1:
                tx, ty = c * x - sine * y, sine * x + c * y
                x, y = px + tx, py + ty
                for k in range(6):
                    dx, dy = moved[0, k] - ty * moved[2, k], moved[1, k] + tx * moved[2, k]
                    gradients[row, k] = (-sb * dx + cb * sg * dy) / (cb * cg)
            length = (q[Z] - footing.heights[frame, i] - sb * x + cb * sg * y) / (cb * cg)
            gradients[row, Z] += 1.0 / (cb * cg)
            gradients[row, BETA] += (-cb * x - sb * sg * y) / (cb * cg) + length * sb / cb
            gradients[row, GAMMA] += y + length * sg / cg
    total = footing.mass_frames + footing.mass_arm
    share = footing.mass_frames * footing.share_y
    mx, my = s[0] + share * px, s[1] + share * py
    mz = s[2] + footing.mass_frames * footing.mass_height
    for edge in range(footing.n_edges):
        row = BALANCE + edge
        for i in range(2):
            normal = footing.edges[edge, i]
            gradients[row, i] += normal
            for k in range(3):
                over = turn_1[k, i, 0] * mx + turn_1[k, i, 1] * my + turn_1[k, i, 2] * mz
                gradients[row, 3 + k] += normal * over / total
            for k in range(6):
                gradients[row, k] += normal * share * (turn[i, 0] * moved[0, k] + turn[i, 1] * moved[1, k]) / total
            for k in range(m - 6):
                over = turn[i, 0] * ds[k, 0] + turn[i, 1] * ds[k, 1] + turn[i, 2] * ds[k, 2]
                gradients[row, 6 + k] += normal * over / total
