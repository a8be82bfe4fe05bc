"""Figure 3.10: open loop, the torques of J^T F and of K' J^-1 a for a force and for an acceleration along -y."""

import math
from typing import Final

import numpy as np

from ...limb_bench.open_loop import FIRST, TRANSFORMS, OpenLoopRun, first_turn, run_open_loop, scaled_torques
from ...limb_bench.pictures.force import Drawn, draw_open_loop, draw_turns
from ...sim.bench_limb import BenchLimb
from ...types import Floats
from ...units import DEGREE
from ..result import Cells, Compared, Figure, StudyResult, Table
from . import MILLI
from .limb_entries import BRANCHES, IDEAL, PLANT, SMOOTH, leg_1

DOWN: Final = -math.pi / 2
FORCES: Final = (2.0, 5.0, 10.0, 20.0, 50.0)
"""[N]."""
STRONG: Final = 10.0
"""From here on friction bends the path little [N]."""
SECONDS: Final = 0.7
"""For 10 N to move the tip by more than 100 mm."""
FAR: Final = (0.02, 0.05)
"""Ways along -y at which the stray is told [m]."""
SHOWN: Final = 0.1
"""Way that the picture shows [m]."""
STRAIGHT: Final = 0.5
"""What we call along -y [deg]."""
TRANSPOSE: Final = "jacobian-transpose"
SCCT: Final = "scct"
NAMES: Final = {
    TRANSPOSE: "J^T F",
    SCCT: "K' J^-1 a",
    "resolved-rate": "J^-1 a",
    "operational-space": "H J^-1 a",
}
"""Law -> its transform."""
FRICTIONS: Final = {"Table 3.1": IDEAL, "none": SMOOTH}
ROUND: Final = np.arange(72) * math.tau / 72
"""Directions of the tip [rad]."""


def _degrees(angle: float | None) -> float | None:
    return None if angle is None else angle / DEGREE


def _all_round(limb: BenchLimb, transform: str) -> Floats:
    """How far the first acceleration without friction is off, for every direction [deg]."""
    out = np.empty(len(ROUND))
    for k, angle in enumerate(ROUND):
        wanted = np.array((math.cos(angle), math.sin(angle)))
        torques = scaled_torques(limb.chain, limb.q0, transform, wanted, STRONG)
        out[k] = first_turn(limb.chain, limb.q0, torques, wanted) / DEGREE
    return out


Key = tuple[str, str, str, float]
"""Friction, branch, transform, force."""


def _row(key: Key, run: OpenLoopRun) -> Cells:
    friction, branch, transform, force = key
    strays = tuple(None if stray is None else stray * MILLI for stray in map(run.stray, FAR))
    off, torques = _degrees(run.turned()), ", ".join(f"{round(float(torque), 3) + 0.0:.3f}" for torque in run.torques)
    return friction, branch, NAMES[transform], force, torques, off, *strays, run.moved * MILLI


Runs = dict[Key, OpenLoopRun]
Turns = dict[str, dict[str, Floats]]
"""Transform -> branch -> how far the first acceleration is off, by direction [deg]."""


def compare_transforms() -> StudyResult:
    """First motion and later path under both transforms, by force, branch and friction; and the first motion in every direction."""
    limbs = leg_1()
    runs: Runs = {
        (friction, branch, transform, force): run_open_loop(
            limb, transform, flaws, force=force, direction=DOWN, seconds=SECONDS
        )
        for friction, flaws in FRICTIONS.items()
        for branch, limb in limbs.items()
        for transform in (SCCT, TRANSPOSE)
        for force in FORCES
    }
    renewed = {
        branch: run_open_loop(limb, SCCT, SMOOTH, force=STRONG, direction=DOWN, seconds=SECONDS, renewed=True)
        for branch, limb in limbs.items()
    }
    off = {key: _degrees(run.turned()) for key, run in runs.items()}
    strong = {key: value for key, value in off.items() if key[3] >= STRONG}
    straight = all(value is not None and abs(value) < STRAIGHT for key, value in strong.items() if key[2] == SCCT)
    bent = all(value is not None and abs(value) > STRAIGHT for key, value in strong.items() if key[2] == TRANSPOSE)
    turns: Turns = {name: {branch: _all_round(limb, name) for branch, limb in limbs.items()} for name in TRANSFORMS}
    return StudyResult(
        claim="Figure 3.10, section 3.4.3: torques K' J^-1 a for an acceleration along -y start the tip along -y, torques J^T F for a "
        "force along -y do not; later the tip strays from -y, for Jdot qd grows.",
        verdict="holds" if straight and bent else "differs",
        compared=(*_first_motions(off), *_strays(runs, renewed), *_round_turns(turns), *_sideways(limbs["elbow +"])),
        deviations=(*_deviations(runs, renewed, turns), *PLANT),
        table=Table(
            (
                *("friction", "branch", "torques", "force [N]", "joints 1 and 4 [N m]", "first motion off -y [deg]"),
                *(f"stray after {far * MILLI:g} mm [mm]" for far in FAR),
                f"moved in {SECONDS:g} s [mm]",
            ),
            tuple(_row(key, run) for key, run in runs.items()),
        ),
        figures=_figures(runs, renewed, turns),
    )


