"""Climbs in contact dynamics: one, and many under model error."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import numpy as np

from ...errors import SpecError
from ...execution.fault import FAULTS, check_faults
from ...json_form import INLINE
from ...planning.problem.plan import Plan
from ...planning.problem.problems import plan_family
from ...tasks.imported import PlaneClimb
from ...tasks.robots import load_robot, robot_names
from ...trials.dynamics import Conditions, Dynamics, NoPlanError, RunEvents, RunRequest, TrialsRequest
from .execution.body_gains import MOST_LIMBS, unfit
from .execution.executable_plan import climbable, objections_to
from .planning.task import LimbedTask
from .robot.robot import LimbedRobot
from .sim.climber_model import boxed_climber
from .trajectories import climb_stances
from .trials.noise import Noise, check_noise
from .trials.planning import no_plan, plan_to_climb, replanner, validations
from .trials.plants import check_plant, is_remote
from .trials.run_plan import ClimbRun, action_told, climbing_flaws, climbing_task, run_plan
from .trials.trial import ClimbTrial, ClimbTrials, TrialSetup, with_plan
from .trials.trial_summary import TrialSummary, sum_up
from .trials.warm_up import CLIMBING

if TYPE_CHECKING:
    from rich.console import Console


@dataclass(frozen=True, slots=True)
class TrialedClimb:
    """Many climbs of one plan."""

    summary: Annotated[TrialSummary, INLINE]
    held_out: bool
    """Whether all seeds are held out: none that any tuning may use."""
    trials: list[ClimbTrial]


@dataclass(frozen=True, slots=True)
class ReplayedClimb:
    """`--replay SEED`: one climb of the trials again."""

    run: Annotated[ClimbRun, INLINE]
    trial: ClimbTrial


class ClimberDynamics(Dynamics):
    """Climbs on a plant with flaws, pegs that are not where the map says."""

    kind = "climb"
    past = "climbed"
    replayed = ReplayedClimb
    compiled = (CLIMBING,)

    def unused(self, work: LimbedTask) -> frozenset[str]:
        """Laws of a whole body in space."""
        return frozenset({"law", "against_law"})

    def check(self, work: LimbedTask, asked: Conditions) -> None:
        """Plant, noise and faults."""
        flaws = climbing_flaws(climbing_task(work), asked.plant)
        if isinstance(asked, RunRequest):
            check_plant(asked.motors)
            if asked.plant and is_remote(asked.motors):
                key, _, value = asked.plant[0].partition("=")
                raise SpecError("--set", f"plant.{key}", value, "is the plant server's to set")
        if isinstance(asked, TrialsRequest):
            check_faults(asked.faults, tuple(FAULTS))
        check_noise(Noise.of(asked.noise_set, asked.noise), work.robot, flaws)

    def plan(self, task: LimbedTask, asked: RunRequest, events: RunEvents) -> Plan:
        """Found with something kept back, and rehearsed."""
        task = climbing_task(task)
        why = None if asked.force else unfit(task.robot)
        if why is not None:
            raise NoPlanError(asked.planner, task.name, f"can be carried out: {why}")
        flaws = climbing_flaws(task, asked.plant)

        plan = plan_to_climb(task, asked.planner, validate_plan=validations(flaws, events), **_search(asked, events))
        if plan is None:
            raise no_plan(asked.planner, task)
        return plan

    def unfit(self, task: LimbedTask) -> str | None:
        """Motors weaker than control asks for, or limbs that it does not know."""
        return unfit(task.robot)

    def untried(self, task: LimbedTask) -> str | None:
        """Robots other than those that come with Clamber and are fit for this control: it is tried with them."""
        shipped = map(load_robot, robot_names(LimbedRobot.family))
        tried = [robot for robot in shipped if isinstance(robot, LimbedRobot) and unfit(robot) is None]
        if task.robot in tried:
            return None
        return (
            f"'{task.robot.name}' is none of the robots with which climbs are tried ({', '.join(r.name for r in tried)}, as they come), "
            "so that it may not climb; docs/own-robot.md says which robots do"
        )

    def in_plane(self, task: LimbedTask) -> PlaneClimb | None:
        """That of limbs that grip, four or more, so that one may swing while the others hold the robot to its wall.

        Holds that bear in some directions alone are left out.
        """
        robot, start, limbs = task.robot, task.start, task.robot.limbs
        boxes = all(goal.region is None and not goal.holds and goal.turns is None for goal in task.goals)
        holds = [hold for hold in task.world.holds if hold.direction is None]
        if not (boxes and robot.grips and len(limbs) > MOST_LIMBS and holds) or task.world.keep_out:
            return None
        places = {hold.number: k for k, hold in enumerate(holds, start=1)}
        held = {limb: places[hold] for limb, hold in start.holds.items() if hold in places}
        joints = climb_stances(task, plan_family(task).problem(task).replay(())).positions[0].reshape(-1, 2)
        openings = [limb.end.opening for limb in limbs if limb.end.opening is not None]
        strengths = [limb.end.strength for limb in limbs if limb.end.strength is not None]
        return PlaneClimb(
            name=task.name,
            title=task.title,
            robot=robot.name,
            wall=task.world.name,
            model=boxed_climber(robot),
            limbs={limb.name: tuple(joints[i].tolist()) for i, limb in enumerate(limbs)},
            speed=min(map(robot.no_load_speed_of, robot.joints)),
            weight=robot.weight,
            opening=min(openings, default=None),
            strength=min(strengths, default=None),
            holds=np.array([(hold.x, hold.y) for hold in holds]),
            strengths=np.array([hold.strength or math.inf for hold in holds]),
            radius=max(hold.radius for hold in holds),
            start=(start.x, start.y, start.theta),
            held=held if len(held) == len(limbs) else None,
            length=task.step.length,
            angle=task.step.angle,
            goals=task.goals,
        )

    def objection(self, task: LimbedTask, plan: Plan, label: str = "plan") -> str | None:
        """By the task under the rules that can be carried out."""
        found = objections_to(climbable(task), plan, label)
        return found[0].in_words if found else None

    def run(
        self, work: LimbedTask, plan: Plan | None, asked: RunRequest, events: RunEvents, label: str = "plan"
    ) -> ClimbRun:
        """One climb."""
        task = climbing_task(work)
        flaws = climbing_flaws(task, asked.plant)
        if plan is None:
            plan = self.plan(task, asked, events)
            events.planned(plan)
        _refuse_unfit(task, asked)
        search = replanner(asked.planner, **_search(asked, events))

        def planned_again(task: LimbedTask) -> Plan | None:
            events.note("planning again from where the robot is, as a hold cannot be had")
            return search(task)

        return run_plan(
            task,
            plan,
            flaws,
            noise=Noise.of(asked.noise_set, asked.noise),
            seed=asked.seed,
            force=asked.force,
            replan=planned_again if asked.replan else None,
            progress=lambda *action: events.step(*action_told(*action)),
            label=label,
            log=asked.log,
            plant=asked.motors,
        )

    def print_run(self, console: "Console", run: ClimbRun) -> None:
        """How it ended, a row for each kind of action."""
        from .pictures.climb_text import print_run

        print_run(console, run)

    def trials(
        self,
        work: LimbedTask,
        plan: Plan | None,
        asked: TrialsRequest,
        events: RunEvents,
        store: Path | None = None,
        label: str = "plan",
    ) -> TrialSetup:
        """What all climbs have in common."""
        _refuse_unfit(work, asked)
        setup = TrialSetup(
            task=climbing_task(work),
            noise=Noise.of(asked.noise_set, asked.noise),
            plan=plan,
            plant=asked.plant,
            planner=asked.planner,
            seconds=asked.plan_seconds,
            replan=asked.replan,
            force=asked.force,
            faults=asked.faults,
        )
        return with_plan(setup, store, label, events)

    def trials_json(self, trials: ClimbTrials, held_out: bool) -> TrialedClimb:
        """Summary and trials."""
        return TrialedClimb(sum_up(trials), held_out, trials.ended)

    def print_trials(self, console: "Console", trials: ClimbTrials, seeds: Sequence[int]) -> None:
        """Success, causes, times, and what of the noise matters."""
        from ...shown_units import units_of
        from .pictures.climb_text import print_trials

        print_trials(console, sum_up(trials), seeds, units_of(trials.setup.task.document))

    def check_picture(self, file: Path) -> None:
        """A picture."""
        from ...viewing.output import CANVASES, check_suffix

        check_suffix(file, CANVASES)

    def draw_trials(self, trials: ClimbTrials, file: Path) -> None:
        """Success over what was drawn."""
        from ...shown_units import units_of
        from .pictures.charts import draw_trials

        draw_trials(sum_up(trials), file, units_of(trials.setup.task.document))


def _refuse_unfit(task: LimbedTask, asked: Conditions) -> None:
    why = None if asked.force else unfit(task.robot)
    if why is not None:
        raise SpecError(f"task '{task.name}'", "robot", task.robot.name, f"{why}; nothing has moved (--force tries it)")


def _search(asked: RunRequest, events: RunEvents) -> dict[str, Any]:
    """What every search for a plan is given."""
    return {"seconds": asked.plan_seconds, "seed": asked.seed, "events": events}


DYNAMICS: Final = ClimberDynamics()
