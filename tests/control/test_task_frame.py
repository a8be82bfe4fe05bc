"""Directions: gains along the axes of a task frame, and errors of turning."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_chains import PERIOD, limb, quarter, random_aim, random_chain, random_state, tick, tip_turn
from scipy.spatial.transform import Rotation

from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LAWS, LawSettings

SEEDS = st.integers(0, 10_000)


@pytest.mark.parametrize("law", sorted(set(LAWS) - {"joint-pd"}))
@quarter
@given(seed=SEEDS, angle=st.floats(-3.0, 3.0))
def test_the_task_frame_does_not_matter_to_even_gains(law: str, seed: int, angle: float) -> None:
    chain = random_chain(6, 6)
    q, qd = random_state(chain, seed)
    aim, felt = random_aim(chain, q, seed), np.random.default_rng(seed).normal(size=6)
    settings = LawSettings(law=law, sigma=0.0)
    plain = tick(chain, settings, aim, q, qd, felt)
    for turned in ({"angle": angle}, {"frame": (angle, 0.4, -0.2)}):
        other = tick(chain, settings.with_changes(**turned), aim, q, qd, felt)
        np.testing.assert_allclose(other, plain, rtol=1e-7, atol=1e-7 * np.abs(plain).max())


@pytest.mark.parametrize("law", ["jacobian-transpose", "operational-space", "resolved-rate", "scct", "admittance"])
@quarter
@given(seed=SEEDS)
def test_a_quarter_turn_of_the_task_frame_swaps_the_gains(law: str, seed: int) -> None:
    chain = limb()
    q, qd = random_state(chain, seed)
    aim, felt = random_aim(chain, q, seed), np.random.default_rng(seed).normal(size=6)
    settings = LawSettings(law=law, kp=(300.0, 20.0), kd=(10.0, 3.0), sigma=0.0)
    swapped = settings.with_changes(kp=(20.0, 300.0), kd=(3.0, 10.0), angle=np.pi / 2)
    ours, theirs = tick(chain, settings, aim, q, qd, felt), tick(chain, swapped, aim, q, qd, felt)
    np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)


@quarter
@given(seed=SEEDS)
def test_a_stiff_direction_can_lie_anywhere_in_space(seed: int) -> None:
    chain = random_chain(3, 3, gravity=False)
    q, _ = random_state(chain, seed)
    frame = Rotation.random(rng=np.random.default_rng(seed))
    settings = LawSettings(
        law="jacobian-transpose", kp=(500.0, 0.0, 0.0), frame=tuple(frame.as_rotvec()), feed_gravity=False
    )
    np.testing.assert_allclose(settings.task_frame(), frame.as_matrix(), atol=1e-12)
    aim = still_aim(chain.place(q) + 0.01 * np.array([0.3, -0.7, 0.4]))
    stiff = frame.as_matrix()[:, 0]
    force = 500.0 * stiff * (stiff @ (aim["place"][0] - chain.place(q)))
    torques = tick(chain, settings, aim, q, np.zeros(3))
    np.testing.assert_allclose(torques, chain.jacobian(q)[:3].T @ force, atol=1e-10)


@quarter
@given(seed=SEEDS, size=st.one_of(st.floats(0.0, np.pi - 1e-7), st.sampled_from([0.0, 1e-15, 1e-9, np.pi - 1e-9])))
def test_the_error_of_a_turn_is_its_rotation_vector(seed: int, size: float) -> None:
    chain = random_chain(6, 6)
    q, _ = random_state(chain, seed)
    axis = np.random.default_rng(seed).normal(size=3)
    vector = size * axis / np.linalg.norm(axis)
    aim = still_aim(chain.place(q))
    aim["turn"] = Rotation.from_rotvec(vector).as_matrix() @ tip_turn(chain, q)
    controller = Controller(chain, LawSettings(law="scct"), period=PERIOD)
    controller.command(aim, np.array([[q, np.zeros(6)]]))
    np.testing.assert_allclose(controller.reports["error"][0, 3:], vector, atol=2e-8)
    oracle = Rotation.from_matrix(aim["turn"][0] @ tip_turn(chain, q).T).as_rotvec()
    np.testing.assert_allclose(controller.reports["error"][0, 3:], oracle, atol=2e-8)


def test_half_a_turn_is_an_error_of_half_a_turn() -> None:
    chain = random_chain(6, 6)
    q, _ = random_state(chain, 0)
    aim = still_aim(chain.place(q))
    for axis in np.eye(3):
        aim["turn"] = Rotation.from_rotvec(np.pi * axis).as_matrix() @ tip_turn(chain, q)
        controller = Controller(chain, LawSettings(law="scct"), period=PERIOD)
        controller.command(aim, np.array([[q, np.zeros(6)]]))
        np.testing.assert_allclose(np.abs(controller.reports["error"][0, 3:]), np.pi * axis, atol=1e-7)