def _figures(runs: Runs, renewed: dict[str, OpenLoopRun], turns: Turns) -> tuple[Figure, ...]:
    columns = {
        branch: [
            Drawn("J^T F", runs["Table 3.1", branch, TRANSPOSE, STRONG]),
            Drawn("J^T F, no friction", runs["none", branch, TRANSPOSE, STRONG], (0, (4, 1.5)), 1.2),
            Drawn("K' J^-1 a", runs["Table 3.1", branch, SCCT, STRONG]),
            Drawn("K' J^-1 a, no friction", runs["none", branch, SCCT, STRONG], (0, (4, 1.5)), 1.2),
            Drawn("the same, renewed with the pose", renewed[branch], (0, (1, 1)), 1.4),
        ]
        for branch in BRANCHES
    }
    return (
        Figure(
            "paths",
            f"Paths of the tip under steady torques of {STRONG:g} N along -y, and their beginning.",
            lambda path: draw_open_loop(
                columns, SHOWN * MILLI, f"Steady torques for a motion along -y, {STRONG:g} N", path
            ),
        ),
        Figure(
            "directions",
            "First acceleration without friction, off the wanted direction, for all directions.",
            lambda path: draw_turns(ROUND, turns, NAMES, path),
        ),
    )


def _first_motions(off: dict[Key, float | None]) -> tuple[Compared, ...]:
    return tuple(
        Compared(
            f"{NAMES[name]}, {branch}, {force:g} N{ending}: first motion off -y [deg]",
            off[friction, branch, name, force],
        )
        for friction, ending, forces in (("Table 3.1", "", FORCES), ("none", ", no friction", (STRONG,)))
        for name in (SCCT, TRANSPOSE)
        for branch in BRANCHES
        for force in forces
        if force >= STRONG
    )


def _round_turns(turns: Turns) -> tuple[Compared, ...]:
    return tuple(
        Compared(
            f"{NAMES[name]}: first acceleration off any direction, at most [deg]",
            max(float(np.abs(values).max()) for values in branches.values()),
        )
        for name, branches in turns.items()
    )


def _strays(runs: Runs, renewed: dict[str, OpenLoopRun]) -> tuple[Compared, ...]:
    out = []
    for far in FAR:
        for branch in BRANCHES:
            for name, run in (
                ("K' J^-1 a", runs["none", branch, SCCT, STRONG]),
                ("K' J^-1 a renewed with the pose", renewed[branch]),
                ("J^T F", runs["none", branch, TRANSPOSE, STRONG]),
            ):
                stray = run.stray(far)
                label = f"{name}, {branch}, no friction: stray after {far * MILLI:g} mm [mm]"
                out.append(Compared(label, None if stray is None else stray * MILLI))
    return tuple(out)


def _sideways(limb: BenchLimb) -> tuple[Compared, ...]:
    """The same transform along +x, where both joints have to move."""
    return tuple(
        Compared(
            f"K' J^-1 a along +x, elbow +, {force:g} N{ending}: first motion off [deg]",
            _degrees(run_open_loop(limb, SCCT, flaws, force=force, direction=0.0, seconds=SECONDS).turned()),
        )
        for flaws, force, ending in ((IDEAL, STRONG, ""), (IDEAL, FORCES[-1], ""), (SMOOTH, STRONG, ", no friction"))
    )


FIXED: Final = (
    f"The first motion is the line from the start to where the true tip is first {FIRST * MILLI:g} mm away; anticlockwise is positive.",
    "Torques stand still, as in an open-loop experiment. Those of both transforms are scaled so that the force they balance at the tip, "
    "J^-T tau, has the same part along -y; here that makes the shoulder's torques equal, and J^T F adds one in the elbow.",
    "Along +x both joints move, against friction and damping that differ between them: even K' J^-1 a starts crooked there, unless the "
    "force is large or friction is compensated. What makes -y straight at 10 N is that one joint does it.",
)


def _deviations(runs: Runs, renewed: dict[str, OpenLoopRun], turns: Turns) -> tuple[str, ...]:
    weak, weakest = (_degrees(runs["Table 3.1", "elbow +", TRANSPOSE, force].turned()) for force in (5.0, 2.0))
    still = [force for force in FORCES if runs["Table 3.1", "elbow +", SCCT, force].turned() is None]
    most = {name: max(float(np.abs(values).max()) for values in turns[name].values()) for name in turns}
    far = FAR[-1]
    shares = [
        abs((renewed[branch].stray(far) or math.nan) / (runs["none", branch, SCCT, STRONG].stray(far) or math.nan))
        for branch in BRANCHES
    ]
    return (
        *FIXED,
        f"Below 10 N friction decides: it turns J^T F to {weak or math.nan:.1f} deg at 5 N and {weakest or math.nan:.1f} deg at 2 N, "
        f"and K' J^-1 a does not move the limb by {FIRST * MILLI:g} mm at {', '.join(f'{force:g}' for force in still) or 'no force'} N.",
        "At (0.22, 0) m a motion along -y is one of the shoulder alone, so K' has no part in the experiment, and J^T F is near its best: "
        f"in other directions it starts up to {most[TRANSPOSE]:.0f} deg off. Without K', J^-1 a is up to {most['resolved-rate']:.0f} "
        f"deg off, K' J^-1 a at most {most[SCCT]:.2f} deg.",
        f"Jdot qd is a part only of the later stray: torques that are renewed with the pose leave it alone, and stray {min(shares):.2f} to "
        f"{max(shares):.2f} times as far after {far * MILLI:g} mm. The rest is that steady torques belong to the first pose.",
    )
