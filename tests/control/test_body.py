"""From the body to its limbs: estimates, shares of a wrench, the hook limit."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.control.body import (
    KINEMATIC,
    LIMIT_COUNTED,
    LIMIT_NONE,
    LIMIT_SHARED,
    LIMIT_THESIS,
    THESIS,
    along_grab,
    command_tips,
    share_wrench,
)
from clamber.control.body_estimate import estimate_body
from clamber.control.chain import chain_of_limb
from clamber.control.hook_forces import MOST_CUTS
from clamber.execution.climb.postures import postures
from clamber.execution.climb.whole_body import WholeBody
from clamber.robots.library import load_robot
from clamber.robots.limbed import LimbedRobot
from clamber.types import Floats

ROBOT = load_robot("libra")
assert isinstance(ROBOT, LimbedRobot)
LEGS = WholeBody(ROBOT, period=0.005).legs
BOTH = np.array((1, 1, 0))


def on_holds(pose: Floats, holds: Floats) -> Floats:
    """Joint angles with every tip on its hold; the posture with the hook on top."""
    return np.array(
        [
            max(postures(limb, pose, place), key=lambda one: one.on_top).angles
            for limb, place in zip(ROBOT.limbs, holds, strict=True)
        ]
    )


POSES = st.tuples(st.floats(-0.03, 0.03), st.floats(-0.03, 0.03), st.floats(-0.15, 0.15)).map(np.array)
HOLDS = np.array(((0.2286, 0.02), (-0.2286, 0.0), (0.05, -0.25)))


@given(POSES, st.booleans())
def test_the_estimate_is_exact_where_the_map_is(pose: Floats, with_encoder: bool) -> None:
    q = on_holds(pose, HOLDS)
    tips, speeds, found, twist = np.zeros((3, 2)), np.zeros((3, 2)), np.zeros(3), np.zeros(3)
    count = estimate_body(
        LEGS, q, np.zeros((3, 2)), BOTH, HOLDS, pose[2], 0.0, with_encoder, tips, speeds, found, twist
    )
    assert count == 2
    np.testing.assert_allclose(found, pose, atol=1e-12)


@given(POSES, POSES, st.booleans())
def test_the_estimated_speed_is_the_derivative_of_the_pose(pose: Floats, rate: Floats, with_encoder: bool) -> None:
    step = 1e-6
    ahead, behind = on_holds(pose + step * rate, HOLDS), on_holds(pose - step * rate, HOLDS)
    qd = (ahead - behind) / (2 * step)
    tips, speeds, found, twist = np.zeros((3, 2)), np.zeros((3, 2)), np.zeros(3), np.zeros(3)
    estimate_body(
        LEGS, on_holds(pose, HOLDS), qd, BOTH, HOLDS, pose[2], rate[2], with_encoder, tips, speeds, found, twist
    )
    np.testing.assert_allclose(twist, rate, atol=1e-7)


@pytest.mark.parametrize("held", [(1, 1, 0), (1, 0, 1), (1, 1, 1)])
@given(st.tuples(*[st.floats(-50, 50)] * 3).map(np.array))
def test_the_shared_forces_add_up_to_the_wrench(held: tuple[int, ...], wrench: Floats) -> None:
    forces = np.zeros((3, 2))
    share_wrench(np.array(held), HOLDS, wrench, forces)
    moment = sum(r[0] * f[1] - r[1] * f[0] for r, f in zip(HOLDS, forces, strict=True))
    np.testing.assert_allclose((*forces.sum(axis=0), moment), wrench, atol=1e-9)
    assert not forces[np.array(held) == 0].any()


def test_two_limbs_share_a_weight_as_the_thesis_says() -> None:
    forces = np.zeros((3, 2))
    share_wrench(BOTH, HOLDS, np.array((0.0, 40.0, 0.0)), forces)
    rx1, rx2 = HOLDS[0, 0], HOLDS[1, 0]
    np.testing.assert_allclose(forces[:2], ((0.0, -40 * rx2 / (rx1 - rx2)), (0.0, 40 * rx1 / (rx1 - rx2))), atol=1e-12)


def _command(limit: int, wanted: Floats, *, mapping: int = THESIS) -> tuple[Floats, Floats, Floats]:
    pose = np.zeros(3)
    q = on_holds(pose, HOLDS)
    pulls, forces = np.zeros((3, 2)), np.zeros((3, 2))
    fed = np.array((0.0, 38.0, 0.0))
    drags, cuts = np.zeros((3, 2)), np.zeros((MOST_CUTS, 2))
    least = np.full(3, 0.3)
    command_tips(LEGS, q, BOTH, pose, HOLDS, wanted, fed, mapping, limit, least, drags, cuts, pulls, forces)
    return q, pulls, forces


def _along(i: int, q: Floats, pull: Floats) -> float:
    grab = q[i].sum() + LEGS[i]["hook_angle"]
    return float(math.cos(grab) * pull[0] + math.sin(grab) * pull[1])


@given(st.tuples(*[st.floats(-3, 3)] * 3).map(np.array))
def test_a_hook_is_never_asked_to_leave_its_hold(wanted: Floats) -> None:
    for limit in (LIMIT_THESIS, LIMIT_COUNTED, LIMIT_SHARED):
        q, pulls, forces = _command(limit, wanted)
        for i in range(2):
            fed = 0.0 if limit == LIMIT_THESIS else along_grab(LEGS[i], q[i], forces[i])
            assert _along(i, q, pulls[i]) + fed >= 0.3 - 1e-9


def test_pulling_against_each_other_leaves_the_wrench_on_the_body() -> None:
    wanted = np.array((0.6, 0.4, 0.0))
    _, free_pulls, free = _command(LIMIT_NONE, wanted)
    _, pulls, forces = _command(LIMIT_SHARED, wanted)
    turned = [np.exp(1j * LEGS[i]["port_angle"]) for i in range(2)]
    more = [complex(*(forces[i] - free[i])) * turned[i] for i in range(2)]  # body frame
    assert abs(more[0] + more[1]) < 1e-9
    line = complex(*(HOLDS[1] - HOLDS[0]))
    assert abs((more[0] * line.conjugate()).imag) < 1e-9
    np.testing.assert_allclose(pulls[:2], free_pulls[:2])


def test_the_kinematic_map_moves_every_tip_against_the_body() -> None:
    _, pulls, _ = _command(LIMIT_NONE, np.array((1.0, 2.0, 3.0)), mapping=KINEMATIC)
    for i in range(2):
        port = np.exp(1j * LEGS[i]["port_angle"])
        body = complex(1.0, 2.0) + 3.0j * complex(*HOLDS[i])
        assert abs(complex(*pulls[i]) * port + body) < 1e-12


@pytest.mark.parametrize("i", range(3))
def test_the_force_counted_along_the_grab_direction_is_what_moves_the_tip(i: int) -> None:
    chain = chain_of_limb(ROBOT, ROBOT.limbs[i].name)
    q, force = np.array((0.4, -0.9)), np.array((3.0, -7.0))
    jacobian = chain.jacobian(q)[:2]
    moved = jacobian @ ((jacobian.T @ force) / chain.joints["share"])
    grab = q.sum() + ROBOT.limbs[i].end.angle
    assert along_grab(LEGS[i], q, force) == pytest.approx(moved @ (math.cos(grab), math.sin(grab)), rel=1e-12)
