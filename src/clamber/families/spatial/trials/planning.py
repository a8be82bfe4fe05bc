"""Plans of robots in space that are made to be carried out: with more in reserve, before a run and on the way."""

from contextlib import suppress
from dataclasses import replace
from typing import Final

from ....errors import SpecError
from ....planning.auto import choose
from ....planning.planners import accepts
from ....planning.problem.plan import Plan
from ....planning.problem.problems import pose_problem
from ....trials.dynamics import Conditions, NoPlanError, RunEvents, search_to_run
from ..execution.carrying import Replan
from ..planning.task import SpatialTask

RESERVES: Final = {0.3: (1,), 0.24: (8,), 0.2: (1, 4), 0.15: (1,)}
"""Of all strengths and torques that plans keep which are made to be carried out, the first that can be had [-] -> how many times as wide
as usual it is looked for, one after the other.

Holds that bear a fifth less under a robot that weighs a tenth more take 27 %, under one that weighs a twentieth more 24 %; holds alone
take 20 %. Where little room is left a wide search finds what several times as long a narrow one does not.
"""


def careful(task: SpatialTask, reserve: float = max(RESERVES)) -> SpatialTask:
    """The task with more in reserve, so that its plans can be carried out where holds, masses and motors are not as believed."""
    return replace(task, rules=replace(task.rules, need=max(task.rules.need, reserve)))


def found_plan(task: SpatialTask, asked: Conditions, events: RunEvents, seed: int) -> Plan:
    """A plan with more in reserve than the task asks for; where there is none, one as the task asks for.

    More in reserve is looked for by the planner that `auto` tries first alone, and briefly: that there is none is known only when all have
    searched as long as they may, which took minutes.

    Raises:
        NoPlanError: If there is none of that kind either.
        SpecError: If the start breaks a rule.
    """
    problem = pose_problem(task).problem
    quick = choose(problem).planners[0] if asked.planner == "auto" else asked.planner
    for reserve, widths in RESERVES.items():
        if reserve <= task.rules.need:
            break
        for wider in widths if accepts(quick, "width") else (0,):
            with suppress(SpecError):  # the start itself has less in reserve
                options = {"width": wider * problem.beam.width} if wider else {}
                result = search_to_run(careful(task, reserve), quick, asked, events, seed, **options)
                if result.has_plan:
                    return result.plan
        events.note(f"no plan keeps {100 * reserve:.0f} % of all strengths in reserve; one with less is looked for")
    result = search_to_run(task, asked.planner, asked, events, seed)
    if result.has_plan:
        return result.plan
    raise NoPlanError(asked.planner, task.name, f"was found: {result.reason}")


def replanner(asked: Conditions, events: RunEvents, seed: int) -> Replan | None:
    """What a run asks for another plan; None: none is made."""
    if not asked.replan:
        return None

    def replan(task: SpatialTask) -> Plan | None:
        events.note("planning again from where the robot is, as a hold cannot be had")
        try:
            return found_plan(task, asked, events, seed)
        except (NoPlanError, SpecError):  # none, or where it stands now breaks a rule of its plans
            return None

    return replan
