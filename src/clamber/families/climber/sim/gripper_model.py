"""A gripper in MuJoCo: open jaws as an arc behind the tip, and the pin that stands for jaws closed about a peg.

Closed jaws are no contact geometry but a constraint that pins a point of the limb to the peg. It takes force in every direction and is let
go of where the force exceeds the gripper's strength (`sim.grippers`). A peg turns in the jaws freely: no moment goes through a grip.
"""

import math
from itertools import pairwise
from typing import Any, Final

import numpy as np

from ....types import Floats
from ..robot.robot import EndEffector, Limb

WIRE: Final = 0.001
"""Radius of the jaws [m]."""
BACK: Final = math.radians(60.0)
"""How far open jaws come round the tip from straight behind it, either way [rad]: a peg may come in from any direction before it."""
CHORDS: Final = 4
"""Straight pieces of that arc."""
PIN_SOLREF: Final = (0.004, 1.0)
PIN_SOLIMP: Final = (0.95, 0.99, 0.0005, 0.5, 2.0)
"""As stiff as a peg in a hook."""
RADII: Final = 6.0
"""Width between open jaws over a hold's radius, for grippers that state none [-]."""


def jaw_opening(end: EndEffector, peg_radius: float) -> float:
    """Width between a gripper's open jaws [m]."""
    return RADII * peg_radius if end.opening is None else end.opening


def capture_radius(end: EndEffector, peg_radius: float) -> float:
    """Jaws that close catch a peg whose centre is no farther than this from the tip [m]: it lies within the circle of the open jaws."""
    return jaw_opening(end, peg_radius) / 2.0


def grip_name(limb: Limb) -> str:
    """Of the constraint that is a limb's closed gripper."""
    return f"{limb.name} grip"


def add_gripper(mujoco: Any, spec: Any, link: Any, limb: Limb, tip: Floats, peg_radius: float, touch: Any) -> None:
    """Jaws behind the tip, open towards the grab direction, and the pin, which is off.

    Args:
        mujoco: The module.
        spec: An `MjSpec`.
        link: The limb's last link.
        limb: Of the robot.
        tip: In the link's frame, shape (3,) [m].
        peg_radius: Of the pegs [m].
        touch: What may touch the jaws, and how, as `add_geom` takes it.
    """
    # the ring's corners lie outside the circle that its pieces leave free
    radius = (jaw_opening(limb.end, peg_radius) / 2.0 + WIRE) / math.cos(BACK / CHORDS)
    turns = limb.end.angle + math.pi + np.linspace(-BACK, BACK, CHORDS + 1)
    corners = tip + radius * np.stack((np.cos(turns), np.sin(turns), np.zeros_like(turns)), axis=1)
    for start, end in pairwise(corners):
        link.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=(*start, *end), size=(WIRE, 0.0, 0.0), mass=0.0, **touch
        )
    pin = spec.add_equality(name=grip_name(limb), type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_BODY)
    pin.name1, pin.active = link.name, False
    pin.data[:3] = tip
    pin.solref, pin.solimp = PIN_SOLREF, PIN_SOLIMP
