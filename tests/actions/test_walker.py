"""The two-frame walker: numbers of its paper, kernel beside plain evaluator, planners that know no family."""

import json
import math
import random
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from clamber.compiled import kernel
from clamber.errors import SpecError
from clamber.families.climber.planning.problem import LimbedProblem
from clamber.families.walker.planning.problem import MOVES, WalkerProblem, outline, walker_table
from clamber.families.walker.planning.task import WalkerTask
from clamber.families.walker.statics.stance import BALANCE, FOOTHOLD, LEGS, SINGULAR, STROKE
from clamber.families.walker.world.ground import Block, Ground
from clamber.planning.planners import plan_task
from clamber.planning.problem import codes
from clamber.planning.problem.arrays import ActionTable
from clamber.planning.problem.codes import MOVE, NONE, RELEASE, pack
from clamber.planning.problem.family_kernels import bound, key
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.problem import FEATURE_NAMES
from clamber.planning.problem.verdict import check_plan
from clamber.tasks import load_task, task_from_document
from clamber.tasks.robots import load_robot
from plain_walker import CHECKS, PlainStance, PlainWalker

ACTIONS = (*MOVES, "swap", "none")
CODES = (*(pack(MOVE, 0, axis) for axis in range(6)), pack(RELEASE), pack(NONE))
OPEN = Ground(name="open", title="", patches=())


def load(*overrides: str, ground: Ground | None = None) -> WalkerTask:
    task = load_task("patch-walk", overrides)
    assert isinstance(task, WalkerTask)
    return task if ground is None else replace(task, world=ground)


def bare(*overrides: str) -> WalkerProblem:
    """On open ground, with the mechanism's checks alone."""
    task = load("rules.hard=['stroke', 'singular']", *overrides, ground=OPEN)
    return WalkerProblem(task, walker_table(), threads=1)


def travel(problem: WalkerProblem, move: str) -> int:
    """How many times the lifted frame can make a move before a check stops it."""
    replay = problem.replay(np.full(20_000, CODES[ACTIONS.index(move)], np.int32))
    assert not replay.ok
    return len(replay.reasons) - 1


# Published numbers, through the kernel


@pytest.mark.parametrize(
    ("direction", "expected"), [(30.0, 160.06), (0.0, 137.7), (90.0, 160.06), (60.0, 137.7), (-30.0, 160.06)]
)
def test_the_step_at_theta_0_is_the_published_one_and_repeats_every_60_degrees(
    direction: float, expected: float
) -> None:
    problem = bare(
        "step.length=0.02 mm", f"start.theta={-direction} deg"
    )  # the world's x is that direction of the frame
    ahead, back = travel(problem, "+x"), travel(problem, "-x")
    assert 0.02 * (ahead + back) == pytest.approx(expected, abs=0.06)


def test_the_longest_step_lies_unevenly_about_the_middle() -> None:
    problem = bare("step.length=0.02 mm", "start.theta=-30 deg")
    assert sorted(0.02 * travel(problem, move) for move in ("+x", "-x")) == pytest.approx([61.6, 98.5], abs=0.1)


def test_the_range_of_the_twist_is_the_published_one() -> None:
    problem = bare("step.angle=0.01 deg")
    assert 0.01 * travel(problem, "+theta") == pytest.approx(47.96, abs=0.01)
    assert 0.01 * travel(problem, "-theta") == pytest.approx(17.98, abs=0.01)


