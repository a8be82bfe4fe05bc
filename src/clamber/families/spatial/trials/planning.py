"""Plans of robots in space that are made to be carried out: with more in reserve, before a run and on the way."""

from contextlib import suppress
from dataclasses import replace
from typing import Any, Final

from ....errors import SpecError, StartError
from ....interrupts import passed_on
from ....planning.auto import choose
from ....planning.planners import accepts
from ....planning.problem.plan import Plan
from ....planning.problem.problems import pose_problem
from ....planning.problem.verdict import check_plan
from ....trials.dynamics import Conditions, NoPlanError, RunEvents, plan_to_run, search_to_run
from ..control.laws import USUAL
from ..execution.carrying import Replan
from ..planning.task import SpatialTask
from .run_plan import Control, run_plan

RESERVES: Final = {0.3: (1,), 0.24: (8,), 0.2: (1, 4), 0.15: (1,)}
"""Of all strengths and torques that plans keep which are made to be carried out, the first that can be had [-] -> how many times as wide
as usual it is looked for, one after the other.

Holds that bear a fifth less under a robot that weighs a tenth more take 27 %, under one that weighs a twentieth more 24 %; holds alone
take 20 %. Where little room is left a wide search finds what several times as long a narrow one does not.
"""
ROOM: Final = 0.005
"""From surfaces, of links and base: plans that come nearer are rehearsed, as what carries them out is some millimetres off [m]."""


def careful(task: SpatialTask, reserve: float = max(RESERVES)) -> SpatialTask:
    """The task with more in reserve, so that its plans can be carried out where holds, masses and motors are not as believed."""
    return replace(task, rules=replace(task.rules, need=max(task.rules.need, reserve)))


def roomy(task: SpatialTask) -> SpatialTask:
    """The task with `ROOM` to keep from surfaces."""
    return replace(task, rules=replace(task.rules, clearance=max(task.rules.clearance, ROOM)))


def found_plan(task: SpatialTask, asked: Conditions, events: RunEvents, seed: int, *, rehearsed: bool = True) -> Plan:
    """A plan with more in reserve than the task asks for; where there is none, one as the task asks for.

    More in reserve is looked for by the planner that `auto` tries first alone, and briefly: that there is none is known only when all have
    searched as long as they may, which took minutes. Where a plan is to be `rehearsed`, comes nearer to a surface than `ROOM` and to no
    end, ones that keep `ROOM` are looked for and rehearsed, with as much in reserve and then with less; where none comes to its end,
    the first is taken.

    Raises:
        NoPlanError: If there is none of that kind either.
        SpecError: If the start breaks a rule.
    """
    problem = pose_problem(task).problem
    quick = choose(problem).planners[0] if asked.planner == "auto" else asked.planner
    failed: list[Plan] = []  # in a rehearsal

    def found(wary: SpatialTask, **options: Any) -> Plan | None:
        with suppress(SpecError):  # the start itself has less in reserve, or is nearer
            result = search_to_run(roomy(wary) if failed else wary, quick, asked, events, seed, **options)
            return result.plan if result.has_plan else None
        return None

    for reserve, widths in RESERVES.items():
        if reserve <= task.rules.need:
            break
        wary = careful(task, reserve)
        for wider in widths if accepts(quick, "width") else (0,):
            options = {"width": wider * problem.beam.width} if wider else {}
            plan = found(wary, **options)
            if plan is not None and not failed and rehearsed and not _goes_well(task, plan, asked, events):
                failed.append(plan)
                plan = found(wary, **options)
            if plan is None or any(plan.actions == other.actions for other in failed):
                continue
            if not failed or _comes_to_its_end(task, plan, asked, events):
                return plan
            failed.append(plan)
        if not failed:
            events.note(f"no plan keeps {100 * reserve:.0f} % of all strengths in reserve; one with less is looked for")
    if failed:
        return failed[0]
    return plan_to_run(task, asked, events, seed, "was found")


def _goes_well(task: SpatialTask, plan: Plan, asked: Conditions, events: RunEvents) -> bool:
    """Whether a plan keeps `ROOM` from surfaces all along, or comes to its end in a rehearsal."""
    with suppress(SpecError, StartError):  # the start itself is nearer: rehearsed, too
        if check_plan(roomy(task), plan).ok:
            return True
    events.note(f"the plan comes nearer than {1e3 * ROOM:g} mm to a surface")
    return _comes_to_its_end(task, plan, asked, events)


def _comes_to_its_end(task: SpatialTask, plan: Plan, asked: Conditions, events: RunEvents) -> bool:
    """Whether a plan does so in a rehearsal without noise."""
    events.note("the plan is rehearsed")
    with passed_on():  # Ctrl-C ends the command, not this run alone
        run = run_plan(task, plan, control=Control(law=asked.law or USUAL))
    if not run.done:
        events.note(f"it does not come to its end ({run.reason}); another is looked for")
    return run.done


def replanner(asked: Conditions, events: RunEvents, seed: int) -> Replan | None:
    """What a run asks for another plan; None: none is made."""
    if not asked.replan:
        return None

    def replan(task: SpatialTask) -> Plan | None:
        events.note("planning again from where the robot is, without what cannot be had")
        try:
            return found_plan(task, asked, events, seed, rehearsed=False)
        except (NoPlanError, SpecError):  # none, or where it stands now breaks a rule of its plans
            return None

    return replan
