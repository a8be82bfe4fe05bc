"""Limbs with more joints than rows: their posture, beside the task."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_chains import motors_only, planar_chain, quarter, random_chain, random_state, tick, tip_turn

from clamber.control.controller import still_aim
from clamber.control.law_settings import LawSettings

SEEDS = st.integers(0, 10_000)


@pytest.mark.parametrize("law", ["scct", "resolved-rate", "operational-space", "jacobian-transpose"])
@quarter
@given(seed=SEEDS)
def test_the_posture_of_a_redundant_limb_does_not_move_its_tip(law: str, seed: int) -> None:
    # in operational space with any links; elsewhere where K' tells the inertia, as these laws assume
    chain = random_chain(7, 7, gravity=False)
    if law != "operational-space":
        chain = motors_only(chain)
    settings = LawSettings(law=law, weight="inertia", posture_kp=20.0, posture_kd=0.0, sigma=0.0)
    q, _ = random_state(chain, seed)
    still = np.zeros(7)
    aim = still_aim(chain.place(q))
    aim["turn"] = tip_turn(chain, q)
    torques = tick(chain, settings, aim, q, still)
    assert np.abs(torques).max() > 1e-3
    joints = np.linalg.solve(chain.inertia(q), torques)
    np.testing.assert_allclose(chain.jacobian(q) @ joints, 0.0, atol=1e-8 * np.abs(joints).max())


@quarter
@given(seed=SEEDS)
def test_the_posture_goes_to_rest_where_the_task_leaves_room(seed: int) -> None:
    chain = planar_chain(4)
    settings = LawSettings(law="scct", posture_kp=20.0, posture_kd=0.0)
    q, _ = random_state(chain, seed)
    torques = tick(chain, settings, still_aim(chain.place(q)), q, np.zeros(4))
    motion = torques / chain.joints["share"]
    assert motion @ torques > 0.0
    assert (chain.joints["share"] * motion) @ (chain.joints["rest"] - q) > 0.0  # towards rest, in the norm of K'
