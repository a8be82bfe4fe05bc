"""The controller: batches, what it refuses, what it says about damping and limits."""

import math
import pickle
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_chains import PERIOD, limb, planar_chain, quarter, random_aim, random_chain, random_state, tip_turn

from clamber.control.chain import Chain
from clamber.control.controller import AimError, Controller, MeasurementError, ShapeError, still_aim
from clamber.control.law_settings import LAWS, LawError, LawSettings
from clamber.control.records import AIM
from clamber.types import Floats, Records

CHAINS = {"leg 1": limb(limited=True), "plane arm of 3": planar_chain(3, limit=30.0), "spatial 6": random_chain(6, 6)}


def batch_of(chain: Chain, size: int) -> tuple[Records, Floats, Floats]:
    """Aims, states and wrenches of a batch."""
    states = np.array([random_state(chain, seed) for seed in range(size)])
    aims = np.concatenate([random_aim(chain, states[b, 0], b) for b in range(size)])
    return aims, states, np.random.default_rng(0).normal(size=(size, 6))


def spread_laws(chain: Chain) -> list[LawSettings]:
    """Every law, with other options by turns."""
    out = []
    for k, law in enumerate(LAWS):
        forced = ("x",) if law in ("hybrid", "implicit-force") else ()
        friction = ("aim", "measured", "torque")[k % 3]
        out.append(
            LawSettings(
                law=law, forced=forced, feed_friction=0.5, friction_from=friction, scaled=k % 2 == 0, angle=0.1 * k
            )
        )
    return out


@pytest.mark.parametrize("name", CHAINS)
def test_a_batch_is_its_limbs_one_by_one_whatever_their_laws(name: str) -> None:
    chain = CHAINS[name]
    laws = spread_laws(chain)
    aims, states, wrenches = batch_of(chain, len(laws))
    together = Controller(chain, laws, period=PERIOD, batch=len(laws))
    alone = [Controller(chain, law, period=PERIOD) for law in laws]
    for tick in range(4):
        moved = states + 1e-3 * tick
        torques = together.command(aims, moved, wrenches)
        for b, one in enumerate(alone):
            single = one.command(aims[b : b + 1], moved[b : b + 1], wrenches[b : b + 1])
            np.testing.assert_array_equal(torques[b], single[0], err_msg=laws[b].law)
            assert together.reports[b] == one.reports[0]


@pytest.mark.parametrize("law", LAWS)
def test_a_batch_of_one_law_is_its_limbs_one_by_one(law: str) -> None:
    chain = CHAINS["leg 1"]
    aims, states, wrenches = batch_of(chain, 7)
    together = Controller(chain, LawSettings(law=law), period=PERIOD, batch=7).command(aims, states, wrenches)
    for b in range(7):
        one = Controller(chain, LawSettings(law=law), period=PERIOD)
        single = one.command(aims[b : b + 1], states[b : b + 1], wrenches[b : b + 1])
        np.testing.assert_array_equal(together[b], single[0])


@pytest.mark.parametrize("law", LAWS)
def test_a_reset_controller_has_forgotten_everything(law: str) -> None:
    chain = CHAINS["leg 1"]
    aims, states, wrenches = batch_of(chain, 1)
    controller = Controller(chain, LawSettings(law=law, forced=("x",) if law == "hybrid" else ()), period=PERIOD)
    first = controller.command(aims, states, wrenches).copy()
    for k in range(5):
        controller.command(aims, states + 0.01 * k, wrenches)
    controller.reset()
    np.testing.assert_array_equal(controller.command(aims, states, wrenches), first)


BAD = st.sampled_from([math.nan, math.inf, -math.inf])


@pytest.mark.parametrize("law", LAWS)
@quarter
@given(value=BAD, limb_of=st.integers(0, 3), row=st.integers(0, 1), joint=st.integers(0, 1))
def test_a_measurement_that_is_no_number_is_named_and_stops_no_other_limb(
    law: str, value: float, limb_of: int, row: int, joint: int
) -> None:
    chain = CHAINS["leg 1"]
    aims, states, wrenches = batch_of(chain, 4)
    good = Controller(chain, LawSettings(law=law), period=PERIOD, batch=4).command(aims, states, wrenches).copy()
    controller = Controller(chain, LawSettings(law=law), period=PERIOD, batch=4)
    broken = states.copy()
    broken[limb_of, row, joint] = value
    name = f"{('angle', 'speed')[row]} of the {chain.joint_names[joint]}"
    text = f"libra's right limb, limb {limb_of} of the batch: measured {name} is {value}; it must be finite"
    with pytest.raises(MeasurementError, match=f"^{re.escape(text)}$"):
        controller.command(aims, broken, wrenches)
    others = [b for b in range(4) if b != limb_of]
    np.testing.assert_array_equal(controller.torques[others], good[others])
    np.testing.assert_array_equal(controller.torques[limb_of], 0.0)
    # its memory is untouched: the next good measurement is as if it were the first
    np.testing.assert_array_equal(controller.command(aims, states, wrenches)[limb_of], good[limb_of])


