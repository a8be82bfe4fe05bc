"""The simulated wall against closed forms: a spring, a damper, Coulomb friction, at any angle."""

import math

import mujoco
import numpy as np
import pytest

from clamber.limb_bench.bench_limb import bench_limb
from clamber.sim.bench_limb import BenchLimb
from clamber.sim.limb_flaws import LimbFlaws, Wall
from clamber.sim.limb_model import limb_spec, plate_mass
from clamber.sim.mujoco_limb import MujocoLimb
from clamber.sim.plant_rules import PlantError


@pytest.fixture(scope="module")
def leg() -> BenchLimb:
    return bench_limb()


def press(
    leg: BenchLimb, wall: Wall, force: float, along: float | None = None, seconds: float = 2.0
) -> tuple[MujocoLimb, np.ndarray]:
    """Push with J^T on a limb without friction, damped; `along` pulls along the wall, None holds the place there. Returns the tip too."""
    plant = MujocoLimb(leg.chain, LimbFlaws(wall=wall, friction=0.0))
    plant.reset(leg.q0)
    normal = np.array((math.cos(wall.angle), math.sin(wall.angle)))
    tangent = np.array((-normal[1], normal[0]))
    tips = []
    for _ in range(round(seconds / plant.period)):
        q, qd = plant.sense().states[0]
        jacobian = leg.chain.jacobian(q)[:2]
        tip, speed = leg.chain.place(q)[:2], jacobian @ qd
        pull = 3000.0 * tangent @ (np.array(leg.start) - tip) if along is None else along
        plant.actuate((jacobian.T @ (force * normal + pull * tangent - 400.0 * speed))[None])
        plant.step()
        tips.append(tip)
    return plant, np.array(tips)


def wall_at_tip(leg: BenchLimb, **changes: float) -> Wall:
    settings = {"angle": 0.0, "stiffness": 1e4} | changes
    return Wall(x=leg.start[0], y=leg.start[1], **settings)


@pytest.mark.parametrize("stiffness", [1e3, 1e4, 1e5])
@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, -45.0])
def test_the_wall_gives_way_by_force_over_stiffness(stiffness: float, angle: float, leg: BenchLimb) -> None:
    wall = wall_at_tip(leg, angle=math.radians(angle), stiffness=stiffness)
    plant, tips = press(leg, wall, 20.0, seconds=5.0)
    normal = np.array((math.cos(wall.angle), math.sin(wall.angle)))
    depth = (tips[-1] - np.array(leg.start)) @ normal
    assert depth == pytest.approx(20.0 / stiffness, rel=0.01)
    np.testing.assert_allclose(plant.truth().wrenches[0, :2], 20.0 * normal, atol=0.02)


def test_an_untouched_wall_rings_like_a_mass_on_a_spring_and_a_damper(leg: BenchLimb) -> None:
    wall = Wall(x=5.0, y=0.0, angle=0.0, stiffness=2e3, damping=2.0)
    model = limb_spec(leg.chain, LimbFlaws(wall=wall, physics_rate=20_000.0)).compile()
    data = mujoco.MjData(model)
    at = model.joint("wall").qposadr[0]
    data.qpos[at] = 1e-3
    mass = plate_mass(wall, model.opt.timestep)
    rate, decay = math.sqrt(wall.stiffness / mass), wall.damping / (2 * mass)
    swing = math.sqrt(rate**2 - decay**2)
    for _ in range(400):
        mujoco.mj_step(model, data)
        t = data.time
        wanted = 1e-3 * math.exp(-decay * t) * (math.cos(swing * t) + decay / swing * math.sin(swing * t))
        assert data.qpos[at] == pytest.approx(wanted, abs=2e-5)


@pytest.mark.parametrize("stiffness", [1e2, 1e4, 1e6, 1e8])
def test_the_plate_is_heavy_enough_for_its_steps(stiffness: float) -> None:
    wall = Wall(x=0.0, y=0.0, angle=0.0, stiffness=stiffness)
    for step in (1e-4, 5e-4, 2e-3):
        assert math.sqrt(stiffness / plate_mass(wall, step)) * step <= 0.5 + 1e-12


@pytest.mark.parametrize("friction", [0.2, 0.6])
def test_the_tip_slips_just_where_coulomb_friction_ends(friction: float, leg: BenchLimb) -> None:
    wall = wall_at_tip(leg, angle=math.pi / 2, friction=friction)
    limit = friction * 20.0
    _, held = press(leg, wall, 20.0, along=0.9 * limit, seconds=1.0)
    plant, slipping = press(leg, wall, 20.0, along=1.2 * limit, seconds=1.0)
    assert np.ptp(held[100:, 0]) < 2e-4
    assert np.ptp(slipping[100:, 0]) > 5e-4
    wrench = plant.truth().wrenches[0]
    assert abs(wrench[0]) == pytest.approx(friction * wrench[1], rel=0.02)


def test_a_tip_that_does_not_touch_feels_nothing(leg: BenchLimb) -> None:
    wall = Wall(x=leg.start[0] + 0.01, y=0.0, angle=0.0)
    plant = MujocoLimb(leg.chain, LimbFlaws(wall=wall))
    plant.reset(leg.q0)
    plant.actuate(np.zeros((1, 2)))
    for _ in range(20):
        plant.step()
    np.testing.assert_allclose(plant.truth().wrenches, 0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("key", "value"),
    [("stiffness", 0.0), ("stiffness", math.inf), ("damping", -1.0), ("friction", math.nan), ("angle", math.nan)],
)
def test_a_wall_that_cannot_be_is_refused_by_name(key: str, value: float) -> None:
    with pytest.raises(PlantError, match=rf"wall\.{key}"):
        Wall(**({"x": 0.0, "y": 0.0, "angle": 0.0} | {key: value}))


def test_a_joint_that_friction_holds_does_not_creep(leg: BenchLimb) -> None:
    plant = MujocoLimb(leg.chain, LimbFlaws())
    plant.reset(leg.q0)
    torques = 0.9 * leg.chain.joints["friction"][None]
    places = []
    for _ in range(400):
        plant.actuate(torques)
        plant.step()
        places.append(plant.truth().states[0, 0].copy())
    # a wall of 10 N/mm would lose 0.01 N a second
    assert np.abs(places[-1] - places[199]).max() < 4e-6