@pytest.mark.parametrize(
    ("twist", "area", "guarded"),
    [(-15, 4.8, None), (0, 168.0, None), (10, 401.0, None), (20, 596.0, None), (40, 1403.0, 96.0)],
)
def test_the_reachable_area_is_the_published_one(twist: float, area: float, guarded: float | None) -> None:
    half = 160 if twist < 40 else 320  # [steps]
    # A path that visits every place of a square grid, row by row, there and back
    row = [[CODES[0]] * (2 * half), [CODES[1]] * (2 * half)]
    path = [CODES[1]] * half + [CODES[3]] * half
    for index in range(2 * half + 1):
        path += [*row[index % 2], CODES[2]]
    problem = bare("step.length=1 mm", f"start.twist={twist} deg")
    margins = problem.replay(np.array(path[:-1], np.int32), go_on=True).margins[2 * half - 1 :]
    assert len(margins) == (2 * half + 1) ** 2
    inside = margins[:, STROKE] >= 0.0
    cell = 0.01  # [cm^2]
    assert cell * inside.sum() == pytest.approx(area, rel=0.01)
    if guarded is not None:
        assert cell * (inside & (margins[:, SINGULAR] >= 0.0)).sum() == pytest.approx(guarded, rel=0.02)


def test_the_mechanism_is_singular_where_the_check_says() -> None:
    robot = load_robot("hoshino")
    a, b = robot.attachments()
    rng = np.random.default_rng(3)
    for _ in range(50):
        twist = rng.uniform(-0.3, 0.8)
        rho = robot.mechanism.singular_distance(twist)
        turned = b @ np.array([[math.cos(twist), math.sin(twist)], [-math.sin(twist), math.cos(twist)]])
        direction = rng.normal(size=2)
        for share, singular in ((1.0, True), (0.9, False)):
            p = share * rho * direction / np.linalg.norm(direction)
            u = p + turned - a
            u /= np.linalg.norm(u, axis=1)[:, None]
            moments = turned[:, 0] * u[:, 1] - turned[:, 1] * u[:, 0]
            jacobian = np.column_stack([u, moments / robot.mechanism.radius_y])
            assert (abs(np.linalg.det(jacobian)) < 1e-9) == singular


# Beside the plain evaluator


def random_task(rng: random.Random) -> WalkerTask:
    """The shipped task with other patches, start, step, rules and frame sizes."""
    patches = []
    for _ in range(rng.randint(0, 5)):
        x, y, size = rng.uniform(-0.5, 0.8), rng.uniform(-0.5, 0.5), rng.uniform(0.02, 0.15)
        corners = sorted(rng.uniform(0.0, math.tau) for _ in range(rng.randint(3, 6)))
        patches.append(tuple((x + size * math.cos(a), y + size * math.sin(a)) for a in corners))
    hard = ",".join(f"'{check}'" for check in CHECKS if rng.random() < 0.8)
    overrides = (
        f"start.theta={rng.uniform(-180, 180)} deg",
        f"start.x={rng.uniform(-0.1, 0.1)} m",
        f"start.twist={rng.uniform(-5, 30)} deg",
        f"start.offset=['{rng.uniform(-2, 2)} cm', '{rng.uniform(-2, 2)} cm']",
        f"start.stands={rng.choice(('delta', 'y'))}",
        f"step.length={rng.uniform(0.5, 4)} cm",
        f"step.angle={rng.choice((3, 6, 7.5, 360 / 7))} deg",
        f"rules.clearance={rng.choice((0, 1))} cm",
        f"rules.balance={rng.choice((0, 1, 4))} cm",
        f"rules.stroke={rng.choice((0, 5))} mm",
        f"rules.hard=[{hard}]",
        f"mass.share_delta={rng.random()}",
        f"start.payload={rng.choice((0, 2, 5))} kg",
        f"start.arm=[{', '.join(repr(f'{rng.uniform(-0.4, 1.5)} rad') for _ in range(4))}]",
        f"legs.radius_y={rng.uniform(20, 28)} cm",
        f"mechanism.radius_y={rng.uniform(21, 26)} cm",
        f"legs.pad_radius={rng.choice((0, 2))} cm",
        "goal.x_min=8 cm",
        "subgoals=[{y_min='2 cm'}, {x_max='4 cm'}]",
    )
    if rng.random() < 0.5:
        overrides = (*overrides, "goal.theta_min=-170 deg", "goal.theta_max=-20 deg")
    blocks = []
    for _ in range(rng.choice((0, 0, 1, 3))):
        x, y, side = rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(0.2, 0.6)
        blocks.append(Block(x_min=x, x_max=x + side, y_min=y, y_max=y + side, height=rng.uniform(-0.12, 0.12)))
    slope = {"slope": rng.choice((0.0, 0.1, 0.3)), "uphill": rng.uniform(-3.0, 3.0)}
    ground = Ground(name="random", title="", patches=tuple(patches), blocks=tuple(blocks), **slope)
    return load(*overrides, ground=ground)


