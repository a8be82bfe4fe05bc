"""What the viewer shows, from the names and files that it is given: tasks, plans, walks, and logs of runs."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..errors import SpecError
from ..execution.log import Log, LogError
from ..execution.log_files import SUFFIXES, read_log
from ..execution.sample_log import told_of
from ..families.climber.execution.climb_report import ActionReport, LoggedClimb
from ..families.climber.execution.climb_trace import ClimbTrace
from ..families.climber.pictures.climb_run_view import ClimbRunView
from ..families.climber.pictures.climb_scenery import ClimbScenery, join
from ..families.climber.pictures.climb_view import ClimbView
from ..families.climber.pictures.run_film import ClimbFilm
from ..families.climber.planning.task import LimbedTask
from ..families.climber.trials.run_plan import ClimbRun
from ..families.walker.execution.walk_report import LoggedWalk
from ..families.walker.execution.walk_trace import WalkTrace
from ..families.walker.pictures.standing_film import StandingFilm
from ..families.walker.pictures.walk_film import PlannedWalkFilm, WalkFilm, logged_walk
from ..families.walker.pictures.walk_scenery import WalkScenery, walk_bounds
from ..families.walker.pictures.walker_view import WalkerView
from ..families.walker.pictures.way import way_poses
from ..families.walker.planning import Walk, is_walk, load_walk, walk_names
from ..families.walker.planning.task import WalkerTask
from ..families.walker.robot import WalkerRobot
from ..families.walker.trials.run_walk import WalkRun
from ..families.walker.world.ground import Ground
from ..planning.problem.plan import Plan
from ..planning.problem.plan_source import check_name, is_plan, open_plan
from ..planning.problem.problem import Replay
from ..planning.problem.problems import plan_family
from ..tasks import Task, load_task
from ..tasks.library import task_names
from ..types import Json
from ..viewing.browser.film import Film, PlanFilm
from ..viewing.browser.scenery import Scenery

NAMED: Final = "name the task, plan or walk that it was made with beside it"


@dataclass(slots=True, eq=False)
class Exhibit:
    """A world with a robot, a plan and a run of it, as far as there are any."""

    title: str
    scenery: Scenery
    plan_film: Film[Any] | None
    """Of the start alone where there is no plan; None for a walk's log, beside which there is none."""
    run_film: Film[Any] | None = None
    task: Task | Walk | None = None
    """What can be edited, planned and run; None for a log whose walk has none."""
    plan: Plan | None = None

    @property
    def main(self) -> Film[Any]:
        """What is played first: the run, if there is one."""
        film = self.run_film or self.plan_film
        assert film is not None  # an exhibit has one of them at least
        return film


def open_exhibit(things: Sequence[str], task: str | None = None, overrides: Sequence[str] = ()) -> Exhibit:
    """What some names and files mean together.

    Args:
        things: A task, a plan or a walk by name or file, a log of a run, or a log and what it was made with, in any order.
        task: Name or path of a task in place of the one that the plan names.
        overrides: Texts "key=value" that change the task.

    Raises:
        SpecError: If two of them are of one kind, or do not belong together.
        ClamberError: As `open_plan`, `load_task`, `load_walk` and `read_log`.
    """
    logs = [thing for thing in things if Path(thing).suffix.lower() in SUFFIXES]
    others = [thing for thing in things if thing not in logs]
    for kind, found in (("logs", logs), ("tasks, plans or walks", others)):
        if len(found) > 1:
            raise SpecError(
                "clamber view", kind, ", ".join(found), "one can be shown at a time; a log may be beside it"
            )
    log = read_log(Path(logs[0])) if logs else None
    what = others[0] if others else _made_with(log) if log is not None else None
    if what is None:
        raise SpecError("clamber view", "nothing to show", "", "name a task, a plan, a walk or a log of a run")
    if is_walk(what):
        return _walk(load_walk(what, overrides), log)
    plan = None
    check_name(what, walk_names())
    if is_plan(what):
        opened = open_plan(what, task, overrides)
        chosen, plan = opened.task, opened.plan
    else:
        chosen = load_task(what, overrides)
    exhibit = planned_exhibit(chosen, plan, what)
    return exhibit if log is None else _with_log(exhibit, log)


def planned_exhibit(task: Task, plan: Plan | None, label: str = "plan") -> Exhibit:
    """A task with a plan carried out on paper, violations and all; without one, its start.

    Raises:
        ClamberError: If the plan has actions that the task has not, or the start violates a hard check.
    """
    codes = np.zeros(0, np.int32) if plan is None else plan.codes(task, label)
    replay = plan_family(task).problem(task).replay(codes, go_on=True)
    if isinstance(task, LimbedTask):
        return _climb(task, replay, plan)
    assert isinstance(task, WalkerTask)
    return _planned_walk(task, replay, plan)


