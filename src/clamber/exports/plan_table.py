"""A plan as a table in Markdown: each action, where it leads, and what limits it."""

from ..planning.problem.plan_source import OpenedPlan
from ..planning.problem.step_verdict import StepVerdict
from ..planning.problem.verdict import Verdict
from ..planning.problem.yardsticks import yardsticks_of
from ..units import DEGREE
from ..viewing.margins import named_limits


def plan_table(opened: OpenedPlan) -> str:
    """The plan as Markdown, carried out again in its task, violations and all.

    Raises:
        SpecError: If the plan has an action that its task has not.
        StartError: If the task's start violates a hard check.
    """
    verdict, plan = opened.check(go_on=True), opened.plan
    sticks = yardsticks_of(opened.task)
    loaded = any(row.max_torque is not None for row in verdict.per_step)
    held = any(row.holds for row in verdict.per_step)
    heads = ["step", "action", "x [m]", "y [m]", "angle [deg]"]
    heads += (["holds"] if held else []) + (["largest torque [N m]"] if loaded else []) + ["nearest limit", "verdict"]
    lines = [f"# {_cell(opened.task.title or opened.task.name)}", "", *_facts(verdict, plan.planner, plan.seed), ""]
    lines += ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    for row in verdict.per_step:
        x, y, angle = row.pose
        cells = [str(row.step), row.action.title, f"{x:.4f}", f"{y:.4f}", f"{angle / DEGREE:.1f}"]
        if held:
            cells.append(", ".join(f"{limb} {hold or 'free'}" for limb, hold in row.holds.items()))
        if loaded:
            cells.append("" if row.max_torque is None else f"{row.max_torque:.3f}")
        limits = named_limits(sticks, row.margins)
        cells += [str(limits[0]) if limits else "", _judged(row)]
        lines.append("| " + " | ".join(map(_cell, cells)) + " |")
    return "\n".join(lines) + "\n"


def _facts(verdict: Verdict, planner: str, seed: int | None) -> list[str]:
    holds = "all hold" if verdict.ok else f"{verdict.steps} hold"
    reached = "the goal is reached" if verdict.reached else f"{verdict.goals_met} of {verdict.goals} goals are met"
    made = f"made by {planner or 'hand'}" + ("" if seed is None else f", seed {seed}")
    lines = [f"{verdict.length} actions for the task `{verdict.task}`, {made}: {holds}; {reached}."]
    first = verdict.first_violation
    if first is not None:
        lines += ["", f"First violation, at step {first.step}: {_cell(first.reason or '')}."]
    return lines


def _judged(row: StepVerdict) -> str:
    warned = ", ".join(row.reported)
    if not row.ok:
        return f"violates {row.check}"
    return f"holds; reported: {warned}" if warned else "holds"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")
