"""Figures 3.11 and 3.12: a step of 2 cm along y, on the simple model and on the limb in MuJoCo."""

from pathlib import Path
from typing import Final

import numpy as np

from ...control.law_settings import LawSettings
from ...limb_bench.measures import Run
from ...limb_bench.runner import run_contest
from ...limb_bench.scenario import step_scenario
from ..result import Compared, Figure, StudyResult, Table, Value
from . import MILLI, PAPER
from .limb_entries import (
    BASELINES,
    BRANCHES,
    CENTRE,
    GAINS,
    IDEAL,
    MATCHED,
    PLANT,
    SCCT,
    SMOOTH,
    WEIGHTED_RATE,
    entries,
    gains_shown,
    judged,
    leg_1,
    scct,
    stiffness_facts,
    transpose,
)

REFERENCE: Final[LawSettings] = scct(100.0, 10.0)
STEP: Final = 0.02
"""Downwards [m]."""
SECONDS: Final = 2.0
COLUMNS: Final = (
    *("friction", "branch", "law", "Kp", "Kd"),
    *("largest |x - 0.22| [mm]", "y at the end [mm]", "past y = -20 mm by [mm]"),
)


def off_line(run: Run) -> float:
    """Furthest that the true tip gets from x = 0.22 m [mm]."""
    return float(np.abs(run.trace.true_places()[:, 0, 0] - CENTRE[0]).max()) * MILLI


def _row(friction: str, branch: str, run: Run) -> tuple[Value, ...]:
    y = run.trace.true_places()[:, 0, 1] * MILLI
    past = max(0.0, -STEP * MILLI - float(y.min()))
    return friction, branch, run.entry.label, *gains_shown(run.entry.settings), off_line(run), float(y[-1]), past


def step_response(result: str, plant: str) -> StudyResult:
    """The step with every law on one plant, `mujoco` or `ode`: verdict, numbers, paths.

    Args:
        result: Name on the command line.
        plant: Name of the plant.
    """
    limbs = leg_1()
    kept: dict[str, list[Run]] = {}
    rows: list[tuple[Value, ...]] = []
    for friction, flaws in (("Table 3.1", IDEAL), ("none", SMOOTH)):
        for branch, limb in limbs.items():
            scenario = step_scenario(limb, flaws.control_rate, dy=-STEP, seconds=SECONDS)
            runs = run_contest(limb, scenario, entries(limb.chain, limb.q0, REFERENCE), flaws, plant=plant)
            rows += [_row(friction, branch, run) for run in runs]
            if flaws is IDEAL:
                kept[branch] = runs
    off = {(branch, run.entry.label): off_line(run) for branch, runs in kept.items() for run in runs}
    ratios = {m: min(off[b, transpose(m)] / off[b, SCCT] for b in BRANCHES) for m in (*MATCHED, "none")}
    limb = limbs["elbow +"]

    def paths(path: Path) -> None:
        from ...limb_bench.pictures.study import draw_step

        shown = {branch: [run for run in runs if run.entry.label != WEIGHTED_RATE] for branch, runs in kept.items()}
        draw_step(shown, CENTRE, STEP, TITLES[result], path)

    return StudyResult(
        paper=PAPER,
        result=result,
        claim=CLAIMS[result],
        verdict=judged({match: ratios[match] > 1.0 for match in MATCHED}),
        compared=(
            *(
                Compared(f"{label}, {branch}: largest |x - 0.22| [mm]", off[branch, label])
                for label in (SCCT, *(transpose(m) for m in (*MATCHED, "none")), *BASELINES)
                for branch in BRANCHES
            ),
            *(Compared(f"J^T over SCCT, matched {m}: least ratio [-]", ratios[m]) for m in MATCHED),
            *stiffness_facts(limb.chain, limb.q0, REFERENCE),
        ),
        deviations=(*OWN[result], *GAINS, *COMMON),
        table=Table(COLUMNS, tuple(rows)),
        figures=(Figure("paths", CAPTIONS[result], paths),),
    )


TITLES: Final = {
    "fig-3-11": "Step of 2 cm along y, simple model (ODE 3.28)",
    "fig-3-12": "Step of 2 cm along y, limb in MuJoCo",
}
CLAIMS: Final = {
    "fig-3-11": "Figure 3.11, section 3.4.3: in simulation of the simple model, SCCT holds x through a step of 2 cm along y "
    "from (0.22, 0) to (0.22, -0.02) m; Jacobian transpose control does not.",
    "fig-3-12": "Figure 3.12, section 3.4.3: on the limb itself SCCT holds x through the same step, and Jacobian transpose control "
    "does not, for J^T F makes no motion along F.",
}
CAPTIONS: Final = {
    "fig-3-11": "The step on the simple model: path of the tip, x stretched, and x over time; "
    "J^T with the same numbers in N/m leaves the picture.",
    "fig-3-12": "The step on the limb in MuJoCo: path of the tip, x stretched, and x over time; "
    "J^T with the same numbers in N/m leaves the picture.",
}
OWN: Final = {
    "fig-3-11": (
        "The model is equation 3.28 with the signs of damping and friction put right, and stick and slip solved exactly; the text "
        "names 3.27 for it.",
        "The table has the step without Coulomb friction, too.",
    ),
    "fig-3-12": (
        *PLANT,
        "The table has the step without Coulomb friction, too: there J^T matched by yy strays less than with it.",
    ),
}
COMMON: Final = (
    '"The same stiffness" is not defined: J^T is matched to SCCT\'s entry yy, to the mean of xx and yy, to each of both '
    '("diagonal"), and run with the same numbers ("none"). The verdict asks for all of yy, mean and diagonal on both branches.',
    "No law reaches y = -20 mm: friction holds the tip where the spring of the law is weaker than it. "
    "A softer law looks slower, not wrong.",
)
