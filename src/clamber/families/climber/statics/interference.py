"""Margins of limbs, body, holds and keep-outs against each other (page "The model", section 9)."""

import math

from ....compiled import kernel
from ....plane import point_segment, polygon_polygon, segment_polygon, segment_segment
from ....planning.problem.check import UNLIMITED
from .near import SIGHT, cells_about, cells_in_row
from .pose import port_of, solve, take_branch, tip_of, usable
from .records import cells, holds, hull, keep_out, limbs, vertices, work

KEEP_OUT, LIMB_LIMB, LIMB_BODY, LIMB_PEG, HOLDER_PEG = 8, 9, 10, 11, 15
"""Places of these checks among the margins."""
BESIDE = 0.1
"""Holds beyond a limb's reach by more than this are in no holder's way [m]."""


@kernel
def bend_free_limbs(p, s):
    """Solve the limbs that hold nothing, and give each the branch that it takes."""
    for i in range(p.n_limbs):
        if s.hold[i] < 0:
            solve(p, s, i)
            s.branch[i] = take_branch(p, s, i, usable(s, i, -1), 0.0, 0.0)


@kernel
def interference(p, s, margins):
    """Margins of limbs, body, holds and keep-outs against each other, in the branches taken [m]."""
    n = p.n_limbs
    corners = p.n_hull
    body = work(p)[64 : 64 + 2 * corners].reshape((corners, 2))
    for i in range(corners):
        body[i, 0] = s.x + s.c * hull(p)[i, 0] - s.s * hull(p)[i, 1]
        body[i, 1] = s.y + s.s * hull(p)[i, 0] + s.c * hull(p)[i, 1]
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


@kernel
def holder_gap(p, s):
    """`holder_peg` margin: how far links and hooks of holders are from other holds, in the branches taken [m].

    A hook needs the strip that it sweeps as it comes straight onto its hold: as wide as it is, from as far ahead of the tip, along the
    grab direction, as it reaches, to where its way begins. But for its mouth, which opens by 45 deg to either side.
    """
    gap = UNLIMITED
    if p.hook_width == 0.0:
        return gap
    for i in range(p.n_limbs):
        if s.hold[i] >= 0:
            gap = min(gap, _holder_room(p, s, i, s.branch[i]))
    return gap


@kernel
def _holder_room(p, s, i, branch):
    """How far links and hook of a holder are from other holds with its elbow on one side [m]."""
    own = holds(p)[s.hold[i]]
    px, py = port_of(limbs(p)[i], s)
    at = 1 + 5 * branch
    ex = s.solved[i, at + 1]
    ey = s.solved[i, at + 2]
    gx = s.solved[i, at + 3]
    gy = s.solved[i, at + 4]
    hooked = limbs(p)[i].c_cone > -1.5
    sight = limbs(p)[i].length + BESIDE
    gap = UNLIMITED
    x0, x1, y0, y1 = cells_about(p, px, py, sight)
    for row in range(y0, y1 + 1):
        first, end = cells_in_row(p, row, x0, x1)
        for c in range(first, end):
            h = cells(p)[c]
            hold = holds(p)[h]
            if h == s.hold[i] or (hold.x - px) ** 2 + (hold.y - py) ** 2 > sight * sight:
                continue
            near = point_segment(hold.x, hold.y, px, py, ex, ey)
            near = min(near, point_segment(hold.x, hold.y, ex, ey, own.x, own.y)) - p.link_radius
            if hooked:
                along = gx * (hold.x - own.x) + gy * (hold.y - own.y)
                across = gx * (hold.y - own.y) - gy * (hold.x - own.x)
                near = min(near, hook_gap(p.hook_width, p.hook_ahead, p.hook_way, along, across) - p.hook_room)
            gap = min(gap, near - hold.radius)
    return gap


@kernel
def hook_gap(width, reach, way, along, across):
    """Distance of a place beside a hook, along its grab direction and across it from its hold, from what the hook sweeps; 0 inside [m].

    That is a strip of the hook's width, from `way` behind its hold to `reach` ahead of it, less the mouth between its lips.
    """
    ahead = along - reach
    inside = 0.5 * width - abs(across)
    if inside > 0.0 and along > 0.0 and ahead + inside > 0.0:  # in the mouth, or before it
        lip = math.hypot(ahead, inside) if ahead > inside else (ahead + inside) * math.sqrt(0.5)
        return min(along, lip)
    beyond = max(0.0, max(ahead, -way - along))
    return math.hypot(beyond, max(0.0, -inside))
