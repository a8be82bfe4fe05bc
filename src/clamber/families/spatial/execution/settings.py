"""How a robot in space is moved: every number by the robot's own weight, size and strength."""

import math
from dataclasses import dataclass, replace
from typing import Final, Self

import numpy as np

from ....control.whole_body.programme import Gains
from ....control.whole_body.tree import Tree
from ....units import GRAVITY
from ..control.believed_tree import flat, joint_inertias
from ..robot.robot import SpatialRobot
from ..statics.records import stretched

REACTION: Final = 0.0075
"""From a reading to the torque that answers it [s]: 5 ms of delay, as motors on a bus have, and a control period."""
LEAST_RATE: Final = 10.0
"""At which errors of a swinging tip die away whatever its gears [1/s]: more slowly, their friction and not the law would move it."""


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
        weight, how = mass * GRAVITY, robot.spec.handling
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


def usual_gains(robot: SpatialRobot, tree: Tree) -> Gains:
    """Of the law of a robot's whole body, for its size and its gears.

    In the play of its gear a motor turns its rotor alone, with torques that are meant for all that its joint moves. Damping d [1/s] of a
    joint then acts on a mass that is r times as light: the rotor's speed follows v' = -r d v(t - T), T late, which is steady up to
    r d T = pi / 2. Beyond, gears rattle from tooth to tooth, as simulated ones did from 1.3 on and did not at 1.1; a swing keeps to 1.

    Args:
        robot: The robot.
        tree: As the law believes it to be.
    """
    pace, moved = Pace.of(robot), joint_inertias(tree, flat(robot, robot.chains.nominal))
    heavier = float(np.max(np.divide(moved, tree.rotor, out=np.ones_like(moved), where=tree.rotor > 0.0)))
    usual = Gains(arm=pace.size, moving=pace.approach / pace.size)
    steady = 0.5 / (heavier * REACTION)
    return replace(usual, swing_rate=min(usual.swing_rate, max(LEAST_RATE, steady)))
