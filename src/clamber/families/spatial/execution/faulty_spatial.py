"""A robot in space with a fault: one layer over any plant of its kind that the controller cannot tell from a plant."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from ....execution.fault import (
    FAULTS,
    FIRST_HOLDS,
    Failing,
    Fault,
    Injector,
)
from ....execution.faulty_plants import (
    OwnHold,
    Weakened,
    step_on,
)
from ....execution.plant import PlantLayer
from ....planning.problem.plan import Plan
from ....types import Floats, Ints
from ....units import GRAVITY
from ..planning.task import SpatialTask
from ..robot.chains import Chains
from ..robot.robot import SpatialRobot
from .course import grabs
from .plant import (
    Pose,
    SpatialPlant,
    SpatialSensed,
    SpatialTruth,
)
from .sensors import sensor_names, sensor_ranges


def fault_kinds(robot: SpatialRobot) -> tuple[str, ...]:
    """Kinds of faults that a robot may have: only end effectors that attach pull a hold off."""
    attaches = any(strength.capture > 0.0 for strength in robot.strengths)
    return tuple(name for name, kind in FAULTS.items() if kind.target != "hold" or attaches)


def failing_of(task: SpatialTask, plan: Plan) -> Failing:
    """Sensors, motors, and the holds that the plan comes to first with end effectors that attach."""
    robot = task.robot
    names = sensor_names(robot)
    strengths = robot.strengths
    taken = [hold for limb, hold in grabs(task, plan) if strengths[limb].capture > 0.0]
    holds = tuple(hold + 1 for hold in dict.fromkeys(taken))[:FIRST_HOLDS]
    sensors = dict(zip(names, sensor_ranges(robot).tolist(), strict=True))
    joints = names[: int(robot.chains.n_joints.sum())]
    return Failing(sensors=sensors, motors=joints, holds=holds, weight=robot.chains.total_mass * GRAVITY)


class FaultySpatial(PlantLayer[SpatialPlant, SpatialTruth | None]):
    """A robot in space with a fault; a `SpatialPlant`. A motor that fails tells the torque that it was asked for: its gear slips.

    Args:
        plant: What moves; for a weak hold, one that can `weaken` it.
        fault: Channels are those of `sensor_names`; motors are the joints'.
        chains: Of the robot.
        inertias: That each joint moves, shape (n,) [kg m^2] or [kg]: a robot without commands holds its posture.
    """

    def __init__(self, plant: SpatialPlant, fault: Fault, chains: Chains, inertias: Floats) -> None:
        super().__init__(plant)
        self._injector, self._own = Injector(fault, plant.period), OwnHold(inertias)
        self.sensed: Final = SpatialSensed.of(chains)
        """What arrives of the sensors' readings."""
        self._n, self._limbs = self.sensed.torques.size, self.sensed.closed.size
        self._real = self.sensed
        self._torques, self._wanted = np.zeros(self._n), np.zeros(self._limbs)
        self._gripped = np.zeros(self._limbs)
        self._weakened = False

    def reset(self, pose: Pose, joints: Floats, held: Sequence[int] | Ints) -> None:
        """See `SpatialPlant`."""
        self.plant.reset(pose, joints, held)
        self._injector.reset()
        self._own.reset()
        self._torques[:] = self._wanted[:] = self._gripped[:] = 0.0
        self._weakened = False

    def sense(self) -> SpatialSensed:
        """See `SpatialPlant`."""
        real, told, injector = self.plant.sense(), self.sensed, self._injector
        fault, n, at = injector.fault, self._n, injector.fault.channel
        self._real = real
        parts = _side_by_side(real)
        values, number = injector.read(np.concatenate(parts), int(real.number[0]))
        ends = np.cumsum([part.size for part in parts])
        for to, part in zip(_side_by_side(told), np.split(values, ends[:-1]), strict=True):
            to[:] = part
        told.number[0] = number
        if fault.target == "sensor" and at < n:
            told.joints[1, at] = injector.speed(float(told.joints[0, at]), float(real.joints[1, at]))
        elif fault.target == "motor" and injector.on:
            told.torques[at] = self._torques[at]
        return told

    def actuate(self, torques: Floats) -> None:
        """See `SpatialPlant`."""
        arrived = self._injector.command(np.concatenate((torques, self._wanted)))
        if arrived is None:
            return
        self._torques[:] = arrived[: self._n]
        for limb in np.flatnonzero(arrived[self._n :] != self._gripped).tolist():
            self._grip(limb, bool(arrived[self._n + limb]))

    def grip(self, limb: int, close: bool) -> None:
        """See `SpatialPlant`; over a link that fails it goes with the torques."""
        self._wanted[limb] = close
        if not (self._injector.on and self._injector.fault.target == "link"):
            self._grip(limb, close)

    def brake(self, joint: int) -> None:
        """See `SpatialPlant`."""
        self.plant.brake(joint)

    def _grip(self, limb: int, close: bool) -> None:
        self._gripped[limb] = close
        self.plant.grip(limb, close)

    def step(self) -> None:
        """See `SpatialPlant`."""
        injector, fault = self._injector, self._injector.fault
        if fault.target == "hold" and injector.on and not self._weakened:
            weakened: Weakened = self.plant  # type: ignore[assignment]
            weakened.weaken(fault.channel, fault.size)
            self._weakened = True
        torques = self._torques
        if injector.silent:
            torques = self._own.torques(torques, *self._real.joints)
        self.plant.actuate(injector.weaken(torques.copy(), np.zeros(self._n)))
        step_on(self.plant, injector.passed())


def _side_by_side(sensed: SpatialSensed) -> tuple[Floats | Ints, ...]:
    """Readings as `sensor_names` has them, then what no sensor of those tells, as views."""
    angles, speeds = sensed.joints
    wrenches = sensed.wrenches.reshape(-1)
    return angles, sensed.torques, sensed.gyro, sensed.accelerometer, wrenches, speeds, sensed.closed, sensed.shutting
