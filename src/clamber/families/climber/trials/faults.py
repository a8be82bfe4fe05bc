"""What of a climber may fail in its trials."""

import math
from typing import Final

import numpy as np

from ....execution.fault import Failing, Fault
from ....execution.faulty_plants import FaultyBody
from ....execution.plant import BodyPlant
from ....planning.problem.plan import Plan
from ..planning.task import LimbedTask
from ..robot.robot import LimbedRobot

BEGINS: Final = (1.0, 20.0)
"""First and last time at which a fault of a trial begins [s]: early, so that what comes of it is soon known."""
GRABS: Final = 6
"""A hold that is too weak is one of so many that are held at the start or grabbed first."""


def failing_of(task: LimbedTask, plan: Plan) -> Failing:
    """Encoders, motors, and the holds that the plan comes to first."""
    robot = task.robot
    names, spans = robot.joint_names, [joint.upper - joint.lower for joint in robot.joints]
    taken = [*task.start.holds.values(), *(action.hold for action in plan.actions if action.hold is not None)]
    holds = tuple(dict.fromkeys(hold for hold in taken if hold))[:GRABS]
    sensors = dict(zip(names, spans, strict=True)) | {"body": math.tau}
    return Failing(sensors=sensors, motors=names, holds=holds, weight=robot.weight)


def failing_body(robot: LimbedRobot, plant: BodyPlant, fault: Fault) -> FaultyBody:
    """The plant with a fault."""
    return FaultyBody(plant, fault, np.array([joint.inertia for joint in robot.joints]))
