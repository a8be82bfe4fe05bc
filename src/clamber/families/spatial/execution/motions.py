"""Motions of a robot in space: the body over its holds, and a limb from hold to hold, which is one behaviour for every end effector.

A limb unloads, lets go, retracts along the normal and swings; it approaches its hold, feels on along the inward normal, and closes or
presses; it searches beside where there is nothing; and its load is passed to it while the body stays where the others alone hold it, so
that what comes off under this load test has only to be taken again.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ....control.whole_body.tree import FREE, Dynamics, State
from ....control.whole_body.tree_kernels import place_bodies, tip_motion
from ....types import Floats
from ..statics.judging import lift_between
from .course import BodyMotion, Regrab
from .limbed_body import LimbedBody, LostHoldError
from .reference_kernels import aim_body, aim_swing, change_aims, direction_at, quintic
from .references import PEAK_SPEED, BodyPath, TimeScaling, TipPath, rotation_vector, seconds_for, swing_seconds

SPEED: Final = 0.7
"""Of a joint's largest speed that motions may ask for [-]."""
SETTLING: Final = 0.1
"""After a motion [s]."""
PRESSED: Final = 1.5
"""Force on something that is to be closed about, of that by which it is noticed [-]."""
SAMPLES: Final = 33
"""Places along a swing where the speeds of its joints are looked at."""
SINGULAR: Final = 0.01
"""A limb whose tip a turn of its joints moves by less than that part of its length is near a singularity [-]."""
LARGEST_STEP: Final = 0.3
"""Of a joint that turns an end effector, from one of these places to the next: near a posture in which it can't, it lags behind and catches
up, as under the law [rad] or [m]."""
FOLDED: Final = 0.25
"""How far a limb that is left out is lifted off what it stood on, where its joints let it, of the longest limb's length [-]."""
FOLDING: Final = 2000
"""Postures that are tried for that."""
PARTS: Final = (0.05, 0.1, 0.2, 0.4, 0.6, 0.8)
"""Of the way there, at which it is looked at [-]."""
LEAST_SPEED: Final = 0.1
"""Of a joint's largest speed that it may always have, however near its limit it ends [-]."""
LOW: Final = 0.8
"""Share of a swing's path after which a tip may touch [-]."""
LEANED: Final = 0.7
"""Lean of an end effector that finds nothing, of the tilt up to which it takes a hold: leans all around leave no gap [-]."""
AROUND: Final = math.radians(137.5)
"""From one of them to the next, about the normal: the golden angle, which leaves no side out [rad]."""


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


def changing(body: LimbedBody, loads: Floats, posture: Floats) -> Handle:
    """How a robot's loads and posture become others, for kernels."""
    return Handle(body.loads.copy(), loads, body.law.aims.posture.copy(), posture)


def share_loads(body: LimbedBody, loads: Floats, limb: int | None, *, fading: bool = False) -> None:
    """Let the contacts' loads become others; a limb that is `fading` bears less and less, another one ever more, if any."""
    aims = body.law.aims
    aims.velocity[:] = aims.acceleration[:] = 0.0
    most = float(np.abs(body.loads if fading else loads).max()) + body.pace.weight
    to_share = ready(change_aims, body.handle, changing(body, loads, aims.posture.copy()), 0.0)
    count, k = max(1, round(body.pace.shift / body.plant.period)), 0
    body.fading = limb if limb is not None and fading else -1
    try:
        while k < count:
            # what has left its ground again is loaded once it is back
            k += fading or limb is None or not body.seeks(limb)
            share = quintic(k / count)[0]
            to_share(share)
            if limb is not None:
                aims.cap[limb] = max(1.0 - share if fading else share, 1e-3) * most
            body.tick()
    except LostHoldError:
        fading = False  # where another came off, this one holds on, and is to bear what it can
        raise
    finally:
        body.fading = -1
        if limb is not None and not fading:
            aims.cap[limb] = math.inf


