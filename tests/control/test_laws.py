"""The laws against their own equations, and against each other where one is a case of another."""

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from random_chains import (
    PERIOD,
    libra,
    limb,
    planar_chain,
    quarter,
    random_aim,
    random_chain,
    random_state,
    tick,
    tip_turn,
)
from scipy.spatial.transform import Rotation

from clamber.control.chain import Chain
from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import AXIS_NAMES, LAWS, LawSettings
from clamber.families.climber.control.limb_chain import closed_branches
from clamber.terminal.catalogue import LAW_TITLES
from clamber.types import Floats

CHAINS = {
    "leg 1": limb(),
    "plane arm of 3": planar_chain(3),
    "spatial 3": random_chain(3, 3),
    "spatial 6": random_chain(6, 6),
}
SEEDS = st.integers(0, 10_000)
SQUARE = ("leg 1", "spatial 3", "spatial 6")
BARE: dict[str, Any] = {"feed_gravity": False, "sigma": 0.0, "posture_kp": 0.0, "posture_kd": 0.0}


def rows_of(chain: Chain, settings: LawSettings, q: Floats) -> tuple[Floats, list[int]]:
    """Task Jacobian by the book: rows of the twist in the task frame."""
    frame = np.kron(np.eye(2), settings.task_frame())
    rows = [AXIS_NAMES.index(name) for name in settings.axes] or list(settings.rows_of(chain))
    return (frame.T @ chain.jacobian(q))[rows], rows


def spring(chain: Chain, settings: LawSettings, aim: np.ndarray, q: Floats, qd: Floats) -> tuple[Floats, Floats]:
    """Task Jacobian and K_p e + K_d de, by the book."""
    task, rows = rows_of(chain, settings, q)
    frame = np.kron(np.eye(2), settings.task_frame())
    turn = Rotation.from_matrix(aim["turn"][0] @ tip_turn(chain, q).T).as_rotvec()
    error = (frame.T @ np.concatenate((aim["place"][0] - chain.place(q), turn)))[rows]
    rate = (frame.T @ aim["twist"][0])[rows] * settings.feed_velocity - task @ qd
    return task, np.multiply(settings.kp, error) + np.multiply(settings.kd, rate)


def shares(chain: Chain) -> Floats:
    out: Floats = chain.joints["share"]
    return out


