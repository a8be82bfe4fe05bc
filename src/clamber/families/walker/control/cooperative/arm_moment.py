"""The arm's first moment of mass, payload included: it has the form of the vector to the tool, with other lengths."""

from dataclasses import dataclass

import numpy as np

from .....types import Floats
from ...robot import WalkerRobot


@dataclass(frozen=True, slots=True, eq=False)
class ArmMoment:
    """Sum of m_j a_j over the links and the payload, written as `arm_vector` writes a vector to a tool."""

    links: Floats
    """What turns with each pitching joint: its link's own half and all beyond it [kg m], shape (n,)."""
    out: float
    """[kg m]."""
    up: float
    """[kg m]."""
    mass: float
    """Of arm and payload [kg]."""


def arm_moment(robot: WalkerRobot, payload: float = 0.0) -> ArmMoment:
    """The first moment of a robot's arm; the payload is carried at the tool [kg]."""
    arm = robot.own_arm
    masses = np.array([*arm.masses, payload])
    beyond = masses[::-1].cumsum()[::-1]  # of link i and all after it
    lengths = np.array(arm.links)
    links = lengths * (0.5 * masses[:-1] + beyond[1:])
    return ArmMoment(links, float(beyond[0]) * arm.out, float(beyond[0]) * arm.up, float(beyond[0]))
