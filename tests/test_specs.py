"""Units, files, robots, boards and tasks: the numbers that load, and what the errors say about those that do not."""

import json
import math
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.errors import (
    MISSING,
    ClamberError,
    FileError,
    SpecError,
    UnitError,
    UnknownHoldError,
    UnknownNameError,
)
from clamber.families.climber.family import CLIMBER
from clamber.families.climber.statics.checks import DEFAULT_HARD, LIMBED_CHECKS
from clamber.families.climber.world.library import board_names, load_board
from clamber.family import family_named
from clamber.files import content_hash, write_atomically
from clamber.tasks import load_task, task_from_document, task_names
from clamber.tasks.robots import load_robot, read_robot, robot_names
from clamber.units import INCH, OZ_IN, UNITS, convert, parse_quantity, read_quantity

LIBRA_TASKS = ("ladder", "modified-ladder", "h", "across", "circle")

# Bevly 1997, Table C.1 [in]; of the H, peg 7 is corrected from y = 26.
LADDER = [(0, 0), (18, 0), (0, 6), (18, 6), (0, 12), (18, 12), (0, 18), (18, 18), (0, 24), (18, 24), (0, 30), (18, 30),
          (0, 36), (18, 36), (0, 42), (18, 42), (0, 48), (18, 48), (0, 54), (18, 54), (0, 60), (18, 60)]  # fmt: skip
CIRCLE = [(20, 0), (28, 2), (34, 6), (38, 12), (40, 20), (40, 28), (40, 36), (38, 44), (34, 50), (28, 54), (20, 56),
          (12, 54), (6, 50), (2, 44), (0, 36), (0, 28), (0, 20), (2, 12), (6, 6), (12, 2), (20, 20), (20, 28), (20, 36),
          (20, 19), (20, 37)]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("3 in", "length", 0.0762),
        ("6.2in", "length", 6.2 * 0.0254),
        (" -1.5e1 cm ", "length", -0.15),
        ("15 deg", "angle", math.pi / 12),
        ("15°", "angle", math.pi / 12),
        ("1500 oz-in", "torque", 1500 * 0.028349523125 * 9.80665 * 0.0254),
        ("1500ozin", "torque", 1500 * OZ_IN),
        ("3000 ozf in", "torque", 21.184655443),
        ("144 ozf", "force", 40.0339945),
        ("40 N", "force", 40.0),
        ("0.25 kg", "mass", 0.25),
        ("0.402 kg m^2", "inertia", 0.402),
        ("1.1 N·m·s/rad", "damping", 1.1),
        ("60 rpm", "angular speed", math.tau),
        ("50 %", "ratio", 0.5),
        ("574", "ratio", 574.0),
    ],
)
def test_a_quantity_is_read_in_si(text: str, dimension: str, expected: float) -> None:
    assert parse_quantity(text, dimension) == pytest.approx(expected, rel=1e-8)


def test_the_ounce_inch_is_the_product_of_its_definitions() -> None:
    assert abs(OZ_IN - 0.00706155) < 5e-9
    assert INCH == 0.0254


@given(st.sampled_from(sorted(UNITS)), st.floats(-1e3, 1e3), st.data())
def test_text_table_and_number_say_the_same(dimension: str, value: float, data: st.DataObject) -> None:
    unit = data.draw(st.sampled_from(sorted(UNITS[dimension])))
    expected = convert(value, unit, dimension)
    assert read_quantity(f"{value!r} {unit}", dimension) == expected
    assert read_quantity({"value": value, "unit": unit, "source": "here"}, dimension) == expected


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (3, "state a unit, such as '3 m'"),
        ("3", "state a unit, such as '3 m'"),
        ("3 kg", "no unit of length; allowed are m, cm, mm, in, ft"),
        ("3 inc", "did you mean 'in'"),
        ("nan in", "is no length"),
        (math.nan, "not a finite number"),
        (10**400, "not a finite number"),
        ("1e999 in", "not a finite number"),
        ({"value": math.inf, "unit": "in"}, "not a finite number"),
        ({"value": 10**400, "unit": "in"}, "not a finite number"),
        ({"value": 3}, "lacks its unit"),
        ({"value": "3", "unit": "in"}, "is no number"),
        ({"value": True, "unit": "in"}, "is no number"),
        ({"value": 3, "units": "in"}, "unknown key 'units'"),
        ({"unit": "in"}, "has no 'value'"),
        (None, "is no length"),
        (True, "is no length"),
    ],
)
def test_what_is_no_length_is_refused_with_what_is_allowed(raw: object, said: str) -> None:
    with pytest.raises(UnitError, match=re.escape(said)):
        read_quantity(raw, "length")


