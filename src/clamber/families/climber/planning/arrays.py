"""A limbed climber's task as the arrays that the kernels read: rules, limbs, holds in a grid, goals, polygons."""

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from ....planning.problem.arrays import Params
from ....planning.problem.check import TICKS
from ....planning.problem.problem import FEATURE_KINDS, Records
from ..robot.robot import Limb
from ..statics.checks import LIMBED_CHECKS
from ..statics.many import work_size
from ..statics.records import GOAL, HOLD, LIMB, PARAMS
from .inventory import whole_kinds
from .keys import ANY_HOLD
from .task import Goal, LimbedTask

CHECKS: Final = tuple(check.name for check in LIMBED_CHECKS)
FORCE_RULES: Final = ("thesis", "min_torque", "min_norm")
ANY_DIRECTION: Final = -2.0
CROWD: Final = 2.0
"""Holds in a cell of the grid, on the average; 1 to 4 make little difference."""


def limbed_params(task: LimbedTask, *, every_check: bool) -> Params:
    """The arrays that the kernels read."""
    robot, board = task.robot, task.world
    cells, cell_start, grid = _grid(board.positions(), max(limb.length for limb in robot.limbs))
    polygons: list[tuple[tuple[float, float], ...]] = list(board.keep_out)
    offsets = np.concatenate([[0], np.cumsum([len(polygon) for polygon in polygons])]).astype(np.int64)
    goals = _goals(task, polygons, int(offsets[-1]))
    vertices = [vertex for polygon in polygons for vertex in polygon]
    hull = robot.outline()
    rows = 1 << len(robot.limbs) if task.rules.branch == "kept" else 0  # margins of each assignment of elbows
    record = np.zeros(1, PARAMS)
    _fill_rules(record[0], task, grid, every_check=every_check)
    return Params(
        record,
        limbs=np.array([_limb(task, limb) for limb in robot.limbs], LIMB),
        holds=_holds(task),
        cells=cells,
        cell_start=cell_start,
        goals=goals,
        vertices=np.array(vertices, np.float64).reshape(-1, 2),
        keep_out=offsets,
        hull=hull,
        work=np.zeros(work_size(len(robot.limbs), len(hull)) + len(CHECKS) * (1 + rows)),
    )


def _fill_rules(
    row: np.void, task: LimbedTask, grid: tuple[float, float, float, int, int], *, every_check: bool
) -> None:
    rules, step = task.rules, task.step
    row["x0"], row["y0"], row["a0"] = task.start.x, task.start.y, task.start.theta
    row["tick"] = step.length / TICKS
    turn = round(math.tau / step.angle)
    row["tick_angle"] = math.tau / turn / TICKS
    row["turn_ticks"] = turn * TICKS
    row["weight"] = task.robot.weight
    row["reach_offset"], row["holding_offset"] = rules.reach_offset, rules.holding_offset
    row["clearance"], row["inside"] = rules.clearance, rules.inside
    row["max_power"] = math.inf if rules.max_power is None else rules.max_power
    row["max_swing"] = rules.max_swing
    row["link_radius"], row["body_margin"] = task.robot.link_radius, task.robot.body_margin
    row["hook_width"], row["hook_ahead"] = rules.hook_width, rules.hook_ahead
    row["hook_way"], row["hook_room"] = rules.hook_way, rules.hook_room
    row["grid_x"], row["grid_y"], row["grid_cell"], row["grid_nx"], row["grid_ny"] = grid
    centre = next((goal.centre for goal in task.goals if goal.centre is not None), (0.0, 0.0))
    row["centre_x"], row["centre_y"] = centre
    row["centre_angle"] = math.atan2(task.start.y - centre[1], task.start.x - centre[0])
    row["allowed"], _ = whole_kinds(task)
    taken = [hold for hold in task.start.holds.values() if hold]
    row["shares"] = bool(row["allowed"] & ANY_HOLD) or len(set(taken)) < len(taken)
    row["circles"] = any(goal.turns is not None for goal in task.goals)
    ways = {math.copysign(1.0, goal.turns) for goal in task.goals if goal.turns}
    row["turning"] = int(ways.pop()) if len(ways) == 1 else 0
    row["seed"] = task.seed
    row["n_limbs"] = len(task.robot.limbs)
    row["n_goals"] = len(task.goals)
    row["force_rule"] = FORCE_RULES.index(rules.force_rule)
    row["atomic"] = rules.support == "atomic"
    row["max_hangs"] = rules.max_hangs
    row["min_supports"] = rules.min_supports
    row["idle"] = rules.limb_in_use == "idle"
    row["offset_while_holding"] = rules.offset_while_holding
    row["replace"] = rules.replace_out_of_reach
    row["kept"] = rules.branch == "kept"
    hard = sum(1 << CHECKS.index(name) for name in rules.hard)
    row["hard"] = hard
    row["seen"] = (1 << len(CHECKS)) - 1 if every_check else hard
    row["kinds"][: len(FEATURE_KINDS)] = FEATURE_KINDS
    row["fences"] = len(task.world.keep_out)
    for first, second in task.robot.opposed:
        i, j = task.robot.limb_index(first), task.robot.limb_index(second)
        row["opposed"][i] |= 1 << j
        row["opposed"][j] |= 1 << i


