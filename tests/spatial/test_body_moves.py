"""Limbs on the body's way from one pose to the next, against postures by least squares at many places of the same way."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from spatial_again import in_space, verdicts_of

import plain_spatial as plain
from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.planning.task import SpatialTask
from clamber.planning.beam import plan_beam
from clamber.planning.problem.codes import HOLD, MOVE, pack
from clamber.planning.problem.verdict import check_plan
from clamber.types import Floats

PLACES = 11
"""Of a way that are looked at."""
BENT = 0.005
"""What joints that turn lie beside the straight line between their places, of the robot's size at most."""


def poses(before: Any, after: Any) -> list[Floats]:
    """Frames of the base along its way: straight on, and about one axis, shape (4, 4) each."""
    first, last = (stance["turn"].reshape(3, 3) for stance in (before, after))
    turn, found = Rotation.from_matrix(last @ first.T).as_rotvec(), []
    for u in np.linspace(0.0, 1.0, PLACES):
        base = np.eye(4)
        base[:3, :3] = Rotation.from_rotvec(u * turn).as_matrix() @ first
        base[:3, 3] = before["place"] + u * (after["place"] - before["place"])
        found.append(base)
    return found


def joints_on_way(task: SpatialTask, before: Any, after: Any) -> list[list[Floats]]:
    """Places of all limbs' joints and tips in the base frame along a move, tips where they hold: of each place, of each limb."""
    chains, posture, found = task.robot.chains, before["q"].copy(), []
    for u, base in zip(np.linspace(0.0, 1.0, PLACES), poses(before, after), strict=True):
        at = []
        for limb, n in enumerate(chains.n_joints):
            lean = before["q"][limb] + u * (after["q"][limb] - before["q"][limb])
            place = task.world.places[before["hold"][limb]]

            def error(q: Floats, limb: int = limb, base: Floats = base, place: Floats = place) -> Floats:
                off: Floats = plain.frames(chains, limb, q, base)[-1][:3, 3] - place
                return off

            solved = least_squares(error, lean[:n], xtol=1e-12, ftol=1e-12, gtol=1e-12)
            assert np.abs(solved.fun).max() < 1e-5
            posture[limb, :n] = solved.x
            at.append(plain.joints(chains, limb, posture[limb], np.eye(4)))
        found.append(at)
    return found


def between_limbs(task: SpatialTask, at: list[Floats]) -> float:
    """Smallest gap between links of different limbs [m]."""
    return min(
        plain.limb_gap(task.robot.chains, limb, at[limb], dict(enumerate(at[:limb]))) for limb in range(1, len(at))
    )


def beside_base(task: SpatialTask, at: list[Floats]) -> float:
    """Smallest gap between the base's box and links [m]."""
    return min(plain.base_gap(task.robot.chains, limb, own) for limb, own in enumerate(at))


GOALS = {
    "stones-quadruped": ("goal={ along_min = '0.5 m' }", "robot.limb_room=15 mm"),
    "rubble-hexapod": ("goal={ along_min = '0.3 m' }",),
    "gecko-climb": ("goal.y_min=45 cm",),
}


@cache
def moves(name: str) -> list[Any]:
    """Of every move of a plan: its margins, and the joints of all limbs along it; the task first."""
    task: Any = in_space(name, *GOALS[name])
    found = plan_beam(task, width=30, threads=1)
    assert found.has_plan, found.reason
    verdict = check_plan(task, found.plan)
    assert verdict.ok
    stances = SpatialProblem(task, 1, exact=True).replay(found.plan.codes(task)).stances
    steps = zip(found.plan.actions, verdict.per_step, stances[:-1], stances[1:], strict=True)
    ways = [(step.margins, joints_on_way(task, a, b)) for action, step, a, b in steps if action.kind == "move"]
    return [task, *ways]


@pytest.mark.slow
@pytest.mark.parametrize("name", GOALS)
def test_gaps_of_a_move_are_the_least_on_its_way(name: str) -> None:
    task, *ways = moves(name)
    assert ways
    bent = BENT * float(np.linalg.norm(task.robot.chains.offset[0], axis=1).sum())
    for margins, way in ways:
        room = task.robot.chains.limb_room
        for check, gap, asked in (("limb_limb", between_limbs, room), ("limb_body", beside_base, 0.0)):
            ends, least = min(gap(task, way[0]), gap(task, way[-1])) - asked, min(gap(task, at) for at in way) - asked
            if least < 1.0:  # of what is far away nobody needs to know how far
                assert least - bent <= margins[check] <= ends + 1e-5
                assert margins[check] <= least + bent


def test_a_move_that_leads_one_limb_through_another_is_refused() -> None:
    """Both its poses are fine where links may touch; forearms of a gecko on a wall are through each other between them."""
    task = in_space("gecko-climb")
    task = replace(task, robot=replace(task.robot, chains=replace(task.robot.chains, limb_room=0.0)))
    problem = SpatialProblem(task, 1)
    stances = problem.start.copy()
    first = (pack(HOLD, 0, 35), pack(HOLD, 2, 16), pack(MOVE, 0, 2))
    for code in first:
        reasons, stances = verdicts_of(problem, stances, np.array([code], np.int32))
        assert reasons[0] < 0
    reasons, made = verdicts_of(problem, stances, np.array([pack(MOVE, 0, 6)], np.int32))
    assert list(problem.checks)[reasons[0]] == "limb_limb"
    gaps = [between_limbs(task, at) for at in joints_on_way(task, stances[0], made[0])]
    assert min(gaps[0], gaps[-1]) > 0.0 > min(gaps)
