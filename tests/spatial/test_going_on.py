"""Robots in space that go on after what ended runs before: a joint that fails, a hold that is gone, a foot that slides."""

from dataclasses import replace

import numpy as np
import pytest
from standing import STIFF, Standing

from clamber.control.whole_body.tree import Dynamics, State
from clamber.control.whole_body.tree_kernels import work_out
from clamber.execution.fault import Fault
from clamber.families.spatial.control.believed_tree import believed_tree
from clamber.families.spatial.execution.centred_loads import LoadCentre
from clamber.families.spatial.execution.course import Course, Regrab
from clamber.families.spatial.execution.plant import Pose
from clamber.families.spatial.execution.replanning import task_from_here, widened, without_limb
from clamber.families.spatial.execution.sensors import sensor_names
from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.sim.spatial_flaws import Deviations
from clamber.families.spatial.trials.planning import careful
from clamber.families.spatial.trials.run_plan import Control, SpatialRun, run_plan
from clamber.planning.planners import plan_task
from clamber.planning.problem.plan import Plan
from clamber.tasks.library import load_task
from clamber.types import Floats

LOCKABLE = ("handrails-triped", "rubble-hexapod")
"""Robots whose files state brakes, and which stand with a limb less."""


def planned(name: str, *settings: str, need: float = 0.05) -> tuple[SpatialTask, Plan]:
    task = load_task(name, settings)
    assert isinstance(task, SpatialTask)
    found = plan_task(careful(task, need), "beam")
    assert found.has_plan, found.reason
    return task, found.plan


def replan(task: SpatialTask) -> Plan | None:
    from clamber.errors import SpecError

    try:
        found = plan_task(task, "beam")
    except SpecError:
        return None
    return found.plan if found.has_plan else None


def carried(task: SpatialTask, plan: Plan, fault: Fault | None = None, frictions: Floats | None = None) -> SpatialRun:
    true = replace(Deviations.none(task.robot, task.world), fault=fault)
    if frictions is not None:
        true = replace(true, frictions=frictions)
    return run_plan(task, plan, deviations=true, control=Control(replan=replan))


def fault_in(task: SpatialTask, kind: str, where: str, start: float, size: float = 1.0) -> Fault:
    return Fault(kind=kind, start=start, size=size, channel=sensor_names(task.robot).index(where), where=where, seed=3)


@pytest.mark.parametrize("share", [0.9, 1.5])
def test_a_brake_holds_what_its_motor_can_give_and_no_more(share: float) -> None:
    """Of a limb in the air, against a long soft spring; its motor is asked for all that it has, too, and gives nothing."""
    at = Standing("handrails-triped")
    plant, joint = at.plant, 2
    for limb in range(3):
        plant.grip(limb, limb > 0)
    plant.step()
    plant.brake(joint)
    started, largest = float(plant.truth().joints[0, joint]), float(at.limits[joint])
    mine = plant.model.joint(at.robot.chains.joint_names[0][joint])
    plant.model.jnt_stiffness[mine.id] = largest / 100.0
    plant.model.qpos_spring[mine.qposadr[0]] = started + 100.0 * share
    for _ in range(20):
        torques = at.limits * np.clip(STIFF * (at.joints - plant.sense().joints[0]), -1.0, 1.0)
        torques[joint] = -largest
        plant.actuate(torques)
        plant.step()
        assert plant.truth().torques[joint] == 0.0
    moved = abs(float(plant.truth().joints[0, joint]) - started)
    assert (moved < 1e-4) == (share < 1.0), moved


