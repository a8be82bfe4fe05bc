"""Plans as files, the printed plans replayed, and what a verdict says of them."""

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clamber
from clamber.errors import ClamberError, FileError, SpecError, UnknownNameError
from clamber.families.climber.planning.thesis_plan import load_thesis_plan
from clamber.planning.problem.codes import MOVE, NEAREST, RANDOM, RELEASE, Code, pack
from clamber.planning.problem.plan import Plan, load_plan
from clamber.planning.problem.plan_source import is_plan, open_plan, plan_names
from clamber.planning.problem.problems import PlannedAction
from clamber.planning.problem.verdict import Verdict, check_plan
from clamber.tasks import Task, load_task
from clamber.tasks.library import task_names
from clamber.units import OZ_IN

PRINTED = Path(clamber.__file__).parent / "families" / "climber" / "data" / "plans"
H_GA = PRINTED / "h-ga.toml"
LADDER = PRINTED / "ladder-hand.toml"
UP = PlannedAction(kind="move", delta=(0.0, 0.0762, 0.0))


def verdict(name: str, *overrides: str, go_on: bool = False) -> Verdict:
    return open_plan(PRINTED / f"{name}.toml", None, overrides).check(go_on=go_on)


def ladder_plan(*actions: PlannedAction) -> tuple[Task, Plan]:
    task = load_task("ladder")
    return task, Plan(task=task.name, document=task.document, hashes=dict(task.hashes), actions=actions)


@pytest.fixture(scope="module")
def ladder() -> Plan:
    return open_plan(LADDER).plan


@pytest.mark.parametrize(
    ("name", "overrides", "steps", "length", "torque"),
    [
        ("ladder-hand", (), 63, 63, 648),
        ("h-hand", (), 69, 69, 1871),
        ("h-ga", ("start.y=6.2in",), 119, 120, 1067),
        ("modified-ladder-ga", (), 60, 60, 1157),
        ("across-hand", (), 214, 214, 1155),
        ("circle-hand", (), 201, 201, 789),
    ],
)
def test_printed_plans_hold_with_the_torques_of_the_record(
    name: str, overrides: tuple[str, ...], steps: int, length: int, torque: float
) -> None:
    found = verdict(name, *overrides)
    assert (found.steps, found.length) == (steps, length)
    assert found.max_torque / OZ_IN == pytest.approx(torque, rel=0.005)
    assert found.ok == (steps == length)


def test_the_h_hand_plan_has_its_largest_torque_where_the_thesis_has_it() -> None:
    rows = verdict("h-hand").per_step
    top = max(row.max_torque or 0.0 for row in rows)
    assert [row.step for row in rows if (row.max_torque or 0.0) > top - 1e-9] == [45, 46, 47]
    x, y, theta = rows[45].pose
    assert (x / 0.0254, y / 0.0254, np.degrees(theta)) == pytest.approx((42, 27, 45))


def test_the_last_step_of_the_h_ga_plan_is_out_of_reach_by_the_known_amount() -> None:
    first = verdict("h-ga", "start.y=6.2in").first_violation
    assert first is not None
    assert (first.step, first.check) == (120, "reach")
    assert first.margins["reach"] == pytest.approx((12.24 - 12.29) * 0.0254, abs=0.02 * 0.0254)
    assert first.reason is not None and first.reason.startswith("reach is short by")


@pytest.mark.parametrize(
    ("name", "overrides", "agree"),
    [
        ("h-ga", ("start.y=6.2in",), (32, 32)),
        ("h-ga", ("start.y=6.0in",), (31, 32)),
        ("modified-ladder-ga", (), (10, 11)),
        ("ladder-hand", (), None),
    ],
)
def test_the_nearest_rule_is_held_against_the_printed_pegs(
    name: str, overrides: tuple[str, ...], agree: tuple[int, int] | None
) -> None:
    assert verdict(name, *overrides, go_on=True).nearest_agree() == agree


def test_a_shared_peg_is_a_warning_of_the_circle_plan() -> None:
    found = verdict("circle-hand")
    assert found.ok and found.reached
    assert len(found.warnings()["shared"]) == 1
    assert found.to_json()["warnings"]["shared"] == list(found.warnings()["shared"])


