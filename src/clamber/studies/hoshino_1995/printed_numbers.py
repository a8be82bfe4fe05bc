"""Sections 3.1 and 3.2: every number that the paper prints of how the walker moves in the plane."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from ...families.walker.robot import TwoFrames
from ...families.walker.robot.turning import turning_range
from ...families.walker.robot.workspace import best_directions, stride
from ...types import Floats
from ...units import DEGREE
from ..result import Cells, Compared, StudyResult, Table, Verdict
from . import CALIBRATED, SIGNS
from .walker import MM, hoshino

PIECES = 400


def slide_seconds(frames: TwoFrames, speed: float, start: npt.ArrayLike, end: npt.ArrayLike) -> float:
    """Least time of a straight slide, which may turn evenly on its way: at every place the busiest actuator runs at full speed [s].

    Starting and stopping take no time here.

    Args:
        frames: The mechanism.
        speed: Of the actuators [m/s].
        start, end: Poses of the Y-frame in the Delta-frame, shape (3,) [m], [rad].
    """
    begin = np.asarray(start, np.float64)
    change = np.asarray(end, np.float64) - begin
    lengths: Floats = np.array([frames.lengths(begin + share * change) for share in np.linspace(0.0, 1.0, PIECES + 1)])
    return float(abs(np.diff(lengths, axis=0)).max(axis=1).sum() / speed)


MINUTE: Final = 60.0
PRINTED: Final = (-48.0, 18.0, 160.0, 130.0, 150.0)
"""Least and largest angle [deg], longest step [mm], walking [mm/min] and turning speed [deg/min]."""
SIXTHS: Final = (30, 90, 150, 210, 270, 330)
"""Directions of the longest step [deg]: equation 2 with n = 0 to 5."""
DEVIATIONS: Final = (
    "The verdict is no more than consistent: four numbers of ours (two sizes of the frames, the actuators' speed, the legs' speed) are "
    "fitted to the five that are printed. What could have failed is that one pair of sizes gives both ends of the range of angles and the "
    "longest step, and the six directions. Differs if one of the numbers, rounded as printed, or a direction does not come out.",
    CALIBRATED,
    SIGNS,
    "The actuators' speed, 9.47 mm/s, is calibrated on 150 deg/min: the whole stroke in the 26.4 s of 66 deg. The legs' 5 mm/s for 50 mm "
    "of lift are assumed, such that 130 mm/min comes out; both speeds together therefore test that one set of motors explains them, no "
    "more.",
    "The paper calls T of equation 1 the swing phase. With a duty factor of 0.5 a cycle is two swings, and the body gains one step in it: "
    "130 mm/min and 160 mm belong together only if T is the whole cycle of 73.85 s. With T one swing it would be twice as fast.",
    "150 deg/min is the speed of the slide alone; with the feet's time and the other frame's slide the body turns less than half as fast.",
    "Equation 2 counts n = +-1, +-2, +-3, which leaves out 30 deg and gives 210 deg twice; n = 0 to 5 is meant. It holds at theta = 0: the "
    "best directions are 30 deg + theta / 2 up to theta = 11 deg, then there are two on either side of that.",
    "0.5 is the least duty factor at which one of two tripods always stands, not the largest as printed.",
)
TURNS: Final = (-15, -10, -5, 0, 5, 10, 15, 20, 30, 40)
"""Angles of the table [deg]."""


@dataclass(frozen=True, slots=True)
class Cycle:
    """A whole cycle of the gait with the longest steps, and a turn over the whole range, by the speeds of the robot's own motors."""

    step: float
    """[m]."""
    back: float
    """Part of it behind the centre [m]."""
    ahead: float
    directions: tuple[float, ...]
    """Of the longest step [deg]."""
    slide: float
    """[s]."""
    legs: float
    """Feet down, and up again [s]."""
    least: float
    """Of the angle between the frames [deg]."""
    most: float
    turning: float
    """From the least to the most [s]."""

    @classmethod
    def of_robot(cls) -> "Cycle":
        """The paper's robot's."""
        robot = hoshino()
        frames, speed = TwoFrames.of(robot.mechanism), robot.mechanism.speed
        turn = turning_range(frames, (0.0, 0.0, 0.0))
        directions, step = best_directions(frames, 0.0)
        along = stride(frames, 0.0, directions[0])
        unit = np.array([math.cos(directions[0]), math.sin(directions[0]), 0.0])
        return cls(
            step=step,
            back=along.back,
            ahead=along.ahead,
            directions=tuple(sorted({round(angle / DEGREE, 3) for angle in directions})),
            slide=slide_seconds(frames, speed, -along.back * unit, along.ahead * unit),
            legs=2.0 * robot.legs.lift / robot.legs.speed,
            least=turn.least / DEGREE,
            most=turn.most / DEGREE,
            turning=slide_seconds(frames, speed, (0.0, 0.0, turn.least), (0.0, 0.0, turn.most)),
        )

    @property
    def whole(self) -> float:
        """Both frames' slides and feet [s]."""
        return 2.0 * (self.slide + self.legs)

    def ours(self) -> tuple[float, ...]:
        """What `PRINTED` has, in its order."""
        walking = self.step / self.whole * MINUTE * MM
        return -self.most, -self.least, self.step * MM, walking, (self.most - self.least) / self.turning * MINUTE