def folded(body: LimbedBody, limb: int, normal: Floats) -> tuple[Floats, float]:
    """A posture in which a limb is off what it stood on, by those of its joints that are not locked: that with the least way there.

    Args:
        body: The robot.
        limb: Which; it begins as it is believed to be.
        normal: Out of the surface, shape (3,).

    Returns:
        Of all joints, shape (n,), and how far up the tip comes [m]; on its straight way there it comes no lower than it is.
    """
    law, mine = body.law, slice(*body.joints_of(limb))
    at, work = State.of(law.tree), Dynamics.of(law.tree)
    at.rotation[:], at.position[:] = law.state.rotation, law.state.position
    here = law.state.joints.copy()

    def height(joints: Floats) -> float:
        at.joints[:] = joints
        place_bodies(law.tree, at, work)
        tip_motion(law.tree, at, work)
        return float(work.tip[limb] @ normal)

    moves = np.array([joint for joint in range(mine.start, mine.stop) if joint not in body.locked], np.intp)
    lower, upper = law.limits.lower[moves], law.limits.upper[moves]
    low, best = height(here), (0.0, 0.0, here)
    for share in np.random.default_rng(0).random((FOLDING, len(moves))):
        there = here.copy()
        there[moves] = lower + share * (upper - lower)
        up = min(height(there) - low, FOLDED * body.pace.size)
        way = float(np.abs(there - here).max())
        if (up, -way) > best[:2] and min(height(here + part * (there - here)) for part in PARTS) >= low:
            best = up, -way, there
    posture = law.aims.posture.copy()
    posture[mine] = best[2][mine]
    return posture, best[0]


def fold(body: LimbedBody, limb: int, posture: Floats) -> None:
    """A limb in the air goes to where it stays for the rest of the run."""
    aims, mine = body.law.aims, slice(*body.joints_of(limb))
    aims.velocity[:] = aims.acceleration[:] = 0.0
    aims.posture[mine] = body.law.state.joints[mine]
    quick = float(np.max(np.abs(posture - aims.posture) / body.law.limits.speed))
    seconds = max(seconds_for(FOLDED * body.pace.size, body.pace.swing), PEAK_SPEED * quick / SPEED)
    count = math.ceil(seconds / body.plant.period)
    change = ready(change_aims, body.handle, changing(body, body.loads.copy(), posture), 0.0)
    for k in range(1, count + 1):
        change(quintic(k / count)[0])
        body.tick()


def move_body(body: LimbedBody, motion: BodyMotion) -> None:
    """The body to where it is to be over its holds, as it stands on them, loads passing to those of the motion's last stance."""
    end, aims, pace = motion.way[-1], body.law.aims, body.pace
    place = body.over_holds(end)
    way = float(np.linalg.norm(place - aims.position))
    turned = float(np.linalg.norm(rotation_vector(end.pose.rotation @ aims.rotation.T)))
    seconds = seconds_for(max(way, turned * pace.size), pace.body)
    quick = float(np.max(np.abs(end.joints - aims.posture) / body.law.limits.speed, initial=0.0))
    seconds = max(seconds, PEAK_SPEED * quick / SPEED, 4.0 * body.plant.period)
    path = BodyPath.between(aims.position, aims.rotation, place, end.pose.rotation, seconds)
    aim = ready(aim_body, body.handle, path.handle, changing(body, end.loads, end.joints), 0.0)
    for k in range(1, math.ceil(seconds / body.plant.period) + 1):
        aim(k * body.plant.period)
        body.tick()
    rest(body, SETTLING)


def regrab(body: LimbedBody, motion: Regrab) -> Landing:
    """A limb lets go of its hold, if it has one, swings, and takes another."""
    limb = motion.limb
    if body.holds[limb] == motion.hold:  # it took it just as another limb came off
        share_loads(body, motion.after.loads, None)
        return Landing(True, float(np.linalg.norm(body.tips[limb] - body.belief.places[motion.hold])))
    if body.holds[limb] >= 0:
        share_loads(body, motion.loads, limb, fading=True)
        body.plant.grip(limb, False)
        body.let_go(limb)
    normals = body.world.normals[[int(motion.before.holds[limb]), motion.hold]]
    return take(body, limb, motion.hold, normals, motion.after.loads, motion.after.joints)


def retake(body: LimbedBody, lost: LostHoldError, loads: Floats) -> Landing:
    """A limb that has come off takes its hold again, while the body stays where it is.

    Args:
        body: The robot.
        lost: What has come off.
        loads: Of the contacts once it holds on again, world frame, shape (limbs, 6).
    """
    body.stop()
    body.plant.grip(lost.limb, False)
    normals = body.world.normals[[lost.hold, lost.hold]]
    return take(body, lost.limb, lost.hold, normals, loads, body.law.aims.posture.copy())


