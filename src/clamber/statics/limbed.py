"""Judge one stance of the limbed climber: forces, torques and every check's margin (page "The model", sections 3 and 5 to 9)."""

import math

from ..compiled import inlined, kernel
from ..robots.kinematics import solve_limb, wrap
from .forces import NO_SPLIT, general_split, thesis_split
from .grip import hang_margin, least_pair, many_least_norm, many_split, pair_margin, port_of
from .interference import point_segment, polygon_polygon, segment_polygon, segment_segment
from .records import (
    LIMBS,
    TOLERANCE,
    UNLIMITED,
    cell_start,
    cells,
    holds,
    hull,
    keep_out,
    limbs,
    vertices,
    work,
)

REACH, JOINT, SUPPORT, HANGS, TORQUE, POWER, CLEARANCE, SWING = 0, 1, 2, 3, 4, 5, 6, 7
KEEP_OUT, LIMB_LIMB, LIMB_BODY, LIMB_PEG, HOOK, SHARED, STABILITY = 8, 9, 10, 11, 12, 13, 14
N_CHECKS = 15
SIGHT = 1.0
"""How far from the body's origin holds are looked for [m]."""


@inlined
def place(p, s):
    """World pose of the stance from its ticks."""
    s.x = p.x0 + s.ix * p.tick
    s.y = p.y0 + s.iy * p.tick
    s.angle = wrap(p.a0 + s.ia * p.tick_angle)
    s.c = math.cos(s.angle)
    s.s = math.sin(s.angle)


@inlined
def tip_of(p, s, i):
    """Tip of limb i in the world [m]: at its hold, or where its foot rides with the body."""
    h = s.hold[i]
    if h >= 0:
        return holds(p)[h].x, holds(p)[h].y
    fx = s.foot[i, 0]
    fy = s.foot[i, 1]
    return s.x + s.c * fx - s.s * fy, s.y + s.s * fx + s.c * fy


@inlined
def solve(p, s, i):
    """Inverse kinematics of limb i at its present tip."""
    limb = limbs(p)[i]
    px, py = port_of(limb, s)
    tx, ty = tip_of(p, s, i)
    c_phi = s.c * limb.c_port - s.s * limb.s_port
    s_phi = s.s * limb.c_port + s.c * limb.s_port
    solve_limb(limb, px, py, c_phi, s_phi, tx, ty, s.solved[i])


@inlined
def count_holders(p, s):
    """Number of limbs on holds, and the last of them."""
    holders = 0
    last = -1
    for i in range(p.n_limbs):
        if s.hold[i] >= 0:
            holders += 1
            last = i
    return holders, last


@inlined
def cells_about(p, x, y, radius):
    """Range of grid cells that a circle may touch: first and last column, first and last row (empty if first > last)."""
    x0 = max(0, int(math.floor((x - radius - p.grid_x) / p.grid_cell)))
    x1 = min(p.grid_nx - 1, int(math.floor((x + radius - p.grid_x) / p.grid_cell)))
    y0 = max(0, int(math.floor((y - radius - p.grid_y) / p.grid_cell)))
    y1 = min(p.grid_ny - 1, int(math.floor((y + radius - p.grid_y) / p.grid_cell)))
    return x0, x1, y0, y1


@inlined
def cells_in_row(p, row, x0, x1):
    """Where the holds of one row of cells, columns x0 to x1, lie in `cells`: first and end."""
    if x0 > x1:
        return 0, 0
    base = row * p.grid_nx
    return cell_start(p)[base + x0], cell_start(p)[base + x1 + 1]


@inlined
def nearest_hold(p, x, y):
    """Distance of the nearest hold from a point [m]; infinity if none is within sight."""
    best = math.inf
    radius = p.grid_cell
    while True:
        x0, x1, y0, y1 = cells_about(p, x, y, radius)
        for row in range(y0, y1 + 1):
            first, end = cells_in_row(p, row, x0, x1)
            for at in range(first, end):
                hold = holds(p)[cells(p)[at]]
                dx = hold.x - x
                dy = hold.y - y
                best = min(best, dx * dx + dy * dy)
        if best <= radius * radius or radius >= SIGHT:
            break
        radius = min(SIGHT, 2.0 * radius)
    best = math.sqrt(best)
    return best if best <= SIGHT else math.inf


