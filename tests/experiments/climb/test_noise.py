"""What a seed draws from a noise, and that each deviation does to the plant what it says."""

import mujoco
import numpy as np
import pytest

from clamber.families.climber.execution.climber import Climber
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.trials.noise import (
    NO_NOISE,
    NOISE,
    Noise,
    assumed_backlash,
    check_noise,
    draw,
    draw_for,
    drawn_flaws,
    drawn_hook,
    drawn_robot,
    encoder_offsets,
)
from clamber.families.climber.world.library import load_board
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot
from clamber.trials.noise import NoiseError
from clamber.units import DEGREE, GRAVITY

FLAWS = LimbFlaws(backlash=2.0 * DEGREE, physics_rate=1000.0)
BOARD = load_board("ladder")
HOLDS = len(BOARD.holds)
START = np.array((0.2286, 0.1374, 0.0))
ON = {"right": 4, "left": 3, "bottom": 2}


def libra() -> LimbedRobot:
    robot = load_robot("libra")
    assert isinstance(robot, LimbedRobot)
    return robot


def climbable(name: str) -> LimbedTask:
    task = load_task(name)
    assert isinstance(task, LimbedTask)
    return task


def test_each_key_draws_from_its_own_stream() -> None:
    uneven = ["joint_friction=10%", "terrain=20mm", "tilt=2deg", "missing=30%"]
    usual, task = Noise.of("usual", uneven), climbable("ladder")
    all_drawn = draw_for(task, usual, 7)
    for off in NOISE:
        nothing = f"{off}=0{'%' if NOISE[off].dimension == 'ratio' else NOISE[off].unit}"
        without = draw_for(task, usual.changed([nothing]), 7)
        for key in NOISE:
            name = "pegs" if key == "peg_error" else key
            kept, left = np.asarray(getattr(all_drawn, name)), np.asarray(getattr(without, name))
            np.testing.assert_array_equal(left, np.zeros_like(kept) if key == off else kept)
            assert np.any(kept != 0.0)


def test_draws_fill_their_widths_evenly_and_scale_with_them() -> None:
    usual, robot = Noise.of("usual"), libra()
    shares = np.array([draw(usual, robot, HOLDS, seed).friction for seed in range(600)]) / usual.widths["friction"]
    assert np.abs(shares).max() <= 1.0
    quarters = np.histogram(shares, bins=4, range=(-1.0, 1.0))[0]
    assert np.abs(quarters - 150).max() < 4 * (600 * 0.25 * 0.75) ** 0.5  # four standard deviations
    half = usual.changed(["friction=15%"])
    assert draw(half, robot, HOLDS, 3).friction == pytest.approx(draw(usual, robot, HOLDS, 3).friction / 2)
    pegs = draw(usual, robot, HOLDS, 3).pegs
    assert 0.004 < np.abs(pegs).max() <= 0.00635


def test_of_pegs_the_largest_distance_of_those_that_count_is_told() -> None:
    drawn = draw(Noise.of("usual"), libra(), HOLDS, 3)
    far = np.hypot(*drawn.pegs.T)
    assert drawn.to_json()["peg_error"] == far.max()
    assert drawn.to_json(np.array([1, 6, 8], np.int32))["peg_error"] == max(far[1], far[6], far[8])


@pytest.mark.parametrize("seed", range(4))
def test_a_robot_is_put_on_its_holds_where_they_truly_are_and_stays_on_them(seed: int) -> None:
    drawn = draw(Noise.of("usual"), libra(), HOLDS, seed)
    pegs = BOARD.positions() + drawn.pegs
    climber = Climber(libra(), BOARD, ClimberPlant(libra(), BOARD, FLAWS, pegs=pegs), map_error=0.00635)
    climber.start(START, ON, idle="bottom", elbows={})
    numbers = [hold.number for hold in BOARD.holds]
    on = np.array([pegs[numbers.index(ON[limb.name])] for limb in libra().limbs])
    np.testing.assert_allclose(climber.plant.truth().tips, on, atol=1e-9)
    before = {number: place.copy() for number, place in climber.holds.items()}
    climber.wait(0.5)
    climber.learn_start()
    np.testing.assert_allclose(climber.plant.truth().tips, on, atol=0.002)  # the slot's play
    span, true = climber.holds[4] - climber.holds[3], on[0] - on[1]
    assert np.abs(span - true).max() < max(0.003, 0.6 * np.abs(before[4] - before[3] - true).max())


def test_no_noise_leaves_the_nominal_plant() -> None:
    robot, nothing = libra(), draw(NO_NOISE, libra(), HOLDS, 5)
    assert drawn_robot(robot, nothing) == robot
    assert drawn_flaws(FLAWS, nothing) == FLAWS
    assert assumed_backlash(robot, nothing) == robot.motor.backlash
    assert not encoder_offsets(nothing).any()
    assert not any(nothing.to_json().values())


def test_a_payload_raises_the_weight_on_the_pegs_by_that_much() -> None:
    robot, noise = libra(), Noise.of("none", ["payload=10%"])
    forces = {}
    for seed in (0, 1):
        drawn = draw(noise, robot, HOLDS, seed)
        plant = ClimberPlant(drawn_robot(robot, drawn), BOARD, FLAWS)
        assert plant.model.body_mass.sum() * GRAVITY == pytest.approx(robot.weight * (1.0 + drawn.payload))
        climber = Climber(robot, BOARD, plant)
        climber.start(START, ON, idle="bottom", elbows={"right": -1, "left": 1})
        climber.wait(2.0)
        felt = []
        for _ in range(100):
            climber.tick()
            felt.append(upward_on_robot(plant))
        forces[drawn.payload] = float(np.mean(felt))
    assert len(forces) == 2
    for payload, force in forces.items():
        assert force == pytest.approx(robot.weight * (1.0 + payload), rel=5e-3)