@pytest.mark.slow
@pytest.mark.parametrize("name", LOCKABLE)
def test_a_robot_with_a_folded_limb_weighs_the_same_and_its_course_is_the_whole_robots(name: str) -> None:
    """Tips and centre of mass of the planned stances are those of the whole robot in the widened ones."""
    task = load_task(name)
    assert isinstance(task, SpatialTask)
    whole = task.robot.chains
    limb = whole.limb_names[1]
    posture = whole.nominal[whole.used]
    names = [joint for one in whole.joint_names for joint in one]
    rest_of = without_limb(task, limb, {joint: float(posture[names.index(joint)]) for joint in whole.joint_names[1]})
    assert rest_of is not None
    chains = rest_of.robot.chains
    assert chains.limb_names == tuple(one for one in whole.limb_names if one != limb)
    assert chains.total_mass == pytest.approx(whole.total_mass, rel=1e-12)
    assert np.array_equal(chains.base_half, whole.base_half)
    goal = rest_of.start.along + 2.0 * rest_of.step.length
    rest_of = replace(rest_of, goals=(replace(rest_of.goals[-1], along_min=goal),))
    plan = replan(rest_of)
    assert plan is not None
    course = Course.of(rest_of, plan)
    wide = widened(course, chains, whole, posture)
    small, large = believed_tree(rest_of.robot, task.world.gravity), believed_tree(task.robot, task.world.gravity)
    kept = [whole.limb_names.index(one) for one in chains.limb_names]
    for few, all_of in zip(course.motions, wide.motions, strict=True):
        looks = []
        for tree, at in ((small, few.start), (large, all_of.start)):
            state, work = State.of(tree), Dynamics.of(tree)
            state.rotation[:], state.position[:], state.joints[:] = at.pose.rotation, at.pose.position, at.joints
            work_out(tree, state, work)
            looks.append((work.tip, work.weight[:6], at.holds, at.loads))
        (tips, weight, holds, loads), (all_tips, whole_weight, all_holds, all_loads) = looks
        assert np.allclose(tips, all_tips[kept], atol=1e-9)
        assert np.allclose(weight, whole_weight, atol=1e-9)  # force and moment about the base's origin
        assert np.array_equal(holds, all_holds[kept]) and all_holds[1] == -1
        assert np.array_equal(loads, all_loads[kept]) and not all_loads[1].any()
        if isinstance(all_of, Regrab):
            assert whole.limb_names[all_of.limb] in chains.limb_names


def test_a_robot_of_one_limb_is_left_without_any() -> None:
    task = load_task("truss-inchworm")
    assert isinstance(task, SpatialTask)
    chains = task.robot.chains

    def places(limb: int) -> dict[str, float]:
        return dict.fromkeys(chains.joint_names[limb], 0.0)

    left = without_limb(task, chains.limb_names[0], places(0))
    assert left is not None
    assert without_limb(left, chains.limb_names[1], places(1)) is None


@pytest.mark.slow
def test_a_joint_whose_sensor_fails_is_locked_and_the_robot_goes_on_with_its_other_limbs() -> None:
    """The clamp triped, in the swing of another limb: that limb goes back, the one with the joint is folded, two are left."""
    task, plan = planned("handrails-triped", "goal.along_min=3 m", need=0.2)
    run = carried(task, plan, fault_in(task, "nan", "A_2", 20.0, 1e4))
    assert run.done, run.reason
    (new,) = run.report.replans
    assert new.locked == ["A_2"] and not new.missed
    after = [one for one in run.report.motions if one.start > 20.5]
    assert {one.limb for one in after} == {"B", "C", None}
    assert run.report.motions[new.after].outcome == "fault"
    assert run.report.findings[-1].where == "A_2" and run.report.ending == ""


@pytest.mark.long
@pytest.mark.parametrize(("kind", "where"), [("dead", "LR_2"), ("stuck", "RF_3")])
def test_a_hexapod_goes_on_with_five_legs(kind: str, where: str) -> None:
    task, plan = planned("rubble-hexapod", "goal.along_min=0.4 m")
    run = carried(task, plan, fault_in(task, kind, where, 5.0))
    assert run.done, run.reason
    assert [one.locked for one in run.report.replans] == [[where]]
    assert run.trace.true_holds is not None
    at = task.robot.limb_names.index(where[:2])
    assert (run.trace.true_holds[-200:, at] == 0).all()


