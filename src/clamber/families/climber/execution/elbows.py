"""The side of every elbow for a plan that is to be carried out, and how well two limbs bear the body with their elbows on given sides."""

import math
from collections.abc import Callable
from itertools import product
from typing import Final

import numpy as np

from ....types import Floats, Ints, Records
from ..control.backlash import weight_moment
from ..control.hook_forces import MOST_CUTS, NOTHING, pair_forces
from ..control.limb_chain import legs_of
from ..control.swing_path import clearance
from ..robot.robot import HOOK_AHEAD, HOOK_WAY, HOOK_WIDTH, LimbedRobot
from ..statics.elbows import has_assignment
from ..statics.interference import hook_gap
from ..world.board import Board
from .approach import discs_near, discs_of, wall_of
from .body_gains import USUAL_WEIGHT
from .postures import Posture, bent_postures, postures

CHANGE: Final = 0.4
"""What a change of side counts, where 1 is a hook that pulls sideways instead of down [-]."""
BARRED: Final = 1e3
"""What counts a side that the plan's checks forbid."""
LACKING: Final = 0.5
"""What counts each newton that the worst of two carrying limbs lacks of what is wished, after each action [1/N]."""
ON_TOP: Final = 0.3
"""What a hook that pulls sideways instead of down counts after each action [-]."""
BLOCKED: Final = 4.0
"""What counts after each action a limb on a hold whose links or hook, with its way, touch another hold or the body: they bend aside [-]."""
NO_HOOK: Final = np.zeros(2)
"""A tip without a hook: hooks that hold are looked at as they are, with an open mouth."""
CLEAR: Final = 0.008
"""Clearance with which it counts nothing [m]."""
OFF_PLAN: Final = 0.2
"""What counts after each action a side that is not the one whose links the plan's checks have looked at [-]."""


def choose_elbows(robot: LimbedRobot, board: Board, stances: Records) -> tuple[Ints, Floats]:
    """A side for each stay on a hold, best for the whole plan: carriers that can bear it, hooks on top, few changes.

    An elbow that passes to the other side throws the body about, so a limb changes only where it gains much by it.

    Args:
        robot: The climber.
        board: Its holds.
        stances: Of the plan, shape (n + 1,).

    Returns:
        +1, -1, or 0 where a limb is free, shape (n + 1, limbs); and what counts against them after each action, shape (n + 1,).
    """
    n, limbs = len(stances), len(robot.limbs)
    states = np.array(list(product((0, 1), repeat=limbs)))
    costs = _costs(robot, board, stances, states)
    changed = states[:, None, :] != states[None, :, :]
    best, came = np.zeros((n, len(states))), np.zeros((n, len(states)), np.int64)
    best[0] = costs[0]
    for step in range(1, n):
        before, now = stances["hold"][step - 1, :limbs], stances["hold"][step, :limbs]
        free = (now >= 0) & (now != before)
        step_costs = CHANGE * changed.sum(axis=2) + np.where((changed & ~free).any(axis=2), np.inf, 0.0)
        total = best[step - 1][:, None] + step_costs
        came[step] = np.argmin(total, axis=0)
        best[step] = np.min(total, axis=0) + costs[step]
    sides: Ints = np.zeros((n, limbs), np.int32)
    elbow_costs: Floats = np.zeros(n)
    at = int(np.argmin(best[-1]))
    for step in range(n - 1, -1, -1):
        sides[step] = np.where(stances["hold"][step, :limbs] >= 0, 1 - 2 * states[at], 0)
        elbow_costs[step] = costs[step, at]
        at = int(came[step, at])
    return sides, elbow_costs


