"""Plans of robots in space in contact dynamics."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

from ...errors import SpecError
from ...planning.planners import plan_task
from ...planning.problem.plan import Plan
from ...trials.dynamics import NoPlanError, RunEvents, RunRequest
from ...trials.plain_dynamics import PlainDynamics
from .execution.carrying_report import CarryingReport
from .planning.task import SpatialTask
from .trials.run_plan import SpatialRun, run_plan

if TYPE_CHECKING:
    from rich.console import Console


class SpatialDynamics(PlainDynamics):
    """Climbs and walks of robots in space."""

    kind = "run"
    past = "carried out"

    def simulate(
        self, task: SpatialTask, plan: Plan, drawn: Mapping[str, float], step: Callable[[str, float | None], None]
    ) -> CarryingReport:
        """See `PlainDynamics`: nothing deviates yet."""
        return run_plan(task, plan).report

    def plan(self, task: SpatialTask, asked: RunRequest, events: RunEvents) -> Plan:
        """As any plan of the task: what is simulated keeps to its checks."""
        result = plan_task(task, asked.planner, seed=asked.seed, seconds=asked.plan_seconds, progress=events.search)
        if not result.has_plan:
            raise NoPlanError(asked.planner, task.name, f"was found: {result.reason}")
        return result.plan

    def run(  # type: ignore[override]
        self, work: SpatialTask, plan: Plan | None, asked: RunRequest, events: RunEvents, label: str = "plan"
    ) -> SpatialRun:
        """One plan carried out."""
        if plan is None:
            plan = self.plan(work, asked, events)
            events.planned(plan)
        elif not asked.force and (against := self.objection(work, plan, label)) is not None:
            raise SpecError(label, "actions", against, "nothing has moved")

        def told(action: int, of: int) -> None:
            events.step(f"action {action} of {of}", action / of)

        return run_plan(work, plan, progress=told, log=asked.log, label=label)

    def print_run(self, console: "Console", run: SpatialRun) -> None:  # type: ignore[override]
        """How it ended, and how near it kept to its plan."""
        report = run.report
        words = self.past if run.done else f"not {self.past}"
        console.print(f"{words}: '{run.task.name}'", style="bold green" if run.done else "bold red")
        if run.reason:
            console.print(run.reason)
        console.print(
            f"{len(run.plan.actions)} actions, {report.seconds:.1f} s in {run.wall_seconds:.1f} s; the body at most "
            f"{1e3 * report.off:.1f} mm off, torques at most {100 * report.torque:.0f} % of what may be used"
        )


DYNAMICS: Final = SpatialDynamics()
