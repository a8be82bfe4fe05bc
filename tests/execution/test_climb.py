"""A climber in contact dynamics: it hangs on two hooks, moves its body, and climbs a rung."""

import itertools
import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from clamber.families.climber.control.planar_limb import HANG, LIMB_TASK
from clamber.families.climber.execution import actor, hook
from clamber.families.climber.execution.approach import Approach
from clamber.families.climber.execution.climber import Climber, FallenError, Grabbed
from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.execution.grabbing import grab, press_on, release
from clamber.families.climber.execution.limb_task import LimbTask
from clamber.families.climber.execution.motions import (
    JOINT_AGILITY,
    JOINT_SPEED,
    LAG,
    SURGE,
    _is_jammed,
    _presses,
    at_speed,
    eased,
    follow,
    may_move,
    move_body,
    move_tip,
)
from clamber.families.climber.execution.postures import postures
from clamber.families.climber.execution.slip import SlipWatch
from clamber.families.climber.execution.swing_contact_monitor import PushedBody
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.families.climber.sim.climber_plant import BodySensed, ClimberPlant
from clamber.families.climber.trials.run_plan import climbing_task
from clamber.families.climber.world.library import load_board
from clamber.planning.problem.plan_source import open_plan
from clamber.sim.limb_flaws import LimbFlaws
from clamber.tasks.robots import load_robot
from clamber.types import Floats

NOMINAL = LimbFlaws(backlash=np.radians(2.0), physics_rate=1000.0, encoder_counts=400, delay=1)
ELBOWS = {"right": -1, "left": 1}
RIGHT, LEFT, BOTTOM = 0, 1, 2
START = np.array((0.2286, 0.1374, 0.0))  # 15 mm below the two pegs that carry


class TurnedEncoder:
    """A plant whose body encoder tells an angle that is off by a constant [rad]."""

    def __init__(self, plant: ClimberPlant, offset: float) -> None:
        self.plant, self.offset, self.period = plant, offset, plant.period
        self.reset, self.actuate, self.step, self.pause = plant.reset, plant.actuate, plant.step, plant.pause

    def sense(self) -> BodySensed:
        sensed = self.plant.sense()
        return sensed._replace(angle=sensed.angle + self.offset)


def on_the_ladder(
    flaws: LimbFlaws = NOMINAL,
    pegs: Floats | None = None,
    *,
    map_error: float = 0.00635,
    offset: float = 0.0,
    backlash: float | None = None,
) -> tuple[Climber, ClimberPlant]:
    robot, board = load_robot("libra"), load_board("ladder")
    assert isinstance(robot, LimbedRobot)
    plant = ClimberPlant(robot, board, flaws, pegs=pegs)
    climber = Climber(robot, board, TurnedEncoder(plant, offset), map_error=map_error, backlash=backlash)
    climber.start(START, {"right": 4, "left": 3, "bottom": 2}, idle="bottom", elbows=ELBOWS)
    return climber, plant


def test_the_robot_hangs_on_two_hooks_and_hardly_creeps() -> None:
    climber, plant = on_the_ladder()
    climber.wait(2.0)
    before = plant.truth().pose
    climber.wait(1.0)
    np.testing.assert_allclose(plant.truth().pose, before, atol=1e-3)  # within a second [m], [rad]
    np.testing.assert_allclose(climber.body.settled[:2], plant.truth().pose[:2], atol=2e-3)


@pytest.mark.parametrize("friction", [0.7, 1.3])
def test_a_hook_that_has_left_is_clear_of_its_peg(friction: float) -> None:
    climber, plant = on_the_ladder(NOMINAL.with_changes(friction=friction))
    climber.wait(0.5)
    release(climber, BOTTOM)
    # the flare's lips end 15 mm before the seat, the peg's far side is 5 mm beyond its centre
    assert float(np.hypot(*(plant.truth().tips[BOTTOM] - climber.holds[2]))) > 0.020


def test_a_hook_drawn_back_while_the_body_moves_goes_straight_in_the_world() -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    climber.carry_with_all(but=BOTTOM)
    body, start, before = climber.body, climber.body.tip(BOTTOM), plant.truth().pose
    way, move = -0.045 * body.grab_direction(BOTTOM), np.array((0.0, 0.03, 0.0))
    true = plant.truth().tips[BOTTOM]
    move_body(climber, body.aim + move, drawn=(BOTTOM, start, way))
    climber.wait(0.3)
    # a peg in its slot, a tip that lags, and play of two degrees: millimetres
    np.testing.assert_allclose(plant.truth().tips[BOTTOM] - true, way, atol=5e-3)
    np.testing.assert_allclose(plant.truth().pose[:2] - before[:2], move[:2], atol=5e-3)


