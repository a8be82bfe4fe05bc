"""A robot in space as whole-body laws believe it to be: its tree, and the limits of its joints."""

from collections.abc import Sequence

import numpy as np

from ....control.whole_body.programme import Limits
from ....control.whole_body.tree import FREE, Dynamics, State, Tree
from ....control.whole_body.tree_kernels import work_out
from ....types import Floats
from ..robot.parts import Motors, parts_of
from ..robot.robot import SpatialRobot


def believed_tree(robot: SpatialRobot, gravity: Sequence[float]) -> Tree:
    """The tree of a robot, as its model has it.

    Args:
        robot: The robot.
        gravity: Acceleration of free fall, world frame [m/s^2].
    """
    chains = robot.chains
    parts = parts_of(robot)
    limbs = len(chains.limb_names)
    joints = [(limb, k) for limb in range(limbs) for k in range(int(chains.n_joints[limb]))]
    bodies = [parts.base, *(parts.links[limb][k] for limb, k in joints)]
    ends = np.cumsum(chains.n_joints)
    last = [(limb, int(chains.n_joints[limb])) for limb in range(limbs)]
    return Tree(
        parent=np.array([-1, *(0 if k == 0 else i for i, (_, k) in enumerate(joints))], np.int32),
        sliding=np.array([0, *(chains.sliding[at] for at in joints)], np.int32),
        offset=np.array([np.zeros(3), *(chains.offset[at] for at in joints)]),
        turn=np.array([np.eye(3), *(chains.rotation[at] for at in joints)]),
        mass=np.array([body.mass for body in bodies]),
        centre=np.array([body.centre for body in bodies]),
        inertia=np.array([body.inertia for body in bodies]),
        rotor=Motors.of(robot).rotor,
        end=ends.astype(np.int32),
        tip=np.array([chains.offset[at] for at in last]),
        tip_turn=np.array([chains.rotation[at] for at in last]),
        gravity=np.array(gravity, np.float64),
    )


def joint_limits(robot: SpatialRobot) -> Limits:
    """Limits of all joints; torques are all that the motors have: the share that plans leave is for what they know nothing of."""
    chains = robot.chains
    motors = Motors.of(robot)
    return Limits(
        torque=motors.torque,
        lower=chains.lower[chains.used],
        upper=chains.upper[chains.used],
        speed=chains.speed[chains.used],
        friction=motors.friction,
    )


def joint_inertias(tree: Tree, joints: Floats) -> Floats:
    """What each joint moves while the base and the other joints rest: rotor and links, shape (n,) [kg m^2] or [kg]."""
    state, dynamics = State.of(tree), Dynamics.of(tree)
    state.joints[:] = joints
    work_out(tree, state, dynamics)
    return np.diag(dynamics.mass)[FREE:].copy()
