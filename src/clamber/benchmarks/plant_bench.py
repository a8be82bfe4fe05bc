"""What a plant in another process costs and keeps: round trips, jitter of a real-time plant, and robots that stay up after a safe stop."""

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

import numpy as np

from ..execution.hardware import Hardware, Reading, WiredClimber
from ..execution.link.channel import read_address
from ..execution.link.client import RemoteHardware
from ..execution.plant import PlantLayer, PlantStoppedError
from ..execution.posture_guard import PostureGuard
from ..execution.sequencer import Sequencer
from ..families.climber.execution.climb_trace import TracedClimber
from ..families.climber.execution.climbing import Climbing
from ..families.climber.execution.executable_plan import lay_course
from ..families.climber.execution.wiring import guard_of, wiring_of
from ..families.climber.planning.plans import thesis_code
from ..families.climber.planning.task import LimbedTask
from ..families.climber.sim.climber_plant import ClimberPlant
from ..families.climber.trials.noise import Noise, draw_for
from ..families.climber.trials.plants import drawn_plant
from ..families.climber.trials.run_plan import believing_climber, climbing_flaws, climbing_task, run_plan
from ..planning.problem.plan import Plan
from ..sim.limb_flaws import LimbFlaws
from ..sim.wires import ClimberWires
from ..tasks import load_task
from ..trials.measured import Row, Say, keep_quiet
from ..types import Floats

TASK: Final = "ladder"
GAIT: Final = (191, 392, 291, 300, 3, 3)
"""A rung by the thesis's gait, in its own numbers."""
SECONDS: Final = 10.0
"""Of each run over a link."""
STOPS: Final = 40
"""Safe stops at random moments of a rung."""
RUNG_TICKS: Final = 4400
"""About those of a rung."""
NOISE: Final = "peg_error=3mm"
"""Of the pegs' places."""
HOLD: Final = 3.0
"""After each stop [s]."""
FELL: Final = 0.05
"""A body that has moved farther since the stop has fallen [m]."""
RUNGS: Final = 3
"""Climbed in real time."""
REAL_TIME: Final = ("--real-time", "-q", "--set", "plant.delay=0")
"""How they are served: the link brings the tick of delay that the nominal plant simulates."""
SERVE: Final = "from clamber.cli import main; main()"


@contextmanager
def served(*words: str) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """A process of `clamber plant serve` with these words, and its address; ended when the block ends."""
    command = [sys.executable, "-c", SERVE, "plant", "serve", *words]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        yield process, process.stdout.readline().strip()
    finally:
        process.terminate()
        process.communicate()


def gait_of(task: LimbedTask) -> Plan:
    """One rung."""
    return Plan.of_codes(task, [thesis_code(task, number) for number in GAIT])


class TimedHardware(PlantLayer[Hardware, Floats]):
    """Hardware whose steps are timed.

    Args:
        hardware: What is timed.
    """

    def __init__(self, hardware: Hardware) -> None:
        super().__init__(hardware)
        self.ends: list[float] = []
        """When each step ended [s]."""
        self.took: list[float] = []
        """How long each step took [s]."""

    def reset(self, start: Floats) -> None:
        """See `Hardware`."""
        self.plant.reset(start)

    def sense(self) -> Reading:
        """See `Hardware`."""
        return self.plant.sense()

    def actuate(self, commands: Floats) -> None:
        """See `Hardware`."""
        self.plant.actuate(commands)

    def step(self) -> None:
        """See `Hardware`."""
        began = time.perf_counter()
        self.plant.step()
        self.ends.append(time.perf_counter())
        self.took.append(self.ends[-1] - began)


class StoppingHardware(PlantLayer[Hardware, Floats]):
    """Hardware that is taken over by its guard at some tick, as a server does.

    Args:
        hardware: What stops.
        guard: Of the same robot.
        at: Tick of the stop.
    """

    def __init__(self, hardware: Hardware, guard: PostureGuard, at: int) -> None:
        super().__init__(hardware)
        self.guard, self.at = guard, at
        self._reading, self._commands = Reading(np.zeros(0, np.int32), 0), np.zeros(0)

    def reset(self, start: Floats) -> None:
        """See `Hardware`."""
        self.plant.reset(start)
        self._reading = self.plant.sense()

    def sense(self) -> Reading:
        """See `Hardware`."""
        return self._reading

    def actuate(self, commands: Floats) -> None:
        """See `Hardware`."""
        self._commands = commands

    def step(self) -> None:
        """See `Hardware`.

        Raises:
            PlantStoppedError: At its tick.
        """
        if self._reading.tick >= self.at:
            raise PlantStoppedError("its time has come")
        self.plant.actuate(self._commands)
        self.plant.step()
        self._reading = self.plant.sense()

    def hold(self, seconds: float, *, power: bool = True) -> float:
        """Let the guard hold, or nobody, and tell how far the body has truly moved [m]."""
        before = self.truth()[:2].copy()
        self.guard.hold(self._reading, self._commands)
        for _ in range(round(seconds / self.period)):
            commands = self.guard.commands(self._reading)
            self.plant.actuate(commands if power else np.zeros_like(commands))
            self.plant.step()
            self._reading = self.plant.sense()
        return float(np.hypot(*(self.truth()[:2] - before)))


