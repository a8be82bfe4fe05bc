"""Equations 12 to 19: whether the second term makes the manipulability larger, in its right form and as printed."""

from typing import Final

import numpy as np

from ...families.walker.control.cooperative.cooperator import Cooperator
from ...families.walker.control.cooperative.freedoms import freedoms_of, weights_of
from ...families.walker.control.cooperative.planted_feet import PlantedFeet
from ...families.walker.control.cooperative.settings import Cooperation, Form, own_speeds
from ...types import Floats
from ..result import Compared, StudyResult, Table, Value
from . import PAPER
from .tool_runs import BALANCED, CHOSEN, DOFS, START, TOOL_SPEEDS
from .walker import hoshino

POSTURES: Final = 2000
SEED: Final = 19
INSTANT: Final = 1e-5
"""Time over which V is compared [s]."""
TILT: Final = 0.17
"""Largest tilt of the plate in the postures [rad]."""


def check_second_term() -> StudyResult:
    """The tool rests and the second term alone moves the robot: how often V falls, by form, freedoms and speeds."""
    robot = hoshino()
    assert robot.arm is not None
    rng = np.random.default_rng(SEED)
    low, high = np.array(robot.arm.lowest), np.array(robot.arm.highest)
    postures = np.tile(START, (POSTURES, 1))
    postures[:, 3:6] = rng.uniform(-1.0, 1.0, (POSTURES, 3)) * (1.0, TILT, TILT)
    postures[:, 6:] = rng.uniform(low, high, (POSTURES, low.size))
    footing = PlantedFeet(robot=robot, support="y", pose=START[:6])
    speeds = {"0.05 m/s, 0.15 rad/s": BALANCED, "of actuators and legs": own_speeds(robot)}
    forms: tuple[Form, ...] = ("right", "as printed")
    falls: dict[tuple[str, str, int], float] = {}
    for title, chosen in speeds.items():
        for form in forms:
            settings = Cooperation(
                speeds=chosen, tool_speeds=TOOL_SPEEDS, gain=1.0, feedback=0.0, period=INSTANT, form=form, limited=False
            )
            law = Cooperator(robot, settings, footing)
            for dof in DOFS:
                weights = weights_of(freedoms_of(dof, 4), 4)
                falls[title, form, dof] = _falls(law, postures, weights)
    rows: tuple[tuple[Value, ...], ...] = tuple((*key, part) for key, part in falls.items())
    right = [part for (_, form, _), part in falls.items() if form == "right"]
    printed = [part for (_, form, _), part in falls.items() if form == "as printed"]
    return StudyResult(
        paper=PAPER,
        result="equation-19",
        claim='Section 6.1: with k of (14) to (16) in (12), and normalised in (19), "the value V(q) becomes bigger".',
        verdict="holds" if max(printed) == 0.0 else "differs",
        compared=(
            Compared("right form: part of the postures in which V falls, most [-]", max(right)),
            Compared("as printed: part of the postures in which V falls, least [-]", min(printed)),
            Compared("as printed: part of the postures in which V falls, most [-]", max(printed)),
            *(
                Compared(
                    f"as printed, {dof} dof, speeds {title}: part in which V falls [-]", falls[title, "as printed", dof]
                )
                for title in speeds
                for dof in DOFS
            ),
        ),
        deviations=(
            *CHOSEN[:2],
            "As printed, V (13) and its gradient (16) are those of the plain Jacobian while (19) projects with the normalised one. In the "
            "right form both are normalised, and dV/dt = k_p |(I - J^+ J^) dV/dq^|^2 >= 0 is a theorem; here it is counted.",
            "V is that of the normalised Jacobian, and falls where it falls by more than a millionth of itself in a second.",
            "Printed besides: a freedom is switched off by terms of T_q (18) that tend to 0, which cannot be inverted; it is those of "
            "T_q^-1. (15) has 8 components for 10 freedoms. (12) minimises the norm of the error, not a determinant.",
            f"{POSTURES} postures: joints uniform over their ranges, yaw within 1 rad and tilts within {TILT} rad.",
        ),
        seeds=range(SEED, SEED + 1),
        table=Table(("speeds", "form", "dof", "part in which V falls [-]"), rows),
    )


def _falls(law: Cooperator, postures: Floats, weights: Floats) -> float:
    """Part of the postures in which the second term makes V smaller [-]."""
    fallen, still = 0, np.zeros(3)
    for q in postures:
        before = law.measure(q, weights)
        after = law.measure(law.step(q, still, still, weights).q, weights)
        fallen += (after - before) / INSTANT < -1e-6 * max(before, 1e-3)
    return fallen / len(postures)