@pytest.mark.parametrize("length", [0.0, 0.05, 0.9, 4.0])
def test_a_way_goes_from_rest_to_rest_within_speed_and_agility(length: float) -> None:
    period = 0.001
    done = np.concatenate(([0.0], at_speed(length, period), [length]))
    speed = np.diff(done) / period
    assert speed.min() >= -1e-9
    assert speed.max() <= JOINT_SPEED + 1e-9
    assert np.abs(np.diff(np.concatenate(([0.0], speed, [0.0])))).max() <= 1.01 * JOINT_AGILITY * period


@pytest.mark.parametrize("stop", [0.3, 9.0])
def test_a_limb_that_something_holds_on_its_way_stays_there_and_pulls_no_more(stop: float) -> None:
    q, ticks, farthest = np.zeros((1, 2)), 0, 0.0
    task = LimbTask("swing_cartesian")

    def tick() -> None:
        """The joints come after what is asked of them, the first as far as something that it cannot move."""
        nonlocal ticks, farthest
        q[0] += 0.5 * (task.angles - q[0])
        q[0, 0] = min(q[0, 0], stop)
        ticks, farthest = ticks + 1, max(farthest, float(np.abs(task.angles - q[0]).max()))

    body = hanging_body(task, q)
    climber = usual_climber(body, tick)
    came = follow(cast(Climber, climber), 0, np.array(((0.0, 0.0), (0.8, -0.4))))
    assert came == (stop > 0.8)
    assert farthest < LAG[1] + 0.01
    assert ticks * 0.005 < (0.8 / JOINT_SPEED + 1.5 if came else 0.3 / JOINT_SPEED + 1.0)
    np.testing.assert_allclose(task.angles, (0.8, -0.4) if came else q[0], atol=1e-12)
    np.testing.assert_array_equal(task.rates, 0.0)
    np.testing.assert_array_equal(task.accelerations, 0.0)


def usual_climber(body: SimpleNamespace, tick: Callable[[], None]) -> SimpleNamespace:
    """What goes along a way with motors as fast as usual."""
    plant = SimpleNamespace(period=0.005)
    return SimpleNamespace(body=body, plant=plant, tick=tick, holding=list, swiftness=1.0, agility=1.0)


def hanging_body(task: LimbTask, q: Floats) -> SimpleNamespace:
    """What a free limb that goes along a way knows of a body that hangs on another one."""
    jobs = np.zeros(2, LIMB_TASK)
    jobs["mode"][1] = HANG
    work = SimpleNamespace(pose=np.zeros(3), aimed=np.zeros(3), jobs=jobs)
    return SimpleNamespace(tasks=[task], q=q, play=np.zeros((1, 2)), work=work)


@pytest.mark.parametrize("seed", range(6))
def test_no_joint_is_sped_up_beyond_what_its_motor_and_the_body_bear(seed: int) -> None:
    """Whatever corners a way has, and however sharp."""
    rng = np.random.default_rng(seed)
    way = np.cumsum(rng.uniform(-0.6, 0.6, (12, 2)), axis=0)
    task, q, rates = LimbTask("swing_cartesian"), way[:1].copy(), [np.zeros(2)]

    def tick() -> None:
        q[0] = task.angles
        assert np.abs(task.accelerations).max() <= SURGE * (1.0 + 1e-9)
        rates.append(task.rates.copy())

    body = hanging_body(task, q)
    climber = usual_climber(body, tick)
    assert follow(cast(Climber, climber), 0, way)
    # the change of pace at a corner comes to it
    assert np.abs(np.diff(rates, axis=0)).max() / 0.005 < 1.6 * SURGE


@pytest.mark.parametrize(("length", "rise"), [(0.2, 0.1), (1.9, 0.3), (1.0, 1.0)])
def test_an_eased_way_goes_from_rest_to_rest_and_its_speed_is_its_derivative(length: float, rise: float) -> None:
    t = np.linspace(0.0, length + rise, 4001)
    way, speed = np.array([eased(one, length, rise) for one in t]).T
    np.testing.assert_allclose(way[[0, -1]], (0.0, length), atol=1e-12)
    np.testing.assert_allclose(speed[[0, -1]], 0.0, atol=1e-12)
    assert speed.max() <= 1.0 + 1e-12
    np.testing.assert_allclose(np.gradient(way, t)[1:-1], speed[1:-1], atol=1e-4)


