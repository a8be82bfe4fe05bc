"""A hook pushed onto a hold until it stops, then tugged (Bevly 1997, Fig. 4.14): stopped is not seated. Kernels."""

import math
from typing import Final

import numpy as np

from ....compiled import inlined, kernel, opened
from .planar_limb import HANG, STANCE

PUSH: Final = 10.0
"""Gentle pull along the grab direction until the hook stops [N]."""
HASTE: Final = 8.0
"""So much more while the hold, wherever it is, is still ahead: a stiff joint would creep there [N]."""
FREE: Final = 0.005
"""Least distance from the nearest place where the hold may be for all of that [m]."""
TUG: Final = 10.0
"""Pull on a hook that has stopped: a quarter of LIBRA's weight; more would lift the limb below off its hold [N]."""
LIFT: Final = (0.003, 0.006)
"""A push that lifts the body this far weakens, to a third at the second: it bears already, and other hooks would come off [m]."""
SLIDING: Final = (0.003, 0.006)
"""So does one under which the tips of holding limbs come apart this far: a hook is coming off, unless joints cross their play [m]."""
FIRM: Final = 0.7
"""A push that has weakened to less of itself tells no seat [-]: it begins anew from where the body has come to rest ..."""
ANEW: Final = 2
"""... so often at most."""
TUG_RISE: Final = 0.1
"""In which the tug grows to its full size [s]."""
BORNE_TIME: Final = 0.05
"""Over which what a push meets is smoothed [s]."""
DITHER: Final = 8.0
"""Pull across, to and fro, so that friction lets the hook slide in [N]."""
DITHER_RATE: Final = 5.0
"""[Hz]."""
SHORT: Final = 0.004
"""A hook that stops this far before where its hold should be may have met it with its flare [m]."""
WIDE_DITHER: Final = 14.0
"""Then the dither is so strong [N] ..."""
WIDE_RATE: Final = 2.5
"""... and so slow that it moves the hook across by millimetres [Hz]."""
STUCK: Final = 0.8
"""At most for that long without an advance [s] ..."""
FAR_SHORT: Final = 0.006
"""... but where it stops this far before, as few hooks do that are home [m] ..."""
COAXED: Final = 2.4
"""... for that long [s] ..."""
STRONGEST: Final = 30.0
"""... while the dither grows to this, beyond what the joints rub with in most postures [N]."""
HANGING: Final = 0.4
"""Part of these forces until the hook has stopped where the body hangs on one limb, which gives way to whatever knocks it [-]."""
YIELDING: Final = 0.3
"""Then the rest comes, over this long: the joints' friction eats the small part, and the body goes aside, not off its own hold [s]."""
CENTRING: Final = 150.0
"""Pull towards the believed hold across the hook, where it may have met it: the flare finds the hold [N/m] ..."""
STEERING: Final = (1500.0, 15.0)
"""... and while the hold, wherever it is, is still ahead [N/m], at most so much [N]: a limb whose elbow is nearly straight is held back
by the friction of one joint, and the push takes it aside, past the hold."""
ADVANCE: Final = 0.0015
"""A tip that advances less than this along the grab direction has stopped [m]."""
CREEP: Final = 0.0006
"""So has one under a tug that advances less than this: a hook creeps in on its flare [m]."""
STOPPED: Final = 0.2
"""For that long, a period of the dither, before the tug begins [s]."""
STILL: Final = 0.25
"""For that long under the full tug before a hook counts as seated [s]."""
PATIENCE: Final = 8.0
"""For one push [s]."""


