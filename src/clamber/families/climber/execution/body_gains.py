"""How stiffly a climber holds its body and moves its limbs, and by which map and hook limit."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Records
from ....units import OUNCE_FORCE, OZ_IN
from ..control.body import (
    KINEMATIC,
    LIMIT_COUNTED,
    LIMIT_FEASIBLE,
    LIMIT_NONE,
    LIMIT_SHARED,
    LIMIT_THESIS,
    THESIS,
    WRENCH,
)
from ..control.body_tick import BODY
from ..robot.robot import LimbedRobot

USUAL_WEIGHT: Final = 144 * OUNCE_FORCE
"""Of the robot on which the forces and torques of climbers' control were chosen [N]. Control takes every robot for one of this weight that
moves the same (`LimbedRobot.at_weight`), and its motors are driven as many times harder as it is heavier."""
USUAL_SPEED: Final = 3.0
"""Of its joints without load [rad/s]; those of free limbs go faster or slower as the slowest motor does."""
USUAL_INERTIA: Final = 0.7652
"""Of its heaviest rotor and gear, reflected: laws count accelerations in units of that [kg m^2]."""
USUAL_AGILITY: Final = 3000 * OZ_IN / USUAL_INERTIA
"""With which its weakest joint speeds up its rotor [rad/s^2]; those of free limbs speed up as the weakest does."""
MAPPINGS: Final = {"thesis": THESIS, "kinematic": KINEMATIC, "wrench": WRENCH}
LIMITS: Final = {
    "none": LIMIT_NONE,
    "thesis": LIMIT_THESIS,
    "counted": LIMIT_COUNTED,
    "shared": LIMIT_SHARED,
    "feasible": LIMIT_FEASIBLE,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyGains:
    """Gains of body and limbs; their forces and torques are those of a robot of `USUAL_WEIGHT`, and go with the weight."""

    kp: tuple[float, float, float] = (100.0, 50.0, 10.0)
    """Of the maps "thesis" and "kinematic"; those of the thesis's Table 4.1."""
    kd: tuple[float, float, float] = (10.0, 5.0, 1.0)
    """Twice the table's: with delay and backlash its own let the body swing (ours)."""
    stiffness: tuple[float, float, float] = (3000.0, 3000.0, 200.0)
    """Of the map "wrench" [N/m], [N m/rad]; ours."""
    damping: float = 20.0
    """Of the map "wrench": each tip's acceleration for its speed [1/s]; at half of it a body on grippers cycles through its play."""
    limb_kp: float = 500.0
    limb_kd: float = 25.0
    joint_kp: float = 400.0
    joint_kd: float = 20.0
    cling: float = 3.0
    """Pull with which a limb that carries nothing keeps to its hold [N]."""
    gentle: float = 3.0
    """Most torque of a limb near a hold, so that what it meets is not thrown off; a tip on its way gets its weight besides [N m]."""
    firm: float = 8.0
    """Likewise of a limb that tugs at its hold: enough to carry half the weight at arm's length [N m]."""
    alpha: float = 0.3
    """Least acceleration of a hook along its grab direction, 4.4.2 of the thesis, for the limits "thesis", "counted" and "shared"
    [m/s^2]. The thesis takes 0 or more. 0.3 is ours, for the limits that count the weight; with "thesis", which does not, it sets soft
    bodies swaying (`usual_alpha`).
    """
    weight_fed: float = 0.95
    """Part of the weight that is fed forward."""
    mapping: str = "wrench"
    limit: str = "feasible"
    law: str = "scct"
    scheme: str = "body"
    """How the holding limbs carry the body: "body" as in the thesis's 4.4, or one of `SCHEMES`."""
    leg_kp: float = 200.0
    """Of a holding limb in those schemes, in the units of its law; "coordinated": of the pressing tip [N/m]."""
    leg_kd: float = 10.0
    inside: float = 8.0
    """"coordinated": with how much the pressing tip is to pull at its hold [N]."""
    hold_stiffness: float = 20_000.0
    """"coordinated": that the holds are believed to have [N/m]."""
    potential: float = 0.0
    """Strength of the virtual potential about the body that repels free limbs (Bevly 1997, 4.4.6): F_0 of
    `control.virtual_potential` over the robot's weight [-]; 0: none."""
    potential_range: float = 0.2
    """Gap from which on it repels, rho_0 over the length of the longest limb [-]."""


USUAL: Final = BodyGains()
"""Those of a climb."""


MOST_LIMBS: Final = 3
"""With more limbs that grip, nothing has climbed by this control."""


def unfit(robot: LimbedRobot) -> str | None:
    """Why a robot cannot do what control asks of it; None where nothing is known against it.

    Control has a limb tug at its hold by up to `firm`, in proportion to the robot's weight: motors that give less stand under full torque
    there, which is taken for a fault.
    """
    weakest = min(robot.joints, key=robot.torque_limit_of)
    least, asked = robot.torque_limit_of(weakest), USUAL.firm * robot.weight / USUAL_WEIGHT
    if least < asked:
        return (
            f"today's control of climbers asks up to {asked:.3g} N m of every joint, and joint {weakest.number} of "
            f"'{robot.name}' gives {least:.3g} N m (motor.torque_limit); docs/own-robot.md says which robots climb"
        )
    n = len(robot.limbs)
    if n > MOST_LIMBS and robot.grips:
        return f"today's control of climbers is for {MOST_LIMBS} limbs, and '{robot.name}' has {n} that grip"
    return None


def usual_alpha(limit: str) -> float:
    """Least acceleration of a hook where nothing is said [m/s^2]: 0 for the printed limit, which does not count the weight; else ours."""
    return 0.0 if limit == "thesis" else USUAL.alpha


def inertia_over_usual(robot: LimbedRobot) -> float:
    """Of the heaviest rotor [-]: what gains that make joints' accelerations of errors are multiplied by."""
    return float(robot.inertias.max()) / USUAL_INERTIA


def records_of(gains: BodyGains, robot: LimbedRobot) -> Records:
    """The gains as the kernels read them, records of `BODY`, shape (1,)."""
    out = np.zeros(1, BODY)
    out["mapping"], out["limit"] = MAPPINGS[gains.mapping], LIMITS[gains.limit]
    for name in ("stiffness", "cling", "gentle", "firm", "weight_fed"):
        out[name] = getattr(gains, name)
    for name in ("kp", "kd", "damping", "joint_kp", "joint_kd"):
        out[name] = inertia_over_usual(robot) * np.array(getattr(gains, name))
    out["weight"] = robot.weight
    return out