def upward_on_robot(plant: ClimberPlant) -> float:
    """Sum of what pegs do to hooks, upwards [N]."""
    total, wrench = 0.0, np.zeros(6)
    for k in range(plant._data.ncon):
        contact = plant._data.contact[k]
        mujoco.mj_contactForce(plant.model, plant._data, k, wrench)
        force = contact.frame.reshape(3, 3).T @ wrench[:3]  # on the second geom
        first_is_peg = plant.model.geom(contact.geom1).name.startswith("peg")
        total += float(force[1]) * (1.0 if first_is_peg else -1.0)
    return total


def test_friction_of_joints_and_hooks_is_scaled() -> None:
    robot = libra()
    noise = Noise.of("none", ["friction=30%", "joint_friction=20%", "hook_friction=25%"])
    drawn = draw(noise, robot, HOLDS, 4)
    nominal, plant = ClimberPlant(robot, BOARD, FLAWS), ClimberPlant(drawn_robot(robot, drawn), BOARD, FLAWS)
    for i, limb in enumerate(robot.limbs):
        for j, joint in enumerate(("shoulder", "elbow")):
            at = plant.model.joint(f"{limb.name} {joint}").dofadr[0]
            ratio = plant.model.dof_frictionloss[at] / nominal.model.dof_frictionloss[at]
            assert ratio == pytest.approx((1.0 + drawn.friction) * (1.0 + drawn.joint_friction[i, j]))
    hooks = plant.model.geom_contype == 1
    np.testing.assert_allclose(
        plant.model.geom_friction[hooks, 0], (1.0 + drawn.hook_friction) * nominal.model.geom_friction[hooks, 0]
    )


def test_backlash_and_slots_are_as_wide_as_drawn() -> None:
    robot, noise = libra(), Noise.of("none", ["backlash=0.5deg", "assumed_backlash=0.5deg", "hook_play=0.5mm"])
    drawn = draw(noise, robot, HOLDS, 2)
    plant = ClimberPlant(robot, BOARD, drawn_flaws(FLAWS, drawn), shape=drawn_hook(drawn))
    low, high = plant.model.joint("left elbow play").range
    assert high - low == pytest.approx(2.0 * DEGREE + drawn.backlash)
    assert assumed_backlash(robot, drawn) == pytest.approx(2.0 * DEGREE + drawn.assumed_backlash)
    assert drawn.backlash != drawn.assumed_backlash
    nominal = ClimberPlant(robot, BOARD, FLAWS)
    assert slot(plant) - slot(nominal) == pytest.approx(drawn.hook_play)


def slot(plant: ClimberPlant) -> float:
    """Distance of the walls of the first hook: its parallel strokes of equal length along the grab direction [m]."""
    geoms = np.flatnonzero(plant.model.geom_contype == 1)[:5]  # bottom, then wall and lip on either side
    return float(np.linalg.norm(plant.model.geom_pos[geoms[1]] - plant.model.geom_pos[geoms[3]]))


def test_encoders_read_too_much_by_their_offsets() -> None:
    robot = libra()
    drawn = draw(Noise.of("none", ["body_angle=1deg", "joint_angle=0.3deg"]), robot, HOLDS, 6)
    plant = ClimberPlant(robot, BOARD, LimbFlaws(physics_rate=1000.0), offsets=encoder_offsets(drawn))
    q = np.array([[0.3, -0.4], [-0.2, 0.5], [0.1, -0.1]])
    plant.reset(np.array((0.2, 0.3, 0.05)), q)
    sensed = plant.sense()
    np.testing.assert_allclose(sensed.q - q, drawn.joint_angle, atol=1e-12)
    assert sensed.angle - 0.05 == pytest.approx(drawn.body_angle)
    np.testing.assert_allclose(plant.truth().q, q, atol=1e-12)
    np.testing.assert_array_equal(sensed.qd, 0.0)


def test_a_noise_comes_back_from_plain_data() -> None:
    noise = Noise.of("usual", ["friction = 12.5 %", "peg_error=0.25in"])
    assert Noise.from_json(noise.to_json()) == noise
    assert noise.widths["peg_error"] == pytest.approx(0.00635)
    assert "friction 12.5 %" in noise.words() and "6.35 mm" in noise.words()
    assert noise.changed(["none"]) == NO_NOISE
    assert Noise.of("none", ["usual", "payload=0%"]).widths["payload"] == 0.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("frction=30%", "did you mean 'friction'|friction"),
        ("friction", "needs a width, as in friction=30 %"),
        ("friction=30mm", "friction = 30mm: .*unit"),
        ("friction=-3%", "must be 0 % or more"),
        ("payload=100%", "less than 100 %"),
        ("peg_error=3", "lacks its unit"),
    ],
)
def test_a_wrong_width_is_told(text: str, message: str) -> None:
    with pytest.raises(NoiseError, match=message):
        Noise.of("none", [text])


@pytest.mark.parametrize(
    "text", ["backlash=2.1deg", "assumed_backlash=3deg", "hook_play=1.1mm", "payload=70%"]
)  # the links alone weigh a third
def test_what_there_is_not_cannot_be_taken_away(text: str) -> None:
    with pytest.raises(NoiseError, match="all that there is"):
        check_noise(Noise.of("none", [text]), libra(), FLAWS)
