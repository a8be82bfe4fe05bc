"""A wall in MuJoCo for a limb to press against: a plate that slides along the wall's normal on a spring, and a ball at the tip."""

from typing import Any, Final

import numpy as np

from .limb_flaws import Wall

TIP_RADIUS: Final = 0.005
"""Of the ball that touches the wall [m]."""
HALF_THICK: Final = 0.01
"""Half the plate's thickness [m]."""
LEAST_MASS: Final = 0.05
"""Of the plate [kg]."""
FASTEST: Final = 0.5
"""Most that the plate's own oscillation may turn in a physics step [rad]: a stiffer wall gets a heavier plate."""
CONTACT: Final = {"solref": (0.002, 1.0), "solimp": (0.999, 0.9999, 0.0005, 0.5, 2.0), "condim": 3}
"""So hard that the spring, not the contact, is the wall's stiffness."""


def plate_mass(wall: Wall, timestep: float) -> float:
    """Mass of the plate [kg]: small, and so large that its oscillation on the spring is resolved by steps of `timestep` [s]."""
    return max(LEAST_MASS, wall.stiffness * (timestep / FASTEST) ** 2)


def add_wall(mujoco: Any, spec: Any, hand: Any, wall: Wall, **bits: int) -> None:
    """Put the wall into the world and the ball on `hand`, a body whose origin is the tip.

    The ball's front touches the plate when the tip is on the untouched surface, so places of the tip and of the surface are the same.
    `bits`: what may touch what, as `add_geom` takes it.
    """
    normal = np.array((np.cos(wall.angle), np.sin(wall.angle), 0.0))
    half = wall.angle / 2
    plate = spec.worldbody.add_body(
        name="wall",
        pos=np.array((wall.x, wall.y, 0.0)) + (HALF_THICK + TIP_RADIUS) * normal,
        quat=(np.cos(half), 0.0, 0.0, np.sin(half)),
    )
    plate.explicitinertial = True
    plate.mass, plate.inertia = plate_mass(wall, spec.option.timestep), (1e-4, 1e-4, 1e-4)
    spring = plate.add_joint(name="wall", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=(1.0, 0.0, 0.0))
    spring.stiffness[0], spring.damping[0] = wall.stiffness, wall.damping
    friction = (wall.friction, 0.0, 0.0)
    plate.add_geom(
        name="wall", type=mujoco.mjtGeom.mjGEOM_BOX, size=(HALF_THICK, 1.0, 0.1), friction=friction, **bits, **CONTACT
    )
    hand.add_geom(
        name="tip",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=(TIP_RADIUS, 0, 0),
        mass=0.0,
        friction=friction,
        **bits,
        **CONTACT,
    )