def stopped_at(task: LimbedTask, flaws: LimbFlaws, tick: int, seed: int) -> StoppingHardware:
    """A robot that has climbed by the gait until a tick, where it was stopped, on pegs that a seed puts beside the map."""
    wiring = wiring_of(task.robot, flaws.encoder_counts)
    noise = Noise.of("none", [NOISE])
    drawn = draw_for(task, noise, seed)
    plant = drawn_plant(task, flaws, drawn)
    hardware = ClimberWires(plant, wiring)
    stopping = StoppingHardware(hardware, guard_of(task.robot, wiring, hardware.period), tick)
    climber = believing_climber(task, WiredClimber(stopping, wiring), noise, drawn)
    Sequencer(Climbing(climber, lay_course(task, gait_of(task), "gait"))).run()
    return stopping


def _wait_through(task: LimbedTask, timed: TimedHardware, seconds: float) -> None:
    climber = TracedClimber(task.robot, task.world, WiredClimber(timed, wiring_of(task.robot)))
    Climbing(climber, lay_course(task, gait_of(task), "gait")).start()
    climber.wait(seconds)


def _climb_in_real_time(task: LimbedTask, flaws: LimbFlaws, seed: int) -> bool:
    with served(TASK, *REAL_TIME, "--noise", NOISE, "--seed", str(seed)) as (_, address):
        noise = Noise.of("none", [NOISE])
        return run_plan(task, gait_of(task), flaws, plant=address, noise=noise, seed=seed).report.done


def plant_rows(*, say: Say = keep_quiet) -> list[Row]:
    """Round trips and jitter at 200 Hz on this machine, and safe stops of a climbing robot."""
    task = climbing_task(load_task(TASK))
    flaws = climbing_flaws(task, ())
    rows = []
    say("plant here")
    wiring = wiring_of(task.robot)
    timed = TimedHardware(ClimberWires(ClimberPlant(task.robot, task.world, flaws), wiring))
    _wait_through(task, timed, SECONDS)
    rows.append(Row("a period of the plant, here", 1e6 * float(np.median(timed.took)), "us"))
    say("plant in lock-step")
    with served(TASK, "-q") as (_, address), RemoteHardware(read_address(address)) as remote:
        timed = TimedHardware(remote)
        _wait_through(task, timed, SECONDS)
    took = 1e6 * np.array(timed.took)
    rows.append(Row("over TCP in lock-step, median", float(np.median(took)), "us"))
    rows.append(Row("over TCP in lock-step, 99 %", float(np.quantile(took, 0.99)), "us", "< 5000"))
    say("plant in real time")
    with (
        served(TASK, *REAL_TIME) as (_, address),
        RemoteHardware(read_address(address)) as remote,
    ):
        timed = TimedHardware(remote)
        _wait_through(task, timed, SECONDS)
    between = 1e6 * np.diff(timed.ends)
    missed = np.maximum(np.rint(between / (1e6 * remote.period)) - 1, 0).sum()
    off = np.abs(between - 1e6 * remote.period)
    rows.append(Row("in real time, between samples, mean", float(between.mean()), "us", "5000"))
    rows.append(Row("in real time, jitter, median", float(np.median(off)), "us"))
    rows.append(Row("in real time, jitter, 99 %", float(np.quantile(off, 0.99)), "us"))
    rows.append(Row("in real time, jitter, largest", float(off.max()), "us", "< 5000"))
    rows.append(Row("in real time, samples that came too late", float(missed), "", "0"))
    say("rungs in real time")
    climbed = [_climb_in_real_time(task, flaws, seed) for seed in range(RUNGS)]
    rows.append(Row("in real time, rungs climbed without a stop", sum(climbed), f"of {RUNGS}", f"{RUNGS}"))
    say("safe stops")
    moments = np.random.default_rng(0).integers(100, RUNG_TICKS, STOPS)
    moved = [stopped_at(task, flaws, int(tick), seed).hold(HOLD) for seed, tick in enumerate(moments)]
    rows.append(
        Row("safe stops that the robot stays up after", sum(m < FELL for m in moved), f"of {STOPS}", f"{STOPS}")
    )
    rows.append(Row(f"body, farthest in {HOLD:g} s after one", 1e3 * max(moved), "mm"))
    return rows
