"""Hanging on one limb: the pendulum against mechanics, its damping against linear analysis, and a gap that only a hang spans."""

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise

import mujoco
import numpy as np
import pytest
from hanging_by_hand import hang_up, one_peg, push_while_hanging

from clamber.execution.sequencer import Sequencer
from clamber.families.climber.execution.climb_trace import TracedClimber
from clamber.families.climber.execution.climber import FallenError
from clamber.families.climber.execution.climbing import Climbing
from clamber.families.climber.execution.executable_plan import alone, climbable, lay_course
from clamber.families.climber.execution.hang import LAG
from clamber.families.climber.execution.pendulum import Pendulum
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_model import HookShape, climber_spec
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.trials.planning import plan_to_climb
from clamber.planning.planners import find_planner
from clamber.planning.problem.plan import Plan
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot
from clamber.types import Floats
from clamber.units import GRAVITY
from tiers import first_fast

IDEAL = LimbFlaws(physics_rate=1000.0)
NOMINAL = LimbFlaws(backlash=np.radians(2.0), physics_rate=1000.0, encoder_counts=400, delay=1)
POSTURE = np.array(((0.35, -1.75), (-0.3, 1.2), (0.5, -1.0)))
"""The right limb holds with its hook on top."""
RIGHT = 0


def robot(friction: float | None = None) -> LimbedRobot:
    libra = load_robot("libra")
    assert isinstance(libra, LimbedRobot)
    if friction is None:
        return libra
    limbs = tuple(replace(limb, end=replace(limb.end, friction=friction)) for limb in libra.limbs)
    return replace(libra, limbs=limbs)


