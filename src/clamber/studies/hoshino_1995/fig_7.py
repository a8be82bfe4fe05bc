"""Figure 7, section 4.2: the plate inclined by its legs in contact dynamics, until the inclinometers read what is wanted."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import numpy as np

from ...families.walker.control.gait import Y
from ...families.walker.control.posture import inclines_of_tilt, tilt_of
from ...families.walker.execution import motions
from ...families.walker.execution.walk_trace import TracedWalker, WalkTrace
from ...families.walker.planning import load_walk
from ...families.walker.sim.walker_flaws import Inclinometers, WalkerFlaws
from ...families.walker.sim.walker_plant import WalkerSim
from ...types import Floats
from ...units import DEGREE
from ..result import Compared, Figure, StudyResult, Table, Value
from . import SIMULATED
from .walker import MM, hoshino

ANGLE: Final = 5.0
"""From level [deg]; the paper prints none."""
DIRECTIONS: Final = (0, 45, 90, 135, 180, 225, 270, 315)
"""Of the steepest ascent, from the plate's heading, one after another [deg]; then back to level."""
RESTS: Final = 8.0
"""For which the robot stands after each motion [s] ..."""
READ: Final = 4.0
"""... of which the inclinometers' readings are averaged over the last [s]: of readings 0.2 s apart, which their filter makes alike, 1 s
would leave 0.03 deg along each axis, a third of what is to be shown, and 4 s leave half of that."""
NOISE: Final = 0.05 * DEGREE
"""Of a reading [rad]."""
MOVES: Final = 0.005
"""A leg that goes farther in a motion than this counts [m]: motors make steps of 0.1 mm."""
ARRIVED: Final = 1e-5
"""Legs that have less left to go are where they are to be [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Inclining:
    """What happened, motion by motion."""

    trace: WalkTrace
    """Every tick."""
    wanted: Floats
    """Inclines that are wanted at each row, shape (rows, 2) [rad]."""
    begins: Floats
    """When each motion begins [s], shape (motions,)."""
    arrives: Floats
    """When its legs are where they are to be [s]."""
    ends: Floats
    """When the rest after it is over [s]."""

    def true_inclines(self) -> Floats:
        """How far the plate's axes truly rise, shape (rows, 2) [rad]."""
        assert self.trace.true_pose is not None, "the plant is simulated"
        return np.array([inclines_of_tilt(beta, gamma) for beta, gamma in self.trace.true_pose[:, 4:]])

    def read_errors(self) -> Floats:
        """Inclinometers from what is wanted, averaged over the end of each rest, shape (motions,) [rad]."""
        return self._at_ends(self.trace.inclines)

    def true_errors(self) -> Floats:
        """Likewise the plate itself."""
        return self._at_ends(self.true_inclines())

    def uneven(self) -> float:
        """Largest difference between legs in the share of their way that they have done half-way in time, of all motions [-]."""
        time, legs = self.trace.time, self.trace.commanded
        stands = self.trace.stands[0] > 0
        spreads = []
        for begin, arrive in zip(self.begins, self.arrives, strict=True):
            first, middle, last = np.searchsorted(time, (begin, 0.5 * (begin + arrive), arrive))
            way = (legs[last] - legs[first])[stands]
            far = np.abs(way) > MOVES
            spreads.append(float(np.ptp((legs[middle] - legs[first])[stands][far] / way[far])))
        return max(spreads)

    def _at_ends(self, inclines: Floats) -> Floats:
        time, off = self.trace.time, inclines - self.wanted
        means = [off[(time > end - READ) & (time <= end)].mean(axis=0) for end in self.ends]
        errors: Floats = np.hypot(*np.transpose(means))
        return errors


def incline(legs: Literal[3, 6], *, corrected: bool = True, seed: int = 0) -> Inclining:
    """Tilt the plate to each of `DIRECTIONS` and back to level.

    Args:
        legs: How many stand: those of the Delta-frame, or all.
        corrected: Whether the inclinometers' readings correct what the legs' lengths say.
        seed: Of the sensors' noise.
    """
    walk = load_walk("level-walk")
    flaws = WalkerFlaws(inclinometers=Inclinometers(noise=NOISE), force_noise=2.0, seed=seed)
    walker = TracedWalker(walk.robot, WalkerSim(walk.robot, walk.ground, flaws), every=1)
    walker.start(walk.start_pose(), walk.start_place(), walk.start_legs(), np.array(walk.arm))
    motions.find_ground(walker)
    motions.level(walker)
    if legs == 3:
        motions.lift(walker, Y, walker.frames()[Y])
    motions.settle(walker)
    walker.inclination.frozen = not corrected
    marks: list[tuple[float, float, float]] = []
    wants: list[tuple[float, float]] = []
    for direction, angle in (*((each, ANGLE) for each in DIRECTIONS), (0, 0.0)):
        begin = walker.time
        walker.wanted[1:] = tilt_of(direction * DEGREE, angle * DEGREE)
        wants.append(inclines_of_tilt(*walker.wanted[1:]))
        walker.tick()
        while walker.left > ARRIVED:
            walker.tick()
        arrive = walker.time
        walker.wait(RESTS)
        marks.append((begin, arrive, walker.time))
    trace = walker.trace()
    begins, arrives, ends = np.transpose(marks)
    turn = np.clip(np.searchsorted(begins, trace.time, side="left") - 1, -1, None)
    wanted = np.where(turn[:, None] < 0, 0.0, np.array(wants)[turn])
    return Inclining(trace, wanted, begins, arrives, ends)


