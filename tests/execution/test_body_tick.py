"""The compiled tick of a climber's control does what the plain formulas say, for every law, map and limit, and allocates nothing."""

from collections.abc import Callable
from typing import Any, get_args

import numpy as np
import pytest
from numba import njit
from numba.core.runtime import _nrt_python, rtsys
from plain_body import PlainBody

from clamber.compiled import Handle
from clamber.control.controller import MeasurementError
from clamber.control.law_settings import LAWS
from clamber.families.climber.control.body_estimate import ENCODER
from clamber.families.climber.control.body_tick import BENT, STOP, command_tick, see_tick
from clamber.families.climber.execution.body_gains import LIMITS, MAPPINGS, BodyGains
from clamber.families.climber.execution.limb_task import LimbMode, LimbTask
from clamber.families.climber.execution.whole_body import WholeBody
from clamber.families.climber.robot.robot import LimbedRobot
from clamber.tasks.robots import load_robot

PERIOD = 0.005


def robot_named(name: str) -> LimbedRobot:
    robot = load_robot(name)
    assert isinstance(robot, LimbedRobot)
    return robot


def busy_pair(robot: LimbedRobot, gains: BodyGains, rng: np.random.Generator) -> tuple[WholeBody, PlainBody]:
    """Two bodies that are to do the same things: each limb something else, two of them holding where they can."""
    pair = WholeBody(robot, period=PERIOD, gains=gains), PlainBody(robot, period=PERIOD, gains=gains)
    modes = ["stance", "stance", *rng.choice(get_args(LimbMode), pair[0].n - 2)]
    rng.shuffle(modes)
    numbers = rng.normal(size=(pair[0].n, 6, 2))
    for body in pair:
        for i, mode in enumerate(modes):
            place, speed, angles, rates, force, tug = numbers[i] * np.array([[0.3], [0.1], [1.0], [1.0], [10.0], [5.0]])
            pressed = bool(numbers[i, 0, 0] > 0.0)
            loads = numbers[i, 0] + numbers[i, 1]
            task = LimbTask(
                mode,
                i + 1,
                place,
                speed,
                angles=angles,
                rates=rates,
                accelerations=4.0 * rates[::-1],
                loads=loads,
                force=force,
                tug=tug,
                pressed=pressed,
            )
            body.assign(i, task)
    return pair


def tick_both(pair: tuple[WholeBody, PlainBody], rng: np.random.Generator, *, angle_from: int = ENCODER) -> None:
    n = pair[0].n
    q, qd = rng.uniform(-1.0, 1.0, (n, 2)) + np.array((0.0, 1.5)), rng.normal(0.0, 0.5, (n, 2))
    angle, angle_speed = rng.normal(0.0, 0.1, 2)
    aim, aim_speed = rng.normal(0.0, 0.1, (2, 3))
    for body in pair:
        body.aim[:], body.aim_speed[:] = aim, aim_speed
        body.see(q, qd, angle, angle_speed, angle_from=angle_from)
        body.command()


def assert_alike(pair: tuple[WholeBody, PlainBody]) -> None:
    compiled, plain = pair
    for name in ("pose", "twist", "settled", "tips", "tip_speeds", "settled_tips", "torques", "play"):
        np.testing.assert_allclose(getattr(compiled, name), getattr(plain, name), rtol=1e-9, atol=1e-10, err_msg=name)
    for name in ("tip", "felt_tip", "tip_speed", "grab_direction"):
        for i in range(compiled.n):
            np.testing.assert_allclose(getattr(compiled, name)(i), getattr(plain, name)(i), atol=1e-10, err_msg=name)


@pytest.mark.parametrize("name", ["libra", "gecko4"])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("mapping", MAPPINGS)
@pytest.mark.parametrize("limit", LIMITS)
def test_every_map_and_limit_gives_the_torques_of_the_plain_formulas(
    name: str, seed: int, mapping: str, limit: str
) -> None:
    rng = np.random.default_rng(seed)
    pair = busy_pair(robot_named(name), BodyGains(mapping=mapping, limit=limit), rng)
    for k in range(5):
        tick_both(pair, rng, angle_from=k % 3)
        assert_alike(pair)