def test_the_body_moves_up_on_its_hooks() -> None:
    climber, plant = on_the_ladder()
    release(climber, BOTTOM)
    move_body(climber, START + np.array((0.0, 0.0762, 0.0)))
    climber.wait(0.5)
    np.testing.assert_allclose(plant.truth().pose[:2], START[:2] + np.array((0.0, 0.0762)), atol=0.01)


def test_a_body_that_something_holds_on_its_way_goes_back_before_its_hooks_come_off() -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    release(climber, BOTTOM)
    climber.wait(0.5)
    start, aims = climber.body.aim.copy(), []

    class HeldBack:
        """A spring of 8 kN/m that holds the body where it is, as a limb that is caught on a hold does."""

        def __init__(self) -> None:
            self.pose = plant.truth().pose[:2].copy()

        def __call__(self) -> None:
            x, y = 8000.0 * (self.pose - plant.truth().pose[:2])
            plant.push((float(x), float(y)))
            aims.append(climber.body.aim.copy())

    climber.balance = HeldBack()
    move_body(climber, start + np.array((0.0, 0.15, 0.0)))
    climber.wait(0.3)
    assert 0.02 < max(aim[1] for aim in aims) - start[1] < 0.05  # it tries
    np.testing.assert_allclose(climber.body.aim, start, atol=1e-9)
    assert all(climber.body.tasks[i].hold for i in (RIGHT, LEFT))


@pytest.mark.parametrize(("seed", "error", "friction"), [(0, 0.0, 1.0), (4, 0.00635, 0.75), (11, 0.00635, 1.25)])
def test_a_rung_is_climbed_and_every_hook_is_seated(seed: int, error: float, friction: float) -> None:
    places = load_board("ladder").positions()
    pegs = places + np.random.default_rng(seed).uniform(-error, error, places.shape)
    climber, plant = on_the_ladder(NOMINAL.with_changes(friction=friction), pegs)
    climber.wait(0.5)
    climber.learn_start()
    for limb, number, elbow in ((RIGHT, 6, -1), (BOTTOM, 1, 1), (LEFT, 5, 1)):
        result = grab(climber, limb, number, elbow=elbow)
        assert result.held, (limb, number, result)
        np.testing.assert_allclose(plant.truth().tips[limb], pegs[number - 1], atol=2e-3)
        # all of them together may be off as far as those are on which it began
        np.testing.assert_allclose(climber.holds[number] - climber.holds[3], pegs[number - 1] - pegs[2], atol=5e-3)
    release(climber, BOTTOM)
    move_body(climber, START + np.array((0.0, 0.1524, 0.0)))
    climber.wait(0.3)
    np.testing.assert_allclose(plant.truth().pose[:2], START[:2] + np.array((0.0, 0.1524)), atol=0.015)


@pytest.mark.parametrize("aside", [-0.010, 0.010])
@pytest.mark.parametrize("up", [-0.004, 0.004])
def test_a_peg_that_is_farther_off_than_the_map_may_be_is_found_all_the_same(aside: float, up: float) -> None:
    pegs = load_board("ladder").positions()
    pegs[5] += aside, up
    climber, plant = on_the_ladder(NOMINAL, pegs)
    climber.wait(0.5)
    # the hook passes beside it in all but one of these, and a lip of its flare is then below the peg
    assert grab(climber, RIGHT, 6, elbow=-1).held
    np.testing.assert_allclose(plant.truth().tips[RIGHT], pegs[5], atol=2e-3)


@pytest.mark.parametrize(("offset", "believed"), [(0.4, 1.6), (-0.4, 2.4)])
def test_a_rung_teaches_what_the_sensors_tell_wrong(offset: float, believed: float) -> None:
    climber, plant = on_the_ladder(map_error=0.001, offset=np.radians(offset), backlash=np.radians(believed))
    climber.wait(0.5)
    climber.learn_start()
    for limb, number, elbow in ((RIGHT, 6, -1), (BOTTOM, 1, 1), (LEFT, 5, 1)):
        assert grab(climber, limb, number, elbow=elbow).held
        np.testing.assert_allclose(plant.truth().tips[limb], load_board("ladder").positions()[number - 1], atol=2e-3)
    assert np.degrees(climber.map.offset) == pytest.approx(offset, abs=0.2)
    assert abs(2 * climber.map.half_play - NOMINAL.backlash) < abs(np.radians(believed) - NOMINAL.backlash)


