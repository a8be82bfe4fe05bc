"""Where a robot in space is: frames of its links in the world, centre of mass, joint torques, and postures between two stances."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ....types import Floats
from .chains import Chains

MOST_STEPS: Final = 40
"""Of inverse kinematics."""
REACHED: Final = 1e-6
"""Error of a tip at which inverse kinematics ends [m]."""
DAMPING: Final = 1e-6
"""Of the squared Jacobian, as a share of its trace [-]."""
LARGEST_STEP: Final = 0.3
"""Of a joint in one step of inverse kinematics [rad] or [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Posed:
    """A body and its joints; leading axes are those of many stances."""

    place: Floats
    """Origin of the base frame, world frame [m], shape (..., 3)."""
    turn: Floats
    """Axes of the base frame as columns, world frame, shape (..., 3, 3)."""
    q: Floats
    """Joint positions [rad] or [m], shape (..., limbs, most joints); 0 where a limb has no such joint."""


@dataclass(frozen=True, slots=True, eq=False)
class LinkFrames:
    """Frames of all links, world frame; behind a limb's last joint every frame is that of its tip."""

    origins: Floats
    """Of the joints and, from index n_joints on, of the tip [m], shape (..., limbs, most joints + 1, 3)."""
    axes: Floats
    """As columns, shape (..., limbs, most joints + 1, 3, 3); frame k moves with joint k."""

    @property
    def tips(self) -> Floats:
        """Places of the tips [m], shape (..., limbs, 3)."""
        return self.origins[..., -1, :]


def posed(chains: Chains, stances: np.void | np.ndarray) -> Posed:
    """Body and joints of a stance record, or of an array of them."""
    limbs, most = chains.lower.shape
    turn = np.asarray(stances["turn"], np.float64)
    return Posed(
        np.array(stances["place"], np.float64),
        turn.reshape(*turn.shape[:-1], 3, 3).copy(),
        np.array(stances["q"], np.float64)[..., :limbs, :most],
    )


def link_frames(chains: Chains, at: Posed) -> LinkFrames:
    """Frames of all links and tips of a posture, or of many."""
    limbs, most = chains.lower.shape
    lead = at.place.shape[:-1]
    place = np.broadcast_to(at.place[..., None, :], (*lead, limbs, 3))
    axes = np.broadcast_to(at.turn[..., None, :, :], (*lead, limbs, 3, 3))
    origins, frames = np.empty((*lead, limbs, most + 1, 3)), np.empty((*lead, limbs, most + 1, 3, 3))
    for k in range(most + 1):
        place = place + np.einsum("...ij,...j->...i", axes, chains.offset[:, k])
        axes = axes @ chains.rotation[:, k]
        if k < most:
            slides = chains.sliding[:, k] == 1
            place = place + np.where(slides, at.q[..., k], 0.0)[..., None] * axes[..., 2]
            axes = axes @ turns_about_z(np.where(slides, 0.0, at.q[..., k]))
        origins[..., k, :], frames[..., k, :, :] = place, axes
    return LinkFrames(origins, frames)


def turns_about_z(angles: Floats) -> Floats:
    """Rotations about z by angles [rad], shape (..., 3, 3)."""
    made = np.zeros((*angles.shape, 3, 3))
    made[..., 0, 0] = made[..., 1, 1] = np.cos(angles)
    made[..., 1, 0] = np.sin(angles)
    made[..., 0, 1] = -made[..., 1, 0]
    made[..., 2, 2] = 1.0
    return made


def jacobians(chains: Chains, frames: LinkFrames, points: Floats) -> Floats:
    """Motion of one point of each limb per joint, as if it were fixed to the last link, shape (..., limbs, 3, most joints).

    Args:
        chains: The robot.
        frames: Of its links.
        points: World frame [m], shape (..., limbs, 3).
    """
    most = chains.lower.shape[1]
    axis = frames.axes[..., :most, :, 2]
    arm = points[..., None, :] - frames.origins[..., :most, :]
    slides = chains.sliding[:, :, None] == 1
    columns = np.where(slides, axis, cross(axis, arm))
    made: Floats = np.swapaxes(np.where(chains.used[..., None], columns, 0.0), -1, -2)
    return made


def cross(a: Floats, b: Floats) -> Floats:
    """Cross products of vectors along the last axis; `np.cross` takes four times as long for a few of them."""
    made: Floats = np.stack(
        (
            a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
            a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
            a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
        ),
        axis=-1,
    )
    return made


def reach_tips(chains: Chains, start: Posed, tips: Floats) -> Posed:
    """The posture near `start` whose tips are at given places: damped least squares within the joints' limits.

    Args:
        chains: The robot.
        start: Body, which stays, and joint positions to begin at.
        tips: World frame [m], shape (..., limbs, 3); as near as can be where a limb does not reach so far.
    """
    q = np.clip(start.q, chains.lower, chains.upper)
    for _ in range(MOST_STEPS):
        at = Posed(start.place, start.turn, q)
        frames = link_frames(chains, at)
        error = tips - frames.tips
        if float(np.abs(error).max(initial=0.0)) < REACHED:
            break
        jacobian = jacobians(chains, frames, frames.tips)
        step = _damped(jacobian, error)
        stuck = ((q <= chains.lower) & (step < 0.0)) | ((q >= chains.upper) & (step > 0.0))
        if stuck.any():
            step = _damped(np.where(stuck[..., None, :], 0.0, jacobian), error)
        largest = np.abs(step).max(axis=-1, keepdims=True)
        q = np.clip(q + step * np.minimum(1.0, LARGEST_STEP / np.maximum(largest, 1e-12)), chains.lower, chains.upper)
    return Posed(start.place, start.turn, q)


def _damped(jacobian: Floats, error: Floats) -> Floats:
    """Joint steps that reduce errors of the tips, shape (..., limbs, most joints)."""
    square = jacobian @ np.swapaxes(jacobian, -1, -2)
    damping = DAMPING * np.trace(square, axis1=-2, axis2=-1)[..., None, None] + 1e-15
    solved = np.linalg.solve(square + damping * np.eye(3), error[..., None])
    made: Floats = (np.swapaxes(jacobian, -1, -2) @ solved)[..., 0]
    return made


def rotation_between(before: Floats, after: Floats, share: float) -> Floats:
    """The rotation at a share of the shortest turn from one to another, shape (3, 3) each."""
    turned = before.T @ after
    skew = np.array((turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]))
    angle = math.atan2(float(np.linalg.norm(skew)), float(np.trace(turned)) - 1.0)
    if angle < 1e-9:
        return after.copy()
    half = math.sin(angle) < 1e-6  # the axis is then that of the symmetric part
    x, y, z = np.linalg.eigh(turned + turned.T)[1][:, -1] if half else skew / np.linalg.norm(skew)
    cross = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
    partly = share * angle
    made: Floats = before @ (np.eye(3) + math.sin(partly) * cross + (1.0 - math.cos(partly)) * (cross @ cross))
    return made


