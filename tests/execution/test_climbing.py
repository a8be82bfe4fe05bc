"""A plan carried out action by action: a rung, what is refused, what a trace keeps, what becomes of a miss."""

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from clamber.execution.log_files import read_log, write_log
from clamber.execution.sequencer import Sequencer
from clamber.families.climber.execution.climb_trace import ClimbTrace, TracedClimber
from clamber.families.climber.execution.climbing import Climbing, Replan
from clamber.families.climber.execution.executable_plan import PlanRefusedError, climbable, lay_course
from clamber.families.climber.execution.motions import move_body
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.statics.elbows import has_assignment
from clamber.planning.problem.plan import Plan
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks import load_task
from clamber.types import Floats

NOMINAL = LimbFlaws(backlash=np.radians(2.0), physics_rate=1000.0, encoder_counts=400, delay=1)
RUNG = (106, 301, 205, 300, 3, 3)
"""The gait of the thesis: the bottom limb stands on the lower right while the right one climbs, and so on."""


def ladder() -> LimbedTask:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    return task


def plan_of(task: LimbedTask, *numbers: int) -> Plan:
    strict = climbable(task)
    return Plan.of_codes(strict, [thesis_code(strict, number) for number in numbers], planner="by hand")


def climb(task: LimbedTask, plan: Plan, *, replan: Replan | None = None, force: bool = False) -> Climbing:
    plant = ClimberPlant(task.robot, task.world, NOMINAL)
    climber = TracedClimber(task.robot, task.world, plant, map_error=0.006, truth=plant.truth)
    return Climbing(climber, lay_course(task, plan), replan=replan, force=force)


def test_a_rung_is_climbed_and_every_action_is_reported_ok() -> None:
    task = ladder()
    told: list[tuple[int, int, str]] = []
    climbing = climb(task, plan_of(task, *RUNG))
    report = Sequencer(climbing, progress=lambda step, n, title, time: told.append((step, n, title))).run()
    assert report.done, report.reason
    assert [(one.first, one.last, one.kind, one.outcome) for one in report.actions] == [
        (1, 1, "grab", "ok"), (2, 2, "grab", "ok"), (3, 3, "grab", "ok"), (4, 4, "release", "ok"), (5, 6, "move", "ok"),
    ]  # fmt: skip
    assert [step for step, _, _ in told] == [1, 2, 3, 4, 5]
    assert report.true_pose is not None
    np.testing.assert_allclose(report.true_pose, climbing.course.pose(6), atol=0.03)  # two steps up [m], [rad]
    assert report.short == pytest.approx(60 * 0.0254 - report.true_pose[1])
    times = [(one.start, one.start + one.seconds) for one in report.actions]
    assert all(before[1] == pytest.approx(after[0]) for before, after in pairwise(times))
    json.dumps(report.to_json(), allow_nan=False)


def test_elbows_keep_the_side_that_is_open_until_the_limb_leaves() -> None:
    course = lay_course(ladder(), plan_of(ladder(), *RUNG))
    assert course.elbows.shape == (7, 3)
    np.testing.assert_array_equal(course.elbows[:, 0], -1)  # inwards, as the thesis climbs
    np.testing.assert_array_equal(course.elbows[:, 1], 1)
    np.testing.assert_array_equal(course.elbows[:, 2], (-1, -1, 1, 1, 0, 0, 0))
    for step, stance in enumerate(course.stances):
        assert has_assignment(stance["elbows"], sum((course.elbows[step, i] == -1) << i for i in range(3)))


def test_like_moves_in_a_row_go_in_one_way() -> None:
    course = lay_course(ladder(), plan_of(ladder(), 300, 3, 3, 4, 3))
    assert course.groups() == [(1, 1), (2, 3), (4, 4), (5, 5)]


def test_a_plan_that_fails_its_check_is_refused_with_step_and_reason_unless_forced() -> None:
    task = ladder()
    bad = plan_of(task, 300, 3, 3, 3, 3, 3, 3, 3)
    course = lay_course(task, bad)
    first = course.objections[0]
    assert first.step is not None and first.step > 1
    assert "+y" in first.reason
    with pytest.raises(PlanRefusedError, match=rf"step {first.step}: .*--force"):
        climb(task, bad)
    assert f"step {first.step}" in climb(task, bad, force=True).report.forced[0]


def test_a_plan_for_another_board_or_robot_is_refused() -> None:
    task, plan = ladder(), plan_of(ladder(), *RUNG)
    other = load_task("ladder", ["board.ladder.rungs=12"])
    heavy = load_task("ladder", ["weight=45N"])
    for changed, part in ((other, "board"), (heavy, "robot")):
        assert isinstance(changed, LimbedTask)
        with pytest.raises(PlanRefusedError, match=f"another {part}"):
            climb(changed, plan)
    assert climb(task, plan).course.objections == ()


