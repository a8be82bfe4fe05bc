"""Plans of robots in space carried out: contact dynamics, holds that come off, holds that are not there."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from clamber.cli import main
from clamber.control.whole_body.programme import SWINGS
from clamber.control.whole_body.tree import FREE
from clamber.errors import SpecError
from clamber.execution.sequencer import Sequencer
from clamber.families.spatial.control.believed_tree import believed_tree
from clamber.families.spatial.control.laws import BODY_LAWS, USUAL
from clamber.families.spatial.control.turn_kernels import write_axes
from clamber.families.spatial.dynamics import DYNAMICS
from clamber.families.spatial.execution.carrying import Carrying
from clamber.families.spatial.execution.course import BodyMotion, Course, Regrab, Standing
from clamber.families.spatial.execution.estimated_base import EstimatedBase
from clamber.families.spatial.execution.limbed_body import LimbedBody
from clamber.families.spatial.execution.motions import (
    SPEED,
    joints_along,
    move_body,
    regrab,
    rest,
    scaled,
    share_loads,
    take,
)
from clamber.families.spatial.execution.plant import Pose
from clamber.families.spatial.execution.references import (
    BodyPath,
    TimeScaling,
    TipPath,
    quaternion_of,
    rotation_vector,
    swing_seconds,
)
from clamber.families.spatial.execution.run_trace import RunTrace
from clamber.families.spatial.execution.sensor_watch import WANDERED
from clamber.families.spatial.execution.settings import Pace
from clamber.families.spatial.planning.swing_loads import SwingLoads
from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.robot.bodies import rotation
from clamber.families.spatial.sim.spatial_flaws import Deviations, SpatialFlaws
from clamber.families.spatial.sim.spatial_model import LINKS
from clamber.families.spatial.sim.spatial_plant import SpatialSim
from clamber.families.spatial.statics.judging import lift_between
from clamber.families.spatial.trials.law_trials import first_steps as short_plan
from clamber.families.spatial.trials.law_trials import try_law
from clamber.families.spatial.trials.planning import RESERVES, careful, roomy
from clamber.families.spatial.trials.run_plan import SpatialRun, body_of, run_plan
from clamber.planning.auto import plan_auto
from clamber.planning.planners import plan_task
from clamber.planning.problem.codes import MOVE, NEAREST, pack
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.problems import plan_family
from clamber.planning.problem.verdict import check_plan
from clamber.tasks.library import load_task, task_names
from clamber.trials.dynamics import RunEvents, RunRequest
from clamber.types import Floats


def first_steps(name: str, grabs: int = 4) -> tuple[SpatialTask, Plan]:
    """A task and a short plan of it: a move of the body, limbs to other holds as far as that can be, another move."""
    task = load_task(name)
    assert isinstance(task, SpatialTask)
    problem = plan_family(task).problem(task)
    moves = [pack(MOVE, 0, argument) for argument in (0, 1, 2, 3, 4)]
    limbs = range(len(task.robot.limb_names))
    nearest = [pack(NEAREST, limb, rank) for rank in range(task.step.nearest) for limb in limbs]
    codes: list[int] = []
    for choices, most in ((moves, 1), (nearest, grabs), (moves, 1)):
        for code in choices:
            if most and problem.replay([*codes, code]).ok:
                codes.append(code)
                most -= 1
    return task, Plan.of_codes(task, codes)


def differences(path: BodyPath | TipPath, time: float, step: float = 1e-5) -> tuple[Floats, Floats]:
    """First and second derivative of a path's places."""
    before, now, after = (np.asarray(path.at(time + k * step)[0]) for k in (-1, 0, 1))
    return (after - before) / (2 * step), (after - 2 * now + before) / step**2