def test_what_errors_of_the_sensors_do_to_a_difference_of_tips_is_its_derivative() -> None:
    climber, plant = on_the_ladder(backlash=np.radians(1.8))
    climber.wait(1.0)
    body, small = climber.body, 1e-6
    sensed = plant.sense()

    def difference(turned: float, played: float) -> Floats:
        play = body.play.copy()
        body.play *= 1.0 + played / (0.5 * body.backlash)
        body.see(sensed.q, sensed.qd, sensed.angle - turned, sensed.angle_speed)
        body.play[:] = play
        return body.tip(RIGHT) - body.tip(LEFT)

    here = difference(0.0, 0.0)
    seen = climber.seen(RIGHT, LEFT)
    np.testing.assert_allclose(seen.place, here, atol=1e-12)
    np.testing.assert_allclose(seen.by_angle, (difference(small, 0.0) - here) / small, atol=1e-5)
    np.testing.assert_allclose(seen.by_play, (difference(0.0, small) - here) / small, atol=1e-5)


def test_without_its_hooks_the_robot_falls_and_says_so() -> None:
    climber, _ = on_the_ladder()
    for task in climber.body.tasks:
        task.mode, task.hold = "swing_joint", 0
    with pytest.raises(FallenError, match="no limb holds"):
        climber.tick()


def test_a_hook_that_slips_off_is_noticed() -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    plant.push((0.0, 400.0))
    with pytest.raises(FallenError, match=r"come off|off its aim"):
        climber.wait(3.0)
    assert climber.time < 2.0


@pytest.mark.parametrize(("turn", "felt", "told"), [
    (1.0, (0.0, 20.0), False), (2.6, (20.0, 20.0), False), (2.6, (20.0, 1.0), True), (2.6, (0.0, 20.0), True), (9.0, (20.0, 20.0), True),
])  # fmt: skip
def test_a_body_that_turns_within_the_play_of_its_joints_has_lost_no_hook_that_bears(
    turn: float, felt: tuple[float, float], told: bool
) -> None:
    """A free limb that is sped up throws it about by as much, and the encoders of the motors tell nothing of it."""
    climber, _ = on_the_ladder()
    climber.wait(0.5)
    release(climber, BOTTOM)
    body, watch, forces = climber.body, SlipWatch(climber.body), np.zeros((3, 2))
    forces[(RIGHT, LEFT), 0] = felt
    assert watch.see(forces) is None
    for pose in (body.pose, body.settled):
        pose[2] += np.radians(turn)
    assert (watch.see(forces) is not None) is told


def test_limbs_are_asked_whether_they_would_hold_before_they_do() -> None:
    climber, _ = on_the_ladder()
    climber.wait(0.2)
    body = climber.body
    assert body.stands(START, [RIGHT, LEFT]) == pytest.approx(body.stands(START))
    assert body.stands(START, [RIGHT, LEFT]) == pytest.approx(body.stands(START, [LEFT, RIGHT]), abs=1e-6)
    assert body.stands(START - np.array((0.0, 0.5, 0.0)), [RIGHT, LEFT]) == -np.inf  # out of reach
    before = body.stands(START, [RIGHT, BOTTOM])
    climber.carry_with_all(but=LEFT)
    assert body.stands(START) == pytest.approx(before, abs=2.0)  # the body sways and the joints' play turns round [N]


@pytest.mark.parametrize("flaws", [LimbFlaws(physics_rate=1000.0), NOMINAL], ids=["ideal", "nominal"])
def test_a_free_limb_keeps_to_its_way(flaws: LimbFlaws) -> None:
    """With what its model tells of rotors, friction and weight fed forward; without, it lags by a degree or two, at the tip 10 mm."""
    climber, _ = on_the_ladder(flaws)
    climber.wait(0.5)
    release(climber, BOTTOM)
    climber.wait(0.3)
    body, tick, lag = climber.body, climber.tick, 0.0

    def watched() -> None:
        nonlocal lag
        tick()
        lag = max(lag, float(np.abs(body.tasks[BOTTOM].angles - body.q[BOTTOM]).max()))

    climber.tick = watched  # type: ignore[method-assign]
    start = body.q[BOTTOM] - body.play[BOTTOM]
    assert follow(climber, BOTTOM, np.array((start, start + np.array((0.6, -0.5)))))
    assert lag < np.radians(0.3)


