"""The inclining motion of section 4.2 in contact dynamics: a robot on three legs or six is to tilt one way after another."""

from dataclasses import dataclass
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