@pytest.mark.slow
@pytest.mark.parametrize("most", [2000, 6000])
def test_kernel_and_plain_evaluator_agree_on_random_walks(most: int) -> None:
    rng = random.Random(5)
    actions = goals = failures = 0
    while actions < most:
        task = random_task(rng)
        try:
            problem = WalkerProblem(task, walker_table(), threads=1)
        except SpecError:
            continue
        plain = PlainWalker(task)
        before, record = PlainStance(stands=task.start.stands), problem.start
        before = plain.act(before, "none").stance
        assert before.stage == record["stage"][0]
        for _ in range(60):
            which = rng.choices(range(8), (3, 1, 2, 2, 2, 2, 3, 1))[0]
            result = plain.act(before, ACTIONS[which])
            problem.start = record
            ours = problem.replay(np.array([CODES[which]], np.int32))
            assert ours.margins[0] == pytest.approx([result.margins[check] for check in CHECKS], abs=1e-12, rel=1e-12)
            assert ours.reasons[0] == (-1 if result.reason is None else CHECKS.index(result.reason))
            after = ours.stances[1]
            assert after["duration"] == pytest.approx(result.duration, abs=1e-9)
            assert after["stage"] == result.stance.stage
            assert after["stands"] == ("delta", "y").index(result.stance.stands)
            for frame, name in enumerate(("delta", "y")):
                origin, angle = plain.pose(result.stance, name)
                assert after["pose"][frame, :2] == pytest.approx([origin.real, origin.imag], abs=1e-12)
                assert math.remainder(after["pose"][frame, 2] - angle, math.tau) == pytest.approx(0.0, abs=1e-12)
                feet = [[foot.real, foot.imag] for foot in plain.feet(result.stance, name)]
                assert after["foot"][frame] == pytest.approx(np.array(feet), abs=1e-12)
            actions += 1
            goals += result.stance.stage > before.stage
            failures += result.reason is not None
            if result.reason is None or rng.random() < 0.1:  # now and then on from a stance that fails
                before, record = result.stance, ours.stances[1:]
    assert goals > most // 120
    assert 0.1 < failures / actions < 0.9


# Symmetry


def test_a_third_of_a_turn_of_walker_and_arm_changes_no_margin() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        twist, (x, y) = rng.uniform(-5.0, 30.0), rng.uniform(-2.0, 2.0, 2)
        turned = complex(x, y) * np.exp(2j * math.pi / 3.0)
        margins = [
            bare(
                f"start.twist={twist} deg",
                f"start.offset=['{at.real} cm', '{at.imag} cm']",
                f"start.arm=['{angle} deg', '0.8 rad', '-1 rad', '-0.9 rad']",
            )
            .replay(np.array([pack(NONE)], np.int32))
            .margins
            for at, angle in ((complex(x, y), 10.0), (turned, 130.0))
        ]
        assert margins[1] == pytest.approx(margins[0], abs=1e-12)


