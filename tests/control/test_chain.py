"""Chains: K' of the thesis's limbs, what a chain refuses, inverse kinematics."""

import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_chains import libra, limb, planar_chain
from scipy.spatial.transform import Rotation

from clamber.control.chain import Chain, ChainError, empty_chain, rotation
from clamber.families.climber.control.limb_chain import chain_of_limb, closed_branches


@pytest.mark.parametrize(
    ("name", "basis", "shares"),
    [
        ("right", "inertia", (0.4020 / 0.7652, 1.0)),  # Table 3.1; Eq. 3.26 read as the ratio that the text describes
        ("left", "inertia", (0.4020 / 0.7652, 1.0)),
        ("bottom", "inertia", (1.0, 1.0)),
        ("right", "damping", (1.0, 0.5706 / 1.1128)),
        ("left", "damping", (1.0, 0.2697 / 0.7143)),
        ("bottom", "damping", (0.5263 / 0.5564, 1.0)),
        ("right", "back-emf", (574**2 / 792**2, 1.0)),  # Eq. 3.27
        ("left", "back-emf", (574**2 / 792**2, 1.0)),
        ("bottom", "back-emf", (1.0, 1.0)),
    ],
)
def test_k_prime_is_that_of_the_thesis(name: str, basis: Any, shares: tuple[float, float]) -> None:
    chain = chain_of_limb(libra(), name, basis=basis)
    np.testing.assert_allclose(chain.joints["share"], shares, rtol=1e-12)


def test_k_prime_of_leg_1_is_about_0_525() -> None:
    # Inertia goes with the gear ratio squared, so Eq. 3.26 and 3.27 agree
    assert limb("right").joints["share"][0] == pytest.approx(0.5254, abs=1e-4)
    assert limb("right").with_shares("back-emf").joints["share"][0] == pytest.approx(0.5254, abs=2e-4)


def test_k_prime_of_a_joint_without_the_quantity_is_refused() -> None:
    for basis, key in (("inertia", "rotor"), ("damping", "damping"), ("back-emf", "back_emf")):
        chain = limb()
        chain.joints[key][1] = 0.0
        with pytest.raises(ChainError, match=rf"right elbow's share by {basis} = 0\.0: must be more than 0 for K'"):
            chain.with_shares(basis)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("key", "value", "text"),
    [
        ("damping", -0.1, "b.damping = -0.1: must be 0 or more, and finite"),
        ("friction", math.nan, "b.friction = nan: must be 0 or more, and finite"),
        ("rotor", math.inf, "b.rotor = inf: must be 0 or more, and finite"),
        ("mass", -1.0, "b.mass = -1.0: must be 0 or more, and finite"),
        ("limit", 0.0, "b.limit = 0.0: must be more than 0"),
        ("speed", math.nan, "b.speed = nan: must be more than 0"),
        ("share", 0.0, "b.share = 0.0: must be more than 0"),
        ("axis", (0.0, 0.0, 2.0), "b.axis = [0.0, 0.0, 2.0]: must be a unit vector"),
        ("place", (0.0, math.nan, 0.0), "b.place = [0.0, nan, 0.0]: must be finite numbers"),
        (
            "turn",
            np.diag((1.0, 1.0, -1.0)),
            "b.turn = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]: must be a rot",
        ),
        (
            "inertia",
            np.diag((1.0, 1.0, -1.0)),
            "b.inertia = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]: must be s",
        ),
        ("lower", 4.0, "b.lower = 4.0: must be at most upper, 3.14159"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_joint_that_cannot_be_is_refused(key: str, value: Any, text: str) -> None:
    joints, root = empty_chain(3)
    joints[key][1] = value
    with pytest.raises(ChainError, match=f"^arm: {re.escape(text)}"):
        Chain("arm", ("a", "b", "c"), joints, root)


def test_a_chain_has_a_name_for_every_joint_and_a_finite_tip() -> None:
    joints, root = empty_chain(2)
    with pytest.raises(ChainError, match="joint_names = 1: must be one or more, 2"):
        Chain("arm", ("a",), joints, root)
    root["tip"] = math.inf
    with pytest.raises(ChainError, match=r"tip = \[inf, inf, inf\]: must be finite numbers"):
        Chain("arm", ("a", "b"), joints, root)
    with pytest.raises(ChainError, match=r"payload = -1\.0: must be 0 kg or more"):
        planar_chain(2).with_payload(-1.0)


@given(vector=st.tuples(*[st.floats(-3.0, 3.0)] * 3))
def test_a_rotation_vector_turns_as_scipys_does(vector: tuple[float, float, float]) -> None:
    np.testing.assert_allclose(rotation(vector), Rotation.from_rotvec(vector).as_matrix(), atol=1e-13)


@given(theta1=st.floats(-1.3, 2.3), theta2=st.floats(-1.9, 1.9), name=st.sampled_from(["right", "left", "bottom"]))
def test_the_closed_branches_put_the_tip_there_and_hold_the_pose_it_came_from(
    theta1: float, theta2: float, name: str
) -> None:
    robot, chain = libra(), limb(name)
    x, y, _ = chain.place((theta1, theta2))
    branches = closed_branches(robot.limbs[robot.limb_index(name)], x, y)
    for q in branches:
        np.testing.assert_allclose(chain.place(q)[:2], (x, y), atol=1e-12)
    bent = abs(np.linalg.det(chain.jacobian((theta1, theta2))[:2])) > 1e-4  # stretched, the branches meet
    if bent:
        assert len(branches) == 2
        assert min(np.abs(np.subtract(q, (theta1, theta2))).max() for q in branches) < 1e-7


def test_no_branch_reaches_what_is_too_far_or_too_near() -> None:
    robot = libra()
    spec = robot.limbs[robot.limb_index("right")]
    assert closed_branches(spec, 0.32, 0.0) == ()
    assert closed_branches(spec, 1e-9, 0.0) == ()