@pytest.mark.parametrize(
    "error",
    [
        FileError("a.toml", "is a folder", "name a file"),
        UnitError(3, "lacks its unit", "state one"),
        SpecError("a.toml", "limbs.right.l1", -3, "must be more than 0 m", ("and more",)),
        SpecError("a.toml", "weight", MISSING, "must be given"),
        UnknownNameError("robot", "lib", ("libra",)),
        UnknownHoldError(99, "ladder", (1, 2, 3)),
    ],
)
def test_an_error_survives_pickling(error: ClamberError) -> None:
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again)) == (type(error), str(error))


def test_every_data_file_loads_and_survives_pickling() -> None:
    for loaded in (
        *map(load_robot, robot_names()),
        *map(load_board, board_names()),
        *map(load_task, task_names()),
    ):
        assert pickle.loads(pickle.dumps(loaded)) == loaded
    assert set(LIBRA_TASKS) < set(task_names())


def numbers_without_source(data: object) -> list[object]:
    """Quantities of a robot file that state no source."""
    if isinstance(data, list):
        return [found for item in data for found in numbers_without_source(item)]
    if not isinstance(data, dict):
        return [data] if isinstance(data, float) else []
    if "value" in data:
        return [] if data.get("source") else [data]
    return [found for key, item in data.items() if key != "number" for found in numbers_without_source(item)]


@pytest.mark.parametrize("name", robot_names())
def test_every_number_of_a_shipped_robot_has_a_source(name: str) -> None:
    robot = load_robot(name)
    assert numbers_without_source(read_robot(name).data) == []
    assert robot.sources
    assert all(found.source for found in robot.sources.values())
    data = family_named(robot.family).data
    assert data is not None and (data / "robots" / f"{name}.toml").is_file()


def test_libra_has_the_numbers_of_the_thesis() -> None:
    robot = load_robot("libra")
    right, left, bottom = robot.limbs
    assert (right.name, left.name, bottom.name) == ("right", "left", "bottom")
    assert robot.opposed == (("right", "left"),)
    assert robot.weight == pytest.approx(40.0, rel=1e-3)
    assert robot.motor.torque_limit == pytest.approx(21.18, abs=5e-3)
    assert robot.motor.backlash == pytest.approx(math.radians(2.0))
    assert bottom.length == pytest.approx(0.311)
    assert [joint.number for limb in robot.limbs for joint in (limb.shoulder, limb.elbow)] == [1, 4, 2, 5, 3, 6]
    assert [limb.elbow.gear for limb in robot.limbs] == [792, 792, 574]
    assert (right.end.angle, left.end.angle, bottom.end.angle) == pytest.approx((-math.pi / 2, math.pi / 2, 0.0))
    for joint in (limb_joint for limb in robot.limbs for limb_joint in (limb.shoulder, limb.elbow)):
        assert joint.inertia / joint.gear**2 == pytest.approx(0.4020 / 574**2, rel=1e-3)  # one kind of motor
    assert "inferred" in robot.sources["limbs.bottom.l2"].source


def test_libra_is_its_own_mirror_image() -> None:
    right, left, _ = load_robot("libra").limbs
    assert (right.port_x, right.port_y) == (-left.port_x, left.port_y)
    assert (right.shoulder.lower, right.shoulder.upper) == (-left.shoulder.upper, -left.shoulder.lower)
    assert right.hook_beta == pytest.approx(-left.hook_beta)
    assert right.length == pytest.approx(left.length)


