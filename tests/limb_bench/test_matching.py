"""The stiffness of a law at the tip against closed forms, and gains that give two laws the same."""

from typing import Any

import numpy as np
import pytest

from clamber.control.law_settings import LAWS, LawError, LawSettings
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.entries import MATCHES, match_gains, tip_stiffness
from clamber.types import Floats

LIMB = bench_limb()
Q = LIMB.q0
INVERSE = np.linalg.inv(LIMB.chain.jacobian(Q)[:2])
WEIGHT = np.diag(LIMB.chain.joints["share"])
BY_DIRECTION = sorted(set(LAWS) - {"joint-pd", "resolved-rate-plain"})
"""Laws whose stiffness follows kp by direction."""


def turn(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


@pytest.mark.parametrize("angle", [0.0, 0.7])
@pytest.mark.parametrize("law", LAWS)
def test_a_laws_stiffness_is_that_of_its_equation(law: str, angle: float) -> None:
    kp = np.array([150.0, 60.0])
    settings = LawSettings(law=law, kp=tuple(kp), kd=(6.0, 2.0), angle=angle)
    along = turn(angle) @ np.diag(kp) @ turn(angle).T
    joint = {
        "jacobian-transpose": np.linalg.inv(INVERSE).T @ along @ np.linalg.inv(INVERSE),
        "operational-space": LIMB.chain.inertia(Q) @ INVERSE @ along @ np.linalg.inv(INVERSE),
        "resolved-rate": INVERSE @ along @ np.linalg.inv(INVERSE),  # the servo's damping cancels
        "resolved-rate-plain": kp.mean() * np.eye(2),
        "joint-pd": kp.mean() * np.eye(2),
    }.get(law, WEIGHT @ INVERSE @ along @ np.linalg.inv(INVERSE))
    np.testing.assert_allclose(
        tip_stiffness(LIMB.chain, settings, Q), INVERSE.T @ joint @ INVERSE, rtol=1e-5, atol=1e-2
    )


def test_the_jacobian_transpose_has_the_stiffness_that_it_is_given() -> None:
    settings = LawSettings(law="jacobian-transpose", kp=(3000.0, 500.0))
    np.testing.assert_allclose(tip_stiffness(LIMB.chain, settings, Q), np.diag((3000.0, 500.0)), atol=1e-2)


def test_scct_with_even_gains_is_not_equally_stiff_everywhere() -> None:
    # Why "the same stiffness" needs a choice
    stiffness = tip_stiffness(LIMB.chain, LawSettings(law="scct", kp=100.0), Q)
    assert abs(stiffness[0, 1]) > 0.1 * stiffness[1, 1]
    assert stiffness[0, 0] > 1.3 * stiffness[1, 1] or stiffness[1, 1] > 1.3 * stiffness[0, 0]


@pytest.mark.parametrize("options", [{}, {"feed_friction": 1.0, "friction_from": "torque"}, {"feed_gravity": True}])
def test_feed_forwards_are_no_stiffness(options: dict[str, Any]) -> None:
    bare = LawSettings(law="scct", kp=100.0, feed_gravity=False)
    fed = bare.with_changes(**options)
    np.testing.assert_array_equal(tip_stiffness(LIMB.chain, fed, Q), tip_stiffness(LIMB.chain, bare, Q))


def sense_of(stiffness: Floats, how: str) -> Floats:
    """What `how` makes equal."""
    return {
        "yy": stiffness[1:, 1],
        "mean": np.atleast_1d(np.trace(stiffness) / 2.0),
        "diagonal": np.diag(stiffness),
    }[how]


@pytest.mark.parametrize("how", ["yy", "mean", "diagonal"])
@pytest.mark.parametrize("law", BY_DIRECTION)
def test_matched_gains_have_the_stiffness_of_the_reference(law: str, how: Any) -> None:
    reference = LawSettings(law="scct", kp=100.0, kd=10.0)
    matched = match_gains(LIMB.chain, LawSettings(law=law), reference, Q, how)
    ours, theirs = tip_stiffness(LIMB.chain, matched, Q), tip_stiffness(LIMB.chain, reference, Q)
    np.testing.assert_allclose(sense_of(ours, how), sense_of(theirs, how), rtol=1e-6)
    np.testing.assert_allclose(np.divide(matched.kp, matched.kd), 10.0, rtol=1e-12)  # kd goes with kp


@pytest.mark.parametrize("how", ["yy", "mean"])
@pytest.mark.parametrize("law", ["joint-pd", "resolved-rate-plain"])
def test_joint_servos_are_matched_as_a_whole(law: str, how: Any) -> None:
    reference = LawSettings(law="scct", kp=100.0, kd=10.0)
    matched = match_gains(LIMB.chain, LawSettings(law=law), reference, Q, how)
    ours, theirs = tip_stiffness(LIMB.chain, matched, Q), tip_stiffness(LIMB.chain, reference, Q)
    np.testing.assert_allclose(sense_of(ours, how), sense_of(theirs, how), rtol=1e-6)


@pytest.mark.parametrize("settings", [LawSettings(law="joint-pd"), LawSettings(law="resolved-rate-plain")], ids=str)
def test_the_stiffness_of_a_joint_servo_tells_that_it_cannot_be_matched_by_direction(settings: LawSettings) -> None:
    reference = LawSettings(law="scct", kp=100.0, kd=10.0)
    matched = match_gains(LIMB.chain, settings, reference, Q, "diagonal")
    ours, theirs = tip_stiffness(LIMB.chain, matched, Q), tip_stiffness(LIMB.chain, reference, Q)
    assert not np.allclose(np.diag(ours), np.diag(theirs), rtol=0.01)


def test_a_law_without_stiffness_cannot_be_matched() -> None:
    pressing = LawSettings(law="hybrid", forced=("y",))
    with pytest.raises(LawError, match=r"hybrid: kp = .*has no stiffness of its own to match by 'yy'"):
        match_gains(LIMB.chain, pressing, LawSettings(law="scct"), Q, "yy")


def test_diagonal_goes_by_the_axes_of_the_task_frame() -> None:
    reference = LawSettings(law="scct", kp=100.0, kd=10.0)
    matched = match_gains(LIMB.chain, LawSettings(law="jacobian-transpose", angle=0.6), reference, Q, "diagonal")
    ours, theirs = tip_stiffness(LIMB.chain, matched, Q), tip_stiffness(LIMB.chain, reference, Q)
    np.testing.assert_allclose(
        np.diag(turn(0.6).T @ ours @ turn(0.6)), np.diag(turn(0.6).T @ theirs @ turn(0.6)), rtol=1e-6
    )


def test_none_leaves_the_gains_alone_and_every_choice_is_offered() -> None:
    settings = LawSettings(law="jacobian-transpose", kp=1.0)
    assert match_gains(LIMB.chain, settings, LawSettings(law="scct"), Q, "none") is settings
    assert set(MATCHES) == {"yy", "mean", "diagonal", "none"}


def test_the_jacobian_transpose_matched_by_yy_has_another_stiffness_along_x_than_scct() -> None:
    reference = LawSettings(law="scct", kp=100.0)
    matched = match_gains(LIMB.chain, LawSettings(law="jacobian-transpose"), reference, Q, "yy")
    ours, theirs = tip_stiffness(LIMB.chain, matched, Q), tip_stiffness(LIMB.chain, reference, Q)
    assert ours[1, 1] == pytest.approx(theirs[1, 1], rel=1e-6)
    assert abs(ours[0, 0] / theirs[0, 0] - 1.0) > 0.2
