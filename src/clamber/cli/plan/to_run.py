"""`clamber plan --to-run`: the plan by which `clamber run` would carry the task out."""

from dataclasses import replace
from typing import Final

import typer

from ...family import family_of
from ...planning.problem.verdict import check_plan
from ...planning.progress import Clock, progress_text
from ...planning.result import PlanResult
from ...tasks import Task
from ...terminal.compile_ahead import compile_ahead
from ...terminal.live_line import LiveLine
from ...terminal.output import refuse_unused, stderr, tell_cuts
from ...trials.dynamics import NoPlanError, RunEvents, RunRequest
from ...trials.work import dynamics_of, fit_family
from .options import PlanOptions

TAKEN: Final = frozenset({"to_run", "planner", "overrides", "seed", "seconds", "output", "as_json", "quiet"})
"""Options that it takes."""


def plan_to_run(task: Task, words: PlanOptions) -> PlanResult:
    """Plan as `run` plans for itself; the answer counts neither plans nor actions.

    Raises:
        Exit: With 1, if there is no such plan; it says why.
        NotOfFamilyError: If the robots of the task's family are never carried out.
        BadParameter: If an option is given that has no meaning here.
    """
    family, task, note = fit_family(family_of(task), task)
    dynamics, clock = dynamics_of(family), Clock()
    unused = PlanOptions.__dataclass_fields__.keys() - TAKEN
    refuse_unused(words, unused, "--to-run plans as `clamber run` does")
    asked = RunRequest(planner=words.chosen, seed=words.seed)
    asked = asked if words.seconds is None else replace(asked, plan_seconds=words.seconds)
    dynamics.check(task, asked)
    compile_ahead(*dynamics.compiled)
    cuts: list[None] = []
    with LiveLine(stderr(), quiet=words.quiet, doing="preparing the search") as line:
        if note and not words.quiet:
            line.say(note)
        events = RunEvents(
            search=lambda moment: line.show(progress_text(moment)),
            cut=lambda: cuts.append(None),
            note=lambda told: None if words.quiet else line.say(told),
            step=line.show,
        )
        try:
            plan = dynamics.plan(task, asked, events)
        except NoPlanError as none:
            line.say(str(none))
            raise typer.Exit(1) from None
    tell_cuts(len(cuts))
    solved = plan.rebuild_task()
    return PlanResult(
        status="found",
        task=solved,
        reason=f"made to be run: with room for what happens in a {dynamics.kind}",
        plan=plan,
        max_torque=check_plan(solved, plan).max_torque,
        evaluations=0,
        checks=0,
        seconds=clock.spent,
        seed=words.seed,
        planner=plan.planner or words.chosen,
    )