def test_velocities_and_accelerations_of_paths_are_those_of_their_places() -> None:
    normals = np.array(((0.0, 0.0, 1.0), (0.0, 0.6, 0.8)))
    tip = TipPath(np.zeros(3), np.array((0.3, 0.1, 0.05)), normals, np.array((0.0, 0.018, 0.054)))
    body = BodyPath.between(
        np.zeros(3), np.eye(3), np.array((0.1, 0.0, 0.2)), Rotation.from_rotvec((0.1, 0.3, 0.2)).as_matrix(), 2.0
    )
    for time in (0.1, 0.31, 0.6, 0.83, 1.2):
        velocity, acceleration = differences(tip, time / 1.3)
        assert np.allclose(tip.at(time / 1.3)[1], velocity, atol=1e-6)
        assert np.allclose(tip.at(time / 1.3)[2], acceleration, atol=1e-3)
        velocity, acceleration = differences(body, time)
        assert np.allclose(body.at(time)[2][:3], velocity, atol=1e-6)
        assert np.allclose(body.at(time)[3][:3], acceleration, atol=1e-3)
        spin = rotation_vector(body.at(time + 1e-5)[1] @ body.at(time - 1e-5)[1].T) / 2e-5
        assert np.allclose(body.at(time)[2][3:], spin, atol=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_a_swing_slows_down_where_it_has_to_and_there_alone(seed: int) -> None:
    """Its pieces take as long as asked at least, and its tip accelerates by half more at most."""
    drawn = np.random.default_rng(seed)
    way, up = drawn.uniform(-0.3, 0.3, 3), drawn.uniform(0.0, 0.05, 3)
    path = TipPath(np.zeros(3), way, np.zeros((2, 3)), up)
    seconds = swing_seconds(float(np.linalg.norm(way)), float(np.linalg.norm(up)), 0.5)
    least = np.zeros(32)
    least[drawn.integers(0, 32, 2)] = seconds * drawn.uniform(2.0, 20.0, 2)
    scaling = TimeScaling.within(seconds, least)
    assert (32 * np.diff(scaling.times) >= np.maximum(least, seconds) * (1.0 - 1e-12)).all()
    assert scaling.times[-1] < 0.2 * least.max() + 2.0 * seconds
    slowest = int(np.argmax(least))
    assert 32 * np.diff(scaling.times)[slowest] == pytest.approx(least[slowest])
    full = TimeScaling.within(seconds, np.zeros(32))
    assert full.at(0.3 * seconds) == pytest.approx((0.3, 1.0 / seconds, 0.0))
    most = []
    for one in (full, scaling):
        times = np.linspace(0.0, float(one.times[-1]), 2000)
        paces = [one.at(time) for time in times]
        parts = [(path.at(share), rate, quicker) for share, rate, quicker in paces]
        most.append(max(float(np.linalg.norm(rate**2 * at[2] + quicker * at[1])) for at, rate, quicker in parts))
    assert most[1] < 1.5 * most[0] + 1e-9
    for time in np.linspace(0.011, scaling.times[-1] - 0.011, 40):
        if np.abs(scaling.times - time).min() > 1e-5:  # the rate has a bend at each of these
            (before, slower, _), (_, rate, quicker), (after, faster, _) = (
                scaling.at(time + step) for step in (-1e-6, 0.0, 1e-6)
            )
            assert (after - before) / 2e-6 == pytest.approx(rate, abs=1e-6)
            assert (faster - slower) / 2e-6 == pytest.approx(quicker, rel=1e-3, abs=1e-4)
    assert scaling.at(float(scaling.times[-1]))[0] == pytest.approx(1.0)


@pytest.mark.parametrize("angle", [0.0, 1e-8, 0.5, 3.0, np.pi])
def test_rotations_and_their_vectors_and_quaternions_agree(angle: float) -> None:
    turned = Rotation.from_rotvec(angle * np.array((0.6, 0.0, 0.8))).as_matrix()
    assert np.allclose(Rotation.from_rotvec(rotation_vector(turned)).as_matrix(), turned, atol=1e-9)
    quaternion = quaternion_of(turned)
    assert quaternion[0] >= 0.0
    assert np.allclose(rotation(quaternion), turned, atol=1e-9)
    axes = np.empty((3, 3))
    write_axes(quaternion, axes)
    assert np.allclose(axes, turned, atol=1e-9)


def test_a_course_has_every_action_of_its_plan_once() -> None:
    task, plan = first_steps("wall-gripper")
    course = Course.of(task, plan)
    numbers = [number for motion in course.motions for number in range(motion.first, motion.last + 1)]
    assert numbers == list(range(1, len(plan.actions) + 1))
    assert any(isinstance(motion, Regrab) for motion in course.motions)
    assert any(isinstance(motion, BodyMotion) for motion in course.motions)
    for motion in course.motions:
        if isinstance(motion, Regrab):
            assert not motion.loads[motion.limb].any()
            total = motion.loads[:, :3].sum(axis=0)
            assert total == pytest.approx(-task.robot.chains.total_mass * np.array(task.world.gravity), abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["wall-gripper", "stones-quadruped", "rubble-hexapod", "corners-magnet"])
def test_a_robot_carries_its_first_steps_out(name: str) -> None:
    """It comes to the end, with every tip within a hundredth of a limb of its hold, and its log tells so."""
    task, plan = first_steps(name)
    run: SpatialRun = run_plan(task, plan)
    assert run.done, run.reason
    assert not run.broken
    taken = [motion for motion in run.report.motions if motion.limb is not None]
    assert taken
    assert max(motion.off for motion in taken) < 0.01
    again = RunTrace.from_log(run.trace.to_log())
    assert again.report == run.trace.report
    assert again.true_pose is not None
    assert run.trace.true_pose is not None
    assert np.array_equal(again.true_pose, run.trace.true_pose)


def standing_body(
    task: SpatialTask, start: Standing, flaws: SpatialFlaws | None = None, deviations: Deviations | None = None
) -> LimbedBody:
    """A robot that stands at rest, as it would at the start of a run."""
    plant = SpatialSim(task.robot, task.world, flaws or SpatialFlaws(), deviations)
    belief = EstimatedBase(task.robot, task.world, believed_tree(task.robot, task.world.gravity), plant.period)
    body = LimbedBody(task.robot, task.world, plant, belief, Pace.of(task.robot), task.rules.lift)
    body.start(start)
    return body


def after_each_tick(body: LimbedBody, look: Callable[[], None]) -> None:
    """Have something looked at after every tick that nothing ends."""
    tick = body.tick

    def both() -> None:
        tick()
        look()

    body.tick = both  # type: ignore[method-assign]


@pytest.mark.parametrize("moment", ["fading", "shutting"])
def test_a_limb_that_comes_off_while_another_lets_go_or_closes_is_taken_again(moment: str) -> None:
    """The other one bears what it can meanwhile: left with its faded load, or counted as in the air, the robot fell."""
    task, plan = first_steps("wall-gripper", grabs=3)
    plant = SpatialSim(task.robot, task.world, SpatialFlaws())
    body = body_of(task, plant, plant.flaws, USUAL)
    carrying = Carrying(body, task, Course.of(task, plan))
    off: list[int] = []

    def look() -> None:
        moves = body.fading if moment == "fading" else int(np.argmax(body.sensed.shutting))
        now = body.law.aims.cap[moves] < 0.2 * body.pace.weight if moment == "fading" else body.sensed.shutting[moves]
        if not off and moves >= 0 and now:
            off.append(next(limb for limb in range(4) if limb != moves))
            plant.grip(off[0], False)

    after_each_tick(body, look)
    report = Sequencer(carrying).run()
    assert off and report.done, report.reason
    assert any("took it again" in motion.reason for motion in report.motions)
    assert report.off < 0.1 * body.pace.size


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 12, 18])
def test_clamps_pass_singular_postures_and_other_limbs(seed: int) -> None:
    """A wrist whipped by a posture in which it could not turn its clamp (1, 12), or a clamp closed on the other limb (18)."""
    task = load_task("truss-inchworm", [f"world.seed={seed}"])
    run: SpatialRun = run_plan(task, plan_auto(task).plan)
    assert run.done, run.reason