def test_stopping_and_going_on_agree_up_to_the_first_violation() -> None:
    stopped = verdict("h-ga", "motor.torque_limit=900oz-in", "start.y=6.2in")
    went_on = verdict("h-ga", "motor.torque_limit=900oz-in", "start.y=6.2in", go_on=True)
    assert not stopped.ok and len(went_on.per_step) == 120
    assert [row.to_json() for row in stopped.per_step] == [
        row.to_json() for row in went_on.per_step[: len(stopped.per_step)]
    ]
    assert stopped.first_violation is not None and stopped.first_violation.check == "torque"
    assert stopped.steps == stopped.first_violation.step - 1 < went_on.steps
    assert stopped.pose == stopped.per_step[-2].pose
    assert went_on.pose == went_on.per_step[-1].pose


def test_a_plan_survives_its_file(ladder: Plan, tmp_path: Path) -> None:
    path = tmp_path / "plan.json"
    ladder.save(path)
    again = load_plan(path)
    assert again == ladder
    assert (
        open_plan(path).check().to_json()["per_step"] == check_plan(ladder.rebuild_task(), ladder).to_json()["per_step"]
    )


def test_a_plan_tells_the_thesis_numbers_it_came_from(ladder: Plan) -> None:
    assert ladder.numbers() == list(load_thesis_plan(LADDER).actions)


def test_nearest_and_random_become_the_holds_they_took() -> None:
    task = load_task("ladder")
    plan = Plan.of_codes(task, [pack(NEAREST, 0, 1), pack(RANDOM, 1)], seed=3, genes=["191", "299"])
    grabs = plan.actions
    assert [action.kind for action in grabs] == ["grab", "grab"]
    assert [action.gene for action in grabs] == ["191", "299"]
    assert [action.code for action in grabs] == [100 + (grabs[0].hold or 0), 200 + (grabs[1].hold or 0)]
    assert [Code.of(int(code)).kind for code in plan.codes(task)] == ["hold", "hold"]
    assert check_plan(task, plan).per_step[1].hold == grabs[1].hold


def test_a_grab_that_finds_no_hold_is_a_violation_of_reach() -> None:
    task = load_task("ladder", ("rules.reach_offset=11in",))
    plan = Plan.of_codes(task, [pack(NEAREST, 0, 2)])
    assert plan.actions[0].hold is None
    first = check_plan(task, Plan.from_json(plan.to_json())).first_violation
    assert first is not None and first.check == "reach" and first.max_torque is None
    json.dumps(check_plan(task, plan).to_json(), allow_nan=False)


def test_boards_with_many_holds_have_no_thesis_numbers() -> None:
    task = load_task("gecko-climb")
    assert task.world.holds[-1].number > 90  # type: ignore[union-attr]
    plan = Plan.of_codes(task, [pack(NEAREST, 0, 1)])
    assert plan.numbers() is None
    assert "grabs" in str(check_plan(task, plan, go_on=True).to_json()["per_step"][0]["action"])


def test_a_walkers_plan_survives_its_file_and_holds() -> None:
    task = load_task("patch-walk")
    plan = Plan.of_codes(task, [pack(MOVE, 0, 0), pack(RELEASE), pack(MOVE, 0, 0)], planner="by hand")
    again = Plan.from_json(json.loads(json.dumps(plan.to_json())))
    assert again == plan and again.numbers() is None
    found = check_plan(again.rebuild_task(), again, go_on=True)
    assert [row.action.kind for row in found.per_step] == ["move", "release", "move"]
    json.dumps(found.to_json(), allow_nan=False)


def test_an_empty_plan_holds_and_is_at_the_start() -> None:
    task, plan = ladder_plan()
    found = check_plan(task, plan)
    assert found.ok and found.steps == 0 and not found.reached
    assert found.holds == {"right": 4, "left": 3, "bottom": 2}


