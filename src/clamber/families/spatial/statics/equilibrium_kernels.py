"""Forces of a stance: largest share of all limits that can be left free while forces balance, and the margins of the forces that do it.

Unknown are the wrenches of the contacts, each in its own frame, forces per weight and moments per weight times size of the robot. Six
equations balance the robot; rows keep every contact within its polytope and every motor within its torque, with s to spare:
`|torque| <= (1 - s) limit`, and contacts with `s` times the weight (or what their rows say) left. So a contact that bears has to do so
with s to spare, a foot with a share of the weight on it: a limb that is not needed may be said to bear nothing.
"""

import math

from ....compiled import inlined, kernel
from ....planning.problem.check import UNLIMITED
from .checks import EQUILIBRIUM, SLIP, TORQUE
from .programme_kernels import eliminate, maximise
from .relaxing_kernels import STEPS, relax_forces

ALL = 1.0 - 1e-8
"""No forces leave more of the limits than this: without weight, none are needed."""
LEAST_WEIGHT = 0.01 * 9.80665
"""Gravity that forces are counted in at least [m/s^2], so that a robot in free fall has a scale, too."""


@kernel
def contact_frame(robot, contact, rotation, limb, work):
    """Frame of a limb's contact in the base frame: normal, the first tangent along the hold or else the end effector's x, the second."""
    normal = work.normal[limb]
    frame = work.frame[limb]
    a, b, c = normal[0], normal[1], normal[2]
    along = contact.along
    u, v, w = along[0], along[1], along[2]
    if u != 0.0 or v != 0.0 or w != 0.0:
        x = rotation[0] * u + rotation[3] * v + rotation[6] * w
        y = rotation[1] * u + rotation[4] * v + rotation[7] * w
        z = rotation[2] * u + rotation[5] * v + rotation[8] * w
    else:
        end = work.tip_turn[limb]
        x, y, z = end[0], end[3], end[6]
        if abs(a * x + b * y + c * z) > 0.9:
            x, y, z = end[1], end[4], end[7]
    across = a * x + b * y + c * z
    x, y, z = x - across * a, y - across * b, z - across * c
    scale = 1.0 / math.sqrt(x * x + y * y + z * z)
    x, y, z = x * scale, y * scale, z * scale
    frame[0], frame[1], frame[2] = a, b, c
    frame[3], frame[4], frame[5] = x, y, z
    frame[6], frame[7], frame[8] = b * z - c * y, c * x - a * z, a * y - b * x


@kernel
def force_scale(robot, work):
    """Weight of the robot, or the largest other load where that is more [N]: the unit of forces."""
    g = math.sqrt(work.gravity[0] ** 2 + work.gravity[1] ** 2 + work.gravity[2] ** 2)
    w = work.wrench
    push = math.sqrt(w[0] ** 2 + w[1] ** 2 + w[2] ** 2)
    twist = math.sqrt(w[3] ** 2 + w[4] ** 2 + w[5] ** 2) / robot.size
    return max(robot.total_mass * max(g, LEAST_WEIGHT), push, twist)


@kernel
def fill_balance(robot, work, weight):
    """The six equations: contact wrenches, gravity and what else acts on the base add up to nothing, moments about the centre of mass.

    Returns:
        Number of unknowns.
    """
    balance = work.balance
    n = 0
    for limb in range(robot.n_limbs):
        if work.bears[limb]:
            n += robot.components[limb]
    for i in range(6):
        for j in range(n + 1):
            balance[i, j] = 0.0
    per_size = 1.0 / robot.size
    moments = work.moments
    cx, cy, cz = moments[1] / moments[0], moments[2] / moments[0], moments[3] / moments[0]
    at = 0
    for limb in range(robot.n_limbs):
        if not work.bears[limb]:
            continue
        frame = work.frame[limb]
        tip = work.target[limb]
        x, y, z = (tip[0] - cx) * per_size, (tip[1] - cy) * per_size, (tip[2] - cz) * per_size
        for a in range(3):
            u, v, w = frame[3 * a], frame[3 * a + 1], frame[3 * a + 2]
            balance[0, at + a], balance[1, at + a], balance[2, at + a] = u, v, w
            balance[3, at + a], balance[4, at + a], balance[5, at + a] = y * w - z * v, z * u - x * w, x * v - y * u
        at += 3
        if robot.components[limb] == 6:
            for a in range(3):
                for b in range(3):
                    balance[3 + b, at + a] = frame[3 * a + b]
            at += 3
    w = work.wrench
    per_weight = 1.0 / weight
    for a in range(3):
        balance[a, n] = -(robot.total_mass * work.gravity[a] + w[a]) * per_weight
    per_moment = per_weight * per_size
    balance[3, n] = -(w[3] - (cy * w[2] - cz * w[1])) * per_moment
    balance[4, n] = -(w[4] - (cz * w[0] - cx * w[2])) * per_moment
    balance[5, n] = -(w[5] - (cx * w[1] - cy * w[0])) * per_moment
    return n


