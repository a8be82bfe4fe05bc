"""A climber with a fault: it goes on, holds its posture, stops safely or falls, and always says which fault it has noticed."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from clamber.benchmarks.climb_speed import two_rungs
from clamber.execution.fault import ANY, FAULTS, Fault, FaultChoiceError, Injector, draw_fault
from clamber.execution.faulty_plants import step_on
from clamber.execution.hardware import Hardware, Reading, WiredClimber
from clamber.execution.plant import PlantLayer
from clamber.execution.posture_guard import PostureGuard
from clamber.execution.sequencer import Sequencer
from clamber.execution.wiring import LOST_COUNT
from clamber.families.climber.execution.climb_trace import TracedClimber
from clamber.families.climber.execution.climbing import Climbing
from clamber.families.climber.execution.executable_plan import lay_course
from clamber.families.climber.execution.wiring import guard_of, wiring_of
from clamber.families.climber.sim.climber_plant import ClimberPlant
from clamber.families.climber.trials.noise import Noise
from clamber.families.climber.trials.plants import truth_of
from clamber.families.climber.trials.run_plan import ClimbRun, climbing_flaws, climbing_task, failing_of, run_plan
from clamber.planning.problem.plan import Plan, load_plan
from clamber.sim.wires import ClimberWires
from clamber.tasks import load_task
from clamber.trials.fault_trials import ENDINGS, ending_of_run
from clamber.types import Floats
from tiers import first_fast

ROOT = Path(__file__).parents[2]
FIRST = 8.0
"""When the faults of these tests begin [s]: the robot climbs its second action."""
CAUGHT = (134217732, 134217730, 536870919, 545259526, 285212672)
"""The first five actions of our own plan up the ladder."""
JOINTS = ("right shoulder", "right elbow", "left shoulder", "left elbow", "bottom shoulder", "bottom elbow")


def climbed(fault: Fault | None, seed: int = 1) -> ClimbRun:
    task, plan = two_rungs()
    return run_plan(task, plan, climbing_flaws(task, ()), noise=Noise.of("usual"), seed=seed, fault=fault)


def fault_of(kind: str, size: float, channel: int = 0, start: float = FIRST) -> Fault:
    return Fault(kind=kind, start=start, size=size, channel=channel, where=JOINTS[channel % 6], seed=5)


def test_a_climb_without_a_fault_notices_none() -> None:
    run = climbed(None)
    assert run.done, run.reason
    assert run.report.findings == []
    assert run.to_json()["findings"] == [] and run.to_json()["ending"] == ""


def test_a_link_that_is_caught_at_a_peg_is_no_fault() -> None:
    """For 0.2 s it bears 2 weights that the tips do not feel: once this ended the climb as a weak motor, as it did 7 of 300."""
    task, _ = two_rungs()
    plan = Plan.of_codes(task, CAUGHT)
    run = run_plan(task, plan, climbing_flaws(task, ()), noise=Noise.of("usual"), seed=1_000_000_154)
    assert run.done, run.reason
    assert run.report.findings == []


@pytest.mark.parametrize("seed", first_fast([1_000_004_003, 1_000_004_010]))
def test_a_joint_that_stood_still_as_the_load_passed_off_its_limb_is_no_fault_once_the_limb_leaves_its_hold(
    seed: int,
) -> None:
    """At step 20 of circle the bottom elbow's torque falls by 30 % of its limit within half a second: its hold bears that much less."""
    task = climbing_task(load_task("circle"))
    codes = load_plan(ROOT / "examples" / "circle" / "plan.json").codes(task)
    plan = Plan.of_codes(task, codes[:20])
    run = run_plan(task, plan, climbing_flaws(task, ()), noise=Noise.of("usual"), seed=seed)
    assert run.done, run.reason
    assert run.report.findings == []


@pytest.mark.parametrize("channel", first_fast([3, 6, 0]))
def test_no_number_for_a_tick_is_bridged_and_the_climb_goes_on(channel: int) -> None:
    """Once it was an input error, with no report and nothing held."""
    run = climbed(fault_of("nan", 0.004, channel))
    assert run.done, run.reason
    (told,) = run.report.findings
    assert told.kind == "no number"
    assert told.where == (JOINTS[channel] if channel < 6 else "body")
    assert told.time == pytest.approx(FIRST, abs=0.015)