def test_mirrored_walkers_have_equal_margins() -> None:
    """Mirrored in the y axis: offset and twist change their signs, x its direction."""
    ground = Ground(name="box", title="", patches=(((0.3, 0.1), (0.4, 0.1), (0.4, 0.3), (0.3, 0.3)),))
    mirror_patches = tuple(tuple((-x, y) for x, y in patch) for patch in ground.patches)
    arms = (f"start.arm=['{angle} deg', '0.8 rad', '-1 rad', '-0.9 rad']" for angle in (80, 100))
    task = load("start.x=7 cm", "start.twist=12 deg", "start.offset=['1 cm', '-2 cm']", next(arms), ground=ground)
    image = load(
        "start.x=-7 cm", "start.twist=-12 deg", "start.offset=['-1 cm', '-2 cm']", "mechanism.offset=60 deg", next(arms),
        ground=replace(ground, patches=mirror_patches),
    )  # fmt: skip
    rng = np.random.default_rng(2)
    which = rng.integers(0, 7, 300)
    swap_signs = np.array([1, 0, 2, 3, 5, 4, 6])
    path, mirrored = (np.array(CODES, np.int32)[index] for index in (which, swap_signs[which]))
    ours = WalkerProblem(task, walker_table(), threads=1).replay(path, go_on=True)
    theirs = WalkerProblem(image, walker_table(), threads=1).replay(mirrored, go_on=True)
    assert theirs.margins == pytest.approx(ours.margins, abs=1e-9)


BARE_ARM = ("rules.balance=0 cm", "mass.frames=80 kg", "arm.masses=['0 kg','0 kg','0 kg']")
"""All mass at the frames' origins: the arm straight out reaches 0.8 m."""


def test_balance_in_the_middle_is_half_the_circle_of_the_feet() -> None:
    replay = bare(*BARE_ARM, "rules.balance=1 cm").replay(np.array([CODES[7], CODES[6]], np.int32))
    assert replay.margins[:, BALANCE] == pytest.approx(0.2384 / 2 - 0.01, abs=1e-12)


@pytest.mark.parametrize(
    ("stands", "side", "slid", "expected"),
    [("delta", 30, 0.0, 0.0303), ("y", 90, 0.0, 0.0303), ("y", 90, -0.0984, -0.0331)],
)
def test_ten_kilograms_at_arm_s_length_tip_the_robot_at_the_end_of_a_slide(
    stands: str, side: float, slid: float, expected: float
) -> None:
    problem = bare(
        *BARE_ARM, f"start.stands={stands}", f"start.offset=['0 m', '{slid} m']", "start.payload=10 kg",
        f"start.arm=['{side} deg', '0 deg', '0 deg', '0 deg']",
    )  # fmt: skip
    margin = problem.replay(np.array([CODES[7]], np.int32)).margins[0, BALANCE]
    moment = 10 * 0.8 - (0.6 * 80 + 10) * slid  # about the middle of the standing feet, towards the load [kg m]
    assert margin == pytest.approx(0.2384 / 2 - moment / 90, abs=1e-12)
    assert margin == pytest.approx(expected, abs=1e-4)


def test_the_links_of_the_arm_move_the_centre_of_mass_by_their_middles() -> None:
    at_rest, straight = bare(), bare("start.arm=['90 deg', '0 deg', '0 deg', '0 deg']")
    masses, middles = np.array([3.0, 2.0, 1.0]), np.array([0.2, 0.5, 0.725])
    assert straight.start["mass_y"][0] == pytest.approx(masses @ middles / 80.0, abs=1e-12)
    assert straight.start["mass_x"][0] == pytest.approx(0.0, abs=1e-12)
    assert 0.0 < at_rest.start["mass_x"][0] < straight.start["mass_y"][0]


@pytest.mark.parametrize(
    ("override", "allowed"),
    [
        ("start.arm=['0 deg']", "4 angles"),
        ("start.arm=['0 deg', '120 deg', '0 deg', '0 deg']", "-0.5 to 1.8 rad"),
        ("start.payload=-1 kg", "0 kg or more"),
    ],
)
def test_an_arm_out_of_range_is_refused(override: str, allowed: str) -> None:
    with pytest.raises(SpecError, match=allowed):
        load(override)


# Steps in the ground


