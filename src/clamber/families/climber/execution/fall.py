"""A fall told before the body is seen to leave: motors and encoders say when nothing carries the robot any more."""

import math
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ..control.felt_force import LOAD, SLOW, see_load
from .whole_body import WholeBody

BORNE: Final = 0.45
"""Tips that press on the world with less than this part of the weight, all together, do not carry it."""
LOOSE: Final = 0.08
"""They do so for that long when nothing holds the robot; a hook that settles bounces for less [s]."""
MOVES: Final = 0.1
"""Meanwhile a joint of a limb that holds turns faster than this, as nothing loads it any more: a robot that stands still leans on something
[rad/s]."""
WEIGHTLESS: Final = (0.2, 0.05)
"""One that hangs keeps its joints where they are while it drops. It falls where its tips feel less than this part of the weight [-], and
these joints have turned faster than this since they began to feel little: what bore the weight has bent them back [rad/s]."""
SMOOTHED: Final = 0.03
"""Time constant of the felt forces [s]."""


class FallWatch:
    """Adds up what the tips of a climber feel, tick by tick.

    What holds is taken for granted by the estimate of the body: with every hook off its hold the estimate stays where it was, while the
    robot drops. The sum of the forces that the tips feel drops at once. A limb that is stretched or folded feels nothing along itself;
    while one that holds is, nothing is told. Nor is it while all stand still: a link that lies on a hold carries, too. What the friction of
    joints at rest may bear besides counts as borne: that of a nearly straight limb may bear the robot.

    Args:
        body: What knows the limbs and their tasks.
    """

    def __init__(self, body: WholeBody) -> None:
        self._body = body
        self._before, self._felt = np.zeros((body.n, 2)), np.zeros((body.n, 2))
        self.forces = np.zeros((body.n, 2))
        """Of the tips on what they touch, world frame, shape (limbs, 2) [N]; infinite where they cannot be told."""
        self.force = np.zeros(2)
        """Their sum [N]."""
        self._load = np.zeros(1, LOAD)
        self._load["period"], self._load["rate"] = body.period, min(1.0, body.period / SMOOTHED)
        self._load["least"] = BORNE * body.robot.weight
        self._see = ready(see_load, Handle(body.work, self._before, self._felt, self.forces, self.force, self._load))

    @property
    def carried(self) -> float:
        """Sum of the forces' sizes [N]; infinite where a limb that holds cannot tell; others that cannot count as none."""
        return float(self._load["carried"][0])

    @property
    def loose(self) -> float:
        """How long the tips have been carrying too little [s]."""
        return float(self._load["loose"][0])

    def reset(self) -> None:
        """Begin anew, as if all were well."""
        self._before[:] = self._felt[:] = 0.0
        self._load["fastest"] = 0.0
        self._load["loose"] = -LOOSE  # what the tips feel has to settle first

    def see(self) -> bool:
        """Take in the tick whose measurements the body has just seen; whether nothing carries the robot."""
        if self._see() <= LOOSE:
            return False
        body, load = self._body, self._load[0]
        hangs = any(task.mode == "hang" for task in body.tasks)
        drops = hangs and load["carried"] < WEIGHTLESS[0] * body.robot.weight and load["fastest"] > WEIGHTLESS[1]
        return bool(drops or (load["turning"] > MOVES and load["carried"] + self._hidden() < load["least"]))

    def _hidden(self) -> float:
        """What limbs on holds may bear unfelt by the friction of joints at rest [N]; infinite where one is stretched or folded."""
        body, hidden = self._body, 0.0
        for i, task in enumerate(body.tasks):
            if not task.hold:
                continue
            if not math.isfinite(self.forces[i, 0]):
                return math.inf
            dry = np.array((body.legs[i]["friction1"], body.legs[i]["friction2"]))
            unknown = dry * np.maximum(0.0, 1.0 - np.abs(body.qd[i]) / SLOW)
            by_shoulder, by_elbow = np.linalg.inv(body.turned_by_joints(i)) * unknown[:, None]
            hidden += max(math.hypot(*(by_shoulder + by_elbow)), math.hypot(*(by_shoulder - by_elbow)))
        return hidden
