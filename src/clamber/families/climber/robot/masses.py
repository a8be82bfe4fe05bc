"""The body of a climber as a mass: what the limbs' links leave of the weight, spread evenly over the polygon of their ports."""

import math

from ....units import GRAVITY
from .robot import LimbedRobot


def body_mass(robot: LimbedRobot) -> float:
    """Mass of the body without its limbs [kg]."""
    return robot.weight / GRAVITY - sum(sum(limb.link_masses) for limb in robot.limbs)


def body_inertia(robot: LimbedRobot) -> float:
    """Inertia of the body without its limbs about its origin [kg m^2]: an even plate over the triangle, or polygon, of its ports."""
    ports = sorted(((limb.port_x, limb.port_y) for limb in robot.limbs), key=lambda p: math.atan2(p[1], p[0]))
    area = second = 0.0
    for (x0, y0), (x1, y1) in zip(ports, ports[1:] + ports[:1], strict=True):
        cross = x0 * y1 - x1 * y0
        area += cross / 2
        second += cross * (x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1) / 12
    per_mass = second / area if area > 0.0 else max(x * x + y * y for x, y in ports) / 2
    return body_mass(robot) * per_mass
