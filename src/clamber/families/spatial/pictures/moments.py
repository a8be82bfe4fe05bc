"""A robot in space at one moment of a plan: in its stances, and on the way from one to the next."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Floats, Records
from ....viewing.recording import Part
from ..execution.references import TipPath
from ..planning.plans import poses_of
from ..planning.task import SpatialTask
from ..robot.kinematics import (
    LinkFrames,
    Posed,
    body_between,
    centre_of_mass,
    joint_torques,
    link_frames,
    posed,
    swing_between,
)
from ..statics.judging import lift_between

SWINGING: Final = -1
"""In place of a hold's index, of a limb that is on its way."""


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """A robot at one moment."""

    body: Posed
    pose: Floats
    """Along, across, height [m], yaw, pitch, roll [rad] on the guide, shape (6,)."""
    frames: LinkFrames
    """Of its links."""
    holds: tuple[int, ...]
    """Index of each limb's hold, or `SWINGING`."""
    normals: Floats
    """Of those holds, shape (limbs, 3); NaN for limbs that swing."""
    wrenches: Floats
    """Of the contacts on the robot, world frame: force [N], moment about the tip [N m], shape (limbs, 6); NaN where not known."""
    torques: Floats
    """Of the joints [N m] or [N], shape (limbs, most joints); NaN where not known."""
    centre: Floats
    """Of mass, world frame [m], shape (3,)."""
    shares: Floats
    """Margin of each check of the step, as a share of what is limited [-]; NaN where it has none."""
    path: Floats | None = None
    """Of the tip that swings, world frame [m], shape (n, 3)."""

    @property
    def origins(self) -> Floats:
        """Of the joints, then of the tips, world frame [m], shape (limbs, most joints + 1, 3)."""
        return self.frames.origins

    @property
    def tips(self) -> Floats:
        """Places of the tips, world frame [m], shape (limbs, 3)."""
        return self.frames.tips


def settled_moments(task: SpatialTask, stances: Records, shares: Floats | None = None) -> list[Moment]:
    """The moments of stances.

    Args:
        task: Robot and world.
        stances: Records of `planning.records.STANCE`, shape (n,).
        shares: Of the checks of each, shape (n, checks).
    """
    chains = task.robot.chains
    world = task.world
    n_limbs = len(chains.limb_names)
    body = posed(chains, stances)
    frames = link_frames(chains, body)
    wrenches = np.array(stances["wrench"][:, :n_limbs])
    torques = joint_torques(chains, frames, wrenches, np.array(world.gravity))
    centres, poses = centre_of_mass(chains, body, frames), poses_of(task, stances)
    normals = world.normals
    found = []
    for k, stance in enumerate(stances):
        held = tuple(int(hold) for hold in stance["hold"][:n_limbs])
        found.append(
            Moment(
                Posed(body.place[k], body.turn[k], body.q[k]),
                poses[k],
                LinkFrames(frames.origins[k], frames.axes[k]),
                held,
                normals[list(held)],
                wrenches[k],
                torques[k],
                centres[k],
                np.zeros(0) if shares is None else shares[k],
            )
        )
    return found


@dataclass(frozen=True, slots=True, eq=False)
class Between:
    """What is on the way between two stances."""

    task: SpatialTask
    before: Moment
    after: Moment
    loads: Callable[[int], Floats]
    """Contact wrenches while a limb swings, as `SwingLoads` has them."""

    def parts(self) -> list[Part[Moment]]:
        """The motion: a body that moves over its holds, or a limb that swings from hold to hold."""
        moved = [
            limb for limb, (old, new) in enumerate(zip(self.before.holds, self.after.holds, strict=True)) if old != new
        ]
        if not moved:
            return [Part("move", lambda share, way: self.body(share))]
        limb = moved[0]
        path = self._path(moved[0])
        line = np.array([path.at(share)[0] for share in np.linspace(0.0, 1.0, 33)])
        wrenches = self.loads(limb)
        return [Part("swing", lambda share, way: self.swing(limb, path.at(share)[0], line, wrenches, share))]

    def _path(self, limb: int) -> TipPath:
        ends = np.stack((self.before.tips[limb], self.after.tips[limb]))
        normals = np.stack((self.before.normals[limb], self.after.normals[limb]))
        return TipPath(ends[0], ends[1], normals, lift_between(ends, normals, self.task.rules.lift))

    def body(self, share: float) -> Moment:
        """The body at a share of its way; forces pass from those of one stance to those of the next."""
        if share >= 1.0:
            return self.after
        before, after = self.before, self.after
        places = np.array([self.task.world.holds[hold].at for hold in before.holds])
        at = body_between(self.task.robot.chains, before.body, after.body, places, share)
        wrenches = before.wrenches + share * (after.wrenches - before.wrenches)
        return self._moment(at, share, before.holds, wrenches, None)

    def swing(self, limb: int, tip: Floats, line: Floats, wrenches: Floats, share: float) -> Moment:
        """The limb at a share of its path, while the others hold the robot."""
        if share >= 1.0:
            return self.after
        before, after = self.before, self.after
        at = swing_between(self.task.robot.chains, before.body, after.body, limb, tip, share)
        holds = tuple(SWINGING if which == limb else hold for which, hold in enumerate(before.holds))
        return self._moment(at, share, holds, wrenches, line)

    def _moment(self, at: Posed, share: float, holds: tuple[int, ...], wrenches: Floats, path: Floats | None) -> Moment:
        chains, before, after = self.task.robot.chains, self.before, self.after
        frames = link_frames(chains, at)
        turn = np.array([0.0, 0.0, 0.0, *(math.remainder(angle, math.tau) for angle in (after.pose - before.pose)[3:])])
        pose = before.pose + share * np.where(np.arange(6) < 3, after.pose - before.pose, turn)
        normals = np.where(np.array(holds)[:, None] >= 0, before.normals, math.nan)
        torques = joint_torques(chains, frames, wrenches, np.array(self.task.world.gravity))
        centre = centre_of_mass(chains, at, frames)
        return Moment(at, pose, frames, holds, normals, wrenches, torques, centre, after.shares, path)
