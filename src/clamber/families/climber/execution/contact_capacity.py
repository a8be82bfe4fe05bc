"""How well two limbs bear the body in a stance of a plan with their elbows on given sides."""

import math

import numpy as np

from ....types import Floats, Ints, Records
from ..control.backlash import weight_moment
from ..control.hook_forces import MOST_CUTS, NOTHING, pair_forces
from ..robot.robot import LimbedRobot
from .postures import postures


def load_capacity(robot: LimbedRobot, legs: Records, places: Floats, stance: Records, sides: Ints) -> float:
    """How well the worst hook or motor of two carrying limbs is off under the weight [N]: negative if none of the splits meets all wishes.

    Args:
        robot: The climber at `USUAL_WEIGHT`.
        legs: Its `legs_of`.
        places: Of the board's holds, world frame, shape (n_holds, 2) [m].
        stance: One of a plan.
        sides: Of the elbows, +1 or -1, shape (limbs,); those of other limbs don't count.

    Returns:
        -inf where a limb has no such posture; 0 where not two limbs carry.
    """
    carriers = [i for i in range(len(robot.limbs)) if int(stance["carriers"]) >> i & 1]
    if len(carriers) != 2:
        return 0.0
    pose = np.array((stance["x"], stance["y"], stance["angle"]))
    q, arms = np.zeros((len(robot.limbs), 2)), np.zeros((len(robot.limbs), 2))
    for i in carriers:
        place = places[stance["hold"][i]]
        found = [one for one in postures(robot.limbs[i], pose, place) if one.inside and one.angles[1] * sides[i] > 0.0]
        if not found:
            return -math.inf
        q[i], arms[i] = found[0].angles, place - pose[:2]
    wrenches = (0.0, robot.weight, weight_moment(legs, q, pose[2])), NOTHING
    cuts, forces = np.zeros((MOST_CUTS, 2)), np.zeros_like(arms)
    margin, _ = pair_forces((legs, q, pose, arms), (carriers[0], carriers[1]), wrenches, cuts, forces)
    return float(margin)
