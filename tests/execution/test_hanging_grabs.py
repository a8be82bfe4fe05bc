"""Grabs from a hang: the hook comes home on a hold that it comes to from the side, and a try that missed does as little harm as can be."""

import copy
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from clamber.families.climber.execution import actor as actor_module
from clamber.families.climber.execution import hook
from clamber.families.climber.execution.actor import Actor
from clamber.families.climber.execution.approach import Approach
from clamber.families.climber.execution.climb_trace import TracedClimber
from clamber.families.climber.execution.climber import Climber
from clamber.families.climber.execution.executable_plan import ExecutablePlan, lay_course
from clamber.families.climber.execution.hold_map import HoldMap
from clamber.families.climber.execution.remaining_task import task_from_here
from clamber.families.climber.trials.planning import VALIDATION_NOISE
from clamber.families.climber.trials.run_plan import ClimbRun, climbing_flaws, climbing_task, run_plan
from clamber.planning.problem.plan import Plan, load_plan
from clamber.tasks import load_task, task_from_document
from clamber.types import Floats

SAVED = Path(__file__).parents[2] / "examples" / "across" / "plan.json"
RIGHT, LEFT = 0, 1
BEFORE = 137
"""Step of the saved plan with which the body goes below the right limb's hold: four moves, then the left limb grabs 8 in on."""


def mapped(course: ExecutablePlan) -> HoldMap:
    """The holds of a course's board, known exactly."""
    return HoldMap({hold.number: np.array((hold.x, hold.y)) for hold in course.task.world.holds}, 0.0)


@pytest.fixture(scope="module")
def single_row() -> ExecutablePlan:
    """The saved plan along the single row, from before the body goes below the right limb's hold, on pegs 26 and 27, to its end."""
    task = climbing_task(load_task("across-hanging"))
    whole = load_plan(SAVED)
    course = lay_course(task, whole)
    document = copy.deepcopy(task_from_here(course, BEFORE, course.holds(BEFORE - 1), set()).document)
    document.pop("subgoals")  # it is beyond them
    here = climbing_task(task_from_document(document, "on the single row"))
    return lay_course(here, Plan.of_codes(here, whole.codes(task)[BEFORE - 1 :], planner="beam"))


def climb(course: ExecutablePlan, actions: int, seed: int) -> ClimbRun:
    """The first actions of a course, pegs 3 mm off."""
    whole = load_plan(SAVED)
    codes = whole.codes(climbing_task(load_task("across-hanging")))[BEFORE - 1 :]
    plan = Plan.of_codes(course.task, codes[:actions], planner="beam")
    return run_plan(course.task, plan, climbing_flaws(course.task, ()), noise=VALIDATION_NOISE, seed=seed)


def true_tip(run: ClimbRun, i: int) -> Floats:
    """Where the tip of limb `i` truly is at the end [m]."""
    assert run.trace.true_pose is not None and run.trace.true_angles is not None
    pose, (shoulder, elbow), limb = run.trace.true_pose[-1], run.trace.true_angles[-1, i], run.task.robot.limbs[i]
    turn = np.exp(1j * pose[2])
    first = turn * np.exp(1j * (limb.port_angle + shoulder))
    second = first * np.exp(1j * (elbow + limb.hook_beta))
    tip = (
        complex(pose[0], pose[1])
        + turn * complex(limb.port_x, limb.port_y)
        + limb.l1 * first
        + limb.l2_effective * second
    )
    return np.array((tip.real, tip.imag))


@pytest.mark.parametrize("seed", [2, 13])
def test_a_hook_that_comes_from_the_side_to_a_hanging_body_comes_home(single_row: ExecutablePlan, seed: int) -> None:
    run = climb(single_row, 5, seed)
    taken = run.report.actions[-1]
    assert (taken.title, taken.outcome, taken.tries) == ("left grabs 28", "ok", 1), run.reason
    pegs = run.task.world.positions() + run.drawn.pegs
    for limb, number in ((RIGHT, 26), (LEFT, 28)):
        peg = pegs[[hold.number for hold in run.task.world.holds].index(number)]
        # on its peg, not on the flare before it, 8 to 16 mm off
        assert true_tip(run, limb) == pytest.approx(peg, abs=3e-3), (limb, number)
    # the load passes to both where the body leans on them: let go, it would swing back by some 30 mm and pull the hook off
    true = run.trace.true_pose
    assert true is not None and run.trace.carries[-1].tolist() == [1, 1, 0]
    assert np.ptp(true[run.trace.time > run.trace.time[-1] - 0.4, :2], axis=0).max() < 2e-3
    # what is believed of it is not thrown by a seat that is none
    assert taken.tip_error is not None and taken.tip_error < 6e-3


