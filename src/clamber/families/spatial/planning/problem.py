"""A task of a robot in space as planners see it."""

import math
from collections.abc import Callable
from typing import Any, Final, Self

import numpy as np
import numpy.typing as npt

from ....errors import SpecError
from ....planning.problem.arrays import ActionTable, CostToGoMap, Params
from ....planning.problem.code_limits import CodeLimits
from ....planning.problem.codes import HOLD, MOVE, NEAREST, NONE, Code, pack
from ....planning.problem.problem import FEATURE_KINDS, FEATURE_NAMES, Beam, CompiledProblem, Records
from ....types import Floats
from ..statics.judging import REACHED
from ..statics.records import BODY, CONTACT, JUDGED, LIMBS, RULES, WORK
from . import search_kernels as search_kernels  # its module registers the family's kernels
from .bounding import with_bound
from .checks import SPATIAL_CHECKS
from .judging_kernels import SCRATCH
from .records import AXES, GOAL, KNOWN, LIFTED, PARAMS
from .records import HOLD as HOLD_RECORD
from .robot_arrays import robot_arrays
from .start import find_start
from .step_kernels import MOVES
from .surface import fit_surface, on_guide, span_along
from .task import CHECK_NAMES, SpatialTask, Start

MOVE_NAMES: Final = tuple(
    f"{sign}{axis}" for axis in ("along", "across", "height", "yaw", "pitch", "roll") for sign in "+-"
) + tuple(f"{sign}{axis} far" for axis in ("along", "across") for sign in "+-")
"""By argument of a move."""