@pytest.mark.parametrize(
    ("action", "key", "words"),
    [
        (PlannedAction(kind="grab", limb="right", hold=77), "actions.1.hold", "board 'ladder' has no hold 77"),
        (PlannedAction(kind="grab", limb="top", hold=3), "actions.1.limb", "right, left, bottom"),
        (PlannedAction(kind="grab", limb="left"), "actions.1.hold", "must be given"),
        (PlannedAction(kind="release"), "actions.1.limb", "must be a limb of robot 'libra'"),
        (PlannedAction(kind="move", delta=(0.0, 0.05, 0.0)), "actions.1.delta", "one step along one axis: 0.0762 m"),
        (PlannedAction(kind="move"), "actions.1.delta", "one step along one axis"),
    ],
)
def test_an_action_that_the_robot_does_not_have_is_named(action: PlannedAction, key: str, words: str) -> None:
    task, plan = ladder_plan(UP, action)
    with pytest.raises(SpecError) as caught:
        plan.codes(task, "my.json")
    assert caught.value.file == "my.json" and caught.value.key == key
    assert words in str(caught.value) and "step 2" in str(caught.value)


def corrupt(data: dict[str, Any], dotted: str, value: Any) -> dict[str, Any]:
    copy = json.loads(json.dumps(data))
    here: Any = copy
    *way, last = dotted.split(".")
    for word in way:
        here = here[int(word)] if isinstance(here, list) else here[word]
    if value is None:
        del here[last]
    else:
        here[last] = value
    return copy  # type: ignore[no-any-return]