@quarter
@given(value=BAD, axis=st.integers(0, 5))
def test_a_wrench_that_is_no_number_is_named(value: float, axis: int) -> None:
    chain = CHAINS["leg 1"]
    aims, states, wrenches = batch_of(chain, 3)
    wrenches[1, axis] = value
    name = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")[axis]
    controller = Controller(chain, LawSettings(law="admittance"), period=PERIOD, batch=3)
    with pytest.raises(MeasurementError, match=rf"limb 1 of the batch: measured wrench {name} is {value}; it must"):
        controller.command(aims, states, wrenches)


@pytest.mark.parametrize("field", ["place", "turn", "twist", "acceleration", "wrench"])
@quarter
@given(value=BAD, limb_of=st.integers(0, 2), at=st.integers(0, 8))
def test_an_aim_that_is_no_number_is_named(field: str, value: float, limb_of: int, at: int) -> None:
    chain = CHAINS["leg 1"]
    aims, states, wrenches = batch_of(chain, 3)
    numbers = aims[field][limb_of].reshape(-1)
    numbers[at % numbers.size] = value
    controller = Controller(chain, LawSettings(law="scct"), period=PERIOD, batch=3)
    with pytest.raises(
        AimError, match=rf"limb {limb_of} of the batch: the aim's {field} is {value}; it must be finite"
    ):
        controller.command(aims, states, wrenches)
    assert (controller.torques[limb_of] == 0.0).all()
    assert (np.abs(controller.torques).sum(axis=1) > 0.0).sum() == 2


@pytest.mark.parametrize(
    ("shape", "text"),
    [((2,), r"of shape \(2,\)"), ((1, 2, 3), r"of shape \(1, 2, 3\)"), ((2, 2, 2), r"of shape \(2, 2, 2\)")],
)
def test_states_of_another_shape_are_refused(shape: tuple[int, ...], text: str) -> None:
    controller = Controller(CHAINS["leg 1"], LawSettings(law="scct"), period=PERIOD)
    with pytest.raises(ShapeError, match=rf"libra's right limb: states {text}: must be of shape \(1, 2, 2\)"):
        controller.command(still_aim((0.2, 0.0)), np.zeros(shape))


def test_wrenches_and_aims_of_another_shape_or_kind_are_refused() -> None:
    controller = Controller(CHAINS["leg 1"], LawSettings(law="scct"), period=PERIOD, batch=3)
    aims, states = still_aim((0.2, 0.0)), np.zeros((3, 2, 2))
    with pytest.raises(ShapeError, match=r"wrenches of shape \(6,\): must be of shape \(3, 6\)"):
        controller.command(aims, states, np.zeros(6))
    with pytest.raises(ShapeError, match=r"aims of shape \(2,\): must be records of AIM, of shape \(1,\) or \(3,\)"):
        controller.command(np.zeros(2, AIM), states)
    with pytest.raises(ShapeError, match=r"aims float64: must be records of AIM"):
        controller.command(np.zeros(3), states)
    with pytest.raises(ShapeError, match=r"states 'here': must be numbers of shape \(3, 2, 2\)"):
        controller.command(aims, "here")  # type: ignore[arg-type]


def test_lists_other_floats_and_strided_arrays_are_taken_as_they_mean() -> None:
    controller = Controller(CHAINS["leg 1"], LawSettings(law="scct"), period=PERIOD)
    q, qd = [0.5, -1.25], [0.25, 0.125]
    aim = still_aim((0.2, 0.1))
    wanted = controller.command(aim, np.array([[q, qd]])).copy()
    strided = np.zeros((1, 2, 4))
    strided[0, :, ::2] = q, qd
    for states in ([[q, qd]], np.array([[q, qd]], dtype=np.float32), strided[:, :, ::2]):
        np.testing.assert_array_equal(controller.command(aim, states), wanted)  # type: ignore[arg-type]
    stacked = np.stack([aim, aim])[0]  # its dtype equals AIM, but is another object
    np.testing.assert_array_equal(controller.command(stacked, np.array([[q, qd]])), wanted)


