"""What a seed makes of a robot in space and its world stays within its widths, is the same each time, and can be stated by texts."""

import io
import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from clamber.families.spatial.execution.course import Course, grabs
from clamber.families.spatial.pictures.trials_text import print_spatial_trials
from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.sim.spatial_flaws import SpatialFlaws, read_spatial_flaws
from clamber.families.spatial.sim.spatial_plant import SpatialSim
from clamber.families.spatial.trials.law_trials import first_steps
from clamber.families.spatial.trials.noise import SPATIAL_NOISE, SpatialNoise, drawn
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
    noise = SpatialNoise.of("usual", ["push=10 %", "payload=20 %"])
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
    usual = SpatialNoise.of("usual").deviations(task.robot, task.world, 7)
    wider = SpatialNoise.of("usual", ["friction=30%"]).deviations(task.robot, task.world, 7)
    assert np.array_equal(usual.places, wider.places) and np.array_equal(usual.masses, wider.masses)
    assert wider.frictions - 1.0 == pytest.approx(1.5 * (usual.frictions - 1.0))


def test_settings_of_the_plant_outdo_the_noise() -> None:
    plant = read_spatial_flaws(["backlash=1 deg", "physics_rate=2 kHz"], seed=5)
    made = SpatialNoise.of("usual").flaws(plant, 5)
    assert made.backlash == pytest.approx(math.radians(1.0)) and made.physics_rate == 2000.0
    assert made.delay == 5e-3 and made.late == 2 and made.seed == 5
    assert SpatialNoise.of("none").flaws(SpatialFlaws(), 5) == SpatialFlaws()


@pytest.mark.parametrize(
    "text", ["backlsh=1deg", "backlash", "backlash=1 N", "delay=2 s", "miss=200 %", "control_rate=700 Hz"]
)
def test_a_setting_that_cannot_be_is_refused_by_name(text: str) -> None:
    with pytest.raises(PlantError, match=text.partition("=")[0][:5]):
        read_spatial_flaws([text])


def test_a_width_that_cannot_be_is_refused_by_name() -> None:
    with pytest.raises(NoiseError, match="hold_place"):
        SpatialNoise.of("usual", ["hold_place=3 deg"])
    with pytest.raises(NoiseError, match="no such key"):
        SpatialNoise.of("usual", ["pegs=3 mm"])
    assert all(kind.shown(kind.width) for kind in SPATIAL_NOISE.values())


def test_trials_are_told_from_others_and_a_failed_one_counts(task: SpatialTask) -> None:
    setup = SpatialSetup(task=task, noise=SpatialNoise.of("usual"))
    assert setup.about() != SpatialSetup(task=task, noise=SpatialNoise.of("none")).about()
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


def ended(seed: int, reason: str, drawn: dict[str, float] | None = None) -> SpatialTrial:
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
        drawn=drawn or {},
    )


def test_one_number_tells_what_a_seed_drew_for_the_holds_of_a_plan(task: SpatialTask) -> None:
    noise = SpatialNoise.of("usual", ["payload=20 %", "push=10 %"])
    plan = first_steps(task)
    told = drawn(noise, task, plan, 7)
    made, holds = noise.deviations(task.robot, task.world, 7), sorted({hold for _, hold in grabs(task, plan)})
    assert set(holds) >= {action.hold - 1 for action in plan.actions if action.hold} and len(holds) <= 4 + len(
        plan.actions
    )
    assert min(made.strengths[holds]) == pytest.approx(1.0 + told["strength"])
    assert min(made.frictions[holds]) == pytest.approx(1.0 + told["friction"])
    assert 0.0 < told["hold_place"] <= 5e-3 and 0.0 < told["hold_tilt"] <= math.radians(5.001)
    assert abs(told["mass"]) <= 0.1 and abs(told["gear_friction"]) <= 0.2
    assert told["payload"] == pytest.approx(made.payload / task.robot.chains.total_mass)
    assert 0.0 < told["push"] <= 0.1
    assert drawn(noise, task, plan, 7) == told and drawn(noise, task, plan, 8) != told
    assert set(drawn(SpatialNoise.of("none"), task, plan, 7).values()) == {0.0}


def test_the_mass_and_the_biases_that_are_told_are_those_of_the_simulation(task: SpatialTask) -> None:
    noise = SpatialNoise.of("usual")
    told = drawn(noise, task, first_steps(task), 3)
    quiet = replace(noise.flaws(SpatialFlaws(), 3), gyro_noise=0.0, accelerometer_noise=0.0, delay=0.0)
    course = Course.of(task, first_steps(task)).start
    readings = []
    for flaws in (quiet, replace(quiet, gyro_bias=0.0, accelerometer_bias=0.0)):
        plant = SpatialSim(task.robot, task.world, flaws, noise.deviations(task.robot, task.world, 3))
        plant.reset(course.pose, course.joints, course.holds)
        sensed = plant.sense()
        readings.append((sensed.gyro.copy(), sensed.accelerometer.copy(), plant.model.body_mass.sum()))
    (gyro, force, mass), (still_gyro, still_force, _) = readings
    assert np.linalg.norm(gyro - still_gyro) == pytest.approx(told["gyro"])
    assert np.linalg.norm(force - still_force) == pytest.approx(told["accelerometer"])
    believed = SpatialSim(task.robot, task.world).model.body_mass.sum()
    assert mass / believed - 1.0 == pytest.approx(told["mass"], abs=1e-4)


def drew(seed: int) -> dict[str, float]:
    chance = np.random.default_rng([41, seed])
    return {
        key: float(chance.uniform(-0.2, 0.2))
        for key in ("hold_place", "friction", "strength", "mass", "payload", "gyro")
    }


def test_the_deviation_that_decides_is_named_and_no_other(task: SpatialTask) -> None:
    setup = SpatialSetup(task=task, noise=SpatialNoise.of("usual"))
    runs = [ended(seed, "fell: off" if drew(seed)["strength"] < -0.12 else "", drew(seed)) for seed in range(80)]
    trials = SpatialTrials(setup, 80, [*runs, setup.failed(80, "boom")])
    verdicts = {effect.key: effect.verdict for effect in trials.effects()}
    assert verdicts.pop("strength") == "low"
    assert set(verdicts) == {"hold_place", "friction", "mass", "payload", "gyro"} and set(verdicts.values()) == {"none"}
    told = {effect["key"]: effect for effect in trials.to_json()["effects"]}
    assert told["strength"]["verdict"] == "fails more at low values" and told["strength"]["p"] < 0.05
    text = printed(trials)
    assert re.search(r"strength +-(19|20)\.\.(19|20) % ", text) and "strength fails more at low values (p = " in text


def test_where_all_runs_are_done_no_effect_is_told(task: SpatialTask) -> None:
    setup = SpatialSetup(task=task, noise=SpatialNoise.of("usual"))
    trials = SpatialTrials(setup, 20, [ended(seed, "", drew(seed)) for seed in range(20)])
    assert {effect.verdict for effect in trials.effects()} == {"too few"}
    text = printed(trials)
    assert "too few failures to tell what of the noise matters" in text and "success [%] by" not in text


def printed(trials: SpatialTrials) -> str:
    console = Console(width=140, record=True, file=io.StringIO())
    print_spatial_trials(console, trials, range(len(trials.ended)))
    return console.export_text()
