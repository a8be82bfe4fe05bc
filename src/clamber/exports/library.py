"""What can be written of what: robots, plans and runs, each by the suffixes that other programs know."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Final, Literal, TypeAlias

from ..errors import ClamberError, SpecError, describe_choices
from ..execution.log import LogError
from ..execution.log_files import SUFFIXES as LOGS
from ..execution.log_files import read_log
from ..family import NotOfFamilyError, families, family_of
from ..files import is_path, unknown_name, write_atomically
from ..json_form import Count, Key, in_json
from ..planning.problem.plan_source import OpenedPlan, is_plan, open_plan, plan_names
from ..planning.problem.problem import Replay
from ..planning.problem.problems import normalisation_of, plan_family
from ..planning.problem.verdict import StepVerdict, Verdict
from ..tasks.robots import Robot, load_robot, robot_names
from ..units import DEGREE
from ..viewing.margins import named_limits
from .joint_trajectory import JointTrajectory


def plan_table(opened: OpenedPlan) -> str:
    """The plan as Markdown, carried out again in its task, violations and all.

    Raises:
        SpecError: If the plan has an action that its task has not.
        StartError: If the task's start violates a hard check.
    """
    verdict, plan = opened.check(go_on=True), opened.plan
    sticks = normalisation_of(opened.task)
    loaded = any(row.max_torque is not None for row in verdict.per_step)
    held = any(row.holds for row in verdict.per_step)
    axes = verdict.pose_axes
    heads = ["step", "action", *(f"{axis.name} [{'m' if axis.unit == 'm' else 'deg'}]" for axis in axes)]
    heads += (["holds"] if held else []) + (["largest torque [N m]"] if loaded else []) + ["nearest limit", "verdict"]
    lines = [f"# {_cell(opened.task.title or opened.task.name)}", "", *_facts(verdict, plan.planner, plan.seed), ""]
    lines += ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    for row in verdict.per_step:
        at = zip(axes, row.pose, strict=True)
        cells = [str(row.step), row.action.title]
        cells += [f"{value:.4f}" if axis.unit == "m" else f"{value / DEGREE:.1f}" for axis, value in at]
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


def run_trajectory(path: Path) -> JointTrajectory:
    """The joints of a run, from the log of `clamber run -o`.

    Raises:
        FileError: If the file cannot be read.
        LogError: If it is no log of a run.
    """
    log = read_log(path, None)
    for family in families():
        trajectories = family.trajectories
        if trajectories.note in log.notes:
            return trajectories.run(log)
    raise LogError(log.label, None, None, None, "is no log of a run; `clamber run PLAN -o run.mcap` writes one")


def plan_trajectory(opened: OpenedPlan) -> JointTrajectory:
    """The joints of a plan, a point for its start and for the stance after each action, at rest in all of them.

    Violations are no hindrance: the trajectory says where the plan leads, `clamber check` whether it holds.

    Raises:
        SpecError: If the plan has an action that its task has not.
    """
    return family_of(opened.task).trajectories.plan(opened.task, _replayed(opened))


def _replayed(opened: OpenedPlan) -> Replay:
    """A plan carried out on paper, violations and all."""
    codes = opened.plan.codes(opened.task, opened.label)
    return plan_family(opened.task).problem(opened.task).replay(codes, go_on=True)


Kind: TypeAlias = Literal["robot", "plan", "run"]


class ExportError(ClamberError):
    """A thing cannot be written as a file's suffix says."""

    def __init__(self, path: str, kind: str, allowed: tuple[str, ...], instead: str | None) -> None:
        super().__init__(path, kind, allowed, instead)
        self.path, self.kind, self.allowed, self.instead = path, kind, allowed, instead

    def __str__(self) -> str:
        suffix = Path(self.path).suffix
        shown = (
            f"no {self.kind} can be exported as '{suffix}'" if suffix else "the name has no suffix that says the format"
        )
        hint = "" if self.instead is None else f"; {self.instead}"
        return f"{self.path}: {shown}; allowed are {describe_choices(suffix, self.allowed)}{hint}"


@dataclass(frozen=True, slots=True)
class Content:
    """What goes into a file."""

    text: str
    format: str
    """In words."""
    notes: tuple[str, ...] = ()
    """What the reader should know, such as what the format cannot say."""


@dataclass(frozen=True, slots=True)
class Exported:
    """A file that was written for other programs."""

    path: Annotated[Path, Key("written", kind=str)]
    kind: Kind
    format: str
    """In words."""
    notes: tuple[str, ...]
    """What the reader should know, such as what the format cannot say."""

    @in_json(after="format")
    def bytes(self) -> Count:
        """Size of the file."""
        return self.path.stat().st_size


def mjcf(robot: Robot) -> Content:
    """A robot for MuJoCo."""
    from ..sim.lone_robot import lone_robot
    from ..sim.mjcf_file import mjcf_text

    return Content(mjcf_text(lone_robot(robot)), "MJCF")