@pytest.mark.parametrize("name", robot_names("limbed"))
def test_effective_link_and_angle_place_the_tip_where_the_three_lengths_do(name: str) -> None:
    # Spec: port-frame tip x = l1 c1 + l2 c12 + l3 cos(t1 + t2 + t_hook), y likewise.
    for limb in load_robot(name).limbs:
        for t1, t2 in ((0.3, -0.7), (-1.1, 0.4), (2.0, 1.5)):
            turn = t1 + t2
            x = limb.l1 * math.cos(t1) + limb.l2 * math.cos(turn) + limb.end.offset * math.cos(turn + limb.end.angle)
            y = limb.l1 * math.sin(t1) + limb.l2 * math.sin(turn) + limb.end.offset * math.sin(turn + limb.end.angle)
            ours = limb.l1 * np.exp(1j * t1) + limb.l2_effective * np.exp(1j * (turn + limb.hook_beta))
            assert (ours.real, ours.imag) == pytest.approx((x, y), abs=1e-15)


def inches(name: str) -> dict[int, tuple[float, float]]:
    board = load_board(name)
    return dict(zip(board.numbers().tolist(), map(tuple, (board.positions() / INCH).tolist()), strict=True))


@pytest.mark.parametrize(("name", "printed"), [("ladder", LADDER), ("circle", CIRCLE)])
def test_boards_are_those_of_table_c1(name: str, printed: list[tuple[int, int]]) -> None:
    pegs = inches(name)
    assert list(pegs) == list(range(1, len(printed) + 1))
    np.testing.assert_allclose(list(pegs.values()), printed, atol=1e-12)


def test_the_modified_ladder_lacks_four_pegs_and_keeps_the_numbers() -> None:
    whole, less = inches("ladder"), inches("modified-ladder")
    assert set(whole) - set(less) == {6, 8, 10, 12}
    assert all(less[number] == whole[number] for number in less)


def test_the_h_is_symmetric_where_the_misprint_was() -> None:
    pegs = inches("h")
    left = {round(y) for x, y in pegs.values() if abs(x) < 1e-9}
    right = {round(y) for x, y in pegs.values() if abs(x - 54) < 1e-9}
    assert left == right == set(range(0, 43, 6))
    assert pegs[7] == pytest.approx((0, 36))
    assert len(pegs) == 32


def test_across_runs_to_ninety_inches() -> None:
    pegs = inches("across")
    assert len(pegs) == 30
    assert pegs[13] == pytest.approx((33, 0))
    assert pegs[30] == pytest.approx((90, 24))


def test_a_taller_ladder_continues_the_numbering() -> None:
    task = load_task("ladder", ("board.ladder.rungs=100",))
    assert len(task.world.holds) == 200
    for number, (x, y) in enumerate(LADDER, start=1):
        hold = task.world.by_number(number)
        assert (hold.x / INCH, hold.y / INCH) == pytest.approx((x, y))
    assert task.world.by_number(199).y == pytest.approx(99 * 6 * INCH)


def test_the_dense_board_is_the_same_each_time_and_has_limited_holds() -> None:
    board = load_board("gecko-wall")
    assert board == load_board("gecko-wall")
    limited = [hold for hold in board.holds if hold.direction is not None]
    assert 0.2 < len(limited) / len(board.holds) < 0.4
    assert all(hold.cone and hold.strength == 30.0 for hold in limited)


def test_an_unknown_hold_is_named_with_its_neighbours() -> None:
    with pytest.raises(UnknownHoldError, match=r"board 'ladder' has no hold 99: it has 22, such as 20, 21, 22"):
        load_board("ladder").by_number(99)


@pytest.mark.parametrize("name", task_names("limbed"))
def test_a_task_is_rebuilt_from_its_document(name: str) -> None:
    task = load_task(name, ("seed=7",))
    again = task_from_document(json.loads(json.dumps(task.document)))
    assert again == task
    assert again.hashes == task.hashes
    assert set(task.hashes) == {"robot", "board", "task"}


def test_a_hash_changes_with_its_part_alone() -> None:
    plain, changed = load_task("ladder"), load_task("ladder", ("weight=39 N",))
    same = {part for part in plain.hashes if plain.hashes[part] == changed.hashes[part]}
    assert same == {"board", "task"}


