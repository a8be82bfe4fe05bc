"""Laws and plants as users write them."""

import math
from dataclasses import fields

import numpy as np
import pytest

from clamber.control.law_settings import LAWS, LawError, LawSettings
from clamber.errors import ClamberError, UnknownNameError
from clamber.limb_bench.bench_limb import bench_limb, load_geared, read_elbow
from clamber.limb_bench.entries import (
    DIMENSIONS,
    GAINS,
    LISTS,
    MATCHES,
    SWITCHES,
    WORDS,
    Match,
    make_entries,
    match_pose,
    read_law,
    reference_law,
    tip_stiffness,
)
from clamber.limb_bench.scenario import circle_scenario, step_scenario
from clamber.sim.flaw_texts import DIMENSIONS as FLAW_DIMENSIONS
from clamber.sim.flaw_texts import SWITCHES as FLAW_SWITCHES
from clamber.sim.flaw_texts import WHOLE, named_flaws, read_flaws
from clamber.sim.limb_flaws import LimbFlaws
from clamber.sim.plant_rules import PlantError
from clamber.terminal.catalogue import LAW_TITLES
from clamber.units import PointError, read_point

LIMB = bench_limb()
REFERENCE = LawSettings(law="scct", kp=100.0, kd=10.0)


def test_every_setting_of_a_law_can_be_written() -> None:
    plain = {"sigma", "damping", "scaled", "force_gain", "torque_gain"}
    known = {*GAINS, *DIMENSIONS, *WORDS, *LISTS, *SWITCHES, *plain}
    assert {field.name for field in fields(LawSettings)} - {"law"} == known


def test_every_property_of_a_plant_but_its_surroundings_can_be_written() -> None:
    known = {*FLAW_DIMENSIONS, *WHOLE, *FLAW_SWITCHES}
    assert {field.name for field in fields(LimbFlaws)} - {"seed", "push", "wall", "wrist", "base"} == known


def test_every_law_has_a_title() -> None:
    assert list(LAW_TITLES) == list(LAWS)


@pytest.mark.parametrize(
    "text", ["jacobian-transpose:kp=5N/mm/1000,kd=100", "jacobian-transpose:kp=5000/1000N/m,kd=100"]
)
def test_gains_have_units_and_one_value_for_each_axis(text: str) -> None:
    law = read_law(text)
    assert law.kp == (5000.0, 1000.0)
    assert law.kd == 100.0


def test_a_servo_gain_is_in_newton_metres_per_radian() -> None:
    assert read_law("scct:kp=2N m/deg").kp == pytest.approx(2.0 * 180.0 / math.pi)
    with pytest.raises(LawError, match="no unit of angular stiffness"):
        read_law("scct:kp=2N/m")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("scct:kd=-1", "scct: kd = -1.0: must be 0 or more"),
        ("scct:kq=1", "no such setting"),
        ("scct:kp", "needs a value"),
        ("scct:kp=1,kp=2", "stated twice"),
        ("scct:kp=nan", "must be a finite number"),
        ("scct:feed_velocity=maybe", "must be yes or no"),
        ("scct:weight=gold", "must be inertia"),
        ("operational-space:kp=100N/m", "must be a number without a unit"),
        ("sct", "did you mean 'scct'"),
    ],
)
def test_a_law_that_cannot_be_is_named(text: str, said: str) -> None:
    with pytest.raises(ClamberError) as caught:
        read_law(text)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("match", ["yy", "mean"])
def test_every_law_can_be_given_the_stiffness_of_the_reference(law: str, match: Match) -> None:
    (entry,) = make_entries(LIMB, [law], REFERENCE, match, LIMB.q0)
    ours = tip_stiffness(LIMB.chain, entry.settings, LIMB.q0)
    theirs = tip_stiffness(LIMB.chain, REFERENCE, LIMB.q0)
    pick = {"yy": lambda s: s[1, 1], "mean": np.trace}[match]
    assert pick(ours) == pytest.approx(pick(theirs), rel=1e-5)
    assert not entry.own_gains


@pytest.mark.parametrize("match", MATCHES)
def test_gains_of_its_own_stay_whatever_is_matched(match: Match) -> None:
    (entry,) = make_entries(LIMB, ["jacobian-transpose:kp=700"], REFERENCE, match, LIMB.q0)
    assert entry.own_gains
    assert entry.settings.kp == 700.0


