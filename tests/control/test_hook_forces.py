"""Two hooks share a load: balance, cones, the best of what cannot be, symmetry, continuity."""

import math

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import linprog

from clamber.families.climber.control.hook_forces import (
    FAR,
    MOST_CUTS,
    WISHED_CONE,
    WISHED_PULL,
    max_min_solution,
    pair_forces,
)
from clamber.families.climber.control.limb_chain import legs_of
from clamber.families.climber.execution.postures import postures
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.tasks.robots import load_robot
from clamber.types import Floats

ROBOT = load_robot("libra")
assert isinstance(ROBOT, LimbedRobot)
LEGS = legs_of(ROBOT)
HOLDS = np.array(((0.2286, 0.02), (-0.2286, 0.0), (0.05, -0.25)))
POSES = st.tuples(st.floats(-0.03, 0.03), st.floats(-0.03, 0.03), st.floats(-0.15, 0.15)).map(np.array)
MORE = st.tuples(st.floats(-60, 60), st.floats(-60, 60), st.floats(-5, 5)).map(np.array)
WEIGHT = np.array((0.0, ROBOT.weight, 0.0))


def on_top(pose: Floats, holds: Floats) -> Floats:
    """Joint angles with every tip on its hold, hooks on top."""
    return np.array(
        [
            max(postures(limb, pose, place), key=lambda one: one.on_top).angles
            for limb, place in zip(ROBOT.limbs, holds, strict=True)
        ]
    )


def shared(pose: Floats, a: int, b: int, more: Floats, holds: Floats = HOLDS) -> tuple[Floats, Floats, float, float]:
    q, arms, forces = on_top(pose, holds), holds - pose[:2], np.zeros((3, 2))
    margin, part = pair_forces(
        (LEGS, q, pose, arms), (a, b), (tuple(WEIGHT), tuple(more)), np.zeros((MOST_CUTS, 2)), forces
    )
    return q, forces, margin, part


@given(POSES, MORE, st.sampled_from(((0, 1), (0, 2), (1, 2))))
def test_the_forces_bring_the_steady_wrench_and_a_part_of_the_rest(
    pose: Floats, more: Floats, pair: tuple[int, int]
) -> None:
    _, forces, _, part = shared(pose, *pair, more)
    assert 0.0 <= part <= 1.0
    arms = HOLDS - pose[:2]
    moment = sum(arms[i, 0] * forces[i, 1] - arms[i, 1] * forces[i, 0] for i in pair)
    np.testing.assert_allclose((*forces[list(pair)].sum(axis=0), moment), WEIGHT + part * more, atol=1e-8)


@given(POSES, st.sampled_from(((0, 1), (0, 2), (1, 2))))
def test_where_the_worst_wish_is_met_every_hook_is_pulled_within_its_cone(pose: Floats, pair: tuple[int, int]) -> None:
    q, forces, margin, _ = shared(pose, *pair, np.zeros(3))
    assume(margin >= 0.0)
    for i in pair:
        grab = pose[2] + LEGS[i]["port_angle"] + q[i].sum() + LEGS[i]["hook_angle"]
        along = -float(forces[i] @ (math.cos(grab), math.sin(grab)))
        assert along >= WISHED_PULL - 1e-9
        assert along >= math.cos(WISHED_CONE) * float(np.hypot(*forces[i])) - 1e-9


@given(st.integers(0, 2**32 - 1), st.integers(2, MOST_CUTS))
def test_the_best_worst_cut_is_that_of_a_linear_programme(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    cuts = np.stack((rng.normal(0.0, 20.0, count), rng.normal(0.0, 1.0, count)), axis=1)
    cuts[0, 1], cuts[1, 1] = abs(cuts[0, 1]) + 0.1, -abs(cuts[1, 1]) - 0.1
    lam, least = max_min_solution(cuts, count, 3.0)
    assert abs(least - (cuts[:, 0] + cuts[:, 1] * lam).min()) < 1e-9
    # greatest t with c + d lambda >= t
    rows = np.stack((-cuts[:, 1], np.ones(count)), axis=1)
    best = linprog((0.0, -1.0), A_ub=rows, b_ub=cuts[:, 0], bounds=((-FAR, FAR), (None, None)))
    assert best.success
    if -best.fun < -1e-6:
        assert abs(least + best.fun) < 1e-6
    else:
        assert least >= -1e-6


@given(POSES)
def test_a_mirrored_stance_has_mirrored_forces(pose: Floats) -> None:
    mirror = np.array((-1.0, 1.0))
    _, forces, _, _ = shared(pose, 0, 1, np.zeros(3))
    holds = np.array((HOLDS[1] * mirror, HOLDS[0] * mirror, HOLDS[2]))
    _, mirrored, _, _ = shared(pose * (-1.0, 1.0, -1.0), 0, 1, np.zeros(3), holds)
    np.testing.assert_allclose(mirrored[:2], forces[1::-1] * mirror, atol=1e-6)


@given(POSES, MORE)
def test_the_forces_do_not_jump_as_the_body_moves(pose: Floats, more: Floats) -> None:
    _, here, _, _ = shared(pose, 0, 1, np.zeros(3))
    _, there, _, _ = shared(pose + 1e-7, 0, 1, np.zeros(3))
    np.testing.assert_allclose(there, here, atol=1e-3)
