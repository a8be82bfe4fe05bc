"""Plans of limbed climbers: packed codes as named actions and back, and the thesis's numbers for them."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from ....errors import describe_choices
from ....planning.problem.arrays import ActionTable
from ....planning.problem.code_limits import CodeLimits
from ....planning.problem.codes import HOLD, MOVE, NEAREST, NONE, RANDOM, RELEASE, Code, pack
from ....planning.problem.problem import CompiledProblem, Records
from ....planning.problem.problems import ActionError, PlanCost, PlanFamily, PlannedAction, Posed
from ....shown_units import units_of
from ....types import Ints
from ..statics.checks import LIMBED_CHECKS
from .inventory import make_inventory, module_name
from .problem import LimbedProblem, limbed_limits
from .task import LimbedTask

LARGEST_PEG: Final = 90
"""The thesis's numbers name holds up to this one; N91 and up mean the nearest ones."""


class LimbedPlans(PlanFamily):
    """How plans of limbed climbers are named, replayed and reported."""

    checks = LIMBED_CHECKS
    stance_costs = LimbedProblem.stance_costs

    def posed(self, task: LimbedTask, threads: int | None, filters: bool) -> Posed:
        """The task as a problem with the hard checks alone, its inventory filtered if asked for."""
        inventory = make_inventory(task, filters=filters)
        return Posed(LimbedProblem(task, inventory.table(), threads=threads), inventory.full_size, inventory.dropped)

    def limits(self, task: LimbedTask) -> CodeLimits:
        """See `PlanFamily`."""
        return limbed_limits(task)

    def without_hangs(self, task: LimbedTask) -> LimbedTask:
        """The same task with no hangs allowed."""
        return replace(task, rules=replace(task.rules, max_hangs=0))

    def sizes(self, task: LimbedTask) -> Mapping[str, float]:
        """Reach, joint ranges, torque and power limits, weight; for distances the clearance or a tenth of the reach."""
        robot, rules = task.robot, task.rules
        reach = min(limb.length for limb in robot.limbs)
        joints = [joint for limb in robot.limbs for joint in (limb.shoulder, limb.elbow)]
        half = 0.5 * min(joint.upper - joint.lower for joint in joints)
        torque = min(robot.motor.torque_limit if j.torque_limit is None else j.torque_limit for j in joints)
        power = math.inf if rules.max_power is None else rules.max_power
        room = max(rules.clearance, 0.1 * reach)
        sizes = {check.name: room for check in LIMBED_CHECKS if check.unit != "1"}
        sizes |= {"reach": reach, "joint": half, "torque": torque, "power": power, "hook": robot.weight}
        return sizes

    def problem(self, task: LimbedTask) -> LimbedProblem:
        """See `PlanFamily`."""
        table = ActionTable.build([("none", [pack(NONE)], False)])
        return LimbedProblem(task, table, every_check=True, threads=1)

    def action(self, task: LimbedTask, code: int, after: np.void, gene: str | None) -> PlannedAction:
        """A packed code as a named action, with the hold that `after`, the stance it led to, says was taken."""
        opened = Code.of(code)
        if opened.kind == "none":
            return PlannedAction(kind="none", code=self._number(task, 0), gene=gene)
        if opened.kind == "move":
            number = self._number(task, 1 + opened.argument)
            return PlannedAction(kind="move", delta=self.move_delta(task, opened.argument), code=number, gene=gene)
        limb = task.robot.limb_names[opened.limb]
        base = 100 * (opened.limb + 1)
        if opened.kind == "release":
            return PlannedAction(kind="release", limb=limb, code=self._number(task, base), gene=gene)
        index = int(after["resolved"])
        if index < 0 and opened.kind == "hold":
            index = opened.argument
        if index < 0:
            wanted = f"nearest {opened.argument}" if opened.kind == "nearest" else "random"
            return PlannedAction(kind="grab", limb=limb, gene=wanted)
        hold = task.world.holds[index].number
        return PlannedAction(kind="grab", limb=limb, hold=hold, code=self._number(task, base + hold), gene=gene)

    def code(self, task: LimbedTask, action: PlannedAction) -> int:
        """The packed code of a named action; grabs name their hold.

        Raises:
            ActionError: If the task's robot or board has no such action.
        """
        if action.kind == "none":
            return pack(NONE)
        if action.kind == "move":
            return pack(MOVE, 0, self.move_argument(task, action.delta))
        names = task.robot.limb_names
        if action.limb not in names:
            allowed = f"must be a limb of robot '{task.robot.name}': {describe_choices(str(action.limb), names)}"
            raise ActionError("limb", allowed)
        limb = names.index(action.limb)
        if action.kind == "release":
            return pack(RELEASE, limb)
        if action.hold is None:
            return _unresolved(limb, action.gene)
        return hold_code(task, limb, action.hold)

    def module(self, task: LimbedTask, code: int) -> str:
        """The thesis's number of a module where it has one, words otherwise."""
        return module_name(task, code)

    def pose(self, task: LimbedTask, stance: np.void) -> tuple[float, float, float]:
        """Place [m] and angle [rad] of the body, world frame."""
        return float(stance["x"]), float(stance["y"]), float(stance["angle"])

    def holds(self, task: LimbedTask, stance: np.void) -> dict[str, int]:
        """Limb name -> number of its hold, 0 if it is free."""
        indices = zip(task.robot.limb_names, stance["hold"], strict=False)
        return {name: task.world.holds[int(h)].number if h >= 0 else 0 for name, h in indices}

    def taken(self, task: LimbedTask, stance: np.void) -> int | None:
        """See `PlanFamily`."""
        index = int(stance["resolved"])
        return None if index < 0 else task.world.holds[index].number

    def model(self, task: LimbedTask) -> str:
        """The rules that a proof about a task holds for."""
        rules = task.rules
        hangs = "any number of hangs" if rules.max_hangs < 0 else f"at most {rules.max_hangs} hangs"
        return (
            f"support {rules.support}, {hangs}, force rule {rules.force_rule}, branch {rules.branch}, "
            f"hard checks {', '.join(rules.hard)}"
        )

    def power(self, stance: np.void) -> float:
        """Electrical power of the joints that hold the weight [W] (thesis 2.22)."""
        return float(stance["power"])

    def costs(self, task: LimbedTask) -> Mapping[str, PlanCost]:
        """Energy of holding, and the largest joint torque."""
        unit, size, digits = units_of(task.document).torque
        return {
            "torque": PlanCost(feature="peak", title="largest torque", unit=unit, per_unit=size, digits=digits),
            "energy": PlanCost(feature="effort", title="holding energy", size=self.duration(task), unit="J"),
        }

    def duration(self, task: LimbedTask) -> float:
        """Time that one action takes [s]."""
        return task.step.duration

    def torque(self, stance: np.void) -> float:
        """Largest joint torque [N m]."""
        return float(stance["torque"])

    def nearest(self, task: LimbedTask, problem: CompiledProblem, stances: Records, asked: Ints) -> list[int | None]:
        """See `PlanFamily`."""
        found: list[int | None] = [None] * len(asked)
        for index in range(min(len(asked), len(stances) - 1)):
            if Code.of(int(asked[index])).kind == "nearest":
                here = problem.rebind(problem.actions, stances[index : index + 1])
                found[index] = self.taken(task, here.replay(asked[index : index + 1], go_on=True).stances[1])
        return found

    def _number(self, task: LimbedTask, number: int) -> int | None:
        """One of the thesis's numbers, where these can name every action of a task."""
        return number if len(task.robot.limbs) <= 9 and task.world.holds[-1].number <= LARGEST_PEG else None


