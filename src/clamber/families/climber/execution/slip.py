"""A hook that has come off, told before the body is far: two tips that are on their holds do not move against each other."""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ....types import Floats
from ..control.felt_force import see_slips
from .whole_body import WholeBody

BEYOND: Final = 0.006
"""What of that no play of their joints can be: a hook slides in its slot, sinks in, and the map is learned meanwhile [m]."""
MOVED: Final = 0.0115
"""Two tips that have moved this far against each other are not both on their holds [m]. One joint that crosses its play moves them by less
than 10 mm on LIBRA, a hook that slides in by 2 mm."""
BEARING: Final = (10.0, 4.0)
"""Of two hooks that move apart, one that feels more than the first of these is on where the other feels less than the second [N]."""
SURELY: Final = 0.023
"""Nearer than this to where they were against each other neither is off where both feel more than the first of those: the body has turned
within the play of all its joints, thrown about by a free limb [m]."""
FORGOTTEN: Final = 0.2
"""Time over which slower changes are forgotten: sinking in, what is learned of the sensors, play that a moving body crosses [s]."""


class SlipWatch:
    """Looks at how the tips of hooks on holds lie to each other, tick by tick.

    Against where the holds are believed to be they are off by as much as the map is, the play and the sensors; against where they were a
    moment ago by little. Where a load turns round, several joints cross their play at once: their encoders move, the tips do not.
    The belief of the play follows that, but moves tips itself where it lags or errs; a hook that comes off moves them by both. Of two
    that move apart, that one has come off which moves the way it pulled: its hold is no longer in the way. One that was pushed off
    backwards moves the other way, but then feels nothing, while the other one bears.

    Args:
        body: What knows the limbs and their tasks.
    """

    def __init__(self, body: WholeBody) -> None:
        self._body = body
        hooked = [i for i, limb in enumerate(body.robot.limbs) if limb.end.kind != "gripper"]
        self._pairs = np.array(list(combinations(hooked, 2)), np.int64).reshape(-1, 2)
        n = len(self._pairs)
        self._holds, self._changes, self._beyond = np.full((n, 2), -1), np.zeros((n, 2)), np.zeros((n, 2))
        rate = min(1.0, body.period / FORGOTTEN)
        seen = Handle(body.work, self._pairs, self._holds, np.zeros((n, 4)), self._changes, self._beyond, rate)
        self._see = ready(see_slips, seen)
        self.moved = 0.0
        """Farthest that two tips have moved against each other of late [m]."""

    def reset(self) -> None:
        """Begin anew, as if all were well."""
        self._holds[:] = -1
        self.moved = 0.0

    def see(self, forces: Floats) -> int | None:
        """Take in the tick whose measurements the body has just seen; index of the limb whose hook has come off.

        Args:
            forces: What the tips feel, shape (limbs, 2) [N]; infinite where they cannot tell.
        """
        self.moved = self._see()
        if self.moved <= MOVED:
            return None
        body, lost, most = self._body, None, MOVED
        for pair, change, beyond in zip(self._pairs.tolist(), self._changes, self._beyond, strict=True):
            size = float(np.hypot(*change))
            if size <= most:
                continue
            most = size
            if self._beyond_play(pair, beyond) <= BEYOND:
                continue
            a, b = pair
            along = body.grab_direction(a) + body.grab_direction(b)
            off, other = (a, b) if change @ along > 0.0 else (b, a)
            loads = math.hypot(*forces[off].tolist()), math.hypot(*forces[other].tolist())
            if size > SURELY or not all(BEARING[0] < force < math.inf for force in loads):
                swapped = BEARING[0] < loads[0] < math.inf and loads[1] < BEARING[1]
                lost = other if swapped else off
        return lost

    def _beyond_play(self, pair: Sequence[int], moved: Floats) -> float:
        """How far two tips have moved against each other at the least, wherever their joints may be within their play [m].

        What the joints of both limbs can make of their play is a polygon with the directions of single joints as edges; this is the
        distance from it.

        Args:
            pair: The limbs.
            moved: First tip less second by the encoders alone, less the same as it lately was, the play counted, world frame [m].
        """
        body = self._body
        ways = np.concatenate([body.turned_by_joints(i) for i in pair], axis=1) * (0.5 * body.backlash)
        normals = np.stack((-ways[1], ways[0])) / np.maximum(np.hypot(*ways), 1e-12)
        across = np.abs(normals.T @ moved)
        return float((across - np.abs(normals.T @ ways).sum(axis=1)).max(initial=0.0))
