"""A climber that hangs on one limb from a single peg: how it swings, and what a push does to it."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from clamber.families.climber.execution.climber import Climber, FallenError
from clamber.families.climber.execution.hang import DAMPING, Hang
from clamber.families.climber.execution.limb_task import LimbTask
from clamber.families.climber.execution.pendulum import Pendulum
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.world.board import Board, build_board
from clamber.files import Document
from clamber.sim.limb_flaws import LimbFlaws
from clamber.types import Floats

PEG: Final = 1
"""Number of the only peg."""
HOOK_ON: Final = 0.004
"""A tip that is farther from the peg has come off it [m]."""
STILL: Final = 1.0
"""Time before a push [s]."""


def one_peg() -> Board:
    """A board with one peg of 3/8 in at the origin."""
    holds = [{"number": PEG, "x": "0 in", "y": "0 in"}]
    return build_board(
        Document("one peg", {
            "schema": "clamber-board-1", "name": "one-peg", "title": "One peg", "hold_radius": "0.1875 in", "holds": holds,
        })
    )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Hanging:
    """A climber that hangs, and the plant that it hangs in."""

    climber: Climber
    plant: ClimberPlant
    hang: Hang

    def true_swing(self) -> float:
        """Of the centre of gravity from straight below, anticlockwise [rad]."""
        true = self.plant.truth()
        return self.hang.pendulum.swing(true.q, float(true.pose[2]))

    def off_peg(self) -> float:
        """Distance of the holding tip from the peg [m]."""
        return float(np.hypot(*self.plant.truth().tips[self.hang.i]))


def hang_up(
    robot: LimbedRobot, flaws: LimbFlaws, q: Floats, *, limb: int = 0, swing: float = 0.0, damping: float = DAMPING
) -> Hanging:
    """A climber on a peg, at rest at an angle.

    Args:
        robot: The climber.
        flaws: Of the plant.
        q: Joint angles, shape (limbs, 2) [rad].
        limb: Index of the limb that holds.
        swing: Of the centre of gravity from straight below [rad].
        damping: Of `Hang`.
    """
    board = one_peg()
    plant = ClimberPlant(robot, board, flaws)
    climber = Climber(robot, board, plant)
    pendulum = Pendulum(robot, limb)
    pose = pendulum.pose(q, np.zeros(2), pendulum.rest(q) + swing)
    plant.reset(pose, q)
    for i in range(len(robot.limbs)):
        climber.body.assign(i, LimbTask("swing_joint", angles=q[i].copy()))
    climber.body.tasks[limb].hold, climber.body.tasks[limb].mode = PEG, "hang"
    sensed = plant.sense()
    climber.body.see(sensed.q, sensed.qd, sensed.angle, sensed.angle_speed)
    return Hanging(climber, plant, Hang(climber, limb, damping))


@dataclass(frozen=True, slots=True)
class PushedHang:
    """What a push did to a hanging climber."""

    on: bool
    """Whether the hook stayed on its peg."""
    widest: float
    """Largest swing, either way [rad]."""
    after: float
    """Largest swing in the last second [rad]."""
    predicted: float
    """Largest swing of a stiff pendulum without friction that gets the same push at once [rad]; pi or more: it goes over."""


def push_while_hanging(
    robot: LimbedRobot, flaws: LimbFlaws, q: Floats, *,
    limb: int = 0, force: float = 60.0, duration: float = 0.1, wait: float = 15.0, damping: float = DAMPING,
) -> PushedHang:  # fmt: skip
    """Push the body sideways at its centre, and look how its swing ends.

    Args:
        robot: The climber.
        flaws: Of the plant.
        q: Joint angles, shape (limbs, 2) [rad].
        limb: Index of the limb that holds.
        force: To the right [N].
        duration: Of the push [s].
        wait: Time after it [s].
        damping: Of `Hang`.
    """
    held = hang_up(robot, flaws, q, limb=limb, damping=damping)
    held.climber.wait(STILL)
    pendulum, true = held.hang.pendulum, held.plant.truth()
    depth = -float(true.pose[1])
    speed = force * duration * depth / pendulum.inertia(true.q)  # angular momentum of the push about the peg
    height = 0.5 * (speed / pendulum.frequency(true.q)) ** 2
    swings: list[float] = []
    on = True
    try:
        for k in range(round((duration + wait) / held.plant.period)):
            held.plant.push((force if k * held.plant.period < duration else 0.0, 0.0))
            held.climber.tick()
            swings.append(abs(held.true_swing()))
            on = on and held.off_peg() < HOOK_ON
    except FallenError:
        on = False
    last = swings[-round(1.0 / held.plant.period) :]
    return PushedHang(on, max(swings), max(last), math.acos(max(1.0 - height, -1.0)))
