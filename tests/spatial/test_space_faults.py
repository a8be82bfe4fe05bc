"""Faults of robots in space: what a plant with one says, what the robot bridges, what it notices, and how its runs end."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from standing import STIFF, Standing

from clamber.control.whole_body.programme import Gains
from clamber.execution.fault import ANY, FAULTS, Fault, draw_fault
from clamber.execution.run_report import FaultError
from clamber.families.spatial.control.believed_tree import believed_tree, joint_inertias, joint_limits
from clamber.families.spatial.control.laws import USUAL, body_law
from clamber.families.spatial.execution.faulty_spatial import FaultySpatial, failing_of, fault_kinds
from clamber.families.spatial.execution.plant import SpatialSensed
from clamber.families.spatial.execution.sensor_watch import SensorWatch
from clamber.families.spatial.execution.sensors import sensor_names
from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.robot.contacts import MOST_ROWS
from clamber.families.spatial.sim.spatial_flaws import SpatialFlaws
from clamber.families.spatial.trials.law_trials import first_steps
from clamber.families.spatial.trials.noise import SpatialNoise
from clamber.families.spatial.trials.run_plan import SpatialRun, run_plan
from clamber.families.spatial.trials.trials import judged
from clamber.tasks.library import load_task
from clamber.trials.fault_trials import ENDINGS, ending_of_run
from clamber.types import Floats

NAME = "wall-gripper"
START = 1.0
"""When the faults of these tests begin [s]: the body moves."""


def gripper() -> SpatialTask:
    task = load_task(NAME)
    assert isinstance(task, SpatialTask)
    return task


def climbed(fault: Fault | None, name: str = NAME, seed: int = 1) -> SpatialRun:
    """The first steps of a plan, under the usual noise."""
    task = load_task(name)
    assert isinstance(task, SpatialTask)
    noise = SpatialNoise.of("usual")
    true = replace(noise.deviations(task.robot, task.world, seed), fault=fault)
    return run_plan(task, first_steps(task), flaws=noise.flaws(SpatialFlaws(), seed), deviations=true)


def fault_of(kind: str, size: float, where: str = "", start: float = START) -> Fault:
    names = sensor_names(gripper().robot)
    return Fault(kind=kind, start=start, size=size, channel=names.index(where) if where else 0, where=where, seed=5)


def told(sensed: SpatialSensed) -> list[Floats]:
    return [np.array(part, np.float64) for part in sensed]


def stand(fault: Fault | None, seconds: float) -> list[list[Floats]]:
    """What a robot that stands is told by its plant, tick by tick; its joints are held by stiff springs."""
    noise = SpatialNoise.of("usual")
    at = Standing(NAME, noise.flaws(SpatialFlaws(), 3))
    plant: Any = at.plant
    if fault is not None:
        inertias = joint_inertias(believed_tree(at.robot, at.task.world.gravity), at.joints)
        plant = FaultySpatial(at.plant, fault, at.robot.chains, inertias)
    plant.reset(at.pose, at.joints, at.held)
    for limb in range(len(at.robot.limb_names)):
        plant.grip(limb, True)
    rows = []
    for _ in range(round(seconds / plant.period)):
        rows.append(told(plant.sense()))
        wanted = np.nan_to_num(STIFF * (at.joints - rows[-1][0][0]))
        plant.actuate(at.limits * np.clip(wanted, -1.0, 1.0))
        plant.step()
    return rows


@pytest.mark.parametrize("kind", ["nan", "stuck", "dead", "late", "hold"])
def test_before_its_fault_begins_a_plant_says_what_it_says_without(kind: str) -> None:
    sound, faulty = stand(None, 0.3), stand(fault_of(kind, 1.0, start=0.2), 0.3)
    before = round(0.2 * 400)
    for mine, other in zip(sound[:before], faulty[:before], strict=True):
        assert all(np.array_equal(a, b) for a, b in zip(mine, other, strict=True))


def test_a_sensor_that_fails_is_the_only_one_that_does() -> None:
    task = gripper()
    names = sensor_names(task.robot)
    for kind, where in (("nan", names[-1]), ("drift", "gyro y"), ("stuck", "LF force z")):
        fault = fault_of(kind, 0.5, where, start=0.1)
        sound, faulty = stand(None, 0.12), stand(fault, 0.12)
        *_, last = zip(sound, faulty, strict=True)
        off = [np.flatnonzero(~np.isclose(a, b, rtol=0.0, atol=1e-12)) for a, b in zip(*last, strict=True)]
        assert sum(len(part) > 0 for part in off) == 1, (kind, off)


def test_failing_sensors_have_the_ranges_of_their_robot_and_holds_are_those_of_limbs_that_attach() -> None:
    task = gripper()
    failing = failing_of(task, first_steps(task))
    assert list(failing.sensors) == list(sensor_names(task.robot))
    assert all(0.0 < span < math.inf for span in failing.sensors.values())
    assert len(failing.motors) == int(task.robot.chains.n_joints.sum())
    assert set(failing.kinds) == set(FAULTS) == set(fault_kinds(task.robot))
    drawn = [draw_fault([ANY], seed, failing) for seed in range(200)]
    assert {fault.kind for fault in drawn} == set(FAULTS)
    feet = load_task("stones-quadruped")
    assert isinstance(feet, SpatialTask)
    assert set(FAULTS) - set(fault_kinds(feet.robot)) == {"hold"}  # feet only push
    assert set(failing_of(feet, first_steps(feet)).kinds) == set(fault_kinds(feet.robot))


class Watching:
    """A watch of a robot at rest, and readings to be looked at."""

    period = 1.0 / 400.0

    def __init__(self) -> None:
        task = gripper()
        tree = believed_tree(task.robot, task.world.gravity)
        law = body_law(USUAL)(tree, joint_limits(task.robot), Gains(arm=0.3), MOST_ROWS)
        self.watch = SensorWatch(task.robot, law, self.period)
        self.chance = np.random.default_rng(7)
        self.sensed = SpatialSensed.of(task.robot.chains)
        self.holds = np.full(tree.limbs, -1, np.int32)
        self.number = 0

    def see(self, **changed: Any) -> list[Floats]:
        """What is read at a tick, with noise; what is believed of it then is in `sensed`."""
        sensed, chance, number = self.sensed, self.chance, self.number
        self.number += 1
        sensed.joints[0], sensed.joints[1] = 0.1 + 0.2 * number * self.period, 0.2
        for part, spread in ((sensed.gyro, 1e-3), (sensed.accelerometer, 1e-2), (sensed.wrenches, 1e-3)):
            part[:] = spread * chance.standard_normal(part.shape)
        sensed.number[0] = number
        for key, (index, value) in changed.items():
            getattr(sensed, key)[index] = value
        read = told(sensed)
        self.watch.see(sensed, self.holds)
        return read


def test_readings_without_a_fault_are_believed_to_the_last_bit() -> None:
    watching = Watching()
    for _ in range(200):
        read = watching.see()
        assert all(np.array_equal(a, b) for a, b in zip(read, told(watching.sensed), strict=True))
    assert watching.watch.monitor.findings == []


@pytest.mark.parametrize("value", [math.nan, math.inf, 2.0])
def test_a_joint_goes_on_at_its_last_speed_where_its_reading_is_not_to_be_believed(value: float) -> None:
    watching = Watching()
    for _ in range(50):
        watching.see()
    for _ in range(10):
        watching.see(joints=((0, 2), value))
        assert watching.sensed.joints[0, 2] == pytest.approx(watching.sensed.joints[0, 1], abs=1e-9)
        assert watching.sensed.joints[1, 2] == pytest.approx(0.2)
    read = watching.see()
    assert watching.sensed.joints[0, 2] == read[0][0, 2]
    (found,) = watching.watch.monitor.findings
    assert (found.kind, found.where) == (
        "jump" if math.isfinite(value) else "no number",
        sensor_names(gripper().robot)[2],
    )


@pytest.mark.parametrize(("part", "index"), [("gyro", 1), ("accelerometer", 2), ("wrenches", (1, 2)), ("torques", 3)])
def test_other_sensors_keep_their_last_reading_for_fifty_milliseconds(part: str, index: Any) -> None:
    watching = Watching()
    for _ in range(50):
        watching.see()
    kept = getattr(watching.sensed, part)[index]
    first = watching.number
    with pytest.raises(FaultError, match="no number"):
        while True:
            watching.see(**{part: (index, math.nan)})
            assert getattr(watching.sensed, part)[index] == kept
    assert watching.number - first == 1 + round(0.05 / watching.period)
    assert np.isfinite(getattr(watching.sensed, part)[index])


def test_the_robots_own_clock_goes_on_where_no_reading_comes() -> None:
    watching = Watching()
    numbers = [0, 1, 2, 2, 2, 5, 6, 4, 8]
    clock = []
    for number in numbers:
        watching.number = number
        watching.see()
        clock.append(int(watching.sensed.number[0]))
    assert clock == list(range(len(numbers)))


def test_a_run_whose_fault_begins_after_its_end_is_the_run_without() -> None:
    sound, faulty = climbed(None), climbed(fault_of("nan", 1.0, start=1e3))
    assert sound.done, sound.reason
    assert sound.report.findings == faulty.report.findings == []
    assert sound.trace.true_pose is not None and faulty.trace.true_pose is not None
    assert np.array_equal(sound.trace.true_pose, faulty.trace.true_pose)
    assert np.array_equal(sound.trace.torques, faulty.trace.torques)
    assert sound.report.seconds == faulty.report.seconds


def test_legs_that_stand_with_nearly_all_their_torque_are_not_told_as_faults() -> None:
    heavy = ["payload.mass=35 kg", "payload.at=['0 m','0 m','0.05 m']", "robot.torque_share=1.0"]
    task = load_task("stones-quadruped", heavy)
    assert isinstance(task, SpatialTask)
    run = run_plan(task, first_steps(task))
    assert run.done, run.reason
    assert run.report.torque > 0.95 and run.report.findings == []


@pytest.mark.parametrize(("kind", "size", "seen"), [("nan", 0.02, "no number"), ("spikes", 0.4, "jump")])
def test_an_encoder_that_fails_now_and_then_is_bridged_and_the_run_ends_as_without(
    kind: str, size: float, seen: str
) -> None:
    run = climbed(fault_of(kind, size, "LF_2"))
    assert run.done, run.reason
    assert {(found.kind, found.where) for found in run.report.findings} == {(seen, "LF_2")}
    trial = judged(1, run, SpatialNoise.of("none"))
    assert trial.fault is not None and (trial.fault["ending"], trial.fault["noticed_as"]) == ("recovered", seen)
    assert trial.fault["early"] == []


@pytest.mark.parametrize(
    ("kind", "size", "where", "seen"),
    [("nan", 9.0, "LF_2", {"no number"}), ("dead", 1.0, "LF_2", {"unbalanced", "no answer"})],
)
def test_what_cannot_be_bridged_is_told_and_ends_in_a_held_posture(
    kind: str, size: float, where: str, seen: set[str]
) -> None:
    run = climbed(fault_of(kind, size, where))
    assert not run.done and run.reason.startswith("fault: "), run.reason
    found = run.report.findings[-1]
    assert found.kind in seen
    assert found.where == where
    assert START < found.time < START + 8.0
    assert run.report.ending == "held"
    assert run.trace.time[-1] == pytest.approx(found.time + 3.0, abs=0.05)  # what became of it is in the log, too
    assert run.to_json()["ending"] == "held"


def test_a_robot_that_hears_nothing_any_more_holds_its_posture_by_itself() -> None:
    run = climbed(Fault(kind="lost", start=START, size=1.0, seed=5))
    assert run.reason.startswith("fault: no reading"), run.reason
    assert run.report.ending == "held"


def test_a_hold_that_gives_way_below_its_strength_is_told() -> None:
    task = gripper()
    failing = failing_of(task, first_steps(task))
    number = failing.holds[0]
    run = climbed(Fault(kind="hold", start=START, size=0.02 * failing.weight, channel=number, where=f"hold {number}"))
    assert [one.hold for one in run.broken] == [number]
    assert ending_of_run(run.done, run.report) in ENDINGS


@pytest.mark.slow
@pytest.mark.parametrize("name", [NAME, "stones-quadruped"])
@pytest.mark.parametrize("kind", list(FAULTS))
def test_every_kind_of_fault_ends_in_a_report(kind: str, name: str) -> None:
    task = load_task(name)
    assert isinstance(task, SpatialTask)
    if kind not in fault_kinds(task.robot):
        return
    for seed in (1, 2, 3):
        fault = draw_fault([kind], seed, failing_of(task, first_steps(task)), (0.5, 4.0))
        run = climbed(fault, name, seed)
        assert run.done != bool(run.reason)
        assert ending_of_run(run.done, run.report) in ENDINGS
        assert all(found.time >= fault.start for found in run.report.findings)
        assert run.to_json() is not None


def test_a_kind_of_fault_that_a_robot_cannot_have_is_one_message(clamber: Any) -> None:
    code, out, err = clamber("trials", "stones-quadruped", "--fault", "hold", "-q")
    assert (code, out) == (2, "")
    assert "hold" in err and "Traceback" not in err
