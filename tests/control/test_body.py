"""From the body to its limbs: estimates, shares of a wrench, the hook limit."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.families.climber.control.body import (
    KINEMATIC,
    LIMIT_COUNTED,
    LIMIT_NONE,
    LIMIT_SHARED,
    LIMIT_THESIS,
    THESIS,
    along_grab,
    command_contact_forces,
    distribute_wrench,
)
from clamber.families.climber.control.body_estimate import ENCODER, LINE, SECOND_TIP, estimate_body
from clamber.families.climber.control.hook_forces import MOST_CUTS
from clamber.families.climber.control.limb_chain import chain_of_limb
from clamber.families.climber.execution.postures import postures
from clamber.families.climber.execution.whole_body import WholeBody
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.tasks.robots import load_robot
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


ANGLES = (LINE, ENCODER, SECOND_TIP)
POSES = st.tuples(st.floats(-0.03, 0.03), st.floats(-0.03, 0.03), st.floats(-0.15, 0.15)).map(np.array)
HOLDS = np.array(((0.2286, 0.02), (-0.2286, 0.0), (0.05, -0.25)))


@given(POSES, st.sampled_from(ANGLES))
def test_the_estimate_is_exact_where_the_map_is(pose: Floats, angle_from: int) -> None:
    q = on_holds(pose, HOLDS)
    tips, speeds, found, twist = np.zeros((3, 2)), np.zeros((3, 2)), np.zeros(3), np.zeros(3)
    count = estimate_body(
        LEGS, (q, np.zeros((3, 2))), (BOTH, HOLDS), (pose[2], 0.0, angle_from), tips, speeds, found, twist
    )
    assert count == 2
    np.testing.assert_allclose(found, pose, atol=1e-12)


@given(POSES, POSES, st.sampled_from(ANGLES))
def test_the_estimated_speed_is_the_derivative_of_the_pose(pose: Floats, rate: Floats, angle_from: int) -> None:
    step = 1e-6
    ahead, behind = on_holds(pose + step * rate, HOLDS), on_holds(pose - step * rate, HOLDS)
    qd = (ahead - behind) / (2 * step)
    tips, speeds, found, twist = np.zeros((3, 2)), np.zeros((3, 2)), np.zeros(3), np.zeros(3)
    estimate_body(
        LEGS, (on_holds(pose, HOLDS), qd), (BOTH, HOLDS), (pose[2], rate[2], angle_from), tips, speeds, found, twist
    )
    np.testing.assert_allclose(twist, rate, atol=1e-7)


def estimated(angle_from: int, pose: Floats, believed: Floats, before: Floats) -> Floats:
    """Where the body is believed to be that truly is at `pose`, the holds off."""
    tips, speeds, found, twist = np.zeros((3, 2)), np.zeros((3, 2)), before.copy(), np.zeros(3)
    q = on_holds(pose, HOLDS)
    estimate_body(LEGS, (q, np.zeros((3, 2))), (BOTH, believed), (pose[2], 0.0, angle_from), tips, speeds, found, twist)
    return found


def test_by_the_second_tips_height_its_hold_along_x_tells_nothing_and_its_height_the_angle() -> None:
    pose = np.array((0.01, -0.02, 0.05))
    aside, above = HOLDS.copy(), HOLDS.copy()
    aside[1, 0] += 0.006
    above[1, 1] += 0.006
    np.testing.assert_allclose(estimated(SECOND_TIP, pose, aside, pose), pose, atol=1e-12)
    assert not np.allclose(estimated(LINE, pose, aside, pose)[:2], pose[:2], atol=1e-3)  # the mean of both
    wide = HOLDS[0, 0] - HOLDS[1, 0]
    turned = estimated(SECOND_TIP, pose, above, pose)[2] - pose[2]
    assert turned == pytest.approx(-0.006 / wide, rel=0.05)


def test_of_the_two_angles_with_the_second_tip_so_high_the_nearer_to_the_one_before_is_taken() -> None:
    pose = np.array((0.0, 0.0, 0.1))
    found = estimated(SECOND_TIP, pose, HOLDS, pose + np.array((0.0, 0.0, math.tau)))
    assert found[2] == pytest.approx(0.1 + math.tau)
    other = estimated(SECOND_TIP, pose, HOLDS, np.array((0.0, 0.0, math.pi)))
    assert abs(other[2] - 0.1) > 2.0  # the mirrored one
    tips = [np.array(((math.cos(a), -math.sin(a)), (math.sin(a), math.cos(a)))) for a in (0.1, other[2])]
    apart = tips[0].T @ (HOLDS[1] - HOLDS[0])
    assert (tips[1] @ apart)[1] == pytest.approx(HOLDS[1, 1] - HOLDS[0, 1])


def test_a_hold_higher_than_the_second_tip_can_be_gives_the_angle_that_comes_nearest() -> None:
    high = HOLDS.copy()
    high[1, 1] += 2.0
    found = estimated(SECOND_TIP, np.zeros(3), high, np.zeros(3))
    line = HOLDS[1] - HOLDS[0]
    assert math.sin(found[2] + math.atan2(line[1], line[0])) == pytest.approx(1.0)


@pytest.mark.parametrize("held", [(1, 1, 0), (1, 0, 1), (1, 1, 1)])
@given(st.tuples(*[st.floats(-50, 50)] * 3).map(np.array))
def test_the_shared_forces_add_up_to_the_wrench(held: tuple[int, ...], wrench: Floats) -> None:
    forces = np.zeros((3, 2))
    distribute_wrench(np.array(held), HOLDS, wrench, forces)
    moment = sum(r[0] * f[1] - r[1] * f[0] for r, f in zip(HOLDS, forces, strict=True))
    np.testing.assert_allclose((*forces.sum(axis=0), moment), wrench, atol=1e-9)
    assert not forces[np.array(held) == 0].any()


def test_two_limbs_share_a_weight_as_the_thesis_says() -> None:
    forces = np.zeros((3, 2))
    distribute_wrench(BOTH, HOLDS, np.array((0.0, 40.0, 0.0)), forces)
    rx1, rx2 = HOLDS[0, 0], HOLDS[1, 0]
    np.testing.assert_allclose(forces[:2], ((0.0, -40 * rx2 / (rx1 - rx2)), (0.0, 40 * rx1 / (rx1 - rx2))), atol=1e-12)


def _command(limit: int, wanted: Floats, *, mapping: int = THESIS) -> tuple[Floats, Floats, Floats]:
    pose = np.zeros(3)
    q = on_holds(pose, HOLDS)
    pulls, forces = np.zeros((3, 2)), np.zeros((3, 2))
    fed = np.array((0.0, 38.0, 0.0))
    drags, cuts = np.zeros((3, 2)), np.zeros((MOST_CUTS, 2))
    least = np.full(3, 0.3)
    asked = wanted, fed, mapping, limit
    command_contact_forces((LEGS, q, pose, HOLDS), BOTH, asked, least, drags, cuts, pulls, forces)
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
