"""Portraits: every law in the same scenes, at gains that are recommended or matched."""

import json

import numpy as np
import pytest

from clamber.control.law_settings import LawSettings
from clamber.control.recommended import read_recommended
from clamber.errors import UnknownNameError
from clamber.limb_bench.portrait import Portrait, Portraits, paint_portraits

REFERENCE = LawSettings(law="scct", kp=200.0, kd=10.0)


@pytest.fixture(scope="module")
def painted() -> dict[str, Portrait]:
    return {each.law: each for each in paint_portraits(["scct", "hybrid", "jacobian-transpose"])}


@pytest.mark.slow
def test_gains_are_those_recommended_for_the_limb_unless_they_are_matched(painted: dict[str, Portrait]) -> None:
    for law, each in painted.items():
        (found,) = (one for one in read_recommended() if (one.robot, one.limb, one.law) == ("libra", "right", law))
        assert (each.settings.kp, each.settings.kd) == (found.kp, found.kd)
        assert np.diag(each.stiffness) == pytest.approx(found.stiffness, rel=1e-4)
    scct, transpose = paint_portraits(["scct", "jacobian-transpose"], matched=REFERENCE)
    assert scct.settings.kp == pytest.approx(200.0)
    assert transpose.stiffness[1, 1] == pytest.approx(scct.stiffness[1, 1], rel=1e-6)


def test_touching_nothing_hybrid_control_is_scct(painted: dict[str, Portrait]) -> None:
    assert painted["hybrid"].figures() == painted["scct"].figures()
    assert painted["hybrid"].forces and not painted["scct"].forces


def test_feeding_forward_helps_and_backlash_does_not(painted: dict[str, Portrait]) -> None:
    for each in painted.values():
        told = each.figures()
        for name in told:
            assert told[name]["nominal"] > told[name]["ideal"]  # type: ignore[operator]
        assert told["fed"]["ideal"] < told["circle"]["ideal"]  # type: ignore[operator]


def test_a_law_that_goes_unstable_has_no_figures_but_a_row(painted: dict[str, Portrait]) -> None:
    (wild,) = paint_portraits(["scct"], matched=LawSettings(law="scct", kp=6000.0, kd=0.0))
    assert wild.figures()["step"]["nominal"] is None
    assert "unstable" in wild.row() and len(wild.row()) == len(painted["scct"].row())


def test_portraits_are_plain_data(painted: dict[str, Portrait]) -> None:
    told = json.loads(json.dumps(Portraits(seed=1, laws=tuple(painted.values())).to_json(), allow_nan=False))
    assert [each["law"] for each in told["laws"]] == list(painted)
    assert set(told["laws"][1]["forces"]["nominal"]) == {"none", "model"}


def test_an_unknown_law_is_named() -> None:
    with pytest.raises(UnknownNameError, match="scct"):
        paint_portraits(["sctt"])