def on_block(height: float, *overrides: str) -> WalkerProblem:
    """On open ground, all feet of the Y-frame but none of the Delta-frame on blocks."""
    task = load(*overrides)
    feet = WalkerProblem(replace(task, world=OPEN), walker_table(), threads=1).start["foot"][0]
    blocks = tuple(
        Block(x_min=x - 0.02, x_max=x + 0.02, y_min=y - 0.02, y_max=y + 0.02, height=height) for x, y in feet[1]
    )
    return WalkerProblem(replace(task, world=replace(OPEN, blocks=blocks)), walker_table(), threads=1)


@pytest.mark.parametrize(
    ("height", "delta_stands", "y_stands"), [(0.0, 0.15, 0.15), (0.04, 0.11, 0.15), (-0.04, 0.15, 0.11)]
)
def test_legs_lose_what_a_step_takes_of_their_stroke(height: float, delta_stands: float, y_stands: float) -> None:
    # Of a stroke of 200 mm, the lift of 50 mm above the higher ground is lost, and the depth of the lower ground
    problem = on_block(height, "rules.hard=[]")
    margins = problem.replay(np.array([pack(NONE), pack(RELEASE)], np.int32)).margins[:, LEGS]
    assert margins == pytest.approx([delta_stands, y_stands], abs=1e-12)


def test_no_foot_stands_on_an_edge() -> None:
    problem = on_block(0.04, "rules.hard=[]", "rules.clearance=5 mm")
    margins = problem.replay(np.array([pack(NONE), pack(RELEASE)], np.int32)).margins[:, FOOTHOLD]
    assert margins[1] == pytest.approx(0.02 - 0.005, abs=1e-12)  # in the middle of a block of 40 mm
    assert margins[0] > 0.02


def test_time_is_that_of_the_slowest_actuator_and_of_the_legs() -> None:
    problem = bare()
    slide, swap = problem.replay(np.array([CODES[0], CODES[6]], np.int32)).stances[1:]
    start = problem.start[0]
    assert slide["duration"] == pytest.approx(np.abs(slide["actuator"] - start["actuator"]).max() / 9.47e-3, abs=1e-12)
    assert swap["duration"] == pytest.approx(2 * 0.05 / 0.005, abs=1e-12)


# Planners that know no family


def best_first(problem: Any, limit: int = 400) -> tuple[list[int], float]:
    """A planner in a few lines that knows no family: from generation to generation, the stances that came farthest."""
    stances, plans = problem.start, [[]]
    seen = set()
    for _ in range(limit):
        children = problem.expand(stances)
        fresh = []
        for index in range(len(children.code)):
            child = children.stance[index : index + 1]
            word = keys_of(problem, child)
            if word not in seen:
                seen.add(word)
                fresh.append((-problem.progress(child), index))
            if problem.is_done(child):
                return [*plans[children.parent[index]], int(children.code[index])], problem.progress(child)
        chosen = [index for _, index in sorted(fresh)[:60]]
        plans = [[*plans[children.parent[index]], int(children.code[index])] for index in chosen]
        stances = children.stance[chosen]
        if not chosen:
            break
    return [], 0.0


@kernel
def key_kernel(p, stances, words):  # type: ignore[no-untyped-def]
    key(p, stances[0], words)


@kernel
def bound_kernel(p, stances):  # type: ignore[no-untyped-def]
    return bound(p, stances[0])


def keys_of(problem: Any, stance: Any) -> bytes:
    words = np.zeros(problem.key_words, np.int64)
    key_kernel(problem.params.record, stance, words)
    return words.tobytes()


@pytest.mark.slow
@pytest.mark.parametrize("family", ["walker", "limbed"])
def test_one_planner_works_on_both_families(family: str) -> None:
    if family == "walker":
        problem: Any = WalkerProblem(load("step.length=4 cm", "step.angle=12 deg"), walker_table(), threads=1)
    else:
        task = load_task("ladder", ("step.length=3in", "goal.y_min=24in", "goal.at=['9in', '24in']"))
        problem = LimbedProblem(task, ActionTable.build([("stay", [pack(codes.NONE)], True)]), threads=1)
    plan, _ = best_first(problem)
    assert plan, "the planner found no plan"
    replay = problem.replay(np.array(plan, np.int32))
    assert replay.ok
    assert problem.is_done(replay.stances[-1:])
    assert len(problem.features) <= 8 and problem.features[:2] == FEATURE_NAMES[:2]


