"""Seeds of inverse kinematics: a posture for every cell of space about a limb's mount, the nearest to the nominal one that was found."""

import math

import numpy as np

from ....compiled import carray, kernel, pointer
from ....planning.problem.randoms import draw, unit
from .alignment_kernels import reach_aligned
from .kinematics_kernels import limb_frames, reach_point
from .records import JOINTS

TURNS = 24
"""Directions told apart of limbs that are aligned: a cube's faces, four quarters each."""
UNREACHED = 1e9
"""Score of a cell without a seed."""
BORROWED = 100.0
"""What a seed that is a neighbour's scores besides: more than any of its own."""
NEAR_LIMIT = 0.08
"""Of a joint's range; postures that close to a limit are taken where there is no other."""
LIMIT_SCORE = 0.2
SEED = 24
"""Of the samples: the same table on every machine."""


@kernel
def postures(seeds):
    """All seeds [rad] or [m], shape (n_seeds, JOINTS)."""
    return carray(pointer(seeds.posture_at), (seeds.n_seeds, JOINTS), np.float64)


@kernel
def scores(seeds):
    """How far each seed is from the nominal posture [-], `UNREACHED` where there is none, shape (n_seeds,)."""
    return carray(pointer(seeds.score_at), seeds.n_seeds, np.float64)


@kernel
def turn_of(x, y, z):
    """Number of a direction in the cube map."""
    a, b, c = abs(x), abs(y), abs(z)
    if a >= b and a >= c:
        return (0 if x > 0.0 else 4) + (1 if y > 0.0 else 0) + (2 if z > 0.0 else 0)
    if b >= c:
        return 8 + (0 if y > 0.0 else 4) + (1 if x > 0.0 else 0) + (2 if z > 0.0 else 0)
    return 16 + (0 if z > 0.0 else 4) + (1 if x > 0.0 else 0) + (2 if y > 0.0 else 0)


@kernel
def cell_index(seeds, limb, place, turn):
    """Index of the seed for a place in the frame of a limb's mount [m] and a number of a direction; -1 outside the grid."""
    per_cell = 1.0 / seeds.cell[limb]
    i = int(math.floor((place[0] - seeds.low[limb, 0]) * per_cell))
    j = int(math.floor((place[1] - seeds.low[limb, 1]) * per_cell))
    k = int(math.floor((place[2] - seeds.low[limb, 2]) * per_cell))
    count = seeds.count[limb]
    if i < 0 or j < 0 or k < 0 or i >= count[0] or j >= count[1] or k >= count[2]:
        return -1
    index = (i * count[1] + j) * count[2] + k
    return seeds.start[limb] + (index if seeds.turns[limb] == 1 else index * TURNS + turn)


@kernel
def seed_index(robot, seeds, limb, work):
    """Index of the seed for a limb's target (and inward normal, if it is aligned) in `work`; -1 if there is none, so out of reach."""
    offset = robot.offset[limb, 0]
    r = robot.rotation[limb, 0]
    target = work.target[limb]
    x, y, z = target[0] - offset[0], target[1] - offset[1], target[2] - offset[2]
    place = work.step
    place[0], place[1], place[2] = (
        r[0] * x + r[3] * y + r[6] * z,
        r[1] * x + r[4] * y + r[7] * z,
        r[2] * x + r[5] * y + r[8] * z,
    )
    turn = 0
    if seeds.turns[limb] > 1:
        normal = work.normal[limb]
        x, y, z = -normal[0], -normal[1], -normal[2]
        turn = turn_of(r[0] * x + r[3] * y + r[6] * z, r[1] * x + r[4] * y + r[7] * z, r[2] * x + r[5] * y + r[8] * z)
    index = cell_index(seeds, limb, place, turn)
    return index if index >= 0 and scores(seeds)[index] < UNREACHED else -1


@kernel
def take_seed(robot, seeds, limb, index, work):
    """Put a seed into `posture` of a limb."""
    for k in range(robot.n_joints[limb]):
        work.posture[limb, k] = postures(seeds)[index, k]


@kernel
def posture_score(robot, limb, work):
    """Distance of the posture in `work` from the nominal one, by ranges of the joints, more if next to a limit [-]."""
    total = 0.0
    for k in range(robot.n_joints[limb]):
        q = work.posture[limb, k]
        lower, upper = robot.lower[limb, k], robot.upper[limb, k]
        span = upper - lower + 1e-12
        off = (q - robot.nominal[limb, k]) / span
        total += off * off
        if min(q - lower, upper - q) < NEAR_LIMIT * span:
            total += LIMIT_SCORE
    return total


@kernel
def keep_better(robot, seeds, limb, work, index):
    """Keep the posture in `work` as the seed `index` if it is nearer the nominal one than what is there."""
    score = posture_score(robot, limb, work)
    if score < scores(seeds)[index]:
        scores(seeds)[index] = score
        for k in range(robot.n_joints[limb]):
            postures(seeds)[index, k] = work.posture[limb, k]