def walk_exhibit(walk: Walk) -> Exhibit:
    """A walk before it has begun: its robot at its start, and its way.

    Raises:
        ClamberError: If there is no way to one of its places.
    """
    way = way_poses(walk)[:, :2]
    scenery = WalkScenery(walk.robot, walk.ground, (), walk_bounds(way), way)
    return Exhibit(walk.title or walk.name, scenery, StandingFilm(walk), task=walk)


def run_film(exhibit: Exhibit, run: ClimbRun | WalkRun) -> Film[Any]:
    """The film of what was just carried out."""
    if isinstance(run, ClimbRun):
        return ClimbFilm(ClimbRunView(run.task, run.trace, run.report.actions, run.true_pegs))
    walk = run.walk
    return WalkFilm(walk.robot, walk.ground, run.true, run.report.to_json(), exhibit.title, payload=walk.payload)


def _climb(task: LimbedTask, replay: Replay, plan: Plan | None) -> Exhibit:
    view = ClimbView(task, replay)
    return Exhibit(task.title or task.name, ClimbScenery(task, view.bounds), PlanFilm(view), task=task, plan=plan)


def _planned_walk(task: WalkerTask, replay: Replay, plan: Plan | None) -> Exhibit:
    view = WalkerView(task, replay)
    x0, x1, y0, y1 = view.bounds
    scenery = WalkScenery(task.robot, task.world, task.goals, (x0 - 0.2, x1 + 0.2, y0 - 0.2, y1 + 0.2))
    return Exhibit(task.title or task.name, scenery, PlannedWalkFilm(view), task=task, plan=plan)


def _walk(walk: Walk, log: Log | None) -> Exhibit:
    """A walk, which has no plan: its start, or its log."""
    title = walk.title or walk.name
    if log is None:
        return walk_exhibit(walk)
    trace = _walk_trace(log)
    bounds = walk_bounds(trace.believed[:, :2])
    scenery = WalkScenery(walk.robot, walk.ground, (), bounds)
    film = _logged_film(walk.robot, walk.ground, trace, title, walk.payload)
    return Exhibit(title, scenery, None, film)


def _with_log(exhibit: Exhibit, log: Log) -> Exhibit:
    task = exhibit.task
    assert task is not None and not isinstance(task, Walk)
    if isinstance(task, LimbedTask):
        assert isinstance(exhibit.scenery, ClimbScenery)
        view = ClimbRunView(task, *_climb_trace(log, task))
        exhibit.scenery = ClimbScenery(task, join(exhibit.scenery.bounds, view.bounds))
        exhibit.run_film = ClimbFilm(view)
        return exhibit
    assert isinstance(task, WalkerTask)
    trace = _walk_trace(log)
    assert isinstance(exhibit.scenery, WalkScenery)
    bounds = join(exhibit.scenery.bounds, walk_bounds(trace.believed[:, :2]))
    exhibit.scenery = WalkScenery(task.robot, task.world, task.goals, bounds)
    exhibit.run_film = _logged_film(task.robot, task.world, trace, exhibit.title, task.start.payload)
    return exhibit


def _logged_film(robot: WalkerRobot, ground: Ground, trace: WalkTrace, title: str, payload: float) -> WalkFilm:
    margins = trace.margin if trace.true_margin is None else trace.true_margin
    return WalkFilm(
        robot, ground, logged_walk(trace), trace.notes or {}, title,
        payload=payload, margins=margins, exact=trace.true_forces is not None,
    )  # fmt: skip


def _climb_trace(log: Log, task: LimbedTask) -> tuple[ClimbTrace, list[ActionReport]]:
    trace = ClimbTrace.from_log(log)
    if trace.limbs != task.robot.limb_names:
        limbs = ", ".join(trace.limbs)
        raise LogError(log.label, None, None, f"limbs {limbs}", f"robot '{task.robot.name}' has other ones; {NAMED}")
    return trace, told_of(trace.notes, LoggedClimb, log.label).actions


def _walk_trace(log: Log) -> WalkTrace:
    trace = WalkTrace.from_log(log)
    told_of(trace.notes, LoggedWalk, log.label)
    if not np.isfinite(trace.believed).all():
        raise LogError(log.label, None, None, None, "tells no place of the robot")
    return trace


def _made_with(log: Log) -> str:
    """The name of the task or walk that a log says it was made with, if it comes with Clamber."""
    trace = WalkTrace if "walker" in log.notes else ClimbTrace
    notes: Json = trace.from_log(log).notes or {}
    for key, known in (("task", task_names()), ("walk", (*walk_names(), *task_names()))):
        if notes.get(key) in known:
            return str(notes[key])
    raise LogError(log.label, None, None, None, f"does not say what it was made with; {NAMED}")
