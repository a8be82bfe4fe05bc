"""Plans of robots in space in contact dynamics: one, and many under model error."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import (
    TYPE_CHECKING,
    Annotated,
    Final,
)

from ...errors import SpecError
from ...execution.fault import check_faults
from ...json_form import INLINE
from ...planning.problem.plan import Plan
from ...tasks.imported import PlaneClimb
from ...trials.dynamics import (
    Conditions,
    Dynamics,
    RunEvents,
    RunRequest,
    TrialsRequest,
)
from .control.laws import USUAL, body_law
from .execution.faulty_spatial import fault_kinds
from .planning.plane_climb import task_of
from .planning.task import SpatialTask
from .sim.spatial_flaws import read_spatial_flaws
from .trials.noise import SpatialNoise
from .trials.planning import found_plan, replanner
from .trials.run_plan import (
    Control,
    SpatialRun,
    run_plan,
)
from .trials.trials import (
    SpatialSetup,
    SpatialTrial,
    SpatialTrials,
)

if TYPE_CHECKING:
    from rich.console import Console
from .trials.warm_up import CARRYING


@dataclass(frozen=True, slots=True)
class TrialedRuns:
    """Many runs of a plan of a robot in space."""

    trials: Annotated[SpatialTrials, INLINE]
    held_out: bool
    """Whether all seeds are held out: none that any tuning may use."""


@dataclass(frozen=True, slots=True)
class ReplayedRun:
    """`--replay SEED`: one run of the trials again."""

    run: Annotated[SpatialRun, INLINE]
    trial: SpatialTrial


class SpatialDynamics(Dynamics):
    """Climbs and walks of robots in space."""

    kind = "run"
    past = "carried out"
    compiled = (CARRYING,)
    replayed = ReplayedRun

    def unused(self, work: SpatialTask) -> frozenset[str]:
        """Motors and servers, of which its plant knows none; its flaws are set with `--set plant.KEY`."""
        return frozenset({"plant"})

    def check(self, work: SpatialTask, asked: Conditions) -> None:
        """Plant, noise, law and faults."""
        body_law(asked.law or USUAL)
        read_spatial_flaws(asked.plant)
        SpatialNoise.of(asked.noise_set, asked.noise)
        if isinstance(asked, TrialsRequest):
            check_faults(asked.faults, fault_kinds(work.robot))

    def of_plane(self, climb: PlaneClimb) -> SpatialTask:
        """The same in the plane of a wall."""
        return task_of(climb)

    def plan(self, task: SpatialTask, asked: RunRequest, events: RunEvents) -> Plan:
        """Found with more in reserve than the checks ask for."""
        return found_plan(task, asked, events, asked.seed)

    def run(
        self, work: SpatialTask, plan: Plan | None, asked: RunRequest, events: RunEvents, label: str = "plan"
    ) -> SpatialRun:
        """One plan carried out."""
        plan = self._fit(work, plan, asked, events, asked.seed, label)
        noise = SpatialNoise.of(asked.noise_set, asked.noise)

        def told(action: int, of: int) -> None:
            events.step(f"action {action} of {of}", action / of)

        return run_plan(
            work,
            plan,
            flaws=noise.flaws(read_spatial_flaws(asked.plant, asked.seed), asked.seed),
            deviations=noise.deviations(work.robot, work.world, asked.seed) if noise.any else None,
            progress=told,
            log=asked.log,
            control=Control(asked.law or USUAL, replanner(asked, events, asked.seed)),
            label=label,
        )

    def _fit(
        self, task: SpatialTask, plan: Plan | None, asked: Conditions, events: RunEvents, seed: int, label: str
    ) -> Plan:
        """The plan if nothing speaks against it, or the one that is found, and told."""
        if plan is None:
            plan = found_plan(task, asked, events, seed)
            events.planned(plan)
        elif not asked.force and (against := self.objection(task, plan, label)) is not None:
            raise SpecError(label, "actions", against, "nothing has moved")
        return plan

    def print_run(self, console: "Console", run: SpatialRun) -> None:
        """How it ended, and how near it kept to its plan."""
        report = run.report
        words = self.past if run.done else f"not {self.past}"
        console.print(f"{words}: '{run.task.name}'", style="bold green" if run.done else "bold red")
        if run.reason:
            console.print(run.reason)
        console.print(
            f"{len(run.plan.actions)} actions, {report.seconds:.1f} s in {run.wall_seconds:.1f} s; the body at most "
            f"{1e3 * report.off:.1f} mm off, torques at most {100 * report.torque:.0f} % of the motors'"
        )

    def trials(
        self,
        work: SpatialTask,
        plan: Plan | None,
        asked: TrialsRequest,
        events: RunEvents,
        store: Path | None = None,
        label: str = "plan",
    ) -> SpatialSetup:
        """What all runs have in common."""
        setup = SpatialSetup(
            task=work,
            noise=SpatialNoise.of(asked.noise_set, asked.noise),
            plant=tuple(asked.plant),
            law=asked.law or USUAL,
            plan=plan,
            planned=plan is None,
            search=Conditions(planner=asked.planner, plan_seconds=asked.plan_seconds, replan=asked.replan),
            faults=asked.faults,
        )
        return replace(setup, plan=self._fit(work, plan or setup.stored_plan(store), asked, events, 0, label))

    def trials_json(self, trials: SpatialTrials, held_out: bool) -> TrialedRuns:
        """The trials and what they say together."""
        return TrialedRuns(trials, held_out)

    def print_trials(self, console: "Console", trials: SpatialTrials, seeds: Sequence[int]) -> None:
        """How often runs came to their end, and the spread of what is measured of them."""
        from .pictures.trials_text import print_spatial_trials

        print_spatial_trials(console, trials, seeds)


DYNAMICS: Final = SpatialDynamics()
