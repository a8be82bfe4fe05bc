"""With limits on, no run ever exceeds one: judged by the second reading of test_planted, not by the law's own kernels."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import minimize
from test_planted import plain_values
from walkers import hoshino

from clamber.families.walker.control.cooperative.closest import Reach, ReachSearch
from clamber.families.walker.control.cooperative.cooperator import Cooperator
from clamber.families.walker.control.cooperative.freedoms import SUPPORT, Freedoms, weights_of
from clamber.families.walker.control.cooperative.planted import stand
from clamber.families.walker.control.cooperative.planted_feet import LimitError, PlantedFeet
from clamber.families.walker.control.cooperative.settings import Cooperation, own_speeds
from clamber.families.walker.robot import WalkerRobot
from clamber.types import Floats

START = np.array([0.0, 0.0, 0.38, 0.0, 0.0, 0.0, 0.2, 1.1, -1.0, -0.9])
SETS: tuple[Freedoms, ...] = ("arm", "height", "levelling", "all")
ROUNDING = 1e-12


@dataclass(frozen=True)
class Judge:
    """Largest excess over every limit, from places of points in the world."""

    robot: WalkerRobot
    stance: PlantedFeet
    speeds: Floats
    period: float

    def excess(self, before: Floats, after: Floats) -> float:
        """By how much a step breaks a limit, each in its own unit; at most 0 if it breaks none."""
        robot, arm = self.robot, self.robot.arm
        assert arm is not None
        rates = np.abs(after - before) / self.period
        if self.stance.support != "y":
            rates[[0, 1, 3]] = 0.0  # they follow from the feet
        worst = [
            np.max(arm.lowest - after[6:]),
            np.max(after[6:] - arm.highest),
            np.max(rates - self.speeds * (1.0 + 1e-9)),
        ]
        old, new = plain_values(self.stance, robot, before), plain_values(self.stance, robot, after)
        moved = np.abs(new - old) / self.period
        if self.stance.support == "y":
            mechanism = robot.mechanism
            worst += [np.max(mechanism.shortest - new[:3]), np.max(new[:3] - mechanism.longest)]
            worst += [np.max(moved[:3]) - mechanism.speed, -new[3]]
        legs = slice(4 + 3 * self.stance.standing()[0], 7 + 3 * self.stance.standing()[0])
        worst += [np.max(robot.legs.shortest - new[legs]), np.max(new[legs] - robot.legs.longest)]
        worst += [np.max(moved[legs]) - robot.legs.speed, -np.min(new[10:13])]
        return float(max(worst))


def run_to(
    target: Floats, freedoms: Freedoms, seed: int, *, steps: int, body_faster: float = 1.0
) -> tuple[float, Floats]:
    """Go to a target as fast as the tool may; the largest excess, and where the tool ends."""
    robot = hoshino()
    rng = np.random.default_rng(seed)
    stance = PlantedFeet(
        robot=robot,
        support=SUPPORT[freedoms],
        pose=START[:6],
        offset=tuple(rng.uniform(-0.02, 0.02, 2)),
        twist=float(rng.uniform(-0.1, 0.1)),
        heights=rng.uniform(-0.02, 0.02, (2, 3)),
        payload=float(rng.choice([0.0, 1.0, 3.0])),
    )
    speeds = own_speeds(robot)
    speeds[:6] *= body_faster  # beyond what actuators and legs can do, so that those bind
    settings = Cooperation(
        speeds=speeds, tool_speeds=np.full(3, rng.uniform(0.05, 0.4)), gain=float(rng.choice([0.0, 1.0, 5.0, 20.0]))
    )
    made, weights = Cooperator(robot, settings, stance), weights_of(freedoms, 4)
    made.check_start(START)
    judge = Judge(robot, stance, speeds, settings.period)
    q, worst, still = START.copy(), -np.inf, np.zeros(3)
    values = [made.limited_values(q)]
    for k in range(steps):
        step = made.step(q, target, still, weights)
        assert step.solved
        if k % 5 == 0 or k < 20:
            worst = max(worst, judge.excess(q, step.q))
        q = step.q
        values.append(made.limited_values(q))
    return max(worst, own_excess(made, np.array(values))), made.place(q)


def own_excess(law: Cooperator, values: Floats) -> float:
    """Largest excess over a range or a speed at any step of a run, by the law's own values; test_planted holds them against the judge's."""
    low, high = law.limits()
    fastest = np.concatenate([law.settings.speeds[6:], law.chain.row_speed])
    rates = np.abs(np.diff(values, axis=0)) / law.settings.period
    bounded = (np.abs(values) < 1e8).all(axis=0)  # edges that the support has not are far away
    over = np.maximum(low - values, values - high).max(axis=0)
    too_fast = (rates - fastest * (1.0 + 1e-9)).max(axis=0)
    return float(max(over[bounded].max(), too_fast[bounded].max()))


def targets(count: int) -> Floats:
    """Anywhere about the robot, two thirds of them out of reach."""
    return np.random.default_rng(6).uniform([-1.2, -1.2, -0.3], [1.2, 1.2, 1.6], (count, 3))


@pytest.mark.parametrize("freedoms", SETS)
def test_no_run_to_a_target_exceeds_a_limit(freedoms: Freedoms) -> None:
    for k, target in enumerate(targets(10)):
        worst, _ = run_to(target, freedoms, k, steps=400, body_faster=1.0 if k % 2 else 5.0)
        assert worst <= ROUNDING, f"target {k} {target}"


@pytest.mark.long
@pytest.mark.parametrize("part", range(4))
def test_no_run_to_any_of_a_thousand_targets_exceeds_a_limit(part: int) -> None:
    for k, target in enumerate(targets(1000)):
        if k % 4 == part:
            freedoms = SETS[(k // 4) % 4]
            worst, _ = run_to(target, freedoms, k, steps=800, body_faster=(1.0, 5.0, 50.0)[k % 3])
            assert worst <= ROUNDING, f"target {k} {target} with {freedoms}"


FAR = np.array([[1.1, 0.3, 0.6], [0.4, 0.9, 0.2], [0.9, -0.2, 1.4], [-0.66, -0.48, 1.37]])


@cache
def closest_to_far(freedoms: Freedoms) -> list[Reach]:
    """Of each of the far targets, with these freedoms."""
    robot = hoshino()
    stance = PlantedFeet(robot=robot, support=SUPPORT[freedoms], pose=START[:6])
    search = ReachSearch(robot, stance, weights_of(freedoms, 4))
    return [search.find(START, target) for target in FAR]


@pytest.mark.slow
@pytest.mark.parametrize("tool_speed", [0.1, 0.05, 0.4])
@pytest.mark.parametrize("freedoms", ["arm", "levelling", "all"])
def test_a_run_comes_to_rest_where_the_search_finds_the_closest_reachable_place(
    freedoms: Freedoms, tool_speed: float
) -> None:
    """The law, step by step at real speed, and the search that jumps, agree where the target cannot be reached; nothing shakes there."""
    robot = hoshino()
    stance = PlantedFeet(robot=robot, support=SUPPORT[freedoms], pose=START[:6])
    weights = weights_of(freedoms, 4)
    for target, found in zip(FAR, closest_to_far(freedoms), strict=True):
        assert not found.reached
        assert "out of reach: the closest reachable point is" in found.reason
        settings = Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, tool_speed), gain=0.0)
        made = Cooperator(robot, settings, stance)
        q, last = START.copy(), START
        for _ in range(6000):
            last, q = q, made.step(q, target, np.zeros(3), weights).q
        assert np.abs(q - last).max() / settings.period < 1e-3
        assert found.distance - 1e-5 < np.linalg.norm(target - made.place(q)) < found.distance + 6e-3


@pytest.mark.slow
@pytest.mark.parametrize("freedoms", ["levelling", "all"])
def test_sequential_quadratic_programming_finds_no_nearer_place(freedoms: Freedoms) -> None:
    """Scipy's SLSQP from sixteen postures, by the values of the limits alone."""
    robot = hoshino()
    stance = PlantedFeet(robot=robot, support=SUPPORT[freedoms], pose=START[:6])
    weights = weights_of(freedoms, 4)
    search = ReachSearch(robot, stance, weights)
    law = Cooperator(robot, Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.1)), stance)
    record, free, rng = stance.record()[0], np.flatnonzero(weights), np.random.default_rng(7)
    low, high = law.limits()
    low[4 + 13 :] = -np.inf  # three edges, no more

    def at(x: Floats) -> Floats:
        q = START.copy()
        q[free] = x
        if stance.support != "y":
            stand(q, record["anchor"], record["heading"])
        return q

    def room(x: Floats) -> Floats:
        values = law.limited_values(at(x))
        out = np.concatenate([values - low, high - values])
        return out[np.isfinite(out)]

    for target in rng.uniform([-1.2, -1.2, -0.2], [1.2, 1.2, 1.6], (10, 3)):
        best = np.inf
        for _ in range(16):
            begin = START[free].copy()
            begin[-4:] = rng.uniform((-3.0, 0.0, -1.5, -1.5), (3.0, 1.5, 1.5, 1.5))
            begin[-4] = np.clip(np.arctan2(target[1], target[0]) + 0.3 * rng.normal(), -3.0, 3.0)
            found = minimize(
                lambda x, target=target: 10.0 * float(np.sum((law.place(at(x)) - target) ** 2)),
                begin,
                constraints={"type": "ineq", "fun": room},
                method="SLSQP",
                options={"maxiter": 300, "ftol": 1e-12},
            )
            if room(found.x).min() > -1e-6:
                best = min(best, float(np.linalg.norm(law.place(at(found.x)) - target)))
        assert search.find(START, target).distance < best + 1e-5