@pytest.mark.slow
@pytest.mark.parametrize("law", BODY_LAWS)
def test_every_law_carries_first_steps_out(law: str) -> None:
    task = load_task("wall-gripper")
    assert isinstance(task, SpatialTask)
    trial, _ = try_law(task, short_plan(task), law)
    assert not trial.reason
    assert (trial.motions, trial.off) == (3, 0)
    size = Pace.of(task.robot).size
    assert trial.body < 0.1 * size and trial.tip < 0.1 * size
    assert trial.slid < 0.001 * size
    assert trial.torque < 1.0


FOOTED = ("stones-quadruped", "chimney-hexapod")
"""Tasks of robots whose feet hold by friction alone."""


def without_load(name: str) -> tuple[SpatialTask, Standing, int]:
    """Where a robot of feet stands at the start, its load shared by all but one, and which that is."""
    task, plan = first_steps(name, grabs=0)
    stance = plan_family(task).problem(task).replay(plan.codes(task), go_on=True).stances[0]
    shares = SwingLoads(task)
    for limb in range(len(task.robot.limb_names)):
        loads = shares.wrenches(stance, limb)
        if np.isfinite(loads).all():
            return task, replace(Course.of(task, plan).start, loads=loads), limb
    raise AssertionError(f"{name} needs all of its feet at the start")


