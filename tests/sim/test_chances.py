"""What is drawn from a seed: play, encoder phase, noise, and what a controller believes."""

import math

import numpy as np
import pytest

from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.runner import MISBELIEVED, believed_chain
from clamber.sim.limb_electronics import Chances
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.mujoco_limb import MujocoLimb
from clamber.sim.plant_rules import PlantError
from clamber.sim.plants import PLANTS, plant_maker

LIMB = bench_limb()
COUNTS = np.array((100.0, 0.0))


def test_joints_start_at_an_end_of_their_play_and_encoders_within_a_count() -> None:
    flaws = LimbFlaws(backlash=math.radians(2.0), encoder_counts=400)
    sides, phases = [], []
    for seed in range(40):
        chances = Chances(flaws.with_changes(seed=seed), 1, 2, COUNTS)
        sides.append(chances.play.copy())
        phases.append(chances.phase.copy())
    ends = np.array(sides) / math.radians(1.0)
    assert set(np.round(ends, 12).ravel()) == {-1.0, 1.0}
    assert np.abs(np.array(phases)[..., 0]).max() <= 0.5 / 100.0
    assert np.ptp(np.array(phases)[..., 0]) > 0.8 / 100.0
    assert not np.array(phases)[..., 1].any()  # a perfect encoder has no phase


def test_noise_has_the_deviation_that_was_asked_for_and_starts_again() -> None:
    chances = Chances(LimbFlaws(seed=5, speed_noise=0.1), 1, 2, COUNTS)

    def draw(ticks: int) -> list[np.ndarray]:
        speeds = []
        for _ in range(ticks):
            states = np.zeros((1, 2, 2))
            chances.disturb(states)
            assert not states[:, 0].any()
            speeds.append(states[0, 1].copy())
        return speeds

    chances.restart()
    first = draw(4000)
    assert np.std(first) == pytest.approx(0.1, rel=0.05)
    chances.restart()
    np.testing.assert_array_equal(draw(4000), first)


def test_a_plant_without_a_seed_starts_in_the_middle_of_its_play_and_a_seeded_one_at_an_end() -> None:
    flaws = LimbFlaws(backlash=math.radians(2.0))
    for seed, off in ((None, 0.0), (1, math.radians(1.0))):
        plant = MujocoLimb(LIMB.chain, flaws.with_changes(seed=seed), gears=LIMB.gears)
        for _ in range(2):  # a second reset draws the same
            plant.reset(LIMB.q0)
            np.testing.assert_allclose(np.abs(plant.truth().states[0, 0] - LIMB.q0), off, atol=1e-12)
            np.testing.assert_allclose(plant.sense().states[0, 0], LIMB.q0, atol=1e-12)
            plant.step()


@pytest.mark.parametrize("name", PLANTS)
def test_a_seeded_encoder_is_off_by_less_than_a_count(name: str) -> None:
    turns = []
    for seed in range(8):
        plant = plant_maker(name)(LIMB.chain, LimbFlaws(encoder_counts=400, seed=seed), gears=LIMB.gears)
        plant.reset(LIMB.q0)
        count = 2 * math.pi / (400 * LIMB.gears)
        error = (plant.sense().states[0, 0] - LIMB.q0) / count
        assert np.abs(error).max() <= 1.0
        turns.append(error)
    assert len({tuple(np.round(error, 9)) for error in turns}) > 1


def test_a_wrong_model_is_wrong_within_its_bound_the_same_for_a_seed_and_knows_its_geometry() -> None:
    flaws = LimbFlaws(model_error=0.1, seed=4)
    wrong = believed_chain(LIMB.chain, flaws)
    for key in MISBELIEVED:
        true = LIMB.chain.joints[key]
        off = np.abs(wrong.joints[key] - true)
        assert (off <= 0.1 * np.abs(true) + 1e-15).all()
    assert (wrong.joints["friction"] != LIMB.chain.joints["friction"]).all()
    np.testing.assert_array_equal(wrong.place(LIMB.q0), LIMB.chain.place(LIMB.q0))
    np.testing.assert_array_equal(wrong.joints, believed_chain(LIMB.chain, flaws).joints)
    rotor = wrong.joints["rotor"]
    np.testing.assert_allclose(wrong.joints["share"], rotor / rotor.max())  # K' is of what is believed
    assert believed_chain(LIMB.chain, LimbFlaws()) is LIMB.chain


def test_noise_and_a_wrong_model_need_a_seed() -> None:
    for key in ("speed_noise", "wrench_noise", "model_error"):
        with pytest.raises(PlantError, match="needs a seed"):
            LimbFlaws(**{key: 0.1})
    with pytest.raises(PlantError, match="seed"):
        LimbFlaws(seed=-1)
