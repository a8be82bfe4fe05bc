"""A bound on the actions that are left: for each limb by itself, the least moves of the body and holds to take on a way to the goal.

Of a plan with m moves in which limb l takes r_l holds, each limb alone sees m / n + r_l of the m + r_1 + ... + r_n actions (n limbs).
The least of that over all ways of the body on which the limb always reaches its hold without a jump, whatever the other limbs, forces
and collisions, is at most what the plan has; so the sum over the limbs bounds the plan (a cost partition as of Katz and Domshlak, 2010).
It is worked out for the poses of a region about the straight way; beyond it a plan needs what `plain_bound` says, for one pose as for all.
"""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....planning.problem.check import TOLERANCE
from ..statics.checks import JUMP
from ..statics.records import LIMBS
from ..statics.stance_kernels import aim_limb, solve_limb
from .judging_kernels import scratch_of
from .poses_kernels import (
    body_of,
    goals_of,
    holds_of,
    meets,
    outside,
    place_body,
    robot_of,
    rules_of,
    seeds_of,
    work_of,
    yaw_missing,
)
from .records import ACROSS, ALONG, AXES, HEIGHT, PITCH, ROLL, YAW
from .step_kernels import MOVES, shift

FAR = 30_000
"""More than any number of the tables: not worked out yet."""
DEAD = 32_000
"""Where a limb does not reach its hold, or no way on leads to the goal."""
ROUNDED = 1e-5
"""By how much a posture may be off that is kept as single floats [rad]."""
BEYOND = -2
"""Of a neighbour: a pose outside the region."""


@inlined
def steps_apart(difference, far):
    """Least number of steps of 1 and of `far` that make up a difference."""
    rest = abs(difference) % far
    return abs(difference) // far + min(rest, 1 + far - rest)


@kernel
def moves_between(p, here, there):
    """Moves of the body from one pose to another, at least."""
    turn = (here[YAW] - there[YAW]) % p.turns
    count = min(turn, p.turns - turn)
    count += steps_apart(here[ALONG] - there[ALONG], p.far)
    count += steps_apart(here[ACROSS] - there[ACROSS], p.far)
    for axis in (HEIGHT, PITCH, ROLL):
        count += abs(here[axis] - there[axis])
    return count


@kernel
def moves_left(p, x, y, angle, goal):
    """Moves of the body from a place on the guide and a yaw to where a goal asks for, at least."""
    stride = p.far * p.length
    count = math.ceil(outside(x, goal.along_min, goal.along_max) / stride - 1e-6)
    count += math.ceil(outside(y, goal.across_min, goal.across_max) / stride - 1e-6)
    return count + math.ceil(yaw_missing(p, angle, goal) / p.angle - 1e-6)


@kernel
def grabs_left(p, limb, hold, goal):
    """Holds that a limb still has to take to come along to a goal, at least."""
    span = carray(pointer(p.spans_at), LIMBS, np.float64)[limb]
    short = outside(hold.along, goal.along_min, goal.along_max) - span
    return math.ceil(short / (2.0 * span) - 1e-6) if short > 0.0 else 0


@kernel
def plain_bound(p, s):
    """Moves that the body needs at least, and times that each limb must take another hold to come along."""
    goal, holds = goals_of(p)[s.stage], holds_of(p)
    count = moves_left(p, s.x, s.y, s.angle, goal)
    for i in range(p.n_limbs):
        count += grabs_left(p, i, holds[s.hold[i]], goal)
    return count


@kernel
def region_index(p, pose):
    """Number of a pose in the region, -1 outside it."""
    index = 0
    for axis in range(AXES):
        at = pose[axis] - p.region_low[axis]
        if axis == YAW:
            at %= p.turns
        if at < 0 or at >= p.region_count[axis]:
            return -1
        index = index * p.region_count[axis] + at
    return carray(pointer(p.region_at), p.n_region, np.int32)[index]