def test_spikes_are_not_believed_and_the_climb_goes_on() -> None:
    """Of 20 deg in a reading of a hundred: once a fall after 1.5 s."""
    run = climbed(fault_of("spikes", math.radians(20.0), 2))
    assert run.done, run.reason
    assert {(told.kind, told.where) for told in run.report.findings} == {("jump", "left shoulder")}


@pytest.mark.parametrize(
    ("kind", "size", "within", "told"),
    [
        ("nan", 9.0, 0.1, {"no number"}),
        ("dead", 1.0, 6.0, {"unbalanced", "no answer", "overpowered"}),
        *(
            pytest.param(*case, marks=pytest.mark.slow)
            for case in [
                ("drift", 0.15, 4.0, {"drift"}),
                ("lost", 1.0, 0.1, {"no reading"}),
                ("late", 6.0, 0.2, {"late readings", "no reading"}),
            ]
        ),
    ],
)
def test_what_cannot_be_bridged_ends_in_a_held_posture_and_names_the_fault(
    kind: str, size: float, within: float, told: set[str]
) -> None:
    run = climbed(fault_of(kind, size, 0))
    assert not run.done
    assert run.reason.startswith("fault: ")
    assert run.report.ending in ("held", "stopped safely")
    found = run.report.findings[-1]
    assert FIRST < found.time < FIRST + within
    assert found.kind in told
    if FAULTS[kind].target != "link":
        assert found.where == "right shoulder"
    assert run.report.true_pose is not None and run.report.true_pose[1] > 0.0  # it has not dropped
    assert run.report.actions[-1].outcome == "fault"
    assert run.trace.time[-1] == pytest.approx(found.time + 3.0, abs=0.05)  # what came of it is in the log, too


@pytest.mark.slow
@pytest.mark.parametrize("channel", [0, 1, 2])
def test_a_stuck_sensor_is_noticed_before_its_joint_is_twenty_degrees_off(channel: int) -> None:
    """While the joint stands still nobody can tell. The shoulder goes 18.9 deg, the elbow and the other shoulder less than 14."""
    run = climbed(fault_of("stuck", 1.0, channel))
    assert run.report.ending == "held", run.reason
    found = run.report.findings[-1]
    assert (found.where, found.time > FIRST) == (JOINTS[channel], True)
    assert run.trace.true_angles is not None
    angle = run.trace.true_angles.reshape(len(run.trace.time), -1)[:, channel]
    off = np.abs(angle - angle[np.searchsorted(run.trace.time, FIRST)])[
        (run.trace.time >= FIRST) & (run.trace.time <= found.time)
    ]
    assert off.max() < math.radians(20.0)


@pytest.mark.parametrize("seed", first_fast([3, 2]))
def test_a_bodys_stuck_sensor_is_noticed_once_the_body_has_turned_by_some_degrees(seed: int) -> None:
    """Once a limb's joint was blamed, 1.5 s later."""
    run = climbed(fault_of("stuck", 1.0, 6), seed)
    assert run.report.ending == "held", run.reason
    (found,) = run.report.findings
    assert (found.kind, found.where) == ("no answer", "body")
    assert run.trace.true_pose is not None
    angle, began = run.trace.true_pose[:, 2], int(np.searchsorted(run.trace.time, FIRST))
    off = np.abs(angle - angle[began])[began : int(np.searchsorted(run.trace.time, found.time))]
    assert math.radians(0.8) < off.max() < math.radians(2.5)


@pytest.mark.parametrize(("kind", "size"), first_fast([("repeated", 0.1), ("jitter", 0.05), ("late", 1.0)]))
def test_a_rough_link_is_told_and_climbed_with(kind: str, size: float) -> None:
    run = climbed(fault_of(kind, size))
    assert run.report.ending != "fell", run.reason
    assert run.report.findings and run.report.findings[0].time == pytest.approx(FIRST, abs=1.0)
    assert run.report.findings[0].kind in ("no reading", "uneven ticks")


@pytest.mark.slow
def test_a_hold_that_breaks_is_the_told_cause() -> None:
    task, _ = two_rungs()
    number = next(iter(task.start.holds.values()))
    run = climbed(Fault(kind="hold", start=1.0, size=5.0, channel=number, where=f"hold {number}"))
    assert [one.hold for one in run.report.broken] == [number]
    assert run.done or f"hold {number} broke" in run.reason


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**31 - 1), st.floats(0.01, 12.0))
def test_any_fault_at_any_tick_ends_in_a_report(seed: int, start: float) -> None:
    task, plan = two_rungs()
    fault = draw_fault([ANY], seed, failing_of(task, plan), (start, start))
    run = climbed(fault, seed % 100)
    assert run.done != bool(run.reason)
    assert ending_of_run(run.done, run.report) in ENDINGS
    assert run.to_json() is not None