def test_starts_and_steps_of_the_published_tasks() -> None:
    expected = {
        "ladder": (9, 6, 3, (4, 3, 2)),
        "modified-ladder": (9, 6, 1, (4, 3, 1)),
        "h": (9, 6, 1, (10, 2, 1)),
        "across": (3, 12, 1, (4, 2, 1)),
        "circle": (10, 28, 1, (22, 16, 17)),
    }
    for name, (x, y, step, holds) in expected.items():
        task = load_task(name)
        assert (task.start.x / INCH, task.start.y / INCH, task.step.length / INCH) == pytest.approx((x, y, step))
        assert tuple(task.start.holds.values()) == holds
        assert math.degrees(task.step.angle) == pytest.approx(15)
        assert task.rules.hard == DEFAULT_HARD
        assert task.rules.reach_offset == pytest.approx(INCH if name == "modified-ladder" else 0.0)


def test_every_start_is_within_reach() -> None:
    for task in map(load_task, task_names("limbed")):
        for limb in task.robot.limbs:
            number = task.start.holds[limb.name]
            if number == 0:  # it starts free
                continue
            hold = task.world.by_number(number)
            distance = math.hypot(hold.x - task.start.x - limb.port_x, hold.y - task.start.y - limb.port_y)
            assert distance < limb.length - task.rules.reach_offset, (task.name, limb.name)


def test_a_point_goal_is_a_box_of_half_a_step_each_way() -> None:
    for step in ("1in", "3in"):
        task = load_task("h", (f"step.length={step}",))
        half = task.step.length / 2 / INCH
        box = tuple(edge / INCH for edge in task.goals[-1].box)
        assert box == pytest.approx((45 - half, 45 + half, 48 - half, 48 + half))


def test_goals_stand_in_order_and_the_last_is_the_goal() -> None:
    task = load_task("circle")
    assert [goal.name for goal in task.goals] == ["below", "right", "above", "once round"]
    assert task.goals[-1].turns == 1.0
    assert task.goals[-1].centre == pytest.approx((20 * INCH, 28 * INCH))


def test_free_limbs_point_straight_out_at_the_start() -> None:
    task = load_task("ladder", ("start.holds.bottom=0",))
    limb = task.robot.limbs[2]
    assert task.start.feet == {"bottom": pytest.approx((limb.port_x, limb.port_y - 0.6 * limb.length))}
    assert load_task("ladder").start.feet == {}


def test_default_hard_checks_are_checks() -> None:
    names = [check.name for check in LIMBED_CHECKS]
    assert len(names) == len(set(names)) == 16
    assert set(DEFAULT_HARD) < set(names)


@pytest.mark.parametrize(
    ("override", "read", "expected"),
    [
        ("start.y=6.2in", lambda task: task.start.y, 6.2 * INCH),
        ("motor.torque_limit=1500ozin", lambda task: task.robot.motor.torque_limit, 1500 * OZ_IN),
        ("robot.motor.torque_limit.value=1500", lambda task: task.robot.motor.torque_limit, 1500 * OZ_IN),
        ("robot.limbs.right.l1=16 cm", lambda task: task.robot.limbs[0].l1, 0.16),
        ("limbs.0.l1=16 cm", lambda task: task.robot.limbs[0].l1, 0.16),
        ("limbs.right.shoulder.gear=600", lambda task: task.robot.limbs[0].shoulder.gear, 600),
        ("rules.max_hangs=0", lambda task: task.rules.max_hangs, 0),
        ("rules.hook_cone=60deg", lambda task: task.rules.hook_cone, math.pi / 3),
        ("goal.y_min=30in", lambda task: task.goals[-1].y_min, 30 * INCH),
        ("start.holds.right=6", lambda task: task.start.holds["right"], 6),
        ("board=modified-ladder", lambda task: len(task.world.holds), 18),
    ],
)
def test_an_override_sets_one_key(override: str, read: object, expected: float) -> None:
    assert callable(read)
    assert read(load_task("ladder", (override,))) == pytest.approx(expected)


def test_a_hold_is_addressed_by_its_number() -> None:
    task = load_task("h", ("board.holds.7.y=26in",))
    assert task.world.by_number(7).y == pytest.approx(26 * INCH)