@pytest.mark.parametrize("law", LAWS)
def test_every_law_of_the_limb_bench_serves_the_body(law: str) -> None:
    rng = np.random.default_rng(5)
    pair = busy_pair(robot_named("libra"), BodyGains(law=law), rng)
    for _ in range(5):  # laws that remember, too
        tick_both(pair, rng)
        assert_alike(pair)


@pytest.mark.parametrize("mode", get_args(LimbMode))
def test_so_do_limbs_that_all_do_the_same(mode: LimbMode) -> None:
    rng = np.random.default_rng(6)
    pair = busy_pair(robot_named("libra"), BodyGains(), rng)
    for body in pair:
        for task in body.tasks:
            task.mode = mode
    for _ in range(3):
        tick_both(pair, rng)
        assert_alike(pair)


def test_so_it_does_while_the_load_passes_on() -> None:
    rng = np.random.default_rng(7)
    pair = busy_pair(robot_named("libra"), BodyGains(), rng)
    for body in pair:
        for task, mode in zip(body.tasks, ("stance", "stance", "unloaded_contact"), strict=True):
            task.mode = mode  # type: ignore[assignment]
    tick_both(pair, rng)
    for body in pair:
        body.hand_over({1, 2})
    parts = 0
    while pair[0].handing_over:
        tick_both(pair, rng)
        assert_alike(pair)
        parts += 1
    assert parts > 50
    assert [task.mode for task in pair[0].tasks] == ["unloaded_contact", "stance", "stance"]


@njit
def hand_over_an_array(array: Any) -> Any:
    return array[0]


def allocations(call: Callable[..., Any], *args: object) -> int:
    before = rtsys.get_allocation_stats().alloc
    call(*args)
    return int(rtsys.get_allocation_stats().alloc - before)


def test_a_tick_allocates_nothing() -> None:
    rng = np.random.default_rng(8)
    body, plain = busy_pair(robot_named("libra"), BodyGains(), rng)
    tick_both((body, plain), rng)
    work = Handle(body.work)
    hand_over_an_array(body.torques)
    see_tick(work, 0.1, 0.0, ENCODER)
    _nrt_python.memsys_enable_stats()
    assert (
        allocations(hand_over_an_array, body.torques) > 0
    )  # so they are counted: an array that is handed over has a counter
    assert allocations(see_tick, work, 0.1, 0.0, ENCODER) == 0
    for mode in get_args(LimbMode):
        body.tasks[2].mode = mode
        body.command()  # notes what the limb is mode
        assert allocations(command_tick, work) == 0
        body.hand_over([i for i, task in enumerate(body.tasks) if task.holds][:1])
        assert allocations(command_tick, work) == 0


def test_a_measurement_that_is_not_finite_is_named() -> None:
    body, _ = busy_pair(robot_named("libra"), BodyGains(), np.random.default_rng(9))
    for task in body.tasks:
        task.mode = "stance"
    q = np.ones((3, 2))
    q[1, 1] = np.nan
    body.see(q, np.zeros((3, 2)), 0.0, 0.0)
    with pytest.raises(MeasurementError):
        body.command()


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("part", [-0.5, 0.0, 0.5, 1.0, 2.0])
def test_an_elbow_is_kept_from_straight_by_a_soft_stop_and_nothing_else_is_touched(side: int, part: float) -> None:
    torques = []
    for kept in (0, side):
        body = WholeBody(robot_named("libra"), period=PERIOD)
        body.assign(1, LimbTask("contact_push", force=np.array((3.0, -8.0)), side=kept))
        q = np.array(((0.2, 1.0), (0.4, side * part * BENT), (-0.3, 0.8)))
        body.see(q, np.zeros_like(q), 0.1, 0.0)
        torques.append(body.command().copy())
    more = torques[1] - torques[0]
    assert more[1, 1] == pytest.approx(side * STOP * max(0.0, 1.0 - part), abs=1e-12)
    more[1, 1] = 0.0
    np.testing.assert_array_equal(more, 0.0)