@pytest.mark.parametrize(("force", "told"), [(10.0, False), (50.0, True)])
def test_a_body_that_is_pushed_up_is_told_before_its_hooks_are_off(force: float, told: bool) -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    release(climber, BOTTOM)
    climber.wait(0.5)
    watch, pushed, off = PushedBody(climber), False, 0.0
    plant.push((0.0, force))
    for _ in range(100):
        climber.tick()
        pushed = pushed or watch.gives_way(BOTTOM)
        if not pushed:
            tips = plant.truth().tips
            off = max(float(np.hypot(*(tips[i] - climber.holds[hold]))) for i, hold in ((RIGHT, 4), (LEFT, 3)))
    assert pushed is told
    assert off < 2e-3


@pytest.mark.parametrize("aside", [0.010, 0.014, -0.012])
def test_a_hook_that_goes_against_a_hold_stops_before_it_takes_others_off(aside: float) -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    g, hold = climber.body.grab_direction(BOTTOM), climber.holds[2].copy()
    release(climber, BOTTOM)
    climber.wait(0.3)
    assert not move_tip(climber, BOTTOM, hold + 0.05 * g + aside * np.array((-g[1], g[0])), 0.8)
    tips = plant.truth().tips
    assert max(float(np.hypot(*(tips[i] - climber.holds[n]))) for i, n in ((RIGHT, 4), (LEFT, 3))) < 2.5e-3


def test_hooks_that_press_hard_already_jam_nothing() -> None:
    """Two that hold each other sideways press with twice the weight before the body moves; what jams, presses harder as it does."""
    climber, _ = on_the_ladder()
    climber.wait(0.5)
    weight = climber.robot.weight
    climber.fall.forces[:] = 0.0
    climber.fall.forces[RIGHT] = 2.0 * weight, 0.0
    before = _presses(climber)
    assert before.tolist() == [pytest.approx(2.0 * weight), 0.0, 0.0]
    assert not _is_jammed(climber, before)
    assert _is_jammed(climber, 0.5 * before)
    climber.fall.forces[RIGHT] = np.inf
    assert not _is_jammed(climber, np.zeros(3))


def test_a_body_makes_no_room_where_limbs_that_hold_would_meet_other_holds() -> None:
    climber, _ = on_the_ladder()
    climber.wait(0.5)
    body, may, met = climber.body, may_move(climber), 0
    sizes = [climber.peg_radius + climber.map.error(number) for number in climber.holds]
    for x, y, angle in itertools.product(np.linspace(-0.1, 0.1, 9), np.linspace(-0.1, 0.1, 9), (-0.3, 0.0, 0.3)):
        pose = body.settled + np.array((x, y, angle))
        if body.stands(pose) < 0.0:
            continue
        rooms = []
        for i, task in enumerate(body.tasks):
            limb, side = climber.robot.limbs[i], body.q[i, 1]
            fit = [one for one in postures(limb, pose, task.place) if one.angles[1] * side > 0.0]
            if not fit:
                rooms.append(-1.0)
                continue
            turn = np.array(((np.cos(pose[2]), -np.sin(pose[2])), (np.sin(pose[2]), np.cos(pose[2]))))
            port = pose[:2] + turn @ (limb.port_x, limb.port_y)
            first = pose[2] + limb.port_angle + fit[0].angles[0]
            elbow = port + limb.l1 * np.array((np.cos(first), np.sin(first)))
            for (number, place), size in zip(climber.holds.items(), sizes, strict=True):
                links = ((port, elbow), (elbow, task.place)) if number != task.hold else ()
                rooms += [_distance(a, b, place) - climber.robot.link_radius - size for a, b in links]
        if min(rooms) < -1e-3:
            met += 1
            assert not may(pose)
    assert met > 3


def _distance(a: Floats, b: Floats, point: Floats) -> float:
    """Of a point from a segment [m]."""
    along = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
    return float(np.hypot(*(a + along * (b - a) - point)))