@kernel
def fill_levers(robot, work):
    """Share of each motor's limit per component of its limb's contact wrench, forces [1/N] and moments [1/(N m)], contact frame."""
    for limb in range(robot.n_limbs):
        if not work.bears[limb]:
            continue
        frame = work.frame[limb]
        for k in range(robot.n_joints[limb]):
            per_limit = 1.0 / robot.torque[limb, k]
            lever = work.lever[limb, k]
            jacobian = work.jacobian[limb, k]
            axis = work.axis[limb, k]
            turns = per_limit * (1 - robot.sliding[limb, k])
            for a in range(3):
                u, v, w = frame[3 * a], frame[3 * a + 1], frame[3 * a + 2]
                lever[a] = (jacobian[0] * u + jacobian[1] * v + jacobian[2] * w) * per_limit
                lever[3 + a] = (axis[0] * u + axis[1] * v + axis[2] * w) * turns


@kernel
def put_row(work, row, at, components, layout):
    """Put a row over a contact's wrench (`full`) into `columns` and `bound`, solved unknowns replaced; `layout`: (unknowns, free ones)."""
    n, d = layout
    columns, balance, free, full = work.columns, work.balance, work.free, work.full
    for k in range(d):
        columns[k, row] = 0.0
    for c in range(components):
        value = full[c]
        if value == 0.0:
            continue
        place = free[at + c]
        if place >= 0:
            columns[place, row] += value
        else:
            solved = -1 - place
            work.bound[row] -= value * balance[solved, n]
            for j in range(n):
                place = free[j]
                if place >= 0:
                    columns[place, row] -= value * balance[solved, j]


@kernel
def scale_row(work, row, d, slack):
    """Divide a row so that s counts once in it."""
    inverse = 1.0 / slack
    work.bound[row] *= inverse
    for k in range(d):
        work.columns[k, row] *= inverse


@kernel
def fill_rows(robot, work, weight, layout):
    """Rows of all contacts that bear and of all motors, the latter in pairs.

    Returns:
        Number of rows.
    """
    _, d = layout
    full = work.full
    size = robot.size
    m = 0
    at = 0
    for limb in range(robot.n_limbs):
        if work.bears[limb]:
            components = robot.components[limb]
            mu, pull = work.friction[limb], work.pull[limb]
            for i in range(robot.n_rows[limb]):
                for c in range(components):
                    value = (robot.row[limb, i, c] + mu * robot.row_friction[limb, i, c]) * weight
                    full[c] = value if c < 3 else value * size
                limit = robot.limit[limb, i]
                work.bound[m] = limit[0] + limit[1] * pull + limit[2] * mu * pull
                put_row(work, m, at, components, layout)
                slack = robot.slack[limb, i]
                scale_row(work, m, d, slack[0] * weight + slack[1])
                m += 1
        for k in range(robot.n_joints[limb]):
            work.bound[m] = -work.load[limb, k] / robot.torque[limb, k]
            if work.bears[limb]:
                for c in range(robot.components[limb]):
                    full[c] = work.lever[limb, k, c] * (weight if c < 3 else weight * size)
                put_row(work, m, at, robot.components[limb], layout)
                for j in range(d):
                    work.columns[j, m + 1] = -work.columns[j, m]
            else:
                for j in range(d):
                    work.columns[j, m] = 0.0
                    work.columns[j, m + 1] = 0.0
            work.bound[m + 1] = 1.0 - work.bound[m]
            work.bound[m] += 1.0
            m += 2
        if work.bears[limb]:
            at += robot.components[limb]
    return m


