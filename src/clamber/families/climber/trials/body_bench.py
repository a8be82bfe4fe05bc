"""A body on its stand: one law, one scenario, and what happened tick by tick."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....sim.limb_flaws import LimbFlaws
from ....types import Floats
from ..control.body_estimate import ENCODER, LINE, SECOND_TIP
from ..execution.body_gains import BodyGains
from ..execution.whole_body import WholeBody
from .body_scenario import BodyScenario
from .body_stand import BodyStand

SLOT: Final = 0.008
"""A peg farther than this from a hook's seat has left the straight walls of its slot: the hook is off [m]."""

ANGLES: Final = {"encoder": ENCODER, "line": LINE, "second-tip": SECOND_TIP}
"""Name -> source of the body's angle: its own encoder, the line between the tips, the height of the second tip (printed, 4.4.3)."""


@dataclass(frozen=True, slots=True)
class BodyEntry:
    """A way to control the body, under a label."""

    label: str
    gains: BodyGains
    angle: str = "encoder"
    """Source of the body's angle, a name of `ANGLES`."""
    first_limb: bool = False
    """Whether the first holding limb alone tells where the body is, as in the thesis (4.4.3); else all that hold do, unless the angle
    is that of the "second-tip"."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyTrace:
    """What happened, row by row at the scenario's ticks; a run that leaves the finite numbers ends in NaN."""

    time: Floats
    """0 where the measured part begins, shape (ticks,) [s]."""
    aim: Floats
    """Shape (ticks, 3) [m], [rad]."""
    pose: Floats
    """True, shape (ticks, 3)."""
    believed: Floats
    """By encoders and holds, shape (ticks, 3)."""
    push: Floats
    """On the body, shape (ticks, 2) [N]."""
    torques: Floats
    """Of the motors, shape (ticks, limbs, 2) [N m]."""
    tips: Floats
    """True, shape (ticks, limbs, 2) [m]."""
    off: Floats
    """How far each holding limb's tip is from its peg, shape (ticks, holding) [m]."""

    @property
    def unhooked_at(self) -> float | None:
        """When the first hook came off [s]; None: never."""
        lost = (self.off > SLOT).any(axis=1) | ~np.isfinite(self.pose).all(axis=1)
        return float(self.time[np.argmax(lost)]) if lost.any() else None


@dataclass(frozen=True, slots=True, eq=False)
class BodyRun:
    """What one entry did."""

    entry: BodyEntry
    trace: BodyTrace


def run_body(
    stand: BodyStand,
    scenario: BodyScenario,
    entry: BodyEntry,
    flaws: LimbFlaws,
    *,
    pegs: Floats | None = None,
    map_errors: Floats | None = None,
) -> BodyRun:
    """Run one entry.

    Args:
        stand: Where the robot is held.
        scenario: What is asked of it.
        entry: Its control.
        flaws: Of the plant.
        pegs: Where the holds truly are, shape (n_holds, 2) [m]; None: as believed.
        map_errors: How far from there the control believes each limb's hold, the robot put on it where it is, shape (limbs, 2) [m].
    """
    climber, plant = stand.put(flaws, entry.gains, pegs=pegs)
    body = climber.body
    if map_errors is not None:
        for task, error in zip(body.tasks, map_errors, strict=True):
            task.place += error
    holding = [i for i, limb in enumerate(stand.robot.limbs) if limb.name in stand.holds]
    numbers = [hold.number for hold in stand.board.holds]
    places = stand.board.positions() if pegs is None else pegs
    seats = np.array([places[numbers.index(stand.holds[stand.robot.limbs[i].name])] for i in holding])
    ticks, n = len(scenario.aims), body.n
    pose, believed = np.full((ticks, 3), np.nan), np.full((ticks, 3), np.nan)
    torques, tips = np.full((ticks, n, 2), np.nan), np.full((ticks, n, 2), np.nan)
    for k in range(ticks):
        sensed = plant.sense()
        if not np.isfinite(sensed.q).all():
            break
        body.see(sensed.q, sensed.qd, sensed.angle, sensed.angle_speed, angle_from=ANGLES[entry.angle])
        if entry.first_limb:
            count_from(body, holding[0])
        body.aim[:], body.aim_speed[:] = scenario.aims[k], scenario.speeds[k]
        plant.actuate(body.command(), climber.grips)
        plant.push((float(scenario.pushes[k, 0]), float(scenario.pushes[k, 1])))
        plant.step()
        truth = plant.truth()
        pose[k], believed[k], torques[k], tips[k] = truth.pose, body.pose, truth.torques, truth.tips
    off = np.linalg.norm(tips[:, holding] - seats, axis=2)
    return BodyRun(entry, BodyTrace(scenario.time, scenario.aims, pose, believed, scenario.pushes, torques, tips, off))


def count_from(body: WholeBody, i: int) -> None:
    """Let the body be where one limb has it: its hold less its tip."""
    hold = body.tasks[i].place
    arm = hold - body.felt_tip(i)
    speed = body.tip_speed(i)  # that of a tip on its hold is none
    body.pose[:2] += arm
    body.twist[:2] -= speed


def run_bodies(
    stand: BodyStand, scenario: BodyScenario, entries: Sequence[BodyEntry], flaws: LimbFlaws
) -> list[BodyRun]:
    """Every entry alone, from the same start."""
    return [run_body(stand, scenario, entry, flaws) for entry in entries]
