"""Section 3.5, Figure 3.15: force along a wall's normal and motion along it, with the wall known and wrongly known."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from ...limb_bench.force import ForceResult, force_entries, run_force
from ...limb_bench.scenario import ForceTask
from ...sim.bench_limb import BenchLimb
from ...units import DEGREE
from ...viewing.study_lines_plot import Points, draw_panels
from ..result import Cells, Compared, Figure, StudyResult, Table, Verdict
from . import MILLI
from .limb_entries import IDEAL, PLANT, leg_1

ANGLES: Final = (60.0, 90.0, 120.0)
"""Directions into the wall, from the limb's x axis [deg]."""
WRONG_ANGLE: Final = 30.0
"""By so much the laws are wrong about it [deg]."""
WRONG_STIFFNESS: Final = 2.0
"""The laws believe the wall this many times as stiff [-]."""
ALONG: Final = 0.002
"""Largest error of the place along the wall that is still following it [m]."""
WORSE: Final = 2.0
"""An error this many times that with the wall known is larger for want of knowledge [-]."""
HYBRID: Final = "hybrid"
IMPLICIT: Final = "implicit-force"
KNOWN: Final = "known"
ASKEW: Final = f"angle {WRONG_ANGLE:g} deg wrong"
STIFFER: Final = f"stiffness {WRONG_STIFFNESS:g} times too high"


@dataclass(frozen=True, slots=True)
class Pressed:
    """What one law did on one wall."""

    held: bool
    """Whether the force stayed within 1 N and the tip on the wall."""
    force: float
    """Largest error of the force [N]."""
    along: float
    """Largest error along the wall [m]."""


Pressings = Mapping[tuple[str, str], list[Pressed]]
"""Law, what is known -> on each wall."""


def judged(told: Pressings) -> Verdict:
    """holds: both laws do with the wall known, and err twice as far without; open: knowledge makes no difference; differs: they do not."""
    if not all(one.held and one.along <= ALONG for law in (HYBRID, IMPLICIT) for one in told[law, KNOWN]):
        return "differs"
    needs = all(
        wrong.force > WORSE * known.force
        for law, case in ((HYBRID, ASKEW), (IMPLICIT, STIFFER))
        for wrong, known in zip(told[law, case], told[law, KNOWN], strict=True)
    )
    return "holds" if needs else "open"


def press_walls() -> StudyResult:
    """Hybrid and implicit force control on walls at three angles, 20 N and a slide of 3 cm, with the wall known and not."""
    limb = leg_1()["elbow +"]
    results = {
        (law, case, angle): _press(limb, law, case, angle)
        for law, case in ((HYBRID, KNOWN), (HYBRID, ASKEW), (IMPLICIT, KNOWN), (IMPLICIT, STIFFER))
        for angle in ANGLES
    }
    told: dict[tuple[str, str], list[Pressed]] = {}
    for (law, case, _), result in results.items():
        one = result.rows[0].measures
        told.setdefault((law, case), []).append(Pressed(one.held, one.worst, one.off_line))
    return StudyResult(
        claim="Section 3.5, Figure 3.15: SCCT along a wall and J^T across it control motion and force if the wall's angle is known; "
        "implicit force control, a place inside the wall, does if its stiffness is. No results are printed.",
        verdict=judged(told),
        compared=(
            *(Compared(f"{law}, {case}: walls with 20 N held within 1 N, of {len(ANGLES)}", sum(one.held for one in pressed))
              for (law, case), pressed in told.items()),
            *(Compared(f"{law}, {case}: largest error of force [N]", max(one.force for one in pressed))
              for (law, case), pressed in told.items()),
            *(Compared(f"{law}, {case}: largest error along the wall [mm]", max(one.along for one in pressed) * MILLI)
              for (law, case), pressed in told.items()),
        ),
        deviations=(
            *PLANT,
            "The walls lie across 60, 90 and 120 deg from the limb's x axis, 2 mm before (0.22, 0) m, with 10 N/mm and no friction of "
            "their own; the force rises to 20 N, stands, slides 3 cm along the wall and stands again.",
            "Joint friction, which 3.3.3 counts among the external forces, is fed forward from the model: without that it is larger than "
            "the force to be controlled (`clamber limb force --friction-compensation none`).",
            "The motion sub-space is SCCT's, as the section's title says; its text says resolved rate, which SCCT is with gains alike.",
            f"The verdict is holds if, with the wall known, both laws keep 20 N within 1 N and the tip within {ALONG * MILLI:g} mm of its "
            f"place along the wall on all three walls, and hybrid control that is {WRONG_ANGLE:g} deg wrong about the angle and implicit "
            f"control that takes the wall for {WRONG_STIFFNESS:g} times as stiff err by more than {WORSE:g} times as much on each; open "
            "if knowledge makes no such difference, differs if the force or the place is not kept with the wall known.",
        ),
        table=Table(
            ("law", "wall", "into the wall [deg]", "held within 1 N", "largest error of force [N]", "largest error along the wall [mm]"),
            tuple(_row(law, case, pressed) for (law, case), walls in told.items() for pressed in zip(ANGLES, walls, strict=True)),
        ),
        figures=(_figure(results),),
    )  # fmt: skip


def _press(limb: BenchLimb, law: str, case: str, angle: float) -> ForceResult:
    true = ForceTask(angle=angle * DEGREE)
    task = ForceTask(
        angle=true.angle,
        believed_angle=true.angle + WRONG_ANGLE * DEGREE if case == ASKEW else None,
        believed_stiffness=WRONG_STIFFNESS * true.stiffness if case == STIFFER else None,
    )
    return run_force(limb, task, force_entries(limb, task, IDEAL, [law], ["model"]), IDEAL)


def _row(law: str, case: str, pressed: tuple[float, Pressed]) -> Cells:
    angle, one = pressed
    return law, case, angle, "yes" if one.held else "no", one.force, one.along * MILLI


def _figure(results: Mapping[tuple[str, str, float], ForceResult]) -> Figure:
    shown = {
        law: {
            f"{law}, {case}": Points(result.rows[0].run.trace.time, result.rows[0].run.force_into(result.task.angle))
            for (one, case, angle), result in results.items()
            if one == law and math.isclose(angle, ANGLES[1])
        }
        for law in (HYBRID, IMPLICIT)
    }
    return Figure(
        "forces",
        "True force into a wall at 90 deg: touched, pressed, slid along from 4 to 6 s.",
        lambda path: draw_panels(shown, ("time [s]", "true force into the wall [N]"), "20 N on a wall at 90 deg", path),
    )
