"""Joint trajectories of plans and runs: the numbers are the robot's, in the message's fields, and put its tips where they were."""

import cmath
import csv
import io
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.errors import SpecError
from clamber.execution.log_files import write_log
from clamber.exports.joint_trajectory import JointTrajectory, moved
from clamber.exports.library import plan_trajectory, run_trajectory
from clamber.families.climber.execution.climb_trace import ClimbTrace, climb_titles
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.walker.execution.walk_trace import WalkTrace, walk_titles
from clamber.families.walker.planning.task import WalkerTask
from clamber.families.walker.robot import WalkerRobot
from clamber.planning.planners import plan_task
from clamber.planning.problem.plan_source import open_plan
from clamber.tasks import load_task


def swing(rows: int = 201) -> JointTrajectory:
    time = np.linspace(3.0, 5.0, rows)
    return moved(("a", "b"), (False, True), time, np.stack([np.sin(time), time**2], axis=1), "log")


def test_velocities_and_accelerations_are_the_derivatives() -> None:
    told = swing()
    time = told.time + 3.0
    assert told.velocities is not None and told.accelerations is not None
    inner = slice(2, -2)  # the ends are one-sided
    np.testing.assert_allclose(told.velocities[inner, 0], np.cos(time)[inner], atol=1e-4)
    np.testing.assert_allclose(told.accelerations[inner, 0], -np.sin(time)[inner], atol=2e-4)
    np.testing.assert_allclose(told.velocities[inner, 1], 2.0 * time[inner], rtol=1e-9)
    np.testing.assert_allclose(told.accelerations[inner, 1], 2.0, rtol=1e-6)


def test_the_message_has_the_fields_of_ros_and_nothing_else() -> None:
    message = swing(5).to_json()
    assert set(message) == {"header", "joint_names", "points"}
    assert set(message["header"]) == {"stamp", "frame_id"}
    assert set(message["header"]["stamp"]) == {"sec", "nanosec"}
    stamps = []
    for point in message["points"]:
        assert set(point) == {"positions", "velocities", "accelerations", "effort", "time_from_start"}
        assert len(point["positions"]) == len(message["joint_names"]) == 2
        assert point["effort"] == []  # nothing known
        stamp = point["time_from_start"]
        assert isinstance(stamp["sec"], int) and 0 <= stamp["nanosec"] < 1_000_000_000
        stamps.append(stamp["sec"] + 1e-9 * stamp["nanosec"])
    assert stamps == [0.0, 0.5, 1.0, 1.5, 2.0]


def test_the_table_has_the_same_numbers_with_units() -> None:
    told = swing(5)
    rows = list(csv.reader(io.StringIO(told.to_csv())))
    assert rows[0][:4] == ["time [s]", "a position [rad]", "b position [m]", "a velocity [rad/s]"]
    values = np.array([[float(value) for value in row] for row in rows[1:]])
    np.testing.assert_array_equal(values[:, 1:3], told.positions)
    np.testing.assert_array_equal(values[:, 0], told.time)


@pytest.mark.parametrize("time", [[0.0], [0.0, 1.0, 1.0]])
def test_times_that_do_not_rise_are_refused(time: list[float]) -> None:
    with pytest.raises(SpecError, match="later than the one before"):
        moved(("a",), (False,), np.array(time), np.zeros((len(time), 1)), "log")


@pytest.mark.parametrize("name", ["ladder-hand", "h-ga"])
def test_a_climbers_plan_keeps_holding_tips_on_their_holds(name: str) -> None:
    opened = open_plan(name)
    task, told = opened.task, plan_trajectory(opened)
    assert isinstance(task, LimbedTask) and told.effort is not None
    rows = opened.check(go_on=True).per_step
    assert len(told.time) == len(rows) + 1
    places = {hold.number: complex(hold.x, hold.y) for hold in task.world.holds}
    held = 0
    for k, row in enumerate(rows, start=1):
        x, y, angle = row.pose
        off = [0.0]
        for i, limb in enumerate(task.robot.limbs):
            shoulder, elbow = told.positions[k, 2 * i : 2 * i + 2]
            assert limb.shoulder.lower - 1e-9 <= shoulder <= limb.shoulder.upper + 1e-9
            if not (hold := row.holds[limb.name]):
                continue
            held += 1
            first = angle + limb.port_angle + shoulder
            tip = complex(x, y) + complex(limb.port_x, limb.port_y) * cmath.exp(1j * angle)
            tip += cmath.rect(limb.l1, first) + limb.second_link * cmath.exp(1j * (first + elbow))
            off.append(abs(tip - places[hold]))
        reach = row.margins["reach"]
        assert reach is not None
        assert max(off) == pytest.approx(max(0.0, -reach), abs=1e-9)  # stretched towards a hold that is too far
        assert row.max_torque == pytest.approx(np.abs(told.effort[k]).max())
    assert held > len(rows)
    np.testing.assert_allclose(np.diff(told.time), task.step.duration)


