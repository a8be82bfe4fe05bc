"""Sections 3.2.3 and 3.3.2: how resolved rate control damps each direction, and SCCT as an implicit admittance."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np

from ...control.controller import Controller, still_aim
from ...control.law_settings import LawSettings
from ...limb_bench.stability import loop_matrix
from ...sim.bench_limb import BenchLimb
from ..result import Cells, Compared, StudyResult, Table, Verdict
from .limb_entries import GAINS, PLANT, SMOOTH, leg_1, scct

SOFTER: Final = 10.0
"""By so much x is softer than y [-]."""
STIFF: Final = 400.0
"""Kp along y [N m/rad]."""
WELL: Final = (0.7, 1.4)
"""Damping ratios between which a direction counts as damped rightly [-]."""
SERVOS: Final = tuple(float(value) for value in np.geomspace(1.0, 100.0, 41))
"""Damping of the joint servo that is tried [N m s/rad]."""
STATES: Final = 1000
"""Random states in which two laws are compared."""
DERIVATIVE: Final = 0.02
"""K'_d over K'_p of the admittance that keeps it [s]."""
MOVES: Final = 1e-9
"""Part of a motion that is not rounding [-]."""
SAME: Final = 1e-9
"""Torques that differ by no more are the same, over the largest [-]."""


def judge_damping(rate: Iterable[tuple[float, float]], direct: Iterable[tuple[float, float]]) -> Verdict:
    """The verdict, from the damping ratios along x and y of resolved rate with each joint servo, and of SCCT on each elbow branch.

    It holds if resolved rate damps both directions rightly with no servo, and SCCT both on either branch; it differs if resolved rate does
    with one.
    """
    if any(map(_well, rate)):
        return "differs"
    return "holds" if all(map(_well, direct)) else "open"


def judge_identity(without: float, kept: float) -> Verdict:
    """The verdict, from the largest differences of torques from SCCT's over the largest torque, without K'_d and with it."""
    return "holds" if without <= SAME < kept else "differs"


def damp_directions() -> StudyResult:
    """Damping ratios of a stiff y and a soft x under resolved rate with every joint servo, and under SCCT."""
    rows: list[Cells] = []
    rate: list[tuple[float, float]] = []
    direct: list[tuple[float, float]] = []
    for branch, limb in leg_1().items():
        stiffness = np.array((STIFF / SOFTER, STIFF))
        damping = 2.0 * np.sqrt(stiffness * limb.chain.largest_inertia)
        kp = tuple(stiffness.tolist())
        ratios = damping_ratios(limb, scct(kp, tuple(damping.tolist())))
        direct.append(ratios)
        rows.append((branch, "SCCT", None, *ratios))
        for servo in SERVOS:
            law = LawSettings(law="resolved-rate", kp=kp, joint_kd=servo, weight="inertia")
            ratios = damping_ratios(limb, law)
            rate.append(ratios)
            rows.append((branch, "resolved rate", servo, *ratios))
    apart = [float(y / x) for x, y in rate]
    return StudyResult(
        claim="Section 3.2.3: resolved rate control with a Cartesian gain leaves the damping in the joints, so that a direction is "
        "over-damped or under-damped where stiffnesses differ.",
        verdict=judge_damping(rate, direct),
        compared=(
            Compared("joint servos with which resolved rate damps x and y rightly", sum(map(_well, rate))),
            Compared("servos tried, on two elbow branches", len(rate)),
            Compared("resolved rate: damping ratio along x over that along y, least [-]", 1.0 / max(apart)),
            Compared("resolved rate: damping ratio along x over that along y, most [-]", 1.0 / min(apart)),
            Compared("SCCT: damping ratio along x, least and most [-]", _span([x for x, _ in direct])),
            Compared("SCCT: damping ratio along y, least and most [-]", _span([y for _, y in direct])),
        ),
        deviations=(
            f"The thesis shows no experiment of it. x is taken {SOFTER:g} times softer than y (Kp {STIFF:g}); damping ratios are those of "
            "the loop of law and limb made linear at rest, at 200 Hz, without Coulomb friction.",
            f"Rightly damped is a ratio from {WELL[0]:g} to {WELL[1]:g}. Holds if none of {len(SERVOS)} servos from {SERVOS[0]:g} to "
            f"{SERVOS[-1]:g} N m s/rad damps both directions rightly and SCCT, with Kd of its own for each, does; differs if one servo "
            "does; the rule was fixed before ratios were computed.",
            "Resolved rate is weighted by inertia, as SCCT is, which is its best case: x and y do not disturb each other then.",
            *PLANT,
            GAINS[0],
        ),
        table=Table(
            ("branch", "law", "joint damping [N m s/rad]", "damping ratio along x [-]", "damping ratio along y [-]"),
            tuple(rows),
        ),
    )


def compare_admittance() -> StudyResult:
    """Torques of the implicit admittance control, equation 3.25, without its K'_d and with it, beside SCCT's, equation 3.16."""
    limb = next(iter(leg_1().values()))
    reference = scct(200.0, 10.0)
    off = {
        derivative: _largest_difference(limb, replace(reference, law="implicit-admittance", derivative=derivative))
        for derivative in (0.0, DERIVATIVE)
    }
    return StudyResult(
        claim="Section 3.3.2: the implicit admittance control, 3.25, becomes SCCT, 3.16, when K'_d is left out; the two equations can be "
        "identical though one commands velocities and the other accelerations.",
        verdict=judge_identity(off[0.0], off[DERIVATIVE]),
        compared=(
            Compared("random states of the limb", STATES),
            Compared("without K'_d: largest difference of a torque, over the largest [-]", off[0.0]),
            Compared(f"with K'_d = {DERIVATIVE:g} s K'_p: the same [-]", off[DERIVATIVE]),
        ),
        deviations=(
            "Two laws of Clamber are compared, each written from its own equation; it is an identity and tests that they are those "
            "equations. K'_d acts from the second tick on, on what the first has left.",
            f"Holds if torques are the same to {SAME:g} without K'_d and differ with it; the rule was fixed beforehand.",
            *PLANT,
        ),
        seeds=range(1),
    )


def damping_ratios(limb: BenchLimb, settings: LawSettings) -> tuple[float, float]:
    """Damping ratios of the loop at rest at the limb's start along x and y [-]; over 1 for two real roots.

    Of the loop's roots each belongs to the axis along which its motion carries the tip farther.
    """
    n = limb.chain.n
    roots, motions = np.linalg.eig(loop_matrix(limb.chain, settings, SMOOTH, limb.q0))
    # numbers in the law's memory that nothing moves stand there as roots of 1 that move no joint
    moving = np.flatnonzero((np.abs(motions[:n]).max(axis=0) > MOVES) & (np.abs(roots) > MOVES))
    slow = moving[np.argsort(-np.abs(roots[moving]))][: 2 * n]
    tips = np.abs(limb.chain.jacobian(limb.q0)[:2] @ motions[:n, slow])
    rates = np.log(roots[slow].astype(complex)) / SMOOTH.period
    lean = tips[1] / np.maximum(tips.sum(axis=0), 1e-300)
    along_y = np.argsort(-lean)[:2]
    along_x = np.argsort(lean)[:2]
    x, y = (float(-0.5 * rates[pair].sum().real / np.sqrt(rates[pair].prod()).real) for pair in (along_x, along_y))
    return x, y


def _largest_difference(limb: BenchLimb, settings: LawSettings) -> float:
    """Of two ticks in each of many random states, from SCCT of the same gains, over SCCT's largest torque [-]."""
    rng = np.random.default_rng(0)
    off = largest = 0.0
    for _ in range(STATES):
        aim = still_aim(limb.chain.place(limb.q0) + rng.normal(size=3) * 0.02)
        states = [limb.q0 + rng.normal(size=2) * 0.1, rng.normal(size=2)]
        later = [states[0] + SMOOTH.period * states[1], states[1]]
        told = []
        for law in (settings, replace(settings, law="scct")):
            controller = Controller(limb.chain, law, period=SMOOTH.period)
            controller.command(aim, np.array([states]))
            told.append(controller.command(aim, np.array([later]))[0].copy())
        off = max(off, float(np.abs(told[0] - told[1]).max()))
        largest = max(largest, float(np.abs(told[1]).max()))
    return off / largest


def _well(ratios: tuple[float, float]) -> bool:
    return all(WELL[0] <= ratio <= WELL[1] for ratio in ratios)


def _span(values: list[float]) -> str:
    return f"{min(values):.3g} to {max(values):.3g}"
