"""Torques in words."""

import pytest

from clamber.families.climber.pictures.artists import torque_gauges
from clamber.families.climber.planning.task import LimbedTask
from clamber.tasks import load_task


@pytest.mark.parametrize(
    ("torque", "step", "words"),
    [
        (-1e-4, "1in", "0 oz-in"),
        (-1e-4, "2cm", "0.00 N m"),
        (-1.0, "1in", "-142 oz-in"),
        (2.345, "2cm", "2.35 N m"),
    ],
)
def test_small_torques_have_no_sign(torque: float, step: str, words: str) -> None:
    task = load_task("ladder", [f"step.length={step}"])
    assert isinstance(task, LimbedTask)
    assert torque_gauges(task).show(torque) == words
