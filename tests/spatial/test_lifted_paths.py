"""Limbs on their way from hold to hold, against a plain calculation: the path, postures by least squares, gaps by dense points."""

import math
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.distance import cdist

import plain_spatial as plain
from clamber.families.spatial.execution.references import TipPath
from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.planning.robot_arrays import robot_arrays
from clamber.families.spatial.robot.chains import Chains
from clamber.families.spatial.statics.judging import lift_between
from clamber.families.spatial.statics.records import CLEAR, PATH_POINTS
from clamber.planning.beam import plan_beam
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.verdict import check_plan
from clamber.tasks import load_task
from clamber.types import Floats

TASKS = {
    "stones-quadruped": "goal={ along_min = '0.5 m' }",
    "wall-gripper": "goal={ along_min = '0.3 m' }",
    "truss-inchworm": "goal={ along_min = '0.6 m' }",
}


def eased(u: float) -> float:
    u = min(1.0, max(0.0, u))
    return u**3 * (10.0 - 15.0 * u + 6.0 * u * u)


def raised(way: Floats, first: Floats, last: Floats, lift: float) -> Floats:
    """How far a path is lifted, over an edge where each of its ends lies behind the other's surface."""
    behind, before, turned = float(-first @ way), float(last @ way), 1.0 + float(first @ last)
    over = max(0.0, max(behind, before) / turned - 0.5 * lift) if min(behind, before) > 0.0 and turned > 0.1 else 0.0
    up: Floats = 0.5 * (lift + over) * (first + last)
    return up


def followed(chains: Chains, limb: int, posture: Floats, base: Floats, place: Floats, normal: Floats | None) -> Floats:
    """Posture near another one that has the tip at a place, and its z against a normal where there is one."""
    n = int(chains.n_joints[limb])

    def error(q: Floats) -> Floats:
        end = plain.frames(chains, limb, np.append(q, posture[n:]), base)[-1]
        off: Floats = end[:3, 3] - place
        return off if normal is None else np.concatenate((off, 0.1 * (end[:3, 2] + normal)))

    found = least_squares(error, posture[:n], xtol=1e-14, ftol=1e-14, gtol=1e-14)
    return np.append(found.x, posture[n:])


NEAR = 1e-4
"""Postures on the way are solved to this part of the robot's size."""


@cache
def planned(name: str, *, whole: bool = False) -> tuple[Any, Plan]:
    """A task with the goal of `TASKS`, or as a whole, and a plan of it."""
    task = load_task(name, [] if whole else [TASKS[name]])
    found = plan_beam(task, width=120 if whole else 30, threads=1)
    assert found.has_plan, found.reason
    return task, found.plan


@cache
def swings(name: str, *, whole: bool = False) -> list[Any]:
    """Of every grab of a plan: its margins, base, limb, the joints of the limb on its way, and those of the other limbs."""
    task, plan = planned(name, whole=whole)
    verdict, found = check_plan(task, plan), []
    assert verdict.ok
    problem = SpatialProblem(task, 1, exact=True)
    stances = problem.replay(plan.codes(task)).stances
    chains, world = task.robot.chains, task.world
    aligned = robot_arrays(task.robot).robot["aligned"][0]
    for action, step, before, after in zip(plan.actions, verdict.per_step, stances[:-1], stances[1:], strict=True):
        if action.kind != "grab":
            continue
        limb = chains.limb_names.index(action.limb)
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = before["turn"].reshape(3, 3), before["place"]
        ends = [int(stance["hold"][limb]) for stance in (before, after)]
        (start, end), (first, last) = world.places[ends], world.normals[ends]
        posture, goal = before["q"][limb].copy(), after["q"][limb]
        way = [posture]
        for point in range(1, PATH_POINTS + 1):
            u = point / PATH_POINTS
            posture = posture + (goal - posture) / (
                PATH_POINTS + 1 - point
            )  # where it is free, it leans to the next stance's
            lifted = eased(min(u, 1.0 - u) / 0.4) * raised(end - start, first, last, task.rules.lift)
            normal = first + eased(u) * (last - first)
            normal = normal / np.linalg.norm(normal) if aligned[limb] else None
            place = start + eased((u - 0.15) / 0.7) * (end - start) + lifted
            posture = followed(chains, limb, posture, base, place, normal)
            way.append(posture)
        mine = [plain.joints(chains, limb, q, base) for q in [*way, after["q"][limb]]]
        others = {
            other: plain.joints(chains, other, before["q"][other], base)
            for other in range(len(chains.limb_names))
            if other != limb
        }
        found.append((step.margins, base, limb, mine, others))
    return found


