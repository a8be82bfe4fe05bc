"""What a seed makes of a robot in space and its world stays within its widths, is the same each time, and can be stated by texts."""

import math
from typing import Any

import numpy as np
import pytest

from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.sim.spatial_flaws import SpatialFlaws, read_spatial_flaws
from clamber.families.spatial.trials.noise import SPATIAL_NOISE, named_spatial_noise, read_spatial_noise
from clamber.families.spatial.trials.trials import SpatialSetup, SpatialTrial, SpatialTrials
from clamber.sim.plant_rules import PlantError
from clamber.tasks.library import load_task
from clamber.trials.noise import NoiseError


@pytest.fixture(scope="module")
def task() -> SpatialTask:
    loaded = load_task("wall-gripper")
    assert isinstance(loaded, SpatialTask)
    return loaded


def test_what_is_drawn_stays_within_its_widths_and_is_the_same_again(task: SpatialTask) -> None:
    noise = read_spatial_noise(named_spatial_noise("usual"), ["push=10 %", "payload=20 %"])
    made, again = (noise.deviations(task.robot, task.world, 7) for _ in range(2))
    off = np.linalg.norm(made.places - task.world.places, axis=1)
    assert off.mean() > 3e-3 and off.max() <= 5e-3
    assert np.linalg.norm(made.normals, axis=1) == pytest.approx(1.0)
    angles = np.arccos(np.clip(np.sum(made.normals * task.world.normals, axis=1), -1.0, 1.0))
    assert math.radians(1.0) < angles.mean() and angles.max() <= math.radians(5.001)
    for shares, width in ((made.strengths, 0.2), (made.frictions, 0.2), (made.masses, 0.1)):
        assert np.abs(shares - 1.0).max() <= width and np.ptp(shares) > width
    assert 0.0 <= made.payload <= 0.2 * task.robot.chains.total_mass
    weight = task.robot.chains.total_mass * 9.80665
    assert made.pushes and all(np.linalg.norm(push.force) <= 0.1 * weight for push in made.pushes)
    assert np.array_equal(made.places, again.places) and made.pushes == again.pushes
    assert not np.array_equal(made.places, noise.deviations(task.robot, task.world, 8).places)


def test_one_width_changes_nothing_else(task: SpatialTask) -> None:
    usual = named_spatial_noise("usual").deviations(task.robot, task.world, 7)
    wider = read_spatial_noise(named_spatial_noise("usual"), ["friction=30%"]).deviations(task.robot, task.world, 7)
    assert np.array_equal(usual.places, wider.places) and np.array_equal(usual.masses, wider.masses)
    assert wider.frictions - 1.0 == pytest.approx(1.5 * (usual.frictions - 1.0))


def test_settings_of_the_plant_outdo_the_noise() -> None:
    plant = read_spatial_flaws(["backlash=1 deg", "physics_rate=2 kHz"], seed=5)
    made = named_spatial_noise("usual").flaws(plant, 5)
    assert made.backlash == pytest.approx(math.radians(1.0)) and made.physics_rate == 2000.0
    assert made.delay == 5e-3 and made.late == 2 and made.seed == 5
    assert named_spatial_noise("none").flaws(SpatialFlaws(), 5) == SpatialFlaws()


@pytest.mark.parametrize(
    "text", ["backlsh=1deg", "backlash", "backlash=1 N", "delay=2 s", "miss=200 %", "control_rate=700 Hz"]
)
def test_a_setting_that_cannot_be_is_refused_by_name(text: str) -> None:
    with pytest.raises(PlantError, match=text.partition("=")[0][:5]):
        read_spatial_flaws([text])


def test_a_width_that_cannot_be_is_refused_by_name() -> None:
    with pytest.raises(NoiseError, match="hold_place"):
        read_spatial_noise(named_spatial_noise("usual"), ["hold_place=3 deg"])
    with pytest.raises(NoiseError, match="no such key"):
        read_spatial_noise(named_spatial_noise("usual"), ["pegs=3 mm"])
    assert all(kind.shown(kind.width) for kind in SPATIAL_NOISE.values())


def test_trials_are_told_from_others_and_a_failed_one_counts(task: SpatialTask) -> None:
    setup = SpatialSetup(task=task, noise=named_spatial_noise("usual"))
    assert setup.about() != SpatialSetup(task=task, noise=named_spatial_noise("none")).about()
    trials = setup.begun(2)
    trials.ended = [setup.failed(1, "ValueError: x"), setup.failed(2, "ValueError: x")]
    assert trials.done == 0 and trials.interval[0] == 0.0
    assert [(cause.words, cause.n, cause.seeds) for cause in trials.causes()] == [("error", 2, (1, 2))]
    assert trials.to_json()["n"] == 2


def test_causes_are_told_without_their_numbers_the_commonest_first() -> None:
    reasons = (
        "fell: the body is 88 mm from where it is to be",
        "step 3, LF to hold 7: missed: nothing to hold on to",
        "",
        "step 9, RF to hold 2: missed: off",
    )
    setup: Any = None
    trials = SpatialTrials(setup, 4, [ended(seed, reason) for seed, reason in enumerate(reasons)])
    missed, fell = trials.causes()
    assert (missed.words, missed.n, missed.seeds, missed.reason) == ("missed", 2, (1, 3), reasons[1])
    assert (fell.words, fell.seeds, fell.steps) == ("fell", (0,), (5,))


def ended(seed: int, reason: str) -> SpatialTrial:
    return SpatialTrial(
        seed=seed,
        done=not reason,
        reason=reason,
        seconds=1.0,
        actions=5,
        off=0.0,
        lost=None,
        breaks=0,
        replans=0,
        wall_seconds=1.0,
    )
