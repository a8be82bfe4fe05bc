"""The plain evaluator itself, against closed forms and brute force: an oracle has to earn its name."""

import itertools
import math
import random
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import pytest

from .carriers import Carrier, torques
from .evaluator import Action, PlainEvaluator, PlainStance
from .forces import is_push_pull, shared_load, split_forces
from .hook import cone_cuts, pair_margins
from .interference import contains, polygon_distance, swing_clearance
from .kinematics import Option, Point, Pose, forward, limb_length, option, port_in_world, to_world, usable, wrap

WEIGHT = 40.0  # [N]
LIMIT = 20.0  # [N m]


def joint(lower: float, upper: float) -> SimpleNamespace:
    return SimpleNamespace(lower=math.radians(lower), upper=math.radians(upper), gear=500.0, torque_limit=None)


def limb(name: str, x: float, y: float, angle: float, lower: float, upper: float, hook: float) -> SimpleNamespace:
    return SimpleNamespace(
        name=name,
        port_x=x,
        port_y=y,
        port_angle=angle,
        l1=0.156,
        l2=0.150,
        shoulder=joint(lower, upper),
        elbow=joint(-110.0, 110.0),
        end=SimpleNamespace(kind="hook", cone=None, offset=0.02, angle=hook, strength=None),
    )


def hold(number: int, x: float, y: float, **more: Any) -> SimpleNamespace:
    fields = {"radius": 0.005, "direction": None, "cone": None, "strength": None, **more}
    return SimpleNamespace(number=number, x=x, y=y, **fields)


def make_task(holds: list[Any], held: dict[str, int], at: Point = (0.0, 0.0), **rules: Any) -> SimpleNamespace:
    limbs = (
        limb("right", 0.05, 0.02, 0.0, -80.0, 140.0, -math.pi / 2.0),
        limb("left", -0.05, 0.02, math.pi, -140.0, 80.0, math.pi / 2.0),
        limb("low", 0.0, -0.05, -math.pi / 2.0, -110.0, 110.0, 0.3),
    )
    everyday: dict[str, Any] = {
        "force_rule": "thesis",
        "support": "strict",
        "max_hangs": -1,
        "min_supports": 1,
        "limb_in_use": "idle",
        "reach_offset": 0.0,
        "offset_while_holding": False,
        "replace_out_of_reach": False,
        "branch": "free",
        "clearance": 0.02,
        "max_power": None,
        "hook_cone": math.pi / 2.0,
        "hook_pull": 0.0,
        "holding_offset": 0.0,
        "inside": 0.0,
        "max_swing": math.pi,
        "hook_width": 0.0,
        "hook_ahead": 0.0,
        "hook_way": 0.0,
        "hook_room": 0.0,
        "hard": ("reach", "joint", "support", "hangs", "torque"),
        "keep": (),
        "barred": {},
    }
    return SimpleNamespace(
        robot=SimpleNamespace(
            weight=WEIGHT,
            limbs=limbs,
            motor=SimpleNamespace(torque_limit=LIMIT, torque_constant=0.0138, resistance=5.0),
            opposed=(("right", "left"),),
            link_radius=0.01,
            body_margin=0.01,
        ),
        world=SimpleNamespace(holds=tuple(holds), keep_out=()),
        start=SimpleNamespace(x=at[0], y=at[1], theta=0.1, holds=held, in_use=None, feet={}),
        step=SimpleNamespace(length=0.0254, angle=math.radians(15.0)),
        goals=(),
        rules=SimpleNamespace(**{**everyday, **rules}),
    )


def pair_of(rng: random.Random, rule: str, **more: Any) -> tuple[SimpleNamespace, Pose, list[Carrier]]:
    """Two limbs on holds that they reach, at a random pose."""
    task = make_task([], {}, force_rule=rule, **more)
    pose = Pose(rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-0.5, 0.5))
    chosen = rng.sample(task.robot.limbs, 2)
    chosen.sort(key=task.robot.limbs.index)
    return task, pose, [carrier_of(rng, task, pose, member, i) for i, member in enumerate(chosen)]


