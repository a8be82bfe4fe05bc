"""Ways to control the body, by text such as "scct", "leg-by-leg:joint-pd" or "coordinated", with gains matched to a reference.

Gains are matched by how stiffly the body is held, measured from the controller itself: the body is moved by a little from its aim, the
holding limbs along, and the torques are turned into forces of the tips and these into the wrench on the body; K = - d W / d X by central
differences, without the weight fed.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, Literal, TypeAlias

import numpy as np

from ....control.law_settings import FEELING, LAWS
from ....errors import UnknownNameError
from ....sim.plant_rules import PlantError
from ....types import Floats
from ..control.backlash import weight_loads
from ..execution.body_gains import BodyGains
from ..execution.limb_task import LimbTask
from ..execution.whole_body import WholeBody
from .body_bench import BodyEntry
from .body_stand import BodyStand

BodyMatch: TypeAlias = Literal["yy", "mean", "diagonal", "none"]
NUDGE: Final = 1e-5
"""Of the body [m], [rad]."""
PERIOD: Final = 0.005
LEAST_PART: Final = 1e-6
"""A stiffness smaller than this part of the largest is none."""


def body_stiffness(stand: BodyStand, gains: BodyGains, pose: Floats | None = None) -> Floats:
    """Stiffness of the body at rest on its aim, shape (3, 3): wrench [N], [N m] against pose [m], [rad].

    Args:
        stand: Which limbs hold what.
        gains: Of the body; neither limit nor weight counts.
        pose: Where; None: at the stand's start.
    """
    at = stand.pose if pose is None else pose
    bare = replace(gains, weight_fed=0.0, limit="none", inside=0.0)
    out = np.empty((3, 3))
    for k, nudge in enumerate(NUDGE * np.eye(3)):
        out[:, k] = -(_wrench(stand, bare, at, at + nudge) - _wrench(stand, bare, at, at - nudge)) / (2 * NUDGE)
    return out


def _wrench(stand: BodyStand, gains: BodyGains, aim: Floats, pose: Floats) -> Floats:
    """What the limbs' torques bring to the body about its origin, world frame, shape (3,)."""
    body = WholeBody(stand.robot, period=PERIOD, gains=gains, backlash=0.0)
    places = stand.board.places()
    for i, limb in enumerate(stand.robot.limbs):
        number = stand.holds.get(limb.name, 0)
        body.assign(i, LimbTask("stance", number, places[number].copy()) if number else LimbTask("swing_joint"))
    still = np.zeros((body.n, 2))
    body.aim[:] = aim
    # laws that remember joint angles begin at the aim
    for seen in (aim, pose):
        body.pose[:] = seen
        body.see(stand.angles(seen), still, float(seen[2]), 0.0)
        torques = body.command()
    total, own = np.zeros(3), np.zeros(2)
    for i, task in enumerate(body.tasks):
        if task.mode == "stance":
            if gains.scheme == "body":  # which feeds each limb's own weight, too
                own = np.array(weight_loads(body.legs[i], body.q[i], body.pose[2]))
            total += tip_wrench(body, i, torques[i] - own)
    return total


def tip_wrench(body: WholeBody, i: int, torques: Floats) -> Floats:
    """Wrench that a hold brings to the body through a limb with these torques at rest, shape (3,)."""
    chain, turn = body.chains[i], float(body.pose[2]) + body.robot.limbs[i].port_angle
    force = np.linalg.solve(chain.jacobian(body.q[i])[:2].T, torques)
    c, s = np.cos(turn), np.sin(turn)
    fx, fy = -(c * force[0] - s * force[1]), -(s * force[0] + c * force[1])
    arm = body.tasks[i].place - body.pose[:2]
    return np.array((fx, fy, arm[0] * fy - arm[1] * fx))


def match_body(stand: BodyStand, gains: BodyGains, reference: BodyGains, how: BodyMatch) -> BodyGains:
    """`gains` with kp and kd of the body scaled until it is held as stiffly as by `reference`; kd is scaled as kp is.

    "yy": x and y by one factor that matches along y; "mean": by one that matches the mean of both; "diagonal": each by its own. The angle
    is always matched by itself. "none": the same numbers.
    """
    if how == "none":
        return replace(gains, kp=reference.kp, kd=reference.kd)
    start = replace(gains, kp=reference.kp, kd=reference.kd)
    ours, theirs = (np.diag(body_stiffness(stand, each)) for each in (start, reference))
    # what one limb alone cannot hold, such as the angle, is nobody's stiffness
    factors = np.divide(theirs, ours, out=np.ones(3), where=np.abs(ours) > LEAST_PART * np.abs(theirs).max())
    if how == "yy":
        factors[:2] = factors[1]
    elif how == "mean":
        factors[:2] = theirs[:2].sum() / ours[:2].sum()
    x, y, angle = (float(factor) for factor in factors)
    kp, kd = reference.kp, reference.kd
    return replace(start, kp=(x * kp[0], y * kp[1], angle * kp[2]), kd=(x * kd[0], y * kd[1], angle * kd[2]))


