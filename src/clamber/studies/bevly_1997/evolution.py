"""Figures 2.16 and 2.19: how the best fitness grows with the operators that the thesis names."""

from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Final

import numpy as np

from ...planning.genetic.evolve import Generation
from ...planning.genetic.planner import plan_genetic
from ...planning.genetic.profile import load_profile
from ...planning.result import PlanResult
from ...tasks.limbed import LimbedTask
from ...types import Floats
from ..result import Compared, Figure, StudyResult, Table, Value
from . import PAPER
from .modified_ladder import HELD_OFFSET, OWN_HALVES
from .replayed import INFERRED, limbed_task

SEEDS: Final = range(10)
BUDGET: Final = 200_000
PASSED: Final = 0.46
"""Fitness at which the body is about at y = 24 in, past the missing pegs' lower half [m]; weight 1 per metre."""
STEEP: Final = 2.0
"""A slope counts as a jump if it is so many times the one before [-]."""
NEAR: Final = 10
"""Generations on either side of a sub-goal that count as around it."""
WEIGHTS: Final = 'Population, weights and the spread of cut points are not printed; the profile "thesis" has ours.'


def _climbs(task: LimbedTask) -> list[PlanResult]:
    return [plan_genetic(task, seed=seed, profile="thesis", max_evaluations=BUDGET) for seed in SEEDS]


def _fitness(history: Sequence[Generation]) -> Floats:
    """Best fitness so far of every generation, goals' rewards taken off, shape (n,)."""
    reward = load_profile("thesis").weights["stages"]
    found = [line.best_fitness - reward * line.stage for line in history]
    grown: Floats = np.maximum.accumulate(np.array(found))
    return grown


def follow_modified_ladder() -> StudyResult:
    """Slopes of the fitness before and after the missing pegs are passed, over many seeds."""
    task = limbed_task("modified-ladder", (OWN_HALVES, HELD_OFFSET))
    rows: list[tuple[Value, ...]] = []
    climbs = _climbs(task)
    for seed, climb in zip(SEEDS, climbs, strict=True):
        fitness = _fitness(climb.history)
        passed = int(np.argmax(fitness >= PASSED)) if fitness[-1] >= PASSED else None
        if passed is None or passed >= len(fitness) - 1:
            rows.append((seed, climb.status, len(fitness), None, None, None))
            continue
        before = PASSED / passed
        after = float(fitness[-1] - fitness[passed]) / (len(fitness) - 1 - passed)
        rows.append((seed, climb.status, len(fitness), passed, before, after))
    ratios = _ratios(rows, 5, 4)
    ratio = median(ratios) if ratios else None
    shown = next((climb for climb in climbs if climb.status == "found"), climbs[0])

    def curve(path: Path) -> None:
        from ...viewing.charts import draw_history

        draw_history(shown.history, path, goals=[goal.name for goal in task.goals])

    return StudyResult(
        paper=PAPER,
        result="modified-ladder-evolution",
        claim="Figure 2.16: the fitness stays flat for long while no way past the missing pegs is known, then grows in large jumps.",
        verdict="open" if ratio is None else "holds" if ratio >= STEEP else "differs",
        compared=(
            Compared("seeds that find a plan", sum(climb.status == "found" for climb in climbs)),
            Compared("seeds that stay in the flat part to the end", sum(row[3] is None for row in rows)),
            Compared("generations to pass the missing pegs, median", _median(rows, 3)),
            Compared("generations to the goal, median of those that pass", _median([row for row in rows if row[3]], 2)),
            Compared("slope after over slope before, median", ratio),
        ),
        deviations=(
            *INFERRED,
            WEIGHTS,
            "Legs 1 and 2 keep to their own column and the offset counts while holding, as in no-rotation: only then is rotation needed.",
            f"Passed means a fitness of {PASSED} m, the body at about 24 in; holds if the slope at least doubles there. "
            f"{len(SEEDS)} seeds of at most {BUDGET} evaluations.",
            "The figure's numbers are not in the text that we have.",
        ),
        seeds=SEEDS,
        table=Table(
            ("seed", "status", "generations", "passed at", "slope before [m/generation]", "slope after"), tuple(rows)
        ),
        figures=(Figure("fitness", "Fitness and actions that hold, generation by generation (figure 2.16).", curve),),
    )


def follow_h() -> StudyResult:
    """Slope of the fitness around the sub-goals of H against the slope elsewhere, over many seeds."""
    task = limbed_task("h")
    rows: list[tuple[Value, ...]] = []
    climbs = _climbs(task)
    for seed, climb in zip(SEEDS, climbs, strict=True):
        gains = np.diff(_fitness(climb.history))
        stages = np.array([line.stage for line in climb.history])
        at = [int(np.argmax(stages >= k)) for k in range(1, min(int(stages.max()), len(task.goals) - 1) + 1)]
        around = np.zeros(len(gains), bool)
        for place in at:
            around[max(0, place - NEAR) : place + NEAR] = True
        inside = float(gains[around].mean()) if around.any() else None
        outside = float(gains[~around].mean()) if not around.all() else None
        rows.append((seed, climb.status, len(stages), ", ".join(map(str, at)), inside, outside))
    ratios = _ratios(rows, 4, 5)
    ratio = median(ratios) if ratios else None
    jumps = all(len(str(row[3]).split(", ")) == len(task.goals) - 1 for row in rows if row[1] == "found")
    shown = next((climb for climb in climbs if climb.status == "found"), climbs[0])

    def curve(path: Path) -> None:
        from ...viewing.charts import draw_history

        draw_history(shown.history, path, goals=[goal.name for goal in task.goals])

    return StudyResult(
        paper=PAPER,
        result="h-evolution",
        claim="Figure 2.19: the fitness on H jumps where a sub-goal is reached and hardly grows around each, "
        "faster on the straight parts.",
        verdict="open" if ratio is None or not jumps else "holds" if ratio <= 1.0 / STEEP else "differs",
        compared=(
            Compared("seeds that find a plan", sum(climb.status == "found" for climb in climbs)),
            Compared("jump of the fitness at a sub-goal (our weight)", load_profile("thesis").weights["stages"]),
            Compared("generations to the goal, median", _median([row for row in rows if row[1] == "found"], 2)),
            Compared("slope around sub-goals over slope elsewhere, median", ratio),
        ),
        deviations=(
            *INFERRED,
            WEIGHTS,
            f"Around means at most {NEAR} generations before or after, the jump itself left out; holds if the slope there is at most half. "
            f"{len(SEEDS)} seeds of at most {BUDGET} evaluations.",
            "The sub-goals are boxes of 3 in each way about points read from the printed plan; the figure with them is not in our text.",
        ),
        seeds=SEEDS,
        table=Table(
            ("seed", "status", "generations", "sub-goals at", "slope around [m/generation]", "slope elsewhere"),
            tuple(rows),
        ),
        figures=(Figure("fitness", "Fitness and actions that hold, generation by generation (figure 2.19).", curve),),
    )


def _median(rows: Sequence[tuple[Value, ...]], column: int) -> float | None:
    values = [value for row in rows if isinstance(value := row[column], int | float)]
    return median(values) if values else None


def _ratios(rows: Sequence[tuple[Value, ...]], upper: int, lower: int) -> list[float]:
    pairs = [(row[upper], row[lower]) for row in rows]
    return [a / b for a, b in pairs if isinstance(a, float) and isinstance(b, float) and b > 0.0]
