"""Motions of a robot in space: the body over its holds, and a limb from hold to hold."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Floats
from .course import BodyMotion, Regrab
from .limbed_body import LimbedBody
from .references import PEAK_SPEED, BodyPath, TipPath, quintic, rotation_vector, seconds_for, swing_seconds

SPEED: Final = 0.7
"""Of a joint's largest speed that motions may ask for [-]."""
SETTLING: Final = 0.1
"""After a motion [s]."""


@dataclass(slots=True)
class Landing:
    """What became of a regrab."""

    taken: bool
    off: float
    """Of the tip from its hold, as believed [m]."""
    tries: int = 1
    reason: str = ""


def rest(body: LimbedBody, seconds: float) -> None:
    """Stay."""
    aims = body.law.aims
    aims.velocity[:] = aims.acceleration[:] = 0.0
    for _ in range(max(1, round(seconds / body.plant.period))):
        body.tick()


def share_loads(body: LimbedBody, loads: Floats, seconds: float, limb: int = -1, *, fading: bool = False) -> None:
    """Let the contacts' loads become others, in some time; a limb that is `fading` bears less and less, otherwise ever more."""
    aims = body.law.aims
    aims.velocity[:] = aims.acceleration[:] = 0.0
    before = body.loads.copy()
    most = float(np.abs(before if fading else loads).max()) + body.pace.weight
    count = max(1, round(seconds / body.plant.period))
    for k in range(1, count + 1):
        share = quintic(k / count)[0]
        body.loads[:] = before + share * (loads - before)
        if limb >= 0:
            left = (1.0 - share) if fading else share
            aims.cap[limb] = max(left, 1e-3) * most
        body.tick()
    if limb >= 0 and not fading:
        aims.cap[limb] = math.inf


def move_body(body: LimbedBody, motion: BodyMotion) -> None:
    """The body from its first stance to its last, loads passing from the one's to the other's."""
    start, end = motion.way[0], motion.way[-1]
    aims, pace, law = body.law.aims, body.pace, body.law
    way = float(np.linalg.norm(end.pose.position - aims.position))
    turned = float(np.linalg.norm(rotation_vector(end.pose.rotation @ aims.rotation.T)))
    seconds = seconds_for(max(way, turned * pace.size), pace.body)
    quick = float(np.max(np.abs(end.joints - start.joints) / law.limits.speed, initial=0.0))
    seconds = max(seconds, PEAK_SPEED * quick / SPEED, 4.0 * body.plant.period)
    path = BodyPath.between(aims.position, aims.rotation, end.pose.position, end.pose.rotation, seconds)
    before, posture = body.loads.copy(), aims.posture.copy()
    for k in range(1, math.ceil(seconds / body.plant.period) + 1):
        time = k * body.plant.period
        aims.position[:], aims.rotation[:], aims.velocity[:], aims.acceleration[:] = path.at(time)
        share = quintic(time / seconds)[0]
        body.loads[:] = before + share * (end.loads - before)
        aims.posture[:] = posture + share * (end.joints - posture)
        body.tick()
    rest(body, SETTLING)


def regrab(body: LimbedBody, motion: Regrab) -> Landing:
    """A limb lets go of its hold, swings, and takes another."""
    pace, _world, limb = body.pace, body.world, motion.limb
    old = int(body.holds[limb])
    share_loads(body, motion.loads, pace.shift, limb, fading=True)
    body.plant.grip(limb, False)
    body.let_go(limb)
    path = _path(body, limb, old, motion)
    _swing(body, motion, path)
    found = _approach(body, motion, path)
    off = float(np.linalg.norm(body.tips[limb] - path.end))
    if not found:
        return Landing(False, off, reason=f"nothing to hold on to within {1e3 * pace.depth:.0f} mm")
    body.hold_on(limb, motion.hold)
    share_loads(body, motion.after.loads, pace.shift, limb)
    return Landing(True, off)


def _path(body: LimbedBody, limb: int, old: int, motion: Regrab) -> TipPath:
    """From where the tip is to the hold."""
    world, pace = body.world, body.pace
    start, end = body.tips[limb].copy(), world.places[motion.hold]
    lift = body.lift
    seconds = swing_seconds(float(np.linalg.norm(end - start)), lift, pace.swing)
    mine = slice(*body.joints_of(limb))
    moved = np.abs(motion.after.joints - motion.before.joints)[mine] / body.law.limits.speed[mine]
    seconds = max(seconds, PEAK_SPEED * float(moved.max()) / SPEED / 0.7)
    return TipPath(start, end, world.normals[[old, motion.hold]], lift, seconds)


def _swing(body: LimbedBody, motion: Regrab, path: TipPath) -> None:
    """Along the path, to its end or to where a foot that comes down touches."""
    limb, aims = motion.limb, body.law.aims
    posture = aims.posture.copy()
    pointed = bool(body.robot.contacts[limb].aligned)
    count = math.ceil(path.seconds / body.plant.period)
    for k in range(1, count + 1):
        time = k * body.plant.period
        body.swing(limb, path.at(time), path.points(time) if pointed else None)
        aims.posture[:] = posture + quintic(k / count)[0] * (motion.after.joints - posture)
        body.tick()
        if k > 0.8 * count and not body.attaches(limb) and touches(body, limb):
            return


def _approach(body: LimbedBody, motion: Regrab, path: TipPath) -> bool:
    """Feel on along the inward normal until the limb has its hold; whether it has."""
    limb, pace = motion.limb, body.pace
    inward = -path.normals[1]
    speed = pace.approach * inward
    body.press(limb, path.normals[1])
    if body.attaches(limb):
        body.plant.grip(limb, True)
    for k in range(1, math.ceil(pace.depth / pace.approach / body.plant.period) + 1):
        if touches(body, limb):
            return True
        deep = k * body.plant.period * speed
        body.swing(limb, (path.end + deep, speed, np.zeros(3)), inward if body.robot.contacts[limb].aligned else None)
        body.tick()
    body.press(-1, inward)
    return False


def touches(body: LimbedBody, limb: int) -> bool:
    """Whether a limb's end effector is attached, or what only pushes is pushed against."""
    if body.attaches(limb):
        return bool(body.sensed.closed[limb])
    return float(np.linalg.norm(body.sensed.wrenches[limb, :3])) > body.pace.touch
