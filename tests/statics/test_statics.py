"""The kernels' physics, against laws that hold whatever the implementation: balance, virtual work, symmetry, brute force."""

import math
import random
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from clamber.errors import StartError
from clamber.families.climber.planning.arrays import CHECKS, FORCE_RULES
from clamber.families.climber.planning.problem import LimbedProblem
from clamber.families.climber.planning.step import find_hold
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.statics.near import nearest_hold
from clamber.families.climber.statics.programme import BOX, maximise
from clamber.families.climber.world.board import Board, Hold
from clamber.plane import inside, point_segment, polygon_polygon, segment_polygon, segment_segment
from clamber.planning.problem import codes
from clamber.planning.problem.arrays import ActionTable
from clamber.planning.problem.check import TICKS
from clamber.planning.problem.codes import pack
from clamber.planning.problem.loops import replay
from clamber.tasks import load_task
from plain.variants import random_task

STAY = ActionTable.build([("stay", [pack(codes.NONE)], True)])
NO_SPLIT = 1e6


def startable(task: LimbedTask) -> LimbedProblem:
    """The task's problem, without the hard checks that its start violates."""
    while True:
        try:
            return LimbedProblem(task, STAY, every_check=True, threads=1)
        except StartError as error:
            hard = tuple(name for name in task.rules.hard if name != error.check)
            task = replace(task, rules=replace(task.rules, hard=hard))


def steps(problem: LimbedProblem, seed: int, length: int) -> list[int]:
    """Codes of a walk through random valid actions."""
    rng = random.Random(seed)
    now, done = problem.start, []
    for _ in range(length):
        found = problem.expand(now).code.tolist()
        if not found:
            break
        kind = rng.choice((codes.MOVE, codes.RELEASE, codes.HOLD, codes.HOLD))
        code = rng.choice([c for c in found if c >> 27 == kind] or found)
        done.append(code)
        stances = np.zeros(2, now.dtype)
        replay(
            problem.params.record,
            now,
            np.array([code], np.int32),
            True,
            stances,
            np.zeros((1, len(problem.checks))),
            np.zeros(1, np.int32),
        )
        now = stances[1:]
    return done


def walked(seed: int, **rules: Any) -> tuple[LimbedTask, Any]:
    """A random variant of a task under given rules, and the stances of a walk on it."""
    task = random_task(random.Random(seed))
    problem = startable(replace(task, rules=replace(task.rules, **rules)))
    return problem.task, problem.replay(np.array(steps(problem, seed, 25), np.int32), go_on=True).stances[1:]


@pytest.mark.parametrize("idle", ["idle", "carries"])
@pytest.mark.parametrize("rule", FORCE_RULES)
def test_forces_and_moments_balance_the_weight(rule: str, idle: str) -> None:
    seen = set()
    for seed in range(30):
        task, stances = walked(seed, force_rule=rule, limb_in_use=idle)
        for s in stances:
            if s["torque"] >= NO_SPLIT or not s["carriers"]:
                continue
            seen.add(bin(s["carriers"]).count("1"))
            force, size = s["force"], 1.0 + np.abs(s["force"]).sum()
            at = [
                (0.0, 0.0) if h < 0 else (task.world.holds[h].x - s["x"], task.world.holds[h].y - s["y"])
                for h in s["hold"]
            ]
            moment = sum(x * fy - y * fx for (x, y), (fx, fy) in zip(at, force, strict=True))
            assert force[:, 0].sum() == pytest.approx(0.0, abs=1e-9 * size)
            assert force[:, 1].sum() == pytest.approx(task.robot.weight, abs=1e-9 * size)
            rounding = task.robot.weight * task.step.length / TICKS  # a hang is straight below to the tick
            assert moment == pytest.approx(0.0, abs=1e-8 * size + rounding)
            free = [i for i in range(8) if not s["carriers"] >> i & 1]
            assert not force[free].any() and not s["torques"][free].any()
    assert {1, 2} <= seen and (3 in seen or idle == "idle")


