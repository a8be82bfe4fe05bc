"""What is odd about robots, boards, grounds and tasks: found where it is, and nowhere else."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.families.climber.inspection import inspect_board, inspect_climber, reach_of
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.world.board import Board, Hold
from clamber.families.walker.inspection import inspect_ground, inspect_walker
from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.world.ground import load_ground
from clamber.inspection.open_file import inspect_file, inspect_task
from clamber.planning.problem.problems import pose_problem
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot
from clamber.units import DEGREE, GRAVITY


def climber() -> LimbedRobot:
    robot = load_robot("gecko4")
    assert isinstance(robot, LimbedRobot)
    return robot


def changed(limb: int = 0, **values: object) -> LimbedRobot:
    """The climber with one limb changed."""
    robot = climber()
    limbs = list(robot.limbs)
    limbs[limb] = replace(limbs[limb], **values)  # type: ignore[arg-type]
    return replace(robot, limbs=tuple(limbs))


@given(
    st.floats(0.05, 0.3), st.floats(0.05, 0.3), st.floats(0.0, 0.1), st.floats(-1.5, 1.5), st.floats(-3.0, 0.0), st.floats(0.1, 3.0)
)  # fmt: skip
def test_reach_is_that_of_every_angle_within_the_limits(
    l1: float, l2: float, offset: float, angle: float, low: float, span: float
) -> None:
    limb = climber().limbs[0]
    end = replace(limb.end, offset=offset, angle=angle)
    limb = replace(limb, l1=l1, l2=l2, end=end, elbow=replace(limb.elbow, lower=low, upper=low + span))
    angles = np.linspace(low, low + span, 4001)
    distances = [abs(l1 + (l2 + offset * cmath.exp(1j * angle)) * cmath.exp(1j * bend)) for bend in angles]
    least, most = reach_of(limb)
    assert least == pytest.approx(min(distances), abs=1e-5)
    assert most == pytest.approx(max(distances), abs=1e-5)


@pytest.mark.parametrize("name", ["gecko4", "libra", "libra-grippers", "hoshino"])
def test_nothing_is_odd_about_the_robots_that_come_with_it(name: str) -> None:
    assert inspect_file(name, "robot").odd == ()


def test_an_elbow_that_cannot_be_straight_is_odd() -> None:
    limb = climber().limbs[0]
    odd = inspect_climber(changed(elbow=replace(limb.elbow, lower=60 * DEGREE))).odd
    reach = abs(limb.l1 + limb.second_link * cmath.exp(1j * 60 * DEGREE))
    assert len(odd) == 1 and f"leave it {reach:.3g} m of {limb.length:.3g} m" in odd[0]


def test_a_limb_too_short_for_its_neighbour_is_odd() -> None:
    odd = inspect_climber(changed(l1=0.05, l2=0.05)).odd
    assert (
        len(odd) == 1
        and "is short: it reaches 0.12 m, and the port of 'upper-left', the nearest, is 0.16 m away" in odd[0]
    )


def test_a_weak_limb_is_odd_from_the_torque_of_half_the_weight_on() -> None:
    robot = climber()
    needed = 0.25 * robot.weight * robot.limbs[0].length
    joint = robot.limbs[0].shoulder
    assert not inspect_climber(changed(shoulder=replace(joint, torque_limit=needed * 1.001))).odd
    odd = inspect_climber(changed(shoulder=replace(joint, torque_limit=needed * 0.999))).odd
    assert len(odd) == 1 and "is weak" in odd[0]


def test_links_that_are_most_of_the_weight_are_odd() -> None:
    robot = climber()
    mass = 0.51 * robot.weight / GRAVITY - 3 * 0.2
    odd = inspect_climber(changed(link_masses=(mass / 2, mass / 2))).odd
    assert odd == ("the links are 51 % of the weight, but statics takes all of it at the body's origin",)


def test_narrow_joints_and_missing_inertia_are_odd() -> None:
    joint = climber().limbs[0].shoulder
    assert any(
        "10 deg only" in line
        for line in inspect_climber(changed(shoulder=replace(joint, lower=-5 * DEGREE, upper=5 * DEGREE))).odd
    )
    assert any("has no inertia" in line for line in inspect_climber(changed(shoulder=replace(joint, inertia=0.0))).odd)
    aside = inspect_climber(changed(shoulder=replace(joint, lower=20 * DEGREE))).odd
    assert len(aside) == 1 and "can't point straight out" in aside[0]


def test_frames_that_cannot_stand_over_each_other_are_odd() -> None:
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    long = replace(robot, mechanism=replace(robot.mechanism, shortest=2.0))
    assert any("can't stand over each other" in line for line in inspect_walker(long).odd)


def board(points: list[tuple[float, float]], keep_out: tuple = ()) -> Board:
    holds = tuple(Hold(number=k, x=x, y=y, radius=0.005) for k, (x, y) in enumerate(points, start=1))
    return Board(name="b", title="", holds=holds, keep_out=keep_out)


GRID = [(0.1 * i, 0.1 * j) for i in range(4) for j in range(4)]


def test_a_hold_far_from_all_others_is_odd() -> None:
    assert inspect_board(board(GRID)).odd == ()
    odd = inspect_board(board([*GRID, (3.0, 0.0)])).odd
    assert len(odd) == 1 and odd[0].startswith(
        "hold 17 lies far from all others, 2.7 m where holds usually are 0.1 m apart"
    )


@given(st.floats(-math.pi, math.pi))
def test_holds_inside_a_region_to_keep_out_of_are_odd_however_it_is_turned(turn: float) -> None:
    c, s = math.cos(turn), math.sin(turn)
    corners = tuple(
        (0.15 + c * x - s * y, 0.15 + s * x + c * y)
        for x, y in ((-0.08, -0.08), (0.08, -0.08), (0.08, 0.08), (-0.08, 0.08))
    )
    odd = inspect_board(board(GRID, (corners,))).odd
    near = [
        (x, y)
        for x, y in GRID
        if abs(c * (x - 0.15) + s * (y - 0.15)) < 0.08 and abs(c * (y - 0.15) - s * (x - 0.15)) < 0.08
    ]
    assert len(odd) == (1 if near else 0)
    if len(near) > 1:
        assert odd[0].startswith(f"{len(near)} holds (")


def test_a_slope_steeper_than_friction_and_a_block_off_the_ground_are_odd() -> None:
    ground = load_ground("steps")
    assert inspect_ground(ground).odd == ()
    assert len(inspect_ground(replace(ground, slope=math.atan(ground.friction) + 0.01)).odd) == 1
    assert any("blocks.0 lies beyond" in line for line in inspect_ground(replace(ground, x_max=-5.0)).odd)


def test_margins_of_a_start_are_those_of_the_first_step_that_stays() -> None:
    """An independent way to the same numbers: reach is a distance that a ruler could take."""
    task = load_task("ladder")
    found = {margin.check: margin.margin for margin in inspect_task(task).margins}
    gaps = []
    for limb in task.robot.limbs:  # type: ignore[union-attr]
        hold = task.world.by_number(task.start.holds[limb.name])  # type: ignore[union-attr]
        gaps.append(limb.length - math.hypot(task.start.x + limb.port_x - hold.x, task.start.y + limb.port_y - hold.y))
    assert found["reach"] == pytest.approx(min(gaps), abs=1e-9)


@pytest.mark.parametrize("name", ["chimney-hexapod", "wall-gripper", "ladder"])
def test_the_start_that_is_judged_is_the_one_that_plans_begin_with(name: str) -> None:
    """In a chimney the best of all stances breaks a check that the best of those that may be does not."""
    task = load_task(name)
    start = pose_problem(task).problem.start
    found = {margin.check: margin for margin in inspect_task(task).margins}
    assert all(margin.holds for margin in found.values() if margin.hard)
    if "share" in start.dtype.names:
        assert found["equilibrium"].margin == pytest.approx(float(start["share"][0]) - task.rules.need, abs=1e-9)  # type: ignore[attr-defined]


def test_what_is_odd_about_a_task() -> None:
    assert any("the start meets the goal" in line for line in inspect_task(load_task("ladder", ["goal.y_min=0m"])).odd)
    hook = load_task("gecko-climb", ['rules.hard=["reach"]'])
    assert any("'hook'" in line for line in inspect_task(hook).odd)
    assert any(
        "'keep_out' only reports" in line
        for line in inspect_task(load_task("overhang", ['rules.hard=["reach","hook"]'])).odd
    )
    assert "no check is hard: any action is allowed" in inspect_task(load_task("ladder", ["rules.hard=[]"])).odd
