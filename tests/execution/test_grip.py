"""Climbing with grippers: a rung with pegs off the map, a miss and a slip that are noticed, and a board that hooks cannot climb."""

import numpy as np
import pytest

from clamber.families.climber.execution.climber import Climber, FallenError
from clamber.families.climber.execution.grabbing import grab, release
from clamber.families.climber.execution.motions import move_body
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.trials.planning import plan_to_climb
from clamber.families.climber.trials.run_plan import climbing_flaws, climbing_task, run_plan
from clamber.families.climber.world.library import load_board
from clamber.planning.planners import find_planner
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot
from clamber.types import Floats

NOMINAL = LimbFlaws(backlash=np.radians(2.0), physics_rate=1000.0, encoder_counts=400, delay=1)
RIGHT, LEFT, BOTTOM = 0, 1, 2
START = np.array((0.2286, 0.1374, 0.0))


def on_the_ladder(pegs: Floats | None = None, map_error: float = 0.004) -> tuple[Climber, ClimberPlant]:
    robot, board = load_robot("libra-grippers"), load_board("ladder")
    assert isinstance(robot, LimbedRobot)
    plant = ClimberPlant(robot, board, NOMINAL, pegs=pegs)
    climber = Climber(robot, board, plant, map_error=map_error)
    climber.start(
        START, {"right": 4, "left": 3, "bottom": 2}, idle="bottom", elbows={"right": -1, "left": 1, "bottom": -1}
    )
    return climber, plant


@pytest.mark.parametrize(("seed", "error"), [(0, 0.0), (3, 0.00635)])
def test_a_rung_is_climbed_and_every_gripper_is_closed_about_its_peg(seed: int, error: float) -> None:
    places = load_board("ladder").positions()
    pegs = places + np.random.default_rng(seed).uniform(-error, error, places.shape)
    pegs[1:4] = places[1:4]  # the robot was put on these
    climber, plant = on_the_ladder(pegs, 0.004 + error)
    climber.wait(0.5)
    for limb, number, elbow in ((RIGHT, 6, -1), (BOTTOM, 1, 1), (LEFT, 5, 1)):
        result = grab(climber, limb, number, elbow=elbow)
        assert result.held, (limb, number, result)
        assert plant.grippers.gripped[limb]
        np.testing.assert_allclose(plant.truth().tips[limb], pegs[number - 1], atol=1e-3)
    release(climber, BOTTOM)
    assert not plant.grippers.gripped[BOTTOM]
    move_body(climber, START + np.array((0.0, 0.1524, 0.0)))
    climber.wait(0.3)
    np.testing.assert_allclose(plant.truth().pose[:2], START[:2] + np.array((0.0, 0.1524)), atol=0.015)
    assert plant.grippers.slips == 0


def test_jaws_that_close_on_nothing_are_a_miss() -> None:
    pegs = load_board("ladder").positions()
    pegs[5] += (0.04, 0.03)  # out of all jaws' reach, and the map does not know
    climber, plant = on_the_ladder(pegs)
    result = grab(climber, RIGHT, 6, elbow=-1)
    assert not result.held
    assert result.tries > 1
    assert not plant.grippers.gripped[RIGHT]
    climber.wait(0.5)  # the others still hold


def test_a_gripper_that_slips_is_noticed() -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    plant.push((0.0, -800.0))
    with pytest.raises(FallenError, match=r"has slipped off|off its aim"):
        climber.wait(3.0)
    assert climber.time < 1.5


def test_hooks_provably_cannot_climb_the_overhang() -> None:
    hooks = climbing_task(load_task("overhang", ["robot=libra"]))
    result = find_planner("exact")(hooks, seconds=120.0)
    assert result.status == "infeasible", result.reason
    assert climbing_task(load_task("overhang")).rules == hooks.rules


def test_grippers_climb_the_overhang_from_start_to_goal_in_dynamics() -> None:
    task = climbing_task(load_task("overhang"))
    plan = plan_to_climb(task, "auto", seconds=60.0, seed=0)
    assert plan is not None
    run = run_plan(task, plan, climbing_flaws(task, []))
    assert run.report.done, run.report.reason
    assert run.report.true_pose is not None
    goal = task.goals[-1].x_min
    assert goal is not None
    assert run.report.true_pose[0] > goal - 0.02
