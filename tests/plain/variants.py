"""Random variants of the shipped tasks: every rule, goal, hold and end effector that a task file can ask for, mixed."""

import copy
import math
import random
from dataclasses import replace
from typing import Any

from clamber.families.climber.planning.task import Goal, Keep, LimbedTask
from clamber.families.climber.statics.checks import DEFAULT_HARD, LIMBED_CHECKS
from clamber.families.climber.world.board import Hold
from clamber.tasks import load_task

NAMES = ("ladder", "modified-ladder", "h", "across", "circle", "gecko-climb")
ALL_CHECKS = tuple(check.name for check in LIMBED_CHECKS)
INCH = 0.0254


def random_task(rng: random.Random) -> LimbedTask:
    """A shipped task with rules, robot, board, start and goals varied; its start may violate what it then calls hard."""
    name = rng.choice(NAMES)
    length = rng.choice(("3 cm", "2 cm") if name == "gecko-climb" else ("1 in", "3 in", "2 in", "0.7 cm"))
    task: Any = load_task(name, (f"step.length={length}", f"step.angle={rng.choice(('15', '10', '7.5'))}deg"))
    assert isinstance(task, LimbedTask)
    task = replace(task, world=varied_board(rng, task))
    return replace(
        task,
        seed=rng.getrandbits(40),
        robot=varied_robot(rng, task),
        start=varied_start(rng, task),
        rules=varied_rules(rng, task),
        goals=varied_goals(rng, task) if rng.random() < 0.7 else task.goals,
    )


def varied_rules(rng: random.Random, task: LimbedTask) -> Any:
    hard = [
        DEFAULT_HARD,
        (*DEFAULT_HARD, "hook"),
        (*DEFAULT_HARD, "shared", "stability"),
        ("reach", "joint", "support", "torque"),
        ("reach",),
        tuple(check for check in ALL_CHECKS if rng.random() < 0.6),
    ]
    aside = copy.deepcopy(rng)  # so that what is drawn later does not depend on the hooks' sizes
    width = aside.choice((0.0, 0.03, 0.1))
    return replace(
        task.rules,
        force_rule=rng.choice(("thesis", "thesis", "min_torque", "min_norm")),
        support=rng.choice(("strict", "atomic")),
        branch=rng.choice(("free", "kept")),
        max_hangs=rng.choice((-1, -1, 0, 1)),
        min_supports=rng.choice((1, 1, 1, 2)),
        limb_in_use=rng.choice(("idle", "carries")),
        reach_offset=rng.choice((0.0, INCH)),
        offset_while_holding=rng.random() < 0.3,
        replace_out_of_reach=rng.random() < 0.4,
        clearance=rng.choice((0.0, 2 * INCH, 6 * INCH)),
        max_power=rng.choice((None, None, 5.0, 50.0)),
        hook_cone=math.radians(rng.choice((90.0, 90.0, 60.0, 30.0))),
        hook_pull=rng.choice((0.0, 0.0, 2.0, 8.0)),
        inside=aside.choice((0.0, 0.0, INCH)),
        holding_offset=aside.choice((0.0, 0.0, 0.5 * INCH)),
        max_swing=math.radians(aside.choice((180.0, 180.0, 40.0))),
        hook_width=width,
        hook_ahead=aside.choice((0.0, 0.016)),
        hook_way=aside.choice((0.0, 0.04)),
        hook_room=aside.choice((0.0, 0.005)),
        hard=rng.choice(hard),
        keep=tuple(random_keep(rng, task) for _ in range(rng.choice((0, 0, 1, 2)))),
        barred={
            name: (aside.choice(task.world.holds).number,) for name in task.robot.limb_names if aside.random() < 0.2
        },
    )


def random_keep(rng: random.Random, task: LimbedTask) -> Keep:
    """A box that leaves one limb about half of the board."""
    hold = rng.choice(task.world.holds)
    edge = rng.choice(("x_min", "x_max", "y_min", "y_max"))
    edges = {edge: hold.x if edge[0] == "x" else hold.y}
    return Keep(limb=rng.choice(task.robot.limb_names), **edges)


def varied_robot(rng: random.Random, task: LimbedTask) -> Any:
    robot = task.robot
    kinds = [rng.choice((limb.end.kind, "hook", "gripper", "foot")) for limb in robot.limbs]
    cones = [rng.choice((None, None, math.radians(45.0))) for _ in robot.limbs]
    if rng.random() < 0.4:
        aside = copy.deepcopy(rng)  # so that what is drawn later does not depend on the strengths
        strong = [aside.choice((None, robot.weight * aside.uniform(0.4, 2.5))) for _ in robot.limbs]
        ends = [
            replace(m.end, kind=k, cone=c, strength=s)
            for m, k, c, s in zip(robot.limbs, kinds, cones, strong, strict=True)
        ]
        robot = replace(robot, limbs=tuple(replace(m, end=e) for m, e in zip(robot.limbs, ends, strict=True)))
    if rng.random() < 0.3:
        robot = replace(robot, opposed=())
    if rng.random() < 0.3:
        robot = replace(robot, weight=robot.weight * rng.uniform(0.5, 3.0))
    if rng.random() < 0.2:
        weak = [replace(m.elbow, torque_limit=robot.motor.torque_limit * rng.uniform(0.2, 1.5)) for m in robot.limbs]
        robot = replace(robot, limbs=tuple(replace(m, elbow=e) for m, e in zip(robot.limbs, weak, strict=True)))
    return robot