def quaternions(turns: Floats) -> Floats:
    """w, x, y, z of rotations, shape (..., 3, 3) -> (..., 4)."""
    from scipy.spatial.transform import Rotation  # takes a tenth of a second to import

    found = Rotation.from_matrix(turns.reshape(-1, 3, 3)).as_quat()
    made: Floats = found[:, [3, 0, 1, 2]].reshape(*turns.shape[:-2], 4)
    return made


def body_between(chains: Chains, before: Posed, after: Posed, tips: Floats, share: float) -> Posed:
    """A body on its way between two stances, limbs on their holds.

    Args:
        chains: The robot.
        before, after: The stances.
        tips: Where the holds are, world frame [m], shape (limbs, 3).
        share: Of the way, in [0, 1].
    """
    place = before.place + share * (after.place - before.place)
    turn = rotation_between(before.turn, after.turn, share)
    q = before.q + share * (after.q - before.q)
    return reach_tips(chains, Posed(place, turn, q), tips)


def swing_between(chains: Chains, before: Posed, after: Posed, limb: int, tip: Floats, share: float) -> Posed:
    """A limb on its way between two holds: its tip is on its path, all else as before.

    Args:
        chains: The robot.
        before, after: The stances; the body is where it was.
        limb: Which swings.
        tip: Where its tip is by now, world frame [m], shape (3,).
        share: Of the way, in [0, 1].
    """
    q = before.q.copy()
    q[limb] += share * (after.q[limb] - before.q[limb])
    start = Posed(after.place, after.turn, q)
    tips = link_frames(chains, Posed(after.place, after.turn, before.q)).tips.copy()
    tips[limb] = tip
    return reach_tips(chains, start, tips)


def centre_of_mass(chains: Chains, at: Posed, frames: LinkFrames) -> Floats:
    """Centre of mass of the whole robot, world frame [m], shape (..., 3)."""
    base = at.place + np.einsum("...ij,j->...i", at.turn, chains.base_centre)
    moment = chains.base_mass * base + np.einsum("lk,...lki->...i", chains.mass, link_centres(chains, frames))
    made: Floats = moment / chains.total_mass
    return made


def link_centres(chains: Chains, frames: LinkFrames) -> Floats:
    """Centres of mass of the links, world frame [m], shape (..., limbs, most joints, 3)."""
    most = chains.lower.shape[1]
    turned = np.einsum("...lkij,lkj->...lki", frames.axes[..., :most, :, :], chains.centre)
    made: Floats = frames.origins[..., :most, :] + turned
    return made


def joint_torques(chains: Chains, frames: LinkFrames, wrenches: Floats, gravity: Floats) -> Floats:
    """Torques [N m] or forces [N] that motors give at rest, shape (..., limbs, most joints); 0 where a limb has no such joint.

    Args:
        chains: The robot.
        frames: Of its links.
        wrenches: Of the contacts on the tips, world frame: force [N], moment about the tip [N m], shape (..., limbs, 6).
        gravity: Acceleration of free fall, world frame [m/s^2], shape (3,).
    """
    most = chains.lower.shape[1]
    torque = -np.einsum("...lij,...li->...lj", jacobians(chains, frames, frames.tips), wrenches[..., :3])
    turning = np.where((chains.sliding == 1)[..., None], 0.0, frames.axes[..., :most, :, 2])
    torque -= np.einsum("...lki,...li->...lk", turning, wrenches[..., 3:])
    centres = link_centres(chains, frames)
    for k in range(most):  # the weight of link k loads the joints up to its own
        weight = chains.mass[:, k, None] * gravity
        moved = jacobians(chains, frames, centres[..., k, :])
        moved = np.where(np.arange(most) <= k, moved, 0.0)
        torque -= np.einsum("...lij,li->...lj", moved, weight)
    made: Floats = np.where(chains.used, torque, 0.0)
    return made
