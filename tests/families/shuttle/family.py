"""A toy family: robots that shuttle along a line of rungs on two feet."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Final, NamedTuple

import numpy as np
from pydantic import StrictStr

from clamber.errors import SpecError
from clamber.execution.run_report import RunReport
from clamber.family import Family
from clamber.files import Document, find_data, read_toml
from clamber.inspection.finding import Finding, Inspection
from clamber.planning.infeasibility.relaxations import key_dial
from clamber.planning.problem.arrays import ActionTable, CostToGoMap, Params
from clamber.planning.problem.body_pose import PoseAxis, PoseLattice
from clamber.planning.problem.check import Check
from clamber.planning.problem.code_limits import CodeLimits
from clamber.planning.problem.codes import HOLD, MOVE, NONE, RELEASE, Code, pack
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.problem import CompiledProblem
from clamber.planning.problem.problems import ActionError, PlanFamily, PlannedAction, Posed
from clamber.specs import Name, build_spec, field_names, spec
from clamber.tasks.parts import parts_of
from clamber.tasks.regions import GoalBox
from clamber.tasks.task_format import TaskFormat, hashes_of
from clamber.trials.noise import NoiseKind
from clamber.trials.plain_dynamics import PlainDynamics
from clamber.types import Json
from clamber.units import Length, PositiveLength

from .kernels import GOAL, PARAMS, REACH, STANCE

DATA: Final = Path(__file__).parent / "data"
CHECKS: Final = (
    Check("reach", "m", "how much nearer than its reach the body is to every foot"),
    Check("support", "1", "feet that stand while another steps, less one"),
)
HARD: Final = tuple(check.name for check in CHECKS)


@spec
class Shuttle:
    name: Name
    title: StrictStr = ""
    family: StrictStr = "shuttle"
    reach: PositiveLength
    limb_names: tuple[StrictStr, ...] = ("front", "back")


class Hold(NamedTuple):
    number: int
    x: float
    y: float = 0.0


@spec
class Line:
    name: Name
    title: StrictStr = ""
    rungs: tuple[Length, ...]

    @property
    def holds(self) -> tuple[Hold, ...]:
        return tuple(Hold(number, x) for number, x in enumerate(self.rungs, start=1))


@spec
class Step:
    length: PositiveLength


@spec
class Start:
    x: Length
    front: int
    back: int


@spec
class Rules:
    hard: tuple[StrictStr, ...] = HARD


@spec
class Stated:
    name: Name
    title: StrictStr = ""
    start: Start
    step: Step
    goal: GoalBox
    rules: Rules = Rules()


@dataclass(frozen=True)
class Task:
    name: str
    title: str
    robot: Shuttle
    world: Line
    start: Start
    step: Step
    goals: tuple[GoalBox, ...]
    rules: Rules
    document: Json = field(default_factory=dict)
    hashes: Mapping[str, str] = field(default_factory=dict)


def build_task(document: Document) -> Task:
    parts = parts_of(document, "line")
    stated = build_spec(Stated, document, without=("schema", *parts, "labels"))
    world = build_spec(Line, parts["line"], without=("schema",))
    for foot in (stated.start.front, stated.start.back):
        if not 1 <= foot <= len(world.rungs):
            raise document.problem("start", f"must name rungs from 1 to {len(world.rungs)}")
    robot = build_robot(parts["robot"])
    goals = (stated.goal.around_point(stated.step.length),)
    hashes = hashes_of(document, parts)
    return Task(
        stated.name, stated.title, robot, world, stated.start, stated.step, goals, stated.rules, document.data, hashes
    )


def build_robot(document: Document) -> Shuttle:
    return build_spec(Shuttle, document, without=("schema",))


def read_line(name: str, folder: Path | None = None) -> Document:
    return read_toml(*find_data("line", name, (DATA / "worlds",), folder))


class Problem(CompiledProblem):
    key_words, pose_words = 4, 4

    def __init__(self, task: Task, threads: int | None = None) -> None:
        self.task, self.rungs = task, np.array(task.world.rungs, np.float64)
        rungs, record, goals = task.world.rungs, np.zeros(1, PARAMS), np.zeros(len(task.goals), GOAL)
        row = record[0]
        row["step"], row["reach"], row["origin"] = task.step.length, task.robot.reach, task.start.x
        hard = sum(1 << k for k, name in enumerate(HARD) if name in task.rules.hard)
        row["hard"], row["n_limbs"], row["n_goals"], row["kinds"][:7] = hard, 2, len(goals), (0, 0, 1, 0, 1, 1, 2)
        row["base"] = self.way
        for k, goal in enumerate(task.goals):
            goals[k] = goal.box[:2]
        start = np.zeros(1, STANCE)
        start["hold"], start["x"] = (task.start.front - 1, task.start.back - 1), task.start.x
        params = Params(record, goals=goals, rungs=self.rungs)
        entries = [("+x", [pack(MOVE, 0, 0)], True), ("-x", [pack(MOVE, 0, 1)], True)]
        for f, name in enumerate(task.robot.limb_names):
            entries.append((f"lift {name}", [pack(RELEASE, f)], False))
            entries += [(f"{name} to {k + 1}", [pack(HOLD, f, k)], False) for k in range(len(rungs))]
        features = ("body", "limbs", "effort", "stages", "length", "unstable", "peak")
        super().__init__(params, start, ActionTable.build(entries), HARD, features, threads)
        short = task.robot.reach - max(abs(rungs[foot] - task.start.x) for foot in start["hold"][0])
        if short < 0.0 and "reach" in task.rules.hard:
            raise SpecError(
                f"task '{task.name}'", "start.x", task.start.x, f"violates the hard check 'reach' by {-short:.4g} m"
            )

    @property
    def limits(self) -> CodeLimits:
        return limits(self.task)

    @property
    def landmarks(self) -> int:
        return len(self.task.world.rungs)

    @property
    def branching(self) -> int:
        return 2 + 2 * max(1, self.landmarks)

    @property
    def way(self) -> float:
        low, high = self.task.goals[0].box[:2]
        return max(0.0, low - self.task.start.x, self.task.start.x - high)

    def ways(self) -> CostToGoMap:
        low, high = self.task.goals[0].box[:2]
        grid = np.arange(-0.2, max(self.task.world.rungs) + 0.2, self.task.step.length)
        away = [
            np.maximum(0.0, np.maximum(low - at, at - high))[None] / self.task.step.length for at in (grid, self.rungs)
        ]
        return CostToGoMap(np.array((grid[0], 0.0, self.task.step.length)), away[0][None], away[1], np.zeros(1))

    def is_done(self, stance: Any) -> bool:
        return bool(stance["stage"][0] >= len(self.task.goals))


def limits(task: Task) -> CodeLimits:
    n = len(task.world.rungs)
    kinds = {NONE: (1, 0, 0), MOVE: (1, 0, 1), RELEASE: (2, 0, 0), HOLD: (2, 0, n - 1)}
    return CodeLimits(f"task '{task.name}'", kinds, {"hold": (-1, n - 1, 2), "stage": (0, len(task.goals), 1)})


class Plans(PlanFamily):
    checks = CHECKS

    def posed(self, task: Task, threads: int | None, filters: bool) -> Posed:
        problem = Problem(task, threads)
        return Posed(problem, len(problem.actions))

    def problem(self, task: Task) -> Problem:
        return Problem(task, 1)

    def limits(self, task: Task) -> CodeLimits:
        return limits(task)

    def sizes(self, task: Task) -> Mapping[str, float]:
        return {"reach": task.robot.reach}

    def hard(self, task: Task) -> tuple[str, ...]:
        return task.rules.hard

    def action(self, task: Task, code: int, after: np.void, gene: str | None) -> PlannedAction:
        opened = Code.of(code)
        if opened.kind == "move":
            return PlannedAction(kind="move", delta=((1 - 2 * opened.argument) * task.step.length, 0.0), gene=gene)
        limb = task.robot.limb_names[opened.limb]
        if opened.kind == "hold":
            return PlannedAction(kind="grab", limb=limb, hold=opened.argument + 1, gene=gene)
        return PlannedAction(kind="release", limb=limb, gene=gene)

    def code(self, task: Task, action: PlannedAction) -> int:
        if action.kind == "move" and action.delta is not None:
            return pack(MOVE, 0, int(action.delta[0] < 0.0))
        if action.limb not in task.robot.limb_names:
            raise ActionError("limb", "must be front or back")
        foot = task.robot.limb_names.index(action.limb)
        return pack(RELEASE, foot) if action.kind == "release" else pack(HOLD, foot, (action.hold or 1) - 1)

    def module(self, task: Task, code: int) -> str:
        opened = Code.of(code)
        return f"{opened.kind} {opened.limb} {opened.argument}"

    pose_axes = (PoseAxis("x", "m"), PoseAxis("y", "m"))

    def pose(self, task: Task, stance: np.void) -> tuple[float, ...]:
        return float(stance["x"]), 0.0

    def lattice(self, task: Task, problem: CompiledProblem) -> PoseLattice:
        start, step = np.array((task.start.x, 0.0)), np.full(2, task.step.length)
        return PoseLattice(axes=self.pose_axes, origin=start, step=step, period=np.zeros(2, np.int64))

    def holds(self, task: Task, stance: np.void) -> dict[str, int]:
        return {name: int(foot) + 1 for name, foot in zip(task.robot.limb_names, stance["hold"], strict=True)}


def relaxations(task: Task) -> Iterator[Any]:
    reach = task.robot.reach
    yield key_dial("robot.reach", reach / 1e-3, most=4e3 * reach, unit="mm", per_unit=1, nested=True)


def inspect(robot: Shuttle) -> Finding:
    return Finding(kind="robot", name=robot.name, title=robot.title, facts={"reach": f"{robot.reach:g} m"})


class ShuttleRuns(PlainDynamics):
    kind, past = "shuttling", "shuttled"
    noise: ClassVar[Mapping[str, NoiseKind]] = {
        "slip": NoiseKind(dimension="length", unit="mm", scale=1e-3, width=5e-3, words="of each step")
    }

    def simulate(self, task: Any, plan: Plan, drawn: Mapping[str, float], step: Callable[..., None]) -> RunReport:
        problem = Problem(task, 1)
        stances, seconds = problem.replay(plan.codes(task)).stances, 0.0
        for number, stance in enumerate(stances[1:], start=1):
            step(f"action {number} of {len(stances) - 1}", number / len(stances))
            seconds += 1.0
            feet = [task.world.rungs[rung] for rung in stance["hold"] if rung >= 0]
            off = max(abs(place - stance["x"]) for place in feet) + abs(drawn["slip"]) - task.robot.reach
            if off > 1e-9:
                return RunReport(reason=f"step {number}: fell: a foot is {off:.3g} m out of reach", seconds=seconds)
        return RunReport(done=True, seconds=seconds)


class ShuttleFamily(Family):
    name, title, data = "shuttle", "shuttle", DATA
    plans, dynamics = Plans(), ShuttleRuns()
    relaxations = staticmethod(relaxations)
    inspection = Inspection(robot=inspect, kinds={})
    files = TaskFormat(
        build_robot=build_robot, robot_spec=Shuttle, world_key="line", read_world=read_line, build=build_task,
        task_spec=Stated, task_keys=field_names(Stated), robot_keys=field_names(Shuttle),
    )  # fmt: skip


SHUTTLE: Final = ShuttleFamily()
assert REACH == 0
