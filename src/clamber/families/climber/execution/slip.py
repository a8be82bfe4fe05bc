"""A hook that has come off, told before the body is far: two tips that are on their holds do not move against each other."""

import cmath
import math
from itertools import combinations
from typing import Final

import numpy as np

from ....types import Floats
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
        self._pairs = list(combinations(hooked, 2))
        self._rate = min(1.0, body.period / FORGOTTEN)
        self._before: dict[tuple[int, int], tuple[int, int, complex, complex]] = {}
        """Pair -> its holds, and the first tip less the second as it lately was, by encoders and with the play counted, world frame [m]."""
        self.moved = 0.0
        """Farthest that two tips have moved against each other of late [m]."""

    def reset(self) -> None:
        """Begin anew, as if all were well."""
        self._before.clear()
        self.moved = 0.0

    def see(self, forces: Floats) -> int | None:
        """Take in the tick whose measurements the body has just seen; index of the limb whose hook has come off.

        Args:
            forces: What the tips feel, shape (limbs, 2) [N]; infinite where they cannot tell.
        """
        body, before = self._body, self._before
        seen = (body.pose, body.tips), (body.settled, body.settled_tips)
        turned = [(cmath.rect(1.0, at.item(2)), tips.view(np.complex128).ravel().tolist()) for at, tips in seen]
        (turn, tips), (settled_turn, settled_tips) = turned
        lost, most = None, 0.0
        for pair in self._pairs:
            a, b = pair
            one, other = body.tasks[a], body.tasks[b]
            if one.mode not in ("stance", "unloaded_contact") or other.mode not in ("stance", "unloaded_contact"):
                before.pop(pair, None)
                continue
            felt, settled = turn * (tips[a] - tips[b]), settled_turn * (settled_tips[a] - settled_tips[b])
            known = before.get(pair)
            if known is None or known[:2] != (one.hold, other.hold):
                before[pair] = one.hold, other.hold, felt, settled
                continue
            _, _, was_felt, was_settled = known
            changes = felt - was_felt, settled - was_settled
            before[pair] = (*known[:2], was_felt + self._rate * changes[0], was_settled + self._rate * changes[1])
            change = min(changes, key=abs)
            size = abs(change)
            if size > max(most, MOVED) and self._beyond_play(pair, felt - was_settled) > BEYOND:
                along = body.grab_direction(a) + body.grab_direction(b)
                off, other_one = (a, b) if change.real * along[0] + change.imag * along[1] > 0.0 else (b, a)
                loads = math.hypot(*forces[off].tolist()), math.hypot(*forces[other_one].tolist())
                if size > SURELY or not all(BEARING[0] < force < math.inf for force in loads):
                    swapped = BEARING[0] < loads[0] < math.inf and loads[1] < BEARING[1]
                    lost = other_one if swapped else off
            most = max(most, size)
        self.moved = most
        return lost

    def _beyond_play(self, pair: tuple[int, int], moved: complex) -> float:
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
        across = np.abs(normals.T @ (moved.real, moved.imag))
        return float((across - np.abs(normals.T @ ways).sum(axis=1)).max(initial=0.0))