def turned(point: Any, about: Any, angle: float) -> Any:
    c, s = math.cos(angle), math.sin(angle)
    dx, dy = point[0] - about[0], point[1] - about[1]
    return np.array([about[0] + c * dx - s * dy, about[1] + s * dx + c * dy])


@pytest.mark.parametrize("rule", FORCE_RULES)
def test_torques_are_the_work_that_a_small_turn_of_a_joint_does(rule: str) -> None:
    """Body fixed: turning a joint moves the tip, which pushes with -F on its hold."""
    h = 1e-6  # [rad]
    count = 0
    for seed in range(30, 50):
        task, stances = walked(seed, force_rule=rule)
        for s in stances:
            for i, limb in enumerate(task.robot.limbs):
                if not s["carriers"] >> i & 1 or s["torque"] >= NO_SPLIT or s["solved"][i, 0] > limb.length - 1e-6:
                    continue
                hold = task.world.holds[s["hold"][i]]
                tip = np.array([hold.x, hold.y])
                port = np.array([s["x"], s["y"]]) + turned((limb.port_x, limb.port_y), (0.0, 0.0), s["angle"])
                at = 2 + 5 * s["branch"][i]
                elbow = s["solved"][i, at : at + 2]
                assert math.dist(port, elbow) == pytest.approx(limb.l1, abs=1e-9)
                assert math.dist(elbow, tip) == pytest.approx(limb.l2_effective, abs=1e-7)
                for joint, about in enumerate((port, elbow)):
                    work = [float(-s["force"][i] @ turned(tip, about, e)) for e in (h, -h)]
                    assert s["torques"][i, joint] == pytest.approx((work[0] - work[1]) / (2.0 * h), abs=1e-6)
                    count += 1
    assert count > 300


def mirrored(task: LimbedTask) -> LimbedTask:
    """Everything seen from behind the wall: x becomes -x, angles turn the other way."""

    def flip(angle: float | None) -> float | None:
        return None if angle is None else math.pi - angle

    limbs = tuple(
        replace(
            m,
            port_x=-m.port_x,
            port_angle=math.pi - m.port_angle,
            shoulder=replace(m.shoulder, lower=-m.shoulder.upper, upper=-m.shoulder.lower),
            elbow=replace(m.elbow, lower=-m.elbow.upper, upper=-m.elbow.lower),
            end=replace(m.end, angle=-m.end.angle),
        )
        for m in task.robot.limbs
    )
    keep_out = tuple(tuple((-x, y) for x, y in polygon) for polygon in task.world.keep_out)
    start = task.start
    return replace(
        task,
        robot=replace(task.robot, limbs=limbs),
        world=replace(
            task.world,
            holds=tuple(replace(h, x=-h.x, direction=flip(h.direction)) for h in task.world.holds),
            keep_out=keep_out,
        ),
        start=replace(start, x=-start.x, theta=-start.theta, feet={k: (-x, y) for k, (x, y) in start.feet.items()}),
        rules=replace(task.rules, keep=()),
    )


