"""Every law on limbs other than LIBRA's, closed in MuJoCo: a plane arm of three joints, a spatial arm of six."""

from typing import Any

import numpy as np
import pytest
from random_chains import PERIOD, planar_chain, tip_turn
from scipy.spatial.transform import Rotation

from clamber.control.chain import Chain, empty_chain
from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LAWS, LawSettings
from clamber.execution.closed_loop import close_loop
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.mujoco_limb import MujocoLimb
from clamber.types import Floats


def spatial_arm() -> Chain:
    """Shoulder of three, elbow, wrist of two: links of 0.3 and 0.25 m, geared motors, weight."""
    joints, root = empty_chain(6)
    joints["axis"] = [(0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0)]
    joints["place"][3], joints["place"][4] = (0.3, 0.0, 0.0), (0.25, 0.0, 0.0)
    joints["mass"] = (0.2, 0.2, 0.6, 0.4, 0.1, 0.1)
    joints["centre"][2:] = [(0.15, 0, 0), (0.12, 0, 0), (0, 0, 0), (0.04, 0, 0)]
    joints["inertia"] = 2e-4 * np.eye(3)
    joints["rotor"] = (0.8, 0.8, 0.5, 0.5, 0.2, 0.2)
    joints["damping"] = 0.3
    joints["limit"], joints["speed"] = 60.0, 6.0
    root["tip"], root["gravity"] = (0.08, 0.0, 0.0), (0.0, 0.0, -9.81)
    return Chain("spatial arm", tuple(f"joint {j}" for j in range(6)), joints, root).with_shares("inertia")


CHAINS = {
    "plane arm of 3": (planar_chain(3, limit=60.0), np.array([0.3, 0.7, 0.6])),
    "spatial arm of 6": (spatial_arm(), np.array([0.2, 0.5, 0.3, -1.1, 0.4, 0.6])),
}
STIFF: dict[tuple[str, str], dict[str, Any]] = {
    ("jacobian-transpose", "plane arm of 3"): {"kp": 600.0, "kd": 60.0},
    ("jacobian-transpose", "spatial arm of 6"): {"kp": (600.0,) * 3 + (20.0,) * 3, "kd": (60.0,) * 3 + (3.0,) * 3},
    ("operational-space", "plane arm of 3"): {"kp": 100.0, "kd": 20.0},
    ("operational-space", "spatial arm of 6"): {"kp": 100.0, "kd": 20.0},
}
"""Gains of laws that are not in N m/rad."""


def run(name: str, settings: LawSettings, *, glide: float = 0.0, seconds: float = 4.0) -> tuple[Floats, Floats, Floats]:
    """Go to an aim 3 cm (and, in space, 0.2 rad) away, which jumps there, or glides for `glide` seconds.

    Returns:
        Distance from the last aim by tick [m], angle from it at the first and the last tick [rad], joint speeds at the end.
    """
    chain, q0 = CHAINS[name]
    flaws = LimbFlaws(friction=0.0, physics_rate=1000.0)
    step, vector = np.array([0.02, -0.02, 0.0 if chain.plane else 0.01]), np.array([0.1, -0.15, 0.1])
    aims = np.repeat(still_aim(chain.place(q0))[None], round(seconds / flaws.period), axis=0)
    for k, aim in enumerate(aims):
        part = min(1.0, (k + 1) * flaws.period / glide) if glide else 1.0
        aim["place"] += part * step
        aim["turn"] = Rotation.from_rotvec(part * vector).as_matrix() @ tip_turn(chain, q0)
        if part < 1.0:
            aim["twist"] = np.concatenate((step, vector)) / glide
    plant = MujocoLimb(chain, flaws)
    plant.reset(q0)
    trace = close_loop(plant, Controller(chain, settings, period=PERIOD), aims)
    away = np.linalg.norm(trace.true_places()[:, 0] - aims["place"][-1], axis=1)
    ends = trace.true[[0, -1], 0, 0]
    turned = [Rotation.from_matrix(aims["turn"][-1, 0] @ tip_turn(chain, q).T).magnitude() for q in ends]
    return away, np.array(turned), trace.true[-1, 0, 1]


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("law", sorted(set(LAWS) - {"resolved-rate-plain"}))
def test_every_law_brings_every_limb_to_an_aim_within_reach(law: str, name: str) -> None:
    # J^T is soft along a small singular value of J, which it squares: this way leads past one of 0.013, and takes its time
    seconds = 24.0 if (law, name) == ("jacobian-transpose", "spatial arm of 6") else 4.0
    settings = LawSettings(law=law, posture_kp=0.0, **STIFF.get((law, name), {}))
    away, turned, speed = run(name, settings, seconds=seconds)
    assert away[0] > 0.02
    assert away[-1] < 1e-4
    assert np.abs(speed).max() < 1e-2
    if not CHAINS[name][0].plane:
        assert turned[0] > 0.19
        assert turned[1] < 1e-3


@pytest.mark.parametrize("name", CHAINS)
def test_plain_resolved_rate_comes_near_a_gliding_aim_and_stays_off(name: str) -> None:
    # No error of the tip is fed back: what the Jacobian changes on the way stays as an error, more so after a jump
    settings = LawSettings(law="resolved-rate-plain")
    glided, _, speed = run(name, settings, glide=2.0)
    assert np.abs(speed).max() < 1e-2
    assert glided[-1] < 0.05 * glided[0]
    jumped, _, _ = run(name, settings)
    assert jumped[-1] > max(1e-4, 3.0 * glided[-1])


def test_the_posture_of_a_redundant_arm_settles_beside_its_task() -> None:
    away, _, speed = run("plane arm of 3", LawSettings(law="operational-space", kp=100.0, kd=20.0))
    assert away[-1] < 1e-4
    assert np.abs(speed).max() < 1e-2