@kernel
def read_margins(robot, work, weight, out):
    """Wrenches of the solution, and the margins that they leave to motors and contacts."""
    margins = out.margins
    for check in range(TORQUE, SLIP + 3):
        margins[check] = UNLIMITED
    out.torque = 0.0
    at = 0
    for limb in range(robot.n_limbs):
        components = robot.components[limb]
        wrench = out.wrench[limb]
        for c in range(6):
            wrench[c] = 0.0
        frame = out.frame[limb]
        if work.bears[limb]:
            for c in range(components):
                wrench[c] = work.solution[at + c] * (weight if c < 3 else weight * robot.size)
            at += components
            for c in range(9):
                frame[c] = work.frame[limb, c]
            mu, pull = work.friction[limb], work.pull[limb]
            for i in range(robot.n_rows[limb]):
                limit = robot.limit[limb, i]
                room = limit[0] + limit[1] * pull + limit[2] * mu * pull
                for c in range(components):
                    room -= (robot.row[limb, i, c] + mu * robot.row_friction[limb, i, c]) * wrench[c]
                check = SLIP + robot.margin[limb, i]
                margins[check] = min(margins[check], room)
        for k in range(robot.n_joints[limb]):
            torque = work.load[limb, k]
            if work.bears[limb]:
                for c in range(components):
                    torque += work.lever[limb, k, c] * robot.torque[limb, k] * wrench[c]
            out.torque = max(out.torque, abs(torque))
            margins[TORQUE] = min(margins[TORQUE], robot.torque[limb, k] - abs(torque))


@inlined
def without_load(work, n):
    """Whether nothing has to be balanced, so that all of every limit can be left."""
    most = 0.0
    for i in range(6):
        most = max(most, abs(work.balance[i, n]))
    return most < 1.0 - ALL


@kernel
def balance_forces(robot, work, rules, out):
    """Judge the forces of the stance that `work` describes: fills `out.s`, wrenches and the margins from `equilibrium` on.

    Returns:
        Whether s is at least the need.
    """
    weight = force_scale(robot, work)
    n = fill_balance(robot, work, weight)
    margins = out.margins
    out.pivots = 0
    share = -math.inf
    if not rules.exact or without_load(work, n):
        share = relax_forces(robot, work, weight, ALL if rules.exact else rules.need, 0 if rules.exact else STEPS, n)
    if share > -math.inf:  # if it is less than the need: a motor that its own limb's weight is too much for
        out.s = share
        margins[EQUILIBRIUM] = share - rules.need
        for check in range(TORQUE, SLIP + 3):
            margins[check] = math.nan
        if share >= rules.need:
            read_margins(robot, work, weight, out)
        return share >= rules.need
    rank = eliminate(work, n)
    if rank < 0:  # as for one or two point contacts: no forces balance, however large
        out.s = -1.0
        margins[EQUILIBRIUM] = -1.0 - rules.need
        for check in range(TORQUE, SLIP + 3):
            margins[check] = math.nan
        return False
    d = n - rank
    m = fill_rows(robot, work, weight, (n, d))
    lower, upper, out.pivots = maximise(work, m, d, rules.need if not rules.exact else math.nan)
    if lower == -math.inf:  # decided before any point within the box was met
        out.s = upper
        margins[EQUILIBRIUM] = upper - rules.need
        for check in range(TORQUE, SLIP + 3):
            margins[check] = math.nan
        return False
    for j in range(n):
        place = work.free[j]
        if place >= 0:
            work.solution[j] = work.point[place]
        else:
            value = work.balance[-1 - place, n]
            for k in range(n):
                other = work.free[k]
                if other >= 0:
                    value -= work.balance[-1 - place, k] * work.point[other]
            work.solution[j] = value
    read_margins(robot, work, weight, out)
    out.s = upper if upper < rules.need else lower  # where the programme was not settled, what it is sure of
    margins[EQUILIBRIUM] = out.s - rules.need
    return lower >= rules.need