@pytest.mark.parametrize("rule", FORCE_RULES)
def test_a_mirrored_world_has_mirrored_margins(rule: str) -> None:
    agreed = total = 0
    for seed in range(60, 80):
        task = random_task(random.Random(seed))
        robot = replace(
            task.robot, limbs=tuple(replace(m, elbow=replace(m.elbow, torque_limit=None)) for m in task.robot.limbs)
        )
        task = replace(task, robot=robot, rules=replace(task.rules, force_rule=rule, keep=()), goals=task.goals[:1])
        problem = startable(task)
        other = startable(mirrored(problem.task))
        plan = steps(problem, seed, 20)
        seen_from_behind = [code ^ 1 if code >> 27 == codes.MOVE and (code & 7) // 2 != 1 else code for code in plan]
        one = problem.replay(np.array(plan, np.int32), go_on=True)
        two = other.replay(np.array(seen_from_behind, np.int32), go_on=True)
        stances = (
            one.stances["ix"],
            -two.stances["ix"],
            one.stances["iy"],
            two.stances["iy"],
            one.stances["hold"],
            two.stances["hold"],
        )
        for a, b in zip(stances[::2], stances[1::2], strict=True):
            np.testing.assert_array_equal(a, b)
        for check, name in enumerate(CHECKS):
            if name == "power" and rule == "min_torque":
                continue  # where several splits have the least torque, each side may take another
            a, b = one.margins[:, check], two.margins[:, check]
            same = np.isclose(a, b, rtol=1e-6, atol=1e-6, equal_nan=True)
            agreed += int(same.sum())
            total += len(same)
            if name in {"reach", "joint", "support", "hangs", "clearance", "swing", "stability", "shared", "torque"}:
                assert same.all(), f"walk {seed}, {name}: {a[~same]} and {b[~same]}"
    assert agreed > 0.98 * total  # two branches that are equally good: "the first" is not the same in a mirror


@pytest.mark.parametrize("rule", FORCE_RULES)
def test_twice_the_weight_is_twice_the_torque(rule: str) -> None:
    for name in ("ladder", "circle", "gecko-climb"):
        task: Any = load_task(name)
        loose = replace(
            task, rules=replace(task.rules, force_rule=rule, hard=("reach", "joint", "support"), clearance=0.0)
        )
        holds = tuple(replace(h, strength=None) for h in task.world.holds)
        loose = replace(loose, world=replace(task.world, holds=holds))
        heavy = replace(loose, robot=replace(loose.robot, weight=2.0 * loose.robot.weight))
        problem = startable(loose)
        plan = np.array(steps(problem, 4, 40), np.int32)
        light, twice = problem.replay(plan, go_on=True).stances, startable(heavy).replay(plan, go_on=True).stances
        split = light["torque"] < NO_SPLIT
        np.testing.assert_allclose(twice["torque"][split], 2.0 * light["torque"][split], rtol=1e-6, atol=1e-7)
        if rule == "thesis" and name != "gecko-climb":
            np.testing.assert_allclose(twice["force"], 2.0 * light["force"], rtol=1e-9, atol=1e-9)
            np.testing.assert_allclose(twice["power"][split], 4.0 * light["power"][split], rtol=1e-9)


def random_programme(rng: np.random.Generator) -> tuple[Any, Any, Any]:
    """Rows about a point that satisfies them, or (every fourth) about none; some rows come twice, some as equalities."""
    d, m = int(rng.integers(1, 8)), int(rng.integers(1, 40))
    a = rng.normal(size=(m, d)) * rng.choice([0.01, 1.0, 3.0], size=(m, 1))
    point = rng.normal(size=d)
    b = a @ point + rng.choice([0.0, 0.1, 1.0], size=m) * rng.random(m)
    if rng.random() < 0.25:
        b -= rng.random(m) * 3.0
    if rng.random() < 0.5:
        a, b = np.vstack([a, -a[:2]]), np.concatenate([b, -b[:2]])
    return a, b, rng.normal(size=d)


def test_the_linear_programme_finds_what_highs_finds() -> None:
    rng = np.random.default_rng(1)
    met = 0
    for _ in range(300):
        a, b, c = random_programme(rng)
        m, d = a.shape
        x = np.zeros(d)
        found = maximise(a, b, c, np.zeros((d + 1, m + 2 * d + 1)), np.zeros(d), x)
        fine = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
        answer = linprog(-c, A_ub=a, b_ub=b, bounds=[(-BOX, BOX)] * d, method="highs", options=fine)
        assert found == (answer.status == 0)
        if found:
            met += 1
            assert c @ x == pytest.approx(-answer.fun, rel=1e-8, abs=1e-8)
            assert (a @ x - b).max() < 1e-7 * (1.0 + np.abs(a * x).sum(axis=1).max())
    assert 150 < met < 290


def along(a: Any, b: Any, n: int = 201) -> Any:
    return np.asarray(a) + np.linspace(0.0, 1.0, n)[:, None] * (np.asarray(b) - np.asarray(a))


def sampled(p: Any, q: Any) -> float:
    return float(np.sqrt(((p[:, None] - q[None]) ** 2).sum(axis=2)).min())


def test_distances_of_segments_are_those_of_many_points_on_them() -> None:
    rng = np.random.default_rng(2)
    crossed = 0
    for _ in range(300):
        a, b, c, d = rng.uniform(-1.0, 1.0, (4, 2)) * rng.choice([1.0, 0.2], size=(4, 1))
        exact = segment_segment(*a, *b, *c, *d)
        crossed += exact == 0.0
        apart = sampled(along(a, b), along(c, d))
        slack = (math.dist(a, b) + math.dist(c, d)) / 400.0
        assert exact - 1e-12 <= apart <= exact + slack
        point = point_segment(*a, *c, *d)
        assert point - 1e-12 <= sampled(a[None], along(c, d)) <= point + slack
    assert crossed > 20


def star(rng: np.random.Generator, convex: bool) -> Any:
    n = int(rng.integers(3, 8))
    bearings = np.sort(rng.uniform(0.0, math.tau, n)) if not convex else np.arange(n) * math.tau / n
    radii = rng.uniform(0.2, 1.0, n) if not convex else np.full(n, 0.5)
    return rng.uniform(-1.0, 1.0, 2) + radii[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=1)


def winding(point: Any, polygon: Any) -> int:
    """How often a polygon goes round a point."""
    arms = polygon - point
    angles = np.arctan2(arms[:, 1], arms[:, 0])
    turns = np.diff(np.append(angles, angles[0]))
    return int(round(float(((turns + math.pi) % math.tau - math.pi).sum() / math.tau)))


@pytest.mark.slow
def test_distances_of_polygons_are_those_of_many_points_on_and_in_them() -> None:
    rng = np.random.default_rng(3)
    touching = 0
    for k in range(200):
        one, two = star(rng, True), star(rng, bool(k % 2))
        rims = [np.vstack([along(p[i - 1], p[i], 101) for i in range(len(p))]) for p in (one, two)]
        overlap = any(winding(x, two) for x in rims[0]) or any(winding(x, one) for x in rims[1])
        apart = 0.0 if overlap else sampled(*rims)
        exact = polygon_polygon(one, two)
        touching += exact == 0.0
        assert exact - 1e-12 <= apart + (0.02 if overlap else 0.0)
        assert apart <= exact + 0.03
        point, end = rng.uniform(-1.5, 1.5, (2, 2))
        assert bool(inside(*point, two)) == (winding(point, two) % 2 != 0)
        segment = along(point, end)
        hits = any(winding(x, two) for x in segment)
        assert segment_polygon(*point, *end, two) == pytest.approx(0.0 if hits else sampled(segment, rims[1]), abs=0.03)
    assert touching > 40


@pytest.fixture(scope="module")
def crowded() -> LimbedProblem:
    """LIBRA on a board of 10 000 random holds, some at one distance from each other."""
    rng = np.random.default_rng(4)
    task: Any = load_task("ladder")
    places = rng.uniform(-4.0, 4.0, (10_000, 2))
    places[::3] = np.round(places[::3] / 0.0127) * 0.0127
    for number, (x, y) in {2: (0.4572, 0.0), 3: (0.0, 0.1524), 4: (0.4572, 0.1524)}.items():
        places[number - 1] = x, y
    holds = tuple(Hold(number=k + 1, x=x, y=y, radius=1e-4) for k, (x, y) in enumerate(places.tolist()))
    board = Board(name="crowd", title="", holds=holds)
    rules = replace(task.rules, hard=("reach", "joint", "support"), reach_offset=0.0127, max_hangs=-1)
    return startable(replace(task, world=board, rules=rules))


def test_the_grid_finds_what_a_search_of_all_holds_finds(crowded: LimbedProblem) -> None:
    task, rng = crowded.task, random.Random(5)
    places, p = task.world.positions(), crowded.params.record
    stance = crowded.start.copy()
    for _ in range(300):
        far = rng.random() < 0.2
        spread = 4.6 if far else 3.5
        x, y, angle = rng.uniform(-spread, spread), rng.uniform(-spread, spread), rng.uniform(-3.0, 3.0)
        stance["x"], stance["y"], stance["angle"] = x, y, angle
        stance["c"], stance["s"] = math.cos(angle), math.sin(angle)
        i = rng.randrange(3)
        limb = task.robot.limbs[i]
        port = np.array([x, y]) + turned((limb.port_x, limb.port_y), (0.0, 0.0), angle)
        square = ((places - port) ** 2).sum(axis=1)
        reach = limb.length - task.rules.reach_offset
        held = set(stance["hold"][0, :3].tolist())
        own = rng.choice([-1, int(square.argmin())])
        free = [h for h in range(len(places)) if h not in held and h != own]
        near = [h for h in free if reach - math.sqrt(square[h]) >= -1e-9]
        near.sort(key=lambda h: (round(square[h] / 1e-10), h))
        for k in (1, 2, 5, 50):
            found, n, margin = find_hold(p, stance[0], i, k, own)
            if near:
                assert (found, n) == (near[min(k, len(near)) - 1], len(near))
            else:
                assert found == -1
                assert margin == pytest.approx(reach - math.sqrt(min(square[h] for h in free)), rel=1e-12)
        nearest = math.sqrt(float(((places - [x, y]) ** 2).sum(axis=1).min()))
        assert nearest_hold(p, x, y) == (pytest.approx(nearest, rel=1e-12) if nearest <= 1.0 else math.inf)


def test_children_name_every_hold_in_reach_once(crowded: LimbedProblem) -> None:
    start, task = crowded.start[0], crowded.task
    found = crowded.expand(crowded.start).code.tolist()
    assert len(set(found)) == len(found)
    tried = crowded_grabs(crowded)
    for i, limb in enumerate(task.robot.limbs):
        port = np.array([start["x"], start["y"]]) + turned((limb.port_x, limb.port_y), (0.0, 0.0), start["angle"])
        distance = np.sqrt(((task.world.positions() - port) ** 2).sum(axis=1))
        near = set(np.flatnonzero(limb.length - task.rules.reach_offset - distance >= -1e-9).tolist())
        grabs = {code & codes.ARGUMENT_MASK for code in found if code >> 23 == codes.HOLD << 4 | i}
        assert grabs <= near - set(start["hold"][:3].tolist())
        assert grabs == {h for h in near if (i, h) in tried}


def crowded_grabs(problem: LimbedProblem) -> set[tuple[int, int]]:
    """(limb, hold) of every grab that holds from the start, tried one by one over the whole board."""
    start, held = problem.start, set(problem.start["hold"][0, :3].tolist())
    good = set()
    for i in range(3):
        for h in range(len(problem.task.world.holds)):
            reasons = np.zeros(1, np.int32)
            if h not in held:
                code = np.array([pack(codes.HOLD, i, h)], np.int32)
                replay(
                    problem.params.record,
                    start,
                    code,
                    True,
                    np.zeros(2, start.dtype),
                    np.zeros((1, len(problem.checks))),
                    reasons,
                )
                if reasons[0] < 0:
                    good.add((i, h))
    return good


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_body_straight_above_its_hold_may_swing_either_way(side: float) -> None:
    """Whichever way it falls, the check `swing` asks for room; a peg on one side counts as one on the other."""
    above, task = 0.25, load_task("ladder", ["rules.hard=[]"])
    assert isinstance(task, LimbedTask)
    places = ((0.0, 0.0), (side * (above + 0.03), 0.0), (0.0, above + 0.2))
    holds = tuple(Hold(number=k, x=x, y=y, radius=0.005) for k, (x, y) in enumerate(places, 1))
    right, left, bottom = task.robot.limb_names
    start = replace(task.start, x=0.0, y=above, theta=0.0, holds={right: 1, left: 3}, feet={bottom: (0.0, -0.1)})
    posed = replace(task, world=Board(name="above", title="", holds=holds), start=start)
    problem = LimbedProblem(posed, STAY, every_check=True, threads=1)
    swung = problem.replay(np.array([pack(codes.RELEASE, 1, 0)], np.int32), go_on=True)
    assert abs(float(swung.stances["turned"][-1])) == pytest.approx(math.pi)
    assert swung.margins[-1, CHECKS.index("swing")] == pytest.approx(0.03 - task.rules.clearance)
