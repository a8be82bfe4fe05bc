"""Freedoms that are switched with the feet that stand, as in walking, and how large the gain may be."""

from dataclasses import replace

import numpy as np
import pytest
from test_equation_19 import law
from test_limits import START, Judge
from walkers import hoshino, switch

from clamber.families.walker.control.cooperative.cooperator import Cooperator, stable_gain
from clamber.families.walker.control.cooperative.freedoms import Freedoms, weights_of
from clamber.families.walker.control.cooperative.planted_feet import PlantedFeet, Support
from clamber.families.walker.control.cooperative.settings import Cooperation, own_speeds
from clamber.types import Floats

PHASES: tuple[tuple[Support, Freedoms], ...] = (
    ("y", "all"),
    ("both", "levelling"),
    ("delta", "levelling"),
    ("both", "levelling"),
)
LASTS = 4.0
RAMP = 1.0
PERIOD = 0.02


def stand_on(made: Cooperator, support: Support, q: Floats) -> None:
    """Change the feet that stand, with the robot as it is at `q`."""
    offset, twist = made.y_in_delta(q)
    made.stand(replace(made.footing, support=support, pose=q[:6].copy(), offset=offset, twist=twist))


def test_the_tool_goes_on_smoothly_while_the_standing_feet_change() -> None:
    """The plate's freedoms are faded out before a change of feet and in after it; no limit breaks, nothing jumps.

    While the Y-frame stands the mechanism keeps a plate that tilts over its place, on its own feet a tilt carries it along; so the plate
    has to be at rest when that changes.
    """
    robot = hoshino()
    speeds = own_speeds(robot)
    settings = Cooperation(speeds=speeds, tool_speeds=np.full(3, 0.1), gain=2.0, period=PERIOD)
    made = Cooperator(robot, settings, PlantedFeet(robot=robot, support="y", pose=START[:6], payload=1.0))
    q, start = START.copy(), made.place(START)
    centre = start - np.array([0.0, 0.0, 0.08])
    arm, rates, errors = weights_of("arm", 4), [], []
    for phase in range(12):
        support, freedoms = PHASES[phase % 4]
        stand_on(made, support, q)
        own = weights_of(freedoms, 4)
        judge = Judge(robot, made.footing, speeds, PERIOD)
        for k in range(round(LASTS / PERIOD)):
            time = k * PERIOD
            weights = switch(arm, own, time / RAMP) if time < RAMP else switch(own, arm, (time - LASTS) / RAMP + 1.0)
            made.check_weights(weights)
            angle = 0.15 * (phase * LASTS + time)
            target = centre + 0.08 * np.array([0.0, np.sin(angle), np.cos(angle)])
            velocity = 0.15 * 0.08 * np.array([0.0, np.cos(angle), -np.sin(angle)])
            step = made.step(q, target, velocity, weights)
            assert step.solved
            assert judge.excess(q, step.q) <= 1e-12
            rates.append((step.q - q) / PERIOD)
            errors.append(np.linalg.norm(step.place - target))
            q = step.q
    jumps = np.abs(np.diff(rates, axis=0)) / speeds
    assert jumps.max() < 0.02  # of each freedom's largest speed, in one period: the ramps' own pace
    assert max(errors) < 1e-3
    moved = np.abs(np.array(rates)).reshape(12, -1, 10).max(axis=1) > 1e-7
    for phase in range(12):
        if PHASES[phase % 4][0] == "y":
            assert moved[phase].all()


@pytest.mark.parametrize("support", ["delta", "y", "both"])
def test_standing_anew_does_not_move_the_robot(support: Support) -> None:
    robot = hoshino()
    settings = Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.1), gain=0.0)
    made = Cooperator(robot, settings, PlantedFeet(robot=robot, support="y", pose=START[:6]))
    q, weights = START.copy(), weights_of("all", 4)
    target = made.place(q) + np.array([0.1, 0.1, -0.1])
    for _ in range(300):
        q = made.step(q, target, np.zeros(3), weights).q
    before = made.limited_values(q)
    stand_on(made, support, q)
    after = made.limited_values(q)
    np.testing.assert_allclose(after[4:14], before[4:14], atol=1e-12)  # joints aside: actuators, guard, legs
    still = made.step(q, made.place(q), np.zeros(3), np.zeros(10))
    np.testing.assert_allclose(still.q, q, atol=1e-12)


def test_above_the_stable_gain_the_second_term_swings_about_the_summit() -> None:
    robot = hoshino()
    made = law(robot, gain=1.0, feedback=0.0, period=0.02)
    weights = weights_of("arm", 4)
    q = np.array([0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.2, 1.1, -1.0, -0.9])
    place, still = made.place(q), np.zeros(3)
    for _ in range(20000):  # to the summit; the tool is brought back to its place
        q = made.step(q, place, still, weights, feedback=2.0).q
    bound = stable_gain(made, q, weights)
    assert 5.0 < bound < 1e4
    swings = {}
    for share in (0.8, 1.2):
        pushed = law(robot, gain=share * bound, feedback=0.0, period=0.02)
        p, ways = q + np.array([0.0] * 7 + [1e-4, 0.0, 0.0]), []
        hold = pushed.place(p)
        for _ in range(60):
            after = pushed.step(p, hold, still, weights, feedback=2.0).q
            ways.append(float(np.linalg.norm(after - p)))
            p = after
        swings[share] = ways[-1] / ways[1]
    assert swings[0.8] < 0.1
    assert swings[1.2] > 3.0
