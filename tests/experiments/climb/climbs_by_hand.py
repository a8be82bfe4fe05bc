"""Made-up climbs and a plan of two actions, for tests of what trials say together."""

from typing import Any

import numpy as np

from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.noise import NOISE, Noise
from clamber.families.climber.trials.trial import ClimbTrial, TrialSetup
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task


def ladder() -> LimbedTask:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    return climbable(task)


def setup_of(*numbers: int, noise: Noise | None = None, **options: Any) -> TrialSetup:
    """Trials of a plan in the thesis's numbers."""
    task = ladder()
    plan = Plan.of_codes(task, [thesis_code(task, number) for number in numbers], planner="by hand")
    return TrialSetup(task=task, plan=plan, noise=noise or Noise.of("usual"), **options)


def climb(seed: int, done: bool = True, **changes: Any) -> ClimbTrial:
    """A climb that drew evenly."""
    chance = np.random.default_rng(seed)
    told: dict[str, Any] = {
        "seed": seed, "done": done, "outcome": "ok" if done else "fell", "step": 2, "kind": "move", "limb": "",
        "reason": "" if done else "fell: a hook has come off", "seconds": 100.0, "short": 0.0, "pushes": 3, "grabs": 2,
        "stalled": 0, "replans": 0, "recovered": 0, "drawn": {key: float(chance.uniform(-1.0, 1.0)) for key in NOISE},
    }  # fmt: skip
    return ClimbTrial(**told | changes)
