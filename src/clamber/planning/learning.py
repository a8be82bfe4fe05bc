"""Learn macros for a task: plan it, look for what repeats, keep what carries on by itself; and store them (thesis 2.2.2)."""

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final

from ..actions.problems import pose_problem
from ..errors import FileError
from ..files import read_text, write_atomically
from ..tasks import Task
from ..types import Json
from .genetic.learning import Macro, learn
from .genetic.planner import plan_genetic
from .genetic.profile import Profile, load_profile
from .progress import Listener

SCHEMA: Final = "clamber-macros-1"
ENOUGH: Final = 0.8
"""Share of the way to the goal that a macro must lead by itself for the search to stop early."""


@dataclass(frozen=True, slots=True)
class Lesson:
    """What was learned from a task."""

    task: str
    macros: tuple[Macro, ...]
    """By how far each leads alone from the task's start, in words that the family's inventory knows: packed codes."""
    plans: int
    """Plans looked at."""
    evaluations: int

    def to_json(self) -> Json:
        """Plain data."""
        return {
            "schema": SCHEMA,
            "task": self.task,
            "plans": self.plans,
            "evaluations": self.evaluations,
            "macros": [asdict(macro) for macro in self.macros],
        }

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
    plans = 0
    evaluations = 0
    goal = problem.way_left(problem.start)
    for seed in seeds:
        result = plan_genetic(
            task, seed=seed, profile=settings, max_evaluations=max_evaluations, threads=threads, progress=progress
        )
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
    return Lesson(task.name, tuple(ranked[:most]), plans, evaluations)


def load_macros(path: Path) -> tuple[Macro, ...]:
    """The macros of a stored lesson.

    Raises:
        FileError: If the file is no lesson.
    """
    allowed = "macros are what `clamber learn -o` writes"
    try:
        data: Any = json.loads(read_text(path))
        if data["schema"] != SCHEMA:
            raise ValueError(f"schema is {data['schema']!r}, not {SCHEMA!r}")
        return tuple(
            Macro(**{**macro, "codes": tuple(int(code) for code in macro["codes"])}) for macro in data["macros"]
        )
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise FileError(str(path), f"holds no macros: {error}", allowed) from None