def _limb(task: LimbedTask, limb: Limb) -> tuple[float, ...]:
    motor = task.robot.motor
    beta = limb.hook_beta
    turn = limb.end.angle - beta
    centre1 = 0.5 * (limb.shoulder.lower + limb.shoulder.upper)
    centre2 = 0.5 * (limb.elbow.lower + limb.elbow.upper) + beta
    joints = (limb.shoulder, limb.elbow)
    cone = task.rules.hook_cone if limb.end.cone is None else limb.end.cone
    free = limb.end.kind == "gripper"
    limits = [motor.torque_limit if joint.torque_limit is None else joint.torque_limit for joint in joints]
    heats = [motor.resistance / (joint.gear * motor.torque_constant) ** 2 for joint in joints]
    return (
        limb.port_x,
        limb.port_y,
        math.cos(limb.port_angle),
        math.sin(limb.port_angle),
        limb.l1,
        limb.l2_effective,
        0.5 / (limb.l1 * limb.l2_effective),
        limb.length,
        math.cos(turn),
        math.sin(turn),
        math.cos(centre1),
        math.sin(centre1),
        0.5 * (limb.shoulder.upper - limb.shoulder.lower),
        math.cos(centre2),
        math.sin(centre2),
        0.5 * (limb.elbow.upper - limb.elbow.lower),
        limits[0],
        limits[1],
        heats[0],
        heats[1],
        ANY_DIRECTION if free else math.cos(cone),
        0.0 if free else math.sin(cone),
        0.0 if free else task.rules.hook_pull,
        math.inf if limb.end.strength is None else limb.end.strength,
    )


def _holds(task: LimbedTask) -> Records:
    out = np.zeros(len(task.world.holds), HOLD)
    for row, hold in zip(out, task.world.holds, strict=True):
        row["x"], row["y"], row["radius"], row["number"] = hold.x, hold.y, hold.radius, hold.number
        row["strength"] = math.inf if hold.strength is None else hold.strength
        row["c_cone"] = ANY_DIRECTION
        if hold.direction is not None:
            cone = math.pi / 2 if hold.cone is None else hold.cone
            row["dir_x"], row["dir_y"] = math.cos(hold.direction), math.sin(hold.direction)
            row["c_cone"], row["s_cone"] = math.cos(cone), math.sin(cone)
        allowed = (1 << len(task.robot.limbs)) - 1
        for keep in task.rules.keep:
            inside = (
                (keep.x_min is None or hold.x >= keep.x_min - 1e-9)
                and (keep.x_max is None or hold.x <= keep.x_max + 1e-9)
                and (keep.y_min is None or hold.y >= keep.y_min - 1e-9)
                and (keep.y_max is None or hold.y <= keep.y_max + 1e-9)
            )
            if not inside:
                allowed &= ~(1 << task.robot.limb_index(keep.limb))
        for name, barred in task.rules.barred.items():
            if hold.number in barred:
                allowed &= ~(1 << task.robot.limb_index(name))
        row["limbs"] = allowed
    return out


