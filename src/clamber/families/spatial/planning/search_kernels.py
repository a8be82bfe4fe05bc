"""What searches ask of a task in space: actions from a stance, its key, its features, what is left at least."""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ....planning.problem.check import TICKS
from ....planning.problem.codes import MOVE, pack_code
from ....planning.problem.family_kernels import family_kernels
from ..statics.records import JOINTS, LIMBS
from .bounding_kernels import moves_between, plain_bound, table_bound
from .judging_kernels import know_posture, scratch_of, set_contacts
from .poses_kernels import away_from, goals_of, holds_of, meets, place_body, yaw_missing
from .records import ACROSS, ALONG, AXES, HEIGHT, PARAMS, PITCH, ROLL, YAW
from .step_kernels import MOVES, NEAR, RANKED, draft, holds_near, step


@kernel
def candidates(p, s, codes):
    """Moves of the body, and the nearest holds of every limb."""
    n = 0
    for argument in range(MOVES):
        axis = (argument % NEAR) >> 1
        if axis in (PITCH, ROLL) and (p.tilt == 0.0 or p.tilts == 0):
            continue
        codes[n] = pack_code(MOVE, 0, argument)
        n += 1
    for limb in range(p.n_limbs):
        n += holds_near(p, s, limb, codes[n:], scratch_of(p)[RANKED : RANKED + p.nearest])
    return n


@kernel
def key(p, s, words):
    """Along, across and yaw in ticks; then height, pitch, roll and stage; then the holds, 16 bits each."""
    words[0], words[1], words[2] = s.pose[ALONG] * TICKS, s.pose[ACROSS] * TICKS, s.pose[YAW] * TICKS
    words[3] = (
        s.stage << 48 | (s.pose[HEIGHT] & 0xFFFF) << 32 | (s.pose[PITCH] & 0xFFFF) << 16 | (s.pose[ROLL] & 0xFFFF)
    )
    words[4] = 0
    words[5] = 0
    for i in range(p.n_limbs):
        words[4 + (i >> 2)] |= (s.hold[i] & 0xFFFF) << 16 * (i & 3)


@inlined
def signed(word):
    """A signed number of 16 bits."""
    return ((word & 0xFFFF) ^ 0x8000) - 0x8000


@kernel
def restore(p, words, s):
    """The stance of a key, with its posture."""
    s.pose[ALONG], s.pose[ACROSS], s.pose[YAW] = words[0] // TICKS, words[1] // TICKS, words[2] // TICKS
    s.pose[HEIGHT], s.pose[PITCH], s.pose[ROLL] = signed(words[3] >> 32), signed(words[3] >> 16), signed(words[3])
    s.stage = words[3] >> 48 & 0xFFFF
    for i in range(LIMBS):
        s.hold[i] = words[4 + (i >> 2)] >> 16 * (i & 3) & 0xFFFF if i < p.n_limbs else -1
    s.count = 0
    place_body(p, s, scratch_of(p))
    set_contacts(p, s, -1, -1)
    for i in range(p.n_limbs):
        known = know_posture(p, s, i)
        for k in range(JOINTS):
            s.q[i, k] = known.posture[k]
    s.postured = 1


@kernel
def measure(p, s, row):
    """Progress of body and limbs [m], one action, goals met, length, nothing unstable, share of all limits that is used."""
    holds = holds_of(p)
    goal = goals_of(p)[min(s.stage, p.n_goals - 1)]
    done = goal.way
    row[0] = done - away_from(s.x, s.y, goal) - p.reach * yaw_missing(p, s.angle, goal)
    tips = carray(pointer(p.tips_at), (p.n_limbs, 3), np.float64)
    row[1] = 0.0
    cosine, sine = math.cos(s.angle), math.sin(s.angle)
    for i in range(p.n_limbs):
        hold = holds[s.hold[i]]
        along = hold.along - cosine * tips[i, 0] + sine * tips[i, 1]
        across = hold.across - sine * tips[i, 0] - cosine * tips[i, 1]
        row[1] += done - away_from(along, across, goal)
    row[2] = 0.0
    row[3] = s.stage
    row[4] = 1.0
    row[5] = 0.0
    row[6] = 1.0 - s.share


@kernel
def bound(p, s):
    """Actions that are left at least: by the tables, where there are any for the pose, else by distances alone."""
    if s.stage >= p.n_goals:
        return 0.0
    if p.n_region > 0 and s.stage == p.n_goals - 1:
        left = table_bound(p, s)
        if left >= 0.0:
            return left
    return float(plain_bound(p, s))


@kernel
def heuristic_between(p, s, t):
    """Moves of the body from one pose to the other, and limbs that have to take another hold."""
    count = moves_between(p, s.pose, t.pose)
    for i in range(p.n_limbs):
        if s.hold[i] != t.hold[i]:
            count += 1
    return float(count)


@kernel
def done(p, s):
    """Whether every goal is met."""
    return s.stage >= p.n_goals


@kernel
def cell(p, s):
    """Stage, holds, and every other step of the pose along and across, for niching."""
    value = (s.stage * 1000003 + (s.pose[ALONG] >> 1)) * 1000003 + (s.pose[ACROSS] >> 1)
    for i in range(p.n_limbs):
        value = (value * 1000003 + s.hold[i]) & 0x3FFFFFFFFFFFFFFF
    return value


@kernel
def body_pose(p, s, words):
    """The pose in ticks, then the hold of each limb."""
    for axis in range(AXES):
        words[axis] = s.pose[axis] * TICKS
    for i in range(LIMBS):
        words[AXES + i] = s.hold[i]


@kernel
def satisfies_goal(p, s, k):
    """Whether the body is where goal k asks for."""
    return meets(p, s, goals_of(p)[k])


family_kernels(
    PARAMS,
    step=step,
    draft=draft,
    heuristic_between=heuristic_between,
    candidates=candidates,
    key=key,
    restore=restore,
    measure=measure,
    bound=bound,
    done=done,
    cell=cell,
    body_pose=body_pose,
    satisfies_goal=satisfies_goal,
)
