"""The torque loop against statics of a spatial chain, and its estimate of friction against the closed form."""

import numpy as np
import pytest

from clamber.compiled import kernel
from clamber.control.chain import Chain, empty_chain
from clamber.control.controller import Controller, MeasurementError, still_aim
from clamber.control.kinematics import CENTRE, FRAME, place_chain
from clamber.control.law_settings import LawError, LawSettings
from clamber.control.torque_loop import read_mount
from clamber.limb_bench.bench_limb import bench_limb

PERIOD = 0.005


@kernel
def read(joints, root, frames, tip, mount, out, wrench):  # type: ignore[no-untyped-def]
    read_mount(joints, root, frames, tip, mount, out, wrench)


def spatial_chain(rng: np.random.Generator, n: int = 4) -> Chain:
    joints, root = empty_chain(n)
    for j in range(n):
        axis = rng.normal(size=3)
        joints["axis"][j] = axis / np.linalg.norm(axis)
        joints["place"][j], joints["centre"][j] = 0.2 * rng.normal(size=3), 0.1 * rng.normal(size=3)
        joints["mass"][j] = rng.uniform(0.1, 2.0)
    joints["sliding"][1] = 1
    root["tip"][0], root["gravity"][0] = 0.2 * rng.normal(size=3), (1.0, -2.0, -9.0)
    return Chain("test", tuple(f"j{j}" for j in range(n)), joints, root)


@pytest.mark.parametrize("seed", range(5))
def test_the_mount_tells_every_gears_torque_and_the_wrench_at_the_tip(seed: int) -> None:
    rng = np.random.default_rng(seed)
    chain = spatial_chain(rng)
    q, wrench = rng.uniform(-1.0, 1.0, chain.n), rng.normal(size=6)
    frames, tip = np.zeros((chain.n, FRAME)), np.zeros(12)
    place_chain(chain.joints, chain.root, q, frames, tip)
    # at rest the mount carries what the tip pushes back, and the weight
    weights = chain.joints["mass"][:, None] * chain.root["gravity"][0]
    centres = frames[:, CENTRE : CENTRE + 3]
    force = -wrench[:3] + weights.sum(axis=0)
    moment = -wrench[3:] - np.cross(tip[:3], wrench[:3]) + np.cross(centres, weights).sum(axis=0)
    torques, felt = np.zeros(chain.n), np.zeros(6)
    read(chain.joints, chain.root, frames, tip, np.concatenate((force, moment)), torques, felt)
    np.testing.assert_allclose(felt, wrench, atol=1e-12)
    np.testing.assert_allclose(torques, chain.jacobian(q).T @ wrench + chain.bias(q, np.zeros(chain.n)), atol=1e-12)


def controller(**changes: float | str) -> tuple[Controller, np.ndarray, np.ndarray]:
    leg = bench_limb()
    settings = {"law": "scct", "kp": 0.0, "kd": 0.0, "torque_sensor": "base", "torque_gain": 20.0} | changes
    return Controller(leg.chain, LawSettings(**settings), period=PERIOD), leg.q0, still_aim(leg.start)


def test_the_estimate_of_friction_settles_as_its_bandwidth_says() -> None:
    law, q, aim = controller()
    rotor = law.chain.joints["rotor"]
    friction = np.array((0.5, -0.3))
    state = np.zeros((1, 2, 2))
    state[0, 0] = q
    for k in range(60):
        torque = law.command(aim, state, mounts=np.zeros((1, 6)))[0].copy()
        # what the motors give is the estimate alone, and the rotors turn by what friction leaves of it
        np.testing.assert_allclose(torque, friction * (1.0 - (1.0 - 20.0 * PERIOD) ** k), atol=1e-12)
        state[0, 1] += PERIOD * (torque - friction) / rotor


def test_the_loop_adds_no_more_than_its_limit() -> None:
    law, q, aim = controller(torque_limit=1.5)
    state = np.zeros((1, 2, 2))
    state[0, 0] = q
    mounts = np.array([[0.0, -100.0, 0.0, 0.0, 0.0, -22.0]])
    for _ in range(300):
        torque = law.command(aim, state, mounts=mounts)[0]
    np.testing.assert_allclose(np.abs(torque), 1.5)


@pytest.mark.parametrize("sensor", ["base", "wrist"])
def test_a_still_limb_whose_links_get_what_the_law_asks_for_is_left_alone(sensor: str) -> None:
    leg = bench_limb()
    settings = LawSettings(law="hybrid", forced=("x",), torque_sensor=sensor)
    law = Controller(leg.chain, settings, period=PERIOD)
    aim = still_aim(leg.start)
    aim["wrench"][0, :2] = (20.0, 0.0)
    state = np.zeros((1, 2, 2))
    state[0, 0] = leg.q0
    tip = np.array((*leg.start, 0.0))
    force = np.array((20.0, 0.0, 0.0))
    wrench, mount = np.concatenate((force, np.zeros(3))), -np.concatenate((force, np.cross(tip, force)))
    for _ in range(50):
        torque = law.command(aim, state, wrench[None], mount[None])[0]
    np.testing.assert_allclose(torque, leg.chain.jacobian(leg.q0)[:2].T @ (20.0, 0.0), atol=1e-9)


def test_a_reading_of_the_mount_that_is_not_finite_is_named() -> None:
    law, q, aim = controller()
    mounts = np.zeros((1, 6))
    mounts[0, 4] = np.nan
    with pytest.raises(MeasurementError, match="wrench on the mount My is nan"):
        law.command(aim, np.stack((q, np.zeros(2)))[None], mounts=mounts)


def test_an_unknown_sensor_is_refused_by_name() -> None:
    with pytest.raises(LawError, match="torque_sensor = elbow"):
        LawSettings(law="hybrid", torque_sensor="elbow")