def test_joints_without_brakes_end_the_run_as_before() -> None:
    task, plan = planned("wall-gripper", "goal.along_min=0.3 m", need=0.2)
    run = carried(task, plan, fault_in(task, "nan", "LF_2", 2.5, 1e4))
    assert not run.done and run.reason.startswith("fault: LF_2: no number")
    assert run.report.ending == "held" and not run.report.replans


@pytest.mark.slow
def test_where_a_hold_is_gone_another_one_near_it_is_taken() -> None:
    """While the body moves a grip breaks that bears a weight of 100 g: once the run ended there."""
    task, plan = planned("wall-gripper", "goal.along_min=0.4 m", need=0.2)
    taken = next(one for one in Course.of(task, plan).motions if isinstance(one, Regrab))
    hold = taken.hold + 1
    nominal = carried(task, plan)
    moves = next(one for one in nominal.report.motions if one.limb is None and one.first > taken.first)
    run = carried(task, plan, Fault(kind="hold", start=moves.start + 0.2, size=1.0, channel=hold, where="", seed=3))
    assert run.done, run.reason
    (new,) = run.report.replans
    assert hold in new.missed
    lost = next(one for one in run.report.motions if one.outcome == "missed")
    assert lost.limb is None and f"came off hold {hold}" in lost.reason
    assert all(one.hold != hold for one in run.report.motions if one.start > lost.start)


@pytest.mark.slow
def test_a_start_from_there_names_the_holds_of_the_limbs_that_are_left() -> None:
    task, plan = planned("handrails-triped", "goal.along_min=1 m", need=0.2)
    at = Course.of(task, plan).motions[1].start
    whole = task.robot.chains
    left = without_limb(task, "A", dict.fromkeys(whole.joint_names[0], 0.0))
    assert left is not None
    start = task_from_here(left, at, set(), whole.limb_names)
    assert start is not None and start.start.holds == {
        name: int(at.holds[whole.limb_names.index(name)]) + 1 for name in ("B", "C")
    }


@pytest.mark.slow
def test_a_foot_that_slides_off_an_icy_stone_no_longer_ends_the_walk() -> None:
    """With a twentieth of the friction of one stone the walk once ended as `drift`, in a fall."""
    task, plan = planned("stones-quadruped", "goal.along_min=0.8 m")
    taken = [one for one in Course.of(task, plan).motions if isinstance(one, Regrab)]
    slid = False
    for regrab in taken[:3]:
        frictions = np.ones(len(task.world.holds))
        frictions[regrab.hold] = 0.05
        run = carried(task, plan, frictions=frictions)
        assert run.done, (regrab.hold, run.reason)
        slid = slid or any(one.kind == "slide" for one in run.report.findings)
    assert slid


def test_who_bears_a_robot_is_judged_as_the_planner_does() -> None:
    """All limbs of a stance do, the others of each swing do, and two feet on one side of a quadruped do not."""
    for name in ("wall-gripper", "stones-quadruped"):
        task, plan = planned(name, "goal.along_min=0.3 m")
        centre = LoadCentre(task.robot, task.world)
        for motion in Course.of(task, plan).motions:
            at = motion.start
            assert centre.bears(at.pose, at.joints, at.holds, 1.0)
            if isinstance(motion, Regrab):
                others = at.holds.copy()
                others[motion.limb] = -1
                assert centre.bears(at.pose, at.joints, others, 1.0)
    side = at.holds.copy()
    side[[one.startswith("F") for one in task.robot.limb_names]] = -1
    pose = Pose(at.pose.rotation, at.pose.position)
    assert not centre.bears(pose, at.joints, side, 1.0)
    assert not centre.bears(pose, at.joints, np.full_like(side, -1), 1.0)