POINTS = 41
"""Of each link, that stand for it on the way from one posture to the next."""


def nearest_between(chains: Chains, limb: int, way: list[Floats], others: dict[int, Floats]) -> float:
    """Gap between the links of a limb and those of others as points, at places of its way and between them [m]: a little too large."""
    along = np.linspace(0.0, 1.0, POINTS)[:, None]
    mine, theirs = list[tuple[Floats, float]](), list[tuple[Floats, float]]()
    for start, end in pairwise(way):
        for u in np.arange(20) / 20:
            mine += plain.links(chains, limb, start + u * (end - start))
    for other, there in others.items():
        theirs += plain.links(chains, other, there)
    there = np.concatenate([ends[0] + along * (ends[1] - ends[0]) for ends, _ in theirs])
    thick = np.repeat([radius for _, radius in theirs], POINTS)
    return min(
        float((cdist(ends[0] + along * (ends[1] - ends[0]), there).min(axis=0) - thick).min()) - radius
        for ends, radius in mine
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", TASKS)
def test_gaps_between_limbs_are_the_least_on_the_way(name: str) -> None:
    chains = planned(name)[0].robot.chains
    for margins, _, limb, mine, others in swings(name):
        standing = [
            plain.limb_gap(chains, i, others[i], {j: at for j, at in others.items() if j < i})
            for i in others
            if i > min(others)
        ]
        least = min(standing + [plain.limb_gap(chains, limb, at, others) for at in mine])
        between = min(least, nearest_between(chains, limb, mine, others))
        assert between - 0.005 <= margins["limb_limb"] + chains.limb_room <= least + NEAR


@pytest.mark.slow
def test_limbs_do_not_pass_through_each_other_between_the_points_that_are_solved() -> None:
    """A limb of 30 mm that swings by half a metre is past another one from one point to the next, 15 cm on."""
    chains = planned("truss-inchworm", whole=True)[0].robot.chains
    for _, _, limb, mine, others in swings("truss-inchworm", whole=True):
        thinnest = float(chains.radius[limb][1 : int(chains.n_joints[limb])].min())
        assert nearest_between(chains, limb, mine, others) > -0.5 * thinnest


def test_limbs_come_nearest_to_each_other_on_the_way() -> None:
    chains = planned("stones-quadruped")[0].robot.chains
    gaps = [
        [plain.limb_gap(chains, limb, at, others) for at in mine]
        for _, _, limb, mine, others in swings("stones-quadruped")
    ]
    assert any(min(way[1:-2]) < min(way[0], way[-1]) - 0.01 for way in gaps)


@pytest.mark.parametrize("name", TASKS)
def test_a_limb_is_as_far_from_the_base_as_it_comes_on_the_way(name: str) -> None:
    chains = planned(name)[0].robot.chains
    for margins, base, limb, mine, others in swings(name):
        inverse = np.linalg.inv(base)

        def from_base(which: int, at: Floats, inverse: Floats = inverse) -> float:
            return plain.base_gap(chains, which, at @ inverse[:3, :3].T + inverse[:3, 3])

        least = min(from_base(which, at) for which, at in [(limb, at) for at in mine] + list(others.items()))
        ways = [start + u * (end - start) for start, end in pairwise(mine) for u in np.arange(1, 20) / 20]
        between = min([least, *(from_base(limb, at) for at in ways)])
        assert between - NEAR <= margins["limb_body"] <= least + NEAR


@pytest.mark.slow
def test_a_limb_is_as_far_from_a_bar_as_it_comes_on_the_way() -> None:
    """Clamber looks at the ends of links and at some places between them: never nearer than links come, and little farther."""
    task, _ = planned("truss-inchworm")
    chains = task.robot.chains
    bars = [
        (np.array(solid.at), np.array(solid.to), solid.radius) for solid in task.world.solids if solid.kind == "bar"
    ]
    assert bars
    for margins, _, limb, mine, others in swings("truss-inchworm"):
        least, longest = np.inf, 0.0
        for which, at in [(limb, at) for at in mine] + list(others.items()):
            for k, (ends, radius) in enumerate(plain.links(chains, which, at), 1):
                length = float(np.linalg.norm(ends[1] - ends[0]))
                part = 1.0 if k + 1 < chains.n_joints[which] else max(0.0, 1.0 - CLEAR * radius / length)
                longest = max(longest, part * length)
                piece = np.array((ends[0], ends[0] + part * (ends[1] - ends[0])))
                least = min(least, *(plain.gap_of_segments(piece, np.array((a, b))) - r - radius for a, b, r in bars))
        assert least - NEAR <= margins["clearance"] <= least + longest / 6.0


@pytest.mark.parametrize("turned", [20.0, 60.0, 90.0, 140.0])
@pytest.mark.parametrize(("before", "behind"), [(0.05, 0.05), (0.02, 0.09), (0.1, 0.01)])
def test_a_path_goes_around_an_edge(turned: float, before: float, behind: float) -> None:
    """Every place of it is outside one of the two surfaces, and in its middle as far outside as half its lift has it."""
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    first, last = np.array((0.0, 0.0, 1.0)), np.array((s, 0.0, c))
    start, end = before * np.array((-1.0, 0.2, 0.0)), behind * np.array((c, -0.3, -s))
    normals, lift = np.stack((first, last)), 0.03
    path = TipPath(start, end, normals, lift_between(np.stack((start, end)), normals, lift))
    places = np.array([path.at(u)[0] for u in np.linspace(0.0, 1.0, 201)])
    outside = np.maximum((places - start) @ first, (places - end) @ last)
    assert outside.min() > -1e-12
    assert outside[100] >= 0.25 * lift * (1.0 + c) - 1e-12


@pytest.mark.parametrize("turned", [0.0, -30.0, -90.0])
def test_a_path_over_a_plane_or_through_a_corner_is_lifted_as_the_task_says(turned: float) -> None:
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    normals = np.array(((0.0, 0.0, 1.0), (s, 0.0, c)))
    ends = np.array(((-0.1, 0.0, 0.0), 0.1 * np.array((c, 0.1, -s))))
    assert lift_between(ends, normals, 0.03) == pytest.approx(0.015 * normals.sum(axis=0), abs=1e-15)


def test_tips_stay_outside_a_wall_and_its_top() -> None:
    task: Any = load_task("scene-top-out")
    found = plan_beam(task, width=30, threads=1)
    assert found.has_plan, found.reason
    (box,) = task.world.solids
    held = SpatialProblem(task, 1).start["hold"][0]
    holds = {limb: int(hold) for limb, hold in zip(task.robot.chains.limb_names, held, strict=False)}
    around = 0
    for action in found.plan.actions:
        if action.kind != "grab":
            continue
        ends = [holds[action.limb], action.hold - 1]
        holds[action.limb] = ends[1]
        places, normals = task.world.places[ends], task.world.normals[ends]
        path = TipPath(places[0], places[1], normals, lift_between(places, normals, task.rules.lift))
        points = np.array([path.at(u)[0] for u in np.linspace(0.0, 1.0, 101)])
        assert plain.depth_in_box(points - np.array(box.at), 0.5 * np.array(box.size)).min() > -1e-9
        around += normals[0] @ normals[1] < 0.5
    assert around > 0
