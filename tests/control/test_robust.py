"""Whatever the pose, the aim or the state: torques are finite, within the motors' limits, and follow the pose without a jump."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from random_chains import PERIOD, limb, planar_chain, quarter, random_chain, random_state, tick

from clamber.control.chain import Chain
from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LAWS, LawSettings
from clamber.errors import ClamberError
from clamber.types import Floats

CHAINS = {
    "leg 1": limb(limited=True),
    "leg 1 without limits": limb(),
    "plane arm of 3": planar_chain(3, limit=30.0),
    "spatial 3": random_chain(3, 3),
    "spatial 6": random_chain(6, 6),
}
SEEDS = st.integers(0, 10_000)


def some_law(law: str, **changes: object) -> LawSettings:
    forced = ("x",) if law in ("hybrid", "implicit-force") else ()
    return LawSettings(law=law, forced=forced, force_gain=1.0, feed_friction=1.0, **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("law", LAWS)
@quarter
@given(seed=SEEDS, far=st.sampled_from([0.05, 1.0, 1e3, 1e6]), undamped=st.booleans())
def test_torques_are_finite_wherever_limb_and_aim_are(
    name: str, law: str, seed: int, far: float, undamped: bool
) -> None:
    chain = CHAINS[name]
    rng = np.random.default_rng(seed)
    settings = some_law(law, sigma=0.0) if undamped else some_law(law)
    controller = Controller(chain, settings, period=PERIOD)
    aim = still_aim(far * rng.normal(size=3))
    for _ in range(5):
        q, qd = random_state(chain, rng.integers(1000))
        torques = controller.command(aim, np.array([[q, 3.0 * qd]]), rng.normal(size=(1, 6)) * 10.0)
        assert np.isfinite(torques).all()
        assert (np.abs(torques[0]) <= chain.joints["limit"]).all()


@pytest.mark.parametrize("law", LAWS)
@quarter
@given(
    states=arrays(np.float64, (1, 2, 2), elements=st.floats(-1e300, 1e300)),
    place=arrays(np.float64, (3,), elements=st.floats(-1e300, 1e300)),
)
def test_absurd_numbers_give_finite_torques_or_the_named_error(law: str, states: Floats, place: Floats) -> None:
    controller = Controller(CHAINS["leg 1 without limits"], some_law(law), period=PERIOD)
    for _ in range(3):
        try:
            torques = controller.command(still_aim(place), states)
        except ClamberError:
            return
        assert np.isfinite(torques).all()


SINGULAR = {
    "stretched": (limb(), np.array([0.4, 0.0])),
    "stretched exactly": (limb("bottom"), np.array([0.0, 0.0])),
    "folded": (limb("bottom"), np.array([0.3, np.pi])),
    "arm of 3 stretched": (planar_chain(3), np.zeros(3)),
    "parallel axes, task in space": (
        Chain("flat", ("a", "b", "c"), planar_chain(3).joints, planar_chain(3).root),
        np.array([0.3, 0.4, 0.5]),
    ),
}


@pytest.mark.parametrize("pose", SINGULAR)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("changes", [{}, {"sigma": 0.0}, {"damping": 0.0}], ids=str)
def test_torques_are_finite_at_a_singular_pose(law: str, pose: str, changes: dict[str, float]) -> None:
    chain, q = SINGULAR[pose]
    for place in ((0.2, 0.1, 0.0), (5.0, 0.0, 0.0), tuple(chain.place(q))):
        torques = tick(chain, some_law(law, **changes), still_aim(place), q, np.full(chain.n, 0.3))
        assert np.isfinite(torques).all()


def test_a_singular_pose_is_reported_as_one() -> None:
    chain, q = SINGULAR["stretched exactly"]
    controller = Controller(chain, LawSettings(law="scct"), period=PERIOD)
    controller.command(still_aim((0.2, 0.1)), np.array([[q, np.zeros(2)]]))
    assert controller.reports["sigma"][0] == pytest.approx(0.0, abs=1e-15)
    assert controller.reports["lambda2"][0] == pytest.approx(0.02**2)


@pytest.mark.parametrize("law", sorted(set(LAWS) - {"joint-pd"}))
def test_torques_follow_the_pose_without_a_jump_through_a_singular_one(law: str) -> None:
    # joint-pd is left out: its inverse kinematics takes one branch or the other
    chain = limb("bottom")
    settings = LawSettings(law=law, feed_gravity=False)
    aim = still_aim((0.29, 0.05))

    def jumps(count: int) -> float:
        states = np.empty((count, 2, 2))
        states[:, 0, 0], states[:, 0, 1] = 0.1, np.linspace(-0.2, 0.2, count)
        states[:, 1] = 0.1, -0.2
        path = Controller(chain, settings, period=PERIOD, batch=count).command(aim, states)
        return float(np.abs(np.diff(path, axis=0)).max())

    coarse, fine = jumps(401), jumps(4001)
    assert fine < 0.2 * coarse  # a jump would stay as large, a slope shrinks tenfold


@quarter
@given(seed=SEEDS)
def test_damping_bounds_the_motion_that_a_task_asks_for(seed: int) -> None:
    chain = limb("bottom")  # its K' is the unit matrix
    q, _ = random_state(chain, seed)
    aim = still_aim(chain.place(q) + np.array([0.01, 0.02, 0.0]))
    controller = Controller(chain, LawSettings(law="scct", kp=200.0, feed_gravity=False, sigma=10.0), period=PERIOD)
    torques = controller.command(aim, np.array([[q, np.zeros(2)]]))
    asked = 200.0 * math.hypot(0.01, 0.02)
    # s / (s^2 + lambda^2) is at most 1 / (2 lambda) for every singular value s
    assert np.linalg.norm(torques[0]) <= asked / (2.0 * math.sqrt(controller.reports["lambda2"][0])) * (1.0 + 1e-9)


def test_sigma_is_the_smallest_singular_value_of_the_task_jacobian() -> None:
    for n in range(1, 8):
        chain = random_chain(n, n)
        settings = LawSettings(law="scct", frame=(0.3, -0.2, 0.9))
        rows = list(settings.rows_of(chain))
        controller = Controller(chain, settings, period=PERIOD)
        turned = np.kron(np.eye(2), settings.task_frame())
        for seed in range(5):
            q, qd = random_state(chain, seed)
            controller.command(still_aim((0.1, 0.0, 0.0)), np.array([[q, qd]]))
            wanted = np.linalg.svd((turned.T @ chain.jacobian(q))[rows], compute_uv=False).min()
            assert controller.reports["sigma"][0] == pytest.approx(wanted, abs=1e-8)