def test_an_override_is_noted_as_the_source() -> None:
    task = load_task("ladder", ("motor.torque_limit=1500ozin",))
    assert task.robot.sources["motor.torque_limit"].source == "override"


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("start.y=6.2", "start.y = 6.2: lacks its unit; state a unit, such as '6.2 m'; units of length are m, cm, mm"),
        ("start.y=6.2kg", "start.y = '6.2kg': is no unit of length; allowed are m, cm, mm, in, ft"),
        ("start.y=nan", "start.y = nan: is not a finite number"),
        (
            "start.yy=3in",
            "start.yy = '3in': unknown key; allowed are x, y, theta, holds, in_use, feet, between; did you mean",
        ),
        ("strat.y=3in", "unknown key; a key starts with name, title, start"),
        ("strat.y=3in", "did you mean 'start'?"),
        ("start.theta.z=3", "start.theta = '0 deg': is a value, so it has no 'z'"),
        ("start.holds.right=99", "start.holds.right = 99: board 'ladder' has no such hold; it has 22, from 1 to 22"),
        ("start.holds.rigth=3", "unknown limb; robot 'libra' has right, left, bottom; did you mean 'right'?"),
        ("start.holds.right=3", "two limbs are on hold 3"),
        ("start.holds={right=0}", "all limbs are free; at least one must be on a hold"),
        ("start.holds.right=2.5", "must be a whole number"),
        ("start.in_use=rght", "did you mean 'right'?"),
        ('start.feet.right=["1in","1in"]', "only free limbs have feet"),
        ("goal.y_min=300in", "lies 6.096 m from the nearest hold, but robot 'libra' reaches 0.3596 m"),
        ("goal={}", "asks for nothing"),
        ("goal.turns=1", "'turns' and 'centre' both or neither"),
        ("goal.holds.right=99", "goal.holds.right = 99: board 'ladder' has no such hold"),
        ('goal.region=[["1in","1in"]]', "at least three corners"),
        ('subgoals=[{x_min="2in",x_max="1in"}]', "subgoals.0.x_min = '2in': must be at most x_max"),
        ("step.angle=25deg", "must divide a turn; 14.4 steps fill one"),
        ("step.length=-1in", "step.length = '-1in': must be 1e-06 m or more"),
        ('rules.hard=["reach","hok"]', "unknown check 'hok'; reach, joint, support"),
        ("rules.max_hnags=0", "did you mean 'max_hangs'?"),
        ("rules.force_rule=best", "must be 'thesis', 'min_torque' or 'min_norm'"),
        ("rules.hook_cone=91deg", "must be 90 deg or less"),
        ("rules.min_supports=4", "at most the number of limbs, 3"),
        ("rules.reach_offset=1m", "less than the shortest limb"),
        ('rules.keep=[{limb="lft"}]', "did you mean 'left'?"),
        ("limbs.right.l1=-3cm", "must be more than 0 m"),
        ("limbs.right.l1=1e-9 m", "must leave 0.0001 m or more"),
        ("limbs.rihgt.l1=3cm", "robot.limbs: has no 'rihgt'; it has right, left, bottom; did you mean 'right'?"),
        ("limbs.right.shoulder.lower=150deg", "must be less than 'upper'"),
        ("limbs.right.shoulder.number=2", "each joint needs its own number"),
        ("limbs.right.name=left", "names must differ; 'left' is there twice"),
        ("limbs=[]", "a robot has 2 to 8 limbs; here are 0"),
        ('opposed=[["right","right"]]', "two different limbs"),
        ("weight=0N", "must be more than 0 N"),
        ("weight=1N", "more than the links weigh together"),
        ("motor.torque_limit=1500", "motor.torque_limit = 1500: lacks its unit"),
        ("robot.sources={}", "unknown key"),
        ("robot.family=fish", "family = 'fish': must be one of limbed, spatial, walker"),
        ("board.ladder.rungs=0", "ladder.rungs = 0: must be greater than or equal to 1"),
        ("board.ladder.removed=[23]", "must be numbers from 1 to 22; 23 is not"),
        ("board.ladder.width=1mm", "holds 1 and 2 overlap: 0.001 m apart"),
        ('board.keep_out=[[["1in","1in"],["2in","2in"],["3in","3in"]]]', "the corners must enclose an area"),
        ("board=hh", "no board is called 'hh'; there are across, circle"),
        (
            "robot=lbra",
            f"no robot is called 'lbra'; there are {', '.join(robot_names())}; did you mean 'libra'?",
        ),
        ("robot=5", "must name a robot"),
        ("foo", "write key=value, such as start.y=6.2in"),
    ],
)
def test_a_bad_override_is_refused_with_what_is_allowed(override: str, said: str) -> None:
    with pytest.raises(ClamberError, match=re.escape(said)) as caught:
        load_task("ladder", (override,))
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_an_error_names_the_override_or_the_file() -> None:
    with pytest.raises(SpecError, match=r"^--set start\.y=6\.2: start\.y"):
        load_task("ladder", ("start.y=6.2",))
    with pytest.raises(SpecError, match=r"^tasks/ladder\.toml with --set goal\.y_min=300in: goal"):
        load_task("ladder", ("goal.y_min=300in",))


