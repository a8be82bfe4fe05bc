"""What a user may set of a law, and what is refused: each with its key, its value and what is allowed."""

import math
import re
from typing import Any

import numpy as np
import pytest
from random_chains import PERIOD, limb, planar_chain, random_chain

from clamber.control.chain import Chain, empty_chain
from clamber.control.law_settings import LAWS, LawError, LawSettings
from clamber.errors import UnknownNameError

NEVER_NEGATIVE = (
    *("kp", "kd", "joint_kp", "joint_kd", "feed_friction", "friction_speed", "sigma", "damping", "derivative"),
    *("derivative_time", "force_gain", "force_limit", "force_damping", "environment", "mass", "admittance_kp"),
    *("admittance_kd", "posture_kp", "posture_kd"),
)


@pytest.mark.parametrize("key", NEVER_NEGATIVE)
def test_a_negative_setting_is_refused(key: str) -> None:
    with pytest.raises(LawError, match=rf"^scct: {key} = -0\.5: must be 0 or more$"):
        LawSettings(law="scct", **{key: -0.5})  # type: ignore[arg-type]


@pytest.mark.parametrize("key", (*NEVER_NEGATIVE, "angle"))
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_setting_that_is_not_finite_is_refused(key: str, value: float) -> None:
    with pytest.raises(LawError, match=rf"^scct: {key} = {value}: must be a finite number$"):
        LawSettings(law="scct", **{key: value})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"kp": "stiff"}, "kp = stiff: must be a number"),
        ({"kp": True}, "kp = True: must be a number"),
        ({"kp": (100.0, -1.0)}, "kp = (100.0, -1.0): must be 0 or more"),
        ({"sigma": (0.1, 0.2)}, "sigma = (0.1, 0.2): must be one number"),
        ({"friction_speed": 0.0}, "friction_speed = 0.0: must be more than 0"),
        ({"environment": 0.0}, "environment = 0.0: must be more than 0"),
        ({"feed_gravity": "no"}, "feed_gravity = no: must be true or false"),
        ({"scaled": 1}, "scaled = 1: must be true or false"),
        ({"weight": "mass"}, "weight = mass: must be of none, inertia, damping, back-emf"),
        ({"friction_from": "guess"}, "friction_from = guess: must be of aim, measured, torque"),
        ({"axes": ("x", "w")}, "axes = w: must be of x, y, z, rx, ry, rz"),
        ({"axes": ("x", "x")}, "axes = x, x: must name each axis once"),
        ({"axes": "x"}, 'axes = x: must be a list of axes, such as ("x",)'),
        ({"frame": 0.3}, "frame = 0.3: must be three numbers: a rotation vector"),
        ({"frame": (0.3, 0.1)}, "frame = (0.3, 0.1): must be three numbers: a rotation vector"),
        ({"forced": ("x",)}, "forced = x: only hybrid and implicit-force take rows of force"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_setting_that_makes_no_sense_is_refused(changes: dict[str, Any], text: str) -> None:
    with pytest.raises(LawError, match=f"^scct: {re.escape(text)}"):
        LawSettings(law="scct", **changes)


def test_an_unknown_law_or_setting_is_refused_with_the_nearest_one() -> None:
    with pytest.raises(UnknownNameError, match=r"no controller is called 'sct'; there are .*did you mean 'scct'"):
        LawSettings(law="sct")
    with pytest.raises(LawError, match=r"scct: kpp = 3: no such setting; there are .*did you mean 'kp'"):
        LawSettings(law="scct").with_changes(kpp=3)


def test_lists_are_taken_for_tuples() -> None:
    settings = LawSettings(law="hybrid", kp=[100, 50], axes=["x", "y"], forced=["y"], frame=[0, 0, 1])  # type: ignore[arg-type]
    assert settings == LawSettings(law="hybrid", kp=(100, 50), axes=("x", "y"), forced=("y",), frame=(0, 0, 1))
    assert hash(settings) == hash(settings.with_changes())


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"kp": (1.0, 2.0, 3.0)}, "kp = (1.0, 2.0, 3.0): must be one number, or 2: one for each controlled axis"),
        ({"axes": ("x", "y", "rz")}, "axes = x, y, rz: libra's right limb has 2 joints only"),
        ({"law": "hybrid", "forced": ("z",)}, "forced = z: must be one of the controlled axes"),
        ({"law": "resolved-rate", "kd": 0.0}, "joint_kd = 0.0: must be more than 0"),
        ({"law": "resolved-rate", "joint_kd": 0.0}, "joint_kd = 0.0: must be more than 0"),
        ({"law": "admittance", "joint_kd": 0.0}, "joint_kd = 0.0: must be more than 0"),
        (
            {"law": "admittance", "mass": 0.0, "admittance_kd": (5.0, 0.0)},
            "admittance_kd = (5.0, 0.0): must be more than 0 where the mass is 0",
        ),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_settings_that_do_not_fit_the_chain_are_refused(changes: dict[str, Any], text: str) -> None:
    settings = LawSettings(**{"law": "scct", **changes})
    with pytest.raises(LawError, match=f"^{settings.law}: {re.escape(text)}"):
        settings.record(limb(), PERIOD)