PUSHING: Final = np.dtype(
    [
        ("period", "f8"),  # of a tick [s]
        ("room", "f8"),  # how much farther along than believed the hold may be [m]
        ("hangs", "i4"),  # 1: the body hangs on one limb
        ("limb", "i4"),  # index of the one that pushes
        ("place", "f8", (2,)),  # of the hold as believed, world frame [m]
        ("grab", "f8", (2,)),  # unit vector along which it is pushed, world frame
        ("most", "i8"),  # ticks in all
        ("ticks", "i8"),  # so far
        ("stage", "i4"),  # one of those below
        ("anew", "i4"),  # how often it has begun anew
        ("pull", "f8", (2,)),  # of the newest tick, without the dither, world frame [N]
        ("phase", "f8"),  # of the dither [rad]
        ("part", "f8"),  # of the forces that is given [-]
        ("faded", "f8"),  # of these, what is left of a push that lifts or slides [-]
        ("borne", "f8"),  # of the push by what it meets, smoothed [N]
        ("tugged", "f8"),  # since the tug began [s]
        ("coaxed", "f8"),  # since the hook was first coaxed [s]
        ("coaxing", "f8"),  # strength of the wide dither [N]
        ("still", "f8"),  # without an advance [s]
        ("marks", "f8", (2,)),  # farthest along the grab direction by the encoders, and with the play counted [m]
        ("rested", "f8", (2,)),  # of the body when it was last at rest, world frame [m]
        ("apart", "f8", (4,)),  # of two holding tips then, see `_apart` [m]
    ],
    align=True,
)
"""A hook that is being pushed on."""
PUSHED, COAXED_ON, TUGGED = range(3)
"""Stages."""
GOES_ON, IS_SEATED, IS_LOOSE = range(3)


@kernel
def push_tick(handle):
    """Set the force of a hook that is pushed on for the next tick, by what came of the last one: GOES_ON, IS_SEATED or IS_LOOSE.

    Args:
        handle: Holds a record of `PUSHING`, changed, shape (1,); the body's pose, shape (3,); `WholeBody.in_world`; records of
            `LIMB_TASK`, of which that of the limb is changed; and the force and its steady part, filled, shape (2, 2) [N].
    """
    pushes, pose, tips, jobs, forces = opened(handle)
    push = pushes[0]
    if push.ticks == 0:
        _rest(push, pose, tips, jobs)
    else:
        state = _judge(push, pose, tips, jobs)
        if state != GOES_ON:
            return state
    if push.ticks == push.most:
        return IS_LOOSE
    push.ticks += 1
    i = push.limb
    job = jobs[i]
    gx, gy = push.grab[0], push.grab[1]
    ax, ay = tips[3, i, 0], tips[3, i, 1]
    size = PUSH + (TUG - PUSH) * min(push.tugged / TUG_RISE, 1.0)
    # what hangs swings aside with a pull, which takes nothing off its own hold; risen, it has gone far enough
    lifted = (
        pose[1] - push.rested[1] if push.hangs else (push.rested[0] - pose[0]) * gx + (push.rested[1] - pose[1]) * gy
    )
    ahead_x = push.place[0] - tips[0, i, 0]
    ahead_y = push.place[1] - tips[0, i, 1]
    # believed to press before it does: in free air the tip is then farther in than believed, never less far
    free = ahead_x * gx + ahead_y * gy - push.room
    if push.stage == PUSHED:
        size += _ramp(free, 0.0, FREE, 0.0, HASTE)
    # a joint that crosses its play, or is wrongly believed to, is seen in one of both; a hook that slides, in both
    now = _apart(jobs, tips)
    slid = math.inf
    for k in range(2):
        x = now[2 * k] - push.apart[2 * k]
        y = now[2 * k + 1] - push.apart[2 * k + 1]
        slid = min(slid, math.sqrt(x * x + y * y))
    push.faded = min(_ramp(lifted, LIFT[0], LIFT[1], 1.0, 1 / 3), _ramp(slid, SLIDING[0], SLIDING[1], 1.0, 1 / 3))
    size *= push.part * push.faded
    coaxes = push.stage == COAXED_ON
    push.phase += 2 * math.pi * (WIDE_RATE if coaxes else DITHER_RATE) * push.period
    side = push.part * (push.coaxing if coaxes else DITHER) * math.sin(push.phase)
    if push.stage == PUSHED:
        aside = -ay * ahead_x + ax * ahead_y
        side += min(max(STEERING[0] * aside, -STEERING[1]), STEERING[1]) if free > 0.0 else CENTRING * aside
        if free <= 0.0:
            job.pressed = 1
    else:
        push.tugged += push.period
        if push.hangs:
            push.part = min(1.0, push.part + push.period / YIELDING)
    # what does not go into motion is borne by what the hook meets, and the other limbs carry that much less
    moves = job.damping * (tips[2, i, 0] * ax + tips[2, i, 1] * ay)
    push.borne += push.period / BORNE_TIME * (min(max(size - moves, 0.0), size) - push.borne)
    push.pull[0], push.pull[1] = size * ax, size * ay
    forces[0, 0], forces[0, 1] = size * ax - side * ay, size * ay + side * ax
    forces[1, 0], forces[1, 1] = push.borne * ax, push.borne * ay
    for k in range(2):
        job.force[k], job.tug[k] = forces[0, k], forces[1, k]
    return GOES_ON


