"""What the viewer's buttons do: plan a task, and carry a plan out in contact dynamics, with progress told on the way."""

import time
from dataclasses import dataclass
from typing import Final

from ..families.climber.planning.task import LimbedTask
from ..families.climber.trials.planning import plan_to_climb, replanner
from ..families.climber.trials.rehearsal import Rehearsal, rehearse
from ..families.climber.trials.run_plan import ClimbRun, climbing_flaws, climbing_task, run_plan
from ..families.walker.planning import Walk
from ..families.walker.planning.task import WalkerTask
from ..families.walker.trials.planned import careful, lay_plan, walk_of
from ..families.walker.trials.run_walk import WalkRun, run_walk, walk_flaws
from ..kernel_cache import is_compiled
from ..planning.planners import plan_task
from ..planning.problem.plan import Plan
from ..planning.progress import Moment, Routing, progress_text
from ..tasks import Task
from ..viewing.browser.labour import Tell

TOLD: Final = 0.2
"""Between two words of progress [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Planned:
    """What came of planning."""

    plan: Plan | None
    words: str
    """What was found, or why nothing was."""


def make_plan(task: Task, planner: str, seconds: float, tell: Tell, *, reserves: bool) -> Planned:
    """Plan a task.

    Args:
        task: What is to be done.
        planner: By name.
        seconds: Most time for each search [s].
        tell: Hears the progress.
        reserves: Whether the plan is to keep something back, so that it can be carried out; it takes longer.

    Raises:
        ClamberError: If the planner cannot work on the task, or the start violates a hard check.
    """
    tell(f"planning: looking for any plan{_unless_compiled(task)}")
    if reserves and isinstance(task, WalkerTask):
        task = careful(task)
    result = plan_task(task, planner, seed=0, seconds=seconds, progress=_Listener(tell))
    if not result.has_plan:
        return Planned(None, f"{result.status}: no plan. {result.reason}")
    words = f"{result.status}: {result.length} actions, {result.seconds:.1f} s. {result.reason}"
    if not reserves or not isinstance(task, LimbedTask):
        return Planned(result.plan, words)
    tell(f"a plan of {result.length} actions; now one that keeps reserves")
    strict = climbing_task(task)
    flaws = climbing_flaws(strict, ())

    def rehearsed(task: LimbedTask, plan: Plan) -> Rehearsal:
        tell(f"rehearsing a plan of {len(plan.actions)} actions in simulation")
        return rehearse(task, plan, flaws)

    found = plan_to_climb(strict, planner, seconds=seconds, seed=0, rehearse=rehearsed)
    if found is None:
        return Planned(
            None,
            f"there is a plan of {result.length} actions, but none that keeps reserves for a run, or that hooks can be trusted with",
        )
    return Planned(found, f"found: {len(found.actions)} actions, with reserves for a run")


def carry_out(task: Task | Walk, plan: Plan | None, tell: Tell) -> ClimbRun | WalkRun:
    """Carry a plan out in contact dynamics, or a walk, which needs none.

    Raises:
        ClamberError: If something speaks against the plan.
    """
    tell(f"making the robot ready{_unless_compiled(task)}")

    def walked(step: int, way: float, whole: float) -> None:
        tell(f"step {step}: {way:.2f} of {whole:.2f} m", way / whole if whole > 0.0 else None)

    if isinstance(task, Walk):
        return run_walk(task, walk_flaws(task, ()), progress=walked)
    assert plan is not None  # of a task
    if isinstance(task, WalkerTask):
        walk, lay = walk_of(task), lay_plan(task, plan)
        return run_walk(walk, walk_flaws(walk, ()), lay=lay, progress=walked)
    strict = climbing_task(task)

    def climbed(step: int, steps: int, title: str, clock: float) -> None:
        tell(f"action {step} of {steps}: {title}, {clock:.0f} s on the robot's clock", (step - 1) / max(steps, 1))

    again = replanner("auto", seconds=60.0, seed=0)
    return run_plan(strict, plan, climbing_flaws(strict, ()), replan=again, progress=climbed)


def _unless_compiled(task: Task | Walk) -> str:
    """What to add where no such robot has moved on this machine: its kernels are compiled, and nothing is told meanwhile."""
    moves = "command_tick" if isinstance(task, LimbedTask) else "level_heights"
    return "" if is_compiled(moves) else "; kernels are compiled, once, which takes a minute or two"


def outcome(run: ClimbRun | WalkRun) -> tuple[bool, str]:
    """Whether a run came to its end, and how it went, in words."""
    if isinstance(run, ClimbRun):
        report = run.report
        count = len(report.actions)
        if report.done:
            return True, f"climbed: {count} actions in {report.seconds:.0f} s, {run.wall_seconds:.1f} s to compute"
        return False, f"not climbed: {report.reason}"
    if run.done:
        return (
            True,
            f"walked: {len(run.report.steps)} steps in {run.report.seconds:.0f} s, {run.wall_seconds:.1f} s to compute",
        )
    return False, f"not walked: {run.reason}"


class _Listener:
    """Passes a search's progress on, now and then."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._last = tell, time.monotonic()

    def __call__(self, moment: Moment) -> None:
        now = time.monotonic()
        if now - self._last < TOLD:
            return
        self._last = now
        self._tell(progress_text(moment), moment.share if isinstance(moment, Routing) else None)
