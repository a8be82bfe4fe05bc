"""Sweeps: the same table with any number of workers, points that can't begin, errors before work starts."""

import json
from pathlib import Path
from typing import Any

import pytest

from clamber.cli import main
from clamber.errors import SpecError, UnknownNameError
from clamber.jobs import StoreError
from clamber.planning.axes import Axis, SweepError, check_axes, range_axis, read_mark, values_axis
from clamber.planning.problem.problems import pose_problem
from clamber.planning.sweep import Sweep, run_sweep
from clamber.tasks import load_task
from clamber.units import INCH

SMALL = ("rules.max_hangs=0", "goal.y_min=15in")
SETTINGS: dict[str, Any] = {"overrides": SMALL, "options": {"max_stances": 20_000}}


def numbers(sweep: Sweep) -> list[dict[str, Any]]:
    """All but the time that it took."""
    return [{key: value for key, value in point.items() if key != "seconds"} for point in sweep.to_json()["points"]]


@pytest.mark.parametrize("workers", [(1, 2), pytest.param((1, 2, 4), marks=pytest.mark.slow)])
def test_the_table_is_the_same_with_any_number_of_workers(workers: tuple[int, ...]) -> None:
    axes = [range_axis("motor.torque_limit=1Nm..9Nm:3"), values_axis("board.ladder.spacing=6in,6.5in")]
    tables = [numbers(run_sweep("ladder", axes, workers=n, **SETTINGS)) for n in workers]
    assert all(table == tables[0] for table in tables)
    statuses = {tuple(point["values"]): point["status"] for point in tables[0]}
    assert statuses["1 Nm", "6in"] == "no start" and statuses["9 Nm", "6in"] == "optimal"
    best = tables[0][4]
    assert best["length"] > 0 and best["least_torque_Nm"] > 0.0 and best["max_torque_Nm"] <= 9.0
    for row in tables[0]:
        if row["status"] == "optimal":  # the start counts among the least, so it alone may be above the plan's own
            limit, spacing = row["values"]
            task = load_task("ladder", (*SMALL, f"motor.torque_limit={limit}", f"board.ladder.spacing={spacing}"))
            start = float(pose_problem(task).problem.start["torque"][0])
            assert row["least_torque_Nm"] <= max(row["max_torque_Nm"], start) + 1e-9
    assert "torque" in tables[0][0]["reason"]


@pytest.mark.usefixtures("in_this_process")
def test_a_point_that_is_no_task_is_a_row_with_its_reason() -> None:
    sweep = run_sweep("ladder", [values_axis("start.holds.right=4,99")], **SETTINGS)
    assert [point.status for point in sweep.points] == ["optimal", "no start"]
    assert "has no such hold" in sweep.points[1].reason


@pytest.mark.usefixtures("in_this_process")
def test_a_store_goes_on_with_its_own_sweep_alone(tmp_path: Path) -> None:
    store, axes = tmp_path / "store.db", [range_axis("motor.torque_limit=8Nm..9Nm:2")]
    first = run_sweep("ladder", axes, store=store, **SETTINGS)
    again = run_sweep("ladder", axes, store=store, resume=True, **SETTINGS)
    assert again == first, "finished points, their seconds included, come from the store"
    with pytest.raises(StoreError, match=r"holds the results of the sweep of 'ladder' over motor\.torque_limit"):
        run_sweep("ladder", [range_axis("motor.torque_limit=8Nm..9Nm:3")], store=store, resume=True, **SETTINGS)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a=10Nm..12Nm:3", ("10 Nm", "11 Nm", "12 Nm")),
        ("a = 0.5 .. 1.0 : 2", ("0.5", "1")),
        ("board.ladder.rungs=8..14:3", ("8", "11", "14")),
        ("a=-15deg..15deg:2", ("-15 deg", "15 deg")),
    ],
)
def test_a_range_is_read(text: str, values: tuple[str, ...]) -> None:
    assert range_axis(text).values == values


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a=12Nm..10Nm", "the range is empty; the first end must be less than the second"),
        ("a=10..12Nm", "one end is in '', the other in 'Nm'; state the same unit at both ends"),
        ("a=10Nm", "is no range; write key=low..high:points"),
        ("a=x..12Nm", "'x' is no number"),
        ("a=1Nm..2Nm:1", "'1' is no number of points; state a whole number, 2 or more"),
        ("a=1..5:4", "4 points between whole numbers are not all whole; take 2 or 3 or 5 points"),
    ],
)
def test_a_wrong_range_is_told(text: str, message: str) -> None:
    with pytest.raises(SweepError) as caught:
        range_axis(text)
    assert str(caught.value).startswith(f"--vary {text}: {message}")