@kernel
def sample_seeds(robot, seeds, limb, work, n_samples):
    """Fill a limb's cells from samples of its joints; the limb's mount must be the base frame."""
    n = robot.n_joints[limb]
    for sample in range(n_samples):
        for k in range(n):
            share = unit(draw(SEED, sample, k, 0))
            work.posture[limb, k] = robot.lower[limb, k] + share * (robot.upper[limb, k] - robot.lower[limb, k])
        limb_frames(robot, limb, work)
        end = work.tip_turn[limb]
        index = cell_index(seeds, limb, work.origin[limb, n], turn_of(end[2], end[5], end[8]))
        if index >= 0:
            keep_better(robot, seeds, limb, work, index)


@kernel
def aim_at_turn(turn, normal):
    """Outward normal of the surface that direction `turn` points into, at the middle of the direction's part of the cube."""
    face, quarter = turn >> 3, turn & 3
    along = -1.0 if turn & 4 else 1.0
    u = 0.5 if quarter & 1 else -0.5
    v = 0.5 if quarter & 2 else -0.5
    scale = -1.0 / math.sqrt(1.5)
    if face == 0:
        normal[0], normal[1], normal[2] = along * scale, u * scale, v * scale
    elif face == 1:
        normal[0], normal[1], normal[2] = u * scale, along * scale, v * scale
    else:
        normal[0], normal[1], normal[2] = u * scale, v * scale, along * scale


@kernel
def neighbour(seeds, limb, cell, side):
    """Cell beside a cell of a limb's grid, by the number of the side from 1 to 6; 0 is the cell itself, -1: outside the grid."""
    count = seeds.count[limb]
    i, j, k = cell // (count[1] * count[2]), cell // count[2] % count[1], cell % count[2]
    i += 1 if side == 1 else -1 if side == 2 else 0
    j += 1 if side == 3 else -1 if side == 4 else 0
    k += 1 if side == 5 else -1 if side == 6 else 0
    if i < 0 or j < 0 or k < 0 or i >= count[0] or j >= count[1] or k >= count[2]:
        return -1
    return (i * count[1] + j) * count[2] + k


@kernel
def refine_cell(robot, seeds, limb, work, cell):
    """Solve the middle of a cell from its own seeds and those of its neighbours, and keep the best of them.

    Returns:
        Number of seeds that got better.
    """
    count = seeds.count[limb]
    i, j, k = cell // (count[1] * count[2]), cell // count[2] % count[1], cell % count[2]
    side = seeds.cell[limb]
    turns = seeds.turns[limb]
    target = work.target[limb]
    target[0] = seeds.low[limb, 0] + (i + 0.5) * side
    target[1] = seeds.low[limb, 1] + (j + 0.5) * side
    target[2] = seeds.low[limb, 2] + (k + 0.5) * side
    near = 1e-4 * robot.size
    better = 0
    for turn in range(turns):
        index = seeds.start[limb] + cell * turns + turn
        before = scores(seeds)[index]
        if turns > 1:
            aim_at_turn(turn, work.normal[limb])
        for side in range(7):
            beside = neighbour(seeds, limb, cell, side)
            if beside < 0:
                continue
            other = seeds.start[limb] + beside * turns + turn
            if scores(seeds)[other] >= UNREACHED or (side > 0 and scores(seeds)[other] > 0.9 * before):
                continue
            take_seed(robot, seeds, limb, other, work)
            error = reach_aligned(robot, limb, work, near) if turns > 1 else reach_point(robot, limb, work, near)
            if error < near:
                keep_better(robot, seeds, limb, work, index)
        if scores(seeds)[index] < before:
            better += 1
    return better


@kernel
def seed_beside(seeds, limb, index, side):
    """Index of the seed of the cell beside that of a seed (`neighbour`), for the same direction; -1 if there is none."""
    turns = seeds.turns[limb]
    beside = neighbour(seeds, limb, (index - seeds.start[limb]) // turns, side)
    if beside < 0:
        return -1
    other = seeds.start[limb] + beside * turns + (index - seeds.start[limb]) % turns
    return other if scores(seeds)[other] < UNREACHED else -1


@kernel
def widen_seeds(robot, seeds, limb):
    """Give cells without a seed that of the best cell beside them: a place near their edge may still be in reach."""
    turns = seeds.turns[limb]
    for cell in range(seeds.count[limb, 0] * seeds.count[limb, 1] * seeds.count[limb, 2]):
        for turn in range(turns):
            index = seeds.start[limb] + cell * turns + turn
            if scores(seeds)[index] < UNREACHED:
                continue
            best, least = -1, BORROWED
            for side in range(1, 7):
                other = seed_beside(seeds, limb, index, side)
                if other >= 0 and scores(seeds)[other] < least:
                    best, least = other, scores(seeds)[other]
            if best >= 0:
                scores(seeds)[index] = BORROWED + least
                for k in range(robot.n_joints[limb]):
                    postures(seeds)[index, k] = postures(seeds)[best, k]


@kernel
def refine_seeds(robot, seeds, limb, work, sweeps):
    """Sweep over all cells of a limb, forwards and back, until no seed gets better or the sweeps are done."""
    count = seeds.count[limb]
    cells = count[0] * count[1] * count[2]
    for sweep in range(sweeps):
        better = 0
        for n in range(cells):
            better += refine_cell(robot, seeds, limb, work, n if sweep & 1 == 0 else cells - 1 - n)
        if better == 0:
            return
