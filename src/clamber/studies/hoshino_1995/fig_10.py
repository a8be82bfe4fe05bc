"""Figure 10: the same target with 4, 5 and 10 degrees of freedom."""

from pathlib import Path
from typing import Final

import numpy as np

from ...control.cooperative.limits import freedom_names
from ...types import Floats
from ..result import Compared, Figure, StudyResult, Table, Value, Verdict
from . import PAPER
from .tool_runs import BALANCED, CHOSEN, DOFS, ToolRun, go
from .walker import hoshino

GAIN: Final = 1.0
SHOWN: Final = (4, 5, 10)
"""Of the paper's figure."""
VISIBLE: Final = 0.02
"""Joint angles that differ by more count as another motion [rad]."""
HEIGHT_SPEEDS: Final = (0.05, 0.1, 0.2)
"""Of the plate's height in T_q, tried besides [m/s]."""
DRAWN_SPEED: Final = 0.1
"""One of them, for the picture [m/s]."""
REACHED: Final = 1e-3
"""[m]."""


def compare_freedoms() -> StudyResult:
    """The way of the tool with every set of freedoms; ends, and by how much the motions differ."""
    free = {dof: go(dof, GAIN) for dof in DOFS}
    kept = {dof: go(dof, GAIN, limited=True, feedback=2.0) for dof in DOFS}
    pairs = [(a, b) for a in SHOWN for b in SHOWN if a < b]
    apart = {pair: _apart(free[pair[0]], free[pair[1]]) for pair in pairs}
    faster = {speed: _apart(*(go(dof, GAIN, speeds=_with_height(speed)) for dof in (4, 5))) for speed in HEIGHT_SPEEDS}
    reached = all(free[dof].off_end < REACHED for dof in SHOWN)
    unseen = [pair for pair, value in apart.items() if value <= VISIBLE]
    by_speeds = unseen == [(4, 5)] and max(faster.values()) > VISIBLE
    verdict: Verdict = "differs" if not reached or (unseen and not by_speeds) else "open" if unseen else "holds"
    names = freedom_names(hoshino())
    rows: list[tuple[Value, ...]] = []
    for title, runs in (("equation 19", free), ("with every limit", kept)):
        for dof, run in runs.items():
            rows.append((title, dof, 1e3 * run.off_end, float(run.measure.mean()), *map(float, run.q[-1])))

    def motions(path: Path) -> None:
        from ...viewing.tool_runs_plot import Motion, draw_motions

        higher = f", $T_q$ of z {DRAWN_SPEED:g} m/s"
        shown = [(free[dof], "") for dof in SHOWN]
        shown.insert(2, (go(5, GAIN, speeds=_with_height(DRAWN_SPEED)), higher))
        draw_motions([Motion(run.title + more, run.footing, run.q, run.places) for run, more in shown], path)

    return StudyResult(
        paper=PAPER,
        result="fig-10",
        claim="Figure 10, section 6.2: with 4, 5 and 10 degrees of freedom the tool goes the same way by different motions.",
        verdict=verdict,
        compared=(
            *(Compared(f"{dof} dof: tool off the target at the end [mm]", 1e3 * free[dof].off_end) for dof in SHOWN),
            *(Compared(f"{a} and {b} dof: largest difference of a joint angle [rad]", apart[a, b]) for a, b in pairs),
            *(
                Compared(f"4 and 5 dof, T_q of z {speed:g} m/s: largest difference of a joint angle [rad]", value)
                for speed, value in faster.items()
            ),
            *(
                Compared(
                    f"{dof} dof: {names[k]} at the end less at the start [{'mm' if k < 3 else 'deg'}]",
                    _moved(free[dof], k),
                )
                for dof, k in ((5, 2), (10, 0), (10, 2), (10, 3), (10, 4))
            ),
            *(
                Compared(f"{dof} dof, every limit kept: tool off the target [mm]", 1e3 * kept[dof].off_end)
                for dof in SHOWN
            ),
        ),
        deviations=(
            *CHOSEN,
            f"k_p of the figure is not printed; {GAIN:g} here. The paper's law has no feedback, so the tool drifts a little off.",
            "In the paper's equations the plate's freedoms are independent of its feet: it tilts on the spot. With every limit kept, the "
            "plate stands on its feet, so a tilt carries it along, and actuators and legs have their own lengths and speeds.",
            "How much the height takes part goes with the square of its speed in T_q: at 0.02 m/s the motions of 4 and 5 dof cannot be "
            "told apart by eye, at 0.1 m/s they can. The paper does not print its speeds.",
        ),
        table=Table(
            ("law", "dof", "off the target [mm]", "mean V [-]", *(f"{n} at the end" for n in names)), tuple(rows)
        ),
        figures=(Figure("motions", f"Start (faint), middle and end of the motions, k_p = {GAIN:g}.", motions),),
    )


def _with_height(speed: float) -> Floats:
    """T_q's speeds with another one along z."""
    out = BALANCED.copy()
    out[2] = speed
    return out


def _apart(a: ToolRun, b: ToolRun) -> float:
    """Largest difference of a joint angle of the arm over the motion [rad]."""
    return float(np.abs(a.q[:, 6:] - b.q[:, 6:]).max())


def _moved(run: ToolRun, k: int) -> float:
    """How far a freedom moved [mm, deg]."""
    return float(run.q[-1, k] - run.q[0, k]) * (1e3 if k < 3 else float(np.degrees(1.0)))