@pytest.mark.slow
def test_the_genetic_planner_crosses_the_field_and_the_plain_evaluator_agrees() -> None:
    task = load()
    result = plan_task(task, "genetic", seed=0, threads=1, max_evaluations=12_000)
    assert result.status == "found"
    assert result.plan is not None
    assert check_plan(task, result.plan, go_on=False).reached
    plain, stance = PlainWalker(task), PlainStance()
    for code in result.plan.codes(task).tolist():
        step = plain.act(stance, ACTIONS[CODES.index(code)])
        assert step.reason is None
        stance = step.stance
    assert stance.stage == len(task.goals)


def test_rollout_says_what_replay_says_on_any_number_of_threads() -> None:
    table = walker_table(strides=(3,))
    one, many = (WalkerProblem(load(), table, threads=n) for n in (1, 3))
    rng = np.random.default_rng(4)
    genes = rng.integers(0, len(table), (200, 30)).astype(np.int32)
    lengths, weights = rng.integers(0, 31, 200).astype(np.int32), rng.normal(size=len(FEATURE_NAMES))
    ours, theirs = one.rollout(genes, lengths, weights, 60), many.rollout(genes, lengths, weights, 60)
    assert ours.tobytes() == theirs.tobytes()
    for row, result in zip(genes[:50], ours, strict=False):
        replay = one.replay(table.spell(row[: result["genes"]]))
        assert replay.ok
        if result["reason"] >= 0:
            replay = one.replay(table.spell(row[: result["genes"] + 1]))
            assert replay.reasons[-1] == result["reason"]


@pytest.mark.parametrize(
    "goal", [("goal.x_min=18 cm",), ("goal.x_min=6 cm", "goal.theta_min=40 deg", "goal.theta_max=90 deg")]
)
def test_the_bound_never_overestimates(goal: tuple[str, ...]) -> None:
    """Against the least actions to a goal, over all stances within 14 actions of the start on a coarse lattice."""
    task = load("step.length=6 cm", "step.angle=24 deg", *goal, ground=OPEN)
    problem = WalkerProblem(task, walker_table(), threads=1)
    layers, index_of, stances, children = [problem.start], {keys_of(problem, problem.start): 0}, [problem.start], {}
    for _ in range(14):
        found = problem.expand(layers[-1])
        base, fresh = len(stances) - len(layers[-1]), []
        for number in range(len(found.code)):
            child = found.stance[number : number + 1]
            word = keys_of(problem, child)
            if word not in index_of:
                index_of[word] = len(stances)
                stances.append(child)
                fresh.append(number)
            children.setdefault(base + int(found.parent[number]), []).append(index_of[word])
        layers.append(found.stance[fresh])
    away = [0.0 if problem.is_done(stance) else math.inf for stance in stances]
    assert 0.0 in away
    for _ in range(len(layers)):
        for parent, following in children.items():
            away[parent] = min(away[parent], 1.0 + min(away[child] for child in following))
    bounds = [bound_kernel(problem.params.record, stance) for stance in stances]
    assert all(b <= d for b, d in zip(bounds, away, strict=True))
    assert bounds[0] >= 4


def test_a_plan_is_stored_and_checked() -> None:
    task = load("step.length=4 cm", "step.angle=12 deg")
    plan, _ = best_first(WalkerProblem(task, walker_table(), threads=1))
    stored = Plan.from_json(json.loads(json.dumps(Plan.of_codes(task, plan).to_json())))
    again = stored.rebuild_task()
    assert stored.codes(again).tolist() == plan
    verdict = check_plan(again, stored, go_on=False)
    assert verdict.ok and verdict.reached
    assert {action.kind for action in stored.actions} == {"move", "release"}