def test_no_grid_point_of_the_arm_is_nearer_than_the_search_finds() -> None:
    robot = hoshino()
    arm = robot.arm
    assert arm is not None
    stance = PlantedFeet(robot=robot, support="y", pose=START[:6])
    search = ReachSearch(robot, stance, weights_of("arm", 4), kept="arm")
    axes = [np.linspace(low, high, 61) for low, high in zip(arm.lowest[1:], arm.highest[1:], strict=True)]
    pitches = np.cumsum(np.stack(np.meshgrid(*axes, indexing="ij")), axis=0).reshape(3, -1)
    lengths = np.array(arm.links)
    out, up = arm.out + lengths @ np.cos(pitches), arm.up + START[2] + lengths @ np.sin(pitches)
    reached = 0
    for target in np.random.default_rng(9).uniform([-0.9, -0.9, 0.0], [0.9, 0.9, 1.4], (40, 3)):
        found = search.find(START, target)
        away, azimuth = np.hypot(target[0], target[1]), np.arctan2(target[1], target[0])
        best = np.inf
        for flipped in (0.0, np.pi):  # the arm may also bend backwards over its axis
            angle = np.remainder(azimuth + flipped + np.pi, 2 * np.pi) - np.pi
            off = angle - np.clip(angle, arm.lowest[0], arm.highest[0])
            along = away * np.cos(off) * (-1.0 if flipped else 1.0)
            best = min(best, np.sqrt(((out - along) ** 2 + (up - target[2]) ** 2).min() + (away * np.sin(off)) ** 2))
        assert best - 0.03 < found.distance < best + 1e-6
        reached += found.reached
    assert 5 < reached < 35


