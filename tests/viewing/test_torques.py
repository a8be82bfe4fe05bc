"""Torques in words."""

import pytest

from clamber.families.climber.pictures.artists import show_torque


@pytest.mark.parametrize(
    ("torque", "ounces", "words"),
    [(-1e-4, True, "0 oz-in"), (-1e-4, False, "0.00 N m"), (-1.0, True, "-142 oz-in"), (2.345, False, "2.35 N m")],
)
def test_small_torques_have_no_sign(torque: float, ounces: bool, words: str) -> None:
    assert show_torque(torque, ounces=ounces) == words