def stretched(climber: Climber, degrees: float) -> Floats:
    """Bring the bottom limb, free, to where its elbow is bent by so much, below the body; where it points, unit vector."""
    climber.wait(0.5)
    release(climber, BOTTOM)
    body, limb = climber.body, climber.robot.limbs[BOTTOM]
    bend = math.radians(degrees)
    reach = math.sqrt(limb.l1**2 + limb.l2_effective**2 + 2.0 * limb.l1 * limb.l2_effective * math.cos(bend))
    down = np.array((math.cos(-2.0), math.sin(-2.0)))
    place = body.settled[:2] + (limb.port_x, limb.port_y) + reach * down
    there = next(one for one in postures(limb, body.settled, place) if one.angles[1] < 0.0)
    assert follow(climber, BOTTOM, np.array((body.q[BOTTOM], there.angles)))
    climber.wait(0.2)
    return down


@pytest.mark.parametrize("degrees", (7.0, 12.0, 20.0))
def test_a_nearly_straight_limb_draws_its_hook_straight_back(degrees: float) -> None:
    """By its tip's law the elbow, which is to bend at once, was thrown: the hook went 60 mm aside and past the hold."""
    climber, plant = on_the_ladder()
    down = stretched(climber, degrees)
    start, where, tick = plant.truth().tips[BOTTOM], [], climber.tick

    def watched() -> None:
        tick()
        where.append(plant.truth().tips[BOTTOM] - start)

    climber.tick = watched  # type: ignore[method-assign]
    assert hook._comes_to(climber, BOTTOM, climber.body.tip(BOTTOM) - 0.05 * down)
    climber.tick = tick  # type: ignore[method-assign]
    way = np.array(where)
    along, aside = -way @ down, way @ np.array((-down[1], down[0]))
    assert along.max() < 0.06 and along[-1] > 0.04
    assert np.abs(aside).max() < 0.015
    assert np.diff(along).max() / plant.period < 2.0 * hook.BACK_SPEED  # of the tip's law; the joints could thrice that


@pytest.mark.parametrize("way", (0.02, 0.04, 0.06))
def test_a_hook_that_its_joints_draw_back_and_something_holds_gives_way_before_others_come_off(way: float) -> None:
    """As fast as the joints go, the body was pushed by 16 mm, and hooks came off: here the peg itself holds the hook."""
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    body, before = climber.body, np.array(plant.truth().pose[:2])
    climber.carry_with_all(but=BOTTOM)
    body.tasks[BOTTOM].hold = 0
    body.tasks[BOTTOM].stay(body.q[BOTTOM])
    pushed, off, tick = [], [], climber.tick

    def watched() -> None:
        tick()
        truth = plant.truth()
        pushed.append(math.dist(truth.pose[:2], before))
        off.extend(math.dist(truth.tips[i], climber.holds[body.tasks[i].hold]) for i in (RIGHT, LEFT))

    climber.tick = watched  # type: ignore[method-assign]
    place = body.tip(BOTTOM) + way * body.grab_direction(BOTTOM)
    assert not hook._comes_by_joints(climber, BOTTOM, place)
    climber.wait(0.3)
    assert max(pushed) < 0.009 and max(off) < 0.002


@pytest.mark.parametrize("end", (-0.006, 0.0, 0.006))
def test_after_a_miss_a_hook_is_pushed_on_the_other_side_of_its_hold_first(end: float) -> None:
    g, hold = np.array((0.0, -1.0)), np.array((1.0, 0.5))
    found, before = Approach(np.zeros(2), np.zeros((1, 2)), g, 0.03), []
    tries = hook.places(cast(Climber, None), 0, hold, 0.01, found, before)
    aims = [next(tries)]
    before.append(hold + np.array((end, 0.01)))
    aims += list(tries)
    asides = [float(aim[0] - hold[0]) for aim in aims]
    side = 1.0 if end < 0.0 else -1.0
    assert asides == pytest.approx([0.0, 0.008 * side, -0.008 * side, 0.014 * side, -0.014 * side, 0.0])
    assert all(aim[1] == hold[1] for aim in aims)


TWIN = 0.025
"""Distance of the hold beyond the one that is to be taken [m]."""