PRINTED: Final = 0.1
"""To which the error of the inclination is brought [deg]."""
STANCES: Final[tuple[Literal[3, 6], ...]] = (3, 6)


def compare_inclinations() -> StudyResult:
    """Eight directions and back to level, on three legs and on six, with and without the inclinometers."""
    runs = {legs: incline(legs) for legs in STANCES}
    blind = {legs: incline(legs, corrected=False) for legs in STANCES}
    read = {legs: float(run.read_errors().max()) / DEGREE for legs, run in runs.items()}
    true = {legs: float(run.true_errors().max()) / DEGREE for legs, run in runs.items()}
    slowest = {legs: float((run.arrives - run.begins).max()) for legs, run in runs.items()}
    holds = max(*read.values(), *true.values()) <= PRINTED

    def motions(path: Path) -> None:
        from ...families.walker.pictures.walk_plots import draw_inclining

        draw_inclining(
            {f"on {_word(legs)} legs": _course(run) for legs, run in runs.items()}, within=PRINTED, path=path
        )

    return StudyResult(
        claim="Figure 7, section 4.2: legs that move at speeds proportional to their displacements incline the upper surface, and the "
        "error between the wanted inclination and what the inclinometers read is brought to 0.1 deg.",
        verdict="holds" if holds else "differs",
        compared=(
            *(Compared(f"{_word(legs)} legs: largest error as read, at rest [deg]", read[legs], PRINTED) for legs in STANCES),
            *(Compared(f"{_word(legs)} legs: largest true error, at rest [deg]", true[legs]) for legs in STANCES),
            *(
                Compared(
                    f"{_word(legs)} legs, by their lengths alone: largest true error, at rest [deg]",
                    float(blind[legs].true_errors().max()) / DEGREE,
                )
                for legs in STANCES
            ),
            *(Compared(f"{_word(legs)} legs: slowest motion [s]", slowest[legs]) for legs in STANCES),
            *(
                Compared(f"{_word(legs)} legs: largest difference of the legs' shares half-way [%]", 100.0 * runs[legs].uneven())
                for legs in STANCES
            ),
        ),
        deviations=(
            f"The figure's curves are not at hand, and the paper prints no inclinations: {ANGLE:g} deg in eight directions, one after "
            "another and back to level, are ours. The verdict is on the 0.1 deg, as read and as it truly is.",
            f"Readings are averaged over {READ:g} s of rest: one alone has a noise of {NOISE / DEGREE:g} deg (assumed). Their offset is "
            "taken for calibrated; the paper does not say how its were.",
            f"Legs of {hoshino().legs.speed * MM:g} mm/s and motors of {hoshino().legs.resolution * MM:g} mm a step, which is 0.03 deg "
            "over the frame, are assumed. The motors' steps and the correction on the way are what keeps the legs' shares from being the "
            "same.",
            "Whether three legs stand or six is not printed: the section's title says three.",
            "By the legs' lengths alone the plate comes as near on ground that is even and as hard as believed. On a slope, which only the "
            "inclinometers tell, it would not: see fig-8.",
            SIMULATED,
        ),
        table=Table(
            ("legs", "direction [deg]", "angle [deg]", "took [s]", "error as read [deg]", "true error [deg]"),
            tuple(row for legs, run in runs.items() for row in _rows(legs, run)),
        ),
        figures=(
            Figure(
                "inclines",
                "How far the plate's axes rise, wanted (black) and as read, and the error; grey where legs move.",
                motions,
            ),
        ),
    )  # fmt: skip


def _word(legs: int) -> str:
    return {3: "three", 6: "six"}[legs]


def _rows(legs: int, run: Inclining) -> list[tuple[Value, ...]]:
    wants = (*((direction, ANGLE) for direction in DIRECTIONS), (0, 0.0))
    columns = zip(wants, run.arrives - run.begins, run.read_errors(), run.true_errors(), strict=True)
    return [(legs, *want, float(took), float(a) / DEGREE, float(b) / DEGREE) for want, took, a, b in columns]


def _course(run: Inclining):  # type: ignore[no-untyped-def]
    from ...families.walker.pictures.walk_plots import Course

    moves = list(zip(run.begins, run.arrives, strict=True))
    return Course(run.trace.time, run.wanted / DEGREE, run.trace.inclines / DEGREE, run.true_inclines() / DEGREE, moves)
