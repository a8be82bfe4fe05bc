"""A walker's plate and arm as MuJoCo has open chains: three slides, three hinges for the plate's angles, then the arm's joints."""

from typing import Any

from ..robot import WalkerRobot

TOOL = "tool"
"""Name of the tool point's site."""
PLATE = (
    ("x", (1, 0, 0)),
    ("y", (0, 1, 0)),
    ("z", (0, 0, 1)),
    ("alpha", (0, 0, 1)),
    ("beta", (0, 1, 0)),
    ("gamma", (1, 0, 0)),
)
"""Freedoms of the plate, and axes."""


def chain_model(robot: WalkerRobot) -> Any:
    """The chain of equation 8 of Hoshino and others; masses are ones, for kinematics only.

    Args:
        robot: With an arm.

    Returns:
        A MuJoCo model.
    """
    import mujoco

    arm = robot.own_arm
    spec = mujoco.MjSpec()
    plate = spec.worldbody.add_body(name="plate", mass=1.0, inertia=(1.0, 1.0, 1.0), explicitinertial=True)
    for k, (name, axis) in enumerate(PLATE):
        kind = mujoco.mjtJoint.mjJNT_SLIDE if k < 3 else mujoco.mjtJoint.mjJNT_HINGE
        plate.add_joint(name=name, type=kind, axis=axis)
    turning = plate.add_body(name="turning", mass=1.0, inertia=(1.0, 1.0, 1.0), explicitinertial=True)
    ranges = list(zip(arm.lowest, arm.highest, strict=True))
    turning.add_joint(name="theta0", axis=(0, 0, 1), range=ranges[0], limited=True)
    parent, place = turning, (arm.out, 0.0, arm.up)
    for k, length in enumerate(arm.links, start=1):
        parent = parent.add_body(
            name=f"link{k}", pos=place, mass=1.0, inertia=(1.0, 1.0, 1.0), explicitinertial=True
        )  # fmt: skip
        parent.add_joint(name=f"theta{k}", axis=(0, -1, 0), range=ranges[k], limited=True)
        place = (length, 0.0, 0.0)
    parent.add_site(name=TOOL, pos=place)
    spec.compiler.degree = False
    return spec.compile()
