"""How a robot in space is moved: every number by the robot's own weight, size and strength."""

import math
from dataclasses import dataclass
from typing import Self

from ....control.whole_body.programme import Gains
from ....units import GRAVITY
from ..robot.robot import SpatialRobot
from ..statics.stretch import stretched


@dataclass(frozen=True, slots=True, kw_only=True)
class Pace:
    """How quickly a robot moves, and by what it feels contacts, SI."""

    size: float
    """Length of its longest limb when stretched [m]."""
    weight: float
    """On Earth [N]."""
    body: float
    """Largest acceleration of the body on its way [m/s^2]."""
    swing: float
    """The same of a tip that swings [m/s^2]."""
    shift: float
    """In which load passes from one set of limbs to another [s]."""
    touch: float
    """A foot that feels such a force stands [N]."""
    stand: float
    """A foot that stands is asked to press with so much at least [N]."""
    firm: float
    """An end effector that presses so hard and does not attach has no hold there [N]."""
    beside: float
    """From a hold to the next place where it is felt for [m]."""
    tries: int
    """Places that are felt for a hold."""
    pressing: float
    """Force of a tip that feels for its hold per way that it misses [N/m]."""
    approach: float
    """Speed of a tip that feels for its hold [m/s]."""
    depth: float
    """How far beyond its hold it feels [m]."""
    deep: float
    """A foot that finds its ground so much deeper than its hold looks for it beside first [m]."""
    lost: float
    """A body that is so far from where it is to be has fallen [m]."""

    @classmethod
    def of(cls, robot: SpatialRobot) -> Self:
        """Of a robot, as its file has it (`robot.handling`)."""
        chains = robot.chains
        limbs = len(chains.limb_names)
        size = max(stretched(chains, limb) for limb in range(limbs))
        mass = chains.total_mass
        strong = sum(float(chains.torque[limb, : chains.n_joints[limb]].max()) for limb in range(limbs))
        agile = min(GRAVITY, strong / (mass * size))
        weight = mass * GRAVITY
        how = robot.spec.handling
        return cls(
            size=size,
            weight=weight,
            body=how.body * agile,
            swing=how.swing * agile,
            shift=how.shift * math.sqrt(size / agile),
            touch=how.touch * weight,
            stand=how.stand * weight,
            firm=how.firm * weight,
            beside=how.beside * size,
            tries=how.tries,
            pressing=how.press * weight / (how.depth * size),
            approach=how.approach * math.sqrt(size * agile),
            depth=how.depth * size,
            deep=how.deep * size,
            lost=how.lost * size,
        )


def usual_gains(robot: SpatialRobot) -> Gains:
    """Of the law of a robot's whole body."""
    pace = Pace.of(robot)
    return Gains(arm=pace.size, moving=pace.approach / pace.size)