def take(body: LimbedBody, limb: int, hold: int, normals: Floats, loads: Floats, posture: Floats) -> Landing:
    """A limb in the air takes a hold.

    Args:
        body: The robot.
        limb: Which.
        hold: Index of the hold.
        normals: Of the surface that its tip is at, and of the hold, shape (2, 3).
        loads: Of the contacts once it holds on, world frame, shape (limbs, 6).
        posture: That the joints lean to then, shape (n,).
    """
    place, pace = body.belief.places[hold].copy(), body.pace
    reason = f"nothing to hold on to within {1e3 * pace.depth:.0f} mm"
    normal = normals[1]
    ways, deeper, tries = list(_beside(body, limb, normal)), list[tuple[float, int]](), 0
    while tries < len(ways):
        end, leant = place + ways[tries][0], ways[tries][1]
        tries += 1
        try:
            landed = _land(body, limb, end, np.stack((normals[0], leant)), posture)
        except LostHoldError:
            if body.sensed.closed[limb] or body.sensed.shutting[limb]:  # its jaws are about it, or will be
                body.hold_on(limb, hold)
            raise
        deep = float((end - body.tips[limb]) @ normal)
        if landed and deep > pace.deep and not body.attaches(limb) and tries <= pace.tries:  # beside the hold, it seems
            deeper.append((deep, tries - 1))
        elif landed:
            body.hold_on(limb, hold)
            off = float(np.linalg.norm(body.tips[limb] - place))
            try:
                share_loads(body, loads, limb)
                return Landing(True, off, tries)
            except LostHoldError as lost:
                if lost.limb != limb:
                    raise
                reason = "it came off when it was loaded"
        body.plant.grip(limb, False)
        body.let_go(limb)
        normals = np.stack((leant, normal))
        if tries == pace.tries and deeper:  # all of it is deeper than believed: where it is least so
            ways.append(ways[min(deeper)[1]])
    return Landing(False, float(np.linalg.norm(body.tips[limb] - place)), tries, reason)


def _land(body: LimbedBody, limb: int, end: Floats, normals: Floats, posture: Floats) -> bool:
    """A limb swings to a place [m] and feels for a hold there; whether it has found one."""
    start = body.tips[limb].copy()
    up = lift_between(np.stack((start, end)), normals, body.lift)
    seconds = swing_seconds(float(np.linalg.norm(end - start)), float(np.linalg.norm(up)), body.pace.swing)
    path = TipPath(start, end, normals, up)
    _swing(body, limb, path, scaled(body, limb, path, posture, seconds), posture)
    return _approach(body, limb, path)


def scaled(body: LimbedBody, limb: int, path: TipPath, posture: Floats, seconds: float) -> TimeScaling:
    """Time along a swing in which its joints keep to their speeds, less near their limits; it takes so many seconds at least."""
    limits, mine = body.law.limits, slice(*body.joints_of(limb))
    joints = joints_along(body, limb, path, np.linspace(0.0, 1.0, SAMPLES), posture)
    moved = np.diff(joints, axis=0)
    ahead = np.where(moved > 0.0, limits.upper[mine] - joints[1:], joints[1:] - limits.lower[mine])
    most = np.clip(body.law.gains.limit_rate * ahead, LEAST_SPEED * limits.speed[mine], limits.speed[mine])
    return TimeScaling.within(seconds, (np.abs(moved) / most).max(axis=1) * (SAMPLES - 1) / SPEED)


def joints_along(body: LimbedBody, limb: int, path: TipPath, shares: Floats, posture: Floats) -> Floats:
    """Joints of a limb whose tip follows a path while the base stays where it is to be.

    An end effector that has to be aligned turns from the path's one inward normal to the other, as `_swing` has it. Where joints are left
    free, they go to a posture; what is out of reach is come near to.

    Args:
        body: The robot.
        limb: Which; it begins as it is believed to be.
        path: Of its tip.
        shares: Of the path, at which they are wanted, near each other, shape (points,).
        posture: Of all joints at the end, shape (n,).

    Returns:
        [rad] or [m], shape (points, joints of the limb).
    """
    law, size, mine = body.law, body.pace.size, slice(*body.joints_of(limb))
    at, work = State.of(law.tree), Dynamics.of(law.tree)
    at.rotation[:], at.position[:], at.joints[:] = law.aims.rotation, law.aims.position, law.state.joints
    joints, columns = at.joints[mine], slice(FREE + mine.start, FREE + mine.stop)
    started, wanted = joints.copy(), posture[mine]
    aligned, direction = body.robot.contacts[limb].aligned, np.empty(3)
    found = np.empty((len(shares), len(joints)))
    for k, share in enumerate(shares):
        place_bodies(law.tree, at, work)
        tip_motion(law.tree, at, work)
        rows, missed = work.jacobian[limb, :3, columns], path.at(share)[0] - work.tip[limb]
        if aligned:  # a turn about its z is free
            direction_at(path.handle, share, direction)
            across = size * work.tip_turn[limb, :, :2].T
            rows = np.vstack((rows, across @ work.jacobian[limb, 3:, columns]))
            missed = np.append(missed, across @ np.cross(work.tip_turn[limb, :, 2], direction))
        lean = started + (k + 1) / len(shares) * (wanted - started) - joints
        square = rows @ rows.T + (SINGULAR * size) ** 2 * np.eye(len(rows))
        step = lean + rows.T @ np.linalg.solve(square, missed - rows @ lean)
        if aligned:
            step *= LARGEST_STEP / max(float(np.abs(step).max()), LARGEST_STEP)
        joints += step
        found[k] = joints
    return found