# Data and errors


def test_the_task_is_rebuilt_from_its_document() -> None:
    task = load("start.x=1 cm")
    again = task_from_document(json.loads(json.dumps(task.document)))
    assert again == task
    assert set(task.hashes) == {"robot", "ground", "task"}


def test_every_number_of_the_robot_says_whether_it_is_printed_fitted_or_chosen() -> None:
    kinds = {found.source.partition(":")[0] for found in load_robot("hoshino").sources.values()}
    assert kinds == {"paper", "calibrated", "assumed"}


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("start.twist=60 deg", "violates the hard check 'stroke'"),
        ("start.x=25 cm", "violates the hard check 'foothold'"),
        ("step.angle=7 deg", "must divide a turn"),
        ("rules.hard=['strokes']", "unknown check 'strokes'; stroke"),
        ("goal.theta_min=3 deg", "states theta_min and theta_max both or neither"),
        ("goal.x_max=3 cm", "must be at most x_max"),
        ("mechanism.guard=1.2", "must be 1 or less"),
        ("start.stands=x", "must be 'delta' or 'y'"),
        ("ground.patches.0.x_min=1 m", "must be less than x_max"),
        ("ground.patches=[[['0 m', '0 m'], ['1 m', '1 m']]]", "at least three corners"),
    ],
)
def test_bad_input_is_named(override: str, said: str) -> None:
    with pytest.raises(SpecError) as error:
        WalkerProblem(load(override), walker_table())
    assert said in str(error.value)


def test_feet_stay_on_the_ground() -> None:
    open_ground = bare().replay(np.array([CODES[6]], np.int32)).margins[0, FOOTHOLD]
    assert open_ground == pytest.approx(10.0 - 0.2384 - 0.005, abs=1e-12)
    ground = replace(OPEN, x_max=0.1)
    margins = (
        WalkerProblem(replace(load("rules.hard=[]"), world=ground), walker_table())
        .replay(np.array([pack(NONE)], np.int32))
        .margins[0]
    )
    assert margins[FOOTHOLD] < 0.0 and margins[LEGS] < -1e6


def test_a_slope_takes_the_stroke_that_the_paper_needs() -> None:
    """Ten degrees take 63 to 73 mm of three legs and up to 84 mm of six, which stand up to twice the radius apart."""
    taken = []
    for uphill in np.linspace(0.0, math.pi, 37):
        problem = WalkerProblem(
            replace(
                load("rules.hard=[]", "legs.lift=0.001 mm"), world=replace(OPEN, slope=math.radians(10), uphill=uphill)
            ),
            walker_table(),
        )
        feet = problem.start["foot"][0]
        heights = feet @ np.array([math.cos(uphill), math.sin(uphill)]) * math.tan(math.radians(10))
        margin = problem.replay(np.array([pack(NONE)], np.int32)).margins[0, LEGS]
        assert margin == pytest.approx(0.2 - (heights.max() - heights.min()), abs=2e-6)
        taken.append((np.ptp(heights[0]), 0.2 - margin))
    three, six = np.array(taken).T
    assert (three.min(), three.max()) == pytest.approx((0.063, 0.073), abs=5e-4)
    assert six.max() == pytest.approx(2 * 0.2384 * math.tan(math.radians(10)), abs=1e-5)


def test_the_outline_has_the_actuators_lengths() -> None:
    task = load()
    replay = WalkerProblem(task, walker_table()).replay(np.array([CODES[0], CODES[4], CODES[2]], np.int32))
    for stance in replay.stances:
        drawn = outline(task, stance)
        lengths = np.linalg.norm(drawn.actuators[:, 1] - drawn.actuators[:, 0], axis=1)
        assert lengths == pytest.approx(stance["actuator"], abs=1e-12)
        assert drawn.feet[0] == pytest.approx(drawn.frames[0], abs=1e-12)  # feet stand at the joint circle
        assert len(drawn.patches) == 5
