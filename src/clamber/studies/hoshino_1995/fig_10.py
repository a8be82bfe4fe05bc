"""Figure 10: the same target with 4, 5 and 10 degrees of freedom."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ...families.walker.control.cooperative.limits import freedom_names
from ...families.walker.control.cooperative.tool_chain import POSE
from ...types import Floats
from ..result import Compared, Figure, StudyResult, Table, Value, Verdict
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
PAIRS: Final = tuple((a, b) for a in SHOWN for b in SHOWN if a < b)
DEVIATIONS: Final = (
    *CHOSEN,
    f"k_p of the figure is not printed; {GAIN:g} here. The paper's law has no feedback, so the tool drifts a little off.",
    "In the paper's equations the plate's freedoms are independent of its feet: it tilts on the spot. With every limit kept, the plate "
    "stands on its feet, so a tilt carries it along, and actuators and legs have their own lengths and speeds.",
    "How much the height takes part goes with the square of its speed in T_q: at 0.02 m/s the motions of 4 and 5 dof cannot be told apart "
    "by eye, at 0.1 m/s they can. Its legs' own speed does not come near: with slides of 16.9 s the paper's "
    "cycle of 73.85 s leaves 10 s for a lift, which at 0.02 m/s is 0.2 m, and at 0.1 m/s would be a metre.",
    "The paper's figure shows a difference between 4 and 5 dof, and its equations let any freedom of the plate be the fifth. With those "
    "speeds x, y, beta or gamma make one that is seen, z does not, and alpha only turns the arm's first joint back by what the plate "
    "turns. So either the fifth was one of the four, or the height had a speed in T_q that its legs have not; nothing printed decides.",
)


@dataclass(frozen=True, slots=True, eq=False)
class Motions:
    """The tool's way with one set of freedoms after another."""

    free: dict[int, ToolRun]
    """Degrees of freedom -> by equation 19 alone."""
    kept: dict[int, ToolRun]
    """Likewise within every limit."""
    faster: dict[float, ToolRun]
    """Speed of the plate's height in T_q -> with 5 degrees of freedom [m/s]."""
    fifth: dict[str, ToolRun]
    """Freedom of the plate -> with it besides the arm's four."""

    @classmethod
    def gone(cls) -> "Motions":
        """All of them."""
        return cls(
            {dof: go(dof, GAIN) for dof in DOFS},
            {dof: go(dof, GAIN, limited=True, feedback=2.0) for dof in DOFS},
            {speed: go(5, GAIN, speeds=_with_height(speed)) for speed in HEIGHT_SPEEDS},
            {name: go(4, GAIN, besides=k) for k, name in enumerate(freedom_names(hoshino())[:POSE])},
        )

    def apart(self, a: int, b: int) -> float:
        """See `_apart`, of two sets."""
        return _apart(self.free[a], self.free[b])

    @property
    def verdict(self) -> Verdict:
        """Open where only 4 and 5 look alike, and what is not printed decides whether they do."""
        unseen = [pair for pair in PAIRS if self.apart(*pair) <= VISIBLE]
        others = max(_apart(self.free[4], run) for run in (*self.faster.values(), *self.fifth.values()))
        if any(self.free[dof].off_end >= REACHED for dof in SHOWN):
            return "differs"
        if not unseen:
            return "holds"
        return "open" if unseen == [(4, 5)] and others > VISIBLE else "differs"


def compare_freedoms() -> StudyResult:
    """The way of the tool with every set of freedoms; ends, and by how much the motions differ."""
    motions = Motions.gone()
    return StudyResult(
        claim="Figure 10, section 6.2: with 4, 5 and 10 degrees of freedom the tool goes the same way by different motions.",
        verdict=motions.verdict,
        compared=_compare(motions),
        deviations=DEVIATIONS,
        table=_table(motions),
        figures=(_figure(motions),),
    )


def _compare(motions: Motions) -> tuple[Compared, ...]:
    free, names = motions.free, freedom_names(hoshino())
    return (
        *(Compared(f"{dof} dof: tool off the target at the end [mm]", 1e3 * free[dof].off_end) for dof in SHOWN),
        *(
            Compared(f"{a} and {b} dof: largest difference of a joint angle [rad]", motions.apart(a, b))
            for a, b in PAIRS
        ),
        *(
            Compared(
                f"4 and 5 dof, T_q of z {speed:g} m/s: largest difference of a joint angle [rad]", _apart(free[4], run)
            )
            for speed, run in motions.faster.items()
        ),
        *(
            Compared(f"4 and 5 dof, the fifth {name}: largest difference of a joint angle [rad]", _apart(free[4], run))
            for name, run in motions.fifth.items()
        ),
        *(
            Compared(
                f"{dof} dof: {names[k]} at the end less at the start [{'mm' if k < 3 else 'deg'}]", _moved(free[dof], k)
            )
            for dof, k in ((5, 2), (10, 0), (10, 2), (10, 3), (10, 4))
        ),
        *(
            Compared(f"{dof} dof, every limit kept: tool off the target [mm]", 1e3 * motions.kept[dof].off_end)
            for dof in SHOWN
        ),
    )


def _table(motions: Motions) -> Table:
    rows: list[tuple[Value, ...]] = []
    for title, runs in (("equation 19", motions.free), ("with every limit", motions.kept)):
        for dof, run in runs.items():
            rows.append((title, dof, 1e3 * run.off_end, float(run.measure.mean()), *map(float, run.q[-1])))
    names = freedom_names(hoshino())
    return Table(("law", "dof", "off the target [mm]", "mean V [-]", *(f"{n} at the end" for n in names)), tuple(rows))


def _figure(motions: Motions) -> Figure:
    def draw(path: Path) -> None:
        from ...families.walker.pictures.tool_plots import Motion, draw_motions

        shown = [(motions.free[dof], motions.free[dof].title) for dof in SHOWN]
        shown.insert(2, (motions.faster[DRAWN_SPEED], f"5 dof, $T_q$ of z {DRAWN_SPEED:g} m/s"))
        pictured = [Motion(title, run.footing, run.q, run.places) for run, title in shown]
        draw_motions(pictured, shown[0][0].time, path)

    caption = (
        f"Start (faint), middle and end of the motions from the side, k_p = {GAIN:g}, and the arm's joints over time in the colours of the "
        "titles; 5 dof with the height at 0.02 m/s (dashed) lies on 4 dof."
    )
    return Figure("motions", caption, draw)


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
