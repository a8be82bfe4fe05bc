"""Section 7: passing over steps of different levels."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from ...families.walker.trials.most import Most, Tried, find_most
from ...families.walker.trials.run_walk import WalkRun
from ...units import DEGREE
from ..result import Compared, Figure, StudyResult, Table, Value, Verdict
from . import PAPER, SIMULATED
from .walker import MM, hoshino, known_noise, run_changed

LEVELS: Final = ((0.6, 15.0), (1.1, 45.0), (1.6, 0.0))
"""Where the ground changes its height [m], and to what [mm]: steps of 15 and 30 mm up, and one of 45 mm down."""
DISTANCE: Final = 2.6
"""Of the walk over them; both frames end behind the last [m]."""
SEEDS: Final = range(3)
SINGLE: Final = tuple(range(20, 141, 20))
"""Heights of a single step up that are tried, by bisection [mm]."""
AHEAD: Final = 1.4
"""Of the walk over a single step at 0.6 m [m]."""


def judge_steps(walks: Sequence[Tried]) -> Verdict:
    """The verdict: every walk passed all steps in balance, or not."""
    return "holds" if walks and all(walk.borne for walk in walks) else "differs"


def pass_steps() -> StudyResult:
    """A walk over three steps of different heights with some seeds, and the highest single step."""
    runs = {seed: _walk(LEVELS, DISTANCE, seed) for seed in SEEDS}
    walks = {seed: Tried.of(f"seed {seed}", run) for seed, run in runs.items()}
    most = find_most(
        [f"{height} mm" for height in SINGLE],
        lambda value: Tried.of(value, _walk(((0.6, float(value.split()[0])),), AHEAD, 0)),
    )
    rows: list[tuple[Value, ...]] = [
        (*_row(walk), runs[seed].report.kicks, len(runs[seed].report.steps)) for seed, walk in walks.items()
    ]
    rows += [(*_row(tried), None, None) for tried in most.tried]
    shown = runs[SEEDS[0]]

    def course(path: Path) -> None:
        from ...viewing.pictures import draw_run

        draw_run(shown, path)

    return StudyResult(
        paper=PAPER,
        result="passing-steps",
        claim="Section 7: the robot has a high performance of passing over obstacles with steps of different levels.",
        verdict=judge_steps(list(walks.values())),
        compared=(
            Compared(
                f"walks over steps of 15, 30 and 45 mm that came to their end in balance, of {len(walks)}",
                sum(walk.borne for walk in walks.values()),
            ),
            Compared("least margin of balance on the way [mm]", min(_mm(walk.margin) for walk in walks.values())),
            Compared("largest tilt of the plate on the way [deg]", max(walk.tilt for walk in walks.values()) / DEGREE),
            Compared("highest single step passed, of those tried [mm]", _value(most, passed=True)),
            Compared("lowest not passed [mm]", _value(most, passed=False)),
            Compared("lift of the feet [mm]", hoshino().legs.lift * MM),
        ),
        deviations=(
            "The paper prints no sizes of the steps. Ours are 15 and 30 mm up and 45 mm down, as walls, half a metre apart; the robot is "
            f"told nothing of them. Holds if the walk comes to its end with its centre of mass inside the feet with {len(SEEDS)} seeds; "
            "the rule was fixed before the walks were made. The highest single step is shown beside it and decides nothing.",
            "Noise is as usual but for the inclinometers' offset, which is known.",
            SIMULATED,
        ),
        seeds=SEEDS,
        table=Table(
            ("walk", "passed in balance", "least margin [mm]", "largest tilt [deg]", "why not", "kicks", "slides"),
            tuple(rows),
        ),
        figures=(Figure("course", "The walk over steps of 15, 30 and 45 mm, from the side and from above.", course),),
    )


def _walk(levels: Sequence[tuple[float, float]], distance: float, seed: int) -> WalkRun:
    ends = (*(at for at, _ in levels[1:]), 10.0)
    blocks = ", ".join(
        f'{{ x_min = "{at} m", x_max = "{end} m", y_min = "-10 m", y_max = "10 m", height = "{height} mm" }}'
        for (at, height), end in zip(levels, ends, strict=True)
    )
    changes = (f"ground.blocks=[{blocks}]", f"way.0.distance={distance}m")
    return run_changed("step-walk", changes, known_noise(), seed)


def _row(tried: Tried) -> tuple[Value, ...]:
    margin = None if tried.margin is None else tried.margin * MM
    return tried.value, "yes" if tried.borne else "no", margin, tried.tilt / DEGREE, tried.reason


def _mm(margin: float | None) -> float:
    return -np.inf if margin is None else margin * MM


def _value(most: Most, *, passed: bool) -> Value:
    one = most.borne if passed else most.refused
    return "none" if one is None else one.value.split()[0]
