"""Figure 11: the manipulability along the way with k_p = 0, 1 and 5."""

from pathlib import Path

import numpy as np

from ...families.walker.control.cooperative.settings import Form
from ...types import Floats
from ..result import Compared, Figure, StudyResult, Table, Value
from . import PAPER
from .tool_runs import CHOSEN, DOFS, GAINS, RUNS, ToolRun, go, random_case


def vary_gain() -> StudyResult:
    """The way of figure 10 with three gains, and random ways, with every set of freedoms."""
    usual = {gain: go(10, gain) for gain in GAINS}
    means = {dof: _means(dof, "right") for dof in DOFS}
    printed = _means(10, "as printed")
    instants = _instants(list(usual.values()))
    ordered = {dof: _rising(values) for dof, values in means.items()}
    rows: list[tuple[Value, ...]] = [
        (seed, dof, *map(float, values[seed])) for dof, values in means.items() for seed in range(RUNS)
    ]

    def courses(path: Path) -> None:
        from ...families.walker.pictures.tool_plots import draw_gains

        draw_gains(usual[0.0].time, {gain: run.measure for gain, run in usual.items()}, means, path)

    return StudyResult(
        paper=PAPER,
        result="fig-11",
        claim="Figure 11, section 6.3: as k_p gets larger (0, 1, 5), the manipulability measure gets larger.",
        verdict="holds" if ordered[10] == RUNS else "differs",
        compared=(
            *(
                Compared(f"mean V over the way, 10 dof, k_p = {gain:g} [-]", float(usual[gain].measure.mean()))
                for gain in GAINS
            ),
            *(
                Compared(f"random ways of {RUNS} on which the mean V grows from 0 to 1 to 5, {dof} dof", ordered[dof])
                for dof in DOFS
            ),
            *(
                Compared(
                    f"mean V with k_p = 5 over that with 0, median of the random ways, {dof} dof [-]", _gain(means[dof])
                )
                for dof in DOFS
            ),
            Compared("part of the instants of the usual way at which V grows with k_p [-]", instants),
            Compared(f"random ways of {RUNS} on which the mean V grows, 10 dof, as printed", _rising(printed)),
        ),
        deviations=(
            *CHOSEN,
            "The claim is read as one about the mean over the motion: all motions start in one posture, so no gain can have the larger V "
            "at every instant, and the greedy ascent of one gain may later be overtaken by another.",
            f"{RUNS} random ways: joints of the start uniform between (-2, 0.5, -2, -1.5) and (2, 1.5, -0.5, 1.5) rad, ways of 0.1 to "
            "0.35 m in any direction with an end that the arm alone reaches.",
            "No limits: k_p = 5 asks more of body and joints than they can do. With limits see `clamber follow --gain`.",
            '"As printed" takes the gradient of the plain Jacobian\'s V (13, 16) in equation 19.',
        ),
        seeds=range(RUNS),
        table=Table(("seed", "dof", *(f"mean V, k_p = {gain:g}" for gain in GAINS)), tuple(rows)),
        figures=(
            Figure(
                "courses", "V along the usual way with 10 dof; mean V of random ways, over that with k_p = 0.", courses
            ),
        ),
    )


def _means(dof: int, form: Form) -> Floats:
    """Mean V by random way and gain, shape (RUNS, 3); V is that of the normalised chain in both forms."""
    out = np.empty((RUNS, len(GAINS)))
    for seed in range(RUNS):
        start, way = random_case(seed)
        out[seed] = [go(dof, gain, start=start, way=way, form=form).measure.mean() for gain in GAINS]
    return out


def _rising(means: Floats) -> int:
    """On how many ways the mean grows with every gain."""
    return int(sum(bool(row.all()) for row in np.diff(means, axis=1) > 0.0))


def _gain(means: Floats) -> float:
    return float(np.median(means[:, -1] / means[:, 0]))


def _instants(runs: list[ToolRun]) -> float:
    """Part of the instants after the first at which V grows with every gain [-]."""
    courses = np.array([run.measure for run in runs])[:, 1:]
    return float((np.diff(courses, axis=0) > 0.0).all(axis=0).mean())