def swings(angles: Floats, period: float) -> tuple[Floats, float]:
    """Sizes of the swings, half a swing apart, about their middle, and the time of a whole one [s]."""
    middle = angles[len(angles) // 2 :].mean()
    signs = np.sign(angles - middle)
    crossings = np.flatnonzero(signs[1:] != signs[:-1]) + 1
    sizes = [np.abs(angles[a:b] - middle).max() for a, b in pairwise(crossings)]
    return np.array(sizes), 2.0 * period * float(np.diff(crossings).mean())


def recorded(flaws: LimbFlaws, swing: float, damping: float, seconds: float, friction: float | None = None) -> Floats:
    held = hang_up(robot(friction), flaws, POSTURE, swing=swing, damping=damping)
    angles = []
    for _ in range(round(seconds / held.plant.period)):
        held.climber.tick()
        assert held.off_peg() < 2e-3
        angles.append(held.true_swing())
    return np.array(angles)


class Mechanics:
    """MuJoCo's mechanics of the climber with one tip at the origin."""

    def __init__(self, limb: int) -> None:
        self.pendulum = Pendulum(robot(), limb)
        model = climber_spec(robot(), one_peg(), LimbFlaws(physics_rate=1000.0)).compile()
        self.model, self.data = model, mujoco.MjData(model)
        self.body = model.body("body").id

    def at(self, q: Floats, angle: float) -> Floats:
        """Centre of gravity [m]."""
        self.data.qpos[:] = np.concatenate((self.pendulum.pose(q, np.zeros(2), angle), q.ravel()))
        mujoco.mj_forward(self.model, self.data)
        return np.array(self.data.subtree_com[self.body, :2])

    def momentum(self, q: Floats, angle: float, rates: Floats, turn: float) -> float:
        """Angular about the origin while the joints move and the body turns [kg m^2/s]."""
        step = 1e-6
        poses = [
            self.pendulum.pose(q + sign * step * rates, np.zeros(2), angle + sign * step * turn) for sign in (-0.5, 0.5)
        ]
        self.at(q, angle)
        self.data.qvel[:] = np.concatenate(((poses[1] - poses[0]) / step, rates.ravel()))
        mujoco.mj_forward(self.model, self.data)
        mujoco.mj_subtreeVel(self.model, self.data)
        (x, y), (vx, vy) = self.data.subtree_com[self.body, :2], self.data.subtree_linvel[self.body, :2]
        mass = float(self.model.body_subtreemass[self.body])
        return float(self.data.subtree_angmom[self.body, 2]) + mass * (x * vy - y * vx)


@pytest.mark.parametrize("limb", [0, 1, 2])
def test_centre_inertia_momentum_and_loads_are_those_of_the_simulated_body(limb: int) -> None:
    mechanics = Mechanics(limb)
    pendulum, rng = mechanics.pendulum, np.random.default_rng(limb)
    for _ in range(5):
        q, angle = rng.uniform(-1.5, 1.5, (3, 2)), float(rng.uniform(-3.0, 3.0))
        arm = pendulum.arm(q) * np.exp(1j * angle)
        np.testing.assert_allclose(mechanics.at(q, angle), (arm.real, arm.imag), atol=1e-9)
        still = np.zeros((3, 2))
        assert mechanics.momentum(q, angle, still, 1.0) == pytest.approx(pendulum.inertia(q), abs=1e-5)
        for j in range(2):
            rates = still.copy()
            rates[limb, j] = 1.0
            step = 1e-5
            turn = math.remainder(pendulum.rest(q + step * rates) - pendulum.rest(q - step * rates), math.tau) / (
                2 * step
            )
            seen = mechanics.momentum(q, pendulum.rest(q), rates, turn)  # the weight stays below the hold
            assert seen == pytest.approx(pendulum.momentum(q)[j], abs=1e-5)
            up, down = (mechanics.at(q + sign * step * rates, angle)[1] for sign in (1.0, -1.0))
            slope = pendulum.mass * GRAVITY * (up - down) / (2 * step)
            assert pendulum.loads(q, angle)[j] == pytest.approx(slope, abs=1e-5)


def test_a_point_mass_has_no_joints_to_push_against() -> None:
    """All weight in the body's middle: the lighter links and the smaller its inertia, the less c; nothing damps a plumb."""
    full = robot()
    light = replace(full, limbs=tuple(replace(limb, link_masses=(0.0, 0.0)) for limb in full.limbs))
    sizes = [float(np.hypot(*Pendulum(one, RIGHT).momentum(POSTURE))) for one in (full, light)]
    assert sizes[1] < 0.2 * sizes[0]
    plumb = Pendulum(light, RIGHT)
    assert plumb.frequency(POSTURE) == pytest.approx(math.sqrt(GRAVITY / plumb.length(POSTURE)), rel=0.03)


def test_angles_for_a_depth_and_an_angle_bring_the_body_there() -> None:
    pendulum = Pendulum(robot(), RIGHT)
    pose = pendulum.pose(POSTURE, np.zeros(2))
    moved = POSTURE.copy()
    moved[RIGHT] = pendulum.angles_for(POSTURE, -pose[1] + 0.02, pose[2] + 0.2, rounds=20)
    there = pendulum.pose(moved, np.zeros(2))
    np.testing.assert_allclose(there[1:], (pose[1] - 0.02, pose[2] + 0.2), atol=1e-6)
    assert pendulum.swing(moved, float(there[2])) == pytest.approx(0.0, abs=1e-9)


def test_an_undamped_body_swings_as_the_closed_form_says_and_friction_of_the_hook_takes_a_steady_part() -> None:
    pendulum = Pendulum(robot(), RIGHT)
    start = math.radians(10.0)
    free, period = swings(recorded(IDEAL, start, 0.0, 6.0, friction=0.0), IDEAL.period)
    wide = 1.0 + start**2 / 16.0  # a wide swing takes longer
    assert period == pytest.approx(wide * math.tau / pendulum.frequency(POSTURE), rel=0.02)
    np.testing.assert_allclose(free[1:], free[1], rtol=0.05)
    rubbed, _ = swings(recorded(IDEAL, start, 0.0, 6.0), IDEAL.period)
    lost = -np.diff(rubbed[1:6])
    assert (lost > 0.0).all()
    # mu W r over M g l: a peg of 4.76 mm in a hook whose wall bears, too, by no more than the root of two
    least = 2.0 * 0.2 * 0.00476 / pendulum.length(POSTURE)
    assert least * 0.9 < lost.mean() < 1.6 * least


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.2, 0.5, 0.9, 1.1])
def test_the_damping_is_stable_between_0_and_1_and_as_strong_as_said_while_small(damping: float) -> None:
    roots = np.roots(((1.0 - damping) * LAG, 1.0, LAG, 1.0))
    if damping == 0.0:
        assert np.abs(roots.real[np.abs(roots.imag) > 0.1]).max() < 1e-12
    else:
        assert (roots.real.max() < 0.0) == (damping < 1.0)
    if 0.0 < damping <= 0.05:
        swing = roots[np.abs(roots.imag) > 0.1][0]
        assert -swing.real / abs(swing) == pytest.approx(damping * LAG / (2.0 + 2.0 * LAG**2), rel=0.1)