@kernel
def arc_clearance(p, hx, hy, radius, angle, turn):
    """Distance of the nearest hold from the arc about (hx, hy) that starts at `angle` and goes on by `turn` [m]."""
    best = math.inf
    x0, x1, y0, y1 = cells_about(p, hx, hy, radius + SIGHT)
    ax = hx + radius * math.cos(angle)
    ay = hy + radius * math.sin(angle)
    bx = hx + radius * math.cos(angle + turn)
    by = hy + radius * math.sin(angle + turn)
    for row in range(y0, y1 + 1):
        first, end = cells_in_row(p, row, x0, x1)
        for at in range(first, end):
            hold = holds(p)[cells(p)[at]]
            dx = hold.x - hx
            dy = hold.y - hy
            d = math.sqrt(dx * dx + dy * dy)
            near = min(math.hypot(hold.x - ax, hold.y - ay), math.hypot(hold.x - bx, hold.y - by))
            if d > 0.0:
                ahead = wrap(math.atan2(dy, dx) - angle)
                if 0.0 <= ahead <= turn or turn <= ahead <= 0.0:
                    near = min(near, abs(d - radius))
            else:
                near = min(near, radius)
            best = min(best, near)
    return best if best <= SIGHT else math.inf


@kernel
def hang(p, s):
    """Turn the body about its one hold until its origin is straight below; returns the swing margin [m] (page "The model", 5)."""
    _, i = count_holders(p, s)
    hold = holds(p)[s.hold[i]]
    rx = s.x - hold.x
    ry = s.y - hold.y
    r = math.sqrt(rx * rx + ry * ry)
    if r < 1e-9:
        return UNLIMITED
    angle = math.atan2(ry, rx)
    turn = wrap(-0.5 * math.pi - angle)
    s.ix = int(round((hold.x - p.x0) / p.tick))
    s.iy = int(round((hold.y - r - p.y0) / p.tick))
    s.ia = (s.ia + int(round(turn / p.tick_angle))) % p.turn_ticks
    s.turned += turn
    place(p, s)
    near = arc_clearance(p, hold.x, hold.y, r, angle, turn)
    return near - p.clearance if near < math.inf else UNLIMITED


@inlined
def usable(s, i, kept):
    """Branches of limb i to choose from (bit set): those allowed and within joint limits, else those allowed, else both."""
    allowed = s.open[i] if kept and s.hold[i] >= 0 else 3
    within = 0
    for branch in range(2):
        if allowed & (1 << branch) and s.solved[i, 1 + 5 * branch] >= -TOLERANCE:
            within |= 1 << branch
    if within:
        return within
    return allowed if allowed else 3


@inlined
def joint_torques(p, s, i, branch, fx, fy):
    """Torques of shoulder and elbow [N m] for a force of the hold on the tip: minus the moment about each joint."""
    px, py = port_of(limbs(p)[i], s)
    tx, ty = tip_of(p, s, i)
    at = 1 + 5 * branch
    ex = s.solved[i, at + 1]
    ey = s.solved[i, at + 2]
    return (ty - py) * fx - (tx - px) * fy, (ty - ey) * fx - (tx - ex) * fy


@inlined
def take_branch(p, s, i, options, fx, fy):
    """The branch of limb i that a force makes least of: less torque, then hook on top, then less at the elbow."""
    if options == 1:
        return 0
    if options == 2:
        return 1
    a1, a2 = joint_torques(p, s, i, 0, fx, fy)
    b1, b2 = joint_torques(p, s, i, 1, fx, fy)
    a = max(abs(a1), abs(a2))
    b = max(abs(b1), abs(b2))
    if abs(a - b) >= 1e-9:
        return 0 if a < b else 1
    down_a = s.solved[i, 5]
    down_b = s.solved[i, 10]
    if abs(down_a - down_b) > 1e-9:
        return 0 if down_a < down_b else 1
    return 1 if abs(b2) < abs(a2) - 1e-9 else 0