@pytest.mark.parametrize("name", FOOTED)
def test_a_foot_that_is_to_bear_nothing_stays_on_its_hold(name: str) -> None:
    """However the plan shares the load: a foot at zero would leave its hold as soon as anything gives way."""
    task, start, _ = without_load(name)
    body = standing_body(task, start)
    rest(body, 1.0)
    felt = np.linalg.norm(body.sensed.wrenches[:, :3], axis=1)
    assert felt.min() > body.pace.touch


def centre_of_mass(plant: SpatialSim) -> Floats:
    """Of all that MuJoCo moves, less where the base is [m], shape (3,)."""
    truth: Floats = plant._data.subtree_com[0] - plant.truth().pose.position
    return truth


@pytest.mark.parametrize(
    "name", ["stones-quadruped", "rubble-hexapod", "wall-gripper", "ceiling-gripper", "corners-magnet"]
)
@pytest.mark.parametrize("seed", [1, 2])
def test_tips_tell_where_the_centre_of_mass_is_and_the_body_makes_up_for_it(name: str, seed: int) -> None:
    """Links that weigh up to 30 % more or less; MuJoCo's own centre of mass is the truth. Along the weight it makes no difference."""
    task, plan = first_steps(name, grabs=0)
    masses = 1.0 + np.random.default_rng(seed).uniform(-0.3, 0.3, 1 + int(task.robot.chains.n_joints.sum()))
    start = Course.of(task, plan).start
    believed, true = (
        standing_body(task, start, deviations=replace(Deviations.none(task.robot, task.world), masses=weights))
        for weights in (np.ones_like(masses), masses)
    )
    down = np.array(task.world.gravity) / np.linalg.norm(task.world.gravity)
    for body in (believed, true):
        rest(body, 3.0)
    off = centre_of_mass(true.plant) - centre_of_mass(believed.plant)
    off -= (off @ down) * down
    assert np.linalg.norm(off) > 1e-3
    assert np.linalg.norm(believed.lean) < 1e-3
    told = start.pose.rotation @ true.lean
    assert np.linalg.norm(told - off) < 0.2 * np.linalg.norm(off) + 5e-4
    made_up = true.over_holds(start) - believed.over_holds(start)
    made_up -= (made_up @ down) * down
    assert np.linalg.norm(made_up + off) < 0.2 * np.linalg.norm(off) + 1e-3


def test_without_weight_nothing_tells_of_balance() -> None:
    task, plan = first_steps("handrails-triped", grabs=0)
    body = standing_body(task, Course.of(task, plan).start)
    assert not np.any(task.world.gravity)
    rest(body, 0.5)
    assert not body.lean.any()