def test_hooks_must_only_pull_though_the_task_lets_them_push() -> None:
    strict = climbable(ladder())
    assert "hook" in strict.rules.hard
    assert (strict.rules.branch, strict.rules.max_hangs) == ("kept", 0)


def test_a_fall_ends_the_run_with_a_reason_and_a_trace_up_to_that_tick() -> None:
    task = ladder()
    plant = ClimberPlant(task.robot, task.world, NOMINAL)
    climber = TracedClimber(task.robot, task.world, plant, map_error=0.006, truth=plant.truth)
    told = lambda step, n, title, time: plant.push((0.0, 400.0) if step == 4 else (0.0, 0.0))  # noqa: E731
    report = Sequencer(Climbing(climber, lay_course(task, plan_of(task, 300, 3, 4, 3, 4))), progress=told).run()
    assert not report.done
    assert report.reason.startswith("fell: ")
    assert report.actions[-1].outcome == "fell"
    assert report.actions[-1].first == 4
    trace = climber.trace(report.to_json())
    assert trace.time[-1] == pytest.approx(report.seconds)
    assert trace.step[-1] == 4
    assert np.all(np.diff(trace.time) > 0.0)


def test_ctrl_c_ends_the_run_and_keeps_what_there_is() -> None:
    task = ladder()

    def stop(step: int, *_: object) -> None:
        if step == 2:
            raise KeyboardInterrupt

    climbing = climb(task, plan_of(task, 300, 3, 4))
    report = Sequencer(climbing, progress=stop).run()
    assert (report.done, report.reason, len(report.actions)) == (False, "interrupted", 1)
    assert climbing.climber.trace().time[-1] == pytest.approx(report.seconds)


def test_a_trace_comes_back_from_its_log(tmp_path: Path) -> None:
    task = ladder()
    climbing = climb(task, plan_of(task, 300))
    report = Sequencer(climbing).run()
    trace = climbing.climber.trace(report.to_json())
    write_log(trace.to_log(), tmp_path / "climb.mcap", "climb")
    back = ClimbTrace.from_log(read_log(tmp_path / "climb.mcap"))
    assert back.limbs == ("right", "left", "bottom")
    assert back.notes == json.loads(json.dumps(report.to_json()))
    arrays = ("time", "step", "believed", "aim", "angles", "torques", "holds", "carries", "true_pose", "true_angles")
    for name in arrays:
        np.testing.assert_array_equal(getattr(back, name), getattr(trace, name), err_msg=name)
    assert trace.holds[0].tolist() == [4, 3, 2]
    assert trace.holds[-1].tolist() == [4, 3, 0]
    silent = replace(trace, true_pose=None, true_angles=None, notes=None)
    assert ClimbTrace.from_log(silent.to_log()).true_pose is None


@pytest.mark.parametrize(("worse", "stays"), [(0.0, True), (1.0, False)])
def test_a_limb_takes_its_hold_from_near_the_plans_pose_only_where_the_others_hold_no_worse(
    worse: float, stays: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    task = ladder()
    climbing = climb(task, plan_of(task, 106))
    climber = climbing.climber
    planned = climbing.course.pose(1)

    def start_off() -> None:
        """With the body 20 mm above the plan's pose, where the others are said to hold worse by some newtons."""
        begin()
        move_body(climber, planned + np.array((0.0, 0.02, 0.0)))

    def stands(pose: Floats, _: object = None) -> float:
        return -worse if pose[1] > planned[1] + 0.01 else 0.0

    begin = climbing.start
    monkeypatch.setattr(climbing, "start", start_off)
    monkeypatch.setattr(climber.body, "stands", stands)
    report = Sequencer(climbing).run()
    assert [one.outcome for one in report.actions] == ["ok"]
    assert climber.body.aim[1] - planned[1] == pytest.approx(0.02 if stays else 0.0, abs=1e-6)


def test_where_a_hold_cannot_be_had_another_plan_is_asked_for_from_there() -> None:
    task = ladder()
    asked: list[LimbedTask] = []

    def replan(here: LimbedTask) -> Plan:
        asked.append(here)
        return Plan.of_codes(here, [thesis_code(here, 104)])

    climbing = climb(task, plan_of(task, 106), replan=replan)
    climbing.climber.holds[6] = np.array((3.0, 3.0))  # the robot believes it out of reach
    report = Sequencer(climbing).run()
    assert [one.outcome for one in report.actions] == ["missed", "ok"]
    assert report.done
    assert 6 not in [hold.number for hold in asked[0].world.holds]
    held = asked[0].start.holds
    assert held["left"] == 3
    assert report.replans[0].without == [6]
