"""Where body and arm are by the robot's own sensors."""

import numpy as np
import pytest
from test_planted import SEEDS, footing, near, turn_of
from walkers import hoshino

from clamber.families.walker.control.cooperative.cooperator import Cooperator
from clamber.families.walker.control.cooperative.settings import Cooperation, own_speeds
from clamber.families.walker.trials.cooperative.simulated_body import FeltBody


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("support", ["delta", "y"])
def test_the_sensors_of_a_rigid_robot_tell_its_freedoms(support: str, seed: int) -> None:
    robot = hoshino()
    stance = footing(robot, support, seed, tilt=0.1)
    q = near(stance, robot, seed)
    settings = Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.1))
    values = Cooperator(robot, settings, stance).limited_values(q)[4:]
    turn = turn_of(q)
    inclines = np.arcsin(turn[2, :2])
    felt = FeltBody(stance).freedoms(values[:3], values[4:10].reshape(2, 3), inclines, q[6:])
    np.testing.assert_allclose(felt, q, atol=1e-9)


def test_a_leg_that_gives_is_felt_by_the_tilt() -> None:
    """The motors say that all is well; the plate has tilted by 5 mrad, and so the tool is lower and farther out."""
    robot = hoshino()
    stance = footing(robot, "delta")
    law = Cooperator(robot, Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.1)), stance)
    q = np.concatenate([stance.pose, robot.arm.rest if robot.arm else ()])
    values = law.limited_values(q)[4:]
    sensed = FeltBody(stance).freedoms(values[:3], values[4:10].reshape(2, 3), np.array([-0.005, 0.0]), q[6:])
    off = law.place(sensed) - law.place(q)
    assert sensed[4] == pytest.approx(0.005)
    assert off[2] == pytest.approx(-0.005 * np.linalg.norm((law.place(q) - q[:3])[:2]), rel=0.15)