def _beside(body: LimbedBody, limb: int, normal: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Ways from a hold to where it is felt for, on a spiral across the normal [m], and normals that it is felt for along, shapes (3,).

    An end effector that has to be aligned is leant besides, and moved by no more than half of what it takes holds from.
    """
    across, contact = np.linalg.svd(normal[None])[2][1:], body.robot.contacts[limb]
    aligned = body.attaches(limb) and contact.aligned and math.isfinite(contact.tilt)
    most = 0.5 * body.robot.ends[limb].bears().capture if aligned else math.inf
    lean = math.tan(LEANED * contact.tilt) if aligned else 0.0
    for k in range(body.pace.tries):
        way = math.cos(k * AROUND) * across[0] + math.sin(k * AROUND) * across[1]
        out = min(most, body.pace.beside * math.sqrt(max(0, k - 1)))  # the second try is where the first was
        leant = normal + lean * way if k > 1 else normal
        yield out * way, leant / np.linalg.norm(leant)


def _swing(body: LimbedBody, limb: int, path: TipPath, scaling: TimeScaling, posture: Floats) -> None:
    """Along the path, to its end or to where what comes down touches."""
    aims, period = body.law.aims, body.plant.period
    pointed = bool(body.robot.contacts[limb].aligned)
    aims.points[limb] = 0.0
    change = changing(body, body.loads.copy(), posture)
    point = ready(direction_at, path.handle, 0.0, aims.points[limb])
    aim = ready(aim_swing, body.handle, path.handle, scaling.handle, change, limb, 0.0)
    for k in range(1, math.ceil(float(scaling.times[-1]) / period) + 1):
        share = aim(limb, k * period)
        if pointed:
            point(share, aims.points[limb])
        body.tick()
        if share > LOW and presses(body, limb):
            return


def _approach(body: LimbedBody, limb: int, path: TipPath) -> bool:
    """Feel on along the inward normal until the limb has its hold; whether it has, before it only presses on something."""
    pace, inward = body.pace, -path.normals[1]
    speed = pace.approach * inward
    pointed = inward if body.robot.contacts[limb].aligned else None
    if body.attaches(limb):
        body.plant.grip(limb, True)
    body.press(limb, path.normals[1])
    deep, closing, met = 0.0, round(pace.shift / body.plant.period), False
    eager = 0.0
    while deep < pace.depth and closing > 0:
        if touches(body, limb):
            return True
        if body.sensed.shutting[limb]:  # jaws that draw the tip to its hold have their way
            body.relax(limb)
            law = body.law
            drawn = law.dynamics.jacobian[limb, :3] @ law.state.speed
            body.swing(limb, (body.tips[limb].copy(), drawn, np.zeros(3)), pointed)
            body.tick()
            continue
        met = met or presses(body, limb)
        if met:  # on something: pressed on by a force alone, it has a while to close about it
            closing -= 1
            body.press(limb, path.normals[1], PRESSED * pace.firm)
            body.swing(limb, (body.tips[limb].copy(), np.zeros(3), np.zeros(3)), pointed)
        else:
            eager = min(1.0, eager + body.plant.period / pace.shift)  # at once would be a knock
            deep += eager * body.plant.period * pace.approach
            body.swing(limb, (path.end + deep * inward, eager * speed, np.zeros(3)), pointed)
        body.tick()
    body.relax(limb)
    return False


def touches(body: LimbedBody, limb: int) -> bool:
    """Whether a limb's end effector is attached, or what only pushes is pushed against."""
    return bool(body.sensed.closed[limb]) if body.attaches(limb) else presses(body, limb)


def presses(body: LimbedBody, limb: int) -> bool:
    """Whether a limb's tip is on something: a foot at once, another end effector when it is pressed on."""
    if not body.attaches(limb):
        return body.feels(limb)
    return float(np.linalg.norm(body.sensed.wrenches[limb, :3])) > body.pace.firm