def test_a_body_stays_over_its_holds_where_the_map_moves_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A touch that corrects where the robot is moves its feet, too: it fell as it went after its place in the world."""
    task, plan = first_steps("stones-quadruped", grabs=0)
    motion = Course.of(task, plan).motions[0]
    assert isinstance(motion, BodyMotion)
    ends = []
    for off in (np.zeros(3), np.array((0.02, -0.03, 0.01))):
        body = standing_body(task, motion.start)
        rest(body, 0.1)
        update, believed = body.belief.update, body.belief.filter.believed

        def moved(*given: Any, update: Any = update, believed: Any = believed, off: Floats = off) -> Any:
            update(*given)
            for place in (believed.position, believed.places, given[-1].position):
                place += off
            return Pose(np.eye(3), off)

        with monkeypatch.context() as once:
            once.setattr(body.belief, "update", moved)
            body.tick()
        rest(body, 0.5)
        assert body.off < 2e-3
        move_body(body, motion)
        truth = body.plant.truth()
        assert truth is not None
        ends.append(truth.pose.position)
    assert np.linalg.norm(ends[1] - ends[0]) < 1e-3


@pytest.mark.parametrize("name", FOOTED)
def test_a_foot_that_is_off_its_hold_finds_it_again(name: str) -> None:
    task, start, limb = without_load(name)
    body = standing_body(task, start)
    first, end = body.joints_of(limb)
    normal = task.world.normals[int(start.holds[limb])]
    along = normal @ body.law.dynamics.jacobian[limb, :3, FREE + first : FREE + end]
    bent = start.joints.copy()
    bent[first:end] += 0.1 * body.pace.depth * along / (along @ along)
    body = standing_body(task, replace(start, joints=bent))
    assert float(np.linalg.norm(body.plant.sense().wrenches[limb, :3])) < body.pace.touch
    rest(body, 1.0)
    truth = body.plant.truth()
    assert truth is not None
    assert float(truth.wrenches[limb, :3] @ normal) > body.pace.touch
    assert (body.holds == start.holds).all()


def test_a_hold_deeper_than_its_wall_is_reached_in_its_recess() -> None:
    """Magnets attach no further than 1 mm off: 4 mm behind the steel they would never get there."""
    task, plan = first_steps("corners-magnet", grabs=1)
    world = task.world
    sunk = Deviations.none(task.robot, world)
    sunk = replace(sunk, places=world.places - 0.004 * world.normals)
    run = run_plan(task, plan, deviations=sunk)
    assert run.done, run.reason
    assert not run.broken


@pytest.mark.parametrize("name", ["wall-gripper", "corners-magnet", "handrails-triped"])
def test_a_swing_takes_so_long_that_its_joints_keep_to_their_speeds(name: str) -> None:
    """Near a singularity and near a joint's limit, too, where a limb that is too quick shakes the body."""
    task, plan = first_steps(name, grabs=1)
    course = Course.of(task, plan)
    motion = next(motion for motion in course.motions if isinstance(motion, Regrab))
    body, limb = standing_body(task, motion.before), motion.limb
    limits, mine = body.law.limits, slice(*body.joints_of(limb))
    normals = task.world.normals[[int(motion.before.holds[limb]), motion.hold]]
    start, end = body.tips[limb].copy(), task.world.places[motion.hold]
    up = lift_between(np.stack((start, end)), normals, body.lift)
    path = TipPath(start, end, normals, up)
    scaling = scaled(body, limb, path, motion.after.joints, 0.01)
    shares, dense = np.linspace(0.0, 1.0, 400), np.linspace(0.0, scaling.times[-1], 10_000)
    times = np.interp(shares, [scaling.at(time)[0] for time in dense], dense)
    joints = joints_along(body, limb, path, shares, motion.after.joints)
    speeds = np.abs(np.diff(joints, axis=0)) / np.diff(times)[:, None]
    assert (speeds / limits.speed[mine]).max() < 1.05 * SPEED
    body.law.state.joints[mine] = joints[-1]
    body.law.look()
    assert body.tips[limb] == pytest.approx(end, abs=0.01 * body.pace.size)
    if task.robot.contacts[limb].aligned:
        assert body.law.dynamics.tip_turn[limb, :, 2] == pytest.approx(-normals[1], abs=0.02)


def test_a_foot_in_the_air_lets_go_as_any_other() -> None:
    """It is still felt for when its load is to fade, which must not wait for ground that it may never feel."""
    task, start, limb = without_load("stones-quadruped")
    body = standing_body(task, start)
    first, end = body.joints_of(limb)
    normal = task.world.normals[int(start.holds[limb])]
    along = normal @ body.law.dynamics.jacobian[limb, :3, FREE + first : FREE + end]
    bent = start.joints.copy()
    bent[first:end] += 0.5 * body.pace.depth * along / (along @ along)
    body = standing_body(task, replace(start, joints=bent))
    while not body.seeks(limb):
        body.tick()
    began = body.time

    def look() -> None:
        assert body.time < began + 2.0 * body.pace.shift

    after_each_tick(body, look)
    share_loads(body, start.loads, limb, fading=True)
    body.let_go(limb)
    assert not body.seeks(limb)


def slid(task: SpatialTask, motion: Regrab) -> float:
    """How far a foot goes along its ground from where it meets it until it has its load [m]."""
    body, normal, limb = standing_body(task, motion.before), task.world.normals[motion.hold], motion.limb
    met: list[Floats] = []
    air = 0

    def look() -> None:
        nonlocal air
        truth = body.plant.truth()
        assert truth is not None
        air = 0 if truth.wrenches[limb].any() else air + 1
        if air * body.plant.period > 0.05:
            met.clear()
        elif air == 0:
            met.append(body.tips[limb].copy())

    after_each_tick(body, look)
    assert regrab(body, motion).taken
    way = np.array(met) - met[0]
    return float(np.linalg.norm(way - np.outer(way @ normal, normal), axis=1).max())