class FaultyHardware(PlantLayer[Hardware, Floats]):
    """A robot's wires with a fault; `Hardware`. A counter that is to say no number says that it has lost its count.

    Args:
        hardware: What is wired.
        fault: Channels are its encoders; motors are its amplifiers.
        resolution: Counts of each encoder per radian, shape (n_encoders,).
        guard: What holds the posture when no commands come; None: the last ones stay.
    """

    def __init__(self, hardware: Hardware, fault: Fault, resolution: Floats, guard: PostureGuard | None = None) -> None:
        super().__init__(hardware)
        self._resolution, self._injector, self._guard = resolution, Injector(fault, hardware.period), guard
        self._commands: Floats | None = None
        self._reading: Reading | None = None
        self._guards = False

    def reset(self, start: Floats) -> None:
        """See `Hardware`."""
        self.plant.reset(start)
        self._injector.reset()
        self._commands, self._reading, self._guards = None, None, False

    def sense(self) -> Reading:
        """See `Hardware`."""
        reading, n = self.plant.sense(), len(self._resolution)
        self._reading = reading
        values = reading.counts.astype(np.float64)
        values[:n] /= self._resolution
        values, number = self._injector.read(values, reading.tick)
        values[:n] *= self._resolution
        counts = np.where(np.isfinite(values), np.rint(np.nan_to_num(values)), LOST_COUNT).astype(np.int32)
        return Reading(counts, number)

    def actuate(self, commands: Floats) -> None:
        """See `Hardware`."""
        arrived = self._injector.command(commands)
        if arrived is not None:
            self._commands = arrived

    def step(self) -> None:
        """See `Hardware`."""
        commands = self._commands
        if commands is not None and self._injector.silent and self._guard is not None and self._reading is not None:
            if not self._guards:
                self._guard.hold(self._reading, commands)
            self._guards, commands = True, self._guard.commands(self._reading)
        if commands is not None:
            self.plant.actuate(self._injector.weaken(commands.copy(), np.zeros(len(commands))))
        step_on(self.plant, self._injector.passed())


@pytest.mark.parametrize(
    ("kind", "size", "told"),
    first_fast([("nan", 9.0, "no number"), ("stuck", 1.0, ""), ("dead", 1.0, ""), ("lost", 1.0, "no reading")]),
)
def test_faults_on_the_wires_are_noticed_as_those_of_a_plant(kind: str, size: float, told: str) -> None:
    task, plan = two_rungs()
    flaws = climbing_flaws(task, ()).with_changes(encoder_counts=400)
    simulated, wiring = ClimberPlant(task.robot, task.world, flaws), wiring_of(task.robot, 400)
    guard = guard_of(task.robot, wiring, simulated.period)
    wires = FaultyHardware(ClimberWires(simulated, wiring), fault_of(kind, size, 2, 3.0), wiring.resolution, guard)
    plant = WiredClimber(wires, wiring)
    climber = TracedClimber(task.robot, task.world, plant, truth=truth_of(plant), watched=True)
    report = Sequencer(Climbing(climber, lay_course(task, plan))).run()
    assert report.reason.startswith("fault: "), report.reason
    assert report.findings[-1].time > 3.0
    assert told in {finding.kind for finding in report.findings} or not told
    assert np.isfinite(simulated.truth().pose).all() and simulated.truth().pose[1] > -0.3  # it holds


def test_faults_are_drawn_by_their_seed_and_say_which() -> None:
    task, plan = two_rungs()
    failing = failing_of(task, plan)
    assert set(failing.kinds) == set(FAULTS)
    drawn = [draw_fault([ANY], seed, failing, (1.0, 20.0)) for seed in range(300)]
    assert drawn == [draw_fault([ANY], seed, failing, (1.0, 20.0)) for seed in range(300)]
    assert {fault.kind for fault in drawn} == set(FAULTS)
    assert all(1.0 <= fault.start <= 20.0 and np.isfinite(fault.size) and fault.size > 0.0 for fault in drawn)
    assert {fault.where for fault in drawn if fault.target == "sensor"} == {*JOINTS, "body"}
    with pytest.raises(FaultChoiceError, match="stuck"):
        draw_fault(["stuk"], 1, failing, (1.0, 20.0))