@inlined
def _judge(push, pose, tips, jobs):
    """What came of a tick."""
    i = push.limb
    gx, gy = push.grab[0], push.grab[1]
    x, y, fx, fy = tips[0, i, 0], tips[0, i, 1], tips[1, i, 0], tips[1, i, 1]
    # the play is crossed without a motor that turns, and the belief about it lags: both must have come to rest
    least = ADVANCE if push.stage == PUSHED else CREEP
    advanced = False
    for k in range(2):
        reached = fx * gx + fy * gy if k == 0 else x * gx + y * gy
        if reached > push.marks[k] + least:
            push.marks[k] = reached
            advanced = True
    push.still = 0.0 if advanced else push.still + push.period
    ahead = (push.place[0] - x) * gx + (push.place[1] - y) * gy
    # the belief about the play may be out for a while, the encoders know nothing of it: beyond by both is beyond
    if max(ahead, (push.place[0] - fx) * gx + (push.place[1] - fy) * gy) < -push.room:
        return IS_LOOSE
    if push.stage == PUSHED and push.still > STOPPED:
        push.stage, push.still = COAXED_ON if ahead > SHORT else TUGGED, 0.0
    elif push.stage == COAXED_ON:
        push.coaxed += push.period
        far = ahead > FAR_SHORT
        push.coaxing = _ramp(push.coaxed, STUCK / 2, COAXED, WIDE_DITHER, STRONGEST if far else WIDE_DITHER)
        if push.coaxed > COAXED or (push.still > STUCK and not far) or ahead < 0.5 * SHORT:
            push.stage, push.still = TUGGED, 0.0
    elif push.stage == TUGGED and push.tugged > TUG_RISE and push.still > STILL:
        if push.faded > FIRM or push.anew == ANEW:
            return IS_SEATED
        # a weak push lets a hook rest on its flare: from where the body is now, with all of it
        _rest(push, pose, tips, jobs)
        push.still = 0.0
        push.anew += 1
    return GOES_ON


@inlined
def _rest(push, pose, tips, jobs):
    """Take where the body and the holding tips are for where they rest."""
    push.rested[0], push.rested[1] = pose[0], pose[1]
    now = _apart(jobs, tips)
    for k in range(4):
        push.apart[k] = now[k]


@inlined
def _apart(jobs, tips):
    """The first holding tip less the last, world frame, by the encoders alone and with the play counted: x, y, x, y [m]."""
    first, last = -1, -1
    for k in range(jobs.size):
        if jobs[k].mode in (STANCE, HANG):
            first, last = k if first < 0 else first, k
    return (
        tips[1, first, 0] - tips[1, last, 0],
        tips[1, first, 1] - tips[1, last, 1],
        tips[0, first, 0] - tips[0, last, 0],
        tips[0, first, 1] - tips[0, last, 1],
    )


@inlined
def _ramp(x, start, end, before, after):
    """A value before a stretch, another after it, and between both on it."""
    if start < x < end:
        return (after - before) / (end - start) * (x - start) + before
    return before if x <= start else after