def test_feet_stay_where_they_stand_as_legs_lean() -> None:
    """The plant's feet are points, as those of the planner and of the estimate: as balls of 2 mm they rolled 26 mm over 5 m."""
    task, plan = first_steps("stones-quadruped", grabs=1)
    body = standing_body(task, Course.of(task, plan).start)
    rest(body, 0.5)
    aims, before = body.law.aims, body.plant.truth()
    path = BodyPath.between(
        aims.position, aims.rotation, aims.position + np.array((0.05, 0.0, 0.0)), aims.rotation, 2.0
    )
    for k in range(1, round(2.5 / body.plant.period)):
        aims.position[:], aims.rotation[:], aims.velocity[:], aims.acceleration[:] = path.at(k * body.plant.period)
        body.tick()
    after = body.plant.truth()
    assert before is not None and after is not None
    assert np.linalg.norm(after.pose.position - before.pose.position) > 0.045
    assert np.linalg.norm((after.tips - before.tips)[:, :2], axis=1).max() < 1e-4
    assert np.linalg.norm(after.pose.position - body.law.state.position) < 2e-4


@pytest.mark.parametrize("name", ["stones-quadruped", "rubble-hexapod"])
def test_a_foot_that_meets_its_ground_does_not_slide_along_it(name: str) -> None:
    """The inertia of a stretched limb pushes along the limb: with an aim below the ground a hexapod's feet bounced, and slid by 10 mm."""
    task, plan = first_steps(name)
    motions = [motion for motion in Course.of(task, plan).motions if isinstance(motion, Regrab)]
    for motion in motions:
        assert slid(task, motion) < 0.006 * Pace.of(task.robot).size


def first_regrab(name: str) -> tuple[SpatialTask, Regrab]:
    """A task, and the first limb that its plan moves."""
    task, plan = first_steps(name, grabs=1)
    return task, next(motion for motion in Course.of(task, plan).motions if isinstance(motion, Regrab))


@pytest.mark.slow
def test_a_foot_that_comes_down_beside_its_stone_finds_it() -> None:
    """A stone that truly lies its radius and 2 mm aside: the ground there is far deeper, and a foot would stand on it."""
    task, motion = first_regrab("rubble-hexapod")
    world, hold = task.world, motion.hold
    normal, radius, tries = world.normals[hold], world.holds[hold].radius, []
    for turn in np.arange(0.0, 2.0 * np.pi, 0.5 * np.pi):
        across = np.cross(normal, (np.cos(turn), np.sin(turn), 0.0))
        true = Deviations.none(task.robot, world)
        places = true.places.copy()
        places[hold] += (radius + 0.002) * across / np.linalg.norm(across)
        body = standing_body(task, motion.before, deviations=replace(true, places=places))
        landing = regrab(body, motion)
        deep = float((world.places[hold] - body.tips[motion.limb]) @ normal)
        assert landing.taken and deep < body.pace.deep
        tries.append(landing.tries)
    assert max(tries) > 1, "another stone was everywhere beside it"


def test_a_clamp_on_an_edge_that_is_turned_further_than_it_takes_is_leant_until_it_does() -> None:
    """A clamp takes edges up to 5 deg off; true ones were up to 5 deg beside their normals, and trials of a truss ended at those."""
    task, motion = first_regrab("truss-inchworm")
    hold, takes = motion.hold, task.robot.contacts[motion.limb].tilt
    inward, tries = task.world.normals[hold].copy(), []
    for turn in np.arange(0.0, 2.0 * np.pi, 0.5 * np.pi):
        across = np.linalg.svd(inward[None])[2][1:]
        axis = np.cos(turn) * across[0] + np.sin(turn) * across[1]
        true = Deviations.none(task.robot, task.world)
        normals = true.normals.copy()
        normals[hold] = Rotation.from_rotvec(1.1 * takes * axis).apply(inward)
        body = standing_body(task, motion.before, deviations=replace(true, normals=normals))
        landing = regrab(body, motion)
        assert landing.taken, landing.reason
        tries.append(landing.tries)
    assert max(tries) > 1, "every clamp took its edge at once"


def test_gears_that_stick_do_not_keep_a_body_from_its_aim() -> None:
    """Friction of an inchworm's gears left its body 15 mm off for good: a law without an integral balances it at some distance."""
    task, plan = first_steps("truss-inchworm", grabs=1)
    body = standing_body(task, Course.of(task, plan).start)
    body.law.aims.position[:] += 0.01 * body.pace.size
    rest(body, 4.0)
    assert body.off < 0.004 * body.pace.size
    assert np.linalg.norm(body.law.aims.base_integral[:3]) < 0.03 * body.pace.size + 1e-9


