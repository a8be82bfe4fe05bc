"""The quickest way to a place: by how long steps are, and how many it takes."""

import math
from itertools import pairwise

import numpy as np
import pytest

from clamber.families.walker.control.gait import Limits
from clamber.families.walker.control.track import Track, straight
from clamber.families.walker.execution.footstep_plan import ImaginedWalker
from clamber.families.walker.execution.quickest import quickest_way, walk_seconds
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.robot import WalkerRobot
from clamber.tasks.robots import load_robot

found = load_robot("hoshino")
assert isinstance(found, WalkerRobot)
ROBOT = found
assert ROBOT.arm is not None
RADIUS = ROBOT.legs.radius_delta
AT_ONCE = WalkSettings(limits=Limits(reserve=0.0), ramp=1e-9, settling=1e-9)
WALKER = ImaginedWalker(ROBOT, AT_ONCE, 0.0, np.array(ROBOT.arm.rest), np.zeros((2, 3)))
HERE = np.zeros(3)


def ends_at(twists: tuple[np.ndarray, ...]) -> np.ndarray:
    track = Track.of(HERE, twists, RADIUS)
    return track.pose(track.length)


def test_a_long_walk_goes_at_the_papers_speed() -> None:
    """Feet 20 s, slides at the actuators' speed: 160 mm in a cycle of 73.8 s, 130 mm/min."""
    shorter, longer = (walk_seconds(WALKER, straight(HERE, math.radians(30.0), way, RADIUS)) for way in (1.6, 3.2))
    speed = 1.6 / (longer - shorter)
    assert speed == pytest.approx(0.16 / 73.8, rel=0.01)
    assert 60e3 * speed == pytest.approx(130.0, abs=1.5)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("direction", "distance", "pivots"), [(0.0, 4.0, True), (0.0, 1.0, False), (90.0, 2.0, False), (30.0, 1.0, False)]
)
def test_a_pivot_pays_where_it_makes_steps_longer_often_enough(direction: float, distance: float, pivots: bool) -> None:
    place = distance * np.array((math.cos(math.radians(direction)), math.sin(math.radians(direction))))
    ways = quickest_way(WALKER, place, None)
    assert (abs(ways[0].pivot) == pytest.approx(math.radians(30.0))) == pivots
    assert pivots or ways[0].pivot == 0.0
    assert all(ends_at(way.twists)[:2] == pytest.approx(place, abs=1e-9) for way in ways)
    assert all(a.seconds <= b.seconds < math.inf for a, b in pairwise(ways))


def test_a_heading_is_come_to() -> None:
    ways = quickest_way(WALKER, np.array((0.4, 0.1)), math.radians(40.0))
    assert all(ends_at(way.twists) == pytest.approx((0.4, 0.1, math.radians(40.0)), abs=1e-9) for way in ways)


def test_to_where_it_is_takes_no_time() -> None:
    best = quickest_way(WALKER, np.zeros(2), None)[0]
    assert best.twists == () and best.seconds == 0.0