@inlined
def share(p, s):
    """Forces, branches and torques of all limbs; sets carriers, push_pull, force, torques, power and torque of the stance."""
    n = p.n_limbs
    holders = 0
    for i in range(n):
        if s.hold[i] >= 0:
            holders += 1
    carriers = 0
    a = -1
    b = -1
    k = 0
    for i in range(n):
        s.force[i, 0] = 0.0
        s.force[i, 1] = 0.0
        if s.hold[i] >= 0 and not (p.idle and holders >= 3 and i == s.in_use):
            carriers |= 1 << i
            k += 1
            if a < 0:
                a = i
            elif b < 0:
                b = i
    s.carriers = carriers
    s.push_pull = 0
    split = True
    given_a = -1
    given_b = -1
    if k == 1:
        s.force[a, 1] = p.weight
    elif k == 2:
        hold_a = holds(p)[s.hold[a]]
        hold_b = holds(p)[s.hold[b]]
        opposed = (p.opposed[a] >> b) & 1 == 1
        rax = hold_a.x - s.x
        rbx = hold_b.x - s.x
        if p.force_rule == 0:
            split, push_pull, fax, fay, fbx, fby = thesis_split(
                p.weight, opposed, rax, hold_a.y - s.y, rbx, hold_b.y - s.y
            )
            s.push_pull = 1 if push_pull else 0
            s.force[a, 0] = fax
            s.force[a, 1] = fay
            s.force[b, 0] = fbx
            s.force[b, 1] = fby
        else:
            s.push_pull = 0 if opposed or rax * rbx < 0.0 else 1
            use_a = usable(s, a, p.kept)
            use_b = usable(s, b, p.kept)
            given_a, given_b, lam = least_pair(p, s, a, b, use_a, use_b, p.force_rule == 2)
            split = given_a >= 0
            if split:
                f = work(p)[:8]
                general_split(p.weight, hold_a.x, hold_a.y, hold_b.x, hold_b.y, s.x, f)
                s.force[a, 0] = f[0] + lam * f[2]
                s.force[a, 1] = f[1] + lam * f[3]
                s.force[b, 0] = f[4] + lam * f[6]
                s.force[b, 1] = f[5] + lam * f[7]
    for i in range(n):
        if s.hold[i] < 0:
            continue
        if i == a and given_a >= 0:
            s.branch[i] = given_a
        elif i == b and given_b >= 0:
            s.branch[i] = given_b
        elif k >= 3 and carriers & (1 << i):
            s.branch[i] = take_branch(p, s, i, usable(s, i, p.kept), 0.0, p.weight / k)
        else:
            s.branch[i] = take_branch(p, s, i, usable(s, i, p.kept), s.force[i, 0], s.force[i, 1])
    if k >= 3:
        if p.force_rule == 2:
            split = many_least_norm(p, s, carriers, s.force)
        else:
            split, _ = many_split(p, s, carriers, 0, s.force)
            if not split:
                split, _ = many_split(p, s, carriers, 1, s.force)
    worst = 0.0
    power = 0.0
    for i in range(n):
        s.torques[i, 0] = 0.0
        s.torques[i, 1] = 0.0
        if not carriers & (1 << i):
            continue
        if split:
            t1, t2 = joint_torques(p, s, i, s.branch[i], s.force[i, 0], s.force[i, 1])
        else:
            t1 = NO_SPLIT
            t2 = NO_SPLIT
        s.torques[i, 0] = t1
        s.torques[i, 1] = t2
        worst = max(worst, max(abs(t1), abs(t2)))
        power += t1 * t1 * limbs(p)[i].heat1 + t2 * t2 * limbs(p)[i].heat2
    s.torque = worst
    s.power = power
    return k


