"""Section 6.2: the more degrees of freedom, the larger the manipulability."""

from pathlib import Path

import numpy as np

from ..result import Compared, Figure, StudyResult, Table, Value
from . import PAPER
from .tool_runs import CHOSEN, DOFS, GAINS, RUNS, go, random_case


def count_freedoms() -> StudyResult:
    """Mean manipulability of random ways by set of freedoms and gain; starts are the same postures."""
    cases = [random_case(seed) for seed in range(RUNS)]
    means = np.empty((len(GAINS), RUNS, len(DOFS)))
    first = np.empty((RUNS, len(DOFS)))
    for g, gain in enumerate(GAINS):
        for seed, (start, way) in enumerate(cases):
            runs = [go(dof, gain, start=start, way=way) for dof in DOFS]
            means[g, seed] = [run.measure.mean() for run in runs]
            first[seed] = [run.measure[0] for run in runs]
    in_place = int((np.diff(first, axis=1) >= 0.0).all(axis=1).sum())
    grows = {
        (gain, a, b): int((means[g][:, DOFS.index(b)] > means[g][:, DOFS.index(a)]).sum())
        for g, gain in enumerate(GAINS)
        for a, b in ((4, 5), (5, 7), (7, 10), (4, 10))
    }
    rows: list[tuple[Value, ...]] = [
        (gain, seed, *map(float, means[g, seed])) for g, gain in enumerate(GAINS) for seed in range(RUNS)
    ]

    def spread(path: Path) -> None:
        from ...families.walker.pictures.tool_plots import draw_freedoms

        draw_freedoms(means, DOFS, GAINS, path)

    return StudyResult(
        paper=PAPER,
        result="section-6-2",
        claim="Section 6.2: generally, as the degrees of freedom get more, the manipulability measure gets larger.",
        verdict="holds" if in_place == RUNS and min(grows.values()) > RUNS // 2 else "differs",
        compared=(
            Compared(f"same posture: starts of {RUNS} at which V grows from 4 to 5 to 7 to 10 dof", in_place),
            *(
                Compared(f"k_p = {gain:g}: ways of {RUNS} with a larger mean V with {b} dof than with {a}", count)
                for (gain, a, b), count in grows.items()
            ),
            *(
                Compared(f"k_p = {gain:g}: median of mean V with {dof} dof [-]", float(np.median(means[g][:, k])))
                for g, gain in enumerate(GAINS)
                for k, dof in enumerate(DOFS)
            ),
        ),
        deviations=(
            *CHOSEN,
            "In one posture it is a theorem: a freedom more adds a column c to J^, and det(J^ J^' + c c') >= det(J^ J^'). Along a way each "
            'set takes its own motion, so it need not be; "generally" is read as on more than half of the ways, for each step from set to '
            "set and each k_p.",
            f"{RUNS} random ways as for figure 11.",
        ),
        seeds=range(RUNS),
        table=Table(("k_p", "seed", *(f"mean V, {dof} dof" for dof in DOFS)), tuple(rows)),
        figures=(Figure("spread", "Mean V of each random way by degrees of freedom, one panel for each k_p.", spread),),
    )
