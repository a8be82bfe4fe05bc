"""Open loop: transforms beside the statics and dynamics of the limb, and the measures of a path."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from clamber.control.chain import Chain
from clamber.errors import UnknownNameError
from clamber.limb_bench.bench_limb import bench_limb
from clamber.limb_bench.open_loop import TRANSFORMS, OpenLoopRun, first_turn, run_open_loop, scaled_torques
from clamber.limb_bench.scenario import ScenarioError
from clamber.sim.limb_flaws import LimbFlaws

LIMB = bench_limb()
SMOOTH = LimbFlaws(friction=0.0, damping=0.0)
angles = st.floats(-math.pi, math.pi)


def direction(angle: float) -> np.ndarray:
    return np.array((math.cos(angle), math.sin(angle)))


@pytest.mark.parametrize("transform", TRANSFORMS)
@settings(max_examples=20, deadline=None)
@given(angle=angles, force=st.floats(0.1, 100.0))
def test_torques_balance_the_force_along_the_wanted_direction(transform: str, angle: float, force: float) -> None:
    wanted = direction(angle)
    torques = scaled_torques(LIMB.chain, LIMB.q0, transform, wanted, force)
    balanced = np.linalg.solve(LIMB.chain.jacobian(LIMB.q0)[:2].T, torques)
    assert balanced @ wanted == pytest.approx(force)
    if transform == "jacobian-transpose":
        np.testing.assert_allclose(balanced, force * wanted, rtol=1e-9, atol=1e-9 * force)


@settings(max_examples=20, deadline=None)
@given(angle=angles)
def test_the_full_inertia_accelerates_the_tip_straight(angle: float) -> None:
    wanted = direction(angle)
    torques = scaled_torques(LIMB.chain, LIMB.q0, "operational-space", wanted, 10.0)
    assert first_turn(LIMB.chain, LIMB.q0, torques, wanted) == pytest.approx(0.0, abs=1e-10)


@pytest.mark.parametrize("transform", TRANSFORMS)
@pytest.mark.parametrize("angle", [-1.571, 0.3, 2.0])
def test_the_first_motion_in_mujoco_is_that_of_the_dynamics(transform: str, angle: float) -> None:
    run = run_open_loop(LIMB, transform, SMOOTH, direction=angle, seconds=0.3)
    told = first_turn(LIMB.chain, LIMB.q0, run.torques, run.wanted)
    turned = run.turned(1e-5)
    assert turned == pytest.approx(told, abs=math.radians(0.05))


def test_the_simple_model_starts_scct_exactly_straight() -> None:
    run = run_open_loop(LIMB, "scct", SMOOTH, direction=0.7, seconds=0.3, plant="ode")
    assert run.turned(1e-5) == pytest.approx(0.0, abs=1e-4)


def test_torques_that_follow_the_pose_start_as_steady_ones_do_and_stray_less() -> None:
    steady = run_open_loop(LIMB, "scct", SMOOTH, seconds=0.5)
    renewed = run_open_loop(LIMB, "scct", SMOOTH, seconds=0.5, renewed=True)
    np.testing.assert_allclose(renewed.places[1], steady.places[1], atol=1e-12)
    far, near = steady.stray(0.05), renewed.stray(0.05)
    assert far is not None and near is not None
    assert abs(near) < abs(far)


def test_friction_that_is_stronger_than_the_torques_holds_the_limb() -> None:
    run = run_open_loop(LIMB, "scct", LimbFlaws(), force=2.0, plant="ode")
    assert run.moved == 0.0
    assert run.turned() is None
    assert run.stray(0.001) is None


def test_a_path_to_the_left_of_the_wanted_direction_turns_anticlockwise() -> None:
    way = np.linspace(0.0, 0.01, 11)
    places = np.stack((0.2 + way * math.sin(0.1), -way * math.cos(0.1)), axis=1)
    run = OpenLoopRun("scct", 1.0, np.array((0.0, -1.0)), np.zeros(2), way, places)
    assert run.turned(0.0015) == pytest.approx(0.1)  # seen along -y, +x lies to the left
    assert run.stray(0.005) == pytest.approx(0.005 * math.tan(0.1))
    assert run.moved == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("key", "changes"),
    [
        ("force", {"force": 0.0}),
        ("force", {"force": math.nan}),
        ("seconds", {"seconds": 0.0}),
        ("direction", {"direction": math.inf}),
    ],
)
def test_bad_input_is_named(key: str, changes: dict[str, float]) -> None:
    with pytest.raises(ScenarioError, match=f"open-loop: {key} = "):
        run_open_loop(LIMB, "scct", SMOOTH, **changes)  # type: ignore[arg-type]


def test_an_unknown_transform_is_named() -> None:
    chain: Chain = LIMB.chain
    with pytest.raises(UnknownNameError, match="transform"):
        scaled_torques(chain, LIMB.q0, "scctt", direction(0.0), 1.0)