def judge_numbers(ours: Sequence[float], directions: Sequence[float]) -> Verdict:
    """Consistent if every printed number comes out to its last digit, and the six directions: four of ours were fitted to five of theirs.

    Args:
        ours: What `PRINTED` has, in its order.
        directions: Of the longest step [deg].
    """
    rounds = all(round(one) == round(other) for one, other in zip(ours, PRINTED, strict=True))
    along = len(directions) == len(SIXTHS) and np.allclose(directions, SIXTHS, atol=0.01)
    return "consistent" if rounds and along else "differs"


def compare_numbers() -> StudyResult:
    """Range of angles, longest step and its directions, and both speeds, from the geometry and the speeds of the robot's own motors."""
    cycle = Cycle.of_robot()
    return StudyResult(
        claim="Sections 3.1, 3.2: strokes from 0 to 250 mm let theta range from -48 to 18 deg; the longest step, 160 mm, is at 30 + 60 n "
        "deg, equation 2; the robot walks at 130 mm/min and turns at 150 deg/min.",
        verdict=judge_numbers(cycle.ours(), cycle.directions),
        compared=_compare(cycle),
        deviations=DEVIATIONS,
        table=_table(),
    )


def _compare(cycle: Cycle) -> tuple[Compared, ...]:
    least, most, step, walking, turning = cycle.ours()
    frames = TwoFrames.of(hoshino().mechanism)
    over_cycle = (cycle.most - cycle.least) / (2.0 * (cycle.turning + cycle.legs)) * MINUTE
    return (
        Compared("least angle, signed as printed [deg]", least, -48),
        Compared("largest angle, signed as printed [deg]", most, 18),
        Compared("longest step at theta = 0 [mm]", step, 160),
        Compared(
            "its directions [deg]", ", ".join(f"{one:g}" for one in cycle.directions), "30 + 60 n, n = +-1, +-2, +-3"
        ),
        Compared("part of it behind the centre [mm]", cycle.back * MM),
        Compared("part of it ahead of the centre [mm]", cycle.ahead * MM),
        Compared("step at theta = 0 along 0 deg [mm]", stride(frames, 0.0, 0.0).length * MM),
        Compared("a slide over the longest step [s]", cycle.slide),
        Compared("feet down, and up again [s]", cycle.legs),
        Compared("both frames' slides and feet, a whole cycle [s]", cycle.whole),
        Compared("walking speed, a step per cycle [mm/min]", walking, 130),
        Compared("S / V of the printed numbers [s]", 160.0 / 130.0 * MINUTE),
        Compared("walking speed if that were one frame's swing alone [mm/min]", 2.0 * walking),
        Compared("a turn over the whole range [s]", cycle.turning),
        Compared("turning speed while sliding [deg/min]", turning, 150),
        Compared("turning speed over a whole cycle, feet included [deg/min]", over_cycle),
    )


def _table() -> Table:
    mechanism = hoshino().mechanism
    frames = TwoFrames.of(mechanism)
    rows: list[Cells] = []
    for theta in TURNS:
        best, length = best_directions(frames, theta * DEGREE)
        by_sixty = sorted({round(angle / DEGREE % 60.0, 2) % 60.0 for angle in best})
        turn = slide_seconds(frames, mechanism.speed, (0.0, 0.0, 0.0), (0.0, 0.0, theta * DEGREE))
        rows.append((theta, length * MM, " and ".join(f"{one:g}" for one in by_sixty), turn))
    return Table(
        ("theta [deg]", "longest step [mm]", "its directions, modulo 60 [deg]", "turn there from 0 [s]"), tuple(rows)
    )
