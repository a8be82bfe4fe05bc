"""What a walker finds out about itself before it walks: its inclinometers' offsets, and how far its feet sink in.

Offsets are told by turning the inclinometers: the plate turns in its own plane over the Y-frame, on ground of any slope.
The plane stays as it is in the world while the sensors turn with the plate, so that a reading is offset + Rz(-heading) slope. Three
headings give both by least squares. The arm turns back as far, so that it weighs on the same legs.
"""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from ....types import Floats
from ..control.gait import DELTA, look_at_step, room_at
from . import motions
from .arm_swing import check_swing
from .walker import Walker

LOOK: Final = 45.0
"""For which readings are averaged at each heading [s]."""
REST: Final = 3.0
"""Before that, until the legs have taken the load [s]."""
SWINGS: Final = (1.5, -1.5)
"""Of the arm's first joint, from where it is, to shift the load [rad]."""
SHIFTS: Final = (0.06, 0.05, 0.04, 0.03, 0.02)
"""By how much the lifted Delta-frame is shifted forth and back to shift more load, the first that mechanism and balance allow [m]."""
STEP: Final = math.radians(0.5)
"""To which the range of the turn is found [rad]."""


def calibrate(walker: Walker) -> Floats:
    """Find the inclinometers' offsets, correct by them what is believed, and put the Delta-frame down again.

    The robot stands on six feet, about level.

    Returns:
        What the offsets were off by, shape (2,) [rad].

    Raises:
        RefusedError: If the robot would tip on its Y-frame, or cannot turn.
        FallenError: If the robot falls.
    """
    home = walker.frames()[DELTA].copy()
    arm, turns = walker.arm.copy(), _turns(walker)
    motions.lift(walker, DELTA, *(home + np.array((0.0, 0.0, turn)) for turn in turns))
    shift_load(walker)
    readings, headings = [], []
    walker.inclination.frozen = True  # the plane stays as it is, by its legs
    for turn in turns:
        _turn_to(walker, home, turn, arm)
        walker.wait(REST)
        seen = []
        for _ in range(round(LOOK / walker.period)):
            walker.tick()
            seen.append(walker.readings.copy())
        readings.append(np.mean(seen, axis=0))
        headings.append(walker.pose[3])
    offsets = offsets_from(readings, headings)
    off = offsets - walker.inclination.offsets
    walker.inclination.offsets = offsets
    _turn_to(walker, home, 0.0, arm)
    walker.inclination.frozen = False
    walker.inclination.doubt(float(np.linalg.norm(off)))
    motions.lower(walker, walker.of_frame(DELTA))
    return off


def feel_give(walker: Walker) -> None:
    """Swing the arm to and fro, so that the filter learns how far feet sink in under load; nothing without an arm.

    Raises:
        RefusedError: If that would tip it, with what it carries; the margin is what is missing.
        FallenError: If the robot falls.
    """
    spec = walker.robot.arm
    if spec is None:
        return
    home = float(walker.arm[0])
    aims = [min(spec.highest[0], max(spec.lowest[0], home + turn)) for turn in (*SWINGS, 0.0)]
    ends = [np.array((aim, *walker.arm[1:])) for aim in (min(aims), max(aims))]
    check_swing(walker, ends[0], ends[1], "swung to feel how the feet sink in")
    walker.inclination.learns = True
    for aim in aims:
        walker.arm_aims[0] = aim
        _until_arm_is_there(walker)
        walker.wait(REST)
    walker.inclination.learns = False


def shift_load(walker: Walker) -> None:
    """Slide the lifted Delta-frame forth and back, so that the filter learns how far the feet of the other sink in.

    That tells it three times as closely as the arm does. Where the plate is turned, it is the legs that say whether its plane stays; they
    must know what shifted load does.

    Raises:
        FallenError: If the robot falls.
    """
    home, limits = walker.frames()[DELTA].copy(), walker.settings.limits
    c, s = math.cos(home[2]), math.sin(home[2])
    for shift in SHIFTS:
        ends = [home + way * np.array((c, s, 0.0)) for way in (shift, -shift)]
        steps = [
            look_at_step(walker.robot, walker.frames(), DELTA, 0.0, end, walker.arm, walker.payload, limits)
            for end in ends
        ]
        if all(step.room >= 0.0 and step.balance >= limits.balance for step in steps):
            for end in (*ends, home):
                motions.slide(walker, DELTA, end, lands=False)
                walker.inclination.learns = True
                walker.wait(REST)
                walker.inclination.learns = False
            return


def offsets_from(readings: Sequence[Floats], headings: Sequence[float]) -> Floats:
    """Offsets of two inclinometers along x and y of a plane that turns in itself, about level, shape (2,) [rad].

    Args:
        readings: At each heading, shape (2,) [rad].
        headings: Of their x axis [rad]; two or more that differ.
    """
    rows = []
    for heading in headings:
        c, s = math.cos(heading), math.sin(heading)
        rows += [[1.0, 0.0, c, s], [0.0, 1.0, -s, c]]
    solved: Floats = np.linalg.lstsq(np.array(rows), np.concatenate(list(readings)), rcond=None)[0]
    return solved[:2]


def _turns(walker: Walker) -> tuple[float, float, float]:
    """Turns of the Delta-frame from where it is: as far as it can one way, the middle, as far the other way [rad]."""
    ends = []
    for sign in (-1.0, 1.0):
        turn = 0.0
        while abs(turn) < math.pi:
            place = motions.place_for(walker, DELTA, walker.frames()[DELTA] + np.array((0.0, 0.0, turn + sign * STEP)))
            if room_at(walker.robot, place[None], walker.settings.limits)[0] < 0.0:
                break
            turn += sign * STEP
        ends.append(turn)
    return ends[0], 0.5 * (ends[0] + ends[1]), ends[1]


def _turn_to(walker: Walker, home: Floats, turn: float, arm: Floats) -> None:
    """Turn the plate to `turn` from its heading at home, the arm back by as much, as far as its joint goes."""
    spec = walker.robot.arm
    if spec is not None:
        aim = min(spec.highest[0], max(spec.lowest[0], arm[0] - turn))
        walker.arm_aims[0] = aim
    motions.slide(walker, DELTA, home + np.array((0.0, 0.0, turn)), lands=False)
    _until_arm_is_there(walker)


def _until_arm_is_there(walker: Walker) -> None:
    while np.abs(walker.arm - walker.arm_aims).max(initial=0.0) > 1e-9:
        walker.tick()
