"""Differential inverse kinematics of mink and pink on the ten-freedom chain of plate and arm: what one step costs there."""

from collections.abc import Callable
from typing import Any, Final, TypeAlias

import numpy as np

from .....types import Floats
from ...control.cooperative.limits import freedom_names
from ...robot import WalkerRobot
from ...sim.arm_chain_model import TOOL, chain_model

Tick: TypeAlias = Callable[[Floats, Floats], Floats]
"""Rates of the freedoms that bring the tool from a configuration to a place of the world [m] within one period."""
PERIOD: Final = 0.02
SOLVER: Final = "daqp"
DAMPING: Final = 1e-6
"""Of the rates, so that ten freedoms for three numbers have one answer."""


def mink_tick(robot: WalkerRobot, speeds: Floats, *, limited: bool) -> Tick:
    """A step of mink: the new configuration read in and `solve_ik`, with limits of joints and rates or none."""
    import mink

    model = chain_model(robot)
    configuration: Any = mink.Configuration(model)
    task: Any = mink.FrameTask(TOOL, "site", position_cost=1.0, orientation_cost=0.0)
    names = freedom_names(robot)
    limits: list[Any] = []
    if limited:
        limits = [mink.ConfigurationLimit(model), mink.VelocityLimit(model, dict(zip(names, speeds, strict=True)))]

    def tick(q: Floats, place: Floats) -> Floats:
        configuration.update(q)
        task.set_target(mink.SE3.from_translation(place))
        out: Floats = mink.solve_ik(configuration, [task], PERIOD, SOLVER, DAMPING, limits=limits)
        return out

    return tick


def pink_tick(robot: WalkerRobot, speeds: Floats, *, limited: bool) -> Tick:
    """A step of pink: the new configuration read in and `solve_ik`, with limits of joints and rates or none."""
    import pinocchio
    from pink import Configuration, solve_ik
    from pink.limits import ConfigurationLimit, VelocityLimit
    from pink.tasks import FrameTask

    arm = robot.own_arm
    model = pinocchio.Model()
    unit = pinocchio.SE3.Identity()
    kinds = [
        *(pinocchio.JointModelPX(), pinocchio.JointModelPY(), pinocchio.JointModelPZ()),
        *(pinocchio.JointModelRZ(), pinocchio.JointModelRY(), pinocchio.JointModelRX(), pinocchio.JointModelRZ()),
    ]
    names, parent = freedom_names(robot), 0
    for name, kind in zip(names, kinds, strict=False):
        parent = model.addJoint(parent, kind, unit, name)
    place = np.array([arm.out, 0.0, arm.up])
    for name, length in zip(names[7:], arm.links, strict=True):
        joint = pinocchio.JointModelRevoluteUnaligned(0.0, -1.0, 0.0)
        parent = model.addJoint(parent, joint, pinocchio.SE3(np.eye(3), place), name)
        place = np.array([length, 0.0, 0.0])
    tool = pinocchio.Frame(TOOL, parent, 0, pinocchio.SE3(np.eye(3), place), pinocchio.FrameType.OP_FRAME)
    model.addFrame(tool)
    model.lowerPositionLimit = np.array([*np.full(6, -10.0), *arm.lowest])
    model.upperPositionLimit = np.array([*np.full(6, 10.0), *arm.highest])
    model.velocityLimit = np.array(speeds)
    configuration: Any = Configuration(model, model.createData(), np.zeros(len(names)))
    task: Any = FrameTask(TOOL, position_cost=1.0, orientation_cost=0.0)
    limits: list[Any] = [ConfigurationLimit(model), VelocityLimit(model)] if limited else []

    def tick(q: Floats, place: Floats) -> Floats:
        configuration.update(q)
        task.set_target(pinocchio.SE3(configuration.get_transform_frame_to_world(TOOL).rotation, place))
        out: Floats = solve_ik(configuration, [task], PERIOD, SOLVER, DAMPING, limits=limits)
        return out

    return tick


CHAIN_PEERS: Final[dict[str, Callable[..., Tick]]] = {"mink": mink_tick, "pink": pink_tick}
"""Library -> what it does in a step; each is optional."""
