"""`clamber run` of a climber's task or plan: plan it if need be, and climb it."""

from collections.abc import Callable

import typer

from ...families.climber.planning.task import LimbedTask
from ...families.climber.trials.noise import NO_NOISE, check_noise, read_noise
from ...families.climber.trials.planning import plan_to_climb, replanner
from ...families.climber.trials.plants import check_plant, is_remote
from ...families.climber.trials.rehearsal import rehearse
from ...families.climber.trials.run_plan import climbing_flaws, open_climb, run_plan
from ...planning.planners import find_planner
from ...planning.problem.plan import Plan
from ...sim.limb_flaws import LimbFlaws
from ...viewing.pictures import check_run_suffix, draw_run
from ..compile_ahead import CLIMBING, compile_ahead
from ..output import announce_compilation, print_json, stderr, stdout, tell_cuts
from .options import RunOptions
from .report import RunReport
from .text import ClimbLine, print_run


def run_climb(what: str, words: RunOptions, telling: RunReport) -> None:
    """Carry a plan out and say how it went; leaves with 1 where there is no plan, or where it did not come to its end.

    Args:
        what: The task's or plan's name or file.
        words: How.
        telling: Its report, if one is asked for.
    """
    check_plant(words.plant)
    for file in words.outputs:
        check_run_suffix(file)
    telling.open("climb")
    find_planner(words.planner)
    peg_error = () if words.peg_error is None else (f"peg_error={words.peg_error}",)
    deviations = read_noise(NO_NOISE, [*(words.noise or ()), *peg_error])
    announce_compilation(quiet=words.quiet)
    compile_ahead(CLIMBING)
    task, plan, for_plant = open_climb(what, words.task, words.overrides or ())
    if for_plant and is_remote(words.plant):
        raise typer.BadParameter(f"{for_plant[0].partition('=')[0]} is the server's to set", param_hint="--set plant.")
    flaws = climbing_flaws(task, for_plant)
    check_noise(deviations, task.robot, flaws)
    cuts: list[None] = []

    def cut() -> None:
        cuts.append(None)

    if plan is None:
        plan = _plan(task, flaws, words, cut)
    if plan is None:
        tell_cuts(len(cuts))
        stderr().print(f"no plan for '{task.name}' that hooks can be trusted with; nothing has moved")
        raise typer.Exit(1)
    again = replanner(words.planner, seconds=words.seconds, seed=words.seed, cut=cut) if words.replan else None
    if words.save_plan is not None:
        plan.save(words.save_plan)
    with ClimbLine(stderr(), quiet=words.quiet) as line:
        run = run_plan(
            task, plan, flaws, noise=deviations, seed=words.seed, force=words.force, replan=again, progress=line.update,
            label=what, log=words.log(line.say), plant=words.plant,
        )  # fmt: skip
    tell_cuts(len(cuts))
    for file in words.outputs:
        if file != words.growing:
            draw_run(run, file)
    page = telling.of(run, run.plan)
    if words.as_json:
        print_json(run)
    else:
        print_run(stdout(), run, (*words.written(run.log_gap), *page))
    raise typer.Exit(130 if run.report.reason == "interrupted" else 0 if run.report.done else 1)


def _plan(task: LimbedTask, flaws: LimbFlaws, words: RunOptions, cut: Callable[[], None]) -> Plan | None:
    return plan_to_climb(
        task,
        words.planner,
        seconds=words.seconds,
        seed=words.seed,
        cut=cut,
        rehearse=lambda task, plan: rehearse(task, plan, flaws),
    )