def carrier_of(rng: random.Random, task: Any, pose: Pose, member: Any, index: int, **more: Any) -> Carrier:
    _, tip = forward(member, pose, rng.uniform(-1.3, 1.3), rng.uniform(-1.8, 1.8))
    place = hold(index + 1, *tip, **more)
    both = [option(member, pose, tip, b) for b in (0, 1)]
    r = (tip[0] - pose.x, tip[1] - pose.y)
    port = port_in_world(member, pose)
    return Carrier(index, member, place, r, port, usable(both), (LIMIT, LIMIT))


def assert_balanced(carriers: list[Carrier], forces: list[Point]) -> None:
    size = 1.0 + sum(abs(x) for f in forces for x in f)
    assert sum(f[0] for f in forces) == pytest.approx(0.0, abs=1e-9 * size)
    assert sum(f[1] for f in forces) == pytest.approx(WEIGHT, abs=1e-9 * size)
    moment = sum(c.r[0] * f[1] - c.r[1] * f[0] for c, f in zip(carriers, forces, strict=True))
    assert moment == pytest.approx(0.0, abs=1e-9 * size)


@pytest.mark.parametrize("seed", range(20))
def test_inverse_kinematics_returns_through_forward_kinematics(seed: int) -> None:
    rng = random.Random(seed)
    _, pose, carriers = pair_of(rng, "thesis")
    for c, b in itertools.product(carriers, (0, 1)):
        o = option(c.limb, pose, c.place, b)
        assert o.tip == pytest.approx(c.place, abs=1e-12)
        assert forward(c.limb, pose, o.t1, o.t2)[1] == pytest.approx(c.place, abs=1e-12)


def test_a_limb_out_of_reach_is_stretched_towards_its_hold() -> None:
    task, pose = make_task([], {}), Pose(0.0, 0.0, 0.4)
    right = task.robot.limbs[0]
    port, target = port_in_world(right, pose), (2.0, 1.0)
    for b in (0, 1):
        tip = option(right, pose, target, b).tip
        assert math.dist(tip, port) == pytest.approx(limb_length(right))
        assert math.dist(tip, target) == pytest.approx(math.dist(port, target) - limb_length(right))


@pytest.mark.parametrize("rule", ["thesis", "min_torque", "min_norm"])
@pytest.mark.parametrize("seed", range(20))
def test_forces_of_two_and_three_holds_balance_the_weight(rule: str, seed: int) -> None:
    rng = random.Random(seed)
    task, pose, pair = pair_of(rng, rule)
    many = [carrier_of(rng, task, pose, member, i) for i, member in enumerate(task.robot.limbs)]
    for carriers in (pair, many):
        forces = split_forces(carriers, task)
        assert forces is not None
        assert_balanced(carriers, forces)


@pytest.mark.parametrize("seed", range(20))
def test_torques_do_the_work_that_the_force_takes(seed: int) -> None:
    """Virtual work with the port fixed: the limb pushes with -F, so dW = t . dq - (-F) . d(tip) = 0."""
    rng = random.Random(seed)
    _, pose, carriers = pair_of(rng, "thesis")
    force = (rng.uniform(-50.0, 50.0), rng.uniform(-50.0, 50.0))
    step = 1e-6  # [rad]
    for c in carriers:
        for o in c.options:
            for j, torque in enumerate(torques(c, o, force)):
                ends = []
                for sign in (1.0, -1.0):
                    q = [o.t1, o.t2]
                    q[j] += sign * step
                    tip = forward(c.limb, pose, q[0], q[1])[1]
                    ends.append(-force[0] * tip[0] - force[1] * tip[1])
                assert torque == pytest.approx((ends[0] - ends[1]) / (2.0 * step), abs=1e-6)


@pytest.mark.parametrize("seed", range(20))
def test_a_hanging_limb_s_torque_is_the_slope_of_the_potential_energy(seed: int) -> None:
    """With the tip pinned and the body free, turning a joint lifts or lowers the weight: t = dV/dq about the hold."""
    rng = random.Random(seed)
    _, pose, carriers = pair_of(rng, "thesis")
    step = 1e-6  # [rad]
    for c in carriers:
        o = c.options[0]
        heights = []
        for sign in (1.0, -1.0):
            tip = forward(c.limb, pose, o.t1, o.t2 + sign * step)[1]
            heights.append(pose.y + c.place[1] - tip[1])  # body translated so that the tip stays on its hold
        slope = WEIGHT * (heights[0] - heights[1]) / (2.0 * step)
        assert torques(c, o, (0.0, WEIGHT))[1] == pytest.approx(slope, abs=1e-6)