class Knock:
    """Of a limb: the peg is not there for a quarter of a second, some ticks after a step has begun and two limbs carry."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, limb: int, step: int, ticks: int) -> None:
        self.at: float | None = None
        """When [s]."""
        self.geom, left, tick = -1, ticks, TracedClimber.tick

        def watched(climber: TracedClimber) -> None:
            nonlocal left
            model, tasks = cast(Any, climber.plant).model, climber.body.tasks
            if self.at is None and climber.step >= step and sum(task.mode == "stance" for task in tasks) == 2:
                left -= 1
                if left < 0:
                    self.at, self.geom = climber.time, model.geom(f"peg {tasks[limb].hold}").id
                    self.kept = int(model.geom_contype[self.geom]), int(model.geom_conaffinity[self.geom])
                    model.geom_contype[self.geom] = model.geom_conaffinity[self.geom] = 0
            elif self.at is not None and climber.time > self.at + 0.25:
                model.geom_contype[self.geom], model.geom_conaffinity[self.geom] = self.kept
            tick(climber)

        monkeypatch.setattr(TracedClimber, "tick", watched)


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "ticks"), [(1, 20), (2, 300)])
def test_a_hook_lost_on_the_single_row_is_brought_back_by_the_plan_that_led_there(
    monkeypatch: pytest.MonkeyPatch, single_row: ExecutablePlan, seed: int, ticks: int
) -> None:
    knock = Knock(monkeypatch, LEFT, 6, ticks)
    run = climb(single_row, 13, seed)
    assert knock.at is not None
    moved = run.report.actions[-1]
    # hanging, no limb comes to the lost hold from above; it goes back to the one before, and takes the lost one as it did
    assert (moved.title, moved.outcome, moved.recovered) == ("+x, 8 times", "ok", 1), run.reason
    assert run.trace.holds[-1, [RIGHT, LEFT]].tolist() == [26, 28]


def test_the_robot_catches_up_from_the_stance_with_its_holds_nearest_to_where_it_is(
    monkeypatch: pytest.MonkeyPatch, single_row: ExecutablePlan
) -> None:
    limbs = single_row.task.robot.limbs
    sides = single_row.elbows[0]
    tasks = [SimpleNamespace(hold=single_row.holds(0)[limb.name]) for limb in limbs]
    body = SimpleNamespace(
        tasks=tasks, q=0.5 * np.stack((sides, sides), axis=1), aim=single_row.pose(2), settled=single_row.pose(2)
    )
    actor = Actor(
        cast(Climber, SimpleNamespace(robot=single_row.task.robot, body=body, map=mapped(single_row))), single_row
    )
    went: list[Floats] = []
    done: list[tuple[int, int]] = []

    def carry_out(first: int, last: int) -> tuple[str, int, str]:
        done.append((first, last))
        return "ok", 1, ""

    monkeypatch.setattr(actor_module, "move_body", lambda climber, pose: went.append(pose))
    monkeypatch.setattr(actor, "carry_out", carry_out)
    assert actor.catch_up(14)  # the moves before the grab are one group, which it is in the middle of: on with the grab
    assert went == [pytest.approx(single_row.pose(2))]
    assert done == [(5, 5), (6, 13)]
    assert not actor.catch_up(1)
    body.q[LEFT] *= -1.0  # on the same hold, with the elbow on the other side
    assert not actor.catch_up(14)
    body.q[LEFT] *= -1.0
    tasks[LEFT].hold = 0
    assert not actor.catch_up(14)


@pytest.mark.parametrize("past", [-0.006, 0.02, 0.035])
@pytest.mark.parametrize("aside", [-0.02, 0.0, 0.02])
def test_a_hook_that_missed_goes_back_the_way_it_came(
    monkeypatch: pytest.MonkeyPatch, past: float, aside: float
) -> None:
    g, hold = np.array((-0.6, 0.8)), np.array((1.0, 0.5))
    h = np.array((-g[1], g[0]))
    places = [hold + past * g + aside * h]

    def comes_to(climber: Climber, i: int, place: Floats) -> bool:
        places.append(place)
        return True

    monkeypatch.setattr(hook, "_comes_to", comes_to)
    monkeypatch.setattr(hook, "stand_off_of", lambda climber, i, doubt: 0.05)
    climber = SimpleNamespace(body=SimpleNamespace(tip=cast("Callable[[int], Floats]", lambda i: places[-1])))
    found = Approach(np.zeros(2), np.zeros((1, 2)), g, 0.05)
    hook.back_off(cast(Climber, climber), LEFT, hold, 0.004, found)
    assert places[-1] == pytest.approx(hold - 0.05 * g)
    if (
        past > 0.012
    ):  # it has passed the hold by, whose other side it was to come to: farther aside, lest it catch there on its way back
        assert (places[1] - places[0]) @ h == pytest.approx(0.02 if aside == 0.0 else np.copysign(0.02, aside))
        assert (places[1] - places[0]) @ g == pytest.approx(0.0, abs=1e-12)
        places.pop(0)
    for start, end in pairwise(places):
        along, across = (end - start) @ g, (end - start) @ h
        deep = max((start - hold) @ g, (end - hold) @ g)
        # beside or beyond the hold only straight back; across only where the whole hook is before it
        assert (abs(across) < 1e-12 and along < 0.0) or deep == pytest.approx(-0.05)


@pytest.mark.parametrize("free_side", [-1.0, 1.0])
@pytest.mark.parametrize("aside", [-0.003, 0.003])
def test_a_hook_whose_flare_catches_on_its_way_back_goes_aside_and_back_from_there(
    monkeypatch: pytest.MonkeyPatch, free_side: float, aside: float
) -> None:
    g, hold = np.array((-0.6, 0.8)), np.array((1.0, 0.5))
    h = np.array((-g[1], g[0]))
    tip = hold + 0.02 * g + aside * h
    places = [tip]

    def comes_to(climber: Climber, i: int, place: Floats) -> bool:
        """The peg is on the other side: it holds the flare while the hook is beside it, and lets it go to the free side only."""
        here = places[-1]
        free = (
            (here - hold) @ h * free_side > 0.015 or (here - hold) @ g < -0.04 or (place - here) @ h * free_side > 1e-9
        )
        if free:
            places.append(place)
        return bool(free)

    monkeypatch.setattr(hook, "_comes_to", comes_to)
    monkeypatch.setattr(hook, "stand_off_of", lambda climber, i, doubt: 0.05)
    climber = SimpleNamespace(body=SimpleNamespace(tip=cast("Callable[[int], Floats]", lambda i: places[-1])))
    found = Approach(np.zeros(2), np.zeros((1, 2)), g, 0.05)
    hook.back_off(cast(Climber, climber), LEFT, hold, 0.004, found)
    assert [(place - tip) @ h for place in places] == pytest.approx([0.0, 0.02 * free_side, 0.02 * free_side, -aside])
    assert places[-1] == pytest.approx(hold - 0.05 * g)


@pytest.mark.parametrize("wall", [0.02, 0.05, 1.0])
def test_a_tip_goes_straight_to_a_place_and_stops_pulling_where_it_is_held(
    monkeypatch: pytest.MonkeyPatch, wall: float
) -> None:
    start, way = np.array((0.3, 0.2)), np.array((0.6, -0.8))
    tip, task, farthest = start.copy(), SimpleNamespace(mode="swing_joint", place=start, speed=np.zeros(2)), 0.0

    def tick() -> None:
        """The tip comes after where it is to be, with a lag of 50 ms, as far as the wall."""
        nonlocal farthest
        tip[:] += 0.1 * (task.place - tip)
        beyond = (tip - start) @ way - wall
        tip[:] -= max(beyond, 0.0) * way
        farthest = max(farthest, float((task.place - tip) @ way))

    body = SimpleNamespace(tasks=[task], tip=lambda i: tip.copy(), pose=np.zeros(3), q=np.ones((1, 2)))
    climber = SimpleNamespace(
        body=body, plant=SimpleNamespace(period=0.005), tick=tick, hangs=False, holding=lambda: [1, 2], fall=None
    )
    monkeypatch.setattr(hook, "PushedBody", lambda _: SimpleNamespace(gives_way=lambda i: False))
    there = hook._comes_to(cast(Climber, climber), 0, start + 0.1 * way)
    assert there == (wall > 0.1)
    assert (tip - start) @ way == pytest.approx(min(wall, 0.1), abs=0.011)
    assert farthest < 0.03  # [m], by which its limb pulls: 15 N
    assert task.place == pytest.approx(start + 0.1 * way if there else tip)
    assert task.speed == pytest.approx(np.zeros(2))


@pytest.mark.parametrize(("short", "before", "hangs", "seated"), [
    (0.003, [], False, True), (0.011, [], False, False), (0.011, [0.0], False, True), (0.011, [0.006], False, False),
    (0.016, [0.0], False, False), (0.011, [], True, True), (0.012, [], True, False), (0.012, [0.0], True, True),
    (0.013, [0.0], True, False), (-0.014, [], True, True),
])  # fmt: skip
def test_a_hook_that_stops_short_is_seated_where_it_stops_there_again_or_the_body_hangs(
    monkeypatch: pytest.MonkeyPatch, short: float, before: list[float], hangs: bool, seated: bool
) -> None:
    g, hold = np.array((0.0, 1.0)), np.array((1.0, 0.5))
    tip = hold - short * g
    monkeypatch.setattr(hook, "move_tip", lambda climber, i, place, seconds: True)
    pushed: list[float] = []
    monkeypatch.setattr(hook, "push_on", lambda climber, i, place, g, room: not pushed.append(room))
    faded: list[int] = []
    monkeypatch.setattr(hook, "_fade", lambda climber, i: faded.append(i))
    body = SimpleNamespace(tip=cast("Callable[[int], Floats]", lambda i: tip), q=np.ones((3, 2)))
    climber = SimpleNamespace(body=body, holds={1: hold}, hangs=hangs)
    found = Approach(np.zeros(2), np.zeros((1, 2)), g, 0.05)
    ends = [tip + np.array((off, 0.0)) for off in before]
    assert hook.close(cast(Climber, climber), LEFT, hold, 0.01, found, hold, ends) == seated
    # from a hang it is pushed again once its pull has faded, before it is taken off
    assert (len(pushed), faded) == ((2, [LEFT, LEFT]) if hangs and not seated else (1, []))


def test_a_pull_fades_to_nothing_within_a_swing() -> None:
    task, forces = SimpleNamespace(force=np.array((6.0, -8.0))), [np.array((6.0, -8.0))]
    climber = SimpleNamespace(
        body=SimpleNamespace(tasks=[task]),
        plant=SimpleNamespace(period=0.005),
        tick=lambda: forces.append(task.force.copy()),
    )
    hook._fade(cast(Climber, climber), 0)
    sizes = np.hypot(*np.array(forces).T)
    assert len(forces) == 201 and sizes[-1] == 0.0
    assert np.diff(sizes) == pytest.approx(-0.05)


def test_a_hang_that_a_slip_has_led_to_is_taken_up_by_the_plan(
    single_row: ExecutablePlan, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After it nobody had let go: the plan's next move of the body that hangs goes on from there."""
    taken: list[tuple[int, str]] = []

    class Hanging:
        def __init__(self, climber: Any, i: int) -> None:
            taken.append((i, "taken up"))

        def bring(self, pose: Floats) -> None:
            taken.append((-1, "brought"))

        def calm(self) -> None:
            taken.append((-1, "calm"))

    monkeypatch.setattr(actor_module, "Hang", Hanging)
    monkeypatch.setattr(actor_module, "clear_the_way", lambda *_: None)
    monkeypatch.setattr(actor_module, "is_clear", lambda *_: True)
    body = SimpleNamespace(settled=single_row.pose(0), aim=single_row.pose(0), tasks=[])
    climber = SimpleNamespace(
        robot=single_row.task.robot, body=body, map=mapped(single_row), hangs=True, holding=lambda: [RIGHT]
    )
    actor = Actor(cast(Climber, climber), single_row)
    assert actor._hang(1) == ""
    assert taken == [(RIGHT, "taken up"), (-1, "brought"), (-1, "calm")]
    assert actor.hanging is not None