@pytest.mark.slow
def test_a_start_beyond_a_limit_is_named() -> None:
    robot = hoshino()
    stance = PlantedFeet(robot=robot, support="delta", pose=START[:6])
    made = Cooperator(robot, Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.1)), stance)
    bent = START.copy()
    bent[8] = -2.5
    with pytest.raises(LimitError, match=r"the joint 2 of the arm \[rad\] is -2.5; allowed is -2.4 to 2.4 rad"):
        made.check_start(bent)
    high = START.copy()
    high[2] = 0.47
    with pytest.raises(
        LimitError, match=r"the length of leg 0 of the Delta-frame \[m\] is 0.47; allowed is 0.25 to 0.45 m"
    ):
        made.check_start(high)


def test_near_a_singular_posture_damping_keeps_the_motion_smooth() -> None:
    """Out to the arm's full stretch and past it: joint rates stay within their speeds, and damped ones come to rest there."""
    robot = hoshino()
    stance = PlantedFeet(robot=robot, support="delta", pose=START[:6])
    damped = Cooperation(speeds=own_speeds(robot), tool_speeds=np.full(3, 0.1), gain=0.0)
    weights, outwards = weights_of("arm", 4), np.array([np.cos(0.2), np.sin(0.2), 0.0])
    shaking = {}
    for name, settings in {"damped": damped, "bare": replace(damped, damping=0.0)}.items():
        made = Cooperator(robot, settings, stance)
        q, rates, start = START.copy(), [], made.place(START)
        for k in range(1500):
            reference = start + min(k * 0.02 * 0.03, 0.6) * outwards
            after = made.step(q, reference, 0.03 * outwards if k < 1000 else np.zeros(3), weights).q
            rates.append((after - q)[6:] / 0.02)
            q = after
        assert np.abs(rates).max() <= 0.35 * (1.0 + 1e-9)
        shaking[name] = np.abs(np.diff(rates[1200:], axis=0)).max()
    assert shaking["damped"] < 1e-4
    assert shaking["bare"] > 0.1