def varied_board(rng: random.Random, task: LimbedTask) -> Any:
    board = task.world
    if rng.random() < 0.15:
        used = {number for goal in task.goals for number in goal.holds.values()} | set(task.start.holds.values())
        holds = [h for h in board.holds if h.number in used]
        top = max(h.number for h in board.holds)
        holds += [random_hold(rng, task, top + 1 + k) for k in range(60)]
        board = replace(board, holds=tuple(holds))
    if rng.random() < 0.4:
        board = replace(board, holds=tuple(weakened(rng, hold, task.robot.weight) for hold in board.holds))
    if rng.random() < 0.4:
        board = replace(board, keep_out=tuple(random_polygon(rng, task, 0.35) for _ in range(rng.choice((1, 2)))))
    return board


def random_hold(rng: random.Random, task: LimbedTask, number: int) -> Hold:
    x, y = task.start.x + rng.uniform(-0.6, 0.6), task.start.y + rng.uniform(-0.5, 0.8)
    return Hold(number=number, x=x, y=y, radius=0.003)


def weakened(rng: random.Random, hold: Hold, weight: float) -> Hold:
    direction = rng.gauss(-math.pi / 2.0, 0.7) if rng.random() < 0.5 else None
    return replace(
        hold,
        direction=direction,
        cone=None if direction is None else math.radians(rng.choice((40.0, 70.0, 90.0))),
        strength=weight * rng.uniform(0.4, 2.5) if rng.random() < 0.5 else None,
    )


def random_polygon(rng: random.Random, task: LimbedTask, away: float) -> tuple[tuple[float, float], ...]:
    """A simple polygon of three to six corners (a star about its centre), about `away` from the start."""
    angle = rng.uniform(-math.pi, math.pi)
    x, y = task.start.x + away * math.cos(angle), task.start.y + away * math.sin(angle)
    bearings = sorted(rng.uniform(0.0, 2.0 * math.pi) for _ in range(rng.randint(3, 6)))
    radii = [rng.uniform(0.03, 0.15) for _ in bearings]
    return tuple((x + r * math.cos(a), y + r * math.sin(a)) for r, a in zip(radii, bearings, strict=True))


def varied_start(rng: random.Random, task: LimbedTask) -> Any:
    """Sometimes one limb is free, its foot somewhere near its port."""
    if rng.random() < 0.7:
        return task.start
    limb = rng.choice(task.robot.limbs)
    foot = (limb.port_x + rng.uniform(-0.2, 0.2), limb.port_y + rng.uniform(-0.2, 0.2))
    in_use = rng.choice((None, limb.name, rng.choice(task.robot.limb_names)))
    return replace(task.start, holds=task.start.holds | {limb.name: 0}, feet={limb.name: foot}, in_use=in_use)


def varied_goals(rng: random.Random, task: LimbedTask) -> tuple[Goal, ...]:
    """A few goals that a random walk has a chance to meet, all turns about one centre."""
    step, start = task.step, task.start
    centre = (start.x + rng.uniform(-0.05, 0.05), start.y + rng.uniform(-0.05, 0.05))
    goals: list[Goal] = []
    for _ in range(rng.randint(1, 5)):
        made: dict[str, Any] = {}
        kind = rng.randrange(5)
        if kind == 0:
            low = start.x + rng.randint(-3, 2) * step.length
            made = {"x_min": low, "x_max": low + rng.randint(0, 2) * step.length}
        elif kind == 1:
            made = {"y_min": start.y + rng.randint(-1, 2) * step.length}
        elif kind == 2:
            low = rng.randint(-3, 2) * step.angle
            made = {"theta_min": low, "theta_max": low + rng.randint(0, 2) * step.angle}
        elif kind == 3:
            limb = rng.choice(task.robot.limb_names)
            near = sorted(task.world.holds, key=lambda h: math.hypot(h.x - start.x, h.y - start.y))[:5]
            made = {"holds": {limb: rng.choice(near).number}}
        else:
            made = {"turns": rng.choice((0.1, -0.1, 0.6, -0.6, 1.1)), "centre": centre}
        if rng.random() < 0.2:
            made["region"] = random_polygon(rng, task, 0.03)
        made["hangs"] = copy.deepcopy(rng).random() < 0.7  # drawn aside, as the hooks' sizes
        goals.append(Goal(**made))
    return tuple(goals)