@pytest.mark.parametrize("period", [0.0, -0.005, math.nan, math.inf])
def test_a_period_that_cannot_be_is_refused(period: float) -> None:
    with pytest.raises(LawError, match=rf"^scct: period = {period}: must be more than 0 s, and finite$"):
        LawSettings(law="scct").record(limb(), period)


def test_operational_space_asks_for_an_inertia_to_divide_by() -> None:
    joints, root = empty_chain(3)
    joints["place"][1:], root["tip"] = (0.1, 0.0, 0.0), (0.1, 0.0, 0.0)
    weightless = Chain("thin arm", ("a", "b", "c"), joints, root, plane=True)
    with pytest.raises(
        LawError, match=r"^operational-space: inertia = 0\.0: thin arm must have an inertia about every"
    ):
        LawSettings(law="operational-space").record(weightless, PERIOD)


@pytest.mark.parametrize(
    ("chain", "rows"),
    [
        (limb(), (0, 1)),
        (planar_chain(1), (0,)),
        (planar_chain(4), (0, 1)),
        (random_chain(2, 2), (0, 1)),
        (random_chain(3, 3), (0, 1, 2)),
        (random_chain(5, 5), (0, 1, 2)),
        (random_chain(6, 6), (0, 1, 2, 3, 4, 5)),
        (random_chain(7, 7), (0, 1, 2, 3, 4, 5)),
    ],
    ids=lambda value: value.name if isinstance(value, Chain) else "",
)
def test_the_usual_rows_are_those_that_a_chain_can_follow(chain: Chain, rows: tuple[int, ...]) -> None:
    assert LawSettings(law="scct").rows_of(chain) == rows


@pytest.mark.parametrize("law", LAWS)
def test_the_joint_servo_takes_the_mean_of_the_gains_unless_told(law: str) -> None:
    record = LawSettings(law=law, kp=(100.0, 300.0), kd=(4.0, 8.0)).record(limb(), PERIOD)[0]
    assert (record["joint_kp"], record["joint_kd"]) == (200.0, 6.0)
    told = LawSettings(law=law, joint_kp=50.0, joint_kd=5.0).record(limb(), PERIOD)[0]
    assert (told["joint_kp"], told["joint_kd"]) == (50.0, 5.0)


def test_the_task_frame_is_the_frame_then_the_angle() -> None:
    quarter = math.pi / 2
    turned = LawSettings(law="scct", frame=(quarter, 0.0, 0.0), angle=quarter).task_frame()
    # frame lays z along -y of the base; angle then turns x and y of the tilted frame
    np.testing.assert_allclose(turned, [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]], atol=1e-15)
