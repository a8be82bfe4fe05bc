"""A ground in MuJoCo: its bricks, as a body that does not move."""

from typing import Any, Final

import numpy as np

from ..world.ground import Ground

GROUND, FEET = 1, 2
"""Bits of what may touch what."""
SOLREF: Final = (0.01, 1.0)


def touch(friction: float, contype: int, conaffinity: int) -> dict[str, Any]:
    """How a foot and the ground touch, as `add_geom` takes it."""
    return {
        "solref": SOLREF,
        "condim": 3,
        "friction": (friction, 0.0, 0.0),
        "contype": contype,
        "conaffinity": conaffinity,
    }


def add_ground(mujoco: Any, spec: Any, ground: Ground, friction: float) -> None:
    """Put the ground into the world.

    Args:
        mujoco: The module.
        spec: An `MjSpec`.
        ground: Its bricks become boxes "tile NUMBER".
        friction: Coefficient of feet on it [-].
    """
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, ground.axes().ravel())
    body = spec.worldbody.add_body(name="ground", quat=quat)
    for i, (x_min, x_max, y_min, y_max, top) in enumerate(ground.tiles()):
        low, high = np.array((x_min, y_min, -ground.depth)), np.array((x_max, y_max, top))
        body.add_geom(
            name=f"tile {i}",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=(low + high) / 2,
            size=(high - low) / 2,
            mass=0.0,
            **touch(friction, GROUND, FEET),
        )