def urdf(robot: Robot) -> Content:
    """A robot for ROS, Pinocchio and others."""
    from ..sim.lone_robot import lone_robot
    from ..sim.urdf_file import urdf_of

    written = urdf_of(lone_robot(robot))
    return Content(written.text, "URDF", tuple(f"not in it: {loss}" for loss in written.losses))


def _table(trajectory: JointTrajectory) -> Content:
    return Content(trajectory.to_csv(), "joint trajectory, CSV")


def _message(trajectory: JointTrajectory) -> Content:
    return Content(json.dumps(trajectory.to_json(), allow_nan=False) + "\n", "trajectory_msgs/JointTrajectory, JSON")


def _contacts(opened: OpenedPlan) -> Content:
    """Stances and contacts of a plan.

    Raises:
        NotOfFamilyError: If the robot's family exports none.
    """
    family = family_of(opened.task)
    if family.trajectories.contacts is None:
        raise NotOfFamilyError(family.title, "contact sequence to export")
    sequence = family.trajectories.contacts(opened.task, _replayed(opened))
    return Content(json.dumps(sequence, allow_nan=False) + "\n", "contact sequence, JSON")


def _of_plan(content: Content, plan: OpenedPlan) -> Content:
    """The same with a word about the first action that does not hold."""
    first = plan.check().first_violation
    if first is None:
        return content
    return replace(content, notes=(*content.notes, f"step {first.step} violates a hard check: {first.reason}"))


CONTACTS: Final = ".contacts.json"
"""Suffix of a contact sequence."""
FORMATS: Final[dict[Kind, dict[str, Callable[[Any], Content]]]] = {
    "robot": {".xml": mjcf, ".mjcf": mjcf, ".urdf": urdf},
    "plan": {
        ".csv": lambda plan: _of_plan(_table(plan_trajectory(plan)), plan),
        ".json": lambda plan: _of_plan(_message(plan_trajectory(plan)), plan),
        CONTACTS: lambda plan: _of_plan(_contacts(plan), plan),
        ".md": lambda plan: _of_plan(Content(plan_table(plan), "table, Markdown"), plan),
    },
    "run": {
        ".csv": lambda path: _table(run_trajectory(path)),
        ".json": lambda path: _message(run_trajectory(path)),
    },
}
"""Kind of thing -> suffix -> what writes it."""
INSTEAD: Final[dict[Kind, str]] = {
    "plan": "`clamber show PLAN -o FILE` draws it: .png .svg .pdf .gif .html .mp4",
    "run": "`clamber run PLAN -o FILE` draws it as it runs: .png .svg .pdf .gif .html .mp4",
}
"""Kind -> where its other formats come from."""


def kind_of(thing: str) -> Kind:
    """Whether a text means a robot, a plan or the log of a run.

    Raises:
        UnknownNameError: If it looks like a name and nothing shipped has it.
    """
    path = Path(thing)
    if path.suffix.lower() in LOGS:
        return "run"
    if is_plan(thing):
        return "plan"
    if thing in robot_names() or is_path(thing):
        return "robot"
    raise unknown_name("robot, plan or log", thing, (*robot_names(), *plan_names()))


def export(thing: str, path: Path, task: str | None = None, overrides: Sequence[str] = ()) -> Exported:
    """Write a thing as a file's suffix says, whole or not at all.

    Args:
        thing: A robot's or a plan's name or file, or the log of a run.
        path: The file.
        task: For plans: a task in place of the one that the plan names.
        overrides: For plans: texts "key=value" that change the task.

    Raises:
        ExportError: If the suffix is none that the thing can be written as.
        SpecError: If a task or overrides are given with something else than a plan.
        ClamberError: As whatever reads the thing, and `write_atomically`.
    """
    kind = kind_of(thing)
    check_export_suffix(kind, path)
    for key, given in (("--task", task), ("--set", overrides)):
        if given and kind != "plan":
            raise SpecError(thing, key, given, f"is for plans; this is a {kind}")
    source: Any = Path(thing)
    if kind != "run":
        source = load_robot(thing) if kind == "robot" else open_plan(thing, task, overrides)
    content = FORMATS[kind][_suffix(path)](source)
    write_atomically(path, content.text)
    return Exported(path, kind, content.format, content.notes)


def check_export_suffix(kind: Kind, path: Path) -> None:
    """Makes sure that a kind of thing can be written as a file's suffix says.

    Raises:
        ExportError: If not; it names what can.
    """
    if _suffix(path) not in FORMATS[kind]:
        raise ExportError(str(path), kind, tuple(FORMATS[kind]), INSTEAD.get(kind))


def _suffix(path: Path) -> str:
    return CONTACTS if path.name.lower().endswith(CONTACTS) else path.suffix.lower()