@pytest.mark.parametrize("seed", range(20))
def test_thesis_forces_are_vertical_or_point_at_the_origin(seed: int) -> None:
    task, _, carriers = pair_of(random.Random(seed), "thesis")
    forces = split_forces(carriers, task)
    assert forces is not None
    for c, f in zip(carriers, forces, strict=True):
        if is_push_pull(carriers[0], carriers[1], task.robot):
            assert c.r[0] * f[1] - c.r[1] * f[0] == pytest.approx(0.0, abs=1e-9 * (1.0 + math.hypot(*f)))
        else:
            assert f[0] == 0.0


def scan(carriers: list[Carrier], spread: float, points: int) -> list[list[Point]]:
    """Force splits over a range of the squeeze along the line between the two holds."""
    (ax, ay), (bx, by) = (c.place for c in carriers)
    d = math.hypot(bx - ax, by - ay)
    u = ((bx - ax) / d, (by - ay) / d)
    origin_x = ax - carriers[0].r[0]
    share = WEIGHT * (bx - origin_x) / (bx - ax)  # vertical forces balance too; the squeeze is what remains free
    squeezes = [spread * (2.0 * k / points - 1.0) for k in range(points + 1)]
    return [[(s * u[0], share + s * u[1]), (-s * u[0], WEIGHT - share - s * u[1])] for s in squeezes]


@pytest.mark.parametrize("rule", ["min_torque", "min_norm"])
@pytest.mark.parametrize("seed", range(10))
def test_no_squeeze_beats_the_optimal_split(rule: str, seed: int) -> None:
    task, _, carriers = pair_of(random.Random(seed), rule)
    for member in task.robot.limbs:
        member.end.kind = "gripper"
    forces = split_forces(carriers, task)
    assert forces is not None

    def cost(split: list[Point]) -> float:
        costs = []
        for combo in itertools.product(*(c.options for c in carriers)):
            loads = [t for c, o, f in zip(carriers, combo, split, strict=True) for t in torques(c, o, f)]
            costs.append(max(map(abs, loads)) if rule == "min_torque" else sum(t * t for t in loads))
        return min(costs)

    best = min(cost(split) for split in scan(carriers, 300.0, 6000))
    assert cost(forces) <= best + 1e-9
    assert cost(forces) == pytest.approx(best, rel=0.02)


def good_squeeze(carriers: list[Carrier], combo: Any, split: list[Point], cone: float) -> bool:
    """The definition in angles and lengths, with none of the cuts."""
    for c, o, f in zip(carriers, combo, split, strict=True):
        pull = math.atan2(-f[1], -f[0])
        if abs(wrap(pull - o.grab_angle)) > cone or max(map(abs, torques(c, o, f))) > LIMIT:
            return False
        if c.hold.direction is not None and abs(wrap(pull - c.hold.direction)) > c.hold.cone:
            return False
        if c.hold.strength is not None and math.hypot(*f) > c.hold.strength:
            return False
    return True


@pytest.mark.parametrize("seed", range(25))
def test_hook_margin_is_half_the_range_of_squeezes_that_hold(seed: int) -> None:
    rng = random.Random(seed)
    task, pose, _ = pair_of(rng, "thesis")
    limits = {"direction": rng.uniform(-math.pi, 0.0), "cone": 1.4, "strength": rng.uniform(30.0, 90.0)}
    more = limits if seed % 2 else {}
    carriers = [carrier_of(rng, task, pose, m, i, **more) for i, m in enumerate(task.robot.limbs[:2])]
    cone = math.radians(75.0)
    margins = pair_margins(carriers[0], carriers[1], WEIGHT, cone)
    squeezes = scan(carriers, 600.0, 12000)
    spacing = 2.0 * 600.0 / 12000
    for combo in itertools.product(*(c.options for c in carriers)):
        count = sum(good_squeeze(carriers, combo, split, cone) for split in squeezes)
        margin = margins[combo[0].branch, combo[1].branch]
        if margin < 0.0:
            assert count == 0
        else:
            assert 2.0 * margin == pytest.approx(count * spacing, abs=1.01 * spacing)


