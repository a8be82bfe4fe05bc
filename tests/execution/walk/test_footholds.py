"""Footholds that are proved: what a frame's feet carry meanwhile, and which of them an edge lets slip."""

import math

import numpy as np
import pytest
from spring_walks import BEST, ROBOT, stood

from clamber.control.loads import strain_of
from clamber.families.walker.control.gait import DELTA, Y
from clamber.families.walker.execution import motions
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.execution.true_walk import TracedPlant
from clamber.families.walker.execution.walker import RefusedError, Walker
from clamber.families.walker.execution.walking import KEPT, proof_strain, prove
from clamber.families.walker.sim.walker_flaws import WalkerFlaws
from clamber.families.walker.sim.walker_model import WalkerBuild
from clamber.families.walker.sim.walker_plant import WalkerSim
from clamber.families.walker.world.ground import Block, Ground

SETTINGS = WalkSettings(probe=1e-3, clear=None)
BALL = WalkerBuild().foot_radius
AHEAD = 0.05
"""By how much the Y-frame steps, along x [m]."""
HIGH = 0.012
"""Of the block that its first foot comes down beside [m]."""


@pytest.mark.parametrize("frame", [DELTA, Y])
def test_a_proved_frame_carries_all_but_what_the_other_keeps(frame: int) -> None:
    walker, _ = stood(settings=SETTINGS)
    motions.settle(walker)
    strain = proof_strain(walker, frame)
    # no force, no moment: so the weight stays where it is
    assert strain.sum() == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(walker.places.T @ strain, 0.0, atol=1e-9)
    np.testing.assert_allclose(strain_of(walker.places, strain, walker.stands), strain, atol=1e-9)
    even = walker.forces - strain_of(walker.places, walker.forces, walker.stands)
    carried = even + strain
    others = list(walker.of_frame(1 - frame))
    assert carried[others].min() == pytest.approx(KEPT)
    assert carried[list(walker.of_frame(frame))].sum() > 0.7 * carried.sum()
    walker.strain[:] = strain
    walker.wait(5.0)
    np.testing.assert_allclose(walker.forces, carried, atol=0.03 * carried.sum() / 6)


def test_on_even_ground_nothing_slips_and_the_robot_stands_as_before() -> None:
    walker, plant = stood(settings=SETTINGS)
    motions.lift(walker, Y)
    motions.slide(walker, Y, walker.frames()[Y] + 0.03 * np.array((math.cos(BEST), math.sin(BEST), 0.0)))
    motions.lower(walker, walker.of_frame(Y))
    before, place = walker.frames(), walker.place.copy()
    assert prove(walker, Y) == []
    np.testing.assert_allclose(walker.frames(), before, atol=2e-4)
    np.testing.assert_allclose(walker.place, place, atol=1e-5)
    assert not walker.strain.any()
    assert plant.forces.min() > 30.0


def on_block(ahead: float, high: float, *, probe: float = 1e-3, friction: float = 0.8) -> tuple[Walker, TracedPlant]:
    """A robot in contact dynamics that has lifted its Y-frame, 50 mm, with a block `ahead` of where its first foot was [m]."""
    x, y = ROBOT.feet()[Y, 0]
    block = Block(x_min=x + ahead, x_max=x + ahead + 0.3, y_min=y - 0.05, y_max=y + 0.05, height=high)
    ground = Ground(name="edge", friction=friction, blocks=(block,))
    plant = TracedPlant(WalkerSim(ROBOT, ground, WalkerFlaws()))
    walker = Walker(ROBOT, plant, settings=WalkSettings(probe=probe, clear=None))
    walker.start(np.zeros(6), np.zeros(3), np.full((2, 3), ROBOT.legs.nominal))
    motions.find_ground(walker)
    motions.level(walker)
    motions.lift(walker, Y)
    return walker, plant


@pytest.mark.parametrize(
    ("share", "slips"),
    [(-0.5, False), (0.3, False), (0.5, True), (0.6, True), pytest.param(0.85, True, marks=pytest.mark.slow)],
)
def test_a_foot_near_an_edge_holds_or_slips_off_in_the_trial_never_later(share: float, slips: bool) -> None:
    # a ball beside an edge touches it where its surface is inclined by asin(share); friction and the push to the side, 20 N or so on
    # 130 to 220 N, allow 30 to 33 deg
    walker, plant = on_block(AHEAD + share * BALL, HIGH)
    motions.slide(walker, Y, walker.frames()[Y] + (AHEAD, 0.0, 0.0))
    motions.lower(walker, walker.of_frame(Y))
    prove(walker, Y)
    proved, true = len(plant.trace().time), plant.truth()
    assert true is not None
    height = 0.0 if slips else HIGH - BALL * (1.0 - math.sqrt(1.0 - max(0.0, share) ** 2))
    assert true.feet[Y, 0, 2] == pytest.approx(height, abs=1.5e-3)  # it sinks in by up to that
    motions.lift(walker, DELTA)
    motions.slide(walker, DELTA, walker.frames()[DELTA] + (AHEAD, 0.0, 0.0))
    walked = plant.trace()
    assert walked.margins.min() > 0.05  # in the trial, too
    heights = walked.feet[proved:, Y, 0, 2]
    assert heights.max() - heights.min() < 1.5e-3  # of load, not of slipping
    assert np.degrees(walked.tilts[proved:].max()) < 0.1


def test_a_foot_that_slips_under_trial_is_named() -> None:
    walker, _ = on_block(AHEAD + 0.5 * BALL, HIGH)
    motions.slide(walker, Y, walker.frames()[Y] + (AHEAD, 0.0, 0.0))
    motions.lower(walker, walker.of_frame(Y))
    assert prove(walker, Y) == [3]


def test_a_wall_that_no_leg_is_short_enough_for_ends_the_slide() -> None:
    walker, plant = on_block(0.03, 0.2)
    start = walker.frames()[Y].copy()
    with pytest.raises(RefusedError, match="leg 1 of the Y-frame runs against ground"):
        motions.slide(walker, Y, start + np.array((AHEAD, 0.0, 0.0)))
    true = plant.truth()
    assert true is not None
    assert 0.02 < walker.frames()[Y, 0] - start[0] < 0.04  # it stopped there
    assert abs(math.degrees(true.pose[3])) < 0.2
    assert plant.trace().margins.min() > 0.05


def test_a_lifted_foot_that_runs_against_a_wall_is_drawn_up_over_it() -> None:
    # feet are lifted by 15 mm where the ground was even so far
    walker, plant = on_block(0.03, 0.03)
    motions.slide(walker, Y, walker.frames()[Y] + (AHEAD, 0.0, 0.0))
    true = plant.truth()
    assert true is not None
    assert true.feet[Y, 0, 2] > 0.03
    np.testing.assert_allclose(walker.frames()[Y, :2], true.pose[:2] + true.place[:2], atol=1e-3)  # heading is 0
    assert abs(math.degrees(true.pose[3])) < 0.1
    assert plant.trace().margins.min() > 0.05
