"""The linear limit of a sampled law: closed forms, symmetries, and the simulation."""

import math
from dataclasses import replace

import numpy as np
import pytest

from clamber.control.chain import Chain
from clamber.control.law_settings import LAWS, LawSettings
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.scenario import step_scenario
from clamber.limb_bench.stability import (
    LimitError,
    Situation,
    linear_limit,
    loop_matrix,
    peak_to_peak,
    poses,
    run_situations,
    scaled_gains,
    spectral_radius,
)
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.flaw_texts import named_flaws
from clamber.sim.limb_flaws import LimbFlaws


@pytest.fixture(scope="module")
def limb() -> BenchLimb:
    return bench_limb("libra")


@pytest.fixture(scope="module")
def flaws(limb: BenchLimb) -> LimbFlaws:
    return named_flaws("nominal", limb.robot)


def lone_joints(chain: Chain) -> Chain:
    """The chain with links without mass, so that its joints do not feel each other."""
    joints = chain.joints.copy()
    joints["mass"], joints["inertia"] = 0.0, 0.0
    return replace(chain, joints=joints)


def roots_of_one_joint(inertia: float, damping: float, kp: float, kd: float, period: float, delay: int) -> np.ndarray:
    """Poles of a servo on a held double lag with speed by difference: z^(d+1) (z-1)(z-a) + (kp z + kd (z-1)/T)(b_x (z-a) + p b_v)."""
    a = math.exp(-damping * period / inertia)
    p = (1 - a) * inertia / damping
    b_v, b_x = (1 - a) / damping, (period - p) / damping
    plant = np.polymul([1.0, -1.0], [1.0, -a])
    servo = [kp + kd / period, -kd / period]
    pulled = np.polymul(servo, [b_x, p * b_v - a * b_x])
    return np.roots(np.polyadd(np.concatenate((plant, np.zeros(delay + 1))), pulled))


@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize(("kp", "kd"), [(50.0, 5.0), (900.0, 30.0), (3000.0, 20.0)])
def test_the_loop_of_a_joint_servo_has_the_poles_of_its_polynomial(
    limb: BenchLimb, flaws: LimbFlaws, kp: float, kd: float, delay: int
) -> None:
    chain = lone_joints(limb.chain)
    law = LawSettings(law="joint-pd", weight="none", kp=kp, kd=kd)
    found = np.linalg.eigvals(loop_matrix(chain, law, flaws.with_changes(delay=delay), limb.q0))
    for joint in chain.joints:
        for root in roots_of_one_joint(joint["rotor"], joint["damping"], kp, kd, flaws.period, delay):
            if abs(root) > 0.05:  # many poles at 0 are spread by rounding
                assert np.abs(found - root).min() < 1e-5


def test_a_motor_alone_is_stable_to_where_its_polynomial_says(limb: BenchLimb, flaws: LimbFlaws) -> None:
    chain = lone_joints(limb.chain)
    law = LawSettings(law="joint-pd", weight="none", kp=1.0, kd=0.04)
    limit = linear_limit(chain, law, flaws, [limb.q0])

    def largest(factor: float) -> float:
        return max(
            np.abs(roots_of_one_joint(j["rotor"], j["damping"], factor, 0.04 * factor, flaws.period, 1)).max()
            for j in chain.joints
        )

    assert largest(0.999 * limit) < 1.0 < largest(1.003 * limit)


def test_laws_that_are_the_same_in_free_motion_have_the_same_limit(limb: BenchLimb, flaws: LimbFlaws) -> None:
    def limit(**settings: object) -> float:
        law = LawSettings(**({"kp": 100.0, "kd": 4.0} | settings))  # type: ignore[arg-type]
        return linear_limit(limb.chain, law, flaws, poses(limb))

    scct = limit(law="scct")
    assert limit(law="hybrid") == pytest.approx(scct, rel=1e-3)
    assert limit(law="implicit-force") == pytest.approx(scct, rel=1e-3)
    assert limit(law="implicit-admittance", derivative=0.0) == pytest.approx(scct, rel=1e-3)
    assert limit(law="resolved-rate", weight="inertia") == pytest.approx(scct, rel=1e-3)
    assert limit(law="joint-pd") == pytest.approx(limit(law="resolved-rate"), rel=1e-3)