def test_a_batch_needs_one_law_or_as_many_as_limbs() -> None:
    laws = [LawSettings(law="scct")] * 2
    with pytest.raises(LawError, match="settings = 2: must be one law, or 3: one for each limb"):
        Controller(CHAINS["leg 1"], laws, period=PERIOD, batch=3)
    with pytest.raises(LawError, match="batch = 0: must be 1 or more"):
        Controller(CHAINS["leg 1"], LawSettings(law="scct"), period=PERIOD, batch=0)


def test_laws_of_one_batch_share_one_weighing_of_the_joints() -> None:
    chain = CHAINS["leg 1"]  # its K' is that of inertia
    pair = [LawSettings(law="scct"), LawSettings(law="resolved-rate", weight="inertia")]
    assert Controller(chain, pair, period=PERIOD, batch=2).chain.joints["share"][0] == pytest.approx(0.4020 / 0.7652)
    mixed = [LawSettings(law="scct"), LawSettings(law="hybrid", weight="damping")]
    with pytest.raises(LawError, match="weight = the chain for scct, damping for hybrid: must give the same K'"):
        Controller(chain, mixed, period=PERIOD, batch=2)
    unweighted = [LawSettings(law="jacobian-transpose"), LawSettings(law="hybrid", weight="damping")]
    assert Controller(chain, unweighted, period=PERIOD, batch=2).chain.joints["share"][0] == 1.0


def test_the_controller_keeps_its_own_copy_of_the_chain() -> None:
    chain = limb()
    controller = Controller(chain, LawSettings(law="scct"), period=PERIOD)
    q = np.array([0.6, -1.2])
    before = controller.command(still_aim((0.2, 0.1)), np.array([[q, q]])).copy()
    chain.joints["share"], chain.joints["place"] = 0.1, 1.0
    np.testing.assert_array_equal(controller.command(still_aim((0.2, 0.1)), np.array([[q, q]])), before)


def test_damping_is_reported_and_explained() -> None:
    controller = Controller(CHAINS["leg 1"], LawSettings(law="scct"), period=PERIOD)
    aim = still_aim((0.2, 0.1))
    controller.command(aim, np.array([[[0.6, -1.2], [0.0, 0.0]]]))
    assert controller.reports["lambda2"][0] == 0.0
    sigma = np.linalg.svd(CHAINS["leg 1"].jacobian((0.6, -1.2))[:2], compute_uv=False).min()
    assert controller.reports["sigma"][0] == pytest.approx(sigma, rel=1e-12)
    assert re.match(
        r"scct on libra's right limb: smallest singular value 0\.0\d+, no damping \(it starts below 0\.01\); ",
        controller.explain(),
    )
    controller.command(aim, np.array([[[0.6, 0.0], [0.0, 0.0]]]))
    sigma, lambda2 = controller.reports["sigma"][0], controller.reports["lambda2"][0]
    assert 0.0 < sigma < 0.01
    assert lambda2 == pytest.approx(0.02**2 * (1.0 - (sigma / 0.01) ** 2))
    assert f"damping lambda = {math.sqrt(lambda2):.3g}" in controller.explain()
    assert "of 2 motors at a limit" in controller.explain()


def test_errors_survive_the_way_between_processes() -> None:
    for error in (
        MeasurementError("arm", "angle of the hip", math.nan, 3),
        AimError("arm", "place", math.inf, 0),
        ShapeError("arm", "states", "of shape (2,)", "must be of shape (1, 2, 2)"),
        LawError("scct", "kp", -1.0, "must be 0 or more"),
    ):
        copy = pickle.loads(pickle.dumps(error))
        assert str(copy) == str(error)
        assert "arm" in str(error) or "scct" in str(error)


def test_a_still_aim_keeps_the_turn_that_the_records_call_none() -> None:
    chain = CHAINS["spatial 6"]
    q, _ = random_state(chain, 0)
    aim = still_aim(chain.place(q), 3)
    assert aim.shape == (3,)
    np.testing.assert_array_equal(aim["turn"], np.broadcast_to(np.eye(3), (3, 3, 3)))
    assert not np.allclose(tip_turn(chain, q), np.eye(3))