BOARD = 'schema = "clamber-board-1"\nname = "mine"\nhold_radius = "5 mm"\n'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("holds = []", "the board has no holds; it needs at least one"),
        ("", "exactly one of 'holds', [ladder], [grid], [random]; here: none"),
        ('holds = [{number = 1, x = "0 m", y = "0 m"}, {number = 1, x = "1 m", y = "0 m"}]', "1 is there twice"),
        ('holds = [{number = 1, x = "0 m", y = "0 m"}, {number = 4, x = "9 mm", y = "0 m"}]', "holds.4: "),
        ('holds = [{number = 1, x = "0 m", y = "0 m"}, {number = 4, x = "9 mm", y = "0 m"}]', "1 and 4 overlap"),
        ('holds = [{number = 0, x = "0 m", y = "0 m"}]', "holds.0.number = 0: must be greater than or equal to 1"),
        ('holds = [{number = 3, x = inf, y = "0 m"}]', "holds.3.x = inf: is not a finite number"),
        ('holds = [{number = 3, x = "0 m"}]', "holds.3.y: must be given"),
        ('holds = [{number = 3, x = "0 m", y = "0 m", cone = "30 deg"}]', "'direction' and 'cone' both or neither"),
        ("holds = [4]", "holds.0 = 4: must be a table"),
        ("holdz = []", "unknown key; allowed are name, title, source"),
        ("x = = 3", "is not valid TOML: Invalid value (at line 4, column 5)"),
    ],
)
def test_a_bad_board_is_refused_with_file_and_key(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(BOARD + text)
    with pytest.raises(ClamberError, match=re.escape(said)) as caught:
        load_board(str(path))
    assert str(caught.value).startswith(str(path))


def test_all_problems_of_a_file_are_listed(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(BOARD + 'holds = [{number = 1, x = 0, y = "0 kg"}]')
    with pytest.raises(SpecError) as caught:
        load_board(str(path))
    assert caught.value.key == "holds.1.x"
    assert len(caught.value.others) == 1
    assert "holds.1.y = '0 kg': is no unit of length" in str(caught.value)


def test_unreadable_files_say_why(tmp_path: Path) -> None:
    (tmp_path / "latin.toml").write_bytes(b'name = "\xff"')
    with (tmp_path / "big.toml").open("wb") as stream:
        stream.truncate(17 * 1024 * 1024)
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "long.toml").write_text("x = " + "9" * 5000)
    (tmp_path / "deep.toml").write_text("x = " + "[" * 100_000)
    for name, said in {
        "latin": "is not UTF-8 (byte 8)",
        "big": "has 17825792 bytes; at most 8388608 are read",
        "folder": "is a folder; it has no TOML files; name a file",
        "latim": "does not exist; files beside it: big.toml, deep.toml, folder.toml, latin.toml, long.toml; did you",
        "long": "is not valid TOML",
        "deep": "is not valid TOML",
    }.items():
        with pytest.raises(FileError, match=re.escape(said)):
            load_robot(str(tmp_path / f"{name}.toml"))


def test_a_file_must_state_its_schema(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('schema = "clamber-board-9"\nname = "mine"')
    with pytest.raises(SpecError, match=re.escape('must say schema = "clamber-board-1"')):
        load_board(str(path))


def test_files_of_the_user_are_found_beside_the_task(tmp_path: Path) -> None:
    for kind, data in (("robots", "libra"), ("worlds", "ladder"), ("tasks", "ladder")):
        text = (CLIMBER.data / kind / f"{data}.toml").read_text()
        text = text.replace('robot = "libra"', 'robot = "robots.toml"').replace(
            'board = "ladder"', 'board = "worlds.toml"'
        )
        (tmp_path / f"{kind}.toml").write_text(text)
    ours, shipped = load_task(str(tmp_path / "tasks.toml")), load_task("ladder")
    assert (ours.robot, ours.world, ours.goals) == (shipped.robot, shipped.world, shipped.goals)


@pytest.mark.parametrize(("text", "unit"), [("0,0\n18,6\n", "in"), ("# wall\nx [in], y [in]\n0, 0\n\n18, 6\n", None)])
def test_a_board_comes_from_a_table_of_coordinates(tmp_path: Path, text: str, unit: str | None) -> None:
    path = tmp_path / "wall.csv"
    path.write_text(text)
    board = load_board(str(path), unit=unit)
    assert [hold.number for hold in board.holds] == [1, 2]
    np.testing.assert_allclose(board.positions() / INCH, [[0, 0], [18, 6]])


@pytest.mark.parametrize(
    ("text", "unit", "said"),
    [
        ("x,y\n1,2\n", None, "wall.csv: does not say its unit; state one of m, cm, mm, in, ft in the header"),
        ("1,2\n3,4,5\n", "in", "wall.csv:2: has 3 columns; each line is x, y"),
        ("x [in],y [in]\n1,2\n4,foo\n", None, "wall.csv:3: y = 'foo'; state a finite number"),
        ("1,2\nnan,3\n", "in", "wall.csv:2: x = 'nan'; state a finite number"),
        ("1,2\n", "kg", "has the unit 'kg'; units of length are m, cm, mm, in, ft"),
        ("x [in],y [cm]\n1,2\n", None, "wall.csv:1: names two units: cm, in"),
        ("x [in],y [in]\n1,2\n", "cm", "names the unit 'in'; but 'cm' was asked for"),
        ("1,2\n\n1,2\n", "in", "wall.csv:3: hold 2; holds 1 and 2 (lines 1 and 3) overlap"),
        ("", "in", "wall.csv: has no points; each line is x, y"),
    ],
)
def test_a_bad_table_is_refused_with_file_and_line(tmp_path: Path, text: str, unit: str | None, said: str) -> None:
    path = tmp_path / "wall.csv"
    path.write_text(text)
    with pytest.raises(ClamberError, match=re.escape(said)):
        load_board(str(path), unit=unit)


def test_a_write_replaces_the_whole_file_and_leaves_nothing_beside(tmp_path: Path) -> None:
    path = tmp_path / "plan.json"
    write_atomically(path, "old")
    write_atomically(path, "new")
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(FileError, match="cannot be written"):
        write_atomically(tmp_path / "none" / "plan.json", "new")


def test_a_hash_ignores_the_order_of_keys() -> None:
    assert content_hash({"a": 1, "b": [2]}) == content_hash({"b": [2], "a": 1})
    assert content_hash("abc") == content_hash(b"abc")
    assert content_hash({"a": 1}) != content_hash({"a": 2})


WORDS = st.text(st.characters(codec="utf-8"), max_size=12)
KEYS = st.sampled_from(
    [
        "start.x",
        "start.holds",
        "goal",
        "goal.at",
        "rules.hard",
        "limbs",
        "limbs.right",
        "motor",
        "board",
        "board.ladder",
        "robot",
        "step.angle",
        "subgoals",
        "rules.keep",
        "weight",
        "opposed",
    ]
)
VALUES = st.one_of(
    WORDS,
    st.integers().map(str),
    st.floats().map(str),
    st.sampled_from(
        ["[]", "{}", "[[]]", "[{}]", "true", '""', '["a"]', "{value=1}", "[1,2]", '{a="b"}', "1e400", "-inf"]
    ),
)


@given(KEYS, VALUES)
def test_no_override_raises_anything_but_a_named_error(key: str, value: str) -> None:
    try:
        load_task("ladder", (f"{key}={value}",))
    except ClamberError as error:
        assert str(error)