@kernel
def judge(p, s, grabbing, swing, margins):
    """Write every margin of a settled stance; return the first hard check that is violated, or -1.

    Args:
        p: Parameters.
        s: Stance record, posed and hung, with `solved` up to date for the holders.
        grabbing: The limb whose grab is being judged (its reach limit is less the offset), or -1.
        swing: Margin of the swing that led here [m].
        margins: Output, shape (N_CHECKS,).
    """
    n = p.n_limbs
    for i in range(N_CHECKS):
        margins[i] = math.nan
    holders, _ = count_holders(p, s)
    margins[SUPPORT] = float(holders - p.min_supports) if holders else -1.0
    if not holders:
        return SUPPORT
    margins[HANGS] = float(p.max_hangs - s.hangs) if p.max_hangs >= 0 else UNLIMITED
    margins[SWING] = swing
    reach = math.inf
    joint = math.inf
    for i in range(n):
        if s.hold[i] < 0:
            continue
        limit = limbs(p)[i].length
        if i == grabbing or p.offset_while_holding:
            limit -= p.reach_offset
        reach = min(reach, limit - s.solved[i, 0])
        allowed = s.open[i] if p.kept else 3
        best = -math.pi
        for branch in range(2):
            if allowed & (1 << branch):
                best = max(best, s.solved[i, 1 + 5 * branch])
        joint = min(joint, best)
    margins[REACH] = reach
    margins[JOINT] = joint
    k = share(p, s)
    torque = math.inf
    for i in range(n):
        if s.carriers & (1 << i):
            torque = min(torque, limbs(p)[i].limit1 - abs(s.torques[i, 0]))
            torque = min(torque, limbs(p)[i].limit2 - abs(s.torques[i, 1]))
    margins[TORQUE] = torque
    margins[POWER] = p.max_power - s.power if p.max_power < math.inf else UNLIMITED
    near = nearest_hold(p, s.x, s.y)
    margins[CLEARANCE] = near - p.clearance if near < math.inf else UNLIMITED
    if p.seen & (1 << STABILITY):
        margins[STABILITY] = stability(p, s, k)
    if p.seen & (1 << SHARED):
        margins[SHARED] = shared(p, s)
    good = 3 * 0x5555  # two bits a limb: every branch good until the hook check says otherwise
    if p.seen & (1 << HOOK):
        margins[HOOK], good = hook(p, s, k)
    margins[KEEP_OUT] = UNLIMITED
    fenced = p.fences > 0 and p.seen & (1 << KEEP_OUT)
    if fenced or p.seen & (1 << LIMB_LIMB | 1 << LIMB_BODY | 1 << LIMB_PEG):
        interference(p, s, margins)
    violated = 0
    for check in range(N_CHECKS):  # no branches, so that it vectorises
        violated |= (1 << check) if margins[check] < -TOLERANCE else 0
    violated &= p.hard
    if violated:
        check = 0
        while not violated & (1 << check):
            check += 1
        return check
    if p.kept:
        for i in range(n):
            if s.hold[i] >= 0:
                s.open[i] = still_open(p, s, i, (good >> (2 * i)) & 3 if p.hard & (1 << HOOK) else 3)
    return -1


@kernel
def still_open(p, s, i, good):
    """The open branches of a holder that this stance leaves open (bit set)."""
    if abs(s.torques[i, 0]) == NO_SPLIT:
        return 0
    left = 0
    for branch in range(2):
        if s.open[i] & good & (1 << branch) and s.solved[i, 1 + 5 * branch] >= -TOLERANCE:
            t1, t2 = joint_torques(p, s, i, branch, s.force[i, 0], s.force[i, 1])
            if limbs(p)[i].limit1 - abs(t1) >= -TOLERANCE and limbs(p)[i].limit2 - abs(t2) >= -TOLERANCE:
                left |= 1 << branch
    return left


@kernel
def hook(p, s, k):
    """`hook` margin [N] and, two bits a limb, the branches in good combinations."""
    a = -1
    b = -1
    for i in range(p.n_limbs):
        if s.carriers & (1 << i):
            if a < 0:
                a = i
            elif b < 0:
                b = i
    good = 3 * 0x5555
    if k == 1:
        margin, good_a = hang_margin(p, s, a, usable(s, a, p.kept))
        return margin, good & ~(3 << (2 * a)) | good_a << (2 * a)
    if k == 2:
        margin, good_a, good_b = pair_margin(p, s, a, b, usable(s, a, p.kept), usable(s, b, p.kept))
        good = good & ~(3 << (2 * a)) | good_a << (2 * a)
        return margin, good & ~(3 << (2 * b)) | good_b << (2 * b)
    if k == 0:
        return math.nan, good
    spare = work(p)[16:32].reshape((LIMBS, 2))
    split, margin = many_split(p, s, s.carriers, 2, spare)
    return margin if split else -UNLIMITED, good


