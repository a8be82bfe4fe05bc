"""A walk's report: its way or plan, what became of every step, and where it was close."""

import math

from ....units import DEGREE
from ....viewing.report.run_page import MILLI, MOST_TOLD, Rows, RunPage, most, plan_words
from ..execution.walk_report import StepReport, WalkReport
from ..planning.piece import Piece
from ..trials.run_walk import WalkRun


def walk_page(run: WalkRun) -> RunPage:
    """What the report of a walk says, which may have followed a plan."""
    plan = run.plan
    if plan is not None:
        planned = plan_words(plan, plan.task)
        rows = Rows(("Step", "Action"), tuple((k, one.title) for k, one in enumerate(plan.actions, start=1)))
    else:
        planned = f"The way: {'; '.join(map(piece_in_words, run.walk.way))}."
        rows = None
    return RunPage(
        kind="walk",
        facts=_facts(run),
        planned=(planned,),
        plan=rows,
        close=tuple(_closest(run)),
        happened=_happened(run.report.steps),
        picture="The walk as it was, from the side and from above.",
        motion=".gif",
    )


def piece_in_words(piece: Piece) -> str:
    """A piece of a way, such as "2.00 m at 0 deg"."""
    if piece.to is not None:
        facing = "" if piece.heading is None else f", facing {piece.heading / DEGREE:.0f} deg"
        return f"to x {piece.to[0]:.2f} m, y {piece.to[1]:.2f} m{facing}"
    if piece.turn is not None:
        about = "on the spot" if piece.about is None else f"about x {piece.about[0]:.2f} m, y {piece.about[1]:.2f} m"
        return f"a turn of {piece.turn / DEGREE:.0f} deg {about}"
    if piece.through is not None:
        last = piece.through[-1]
        return f"a path of {len(piece.through)} places to x {last.x:.2f} m, y {last.y:.2f} m"
    if piece.twist is not None:
        vx, vy, omega = piece.twist.rates()
        return f"{MILLI * vx:.3g} mm/s ahead, {MILLI * vy:.3g} mm/s to the left, {omega / DEGREE:.3g} deg/s for {piece.lasts:.3g} s"
    assert piece.direction is not None and piece.distance is not None
    return f"{piece.distance:.2f} m at {piece.direction / DEGREE:.0f} deg"


def _facts(run: WalkRun) -> tuple[tuple[str, str], ...]:
    report = run.report
    facts = [
        ("Robot", run.walk.robot.title or run.walk.robot.name),
        ("Steps", str(len(report.steps))),
        ("Time", f"{report.seconds:.0f} s, of which {report.prepared:.0f} s before the first step"),
        ("Plate at the end", _place(report)),
    ]
    if report.missed is not None:
        off, turned = report.missed
        facts.append(("From where the way ends", f"{MILLI * off:.1f} mm, {turned / DEGREE:.2f} deg"))
    return tuple(facts)


def _place(report: WalkReport) -> str:
    x, y, z, alpha = (round(part, 3) + 0.0 for part in (report.true_pose or report.pose)[:4])
    return f"x {x:.3f} m, y {y:.3f} m, z {z:.3f} m, heading {alpha / DEGREE:.1f} deg"


def _closest(run: WalkRun) -> list[tuple[str, str, str]]:
    steps, true, walking = run.report.steps, run.true, run.walking
    rows = [
        (f"ended: {step.outcome}", step.reason, _where(step)) for step in steps if step.outcome not in ("ok", "moved")
    ]
    margins, tilts, times = true.margins[walking], true.tilts[walking], true.time[walking]
    if len(times):
        least, steepest = int(margins.argmin()), int(tilts.argmax())
        margin = f"{MILLI * margins[least]:.0f} mm" if math.isfinite(margins[least]) else "fewer than three feet stood"
        rows.append(("least margin of balance", margin, f"at {times[least]:.0f} s"))
        rows.append(("largest tilt of the plate", f"{tilts[steepest] / DEGREE:.3f} deg", f"at {times[steepest]:.0f} s"))
    rows += [
        ("feet lowered again", f"{step.tries} tries", _where(step)) for step in most(steps, "tries") if step.tries > 1
    ]
    far = [step for step in steps if math.isfinite(step.off)]
    rows += [("frame from its aim", f"{MILLI * step.off:.1f} mm", _where(step)) for step in most(far, "off")[:1]]
    ends = [step.start for step in steps[1:]] + [run.report.seconds]
    took = sorted(((end - step.start, step) for step, end in zip(steps, ends, strict=True)), key=lambda one: -one[0])
    rows += [("longest step", f"{seconds:.0f} s", _where(step)) for seconds, step in took[:MOST_TOLD]]
    if run.report.kicks:
        rows.append(("kicked", f"{run.report.kicks} times", "the plate tilted without its legs telling"))
    return rows


def _where(step: StepReport) -> str:
    return f"step {step.number}, {step.frame}-frame, at {step.start:.0f} s"


def _happened(steps: list[StepReport]) -> Rows:
    columns = (
        "Step", "Frame", "Way [m]", "Outcome", "From [s]", "Tries", "Off [mm]", "Margin reckoned [mm]", "Tilt [deg]", "Why",
    )  # fmt: skip
    rows = tuple(
        (
            step.number,
            step.frame,
            round(step.way, 3),
            step.outcome,
            round(step.start, 1),
            step.tries,
            round(MILLI * step.off, 1) if math.isfinite(step.off) else None,
            round(MILLI * step.balance) if math.isfinite(step.balance) else None,
            round(step.tilt / DEGREE, 3),
            step.reason,
        )
        for step in steps
    )
    return Rows(columns, rows)
