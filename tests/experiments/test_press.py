"""A force held against a wall while the body moves."""

import numpy as np
import pytest

from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.trials.hold_force import Pressed, run_press
from clamber.families.climber.world.library import load_board
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks.robots import load_robot

IDEAL = LimbFlaws(physics_rate=1000.0)
NOMINAL = IDEAL.with_changes(backlash=np.radians(2.0), encoder_counts=400, delay=1)


def pressed(name: str, flaws: LimbFlaws, force: float = 20.0) -> Pressed:
    robot = load_robot(name)
    assert isinstance(robot, LimbedRobot)
    return run_press(robot, load_board("ladder"), flaws, force=force)


def test_grippers_hold_20_newtons_within_a_tenth_while_the_body_moves_5_cm() -> None:
    result = pressed("libra-grippers", IDEAL)
    assert not result.reason
    assert result.ripple < 0.1
    np.testing.assert_allclose(result.way, (0.0, 0.05), atol=3e-3)  # [m]


@pytest.mark.parametrize("name", ["libra", "libra-grippers"])
def test_with_play_and_encoders_the_force_is_within_a_tenth_but_for_knocks(name: str) -> None:
    result = pressed(name, NOMINAL)
    assert not result.reason
    assert result.within > 0.95
    assert float(result.force.mean()) == pytest.approx(20.0, rel=0.03)
    np.testing.assert_allclose(result.way, (0.0, 0.05), atol=5e-3)  # [m]


def test_the_measures_are_those_of_the_curve() -> None:
    time = np.arange(200) * 0.005
    force = np.zeros(200) + 20.0
    force[50], force[100:120] = 30.0, 19.0
    body = np.zeros((200, 3))
    body[-1, 1] = 0.05
    result = Pressed(20.0, time, force, body, body, (0.0, 1.0))
    assert result.ripple == pytest.approx(0.5)
    assert result.steady_ripple == pytest.approx(0.125)  # one tick of four
    assert result.within == pytest.approx(199 / 200)
    assert result.spread == pytest.approx(np.sqrt((100.0 + 20.0) / 200) / 20.0)