@pytest.mark.parametrize(
    ("elbow", "short", "aside", "seated"),
    [
        (60.0, 0.008, 0.0, True),
        (12.0, 0.008, 0.0, False),  # at the end of its reach: never
        (30.0, 0.008, 0.0, True),
        (12.0, 0.002, 0.0, True),
        (12.0, 0.004, 0.0, False),
        (12.0, 0.0, 0.007, False),
        (60.0, 0.012, 0.0, False),  # on its flare
        (60.0, -0.006, 0.0, True),
        (60.0, -0.012, 0.0, True),  # the map is off by as much
        (60.0, -0.009, 0.010, False),  # past it, a link against it
        (60.0, -0.013, 0.0, False),  # on the next one
        (60.0, 0.0, 0.010, True),
        (60.0, 0.008, 0.010, False),  # on the end of its flare
    ],
)
@pytest.mark.parametrize("been", [False, True])
def test_where_a_hook_stops_tells_whether_it_is_on_its_hold(
    monkeypatch: pytest.MonkeyPatch, elbow: float, short: float, aside: float, seated: bool, been: bool
) -> None:
    """One that came there before, pushed on from elsewhere, may be farther off; but not where its limb is straight or on another hold."""
    monkeypatch.setattr(hook, "move_tip", lambda *_: True)
    monkeypatch.setattr(hook, "push_on", lambda *_: True)
    g = np.array((0.0, -1.0))
    tip = -short * g + np.array((aside, 0.0))
    body = SimpleNamespace(q=np.radians(((0.0, elbow),)), tip=lambda i: tip)
    holds = {1: np.zeros(2), 2: TWIN * g}
    found, before = Approach(np.zeros(2), np.zeros((1, 2)), g, 0.03), [tip + 0.001] if been else []
    close = hook.close(
        cast(Climber, SimpleNamespace(body=body, holds=holds, hangs=False)),
        0,
        holds[1],
        0.01,
        found,
        np.zeros(2),
        before,
    )
    never = (abs(elbow) < 25.0 and short > 0.006) or -short > TWIN / 2
    assert close is (seated or (been and not never))


@pytest.mark.parametrize(
    ("farther", "aside", "seated"),
    [
        (0.002, 0.006, True),
        (0.006, 0.006, False),  # it was on its hold, and has stopped on its flare now
        (0.006, 0.030, True),  # it had passed it by
        (-0.010, 0.006, True),  # it had stopped on its flare, and is home now
    ],
)
def test_a_hook_that_has_come_farther_in_an_earlier_try_is_not_home(
    monkeypatch: pytest.MonkeyPatch, farther: float, aside: float, seated: bool
) -> None:
    monkeypatch.setattr(hook, "move_tip", lambda *_: True)
    monkeypatch.setattr(hook, "push_on", lambda *_: True)
    g, hold, tip = np.array((0.0, -1.0)), np.zeros(2), np.array((0.0, -0.002))
    body = SimpleNamespace(q=np.ones((1, 2)), tip=lambda i: tip)
    climber = SimpleNamespace(body=body, holds={1: hold}, hangs=False)
    before = [tip + farther * g + np.array((aside, 0.0))]
    found = Approach(np.zeros(2), np.zeros((1, 2)), g, 0.03)
    assert hook.close(cast(Climber, climber), 0, hold, 0.007, found, hold, before) is seated


@pytest.mark.parametrize(("off", "home"), [(0.004, True), (0.008, True), (0.012, True), (0.03, False)])
def test_a_hook_that_has_slid_back_on_its_hold_is_pushed_home_from_there(off: float, home: bool) -> None:
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    body, task = climber.body, climber.body.tasks[BOTTOM]
    assert move_tip(climber, BOTTOM, body.tip(BOTTOM) - off * body.grab_direction(BOTTOM), 0.3)
    climber.wait(0.1)
    task.mode = "unloaded_contact"
    before = float(np.hypot(*(plant.truth().tips[BOTTOM] - climber.holds[2])))
    assert before == pytest.approx(off, abs=0.006)
    if not home:  # something lies in its way
        climber.holds[2] = climber.holds[2] + np.array((0.0, 0.06))
        task.place = climber.holds[2].copy()
    assert press_on(climber, BOTTOM) is home
    assert (task.hold, task.mode, task.side) == (2, "unloaded_contact", 0)
    if home:
        assert float(np.hypot(*(plant.truth().tips[BOTTOM] - climber.holds[2]))) < 0.004
        assert climber.latest == BOTTOM and not climber.proven


