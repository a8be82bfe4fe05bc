"""Body poses on a guide: from steps of a lattice to a frame in the world."""

import math

import numpy as np

from ....compiled import carray, inlined, kernel, pointer
from ..statics.records import BODY, CONTACT, JUDGED, LIMBS, ROBOT, RULES, SEEDS, WORK
from ..world.guide import GRAIN, NODE
from .records import ACROSS, ALONG, GOAL, HEIGHT, HOLD, PITCH, ROLL, YAW

FOLLOW = 3
"""Numbers of a place of the fitted surface: height over the guide [m], slopes along and across [-]."""


@inlined
def goals_of(p):
    """Goals in order."""
    return carray(pointer(p.goals_at), p.n_goals, GOAL)


@inlined
def robot_of(p):
    """The robot."""
    return carray(pointer(p.robot_at), 1, ROBOT)[0]


@inlined
def holds_of(p):
    """Holds of the world."""
    return carray(pointer(p.holds_at), p.n_holds, HOLD)


@inlined
def seeds_of(p):
    """Where searches of postures begin."""
    return carray(pointer(p.seeds_at), 1, SEEDS)[0]


@inlined
def rules_of(p):
    """What stances are judged by."""
    return carray(pointer(p.rules_at), 1, RULES)[0]


@inlined
def body_of(p):
    """Pose of the base that the thread judges, and what acts on it."""
    return carray(pointer(p.work_body_at), 1, BODY)[0]


@inlined
def contacts_of(p):
    """Contacts of the limbs of the stance that the thread judges."""
    return carray(pointer(p.work_contacts_at), LIMBS, CONTACT)


@inlined
def judged_of(p):
    """What the thread found of the stance before, and of the one that it judges."""
    return carray(pointer(p.work_judged_at), 2, JUDGED)


@inlined
def work_of(p):
    """Scratch of the thread for statics."""
    return carray(pointer(p.work_statics_at), 1, WORK)[0]


@kernel
def guide_frame(p, along, out):
    """Frame of the guide at a distance along it [m], which goes straight on beyond its ends: origin, then axes, into `out` (12,)."""
    frames = carray(pointer(p.frames_at), (p.n_frames, NODE), np.float64)
    last = GRAIN * (p.n_frames - 1)
    within = min(max(along, 0.0), last)
    at = within / GRAIN
    k = min(int(at), p.n_frames - 2)
    at -= k
    for i in range(NODE):
        out[i] = (1.0 - at) * frames[k, i] + at * frames[k + 1, i]
    for i in range(3):
        out[i] += (along - within) * out[3 + i]


@kernel
def fitted_surface(p, along, across, out):
    """Height [m] and slopes along and across of the surface that is fitted to the holds, over the guide; zero where none is."""
    if p.n_rows == 0:
        out[0] = out[1] = out[2] = 0.0
        return
    grid = carray(pointer(p.follow_at), (p.n_rows, p.n_columns, FOLLOW), np.float64)
    a = min(max((along - p.follow_along) / p.follow_grain, 0.0), p.n_rows - 1.001)
    b = min(max((across - p.follow_across) / p.follow_grain, 0.0), p.n_columns - 1.001)
    i = int(a)
    j = int(b)
    a -= i
    b -= j
    for k in range(FOLLOW):
        near = (1.0 - b) * grid[i, j, k] + b * grid[i, j + 1, k]
        far = (1.0 - b) * grid[i + 1, j, k] + b * grid[i + 1, j + 1, k]
        out[k] = (1.0 - a) * near + a * far


@inlined
def normalise(v, i):
    """Make three numbers of an array from `i` on a unit vector."""
    scale = 1.0 / math.sqrt(v[i] * v[i] + v[i + 1] * v[i + 1] + v[i + 2] * v[i + 2])
    for k in range(i, i + 3):
        v[k] *= scale


@kernel
def place_body(p, s, w):
    """Write the pose of a stance's body from its steps; `w` is scratch (32,)."""
    s.x = p.along + p.length * s.pose[ALONG]
    s.y = p.across + p.length * s.pose[ACROSS]
    s.angle = p.yaw + p.angle * s.pose[YAW]
    frame = w[0:12]
    fit = w[12:15]
    up = w[15:18]
    ahead = w[18:21]
    side = w[21:24]
    guide_frame(p, s.x, frame)
    normalise(frame, 3)
    normalise(frame, 6)
    normalise(frame, 9)
    fitted_surface(p, s.x, s.y, fit)
    for i in range(3):
        up[i] = frame[9 + i] - fit[1] * frame[3 + i] - fit[2] * frame[6 + i]
    normalise(up, 0)
    height = p.height + p.rise * s.pose[HEIGHT]
    cosine = math.cos(s.angle)
    sine = math.sin(s.angle)
    lean = 0.0
    for i in range(3):
        s.place[i] = frame[i] + s.y * frame[6 + i] + fit[0] * frame[9 + i] + height * up[i]
        ahead[i] = cosine * frame[3 + i] + sine * frame[6 + i]
        lean += ahead[i] * up[i]
    for i in range(3):
        ahead[i] -= lean * up[i]
    normalise(ahead, 0)
    side[0] = up[1] * ahead[2] - up[2] * ahead[1]
    side[1] = up[2] * ahead[0] - up[0] * ahead[2]
    side[2] = up[0] * ahead[1] - up[1] * ahead[0]
    pitch = p.pitch + p.tilt * s.pose[PITCH]
    roll = p.roll + p.tilt * s.pose[ROLL]
    cp = math.cos(pitch)
    sp = math.sin(pitch)
    cr = math.cos(roll)
    sr = math.sin(roll)
    for i in range(3):  # pitch about the body's y, then roll about its new x
        x = cp * ahead[i] - sp * up[i]
        z = sp * ahead[i] + cp * up[i]
        s.turn[3 * i] = x
        s.turn[3 * i + 1] = cr * side[i] + sr * z
        s.turn[3 * i + 2] = cr * z - sr * side[i]


@inlined
def outside(value, low, high):
    """How far a value lies outside a range."""
    return max(0.0, max(low - value, value - high))


@inlined
def yaw_missing(p, angle, goal):
    """Angle by which a yaw lies outside a goal's range [rad]."""
    if goal.yaw_width > math.tau:
        return 0.0
    past = (angle - goal.yaw_min) % math.tau
    return 0.0 if past <= goal.yaw_width + 1e-9 else min(past - goal.yaw_width, math.tau - past)


@kernel
def meets(p, s, goal):
    """Whether a body is where a goal asks for."""
    away = outside(s.x, goal.along_min, goal.along_max) + outside(s.y, goal.across_min, goal.across_max)
    return away < 1e-9 and yaw_missing(p, s.angle, goal) < 1e-9


@inlined
def away_from(x, y, goal):
    """Distance of a place on the guide from a goal's box [m]."""
    along = outside(x, goal.along_min, goal.along_max)
    across = outside(y, goal.across_min, goal.across_max)
    return math.sqrt(along * along + across * across)
