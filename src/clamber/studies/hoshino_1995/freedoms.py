"""Section 6: the tool moved by 5 to 10 degrees of freedom (figure 10), and the manipulability by the form of equation 19 and by k_p."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from ...families.walker.control.cooperative.cooperator import Cooperator
from ...families.walker.control.cooperative.freedoms import freedoms_of, weights_of
from ...families.walker.control.cooperative.limits import freedom_names
from ...families.walker.control.cooperative.planted_feet import PlantedFeet
from ...families.walker.control.cooperative.settings import Cooperation, Form, own_speeds
from ...families.walker.control.cooperative.tool_chain import POSE
from ...families.walker.pictures.tool_plots import Motion, draw_freedoms, draw_gains, draw_motions
from ...types import Floats
from ..result import Cells, Compared, Figure, StudyResult, Table, Verdict
from .tool_runs import BALANCED, CHOSEN, DOFS, GAINS, RUNS, START, TOOL_SPEEDS, ToolRun, go, random_case
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
    rows: list[Cells] = []
    for title, runs in (("equation 19", motions.free), ("with every limit", motions.kept)):
        for dof, run in runs.items():
            rows.append((title, dof, 1e3 * run.off_end, float(run.measure.mean()), *map(float, run.q[-1])))
    names = freedom_names(hoshino())
    return Table(("law", "dof", "off the target [mm]", "mean V [-]", *(f"{n} at the end" for n in names)), tuple(rows))


def _figure(motions: Motions) -> Figure:
    shown = [(motions.free[dof], motions.free[dof].title) for dof in SHOWN]
    shown.insert(2, (motions.faster[DRAWN_SPEED], f"5 dof, $T_q$ of z {DRAWN_SPEED:g} m/s"))
    pictured = [Motion(title, run.footing, run.q, run.places) for run, title in shown]
    caption = (
        f"Start (faint), middle and end of the motions from the side, k_p = {GAIN:g}, and the arm's joints over time in the colours of the "
        "titles; 5 dof with the height at 0.02 m/s (dashed) lies on 4 dof."
    )
    return Figure("motions", caption, lambda path: draw_motions(pictured, shown[0][0].time, path))


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
    rows: tuple[Cells, ...] = tuple((*key, part) for key, part in falls.items())
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
    rows: list[Cells] = [
        (seed, dof, *map(float, values[seed])) for dof, values in means.items() for seed in range(RUNS)
    ]
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
                "courses",
                "V along the usual way with 10 dof; mean V of random ways, over that with k_p = 0.",
                lambda path: draw_gains(
                    usual[0.0].time, {gain: run.measure for gain, run in usual.items()}, means, path
                ),
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
    rows: list[Cells] = [
        (gain, seed, *map(float, means[g, seed])) for g, gain in enumerate(GAINS) for seed in range(RUNS)
    ]
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
        figures=(
            Figure(
                "spread",
                "Mean V of each random way by degrees of freedom, one panel for each k_p.",
                lambda path: draw_freedoms(means, DOFS, GAINS, path),
            ),
        ),
    )
