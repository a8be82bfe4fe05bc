"""Ways to control the body, by text such as "scct", "leg-by-leg:joint-pd" or "coordinated", with gains matched to a reference."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from ....control.law_settings import FEELING, LAWS
from ....errors import UnknownNameError
from ....sim.plant_rules import PlantError
from ....types import Floats
from ..execution.body_gains import BodyGains
from .body_bench import BodyEntry
from .body_stand import BodyStand
from .body_stiffness import BodyMatch, body_stiffness, match_body

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