def ladder() -> list[Any]:
    return [hold(2 * k + side, 0.46 * side - 0.23, 0.15 * k) for k in range(6) for side in (1, 0) if 2 * k + side]


def random_action(rng: random.Random, numbers: list[int]) -> Action:
    i = rng.randrange(3)
    return rng.choice(
        [
            ("none",),
            ("move", rng.randrange(3), rng.choice((1, -1))),
            ("release", i),
            ("nearest", i, rng.randint(1, 4)),
            ("hold", i, rng.choice(numbers)),
            ("random", i, rng.random()),
        ]
    )


@pytest.mark.parametrize("support", ["strict", "atomic"])
@pytest.mark.parametrize("branch", ["free", "kept"])
def test_random_walks_end_with_what_the_page_promises(support: str, branch: str) -> None:
    """A lone holder has the origin straight below, ticks stay in range, and a reason means a violated hard check."""
    rng = random.Random(3)
    task = make_task(ladder(), {"right": 5, "left": 4, "low": 2}, (0.0, 0.2), support=support, branch=branch)
    evaluator = PlainEvaluator(task)
    numbers = [h.number for h in task.world.holds]
    hangs = 0
    stance = evaluator.start()
    for _ in range(800):
        result = evaluator.step(stance, random_action(rng, numbers))
        after = result.stance
        assert (result.reason is not None) == any(result.margins[c] < -1e-9 for c in task.rules.hard)
        assert 0 <= after.ia < evaluator.turn_ticks
        assert after.hangs >= stance.hangs
        holders = after.holders()
        if result.reason is None and len(holders) == 1:
            hangs += 1
            x, y = evaluator.place(after.hold[holders[0]] or 0)
            pose = evaluator.pose(after)
            assert abs(pose.x - x) <= evaluator.tick
            assert pose.y < y
            assert result.forces[holders[0]] == (0.0, WEIGHT)
        if result.reason is None:
            stance = after
        elif rng.random() < 0.02:
            stance = evaluator.start()
    assert hangs > 20


def test_a_hang_moves_limb_and_foot_rigidly_with_the_body() -> None:
    task = make_task(ladder(), {"right": 5, "left": 4}, (0.0, 0.2))
    evaluator = PlainEvaluator(task)
    before = evaluator.start()
    left_hold = evaluator.place(4)
    after = evaluator.step(before, ("release", 1)).stance
    pivot = evaluator.place(5)
    assert after.hangs == 1
    foot = after.foot[1]
    assert foot is not None
    moved = to_world(evaluator.pose(after), foot)
    old, new = evaluator.pose(before), evaluator.pose(after)
    assert math.dist(moved, pivot) == pytest.approx(math.dist(left_hold, pivot), abs=1e-6)
    assert math.dist(moved, (new.x, new.y)) == pytest.approx(math.dist(left_hold, (old.x, old.y)), abs=1e-9)
    for a_limb in task.robot.limbs[:1]:
        apart = [math.dist(port_in_world(a_limb, p), pivot) for p in (old, new)]
        assert apart[0] == pytest.approx(apart[1], abs=1e-6)


def test_a_strict_grab_equals_a_release_and_a_grab() -> None:
    task = make_task(ladder(), {"right": 5, "left": 4}, (0.0, 0.2), hard=("reach",))
    evaluator = PlainEvaluator(task)
    at_once = evaluator.step(evaluator.start(), ("hold", 1, 6))
    released = evaluator.step(evaluator.start(), ("release", 1))
    in_two = evaluator.step(released.stance, ("hold", 1, 6))
    one, two = at_once.stance, in_two.stance
    assert (one.ix, one.iy, one.ia, one.hold, one.hangs) == (two.ix, two.iy, two.ia, two.hold, two.hangs)
    for name, margin in at_once.margins.items():
        assert margin == min(in_two.margins[name], released.margins[name])