@pytest.mark.parametrize("name", ["truss-inchworm", "wall-gripper", "stones-quadruped"])
def test_a_swinging_limb_is_damped_by_no_more_than_its_gears_take_without_a_rattle(name: str) -> None:
    """The worst joint's rotor alone, under the damping meant for all that it moves, as late as a loop answers: it comes to rest."""
    task, motion = first_regrab(name)
    body = standing_body(task, motion.before)
    body.law.aims.does[motion.limb] = SWINGS
    body.law.aims.tip[motion.limb] = body.tips[motion.limb]
    body.tick()
    rate = min(body.law.gains.swing_rate, body.law.aims.tip_rate[motion.limb])
    mine = slice(*body.joints_of(motion.limb))
    heavier = (np.diag(body.law.dynamics.mass)[FREE:] / body.law.tree.rotor)[mine].max()

    def left(damping: float) -> float:
        step, late = 1e-5, 0.0075
        speeds = [1.0] * round(late / step)
        for _ in range(round(1.0 / step)):
            speeds.append(speeds[-1] - step * heavier * damping * speeds[-round(late / step)])
        return float(np.abs(speeds[-10000:]).max())

    assert left(2.0 * rate) < 0.5
    if rate < body.law.gains.swing_rate:
        assert left(2.0 * 1.3 * rate) > 1.0, "it could be damped by more"


def test_a_foot_that_takes_its_hold_anew_elsewhere_is_told_as_no_drift() -> None:
    task, motion = first_regrab("stones-quadruped")
    body, limb = standing_body(task, motion.before), motion.limb
    hold = int(motion.before.holds[limb])
    normals = task.world.normals[[hold, hold]]
    aside = 2.0 * WANDERED * body.pace.size * np.linalg.svd(normals[:1])[2][1]
    rest(body, 0.5)
    share_loads(body, motion.loads, limb, fading=True)
    body.let_go(limb)
    body.belief.places[hold] += aside
    assert take(body, limb, hold, normals, motion.before.loads, motion.before.joints).taken
    rest(body, 1.0)
    assert not body.watch.monitor.findings


def test_a_foot_stands_where_its_ground_is_least_deep_if_all_of_it_is_deeper_than_believed() -> None:
    task, motion = first_regrab("stones-quadruped")
    size, true = Pace.of(task.robot).size, Deviations.none(task.robot, task.world)
    places = true.places.copy()
    places[motion.hold] -= 0.06 * size * task.world.normals[motion.hold]
    body = standing_body(task, motion.before, deviations=replace(true, places=places))
    landing = regrab(body, motion)
    assert landing.taken and landing.tries == body.pace.tries + 1
    rest(body, 0.5)
    truth = body.plant.truth()
    assert truth is not None
    assert float(truth.wrenches[motion.limb, :3] @ task.world.normals[motion.hold]) > body.pace.touch


def test_the_noise_of_a_force_sensor_is_no_ground() -> None:
    """A reading in twenty is above what a foot stands at: each swing would end in the air by one of them."""
    task, motion = first_regrab("rubble-hexapod")
    body = standing_body(task, motion.before, SpatialFlaws(force_noise=0.007, seed=2))
    rest(body, 0.1)
    stands: list[bool] = []

    def look() -> None:
        truth = body.plant.truth()
        assert truth is not None
        stands.append(bool(truth.wrenches[motion.limb].any()))

    after_each_tick(body, look)
    assert regrab(body, motion).taken
    swung = len(stands) - stands[::-1].index(False)
    assert stands[swung:], "it was taken for landed in the air"
    assert sum(stands[swung:]) * body.plant.period > 0.5 * body.pace.shift


@pytest.mark.parametrize("strength", [0.02, 0.1, 0.2, 0.3])
def test_a_robot_whose_holds_all_give_way_ends_with_a_reason(strength: float) -> None:
    """At once, or one after the other as what is left takes over their loads."""
    task, plan = first_steps("ceiling-gripper")
    weak = Deviations.none(task.robot, task.world)
    run = run_plan(task, plan, deviations=replace(weak, strengths=strength * weak.strengths))
    assert not run.done
    assert run.reason
    assert run.broken


@pytest.mark.long
def test_a_hexapod_goes_up_its_chimney_to_the_end() -> None:
    """Feet that press both walls with nine tenths of the torques: one that leaves its wall as it is loaded would end it."""
    task = load_task("chimney-hexapod")
    assert isinstance(task, SpatialTask)
    run = run_plan(task, plan_task(task, "auto").plan)
    assert run.done, run.reason
    assert run.report.off < 0.1 * Pace.of(task.robot).size


