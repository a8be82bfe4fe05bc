"""Plans of robots in space in many worlds of a kind: how many are found and hold, and what one costs."""

import os
import time
from collections.abc import Sequence
from typing import Final

from ....errors import ClamberError
from ....jobs import LocalProcesses
from ....planning.auto import plan_auto
from ....tasks import load_task, task_names
from ....trials.measured import Crew, Row, Say, keep_quiet, median_or_nothing
from ....types import Json

TASKS: Final = {
    "wall-gripper": "20 of 20, 3 s",
    "overhang-gripper": "20 of 20, 3 s",
    "ceiling-gripper": "20 of 20, 3 s",
    "stones-quadruped": "20 of 20, 2 s",
    "rubble-hexapod": "20 of 20, 4 s",
    "handrails-triped": "20 of 20, 6 s",
    "corners-magnet": "20 of 20",
    "truss-inchworm": "20 of 20",
    "chimney-hexapod": "20 of 20",
}
"""Task -> what is aimed at."""
SCENES: Final = "scene-"
"""What scenes' names begin with."""
SCENE_AIM: Final = "20 of 20, 3 s"
WORLDS: Final = tuple(range(20))
"""Seeds of the worlds: 0 is the one that comes with Clamber."""


def plan_world(item: Json) -> Json:
    """Plan a task in one of its worlds; runs in a worker.

    Args:
        item: `task`, and `seed` of its world.

    Returns:
        `seconds` of CPU time that the plan took, None where there is none or it does not hold; `actions`; `reason`.
    """
    try:
        task = load_task(item["task"], (f"world.seed={item['seed']}",))
        began = time.process_time()
        found = plan_auto(task, threads=1)
    except ClamberError as error:
        return {"seconds": None, "actions": None, "reason": str(error)}
    seconds = time.process_time() - began
    verdict = found.check()
    holds = found.has_plan and verdict.ok and verdict.goals_met == verdict.goals
    return {"seconds": seconds if holds else None, "actions": found.length if holds else None, "reason": found.reason}


def bench_worlds(
    *,
    tasks: Sequence[str] | None = None,
    seeds: Sequence[int] = WORLDS,
    say: Say = keep_quiet,
    crew: Crew | None = None,
) -> list[Row]:
    """Of each task: worlds with a plan that holds, median CPU time on one core with start and polishing, median length.

    Args:
        tasks: Their names; None: those of `TASKS`, and the scenes.
        seeds: Of their worlds.
        say: Told what is being done.
        crew: Who plans; None: local processes, one a core.

    Raises:
        TrialError: If a plan's worker raised or died.
    """
    names = tuple(tasks or (*TASKS, *(name for name in task_names() if name.startswith(SCENES))))
    crew = crew or Crew(executor=LocalProcesses(os.cpu_count() or 1))
    items: list[Json] = [{"task": name, "seed": seed} for name in names for seed in seeds]
    say(f"{len(names)} tasks in {len(seeds)} worlds each")
    title = f"{len(seeds)} worlds each of {len(names)} tasks in space"
    told = crew.answers(plan_world, items, {"items": items}, title)
    rows = []
    for k, name in enumerate(names):
        mine = told[k * len(seeds) : (k + 1) * len(seeds)]
        found = sum(each["seconds"] is not None for each in mine)
        for seed, each in zip(seeds, mine, strict=True):
            if each["seconds"] is None:
                say(f"{name}, world {seed}: {each['reason']}")
        rows += [
            Row(f"{name}: plans that hold, of {len(seeds)} worlds", found, "worlds", TASKS.get(name, SCENE_AIM)),
            Row(f"{name}: CPU time of a plan, median", median_or_nothing([each["seconds"] for each in mine]), "s"),
            Row(f"{name}: actions, median", median_or_nothing([each["actions"] for each in mine]), "actions"),
        ]
    return rows
