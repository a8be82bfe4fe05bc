"""The tool stays at a point of the world while the standing frame slides, lifts and tilts the body, in contact dynamics."""

import numpy as np
import pytest

from clamber.families.walker.control.cooperative.cooperator import Cooperator
from clamber.families.walker.control.cooperative.freedoms import weights_of
from clamber.families.walker.control.cooperative.holding import ToolHolder
from clamber.families.walker.control.cooperative.settings import Cooperation, own_speeds
from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.trials.cooperative.simulated_body import SimulatedBody
from clamber.tasks.robots import load_robot
from clamber.types import Floats

PERIOD = 0.02
APPROACH, SLIDE, AFTER = 6.0, 20.0, 2.0
ACROSS = np.array([-0.1, 0.25, -0.1])
"""From the tool at rest to the point [m]."""


def share(part: float) -> float:
    u = min(1.0, max(0.0, part))
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)


def slide(way: Floats) -> tuple[Floats, Floats, Floats]:
    """Distances of the tool from the point while the body goes a way, how far off it was felt to be, and the body's true way."""
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    body = SimulatedBody(robot, "y", 0.35, 0.0, PERIOD)
    settings = Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.2), gain=0.5, period=PERIOD)
    law = Cooperator(robot, settings, body.footing, "arm")
    holder, begin, weights = ToolHolder(law, body.start), law.place(body.start), weights_of("arm", 4)
    errors, felt = [], []
    for k in range(round((APPROACH + SLIDE + AFTER) / PERIOD)):
        time = k * PERIOD
        target = begin + share(time / APPROACH) * ACROSS
        holder.step(body.start[:6] + share((time - APPROACH) / SLIDE) * way, target - body.off, weights)
        place = body.move(law, holder.q)
        if time > APPROACH:
            errors.append(np.linalg.norm(place - target))
            felt.append(np.linalg.norm(body.off))
    return np.array(errors), np.array(felt), body.pose() - body.start[:6]


@pytest.mark.parametrize(
    "way",
    [
        np.array([0.05, 0.0, 0.0, 0.0, 0.0, 0.0]),
        np.array([-0.04, 0.02, 0.03, 0.05, 0.0, 0.0]),
        np.array([0.02, 0.02, -0.02, 0.0, 0.05, -0.05]),
    ],
    ids=["straight", "turning and rising", "tilting"],
)
def test_the_tool_stays_within_millimetres_while_the_body_goes(way: Floats) -> None:
    errors, _, went = slide(way)
    np.testing.assert_allclose(went, way, atol=4e-3)
    assert errors.max() < 2e-3


def test_a_body_that_does_not_come_where_it_is_led_is_felt() -> None:
    """Led past an actuator's stroke: the body stays back by 40 mm, the sensors say so, and the arm makes up for it."""
    errors, felt, went = slide(np.array([0.08, 0.04, 0.03, 0.1, 0.0, 0.0]))
    assert went[0] < 0.06
    assert felt.max() > 0.03
    assert errors.max() < 6e-3
