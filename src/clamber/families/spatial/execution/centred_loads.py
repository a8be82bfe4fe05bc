"""Loads of a stance farthest from all limits of contacts and motors.

The planner's programme finds wrenches that leave the most of the limit that binds; what does not bind may be anywhere up to there,
friction of feet all but used up. Here wrenches that balance the same, and leave every contact nearly as much as the programme leaves the
one that binds, are moved to where the product of all that is left is largest: the analytic centre of Sonnevend (1986), by Newton's
method, damped so that no step leaves the limits (Nesterov and Nemirovskii 1994).
"""

import math
from typing import Final, TypeAlias

import numpy as np
from scipy.linalg import block_diag
from scipy.optimize import linprog

from ....control.whole_body.tree import FREE, Dynamics, State
from ....control.whole_body.tree_kernels import work_out
from ....types import Floats, Ints
from ....units import GRAVITY
from ..control.believed_tree import believed_tree, joint_limits
from ..robot.robot import SpatialRobot
from ..world.world import World
from .plant import Pose

Contacts: TypeAlias = tuple[list[int], list[tuple[Floats, Floats]], list[tuple[Floats, Floats, Floats]], list[slice]]
KEPT: Final = 0.9
"""What every contact has left of its limits stays this part of what the planner's programme leaves of the one that binds [-]."""
STEPS: Final = 40
"""Of Newton's method at most."""
NEAR: Final = 1e-3
"""Newton's decrement at which it ends [-]."""


def contact_rows(
    robot: SpatialRobot, world: World, limb: int, hold: int, turn: Floats, share: float
) -> tuple[Floats, Floats, Floats]:
    """A limb's contact on a hold: its normal and tangents as rows, shape (3, 3), and its polytope, `rows wrench <= limits`.

    Args:
        robot: Whose limb it is.
        world: Of the hold.
        limb, hold: Their indices.
        turn: Axes of the end effector, world frame, as columns, shape (3, 3).
        share: Of friction and pull that is counted on [-].
    """
    contact, patch, normal = robot.contacts[limb], world.holds[hold], world.normals[hold]
    x = turn[:, 0] if abs(float(normal @ turn[:, 0])) <= 0.9 else turn[:, 1]
    first = x - (normal @ x) * normal
    first /= np.linalg.norm(first)
    mu = min(contact.friction, math.inf if patch.friction is None else patch.friction)
    tilt = math.acos(min(1.0, max(-1.0, -float(turn[:, 2] @ normal))))
    pull = min(
        contact.pull * max(0.0, 1.0 - contact.tilt_loss * tilt), math.inf if patch.strength is None else patch.strength
    )
    rows, limits = contact.polytope(share * mu, share * pull)
    return np.stack((normal, first, np.cross(normal, first))), rows, limits


