"""Courses: a plan as steps, laid out from where the robot stands, and carried out."""

import math
import re

import numpy as np
import pytest
from spring_walks import ROBOT, stood
from springs_walker import flat

from clamber.execution.sequencer import Sequencer
from clamber.families.walker.control.gait import Limits
from clamber.families.walker.control.track import straight
from clamber.families.walker.execution.footstep_plan import PlannedCourse, PlannedStep, TrackCourse
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.execution.walking import Walking
from clamber.families.walker.planning.problem import WalkerProblem, walker_table
from clamber.families.walker.planning.task import WalkerTask
from clamber.families.walker.robot.plane_poses import compose, seen_from
from clamber.families.walker.trials.planned import plan_start, planned_steps
from clamber.planning.problem.codes import MOVE, NONE, RELEASE, pack
from clamber.tasks import load_task

FORTH, BACK, LEFT, TURN = (pack(MOVE, 0, axis) for axis in (0, 1, 2, 4))
SWAP = pack(RELEASE)
WALK = [FORTH, FORTH, LEFT, TURN, SWAP, FORTH, FORTH, FORTH, SWAP, SWAP, FORTH, BACK, pack(NONE), FORTH]


def replayed(codes: list[int], *changes: str):  # type: ignore[no-untyped-def]
    task = load_task("patch-walk", ("ground.patches=[]", "start.theta=10 deg", *changes))
    assert isinstance(task, WalkerTask)
    return WalkerProblem(task, walker_table(), threads=1).replay(np.array(codes, np.int32))


def test_a_step_is_what_lies_between_two_swaps_and_bends_where_the_action_changes() -> None:
    replay = replayed(WALK)
    assert replay.ok
    steps = planned_steps(np.array(WALK, np.int32), replay)
    assert [step.swing for step in steps] == [1, 0, 0]  # Y is lifted first; Y lifts and lands where it was: no step
    assert [len(step.corners) for step in steps] == [3, 1, 3]
    turned = np.array((0.04, 0.02, math.radians(6.0)))
    assert steps[0].corners[-1] == pytest.approx(replay.stances[0]["pose"][1] + turned, abs=1e-12)
    assert steps[0].stands == pytest.approx(replay.stances[0]["pose"][0], abs=1e-12)
    assert steps[1].stands == pytest.approx(steps[0].corners[-1], abs=1e-12)
    assert steps[-1].corners[-1] == pytest.approx(replay.stances[-1]["pose"][0], abs=1e-12)


def test_a_plan_is_laid_out_from_where_the_robot_stands() -> None:
    replay = replayed(WALK)
    steps, start = planned_steps(np.array(WALK, np.int32), replay), plan_start(replay)
    here = np.array((1.0, -2.0, 2.0))
    course = PlannedCourse(steps, start, here, radius=0.2)
    end = replay.stances[-1]["pose"][0]
    assert seen_from(here, course.goal) == pytest.approx(seen_from(start, end), abs=1e-12)
    assert course.length == pytest.approx(0.08, abs=1e-12) and not course.done


@pytest.mark.slow
def test_a_planned_walk_comes_to_the_plans_end() -> None:
    codes = [FORTH] * 3 + [SWAP] + [FORTH] * 3 + [SWAP] + [TURN, LEFT, SWAP, LEFT, TURN]
    replay = replayed(codes)
    assert replay.ok
    steps, start = planned_steps(np.array(codes, np.int32), replay), plan_start(replay)
    walker, plant = stood(flat)
    sequencer = Sequencer(Walking(walker, lambda pose: PlannedCourse(steps, start, pose, radius=0.2384)))
    began = walker.frames()[0].copy()
    report = sequencer.run()
    assert report.done, report.reason
    assert [step.frame for step in report.steps] == ["Y", "Delta", "Y", "Delta"]
    goal = compose(began, seen_from(start, replay.stances[-1]["pose"][0]))
    assert report.goal[:2] == pytest.approx(goal[:2], abs=1e-3)
    assert report.missed is not None and report.missed[0] < 0.003 and report.missed[1] < math.radians(0.2)
    assert plant.dragged < 1e-3


def test_a_planned_step_is_not_tried_from_elsewhere() -> None:
    walker, _ = stood(flat)
    standing = walker.frames()[0] + np.array((0.03, 0.0, 0.0))
    step = PlannedStep(1, walker.frames()[1:] + np.array((0.02, 0.0, 0.0)), standing)
    course = PlannedCourse([step], walker.frames()[0], walker.frames()[0], radius=ROBOT.legs.radius_y)
    assert course.next(walker) is None
    assert course.obstacle(walker) == (
        "the Delta-frame stands 30 mm and 0.0 deg from where the plan has it; 20 mm and 1.1 deg are allowed"
    )


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        (Limits(reserve=0.12), r"for the Delta-frame [\d.]+ mm are missing to the actuators' strokes"),
        (Limits(balance=0.15), r"with the Y-frame lifted the centre of mass is \d+ mm inside .* and 150 mm are kept"),
    ],
)
def test_a_frame_that_cannot_go_on_says_which_limit_keeps_it(limits: Limits, words: str) -> None:
    walker, _ = stood(flat, settings=WalkSettings(limits=limits))
    course = TrackCourse(straight(walker.frames()[0], 0.0, 1.0, ROBOT.legs.radius_delta))
    assert course.next(walker) is None
    assert re.search(words, course.obstacle(walker)), course.obstacle(walker)
