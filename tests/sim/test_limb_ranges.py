import mujoco
import numpy as np
import pytest

from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.limb_model import limb_spec
from clamber.sim.mujoco_limb import MujocoLimb
from clamber.units import DEGREE


def test_the_play_of_a_model_is_the_backlash_in_radians() -> None:
    model = limb_spec(bench_limb().chain, LimbFlaws(backlash=2 * DEGREE)).compile()
    plays = [k for k in range(model.njnt) if mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, k).endswith("play")]
    assert len(plays) == 2
    np.testing.assert_allclose(model.jnt_range[plays], [[-DEGREE, DEGREE]] * 2, rtol=1e-12)


def test_a_joint_turns_past_its_limits_only_without_stops() -> None:
    limb = bench_limb()
    upper = float(limb.chain.joints["upper"][0])
    for stops in (False, True):
        plant = MujocoLimb(limb.chain, LimbFlaws(joint_limits=stops))
        plant.reset(limb.q0)
        plant.actuate(np.array([[3.0, 0.0]]))
        for _ in range(1200):
            plant.step()
        angle = plant.truth().states[0, 0, 0]
        if stops:
            assert angle == pytest.approx(upper, abs=0.01)
        else:
            assert angle > upper + 1.0