class SpatialProblem(CompiledProblem):
    """Poses on a guide, holds of the world, all checks."""

    key_words, pose_words = 6, AXES + LIMBS
    foreseen = ("body", "limbs", "stages", "length", "unstable")
    beam = Beam(width=120, niche=2, weights=(("body", 1.0), ("limbs", 0.3), ("stages", 0.5)), polish=10_000)

    def __init__(self, task: SpatialTask, threads: int | None = None, *, exact: bool = False) -> None:
        """Pose a task.

        Args:
            task: What is planned.
            threads: For batches; None: one a core.
            exact: Whether every margin is worked out to its end, as replays ask for it.

        Raises:
            SpecError: If the robot cannot stand at the start.
        """
        self.task = task
        params = problem_params(task, exact)
        super().__init__(
            params,
            find_start(task, params),
            ActionTable.build([(name, [pack(MOVE, 0, k)], True) for k, name in enumerate(MOVE_NAMES)] + _choices(task)),
            CHECK_NAMES,
            FEATURE_NAMES,
            threads,
        )

    def informed(self, is_late: Callable[[], bool] = lambda: False) -> Self:
        """The same problem whose `bound` counts, limb by limb, what must still change near the straight way to the last goal."""
        return self._with_params(with_bound(self.params, self.start, is_late))

    @property
    def limits(self) -> CodeLimits:
        """Codes and indices of the task."""
        return code_limits(self.task)

    @property
    def landmarks(self) -> int:
        """Holds."""
        return len(self.task.world.holds)

    @property
    def branching(self) -> int:
        """Moves, and the nearest holds of each limb."""
        return MOVES + len(self.task.robot.chains.limb_names) * self.task.step.nearest

    @property
    def way(self) -> float:
        """Distance to the last goal from the start, by way of the goals between [m]."""
        return float(self.params.record["base"])

    @property
    def estimated_stances(self) -> float:
        """Poses of the lattice about the way, times the holds that each limb may have there."""
        step, limbs = self.task.step, len(self.task.robot.chains.limb_names)
        reach = float(self.params.record["reach"])
        poses = (self.way / step.length + 1.0) * (2.0 * reach / step.length) * (2 * step.heights + 1)
        poses *= float(self.params.record["turns"]) * ((2 * step.tilts + 1) ** 2 if step.tilt else 1)
        places = self.task.world.places
        some = places[:: max(1, len(places) // SAMPLED)]
        near = np.linalg.norm(places[None] - some[:, None], axis=2) < 0.5 * reach
        return poses * max(1.0, float(np.median(near.sum(axis=1)))) ** limbs

    def ways(self) -> CostToGoMap:
        """Steps along and across to each goal, straight."""
        task, step = self.task, self.task.step
        goals: Any = self.params.array("goals")
        holds: Any = self.params.array("holds")
        spread = float(self.params.record["reach"])
        ends_u = np.concatenate((holds["along"], [task.start.along]))
        ends_v = np.concatenate((holds["across"], [task.start.across]))
        u = np.arange(ends_u.min() - spread, ends_u.max() + spread, step.length)
        v = np.arange(ends_v.min() - spread, ends_v.max() + spread, step.length)
        fields = np.array([_away(goal, u[None, :], v[:, None]) for goal in goals]) / (step.far * step.length)
        at_holds = np.array([_away(goal, holds["along"], holds["across"]) for goal in goals])
        after = np.zeros(len(goals))
        for k in range(len(goals) - 2, -1, -1):
            after[k] = (goals["way"][-1] - goals["way"][k]) / (step.far * step.length)
        return CostToGoMap(np.array((u[0], v[0], step.length)), fields, at_holds / (step.far * step.length), after)

    def resolve(self, codes: npt.NDArray[np.int32], stances: Records) -> npt.NDArray[np.int32]:
        """Codes that name the hold which each choice of the nearest came to."""
        named = codes.copy()
        for i, code in enumerate(codes.tolist()):
            opened = Code.of(code)
            if opened.kind == "nearest":
                named[i] = pack(HOLD, opened.limb, int(stances["hold"][i + 1, opened.limb]))
        return named


def _choices(task: SpatialTask) -> list[tuple[str, list[int], bool]]:
    return [
        (f"{name} nearest {rank + 1}", [pack(NEAREST, limb, rank)], False)
        for limb, name in enumerate(task.robot.chains.limb_names)
        for rank in range(task.step.nearest)
    ]


def code_limits(task: SpatialTask) -> CodeLimits:
    """The codes that are actions of a task, and the indices that its stances may have."""
    holds, limbs = len(task.world.holds), len(task.robot.chains.limb_names)
    kinds = {
        NONE: (1, 0, 0),
        MOVE: (1, 0, MOVES - 1),
        NEAREST: (limbs, 0, task.step.nearest - 1),
        HOLD: (limbs, 0, holds - 1),
    }
    return CodeLimits(f"task '{task.name}'", kinds, {"hold": (0, holds - 1, limbs), "stage": (0, len(task.goals), 1)})


def _away(goal: Any, along: Any, across: Any) -> Floats:
    beside = [
        np.maximum(0.0, np.maximum(goal[f"{axis}_min"] - at, at - goal[f"{axis}_max"]))
        for axis, at in (("along", along), ("across", across))
    ]
    made: Floats = np.hypot(*beside)
    return made


def goal_records(task: SpatialTask) -> Records:
    """Goals in order, records of `GOAL`."""
    rows = np.zeros(len(task.goals), GOAL)
    at, way = (task.start.along, task.start.across), 0.0
    for row, goal in zip(rows, task.goals, strict=True):
        row["along_min"], row["along_max"], row["across_min"], row["across_max"] = box = goal.box
        low, high = goal.yaw_min, goal.yaw_max
        entered = min(max(at[0], box[0]), box[1]), min(max(at[1], box[2]), box[3])
        way += math.dist(at, entered)
        at = entered
        row["way"] = way
        row["yaw_min"], row["yaw_width"] = (0.0, ANY_YAW) if low is None or high is None else (low, high - low)
    return rows


def hold_records(task: SpatialTask) -> Records:
    """Holds in order, records of `records.HOLD`."""
    world = task.world
    rows = np.zeros(len(world.holds), HOLD_RECORD)
    rows["place"], rows["normal"] = world.places, world.normals
    rows["friction"] = [math.inf if hold.friction is None else hold.friction for hold in world.holds]
    rows["strength"] = [math.inf if hold.strength is None else hold.strength for hold in world.holds]
    on = on_guide(world.frames, world.places)
    rows["along"], rows["across"], rows["height"] = on[:, 0], on[:, 1], on[:, 2]
    return rows


def leaning(tips: Floats, start: Start) -> Floats:
    """Nominal tips along, beside and above a body's heading on the guide, when it leans as at the start, shape (limbs, 3) [m].

    Args:
        tips: Base frame, shape (limbs, 3) [m].
        start: Of the task.
    """
    cp, sp, cr, sr = math.cos(start.pitch), math.sin(start.pitch), math.cos(start.roll), math.sin(start.roll)
    made: Floats = tips @ np.array(((cp, sp * sr, sp * cr), (0.0, cr, -sr), (-sp, cp * sr, cp * cr))).T
    return made


def problem_params(task: SpatialTask, exact: bool) -> Params:
    """The parameters of a task for its kernels."""
    robot, world, step, rules, start = task.robot, task.world, task.step, task.rules, task.start
    if not world.holds:
        raise SpecError(f"world '{world.name}'", "holds", [], "must be one or more: limbs stand on holds")
    holds, record = hold_records(task), np.zeros(1, PARAMS)
    row = record[0]
    for key in ("along", "across", "height", "yaw", "pitch", "roll"):
        row[key] = getattr(start, key)
    row["rise"] = step.height
    for key in ("length", "angle", "tilt", "heights", "tilts", "far", "nearest"):
        row[key] = getattr(step, key)
    row["turns"] = round(math.tau / step.angle)
    row["n_limbs"], row["kinds"][: len(FEATURE_KINDS)] = len(robot.chains.limb_names), FEATURE_KINDS
    row["hard"] = sum(1 << k for k, check in enumerate(SPATIAL_CHECKS) if check.name in rules.hard)
    row["lift"], row["clearance"] = rules.lift, rules.clearance
    arrays = robot_arrays(robot)
    reach = arrays.reach
    row["reach"] = float(reach.max())
    aloft = abs(start.height) + step.heights * step.height + float(abs(holds["height"]).max())
    spans = np.zeros(LIMBS)
    spans[: len(reach)] = [span_along(world.frames, float(most), aloft) for most in reach]
    follow, corner = np.zeros((0, 0, 3)), (0.0, 0.0)
    if step.follow:
        on = np.column_stack((holds["along"], holds["across"], holds["height"]))
        radius = 0.5 * float(reach.max())
        follow, corner = fit_surface(on, 0.25 * radius, radius)
        row["follow_grain"] = 0.25 * radius
    row["follow_along"], row["follow_across"] = corner
    row["n_rows"], row["n_columns"] = follow.shape[:2]
    rows = np.zeros(1, RULES)
    rows["need"], rows["jump"], rows["jump_moved"] = rules.need, rules.jump, MOVED * rules.jump
    rows["reach"], rows["exact"] = REACHED, int(exact)
    rows["hard"] = row["hard"]
    body = np.zeros(1, BODY)
    body["gravity"], body["wrench"][0, :3] = world.gravity, rules.push
    goals = goal_records(task)
    row["base"] = goals["way"][-1]
    return Params(
        record,
        robot=arrays.robot,
        seeds=arrays.table.records,
        rules=rows,
        goals=goals,
        holds=holds,
        frames=world.frames,
        follow=follow,
        solids=world.solid_records,
        spans=spans,
        tips=leaning(arrays.tips, start),
        region=np.zeros(0, np.int32),
        left=np.zeros(0, np.int16),
        work=np.zeros(SCRATCH),
        work_body=body,
        work_contacts=np.zeros(LIMBS + 2, CONTACT),
        work_judged=np.zeros(2, JUDGED),
        work_statics=np.zeros(1, WORK),
        work_known=np.zeros(KEPT, KNOWN),
        work_lifted=np.zeros(KEPT_STANCES, LIFTED),
    )


KEPT: Final = 1 << 14
"""Postures that each thread keeps; a power of two."""
KEPT_STANCES: Final = 1 << 12
"""Stances of which each thread keeps what limbs may be lifted: several layers of a beam; a power of two."""
SAMPLED: Final = 100
"""Holds about which others are counted, to estimate how many there are for a limb."""
ANY_YAW: Final = 7.0
"""Width of a goal's range of yaw that takes all of them: more than a turn [rad]."""
MOVED: Final = 2.5
"""How much farther a joint of a limb that takes another hold may move than one of a limb that stays, of `rules.jump` [-]."""