def test_unmatched_laws_take_the_numbers_of_the_reference() -> None:
    (entry,) = make_entries(LIMB, ["jacobian-transpose"], REFERENCE, "none", LIMB.q0)
    assert (entry.settings.kp, entry.settings.kd) == (100.0, 10.0)


def test_a_law_without_stiffness_to_match_is_named() -> None:
    with pytest.raises(LawError, match="no stiffness of its own to match by 'yy'"):
        make_entries(LIMB, ["hybrid:forced=y"], REFERENCE, "yy", LIMB.q0)


def test_labels_are_unique_and_the_usual_set_has_scct_and_both_baselines() -> None:
    labels = [entry.label for entry in make_entries(LIMB, (), REFERENCE, "yy", LIMB.q0)]
    assert len(set(labels)) == len(labels)
    assert {"scct", "resolved-rate by inertia", "resolved-rate unweighted"} <= set(labels)
    again = [entry.label for entry in make_entries(LIMB, ["scct", "scct"], REFERENCE, "yy", LIMB.q0)]
    assert len(set(again)) == 2


def test_stiffness_is_matched_at_the_centre_of_a_circle_on_the_branch_of_the_start() -> None:
    for elbow in (1, -1):
        limb = bench_limb(start=(0.27, 0.0), elbow=elbow)
        q = match_pose(limb, circle_scenario(limb, 200.0))
        np.testing.assert_allclose(limb.chain.place(q)[:2], (0.22, 0.0), atol=1e-12)
        assert np.sign(q[1]) == elbow
    assert match_pose(LIMB, step_scenario(LIMB, 200.0)) is LIMB.q0


def test_the_gains_of_the_command_go_before_those_of_the_reference() -> None:
    assert reference_law("scct", None, None).kp == 100.0
    assert reference_law("scct:kp=150", None, None).kp == 150.0
    assert reference_law("scct:kp=150", 300.0, 2.0).kp == 300.0
    with pytest.raises(LawError):
        reference_law("scct", -1.0, None)


def test_nominal_flaws_are_those_of_the_robots_file_and_one_sample() -> None:
    flaws = named_flaws("nominal", load_geared("libra")[0])
    assert flaws.backlash == pytest.approx(math.radians(2.0))
    assert (flaws.control_rate, flaws.encoder_counts, flaws.delay) == (200.0, 400, 1)
    with pytest.raises(UnknownNameError):
        named_flaws("perfect", load_geared("libra")[0])


def test_flaws_are_read_with_units_all_at_once() -> None:
    texts = ["backlash=1 deg", "control_rate=3kHz", "physics_rate=6kHz", "payload=300g", "friction=130%", "delay=2"]
    flaws = read_flaws(LimbFlaws(), texts)
    assert flaws.backlash == pytest.approx(math.radians(1.0))
    assert (flaws.control_rate, flaws.payload, flaws.friction, flaws.delay) == (3000.0, 0.3, 1.3, 2)
    assert flaws.seed is None
    assert read_flaws(LimbFlaws(), ["speed_noise=1deg/s"]).seed == 0
    assert read_flaws(LimbFlaws(), [], 7).seed == 7


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("backlash=2", "lacks its unit"),
        ("bakclash=2deg", "did you mean 'backlash'"),
        ("backlash=-1deg", "must be 0 or more"),
        ("damping=-1", "must be 0 or more"),
        ("control_rate=300Hz", "must divide the physics rate"),
        ("delay=1.5", "must be a whole number"),
        ("upright=perhaps", "must be yes or no"),
        ("model_error=100%", "must be less than 1"),
        ("payload", "needs a value"),
    ],
)
def test_a_plant_that_cannot_be_is_named(text: str, said: str) -> None:
    with pytest.raises(PlantError) as caught:
        read_flaws(LimbFlaws(), [text])
    assert said in str(caught.value)


def test_points_have_units_or_are_in_metres() -> None:
    assert read_point("start", "22cm,0") == (0.22, 0.0)
    assert read_point("start", "0.22, -0.01") == (0.22, -0.01)
    for text in ("1", "1,2,3", "1kg,0", "nan,0", "a,b"):
        with pytest.raises(PointError):
            read_point("start", text)
    assert (read_elbow("+"), read_elbow("-"), read_elbow(None)) == (1, -1, None)
    with pytest.raises(PointError):
        read_elbow("up")