@pytest.mark.parametrize("rule", ["thesis", "min_norm"])
@pytest.mark.parametrize("kind", ["gripper", "hook"])
@pytest.mark.parametrize("seed", range(10))
def test_no_other_split_of_three_holds_is_better(rule: str, kind: str, seed: int) -> None:
    rng = random.Random(seed)
    task, pose, _ = pair_of(rng, rule, hook_cone=1.5)
    for member in task.robot.limbs:
        member.end.kind = kind
    carriers = [carrier_of(rng, task, pose, member, i) for i, member in enumerate(task.robot.limbs)]
    load = shared_load(carriers, task)
    forces = load.forces
    assert forces is not None

    def cost(split: list[Point], options: Sequence[Option]) -> float:
        loads = [t for c, o, f in zip(carriers, options, split, strict=True) for t in torques(c, o, f)]
        return max(map(abs, loads)) if rule == "thesis" else sum(t * t for t in loads)

    def pulls(split: list[Point], options: Sequence[Option], slack: float) -> bool:
        rows = [(f, row) for c, o, f in zip(carriers, options, split, strict=True) for row in cone_cuts(c, o, 1.5)]
        return all(row[0] * f[0] + row[1] * f[1] >= -slack for f, row in rows)

    need_pull = pulls(forces, load.options, 1e-6)
    for _ in range(2000):
        other = [list(f) for f in forces]
        for (i, a), (j, b) in itertools.combinations(enumerate(carriers), 2):  # squeezes keep the balance
            d, size = math.dist(a.place, b.place), rng.gauss(0.0, 10.0 ** rng.uniform(-3.0, 1.5))
            for axis in (0, 1):
                along = size * (b.place[axis] - a.place[axis]) / d
                other[i][axis] += along
                other[j][axis] -= along
        split = [(f[0], f[1]) for f in other]
        elbows = [rng.choice(c.options) for c in carriers]
        if not need_pull or pulls(split, elbows, 0.0):
            assert cost(split, elbows) >= cost(forces, load.options) * (1.0 - 1e-5)


def test_opposed_limbs_on_one_vertical_line_push_and_pull() -> None:
    task = make_task([hold(1, 0.1, 0.0), hold(2, 0.1, 0.2)], {"right": 1, "left": 2}, hard=())
    result = PlainEvaluator(task).step(PlainEvaluator(task).start(), ("move", 1, 1))
    assert all(math.isfinite(x) for force in result.forces for x in force)
    assert result.forces[0][1] + result.forces[1][1] == pytest.approx(WEIGHT)


def test_turns_are_counted_through_the_branch_cut() -> None:
    task = make_task([hold(1, 0.0, 0.0)], {"right": 1}, (1.0, 0.0), hard=())
    blank: dict[str, Any] = dict.fromkeys(("x_min", "x_max", "y_min", "y_max", "theta_min", "theta_max", "region"))
    task.goals = (SimpleNamespace(**blank, holds={}, turns=2.0, centre=(0.0, 0.0)),)
    evaluator = PlainEvaluator(task)
    stance: PlainStance = evaluator.start()
    for k in range(1, 25):
        before = stance.copy()
        angle = 2.0 * math.pi * k / 12.0
        stance.ix = round((math.cos(angle) - 1.0) / evaluator.tick)
        stance.iy = round(math.sin(angle) / evaluator.tick)
        evaluator.count_laps(before, stance)
        assert evaluator.met(stance, task.goals[0]) == (k >= 24)


def test_arc_clearance_is_that_of_many_points_on_the_arc() -> None:
    rng = random.Random(5)
    for _ in range(50):
        task = make_task([hold(k, rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4)) for k in range(1, 6)], {})
        start, turn, radius = rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0), rng.uniform(0.05, 0.3)
        points = [start + turn * k / 2000.0 for k in range(2001)]
        nearest = min(
            math.hypot(h.x - radius * math.cos(a), h.y - radius * math.sin(a)) for a in points for h in task.world.holds
        )
        margin = swing_clearance(task, (0.0, 0.0), radius, start, turn)
        assert margin == pytest.approx(nearest - task.rules.clearance, abs=radius * abs(turn) / 2000.0)


def test_polygon_distance_is_zero_inside_and_exact_beside() -> None:
    square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    assert contains(square, (0.5, 0.5))
    assert polygon_distance(square, [(0.2, 0.2), (0.3, 0.3)]) == 0.0
    assert polygon_distance([(-1.0, 0.5), (2.0, 0.5)], square) == 0.0
    assert polygon_distance(square, [(2.0, 2.0), (3.0, 3.0)]) == pytest.approx(math.sqrt(2.0))