@kernel
def table_bound(p, s):
    """The bound of a pose in the region, infinite where a limb has no way on; -1 outside the region."""
    q = region_index(p, s.pose)
    if q < 0:
        return -1.0
    left = carray(pointer(p.left_at), (p.n_limbs, p.n_poses, p.n_holds), np.int16)
    total = 0
    for i in range(p.n_limbs):
        value = left[i, q, s.hold[i]]
        if value >= FAR:
            return math.inf
        total += value
    return float((total + p.n_limbs - 1) // p.n_limbs)


@kernel
def mark_region(p, start, slack, low, count, region, pose):
    """Number the poses of a box through which a way from the start to the last goal needs at most `slack` moves more than the least.

    Args:
        p: Parameters.
        start: Pose of the start.
        slack: Moves.
        low, count: The box: least step of each axis, and how many.
        region: Output: number of each pose, -1 where it is not in the region; as long as the box.
        pose: Scratch.

    Returns:
        How many there are.
    """
    goal = goals_of(p)[p.n_goals - 1]
    least = moves_left(p, p.along, p.across, p.yaw + p.angle * start[YAW], goal)
    n = 0
    for index in range(region.shape[0]):
        rest = index
        for axis in range(AXES - 1, -1, -1):
            pose[axis] = low[axis] + rest % count[axis]
            rest //= count[axis]
        x, y = p.along + p.length * pose[ALONG], p.across + p.length * pose[ACROSS]
        there = moves_between(p, start, pose) + moves_left(p, x, y, p.yaw + p.angle * pose[YAW], goal)
        region[index] = n if there <= least + slack else -1
        n += region[index] >= 0
    return n


@kernel
def list_poses(p, low, count, region, poses):
    """Write all poses of a region."""
    for index in range(region.shape[0]):
        q = region[index]
        if q < 0:
            continue
        rest = index
        for axis in range(AXES - 1, -1, -1):
            poses[q, axis] = low[axis] + rest % count[axis]
            rest //= count[axis]
        poses[q, YAW] %= p.turns


@kernel
def reach_holds(p, limb, poses, left, postures, s):
    """Write for every pose and hold `FAR` if a limb reaches the hold, with its posture, and `DEAD` if it does not.

    Args:
        p: Parameters.
        limb: Index of the limb.
        poses: Poses of the region, shape (n, AXES).
        left: Output, shape (n, holds).
        postures: Output, shape (n, holds, joints).
        s: Scratch, array of one stance.
    """
    robot, holds = robot_of(p), holds_of(p)
    seeds = seeds_of(p)
    body = body_of(p)
    work = work_of(p)
    most = rules_of(p).reach * robot.size + TOLERANCE
    for q in range(poses.shape[0]):
        for axis in range(AXES):
            s[0].pose[axis] = poses[q, axis]
        place_body(p, s[0], scratch_of(p))
        for k in range(9):
            body.rotation[k] = s[0].turn[k]
        for k in range(3):
            body.place[k] = s[0].place[k]
        for h in range(p.n_holds):
            away = 0.0
            for k in range(3):
                away += (holds[h].place[k] - s[0].place[k]) ** 2
            left[q, h] = DEAD
            if away <= p.reach * p.reach:
                aim_limb(body, holds[h].place, holds[h].normal, limb, work)
                if solve_limb(robot, seeds, limb, work) <= most:
                    left[q, h] = FAR
                    for k in range(postures.shape[2]):
                        postures[q, h, k] = work.posture[limb, k]


@inlined
def near_by(one, other, most):
    """Whether no joint differs by more than `most` between two postures that are kept as single floats."""
    largest = 0.0
    for k in range(one.shape[0]):
        largest = max(largest, abs(one[k] - other[k]))
    return largest <= most + ROUNDED


@kernel
def join_poses(p, poses, beside, exits, met, s):
    """For each pose of the region the poses one move away, the least moves to the goal by a move out of it, and whether it meets the goal.

    Args:
        p: Parameters, with the region.
        poses: Poses of the region, shape (n, AXES).
        beside: Output, shape (n, MOVES): number of the pose, -1 where the lattice has none, `BEYOND` where it is outside.
        exits: Output, shape (n,): `FAR` where no move leads out.
        met: Output, shape (n,).
        s: Scratch, array of one stance.
    """
    goal = goals_of(p)[p.n_goals - 1]
    for q in range(poses.shape[0]):
        exits[q] = FAR
        for argument in range(MOVES):
            for axis in range(AXES):
                s[0].pose[axis] = poses[q, axis]
            beside[q, argument] = -1
            if not shift(p, argument, s[0].pose):
                continue
            other = region_index(p, s[0].pose)
            beside[q, argument] = other if other >= 0 else BEYOND
            if other < 0:
                x, y = p.along + p.length * s[0].pose[ALONG], p.across + p.length * s[0].pose[ACROSS]
                exits[q] = min(exits[q], 1 + moves_left(p, x, y, p.yaw + p.angle * s[0].pose[YAW], goal))
        s[0].x, s[0].y = p.along + p.length * poses[q, ALONG], p.across + p.length * poses[q, ACROSS]
        s[0].angle = p.yaw + p.angle * poses[q, YAW]
        met[q] = meets(p, s[0], goal)


@kernel
def count_down(p, limb, left, postures, beside, exits, met, reached):
    """Fill a limb's table: moves left at least plus n times the holds to take, over all poses and holds, from the goal on.

    Args:
        p: Parameters.
        limb: Index of the limb.
        left, postures: As `reach_holds` wrote them; `left` becomes the table.
        beside, exits, met: As `join_poses` wrote them.
        reached: Scratch: pairs that it reaches, as pose times holds plus hold.
    """
    goal, holds = goals_of(p)[p.n_goals - 1], holds_of(p)
    rules = rules_of(p)
    held = p.hard >> JUMP & 1
    jump, jump_moved = rules.jump if held else math.inf, rules.jump_moved if held else math.inf
    n, last = 0, 0
    for q in range(left.shape[0]):
        for h in range(left.shape[1]):
            if left[q, h] == FAR:
                reached[n] = q * left.shape[1] + h
                n += 1
                if met[q]:
                    left[q, h] = 0
                elif exits[q] < FAR:
                    left[q, h] = min(FAR - 1, exits[q] + p.n_limbs * grabs_left(p, limb, holds[h], goal))
                if left[q, h] < FAR:
                    last = max(last, left[q, h])
    value = 0
    while value <= last:
        for at in range(n):
            q, h = reached[at] // left.shape[1], reached[at] % left.shape[1]
            if left[q, h] != value:
                continue
            for argument in range(MOVES):
                other = beside[q, argument]
                if (
                    other >= 0
                    and value + 1 < left[other, h] < DEAD
                    and near_by(postures[q, h], postures[other, h], jump)
                ):
                    left[other, h] = value + 1
                    last = max(last, value + 1)
            for k in range(left.shape[1]):
                if value + p.n_limbs < left[q, k] < DEAD and near_by(postures[q, h], postures[q, k], jump_moved):
                    left[q, k] = value + p.n_limbs
                    last = max(last, value + p.n_limbs)
        value += 1