@kernel
def stability(p, s, k):
    """How far the origin lies inside the carriers' span [m]; 0 in a hang."""
    if k < 2:
        return 0.0
    lo = math.inf
    hi = -math.inf
    for i in range(p.n_limbs):
        if s.carriers & (1 << i):
            lo = min(lo, holds(p)[s.hold[i]].x)
            hi = max(hi, holds(p)[s.hold[i]].x)
    return min(hi - s.x, s.x - lo)


@kernel
def shared(p, s):
    """-1 if two limbs hold one hold, else 0."""
    n = p.n_limbs
    for i in range(n):
        for j in range(i + 1, n):
            if s.hold[i] >= 0 and s.hold[i] == s.hold[j]:
                return -1.0
    return 0.0


@kernel
def interference(p, s, margins):
    """Margins of limbs, body, holds and keep-outs against each other [m]."""
    n = p.n_limbs
    corners = p.n_hull
    body = work(p)[64 : 64 + 2 * corners].reshape((corners, 2))
    for i in range(corners):
        body[i, 0] = s.x + s.c * hull(p)[i, 0] - s.s * hull(p)[i, 1]
        body[i, 1] = s.y + s.s * hull(p)[i, 0] + s.c * hull(p)[i, 1]
    for i in range(n):
        if s.hold[i] < 0:
            solve(p, s, i)
            s.branch[i] = take_branch(p, s, i, usable(s, i, p.kept), 0.0, 0.0)
    limb_limb = UNLIMITED
    limb_body = UNLIMITED
    limb_peg = UNLIMITED
    fence = UNLIMITED
    radius = p.link_radius
    x0, x1, y0, y1 = cells_about(p, s.x, s.y, SIGHT)
    for k in range(p.fences):
        polygon = vertices(p)[keep_out(p)[k] : keep_out(p)[k + 1]]
        fence = min(fence, polygon_polygon(body, polygon) - p.body_margin)
    for i in range(n):
        ax, ay = port_of(limbs(p)[i], s)
        at = 1 + 5 * s.branch[i]
        bx = s.solved[i, at + 1]
        by = s.solved[i, at + 2]
        cx, cy = tip_of(p, s, i)
        limb_body = min(limb_body, segment_polygon(bx, by, cx, cy, body) - radius - p.body_margin)
        for k in range(p.fences):
            polygon = vertices(p)[keep_out(p)[k] : keep_out(p)[k + 1]]
            near = min(segment_polygon(ax, ay, bx, by, polygon), segment_polygon(bx, by, cx, cy, polygon))
            fence = min(fence, near - radius)
        for j in range(i + 1, n):
            dx, dy = port_of(limbs(p)[j], s)
            ex = s.solved[j, 1 + 5 * s.branch[j] + 1]
            ey = s.solved[j, 1 + 5 * s.branch[j] + 2]
            fx, fy = tip_of(p, s, j)
            near = min(segment_segment(ax, ay, bx, by, dx, dy, ex, ey), segment_segment(ax, ay, bx, by, ex, ey, fx, fy))
            near = min(near, segment_segment(bx, by, cx, cy, dx, dy, ex, ey))
            near = min(near, segment_segment(bx, by, cx, cy, ex, ey, fx, fy))
            limb_limb = min(limb_limb, near - 2.0 * radius)
        own = s.hold[i] if s.hold[i] >= 0 else s.left[i]
        for row in range(y0, y1 + 1):
            first, end = cells_in_row(p, row, x0, x1)
            for c in range(first, end):
                h = cells(p)[c]
                if h == own:
                    continue
                hold = holds(p)[h]
                if (hold.x - s.x) ** 2 + (hold.y - s.y) ** 2 > SIGHT * SIGHT:
                    continue
                near = min(point_segment(hold.x, hold.y, ax, ay, bx, by), point_segment(hold.x, hold.y, bx, by, cx, cy))
                limb_peg = min(limb_peg, near - radius - hold.radius)
    margins[KEEP_OUT] = fence
    margins[LIMB_LIMB] = limb_limb
    margins[LIMB_BODY] = limb_body
    margins[LIMB_PEG] = limb_peg