class LoadCentre:
    """Moves loads of stances away from their limits.

    Args:
        robot: The robot. Its motors give more than plans use (`torque_share`), while contacts bear no more: all of it counts here.
        world: Where it stands.
    """

    def __init__(self, robot: SpatialRobot, world: World) -> None:
        self._robot = robot
        self._world = world
        self._tree = tree = believed_tree(robot, world.gravity)
        self._state, self._dynamics = State.of(tree), Dynamics.of(tree)
        self._torque = joint_limits(robot).torque

    def __call__(self, pose: Pose, joints: Floats, holds: Ints, loads: Floats) -> Floats:
        """The centre of the wrenches that balance as `loads` do; these themselves where they are on a limit, or beyond.

        Args:
            pose: Of the body.
            joints: Shape (n,).
            holds: Index of the hold of each limb that bears, -1: it does not; shape (limbs,).
            loads: World frame, shape (limbs, 6).
        """
        bearing, turns, bounds, parts = self._contacts(pose, joints, holds, 1.0)
        if not bearing:
            return loads
        dynamics, at = self._dynamics, parts[-1].stop
        start = np.concatenate(
            [turn @ loads[limb, : len(turn)] for limb, (turn, _) in zip(bearing, turns, strict=True)]
        )
        levers = np.concatenate([turn @ jacobian for turn, jacobian in turns])
        torque = dynamics.weight[FREE:] - start @ levers[:, FREE:]
        matrix, limit = [-levers[:, FREE:].T, levers[:, FREE:].T], [self._torque - torque, self._torque + torque]
        rooms = [limits - rows @ start[part] for part, (rows, limits, _) in zip(parts, bounds, strict=True)]
        least = max(0.0, min(float((room / scale).min()) for room, (_, _, scale) in zip(rooms, bounds, strict=True)))
        for part, room, (rows, _, scale) in zip(parts, rooms, bounds, strict=True):
            whole = np.zeros((len(rows), at))
            whole[:, part] = rows
            matrix.append(whole)
            limit.append(room - KEPT * least * scale)
        moved = centre(np.concatenate(matrix), np.concatenate(limit), levers[:, :FREE].T)
        found = loads.copy()
        for limb, part, (turn, _) in zip(bearing, parts, turns, strict=True):
            found[limb, : len(turn)] = turn.T @ (start[part] + moved[part])
        return found

    def bears(self, pose: Pose, joints: Floats, holds: Ints, share: float) -> bool:
        """Whether contacts that are relied on for that share of friction and pull [-] can hold the robot at rest; see `__call__`."""
        bearing, turns, bounds, parts = self._contacts(pose, joints, holds, share)
        if not bearing:
            return False
        levers, weight = np.concatenate([turn @ jacobian for turn, jacobian in turns]), self._dynamics.weight
        solved = linprog(
            np.zeros(parts[-1].stop),
            np.concatenate((block_diag(*(rows for rows, _, _ in bounds)), -levers[:, FREE:].T, levers[:, FREE:].T)),
            np.concatenate(
                (*(bound[1] for bound in bounds), self._torque - weight[FREE:], self._torque + weight[FREE:])
            ),
            levers[:, :FREE].T,
            weight[:FREE],
            bounds=(None, None),
        )
        return bool(solved.success)

    def _contacts(self, pose: Pose, joints: Floats, holds: Ints, share: float) -> Contacts:
        """Limbs that bear; of each its contact's axes and Jacobian; rows, limits and scale of its polytope; its part of all wrenches."""
        state, dynamics = self._state, self._dynamics
        state.rotation[:], state.position[:], state.joints[:] = pose.rotation, pose.position, joints
        work_out(self._tree, state, dynamics)
        bearing = [limb for limb, hold in enumerate(holds.tolist()) if hold >= 0]
        turns, bounds, parts, at = [], [], [], 0
        weight = GRAVITY * self._robot.chains.total_mass
        for limb in bearing:
            turn = dynamics.tip_turn[limb]
            frame, rows, limits = contact_rows(self._robot, self._world, limb, int(holds[limb]), turn, share)
            size = self._robot.contacts[limb].components
            axes = np.asarray(np.kron(np.eye(size // 3), frame), np.float64)
            turns.append((axes, dynamics.jacobian[limb, :size]))
            parts.append(slice(at, at + size))
            scale = np.array([row.slack[0] * weight + row.slack[1] for row in self._robot.contacts[limb].rows])
            bounds.append((rows[:, :size], limits, scale))
            at += size
        return bearing, turns, bounds, parts


def centre(rows: Floats, limits: Floats, balance: Floats) -> Floats:
    """Where the product of `limits - rows x` is largest of all x with `balance x = 0`; zero where zero is not within the limits.

    Args:
        rows: Shape (rows, n).
        limits: Shape (rows,).
        balance: Shape (equations, n).
    """
    x = np.zeros(rows.shape[1])
    _, sizes, ways = np.linalg.svd(balance)
    free = ways[np.count_nonzero(sizes > 1e-9 * sizes[0]) :].T
    if limits.min() <= 0.0 or not free.size:
        return x
    along = rows @ free
    for _ in range(STEPS):
        inverse = 1.0 / (limits - rows @ x)
        scaled = inverse[:, None] * along
        slope = scaled.sum(axis=0)
        step = -np.linalg.lstsq(scaled.T @ scaled, slope)[0]
        decrement = math.sqrt(max(0.0, -float(slope @ step)))
        x += free @ step / (1.0 + decrement)
        if decrement < NEAR:
            break
    return x