@pytest.mark.parametrize("name", CHAINS)
@quarter
@given(seed=SEEDS, feed=st.booleans(), turned=st.booleans())
def test_the_jacobian_transpose_is_its_equation(name: str, seed: int, feed: bool, turned: bool) -> None:
    chain = CHAINS[name]
    (q, qd), settings = random_state(chain, seed), LawSettings(law="jacobian-transpose", feed_velocity=feed, **BARE)
    if turned:
        settings = settings.with_changes(angle=0.4, frame=(0.0, 0.0, 0.3) if chain.plane else (0.3, -0.8, 0.5))
    aim = random_aim(chain, q, seed)
    task, pull = spring(chain, settings, aim, q, qd)
    np.testing.assert_allclose(tick(chain, settings, aim, q, qd), task.T @ pull, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("name", SQUARE)
@quarter
@given(seed=SEEDS, feed=st.booleans(), turned=st.booleans())
def test_scct_is_its_equation(name: str, seed: int, feed: bool, turned: bool) -> None:
    chain = CHAINS[name]
    (q, qd), settings = random_state(chain, seed), LawSettings(law="scct", feed_velocity=feed, **BARE)
    if turned:
        settings = settings.with_changes(angle=0.4, frame=(0.0, 0.0, 0.3) if chain.plane else (0.3, -0.8, 0.5))
    aim = random_aim(chain, q, seed)
    task, pull = spring(chain, settings, aim, q, qd)
    wanted = shares(chain) * np.linalg.solve(task, pull)
    np.testing.assert_allclose(tick(chain, settings, aim, q, qd), wanted, rtol=1e-9, atol=1e-9)


@quarter
@given(seed=SEEDS)
def test_scct_of_a_redundant_limb_takes_the_weighted_pseudoinverse(seed: int) -> None:
    chain = CHAINS["plane arm of 3"]
    q, qd = random_state(chain, seed)
    settings = LawSettings(law="scct", **BARE)
    aim = random_aim(chain, q, seed)
    task, pull = spring(chain, settings, aim, q, qd)
    root = np.sqrt(shares(chain))  # least |W^1/2 motion|
    wanted = shares(chain) * (np.linalg.pinv(task / root) @ pull / root)
    np.testing.assert_allclose(tick(chain, settings, aim, q, qd), wanted, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("name", CHAINS)
@quarter
@given(seed=SEEDS)
def test_scct_with_even_gains_is_inertia_weighted_resolved_rate(name: str, seed: int) -> None:
    chain = CHAINS[name]
    q, qd = random_state(chain, seed)
    aim = random_aim(chain, q, seed)
    settings = LawSettings(law="scct", kp=200.0, kd=10.0, posture_kp=0.0, posture_kd=0.0)
    task, _ = rows_of(chain, settings, q)
    assume(np.linalg.svd(task, compute_uv=False).min() > settings.sigma)  # nearer, only one of the two damps task speed
    rate = settings.with_changes(law="resolved-rate", weight="inertia")
    ours, theirs = tick(chain, settings, aim, q, qd), tick(chain, rate, aim, q, qd)
    if chain.n > len(task):  # they differ by what moves no row, which only resolved rate damps
        ours, theirs = task @ (ours / shares(chain)), task @ (theirs / shares(chain))
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12 * np.abs(ours).max())


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize(
    ("law", "changes"), [("implicit-admittance", {"derivative": 0.0}), ("hybrid", {}), ("implicit-force", {})]
)
@quarter
@given(seed=SEEDS)
def test_laws_without_their_own_term_are_scct(name: str, law: str, changes: dict[str, float], seed: int) -> None:
    chain = CHAINS[name]
    q, qd = random_state(chain, seed)
    aim = random_aim(chain, q, seed)
    settings = LawSettings(law="scct", kp=120.0, kd=7.0)
    other = tick(chain, settings.with_changes(law=law, **changes), aim, q, qd)
    np.testing.assert_array_equal(other, tick(chain, settings, aim, q, qd))


@quarter
@given(seed=SEEDS)
def test_an_admittance_that_feels_nothing_is_resolved_rate(seed: int) -> None:
    chain = CHAINS["leg 1"]
    q, qd = random_state(chain, seed)
    aim = random_aim(chain, q, seed)
    ours = tick(chain, LawSettings(law="admittance"), aim, q, qd)
    theirs = tick(chain, LawSettings(law="resolved-rate", weight="inertia"), aim, q, qd)
    np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize("name", CHAINS)
@quarter
@given(seed=SEEDS)
def test_the_jacobian_transpose_is_the_slope_of_the_springs_energy(name: str, seed: int) -> None:
    # Turns have even gains: the square of a rotation vector is a potential, an uneven form of it has another slope
    chain = CHAINS[name]
    q, _ = random_state(chain, seed)
    kp = (300.0, 80.0, 150.0, 5.0, 5.0, 5.0)[: 2 if chain.plane else chain.n]
    settings = LawSettings(law="jacobian-transpose", kp=kp, angle=0.3, posture_kp=0.0, feed_gravity=False)
    aim = still_aim(random_aim(chain, q, seed)["place"][0])
    aim["turn"] = Rotation.from_rotvec([0.3, 0.2, -0.5]).as_matrix() @ tip_turn(chain, q)

    def energy(angles: Floats) -> float:
        _, force = spring(chain, settings.with_changes(kp=tuple(np.sqrt(kp))), aim, angles, np.zeros(chain.n))
        return 0.5 * float(force @ force)

    step = 1e-6
    slope = [(energy(q + nudge) - energy(q - nudge)) / (2 * step) for nudge in step * np.eye(chain.n)]
    torques = tick(chain, settings, aim, q, np.zeros(chain.n))
    np.testing.assert_allclose(torques, np.negative(slope), atol=1e-6, rtol=1e-6)


@pytest.mark.parametrize("name", (*CHAINS, "spatial 7"))
@quarter
@given(seed=SEEDS, feed=st.booleans())
def test_operational_space_gives_the_tip_the_acceleration_that_it_commands(name: str, seed: int, feed: bool) -> None:
    chain = random_chain(7, 7) if name == "spatial 7" else CHAINS[name]
    q, qd = random_state(chain, seed)
    settings = LawSettings(law="operational-space", kp=100.0, kd=20.0, feed_acceleration=feed, sigma=0.0)
    aim = random_aim(chain, q, seed)
    task, wanted = spring(chain, settings, aim, q, qd)
    rows = list(settings.rows_of(chain))
    if feed:
        wanted = wanted + aim["acceleration"][0][rows]
    torques = tick(chain, settings, aim, q, qd)
    joints = np.linalg.solve(chain.inertia(q), torques - chain.bias(q, qd))
    got = task @ joints + chain.drift(q, qd)[rows]
    # a pose near a singular one loses digits as its condition squared
    condition = np.linalg.cond(task) ** 2
    np.testing.assert_allclose(got, wanted, atol=1e-13 * condition * max(1.0, np.abs(wanted).max()), rtol=0)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", CHAINS)
def test_a_limb_at_rest_on_its_aim_has_no_torque(law: str, name: str) -> None:
    chain = CHAINS[name].with_gravity((0.0, 0.0, 0.0))
    for seed in range(5):
        q, _ = random_state(chain, seed)
        aim = still_aim(chain.place(q))
        aim["turn"] = tip_turn(chain, q)
        torques = tick(chain, LawSettings(law=law, posture_kp=0.0), aim, q, np.zeros(chain.n))
        np.testing.assert_allclose(torques, 0.0, atol=1e-10)


@quarter
@given(x=st.floats(0.12, 0.28), angle=st.floats(-1.2, 1.2), first=st.booleans())
def test_joint_pd_finds_the_angles_of_the_closed_form(x: float, angle: float, first: bool) -> None:
    chain, spec = limb(), libra().limbs[libra().limb_index("right")]
    start = np.array(closed_branches(spec, x, 0.0)[0 if first else 1])
    place = x * np.array([np.cos(angle), np.sin(angle)])
    exact = np.array(closed_branches(spec, *place)[0 if first else 1])
    settings = LawSettings(law="joint-pd", joint_kp=1.0, joint_kd=0.0, **BARE)
    controller = Controller(chain.with_gravity((0, 0, 0)), settings, period=PERIOD)
    for _ in range(20):  # a few steps a tick
        torques = controller.command(still_aim(place), np.array([[start, [0.0, 0.0]]]))
    np.testing.assert_allclose(torques[0], exact - start, atol=1e-8)


@quarter
@given(x=st.floats(0.14, 0.27), angle=st.floats(-1.2, 1.2), away=st.floats(-0.005, 0.005))
def test_joint_pd_has_the_angles_of_a_near_aim_within_one_tick(x: float, angle: float, away: float) -> None:
    spec = libra().limbs[libra().limb_index("right")]
    place = x * np.array([np.cos(angle), np.sin(angle)])
    start, exact = (np.array(closed_branches(spec, *at)[0]) for at in (place, place + away))
    aim, settings = still_aim(place + away), LawSettings(law="joint-pd", joint_kp=1.0, joint_kd=0.0, **BARE)
    np.testing.assert_allclose(tick(limb(), settings, aim, start, np.zeros(2)), exact - start, atol=1e-7)


@pytest.mark.parametrize(("name", "reach"), [("leg 3", 0.311), ("plane arm of 3", 0.45)])
@pytest.mark.parametrize("aim", [(0.5, 0.3), (0.1, -0.7), (3.0, 0.1)])
def test_joint_pd_points_at_an_aim_out_of_reach_and_comes_back(
    name: str, reach: float, aim: tuple[float, float]
) -> None:
    chain = limb("bottom") if name == "leg 3" else planar_chain(3)
    q = np.array([0.3, 0.7, 0.6][: chain.n])
    controller = Controller(chain, LawSettings(law="joint-pd", joint_kp=1.0, joint_kd=0.0, **BARE), period=PERIOD)

    def angles(place: tuple[float, float], ticks: int) -> Floats:
        for _ in range(ticks):
            torques = controller.command(still_aim(place), np.array([[q, np.zeros(chain.n)]]))
        pose: Floats = torques[0] + q
        return pose

    nearest = np.array(aim) / np.hypot(*aim) * reach
    for _ in range(2):
        # the distance is flat about the nearest pose, so half of the digits are there
        np.testing.assert_allclose(chain.place(angles(aim, 40))[:2], nearest, atol=1e-5)
        np.testing.assert_allclose(chain.place(angles((0.2, 0.1), 20))[:2], (0.2, 0.1), atol=1e-8)


def test_plain_resolved_rate_follows_joint_angles_that_integrate_the_aims_motion() -> None:
    chain, rng = random_chain(6, 6, gravity=False), np.random.default_rng(0)
    q = rng.uniform(-1.0, 1.0, 6)
    settings = LawSettings(law="resolved-rate-plain", joint_kp=1.0, joint_kd=0.0, sigma=0.0)
    controller = Controller(chain, settings, period=PERIOD)
    place, turn, angles, moved = chain.place(q), tip_turn(chain, q), q.copy(), q.copy()
    for _ in range(10):
        step = 1e-3 * rng.normal(size=6)
        place, turn = place + step[:3], Rotation.from_rotvec(step[3:]).as_matrix() @ turn
        aim = still_aim(place)
        aim["turn"] = turn
        moved = moved + 1e-3 * rng.normal(size=6)  # where the limb is, which the Jacobian is of
        angles = angles + np.linalg.solve(chain.jacobian(moved), step)
        if _ == 0:
            # the first tick takes the tip where it is for where the aim was
            angles = moved + np.linalg.solve(
                chain.jacobian(moved),
                np.concatenate(
                    (
                        place - chain.place(moved),
                        Rotation.from_matrix(turn @ tip_turn(chain, moved).T).as_rotvec(),
                    )
                ),
            )
        torques = controller.command(aim, np.array([[moved, np.zeros(6)]]))
        np.testing.assert_allclose(torques[0], angles - moved, atol=1e-9)


def test_the_derivative_of_the_implicit_admittance_rises_to_the_slope_of_its_command() -> None:
    chain = limb()
    q, time = np.array([0.6, -1.2]), 0.01
    settings = LawSettings(law="implicit-admittance", derivative=0.03, derivative_time=time, kp=50.0)
    controller = Controller(chain, settings, period=PERIOD)
    velocity, still = np.array([0.02, -0.01, 0.0]), np.array([[q, [0.0, 0.0]]])
    jacobian = chain.jacobian(q)[:2]
    slope = np.linalg.solve(jacobian, 50.0 * velocity[:2])
    for k in range(100):
        torques = controller.command(still_aim(chain.place(q) + k * PERIOD * velocity), still)
        risen = 1.0 - (time / (time + PERIOD)) ** k  # a first-order filter, stepped backwards in time
        np.testing.assert_allclose(torques[0], shares(chain) * slope * (k * PERIOD + 0.03 * risen), atol=1e-11)


def test_every_law_has_a_title_with_a_source() -> None:
    assert list(LAW_TITLES) == list(LAWS)
    for name, title in LAW_TITLES.items():
        assert "\n" not in title
        assert len(title) < 120, name
