"""A hook pushed onto a hold until it stops, then tugged (Bevly 1997, Fig. 4.14): stopped is not seated."""

import math
from typing import Final

import numpy as np

from ....types import Floats
from .climber import Climber
from .motions import ramp

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


def push_on(climber: Climber, i: int, place: Floats, g: Floats, room: float) -> bool:
    """Push a hook along its grab direction until it stops, then tug as hard as it will have to carry, until it no longer advances.

    One that stops short of where its hold should be is coaxed across under the tug, as its flare may have met the hold.

    Returns:
        Whether it came to rest under the tug, not farther in than a hold could be. Where the body hangs, it then goes on pulling: what
        let go of would swing.
    """
    body, task, period = climber.body, climber.body.tasks[i], climber.plant.period
    task.mode, task.pressed, task.tug = "contact_push", False, np.zeros(2)
    stage, still, tugged, phase, borne = "push", 0.0, 0.0, 0.0, 0.0
    seated, marks, anew = False, [-math.inf, -math.inf], 0
    places, felt, speeds, grabs = body.in_world.tolist()
    rested, apart = body.pose.tolist(), _apart(climber, felt, places)
    hangs = climber.hangs
    part, coaxing, coaxed = HANGING if hangs else 1.0, WIDE_DITHER, 0.0
    (gx, gy), (px, py) = g.tolist(), place.tolist()
    for _ in range(round(PATIENCE / period)):
        (bx, by, _), (x, y), (ax, ay) = body.pose.tolist(), places[i], grabs[i]
        size = PUSH + (TUG - PUSH) * min(tugged / TUG_RISE, 1.0)
        # what hangs swings aside with a pull, which takes nothing off its own hold; risen, it has gone far enough
        lifted = by - rested[1] if hangs else (rested[0] - bx) * gx + (rested[1] - by) * gy
        if stage == "push":
            # believed to press before it does: in free air the tip is then farther in than believed, never less far
            free = (px - x) * gx + (py - y) * gy - room
            size += ramp(free, (0.0, FREE), (0.0, HASTE))
        # a joint that crosses its play, or is wrongly believed to, is seen in one of both; a hook that slides, in both
        slid = min(
            math.sqrt((nx - wx) * (nx - wx) + (ny - wy) * (ny - wy))
            for (nx, ny), (wx, wy) in zip(_apart(climber, felt, places), apart, strict=True)
        )
        faded = min(ramp(lifted, LIFT, (1.0, 1 / 3)), ramp(slid, SLIDING, (1.0, 1 / 3)))
        size *= part * faded
        strength, rate = (coaxing, WIDE_RATE) if stage == "coax" else (DITHER, DITHER_RATE)
        phase += 2 * math.pi * rate * period
        side = part * strength * math.sin(phase)
        if stage == "push":
            aside = -ay * (px - x) + ax * (py - y)
            side += min(max(STEERING[0] * aside, -STEERING[1]), STEERING[1]) if free > 0.0 else CENTRING * aside
            if free <= 0.0 and not task.pressed:
                task.pressed = True
        else:
            tugged += period
            part = min(1.0, part + period / YIELDING) if hangs else part
        # what does not go into motion is borne by what the hook meets, and the other limbs carry that much less
        vx, vy = speeds[i]
        borne += period / BORNE_TIME * (min(max(size - task.damping * (vx * ax + vy * ay), 0.0), size) - borne)
        task.tug = np.array((borne * ax, borne * ay))
        task.force = np.array((size * ax - side * ay, size * ay + side * ax))
        climber.tick()
        places, felt, speeds, grabs = body.in_world.tolist()
        # the play is crossed without a motor that turns, and the belief about it lags: both must have come to rest
        (fx, fy), (x, y) = felt[i], places[i]
        least = ADVANCE if stage == "push" else CREEP
        advanced = False
        for k, reached in enumerate((fx * gx + fy * gy, x * gx + y * gy)):
            if reached > marks[k] + least:
                marks[k], advanced = reached, True
        still = 0.0 if advanced else still + period
        ahead = (px - x) * gx + (py - y) * gy
        # the belief about the play may be out for a while, the encoders know nothing of it: beyond by both is beyond
        if max(ahead, (px - fx) * gx + (py - fy) * gy) < -room:
            break
        if stage == "push" and still > STOPPED:
            stage, still = "coax" if ahead > SHORT else "tug", 0.0
        elif stage == "coax":
            coaxed += period
            far = ahead > FAR_SHORT
            coaxing = ramp(coaxed, (STUCK / 2, COAXED), (WIDE_DITHER, STRONGEST if far else WIDE_DITHER))
            if coaxed > COAXED or (still > STUCK and not far) or ahead < 0.5 * SHORT:
                stage, still = "tug", 0.0
        elif stage == "tug" and tugged > TUG_RISE and still > STILL:
            if faded > FIRM or anew == ANEW:
                seated = True
                break
            # a weak push lets a hook rest on its flare: from where the body is now, with all of it
            rested, apart, still, anew = body.pose.tolist(), _apart(climber, felt, places), 0.0, anew + 1
    if hangs and seated:
        task.force = np.array((size * ax, size * ay))
        return True
    task.pressed, task.tug = False, np.zeros(2)
    return seated


def _apart(climber: Climber, *beliefs: list[list[float]]) -> list[list[float]]:
    """One holding tip less another by each belief of where the tips are, world frame, shape (beliefs, 2) [m]."""
    holding = climber.holding()
    i, j = holding[0], holding[-1]
    return [[tips[i][0] - tips[j][0], tips[i][1] - tips[j][1]] for tips in beliefs]