def test_a_walkers_plan_has_actuators_as_long_as_its_frames_are_apart(tmp_path: Path) -> None:
    task = load_task("patch-walk")
    assert isinstance(task, WalkerTask)
    plan_task(task, "greedy", seed=0, seconds=60.0).plan.save(tmp_path / "plan.json")
    told = plan_trajectory(open_plan(tmp_path / "plan.json"))
    robot = task.robot
    assert isinstance(robot, WalkerRobot)
    on_delta, on_y = robot.attachments()
    for row in told.positions:
        x, y, turn = row[:3]
        c, s = math.cos(turn), math.sin(turn)
        ends = on_y @ np.array(((c, s), (-s, c))) + (x, y)
        np.testing.assert_allclose(row[3:], np.linalg.norm(ends - on_delta, axis=1), atol=1e-9)
    assert np.all(np.diff(told.time) > 0.0)
    assert np.ptp(told.positions[:, 0]) > 0.05  # it does walk


def climb_log(path: Path) -> ClimbTrace:
    rng = np.random.default_rng(1)
    columns = sum(map(len, climb_titles(("left", "right"), true=False).values()))
    table = rng.normal(size=(6, columns))
    table[:, 0] = 0.1 * np.arange(6)
    trace = ClimbTrace.from_table(("left", "right"), table, {"done": True})
    write_log(trace.to_log(), path, "climb")
    return trace


@pytest.mark.parametrize("suffix", [".csv", ".mcap"])
def test_a_climbs_log_becomes_its_angles_and_torques(tmp_path: Path, suffix: str) -> None:
    trace = climb_log(tmp_path / f"run{suffix}")
    told = run_trajectory(tmp_path / f"run{suffix}")
    assert told.names == ("left_shoulder", "left_elbow", "right_shoulder", "right_elbow")
    np.testing.assert_array_equal(told.positions, trace.angles.reshape(6, -1))
    np.testing.assert_array_equal(told.effort, trace.torques.reshape(6, -1))
    np.testing.assert_allclose(told.velocities[1:-1], (told.positions[2:] - told.positions[:-2]) / 0.2)


def test_a_walks_log_becomes_frames_legs_and_actuators(tmp_path: Path) -> None:
    columns = sum(map(len, walk_titles(true=False).values()))
    table = np.random.default_rng(2).normal(size=(4, columns))
    table[:, 0] = np.arange(4)
    trace = WalkTrace.from_table(table, {"done": True})
    write_log(trace.to_log(), tmp_path / "walk.mcap", "walk")
    told = run_trajectory(tmp_path / "walk.mcap")
    assert told.names[:3] == ("slide_x", "slide_y", "turn") and told.names[-1] == "actuator_2"
    assert told.sliding == (True, True, False, *(True,) * 9)
    np.testing.assert_array_equal(told.positions[:, 3:9], trace.lengths)
    assert told.effort is None


def test_the_command_writes_tables_messages_and_robots(clamber: Any, tmp_path: Path) -> None:
    climb_log(tmp_path / "run.mcap")
    for thing, file in (
        (str(tmp_path / "run.mcap"), "run.json"),
        ("ladder-hand", "plan.csv"),
        ("ladder-hand", "plan.md"),
        ("libra", "libra.urdf"),
        ("libra", "libra.xml"),
    ):
        code, out, _ = clamber("export", thing, "-o", str(tmp_path / file), "--json")
        assert code == 0
        assert json.loads(out)["bytes"] == (tmp_path / file).stat().st_size > 500
    assert len(json.loads((tmp_path / "run.json").read_text())["points"]) == 6


def test_a_plans_table_has_a_row_for_every_action_and_names_what_is_violated(clamber: Any, tmp_path: Path) -> None:
    file = tmp_path / "plan.md"
    assert clamber("export", "ladder-hand", "-o", str(file), "--set", "weight=20kgf")[0] == 0
    verdict = open_plan("ladder-hand", None, ["weight=20kgf"]).check(go_on=True)
    lines = file.read_text(encoding="utf-8").splitlines()
    assert sum(line.startswith("| ") for line in lines) == verdict.length + 1
    violated = [row for row in verdict.per_step if not row.ok]
    assert violated
    assert sum("violates torque" in line for line in lines) == sum(row.check == "torque" for row in violated)
    assert any(line.startswith(f"First violation, at step {violated[0].step}") for line in lines)


def test_a_plan_that_does_not_hold_is_exported_and_said_so(clamber: Any, tmp_path: Path) -> None:
    code, out, _ = clamber("export", "h-ga", "-o", str(tmp_path / "plan.json"))
    assert code == 0
    assert "step 120 violates a hard check" in " ".join(out.split())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("libra", "-o", "libra.gif"), "no robot can be exported as '.gif'; allowed are .xml, .mjcf, .urdf"),
        (("libra", "-o", "libra"), "no suffix that says the format"),
        (("ladder-hand", "-o", "x.mp4"), "`clamber show PLAN -o FILE` draws it"),
        (("nothing", "-o", "x.urdf"), "no robot, plan or log is called 'nothing'"),
        (("libra", "-o", "x.urdf", "--task", "ladder"), "is for plans; this is a robot"),
        (("missing.mcap", "-o", "x.csv"), "does not exist"),
        (("missing.toml", "-o", "x.urdf"), "does not exist"),
        (("libra", "-o", "nowhere/x.urdf"), "does not exist"),
    ],
)
def test_what_cannot_be_is_one_message(
    clamber: Any, words: tuple[str, ...], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, err = clamber("export", *words)
    assert code == 2
    assert said in " ".join(err.split()) and "Traceback" not in err
    assert not any(tmp_path.iterdir())