def _goals(task: LimbedTask, polygons: list[tuple[tuple[float, float], ...]], n_vertices: int) -> Records:
    """Goal records; the polygons of regions are added behind the keep-outs."""
    out = np.zeros(len(task.goals), GOAL)
    at = (task.start.x, task.start.y)
    way = 0.0
    for row, goal in zip(out, task.goals, strict=True):
        row["x_min"], row["x_max"], row["y_min"], row["y_max"] = goal.box
        row["a_half"] = math.tau
        if goal.theta_min is not None or goal.theta_max is not None:
            lower = -math.pi if goal.theta_min is None else goal.theta_min
            upper = math.pi if goal.theta_max is None else goal.theta_max
            row["a_mid"], row["a_half"] = 0.5 * (lower + upper), 0.5 * (upper - lower)
        if goal.turns is not None and goal.centre is not None:
            row["turns"] = math.tau * goal.turns
            row["radius"] = math.hypot(task.start.x - goal.centre[0], task.start.y - goal.centre[1])
        if goal.region is not None:
            row["vertex"], row["n_vertices"] = n_vertices, len(goal.region)
            polygons.append(goal.region)
            n_vertices += len(goal.region)
        row["hangs"] = goal.hangs
        row["hold"] = -1
        for name, number in goal.holds.items():
            row["hold"][task.robot.limb_index(name)] = task.world.index_of(number)
        there = _middle(goal, at)
        row["before"] = way
        row["way"] = math.hypot(there[0] - at[0], there[1] - at[1])
        if row["turns"]:
            row["way"] = max(float(row["way"]), float(row["radius"]) * abs(float(row["turns"])))
        way += float(row["way"])
        at = there
    for i in range(len(out) - 2, -1, -1):
        out["after"][i] = out["after"][i + 1] + _steps_between(out[i], out[i + 1], task.step.length)
        rise = max(0.0, float(out["y_min"][i + 1] - out["y_max"][i]))
        out["rise_after"][i] = out["rise_after"][i + 1] + math.ceil(rise / task.step.length - 1e-6)
    return out


def _steps_between(first: np.void, second: np.void, stride: float) -> int:
    """Fewest body steps along x and y from one goal's box to another's."""
    steps = 0
    for low, high in (("x_min", "x_max"), ("y_min", "y_max")):
        gap = max(0.0, float(second[low] - first[high]), float(first[low] - second[high]))
        steps += math.ceil(gap / stride - 1e-6)
    return steps


def _middle(goal: Goal, start: tuple[float, float]) -> tuple[float, float]:
    """The place that stands for a goal when ways are added up: the middle of its region, or of its box (`GoalBox.middle`)."""
    if goal.region is not None:
        corners = np.array(goal.region)
        return float(corners[:, 0].mean()), float(corners[:, 1].mean())
    return goal.middle(start)


def _grid(
    points: npt.NDArray[np.float64], cell: float
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32], tuple[float, float, float, int, int]]:
    """Holds sorted into square cells: indices cell by cell, where each cell starts, and the grid's place and size.

    Cells hold about `CROWD` holds, so that little but what is in reach is looked at on a dense board. They are at most `cell`
    wide, and never so small that there are many more cells than holds.
    """
    low = points.min(axis=0) - 1e-6
    size = points.max(axis=0) - low
    cell = min(cell, float(np.sqrt(CROWD * size[0] * size[1] / len(points))))
    cell = max(
        cell, float(np.sqrt(size[0] * size[1] / (4 * len(points) + 1024))), float(size.max()) / (len(points) + 1024)
    )
    count = np.maximum(1, np.ceil((points.max(axis=0) + 1e-6 - low) / cell).astype(int))
    column = ((points - low) / cell).astype(int)
    where = column[:, 1] * count[0] + column[:, 0]
    order = np.argsort(where, kind="stable").astype(np.int32)
    start = np.searchsorted(where[order], np.arange(count[0] * count[1] + 1)).astype(np.int32)
    return order, start, (float(low[0]), float(low[1]), cell, int(count[0]), int(count[1]))
