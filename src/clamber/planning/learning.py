"""Learn macros for a task: plan it, look for what repeats, keep what carries on by itself; and store them (thesis 2.2.2)."""

import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from pydantic import StrictStr

from ..errors import FileError, SpecError
from ..files import Document, check_schema, parse_json, read_text, write_atomically
from ..json_form import Jsonable
from ..specs import build_spec, spec
from ..tasks import Task
from .genetic.learning import Count, Macro, learn
from .genetic.planner import plan_genetic
from .genetic.profile import Profile, load_profile
from .problem.problems import code_limits, pose_problem
from .progress import Listener

SCHEMA: Final = "clamber-macros-2"
UNNAMED: Final = "clamber-macros-1"
"""What files followed before they named their robot."""
ENOUGH: Final = 0.8
"""Share of the way to the goal that a macro must lead by itself for the search to stop early."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lesson(Jsonable):
    """What was learned from a task; its file is the same. Exit code 1 where nothing repeats."""

    schema: str = SCHEMA
    task: str
    robot: str
    """Its name; another robot's macros are refused."""
    plans: Count
    """Plans looked at."""
    evaluations: Count
    macros: tuple[Macro, ...]
    """By how far each leads alone from the task's start, in words that the family's inventory knows; empty if nothing repeats."""

    def save(self, path: Path) -> None:
        """Write it as JSON, whole or not at all."""
        write_atomically(path, json.dumps(self.to_json(), indent=1) + "\n")


def learn_macros(
    task: Task,
    *,
    seeds: Iterable[int] = range(12),
    profile: str | Profile = "default",
    max_evaluations: int = 50_000,
    threads: int | None = None,
    progress: Listener | None = None,
    most: int = 1,
) -> Lesson:
    """Plan a task with one seed after another until a sequence of a plan carries on by itself, and give the best found.

    Args:
        task: The task to learn from.
        seeds: Seeds of the plans.
        profile: Profile of the genetic planner.
        max_evaluations: Most evaluations of one plan.
        threads: Threads; None for one a core.
        progress: Called after every generation.
        most: How many macros to keep.

    Returns:
        The lesson; without macros if nothing repeats.
    """
    settings = load_profile(profile) if isinstance(profile, str) else profile
    # The shortest plans differ from one cycle of the gait to the next: what repeats is learned before plans are made so short.
    settings = replace(settings, search=replace(settings.search, beam=0, windows=0))
    problem = pose_problem(task, threads=threads).problem
    macros: dict[tuple[int, ...], Macro] = {}
    plans = evaluations = 0
    goal = problem.way_left(problem.start)
    for seed in seeds:
        result = plan_genetic(
            task, seed=seed, profile=settings, max_evaluations=max_evaluations, threads=threads, progress=progress
        )
        if "interrupted" in result.reason:  # what is known of the plans before stays
            break
        plans += 1
        evaluations += result.evaluations
        if result.status != "found":
            continue
        codes = result.plan.codes(task)
        relative = problem.relative(codes, problem.replay(codes).stances)
        for macro in learn(problem, relative, most=max(3, most)):
            macros.setdefault(macro.codes, macro)
        if any(macro.from_start * macro.gain >= ENOUGH * goal for macro in macros.values()):
            break
    ranked = sorted(macros.values(), key=lambda macro: (-round(macro.from_start * macro.gain, 6), len(macro.codes)))
    return Lesson(
        task=task.name,
        robot=task.robot.name,
        plans=plans,
        evaluations=evaluations,
        macros=tuple(ranked[:most]),
    )


@spec
class _Stored:
    """A stored lesson, by its types."""

    task: StrictStr
    robot: StrictStr
    plans: Count
    evaluations: Count
    macros: tuple[Macro, ...]


def load_macros(path: Path, task: Task) -> tuple[Macro, ...]:
    """The macros of a stored lesson, for a task.

    Raises:
        FileError: If the file is no JSON.
        SpecError: If it is no lesson, or of another robot, or has a code that is no action of the task.
    """
    label = str(path)
    try:
        data = parse_json(read_text(path))
    except ValueError as error:
        raise FileError(label, f"holds no macros: {error}", "macros are what `clamber learn -o` writes") from None
    if not isinstance(data, dict):
        raise FileError(label, "holds no macros: it is no JSON object", "macros are what `clamber learn -o` writes")
    if data.get("schema") == UNNAMED:
        raise FileError(label, f"follows {UNNAMED!r}, which names no robot", "learn again: clamber learn TASK -o FILE")
    document = Document(label, data)
    check_schema(document, SCHEMA)
    stored = build_spec(_Stored, document, without=("schema",))
    if stored.robot != task.robot.name:
        allowed = (
            f"must be '{task.robot.name}', the robot of task '{task.name}'; learn its own: clamber learn TASK -o FILE"
        )
        raise SpecError(label, "robot", stored.robot, allowed)
    limits = code_limits(task)
    for i, macro in enumerate(stored.macros):
        limits.macro(macro.codes, f"macros.{i}.codes", label)
    return stored.macros
