"""Rows of the benchmark on the walker's geometry."""

import math

from clamber.benchmarks.control_speed import region_rows
from clamber.families.walker.robot import WalkerRobot
from clamber.tasks.robots import load_robot


def test_every_row_has_a_time() -> None:
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    rows = region_rows(robot, rounds=1)
    assert len({row.name for row in rows}) == len(rows) == 5
    assert all(math.isfinite(row.value) and row.value > 0.0 for row in rows)
