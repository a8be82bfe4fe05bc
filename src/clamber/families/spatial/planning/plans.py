"""Plans of robots in space: packed codes as named actions and back."""

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from ....errors import describe_choices
from ....planning.problem.body_pose import SPACE, PoseLattice
from ....planning.problem.code_limits import CodeLimits
from ....planning.problem.codes import HOLD, MOVE, NONE, Code, pack
from ....planning.problem.problem import CompiledProblem, Records
from ....planning.problem.problems import SAME, ActionError, PlanCost, PlanFamily, PlannedAction, Posed
from ....types import Floats
from .checks import SPATIAL_CHECKS
from .problem import MOVE_NAMES, SpatialProblem, code_limits
from .records import AXES
from .robot_arrays import robot_arrays
from .step_kernels import NEAR
from .task import SpatialTask


class SpatialPlans(PlanFamily):
    """How plans of robots in space are named, replayed and reported."""

    checks = SPATIAL_CHECKS

    def posed(self, task: SpatialTask, threads: int | None, filters: bool) -> Posed:
        """The task as a problem with the hard checks alone."""
        problem = SpatialProblem(task, threads)
        return Posed(problem, len(problem.actions))

    def problem(self, task: SpatialTask) -> SpatialProblem:
        """See `PlanFamily`."""
        return SpatialProblem(task, 1, exact=True)

    def limits(self, task: SpatialTask) -> CodeLimits:
        """See `PlanFamily`."""
        return code_limits(task)

    def sizes(self, task: SpatialTask) -> Mapping[str, float]:
        """What each margin is a share of: half a joint's range, the largest jump, the torque limit, the weight, the limb's length."""
        chains = task.robot.chains
        used = chains.used
        weight = chains.total_mass * float(np.linalg.norm(task.world.gravity)) or chains.total_mass
        size = float(robot_arrays(task.robot).robot["size"][0])
        return {
            "joint": 0.5 * float((chains.upper - chains.lower)[used].min()),
            "jump": task.rules.jump,
            "limb_limb": 0.1 * size,
            "equilibrium": 1.0,
            "torque": float(chains.torque[used].max()),
            "slip": weight,
            "grip": weight,
            "moment": weight * size,
            "clearance": 0.1 * size,
        }

    def model(self, task: SpatialTask) -> str:
        """The lattice, and how many holds a limb chooses from, that a proof holds for."""
        step = task.step
        lattice = (
            f"poses in steps of {1e3 * step.length:g} mm along and across, {1e3 * step.height:g} mm of height (up to {step.heights} either "
            f"way), {math.degrees(step.angle):g} deg of yaw"
        )
        if step.tilt:
            lattice += f", {math.degrees(step.tilt):g} deg of pitch and roll (up to {step.tilts} either way)"
        return f"{super().model(task)}; {lattice}; the {step.nearest} nearest holds of each limb"

    def action(self, task: SpatialTask, code: int, after: np.void, gene: str | None) -> PlannedAction:
        """See `PlanFamily`."""
        opened = Code.of(code)
        if opened.kind == "move":
            return PlannedAction(kind="move", delta=self.move_delta(task, opened.argument), gene=gene)
        if opened.kind == "none":
            return PlannedAction(kind="none", gene=gene)
        return PlannedAction(
            kind="grab",
            limb=task.robot.chains.limb_names[opened.limb],
            hold=int(after["hold"][opened.limb]) + 1,
            gene=gene or (f"nearest {opened.argument + 1}" if opened.kind == "nearest" else None),
        )

    def code(self, task: SpatialTask, action: PlannedAction) -> int:
        """The packed code of a named action.

        Raises:
            ActionError: If the robot has no such action.
        """
        names = task.robot.chains.limb_names
        if action.kind == "none":
            return pack(NONE)
        if action.kind == "move":
            return pack(MOVE, 0, self.move_argument(task, action.delta))
        if action.kind == "grab":
            if action.limb not in names:
                raise ActionError("limb", f"must be a limb: {describe_choices(str(action.limb), names)}")
            if action.hold is None or action.hold > len(task.world.holds):
                raise ActionError("hold", f"must be 1 to {len(task.world.holds)}, a hold of the world")
            return pack(HOLD, names.index(action.limb), action.hold - 1)
        raise ActionError("kind", "actions of a robot in space are none, move and grab")

    def module(self, task: SpatialTask, code: int) -> str:
        """Name of a code: the move, or the limb with its choice."""
        opened = Code.of(code)
        if opened.kind == "move":
            return MOVE_NAMES[opened.argument]
        limb = task.robot.chains.limb_names[opened.limb]
        return f"{limb} {'nearest' if opened.kind == 'nearest' else 'to'} {opened.argument + 1}"

    def move_delta(self, task: SpatialTask, argument: int) -> tuple[float, ...]:
        """What the move of an argument changes: along, across, height [m], yaw, pitch, roll [rad]."""
        step, delta = task.step, np.zeros(AXES)
        times = 1 if argument < NEAR else step.far
        axis = argument % NEAR >> 1
        size = (step.length, step.length, step.height, step.angle, step.tilt, step.tilt)[axis]
        delta[axis] = (1 - 2 * (argument & 1)) * times * size
        return tuple(delta.tolist())

    def move_argument(self, task: SpatialTask, delta: tuple[float, ...] | None) -> int:
        """Which argument stands for a body's move; raises `ActionError` where none does."""
        step = task.step
        sizes = np.array([step.length, step.length, step.height, step.angle, step.tilt or 1.0, step.tilt or 1.0])
        if delta is not None and len(delta) == AXES and any(delta):
            for argument in range(len(MOVE_NAMES)):
                if np.all(np.abs(np.subtract(delta, self.move_delta(task, argument))) <= SAME * sizes):
                    return argument
        tilts = f", {step.tilt:.6g} rad of pitch or roll" if step.tilt else ""
        allowed = (
            f"must be along, across, height, yaw, pitch, roll with one step along one axis: {step.length:.6g} m or {step.far} times that "
            f"along or across, {step.height:.6g} m of height, {step.angle:.6g} rad of yaw{tilts}, either way"
        )
        raise ActionError("delta", allowed)

    pose_axes = SPACE

    def pose(self, task: SpatialTask, stance: np.void) -> tuple[float, ...]:
        """Along, across and above the guide [m], yaw, pitch and roll [rad]; a surface that is followed adds to height and tilt."""
        return tuple(poses_of(task, stance.reshape(1))[0].tolist())

    def lattice(self, task: SpatialTask, problem: CompiledProblem) -> PoseLattice:
        """The lattice of the body's poses on the guide."""
        start = task.start
        step = task.step
        return PoseLattice(
            axes=SPACE,
            origin=np.array((start.along, start.across, start.height, start.yaw, 0.0, 0.0)),
            step=np.array((step.length, step.length, step.height, step.angle, step.tilt, step.tilt)),
            period=np.array((0, 0, 0, round(math.tau / step.angle), 0, 0), np.int64),
        )

    def holds(self, task: SpatialTask, stance: np.void) -> dict[str, int]:
        """Limb name -> number of its hold."""
        names = task.robot.chains.limb_names
        return {name: int(hold) + 1 for name, hold in zip(names, stance["hold"][: len(names)], strict=True)}

    def torque(self, stance: np.void) -> float:
        """Largest joint torque in the solution with the most reserve [N m]."""
        return float(stance["torque"])

    def costs(self, task: SpatialTask) -> Mapping[str, PlanCost]:
        """How much of strengths and torques the worst stance uses."""
        return {"strain": PlanCost(feature="peak", title="uses at most", unit="%", per_unit=0.01, digits=0)}


def poses_of(task: SpatialTask, stances: Records) -> Floats:
    """Along, across, height [m], yaw, pitch, roll [rad] of stances, shape (n, 6)."""
    steps, lattice = stances["pose"], task.step
    height = task.start.height + lattice.height * steps[:, 2]
    return np.column_stack(
        (stances["x"], stances["y"], height, stances["angle"], lattice.tilt * steps[:, 4], lattice.tilt * steps[:, 5])
    )


PLANS: Final = SpatialPlans()
