"""A point of the world held by the tool while the body goes past it."""

import numpy as np
import pytest
from walkers import hoshino

from clamber.families.walker.control.cooperative.cooperator import Cooperator
from clamber.families.walker.control.cooperative.freedoms import weights_of
from clamber.families.walker.control.cooperative.holding import ToolHolder, reachable_part
from clamber.families.walker.control.cooperative.planted_feet import PlantedFeet
from clamber.families.walker.control.cooperative.settings import Cooperation, own_speeds
from clamber.types import Floats

POINT = np.array([0.0, 0.30, 0.45])


def way(count: int, half: float = 1.0, height: float = 0.36) -> Floats:
    """Straight along x past the point, level."""
    poses = np.zeros((count, 6))
    poses[:, 0] = np.linspace(-half, half, count)
    poses[:, 2] = height
    return poses


def farthest_reach() -> float:
    """Half the chord of the outer bound: the arm stretched, and joints in range there."""
    arm = hoshino().arm
    assert arm is not None
    over = POINT[2] - 0.36 - arm.up
    radius = arm.out + np.sqrt(sum(arm.links) ** 2 - over**2)
    return float(np.sqrt(radius**2 - POINT[1] ** 2))


@pytest.mark.slow
def test_the_part_of_a_way_where_a_point_can_be_held_ends_where_the_arm_is_stretched() -> None:
    found = reachable_part(hoshino(), way(41), POINT)
    assert len(found.parts) == 1
    first, last = (-1.0 + 0.05 * place for place in found.parts[0])
    assert first == pytest.approx(-farthest_reach(), abs=2e-5)
    assert last == pytest.approx(farthest_reach(), abs=2e-5)


@pytest.mark.slow
def test_a_line_that_goes_along_with_the_body_can_be_reached_as_far_as_one_likes() -> None:
    """At each pose its own place, always beside the body; and a line that runs away ends where the stretched arm does."""
    poses = way(21)
    beside = np.column_stack([poses[:, 0], np.full(21, POINT[1]), np.full(21, POINT[2])])
    assert reachable_part(hoshino(), poses, beside).parts == ((0.0, 20.0),)
    half = farthest_reach()
    twice = beside + np.column_stack(
        [poses[:, 0], np.zeros((21, 2))]
    )  # as far again ahead of the body as that has come
    (part,) = reachable_part(hoshino(), poses, twice).parts
    np.testing.assert_allclose((-1.0 + 0.1 * part[0], -1.0 + 0.1 * part[1]), (-half, half), atol=2e-5)


def test_a_point_too_near_the_arms_axis_parts_the_way_in_two() -> None:
    """A point low beside the robot that the arm's folded links cannot come to, or one out of reach throughout."""
    nowhere = reachable_part(hoshino(), way(11), np.array([0.0, 2.0, 0.4]))
    assert nowhere.parts == ()
    assert (nowhere.distances > 1.0).all()
    everywhere = reachable_part(hoshino(), way(5, half=0.1), POINT)
    assert everywhere.parts == ((0.0, 4.0),)


def test_the_tool_stays_while_the_body_goes_past() -> None:
    """Over the reachable part at the paper's walking speed, with joints within range and speed, and then it is lost gently."""
    robot = hoshino()
    arm = robot.arm
    assert arm is not None
    half = farthest_reach() - 0.02
    speed, period = 0.130 / 60.0 * 4.0, 0.02  # four times the paper's: a slide's pace
    count = round(2 * half / (speed * period)) + 1
    poses = way(count, half=half)
    found = reachable_part(robot, way(5, half=half), POINT)
    assert found.parts == ((0.0, 4.0),)
    settings = Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.2), gain=0.5, period=period)
    law = Cooperator(robot, settings, PlantedFeet(robot=robot, support="y", pose=poses[0]), "arm")
    holder = ToolHolder(law, np.concatenate([poses[0], found.joints[0]]))
    weights = weights_of("arm", 4)
    worst, last = 0.0, holder.q.copy()
    for pose in poses:
        holder.step(pose, POINT, weights)
        worst = max(worst, float(np.linalg.norm(law.place(holder.q) - POINT)))
        assert (np.abs(holder.q - last)[6:] <= 0.35 * period * (1 + 1e-9)).all()
        assert ((holder.q[6:] >= arm.lowest) & (holder.q[6:] <= arm.highest)).all()
        last = holder.q.copy()
    assert worst < 1e-4


def test_a_free_height_of_the_body_serves_the_tool_too() -> None:
    """Just out of the arm's own reach, the legs' stroke makes up what is missing."""
    robot = hoshino()
    poses = way(200, half=0.0)
    point = np.array([0.0, 0.30, 0.36 + 0.15 + 0.75])  # 37 mm higher than the arm reaches there
    stance = PlantedFeet(robot=robot, support="delta", pose=poses[0])
    settings = Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.2), gain=0.0)
    ends = {}
    for freedoms in ("arm", "height"):
        law = Cooperator(robot, settings, stance)
        holder = ToolHolder(law, np.concatenate([poses[0], [1.5, 1.2, 0.2, 0.1]]))
        for _ in range(10):
            for pose in poses:
                holder.step(pose, point, weights_of(freedoms, 4))
        ends[freedoms] = float(np.linalg.norm(law.place(holder.q) - point))
    assert ends["arm"] > 0.02
    assert ends["height"] < 1e-4