def test_a_limb_of_twice_the_inertia_and_damping_takes_twice_the_gains(limb: BenchLimb, flaws: LimbFlaws) -> None:
    joints = limb.chain.joints.copy()
    for key in ("rotor", "damping", "mass", "inertia"):
        joints[key] *= 2.0
    heavy = replace(limb.chain, joints=joints)
    law = LawSettings(law="jacobian-transpose", kp=1000.0, kd=50.0)
    once, twice = (linear_limit(chain, law, flaws, poses(limb)) for chain in (limb.chain, heavy))
    assert twice == pytest.approx(2.0 * once, rel=2e-3)


@pytest.mark.parametrize("law", LAWS)
def test_more_delay_never_lets_a_law_be_stiffer(limb: BenchLimb, flaws: LimbFlaws, law: str) -> None:
    settings = LawSettings(law=law, kp=100.0, kd=4.0)
    limits = [linear_limit(limb.chain, settings, flaws.with_changes(delay=d), [limb.q0]) for d in (0, 1, 2, 4)]
    assert limits == sorted(limits, reverse=True)
    assert limits[-1] < 0.7 * limits[0]


def test_a_spring_that_pushes_away_has_no_limit(limb: BenchLimb, flaws: LimbFlaws) -> None:
    hanging = limb.chain.with_gravity((-9.81, 0.0, 0.0))  # towards the port: the weight tips the stretched limb over
    law = LawSettings(law="jacobian-transpose", kp=0.0, kd=0.0, feed_gravity=False)
    with pytest.raises(LimitError, match=r"jacobian-transpose: is unstable at rest however small its gains are"):
        linear_limit(hanging, law, flaws, [np.array((0.0, 0.3))])


def test_scaling_gains_scales_the_joint_servo_too() -> None:
    law = scaled_gains(LawSettings(law="joint-pd", kp=(1.0, 2.0), kd=3.0, joint_kp=4.0), 2.0)
    assert (law.kp, law.kd, law.joint_kp, law.joint_kd) == ((2.0, 4.0), 6.0, 8.0, None)


@pytest.mark.parametrize("law", ["scct", "jacobian-transpose", "operational-space", "joint-pd", "implicit-admittance"])
@pytest.mark.parametrize("damping_time", [0.02, 0.06])
def test_the_simulation_without_play_and_friction_turns_unstable_at_the_linear_limit(
    limb: BenchLimb, flaws: LimbFlaws, law: str, damping_time: float
) -> None:
    # at 2 kHz the integrator's own lead of half a step lifts the limit by 3 to 6 %
    smooth = flaws.with_changes(
        backlash=0.0, friction=0.0, encoder_counts=10**7, motor_limits=False, physics_rate=16_000.0
    )
    unit = LawSettings(law=law, kp=1.0, kd=damping_time)
    step = step_scenario(limb, flaws.control_rate, dy=-1e-4, seconds=7.0)
    limit = linear_limit(limb.chain, unit, smooth, [limb.q0])
    assert spectral_radius(limb.chain, scaled_gains(unit, limit), smooth, limb.q0) == pytest.approx(1.0, abs=1e-3)
    swings = []
    for factor in (0.97, 1.04):
        ((_, trace),) = run_situations(
            limb, scaled_gains(unit, factor * limit), smooth, [Situation("step", limb.q0, step.aims)]
        )
        swings.append(float(peak_to_peak(trace, since=5.0)[0]))
    assert 10.0 * swings[0] < 1e-5 < swings[1]