@pytest.mark.parametrize("direction", (-150, -120, -90, -60))
@pytest.mark.parametrize("elbow", (31, 42, 60))
def test_a_hook_goes_straight_to_where_its_hold_may_be_however_straight_its_limb(
    direction: float, elbow: float
) -> None:
    """The friction of one joint and the weight of a limb that is nearly straight would take it aside, past the hold."""
    climber, plant = on_the_ladder()
    climber.wait(0.5)
    release(climber, BOTTOM)
    climber.wait(0.3)
    body, limb, room = climber.body, climber.robot.limbs[BOTTOM], 0.015
    reach = math.sqrt(
        limb.l1**2 + limb.l2_effective**2 + 2.0 * limb.l1 * limb.l2_effective * math.cos(math.radians(elbow))
    )
    angle = math.radians(direction)
    place = body.settled[:2] + (limb.port_x, limb.port_y) + reach * np.array((math.cos(angle), math.sin(angle)))
    g = next(one for one in postures(limb, body.settled, place) if one.angles[1] < 0.0).grab
    start = next(one for one in postures(limb, body.settled, place - 0.03 * g) if one.angles[1] < 0.0)
    assert follow(climber, BOTTOM, np.array((body.q[BOTTOM], start.angles)))
    assert move_tip(climber, BOTTOM, place - 0.03 * g, 0.3)
    asides: list[float] = []
    tick = climber.tick

    def watched() -> None:
        lack = place - plant.truth().tips[BOTTOM]
        if float(lack @ g) < room:
            asides.append(float(g[0] * lack[1] - g[1] * lack[0]))
            raise StopIteration
        tick()

    climber.tick = watched  # type: ignore[method-assign]
    with pytest.raises(StopIteration):
        hook.push_on(climber, BOTTOM, place, g, room)
    assert abs(asides[0]) < 0.006  # the flare of a hook catches 15 mm either way, the map is off by 9 mm


@pytest.mark.parametrize("goes_home", [True, False])
@pytest.mark.parametrize("takes_it", [True, False])
@pytest.mark.parametrize("off", [(0.0, 0.012), (0.0, -0.03), (0.025, 0.0)], ids=["back", "beyond", "aside"])
def test_a_hold_that_a_clinging_limb_has_slid_off_is_taken_again_before_another_limb_acts(
    monkeypatch: pytest.MonkeyPatch, takes_it: bool, goes_home: bool, off: tuple[float, float]
) -> None:
    plan = open_plan("ladder-hand")
    course = lay_course(climbing_task(plan.task), plan.plan)
    step = next(k for k, action in enumerate(course.actions, 1) if action.kind == "release")
    names = [limb.name for limb in course.task.robot.limbs]
    acts = names.index(str(course.actions[step - 1].limb))
    tasks = [
        LimbTask("unloaded_contact" if i != acts else "stance", course.holds(step - 1)[name])
        for i, name in enumerate(names)
    ]
    slid = next(i for i, task in enumerate(tasks) if i != acts and task.hold)
    down = np.array((0.0, -1.0))
    body = SimpleNamespace(
        tasks=tasks,
        q=np.ones((3, 2)),
        grab_direction=lambda i: down,
        tip=lambda i: np.array(off) if i == slid else np.zeros(2),
    )
    took: list[tuple[int, int]] = []
    pressed: list[int] = []

    def press(_: Climber, i: int) -> bool:
        pressed.append(i)
        return goes_home

    def take(_: Climber, i: int, number: int, *, elbow: int) -> Grabbed:
        took.append((i, number))
        return Grabbed(takes_it, 1, 0.0, 0.0)

    def let(_: Climber, i: int) -> None:
        tasks[i].hold = 0

    monkeypatch.setattr(actor, "grab", take)
    monkeypatch.setattr(actor, "press_on", press)
    monkeypatch.setattr(actor, "release", let)
    climber = SimpleNamespace(robot=course.task.robot, body=body, hangs=False)
    outcome, _, why = actor.Actor(cast(Climber, climber), course).carry_out(step, step)
    # back in its slot, or off its hold
    assert pressed == ([slid] if off == (0.0, 0.012) else [])
    if pressed and goes_home:
        assert (took, outcome) == ([], "ok")
        return
    assert took == [(slid, tasks[slid].hold)]
    assert outcome == ("ok" if takes_it else "missed")
    assert ("slid off" in why) is not takes_it
    assert (tasks[acts].hold == 0) is takes_it
