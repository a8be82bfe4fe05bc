"""Figures 4.15 and 4.16: the gait as it is carried out, and x and y of the body over two rungs of the ladder."""

from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from ...actions.limbed_plans import thesis_code
from ...actions.plan import Plan
from ...execution.climb.course import climbable
from ...experiments.climb.run_plan import ClimbRun, climbing_flaws, run_plan
from ...tasks import load_task
from ...tasks.limbed import LimbedTask
from ...units import INCH
from ..result import Compared, Figure, StudyResult, Table, Value
from . import PAPER
from .body_entries import PLANT
from .nominal_gait import GAIT

MILLI: Final = 1e3


def gait_plan(task: LimbedTask, rungs: int) -> Plan:
    """The gait with the pegs of each rung: leg 3 to the lower right where leg 1 climbs, to the lower left where leg 2 does.

    Args:
        task: The ladder, under the rules that can be carried out.
        rungs: How many, each two steps of the body.
    """
    numbers: list[int] = []
    for k in range(rungs):
        low = 2 * k
        start = () if k == 0 else (300 + low + 2,)
        numbers += [*start, 100 + low + 6, 300 + low + 1, 200 + low + 5, 300, 3, 3]
    return Plan.of_codes(task, [thesis_code(task, number) for number in numbers], planner="by hand")


@cache
def climbed(rungs: int) -> ClimbRun:
    """That gait, carried out."""
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    return run_plan(strict, gait_plan(strict, rungs), climbing_flaws(strict, ()))


def show_gait() -> StudyResult:
    """One rung, action by action."""
    run = climbed(2)
    actions = run.report.actions
    sides = _elbows(run)
    first = [action for action in actions if action.first > 6]

    def stages(path: Path) -> None:
        from ...viewing.climb_stages import draw_stages

        draw_stages(run, path)

    return StudyResult(
        paper=PAPER,
        result="fig-4-15",
        claim="Figure 4.15, section 4.5: LIBRA climbs by the gait 191, 392, 291, 300, 3 of the action module planner; leg 3 switches "
        "its elbow as "
        "it changes sides, and follows the body once it has let go.",
        verdict="differs" if not run.report.done else "holds" if " " in sides else "open",
        compared=(
            Compared("actions carried out", sum(action.outcome == "ok" for action in actions)),
            Compared("actions in the plan", len(actions)),
            Compared("modules of the gait", " ".join(map(str, GAIT)), " ".join(map(str, GAIT))),
            *(Compared(f"{action.title}: time [s]", action.seconds) for action in first),
            Compared("sides of leg 3's elbow that it holds with", sides),
        ),
        deviations=(
            *PLANT,
            "Modules 191, 392, 291 name pegs by where they are; ours are grabbed in the order right, bottom to the left, left, bottom "
            "off, body up, with leg 3 on the lower right before leg 1 moves, for a swing needs two other legs on pegs (the planner's "
            "model lets leg 3 hang in the air then, see `nominal-gait`). One module 003 is 3 in, so there are two a rung.",
            "Which side an elbow takes is chosen for a whole stay by what hooks and motors can then bear, with few changes; the thesis "
            "switches leg 3's with its side, so that its hook is on top. The verdict is open where the gait is climbed and leg 3 keeps "
            "one side.",
            "2 deg of backlash, 400 counts, pegs where the map says; the robot's own control at its defaults.",
        ),
        table=Table(
            ("actions", "kind", "what", "outcome", "start [s]", "time [s]"),
            tuple((f"{a.first}-{a.last}", a.kind, a.title, a.outcome, a.start, a.seconds) for a in actions),
        ),
        figures=(Figure("stages", "The robot at the end of each action, from the simulation's own state.", stages),),
    )


def _elbows(run: ClimbRun) -> str:
    """Signs of leg 3's elbow angle while it is on a peg, in order."""
    trace, leg = run.trace, len(run.trace.limbs) - 1
    held = trace.holds[:, leg] > 0
    signs = np.sign(trace.angles[held, leg, 1])
    changes = [signs[0], *signs[1:][np.diff(signs) != 0]] if held.any() else []
    return " ".join(f"{sign:+.0f}" for sign in changes)


def climb_two_steps() -> StudyResult:
    """Body x and y over time, with the actions' numbers."""
    run = climbed(2)
    trace = run.trace
    assert trace.true_pose is not None
    still = trace.step > 0
    off = (trace.true_pose - trace.aim)[still]
    rise = float(trace.true_pose[-1, 1] - trace.true_pose[0, 1])
    told = float(trace.aim[-1, 1] - trace.aim[0, 1])

    def times(path: Path) -> None:
        from ...viewing.climb_stages import draw_body_over_time

        draw_body_over_time(run, path)

    x, y = np.abs(off[:, 0]) * MILLI, np.abs(off[:, 1]) * MILLI
    held = [action for action in run.report.actions if action.kind != "move"]
    sways = [_sway(run, action.start, action.start + action.seconds) for action in held]
    rows: list[tuple[Value, ...]] = [
        (f"{a.first}-{a.last}", a.title, *(round(value, 2) for value in sway))
        for a, sway in zip(held, sways, strict=True)
    ]
    return StudyResult(
        paper=PAPER,
        result="fig-4-16",
        claim="Figure 4.16, section 4.5: over two steps of the ladder the body follows its path; where it is to hold still there are "
        "errors as "
        "legs pull away from pegs and grab new ones, for the body is compliant so that hooks never leave the pegs.",
        verdict="holds" if run.report.done and max(sway[1] for sway in sways) > 0.5 else "differs",
        compared=(
            Compared("rise of the body [in]", rise / INCH, told / INCH),
            Compared("time of two rungs [s]", run.report.actions[-1].start + run.report.actions[-1].seconds),
            Compared("x off its aim, RMS [mm]", float(np.sqrt(np.mean(x**2)))),
            Compared("x off its aim, largest [mm]", float(x.max())),
            Compared("y off its aim, RMS [mm]", float(np.sqrt(np.mean(y**2)))),
            Compared("y off its aim, largest [mm]", float(y.max())),
            Compared("body holding still while a leg grabs: x moves by at most [mm]", max(sway[0] for sway in sways)),
            Compared("body holding still while a leg grabs: y moves by at most [mm]", max(sway[1] for sway in sways)),
        ),
        deviations=(
            *PLANT,
            "The figure's curves are not printed as numbers, so what is compared is what the text says of them; the printed rise is "
            "that of the aim. Two steps are read as two rungs of 6 in, each two modules 003.",
            "2 deg of backlash, 400 counts, pegs where the map says; the robot's own control at its defaults, not Table 4.1's.",
        ),
        table=Table(("actions", "what", "x moves [mm]", "y moves [mm]"), tuple(rows)),
        figures=(
            Figure("times", "Body x and y, as they are and as aimed at; numbers are those of the actions.", times),
        ),
    )


def _sway(run: ClimbRun, start: float, end: float) -> tuple[float, float]:
    """How far the body moves to and fro less its aim between two times [mm]."""
    trace = run.trace
    assert trace.true_pose is not None
    during = (trace.time >= start) & (trace.time <= end)
    off = (trace.true_pose - trace.aim)[during]
    return float(np.ptp(off[:, 0])) * MILLI, float(np.ptp(off[:, 1])) * MILLI