@pytest.mark.parametrize("flaws", [IDEAL, NOMINAL], ids=["ideal", "backlash, counts and delay"])
@pytest.mark.parametrize("damping", [0.2, 0.4])
def test_a_damped_swing_shrinks_as_its_roots_say(flaws: LimbFlaws, damping: float) -> None:
    sizes, _ = swings(recorded(flaws, math.radians(6.0), damping, 6.0, friction=0.0), flaws.period)
    roots = np.roots(((1.0 - damping) * LAG, 1.0, LAG, 1.0))
    swing = roots[np.abs(roots.imag) > 0.1][0]
    part = math.exp(math.pi * swing.real / abs(swing.imag))  # over half a swing
    seen = (sizes[4] / sizes[1]) ** (1.0 / 3.0)
    assert seen == pytest.approx(part, abs=0.04)
    assert (np.diff(sizes[sizes > math.radians(0.5)]) < 0.0).all()  # energy only falls


def test_joints_that_cross_their_play_are_hardly_taken_for_a_swing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Motors have gone on by 2 deg and nothing else has moved: damped as the swing that it seems, it would go to and fro for ever."""
    held = hang_up(robot(0.0), IDEAL, POSTURE, swing=0.0, damping=0.5)
    hang, step = held.hang, math.radians(2.0)
    for _ in range(200):
        held.climber.tick()
    swing, speeds, asides = hang.pendulum.swing, [], []
    monkeypatch.setattr(hang.pendulum, "swing", lambda q, angle: swing(q, angle) + step)
    for _ in range(800):
        held.climber.tick()
        speeds.append(hang.speed)
        asides.append(hang.aside)
    assert np.abs(speeds).max() < hang.omega * step  # differences would tell the play over a tick: 7 rad/s
    assert np.abs(asides).max() < 1.5 * step
    assert np.abs(speeds[-40:]).max() < 0.1 * hang.omega * step  # it rests elsewhere, and swings by 0.1 deg


def test_a_wide_swing_is_damped_and_its_hook_stays_on() -> None:
    angles = recorded(NOMINAL, math.radians(40.0), 0.5, 18.0)
    assert np.abs(angles[-200:]).max() < math.radians(2.0)


@pytest.mark.parametrize("swing", [0.0, 10.0, 40.0])
@pytest.mark.parametrize("after", [0.5, 1.0, 1.3, 1.7, 3.0])
def test_a_body_that_falls_from_a_hang_is_told_within_a_fifth_of_a_second(swing: float, after: float) -> None:
    """Its joints are kept where they are, and turn little as it drops."""
    held = hang_up(robot(), NOMINAL, POSTURE, swing=math.radians(swing), damping=0.2)
    climber, plant = held.climber, held.plant
    climber.wait(after)
    plant.model.geom_contype[:] = plant.model.geom_conaffinity[:] = 0
    fell, told = None, False
    while not told:
        try:
            climber.tick()
        except FallenError:
            told = True
        if fell is None and held.off_peg() > HookShape().depth + HookShape().flare:
            fell = climber.time
        assert told or fell is None or climber.time - fell < 0.2


def test_a_body_rests_once_its_swing_has_died_and_not_before() -> None:
    held = hang_up(robot(0.0), NOMINAL, POSTURE, swing=math.radians(20.0), damping=0.5)
    assert held.climber.rest(20.0)
    left = []
    for _ in range(round(2.0 / held.plant.period)):  # more than a whole swing
        held.climber.tick()
        left.append(held.true_swing())
    assert np.ptp(left) < math.radians(3.0)
    swinging = hang_up(robot(0.0), IDEAL, POSTURE, swing=math.radians(20.0), damping=0.0)
    assert not swinging.climber.rest(4.0)


def test_a_push_swings_the_body_as_its_angular_momentum_says_and_the_swing_dies() -> None:
    pushed = push_while_hanging(robot(), NOMINAL, POSTURE, force=60.0, duration=0.1)
    assert pushed.on
    assert pushed.widest == pytest.approx(pushed.predicted, rel=0.1)
    assert pushed.after < math.radians(3.0)
    over = push_while_hanging(robot(), NOMINAL, POSTURE, force=60.0, duration=0.4, wait=2.0)
    assert not over.on  # round the peg


@cache
def test_a_body_that_is_folded_hangs_straight_below_its_peg_with_those_angles() -> None:
    hanging = hang_up(robot(), NOMINAL, POSTURE)
    hang, wished = hanging.hang, POSTURE[0] + np.array((-0.3, 0.4))
    assert hang.fold(wished)
    assert hang.calm()
    np.testing.assert_allclose(hanging.plant.truth().q[0], wished, atol=np.radians(3.0))  # the play is 2 deg
    assert abs(hanging.true_swing()) < np.radians(3.0)
    assert hanging.off_peg() < 0.003


def gap() -> LimbedTask:
    task = load_task("gap")
    assert isinstance(task, LimbedTask)
    return climbable(task)


@cache
def plan() -> Plan:
    found = plan_to_climb(gap(), "exact", seconds=30.0, seed=0)
    assert found is not None
    return found


def test_the_gap_needs_a_hang() -> None:
    assert gap().rules.max_hangs == 1
    without = load_task("gap", ("rules.max_hangs=0",))
    assert find_planner("exact")(without).status == "infeasible"
    course = lay_course(gap(), plan())
    assert course.objections == ()
    assert [alone(course, step) is not None for step in range(len(course.stances))].count(True) >= 1


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "friction"), first_fast([(1, 1.0), (2, 0.7), (3, 1.3)]))
def test_the_gap_is_crossed_hanging_and_no_hook_is_lost(seed: int, friction: float) -> None:
    task, error = gap(), 0.003
    places = task.world.positions()
    pegs = places + np.random.default_rng(seed).uniform(-error, error, places.shape)
    plant = ClimberPlant(task.robot, task.world, NOMINAL.with_changes(friction=friction), pegs=pegs)
    climber = TracedClimber(task.robot, task.world, plant, map_error=0.004 + error, truth=plant.truth)
    course = lay_course(task, plan())
    seen: list[tuple[int, float, float]] = []
    tick = climber.tick

    def watched() -> None:
        tick()
        if climber.hangs:
            true = plant.truth()
            stay = next(i for i, one in enumerate(climber.body.tasks) if one.mode == "hang")
            peg = pegs[climber.body.tasks[stay].hold - 1]
            swing = Pendulum(task.robot, stay).swing(true.q, float(true.pose[2]))
            seen.append((climber.step, swing, float(np.hypot(*(true.tips[stay] - peg)))))

    climber.tick = watched  # type: ignore[method-assign]
    report = Sequencer(Climbing(climber, course)).run()
    assert report.done, report.reason
    assert report.short < 0.01
    rows = np.array(seen)
    assert rows[:, 2].max() < 3e-3  # on its peg throughout
    grab = next(one.first for one in report.actions if one.kind == "grab")
    before = rows[rows[:, 0] < grab]
    assert np.abs(before[:, 1]).max() < math.radians(12.0)  # it lets go without a fall
    # at rest the weight is below the peg, as far as play and the hook's friction let one tell
    assert abs(before[-1, 1]) < math.radians(2.0)
    assert plant.truth().tips[2] == pytest.approx(pegs[2], abs=3e-3)


def test_letting_go_where_the_weight_cannot_come_below_the_hold_is_refused() -> None:
    task = load_task("ladder", ("rules.max_hangs=1", "start.holds.bottom=0"))
    assert isinstance(task, LimbedTask)
    task = climbable(task)
    chosen = Plan.of_codes(task, [thesis_code(task, 200)], planner="by hand")
    plant = ClimberPlant(task.robot, task.world, NOMINAL)
    climber = TracedClimber(task.robot, task.world, plant, map_error=0.004, truth=plant.truth)
    report = Sequencer(Climbing(climber, lay_course(task, chosen), force=True)).run()
    assert report.actions[-1].outcome == "not supported"
    assert "below the hold" in report.reason
    assert climber.body.tasks[1].hold == 3  # nothing has let go


def test_the_last_limb_that_holds_does_not_let_go() -> None:
    task = gap()
    codes = [*plan().codes(task)[:2], thesis_code(task, 100)]
    plant = ClimberPlant(task.robot, task.world, NOMINAL)
    climber = TracedClimber(task.robot, task.world, plant, map_error=0.004, truth=plant.truth)
    course = lay_course(task, Plan.of_codes(task, codes, planner="by hand"))
    assert "support" in course.objections[0].reason
    report = Sequencer(Climbing(climber, course, force=True)).run()
    assert report.actions[-1].outcome == "not supported"
    assert "last limb" in report.reason
    assert plant.truth().tips[RIGHT] == pytest.approx(climber.holds[2], abs=3e-3)


def test_hangs_are_carried_out_only_where_the_task_counts_them() -> None:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    assert (task.rules.max_hangs, climbable(task).rules.max_hangs) == (-1, 0)