def hold_code(task: LimbedTask, limb: int, number: int) -> int:
    """The packed code of a limb's grab of the hold with a number.

    Raises:
        ActionError: If the board has no such hold.
    """
    holds = task.world.holds
    index = task.world.index_of(number)
    if index is None:
        listed = f"it has {len(holds)}, from {holds[0].number} to {holds[-1].number}"
        raise ActionError("hold", f"board '{task.world.name}' has no hold {number}; {listed}")
    return pack(HOLD, limb, index)


def _unresolved(limb: int, gene: str | None) -> int:
    """A grab that found no hold when it was planned looks for one again."""
    word, _, rank = (gene or "").partition(" ")
    if word == "random":
        return pack(RANDOM, limb)
    if word == "nearest" and rank.isdecimal() and 1 <= int(rank) <= LARGEST_PEG:
        return pack(NEAREST, limb, int(rank))
    raise ActionError("hold", "must be given for a grab")


def thesis_code(task: LimbedTask, number: int) -> int:
    """The packed code of one of the thesis's numbers: 0, 1..6, N00, NXX (hold XX), N9k (k-th nearest), N99 (random).

    Raises:
        ActionError: If it is no such number, or limb or hold do not exist.
    """
    if number == 0:
        return pack(NONE)
    if 1 <= number <= 6:
        return pack(MOVE, 0, number - 1)
    limb, rest = number // 100 - 1, number % 100
    n_limbs = len(task.robot.limbs)
    if not 0 <= limb < n_limbs:
        raise ActionError("", f"must be 0..6, or three digits that start with the limb, 1..{n_limbs}")
    if rest == 0:
        return pack(RELEASE, limb)
    if rest == 99:
        return pack(RANDOM, limb)
    if rest > LARGEST_PEG:
        return pack(NEAREST, limb, rest - LARGEST_PEG)
    return hold_code(task, limb, rest)


PLANS: Final = LimbedPlans()
