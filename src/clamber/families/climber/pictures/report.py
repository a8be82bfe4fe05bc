"""A climb's report: the plan with its least margins, what became of every action, and where it was close."""

from typing import Final

import numpy as np

from ....planning.problem.problems import normalisation_of
from ....planning.problem.verdict import Verdict, check_plan
from ....units import DEGREE
from ....viewing.margins import named_limits
from ....viewing.report.run_page import MILLI, Rows, RunPage, most, plan_words
from ..execution.climb_report import ActionReport
from ..trials.run_plan import ClimbRun
from .artists import torque_limits

CHECKS_TOLD: Final = 3
"""Checks whose least margins are told, the tightest first."""
JOINTS: Final = ("shoulder", "elbow")


def climb_page(run: ClimbRun) -> RunPage:
    """What the report of a climb says."""
    verdict = check_plan(run.task, run.plan, go_on=True)
    report = run.report
    planned = [plan_words(run.plan, run.task.name)]
    if not verdict.ok and verdict.first_violation is not None:
        first = verdict.first_violation
        planned.append(f"The plan violates a hard check at step {first.step}: {first.reason}.")
    planned += [
        f"Planned again after action {note.after}: {note.length} actions, without {note.without}."
        for note in report.replans
    ]
    planned += [f"Forced in spite of {objection}." for objection in report.forced]
    return RunPage(
        kind="climb",
        facts=_facts(run),
        planned=tuple(planned),
        plan=_plan_rows(verdict, run),
        close=(*_margins(verdict, run), *_closest(run)),
        happened=_happened(report.actions),
        picture="The climb as it was: the way of the body, and the robot along it.",
        motion=".html",
        keeps_plan=True,
    )


def _facts(run: ClimbRun) -> tuple[tuple[str, str], ...]:
    report, notes = run.report, run.trace.notes or {}
    x, y, theta = report.pose if report.true_pose is None else report.true_pose
    return (
        ("Robot", run.task.robot.title or run.task.robot.name),
        ("Actions", str(sum(action.last - action.first + 1 for action in report.actions))),
        ("Time", f"{report.seconds:.1f} s"),
        ("Body at the end", f"x {x:.3f} m, y {y:.3f} m, {round(theta / DEGREE, 1) + 0.0:.1f} deg"),
        ("From the goal", f"{MILLI * report.short:.0f} mm"),
        (
            "Seed of the noise",
            str(notes.get("seed", 0)) if run.true_pegs is not None or _noisy(notes) else "none drawn",
        ),
    )


def _noisy(notes: dict[str, object]) -> bool:
    widths = notes.get("noise")
    return isinstance(widths, dict) and any(bool(width) for width in widths.values())


def _plan_rows(verdict: Verdict, run: ClimbRun) -> Rows:
    sticks, rows = normalisation_of(run.task), []
    for row in verdict.per_step:
        limits = named_limits(sticks, row.margins)
        rows.append((row.step, row.action.title, str(limits[0]) if limits else ""))
    return Rows(("Step", "Action", "Nearest limit"), tuple(rows))


def _margins(verdict: Verdict, run: ClimbRun) -> list[tuple[str, str, str]]:
    """The checks that the plan comes nearest to."""
    tightest, rows = verdict.tightest(), []
    least = {name: margin for name, (margin, _) in tightest.items()}
    for limit in named_limits(normalisation_of(run.task), least)[:CHECKS_TOLD]:
        step = tightest[limit.check.name][1]
        rows.append(("plan, least margin", str(limit), f"step {step}: {verdict.per_step[step - 1].action.title}"))
    return rows


def _closest(run: ClimbRun) -> list[tuple[str, str, str]]:
    """What the climb itself came near to."""
    actions = run.report.actions
    rows = []
    for action in actions:
        if action.outcome != "ok":
            rows.append((f"ended: {action.outcome}", action.reason, _where(action)))
        if action.recovered:
            rows.append(("a hook came off and was brought back", f"{action.recovered} times", _where(action)))
    pushed = [action for action in actions if action.kind == "grab" and action.tries > 1]
    rows += [("pushes of a hook", str(action.tries), _where(action)) for action in most(pushed, "tries")]
    rows += [("longest action", f"{action.seconds:.1f} s", _where(action)) for action in most(actions, "seconds")]
    moves = [action for action in actions if action.kind == "move"]
    rows += [("body from its aim", f"{MILLI * one.off:.1f} mm", _where(one)) for one in most(moves, "off")[:1]]
    told = [action for action in actions if action.tip_error is not None]
    rows += [
        ("tip, believed from true", f"{MILLI * (one.tip_error or 0.0):.1f} mm", _where(one))
        for one in most(told, "tip_error")[:1]
    ]
    return [*rows, *_hardest_joint(run)]


def _hardest_joint(run: ClimbRun) -> list[tuple[str, str, str]]:
    """The joint that was asked for most of what its motor gives, and how long any was asked for more than that."""
    trace = run.trace
    shares = np.abs(trace.torques) / torque_limits(run.task)
    if not shares.size:
        return []
    row, limb, joint = np.unravel_index(int(shares.argmax()), shares.shape)
    share, torque = float(shares[row, limb, joint]), float(abs(trace.torques[row, limb, joint]))
    where = f"{trace.limbs[limb]} {JOINTS[joint]}, at {trace.time[row]:.1f} s"
    rows = [("torque asked of a joint", f"{torque:.1f} N m, {100.0 * share:.0f} % of what its motor gives", where)]
    beyond = (shares > 1.0).any(axis=(1, 2))
    if beyond.any():
        rows.append(("a motor gave all it has", f"in {100.0 * float(beyond.mean()):.2g} % of the samples", "any joint"))
    return rows


def _where(action: ActionReport) -> str:
    return f"step {action.steps}: {action.title}"


def _happened(actions: list[ActionReport]) -> Rows:
    columns = (
        "Steps", "Action", "Outcome", "From [s]", "Took [s]", "Pushes", "Recovered", "Off [mm]", "Tip error [mm]", "Why",
    )  # fmt: skip
    rows = tuple(
        (
            one.steps,
            one.title,
            one.outcome,
            round(one.start, 1),
            round(one.seconds, 1),
            one.tries if one.kind == "grab" else None,
            one.recovered or None,
            round(MILLI * one.off, 1),
            None if one.tip_error is None else round(MILLI * one.tip_error, 1),
            one.reason,
        )
        for one in actions
    )
    return Rows(columns, rows)