@pytest.mark.parametrize(
    ("dotted", "value", "words"),
    [
        ("schema", "clamber-plan-9", 'schema = "clamber-plan-1"'),
        ("schema", None, 'schema = "clamber-plan-1"'),
        ("actions", None, "actions: must be given"),
        ("actions", 3, "actions = 3: must be a list"),
        ("actions.4.kind", "jump", "actions.4.kind = 'jump'"),
        ("actions.4.hold", "seven", "actions.4.hold = 'seven'"),
        ("actions.5.delta", [0.0, 1.0], "actions.5.delta"),
        ("actions.5.delta", [0.0, "up", 0.0], "actions.5.delta.1 = 'up'"),
        ("actions.5.legs", 3, "actions.5.legs = 3: unknown key"),
        ("document", [], "document = []: must be a table"),
        ("hashes.robot", 5, "hashes.robot = 5"),
        ("seed", -1, "seed = -1"),
        ("extra", 1, "extra = 1: unknown key"),
    ],
)
def test_a_corrupt_plan_file_names_file_and_key(
    ladder: Plan, tmp_path: Path, dotted: str, value: Any, words: str
) -> None:
    path = tmp_path / "plan.json"
    path.write_text(json.dumps(corrupt(ladder.to_json(), dotted, value)))
    with pytest.raises(SpecError) as caught:
        load_plan(path)
    assert str(path) in str(caught.value) and words in str(caught.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is not valid JSON"),
        ('{"schema": "clamber-plan-1",', "is not valid JSON"),
        ("[1, 2]", "holds no table"),
        ('{"schema": NaN}', "NaN is no JSON number"),
        ("[" * 100_000, "is not valid JSON"),
        ("\udcff", "is not UTF-8"),
    ],
)
def test_a_file_that_is_no_plan_is_named(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "plan.json"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(FileError, match=words) as caught:
        load_plan(path)
    assert str(path) in str(caught.value)


def test_every_truncation_of_a_plan_file_is_a_named_error(ladder: Plan, tmp_path: Path) -> None:
    path = tmp_path / "plan.json"
    whole = json.dumps(ladder.to_json())
    for end in np.linspace(0, len(whole) - 1, 40).astype(int):
        path.write_text(whole[:end])
        with pytest.raises(ClamberError):
            load_plan(path)


def test_a_plan_whose_stored_task_was_edited_is_refused(ladder: Plan) -> None:
    document = json.loads(json.dumps(ladder.document))
    document["start"]["x"] = "8 in"
    with pytest.raises(SpecError, match=r"hashes\.task.*hash of 'task'"):
        dataclasses.replace(ladder, document=document).rebuild_task("my.json")


def test_the_stored_task_takes_overrides(ladder: Plan, tmp_path: Path) -> None:
    path = tmp_path / "plan.json"
    ladder.save(path)
    assert open_plan(path).check().ok
    weak = open_plan(path, None, ("motor.torque_limit=600oz-in",)).check()
    assert weak.first_violation is not None and weak.first_violation.check == "torque"
    assert open_plan(path, "ladder", ("step.length=3in",)).check().ok
    with pytest.raises(SpecError, match="unknown key"):
        open_plan(path, None, ("nonsense=1",))


def test_a_plan_in_another_task_names_the_hold_that_is_not_there(ladder: Plan, tmp_path: Path) -> None:
    path = tmp_path / "plan.json"
    ladder.save(path)
    with pytest.raises(SpecError, match=r"actions\.\d+\.hold = 6: board 'modified-ladder' has no hold 6"):
        open_plan(path, "modified-ladder", ("step.length=3in",)).check()


def test_step_sizes_come_from_the_plan_file_unless_overridden() -> None:
    opened = open_plan(PRINTED / "h-hand.toml")
    assert opened.task.step.length == pytest.approx(3 * 0.0254)  # type: ignore[union-attr]
    assert opened.notes == ("step sizes as the plan file says: step.length=3in, step.angle=15deg",)
    chosen = open_plan(PRINTED / "h-hand.toml", None, ("step.length=1in",))
    assert chosen.task.step.length == pytest.approx(0.0254)  # type: ignore[union-attr]
    assert chosen.notes == ("step sizes as the plan file says: step.angle=15deg",)


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("n_steps=120", "n_steps=119", "n_steps = 119: must be the number of actions, 120"),
        ("n_steps=120", "", "n_steps: must be given"),
        ("step_inch=1", "step_inch=-1", "step_inch = -1"),
        ("step_inch=1", 'step_inch="1 in"', "step_inch = '1 in'"),
        ("step_inch=1", "step_inch=nan", "step_inch = nan"),
        ("3, 3, 293,", "3, 7, 293,", "actions.1 = 7: must be 0..6"),
        ("3, 3, 293,", "3, 400, 293,", "actions.1 = 400: must be 0..6, or three digits that start with the limb, 1..3"),
        ("3, 3, 293,", "3, 150, 293,", "actions.1 = 150: board 'h' has no hold 50"),
        ("3, 3, 293,", "3, 3, 3, 293,", "n_steps"),
        ("0, 0, 4, 11,", "0, 2, 4, 11,", "actual_peg.1 = 2: must be 0, for action 3 takes no peg"),
        ("0, 0, 4, 11,", "0, 0, 70, 11,", "actual_peg.2 = 70: board 'h' has no hold 70"),
        ("0, 0, 4, 11,", "0, 0, 4,", "actual_peg"),
        ('task="h"', "task=5", "task = 5"),
        ('task="h"', 'tasks="h"', "unknown key"),
    ],
)
def test_a_corrupt_printed_plan_names_file_and_key(tmp_path: Path, before: str, after: str, words: str) -> None:
    text = H_GA.read_text()
    assert before in text
    path = tmp_path / "plan.toml"
    path.write_text(text.replace(before, after, 1))
    with pytest.raises(SpecError) as caught:
        open_plan(path)
    assert str(path) in str(caught.value) and words in str(caught.value)


@pytest.mark.parametrize("name", plan_names())
def test_a_shipped_plan_is_known_by_its_name(name: str) -> None:
    assert is_plan(name)
    assert name not in task_names()
    assert open_plan(name).plan == open_plan(PRINTED / f"{name}.toml").plan


def test_a_printed_plan_for_an_unknown_task_is_named(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    path.write_text(H_GA.read_text().replace('task="h"', 'task="hh"'))
    with pytest.raises(UnknownNameError, match="no task is called 'hh'"):
        open_plan(path)
    assert open_plan(path, "h").check().length == 120


def test_plan_files_are_told_from_task_files(tmp_path: Path) -> None:
    assert is_plan(str(H_GA)) and is_plan("some/where.json")
    assert not is_plan("ladder") and not is_plan("missing.toml")
    task = tmp_path / "task.toml"
    task.write_text('schema = "clamber-task-1"\nname = "actions"\n')
    assert not is_plan(str(task))