def test_wrong_axes_keys_units_and_planners_are_told_before_work_starts() -> None:
    axis = range_axis("motor.torque_limit=8Nm..9Nm:2")
    for axes, message in (((), "0 keys are to vary"), ((axis, axis), "is to vary twice")):
        with pytest.raises(SweepError, match=message):
            check_axes(axes)
    with pytest.raises(SweepError, match="names a value twice"):
        values_axis("a=1,1")
    with pytest.raises(SpecError, match=r"motor\.torque_limits.*unknown key.*did you mean 'torque_limit'"):
        run_sweep("ladder", [Axis(key="motor.torque_limits", values=("8 Nm",))])
    with pytest.raises(SpecError, match=r"motor\.torque_limit.*is no unit of torque"):
        run_sweep("ladder", [range_axis("motor.torque_limit=8kg..9kg:2")])
    with pytest.raises(SpecError, match="lacks its unit"):
        run_sweep("ladder", [range_axis("motor.torque_limit=8..9")])
    with pytest.raises(UnknownNameError, match="no planner is called 'exat'"):
        run_sweep("ladder", [axis], planner="exat")


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("name", ["out.csv", "out.png"])
def test_the_command_prints_json_and_writes_a_file(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    words = ["sweep", "ladder", "--vary", "motor.torque_limit=8Nm..9Nm:2", "--workers", "1", "--json"]
    with pytest.raises(SystemExit) as left:
        main([*words, "-o", str(tmp_path / name), *(word for text in SMALL for word in ("--set", text))])
    told = json.loads(capfd.readouterr().out)
    assert left.value.code == 0 and told["found"] == 2 and len(told["points"]) == 2
    content = (tmp_path / name).read_bytes()
    assert content.startswith(b"\x89PNG" if name.endswith("png") else b"motor.torque_limit,status,length,least")


@pytest.mark.usefixtures("in_this_process")
def test_a_mark_is_a_value_or_a_range_of_an_axis_in_its_unit() -> None:
    axes = [range_axis("board.spacing=18in..20in:3"), values_axis("board.rung=6in,7in")]
    marks = [read_mark("board.spacing=18in..19in", axes), read_mark("board.rung=6in", axes)]
    sweep = run_sweep("ladder", axes, marks=marks, **SETTINGS)
    assert [sweep.marked(k) for k in range(6)] == [True, False, True, False, False, False]
    for text, message in (
        ("board.rungs=6", "'board.rungs' does not vary; mark board.spacing or board.rung"),
        ("board.rung=15cm", "is in 'cm'; state the unit of the axis, 'in'"),
        ("board.rung=x", "'x' is no number and no range"),
        ("board.rung=7in..6in", "the range is empty"),
    ):
        with pytest.raises(SweepError, match=message):
            read_mark(text, axes)


def test_the_start_between_holds_follows_them() -> None:
    task = load_task("ladder", ("board.spacing=20in", "board.rung=5in"))
    assert (task.start.x, task.start.y) == pytest.approx((10 * INCH, 5 * INCH))
    assert load_task("ladder").start.x == pytest.approx(9 * INCH)
    assert load_task("ladder", ("start.x=8in",)).start.x == pytest.approx(8 * INCH)
    with pytest.raises(SpecError, match=r"start\.between.*has no hold 99"):
        load_task("ladder", ("start.between=[3,99]",))