def _costs(robot: LimbedRobot, board: Board, stances: Records, states: Ints) -> Floats:
    """What each choice of branches counts after each action, shape (n, states)."""
    robot = robot.at_weight(USUAL_WEIGHT)
    legs, limbs = legs_of(robot), len(robot.limbs)
    cuts, forces = np.zeros((MOST_CUTS, 2)), np.zeros((limbs, 2))
    wrenches = (0.0, robot.weight, 0.0), NOTHING
    places = board.positions()
    costs = np.zeros((len(stances), len(states)))
    wall = wall_of(robot)
    for step, stance in enumerate(stances):
        pose = np.array((stance["x"], stance["y"], stance["angle"]))
        held = [i for i in range(limbs) if stance["hold"][i] >= 0]
        arms = np.array([places[hold] - pose[:2] if hold >= 0 else (0.0, 0.0) for hold in stance["hold"][:limbs]])
        found = {i: postures(robot.limbs[i], pose, places[stance["hold"][i]]) for i in held}
        near = {i: _crowding(robot, board, legs, i, pose, int(stance["hold"][i]), found[i], wall) for i in held}
        carriers = [i for i in held if int(stance["carriers"]) >> i & 1]
        for k, state in enumerate(states):
            q = np.zeros((limbs, 2))
            if not has_assignment(stance["elbows"], sum(int(side) << i for i, side in enumerate(state))):
                costs[step, k] += BARRED
            for i in held:
                if not found[i]:
                    costs[step, k] += BARRED
                    continue
                posture = found[i][int(state[i])]
                q[i] = posture.angles
                off_plan = int(stance["branch"][i]) != int(state[i])
                costs[step, k] += DRAWBACKS[robot.limbs[i].end.kind](posture, off_plan)
                costs[step, k] += near[i][int(state[i])]
            if len(carriers) == 2:
                margin, _ = pair_forces((legs, q, pose, arms), (carriers[0], carriers[1]), wrenches, cuts, forces)
                costs[step, k] += LACKING * max(0.0, -margin)
    return costs


def _not_on_top(posture: Posture, _: bool) -> float:
    return ON_TOP * (1.0 - posture.on_top)


DRAWBACKS: Final[dict[str, Callable[[Posture, bool], float]]] = {
    "hook": _not_on_top,
    "foot": _not_on_top,
    "gripper": lambda _, off_plan: OFF_PLAN * off_plan,
}
"""Kind of end effector -> what its posture, or one off the plan, counts after each action; a gripper may hold from anywhere."""


def _crowding(
    robot: LimbedRobot, board: Board, legs: Records, i: int, pose: Floats, on: int, found: list[Posture], wall: Floats
) -> list[float]:
    """What each posture of a limb on hold number `on` of the board's list counts for being near other holds and the body."""
    own = board.holds[on]
    others = [(hold.x, hold.y) for k, hold in enumerate(board.holds) if k != on]
    radius = max(hold.radius for hold in board.holds)
    obstacles = discs_near(discs_of(others, radius), pose), wall, robot.link_radius, NO_HOOK
    out = []
    for posture in found:
        room = clearance(legs[i], posture.angles[0], posture.angles[1], obstacles)
        if robot.limbs[i].end.kind != "gripper":
            x, y = posture.grab
            for other_x, other_y in others:
                dx, dy = other_x - own.x, other_y - own.y
                beside = hook_gap(HOOK_WIDTH, HOOK_AHEAD, HOOK_WAY, x * dx + y * dy, x * dy - y * dx)
                room = min(room, float(beside) - radius)
        out.append(BLOCKED * min(max(1.0 - room / CLEAR, 0.0), 1.0))
    return out


def load_capacity(robot: LimbedRobot, legs: Records, places: Floats, stance: Records, sides: Ints) -> float:
    """How well the worst hook or motor of two carrying limbs is off under the weight [N]: negative if none of the splits meets all wishes.

    Args:
        robot: The climber at `USUAL_WEIGHT`.
        legs: Its `legs_of`.
        places: Of the board's holds, world frame, shape (n_holds, 2) [m].
        stance: One of a plan.
        sides: Of the elbows, +1 or -1, shape (limbs,); those of other limbs don't count.

    Returns:
        -inf where a limb has no such posture; 0 where not two limbs carry.
    """
    carriers = [i for i in range(len(robot.limbs)) if int(stance["carriers"]) >> i & 1]
    if len(carriers) != 2:
        return 0.0
    pose = np.array((stance["x"], stance["y"], stance["angle"]))
    q, arms = np.zeros((len(robot.limbs), 2)), np.zeros((len(robot.limbs), 2))
    for i in carriers:
        place = places[stance["hold"][i]]
        found = bent_postures(robot.limbs[i], pose, place, float(sides[i]))
        if not found:
            return -math.inf
        q[i], arms[i] = found[0].angles, place - pose[:2]
    wrenches = (0.0, robot.weight, weight_moment(legs, q, pose[2])), NOTHING
    cuts, forces = np.zeros((MOST_CUTS, 2)), np.zeros_like(arms)
    margin, _ = pair_forces((legs, q, pose, arms), (carriers[0], carriers[1]), wrenches, cuts, forces)
    return float(margin)