USUAL: Final = ("scct", "jacobian-transpose")
"""What is compared unless said otherwise."""
AIM_BOUND: Final = frozenset({"joint-pd"})
"""Laws that remember where their aim was: a pull of the body is no aim that stays, so they carry it leg by leg."""
LEG_BY_LEG: Final = "leg-by-leg"
COORDINATED: Final = "coordinated"
CLIMBER: Final = "climber"
"""The robot's own control as it climbs, with its own gains."""
CONTROLS: Final = (
    *(law for law in LAWS if law not in AIM_BOUND | FEELING),
    *(f"{LEG_BY_LEG}:{law}" for law in LAWS if law not in FEELING),
    COORDINATED,
    CLIMBER,
)
"""All ways; none with a law that must feel forces: without a sensor at its tips the robot gives way to the weight that is fed forward."""


def make_entries(
    texts: Sequence[str],
    reference: BodyGains,
    stand: BodyStand,
    match: BodyMatch,
    *,
    angle: str = "encoder",
    pose: Floats | None = None,
) -> list[BodyEntry]:
    """An entry for each text; SCCT has the reference's gains, all others gains that hold the body as stiffly in the sense of `match`.

    Args:
        texts: A law, "leg-by-leg:LAW" or "coordinated".
        reference: Gains of the reference, whose law is SCCT.
        stand: Where gains are matched.
        match: What "as stiffly" means; "none": the same numbers.
        angle: Source of the body's angle, a name of `ANGLES`.
        pose: Where gains are matched; None: at the stand's start.

    Raises:
        UnknownNameError: If there is no such law.
    """
    there = stand if pose is None else replace(stand, pose=pose)
    return [BodyEntry(text, read_gains(text, reference, there, match), angle) for text in texts or USUAL]


def read_gains(text: str, reference: BodyGains, stand: BodyStand, match: BodyMatch) -> BodyGains:
    """The gains of one way to control the body, matched.

    Raises:
        UnknownNameError: If there is no such law.
    """
    if text == CLIMBER:
        return BodyGains()
    if text == COORDINATED:
        gains = replace(reference, scheme=COORDINATED, weight_fed=0.0)
        matched = match_body(stand, gains, reference, match)
        tip = (matched.kp[0] + matched.kp[1]) / 2
        return replace(matched, leg_kp=tip, leg_kd=tip * reference.kd[0] / reference.kp[0])
    scheme, _, named = text.rpartition(":")
    if text not in (*CONTROLS, *AIM_BOUND):
        raise UnknownNameError("control of the body", text, CONTROLS)
    if scheme or named in AIM_BOUND:
        return match_legs(stand, replace(reference, law=named, scheme=LEG_BY_LEG), reference, match)
    gains = replace(reference, law=named)
    return gains if named == "scct" else match_body(stand, gains, reference, match)


def read_triple(key: str, text: str) -> tuple[float, float, float]:
    """Three gains from a text such as "100,50,10": of x, y and the angle.

    Raises:
        PlantError: If it is none.
    """
    try:
        x, y, angle = (float(part) for part in text.split(","))
    except ValueError:
        raise PlantError(key, text, "must be three numbers: x,y,theta") from None
    if not all(0.0 <= value < math.inf for value in (x, y, angle)):
        raise PlantError(key, text, "must be three numbers of 0 or more")
    return x, y, angle


def match_legs(stand: BodyStand, gains: BodyGains, reference: BodyGains, match: BodyMatch) -> BodyGains:
    """As `match_body`, for limbs with one gain in all directions: "diagonal" cannot hold and takes the mean."""
    if match == "none":
        return replace(gains, leg_kp=reference.kp[0], leg_kd=reference.kd[0])
    start = replace(gains, leg_kp=1.0, leg_kd=reference.kd[0] / reference.kp[0])
    ours, theirs = body_stiffness(stand, start), body_stiffness(stand, reference)
    part = theirs[1, 1] / ours[1, 1] if match == "yy" else (theirs[0, 0] + theirs[1, 1]) / (ours[0, 0] + ours[1, 1])
    return replace(start, leg_kp=float(part), leg_kd=float(part) * start.leg_kd)