@pytest.mark.slow
def test_what_fails_to_attach_is_tried_again() -> None:
    task, plan = first_steps("wall-gripper")
    run = run_plan(task, plan, flaws=SpatialFlaws(miss=0.5, seed=1))
    assert run.done, run.reason
    assert any(motion.tries > 1 for motion in run.report.motions)


def test_plans_that_are_refused_move_nothing() -> None:
    task, plan = first_steps("wall-gripper")
    assert DYNAMICS.objection(task, plan) is None


def test_a_robot_in_space_has_no_other_plant_to_ask_for(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(["run", "wall-gripper", "--plant", "volts"])
    assert left.value.code == 2 and "--plant" in capsys.readouterr().err


def test_a_start_that_bears_less_in_reserve_than_runs_like_is_planned_from_all_the_same() -> None:
    task = load_task("patch-gripper", ["payload.mass=3 kg", "goal={ along_min = '0.03 m' }"])
    with pytest.raises(SpecError, match="violate 'equilibrium'"):
        plan_task(careful(task, min(RESERVES)), "auto")
    notes: list[str] = []
    plan = DYNAMICS.plan(task, RunRequest(), RunEvents(note=notes.append))
    assert len(plan.actions) == 1
    assert notes == [
        f"no plan keeps {100 * reserve:.0f} % of all strengths in reserve; one with less is looked for"
        for reserve in RESERVES
    ]


@pytest.mark.slow
def test_a_plan_along_a_surface_is_rehearsed_and_stays_where_it_goes_well() -> None:
    """This one passes 3 mm from the tube."""
    task, notes = load_task("scene-tube"), []
    plan = DYNAMICS.plan(task, RunRequest(), RunEvents(note=notes.append))
    assert notes[-2:] == ["the plan comes nearer than 5 mm to a surface", "the plan is rehearsed"]
    assert check_plan(task, plan).ok and not check_plan(roomy(task), plan).ok


@pytest.mark.long
def test_a_plan_that_fails_in_its_rehearsal_gives_way_to_one_that_does_not() -> None:
    """On the wall's edge two plans ask too much of a shoulder."""
    task, notes = load_task("scene-top-out"), []
    run: SpatialRun = run_plan(task, DYNAMICS.plan(task, RunRequest(), RunEvents(note=notes.append)))
    assert [note for note in notes if note.startswith("it does not come to its end")]
    assert run.done, run.reason


@pytest.mark.long
def test_no_leg_catches_the_edge_of_a_corner() -> None:
    """A plan leads a leg past the edge of this world's steel by 0.14 mm."""
    task = load_task("corners-magnet", ["world.seed=10"])
    run: SpatialRun = run_plan(task, DYNAMICS.plan(task, RunRequest(), RunEvents()))
    assert run.done, run.reason


def links_that_touch(task: SpatialTask, stance: Standing) -> int:
    """Contacts of links with anything, by the plant's own colliders, where its tips are put on their holds."""
    plant = SpatialSim(task.robot, task.world)
    plant.reset(stance.pose, stance.joints, stance.holds)
    model, data = plant.model, plant._data
    pairs = [(model.geom(contact.geom1), model.geom(contact.geom2)) for contact in data.contact[: data.ncon]]
    return sum(any(int(geom.contype[0]) & LINKS for geom in pair) for pair in pairs)


WALLS = (("solids", "at"), ("patterns", "on.at"))
"""Where a world's file says where a wall and its holds are."""


@pytest.mark.parametrize("name", task_names("spatial"))
def test_no_link_touches_a_solid_where_a_task_starts(name: str) -> None:
    task = load_task(name)
    assert isinstance(task, SpatialTask)
    assert links_that_touch(task, Course.of(task, Plan.of_codes(task, [])).start) == 0


def test_a_shin_along_a_wall_is_seen_by_the_planner_as_it_is_by_the_plant() -> None:
    """In a chimney of 0.44 m the hexapod's shins lie on the walls that its feet press."""
    narrow = [
        f"world.{part}.{k}.{at}=['0 m', '{side} m', '0 m']" for k, side in ((0, 0.22), (1, -0.22)) for part, at in WALLS
    ]
    with pytest.raises(SpecError, match="violate 'clearance'"):
        plan_family(load_task("chimney-hexapod", narrow)).problem(load_task("chimney-hexapod", narrow))
    loose: Any = load_task("chimney-hexapod", [*narrow, "rules.hard=['reach', 'joint', 'equilibrium', 'torque']"])
    course = Course.of(loose, Plan.of_codes(loose, []))
    assert links_that_touch(loose, course.start) > 0
