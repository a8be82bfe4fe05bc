"""Section 6: the manipulability by the form of equation 19, by k_p (figure 11) and by the degrees of freedom (section 6.2)."""

from pathlib import Path
from typing import Final

import numpy as np

from ...families.walker.control.cooperative.cooperator import Cooperator
from ...families.walker.control.cooperative.freedoms import freedoms_of, weights_of
from ...families.walker.control.cooperative.planted_feet import PlantedFeet
from ...families.walker.control.cooperative.settings import Cooperation, Form, own_speeds
from ...types import Floats
from ..result import Compared, Figure, StudyResult, Table, Value
from .tool_runs import BALANCED, CHOSEN, DOFS, GAINS, RUNS, START, TOOL_SPEEDS, ToolRun, go, random_case
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
