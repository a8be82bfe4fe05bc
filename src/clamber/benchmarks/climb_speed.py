"""How fast a climb is simulated: closed loop over real time, over raw `mj_step`, where the time goes, and what more workers bring."""

import os
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import cache, partial
from pathlib import Path
from statistics import median
from typing import Any, Final

import numpy as np

from ..execution.sequencer import Sequencer
from ..families.climber.execution.climb_trace import TracedClimber
from ..families.climber.execution.climbing import Climbing
from ..families.climber.execution.executable_plan import lay_course
from ..families.climber.planning.plans import thesis_code
from ..families.climber.planning.task import LimbedTask
from ..families.climber.sim.climber_plant import ClimberPlant
from ..families.climber.trials.noise import Noise
from ..families.climber.trials.run_plan import climbing_flaws, climbing_task, run_plan
from ..families.climber.trials.warm_up import warm_up
from ..jobs import LocalProcesses
from ..planning.problem.plan import Plan
from ..sim.limb_flaws import LimbFlaws
from ..tasks import load_task
from ..trials.measured import Row, Say, keep_quiet, round_times
from ..types import Floats, Json
from .batches import WORKERS, run_batch, timed


class TapedClimberPlant(ClimberPlant):
    """A climber's plant that writes down what goes into its physics since its reset, and can do it again without anybody else."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._tape: list[tuple[Floats, Floats, int]] = []
        self._start: tuple[Floats, Floats] | None = None
        self._raw_step, self._step = self._step, self._taped

    @property
    def steps(self) -> int:
        """Steps written down."""
        return sum(n for _, _, n in self._tape)

    @property
    def coordinates(self) -> Floats:
        """Of the model now, shape (nq,)."""
        out: Floats = self._qpos.copy()
        return out

    def reset(self, pose: Floats, q: Floats) -> None:
        """As a plant's, with nothing written down."""
        super().reset(pose, q)
        self._tape.clear()
        self._start = np.array(pose, float), np.array(q, float)

    def replay(self) -> None:
        """Start again and step through all that is written down, as fast as MuJoCo goes from Python."""
        assert self._start is not None
        super().reset(*self._start)
        step, model, data, ctrl, pushed = self._raw_step, self.model, self._data, self._data.ctrl, self._pushed
        for torques, push, n in self._tape:
            ctrl[:] = torques
            pushed[:] = push
            step(model, data, n)

    def _taped(self, model: Any, data: Any, n: int) -> None:
        self._tape.append((self._data.ctrl.copy(), self._pushed.copy(), n))
        self._raw_step(model, data, n)


RUNGS = (106, 301, 205, 300, 3, 3, 304, 108, 303, 207, 300, 3, 3)
"""Two rungs of the ladder by the gait of the thesis, its numbers of actions."""
NOISE = "peg_error=3mm"
"""Of the trials."""


@cache
def two_rungs() -> tuple[LimbedTask, Plan]:
    """The climb that is timed."""
    task = climbing_task(load_task("ladder"))
    return task, Plan.of_codes(task, [thesis_code(task, number) for number in RUNGS])


@cache
def _ready() -> float:
    """The moment at which this process has its kernels loaded."""
    warm_up()
    return time.monotonic()


def timed_trial(item: Json) -> Json:
    """Two rungs with pegs off the map by a seed, in a process that has climbed before.

    Args:
        item: `seed`.
    """
    ready, (task, plan) = _ready(), two_rungs()
    flaws, noise = climbing_flaws(task, ()), Noise.of("none", [NOISE])
    return timed(ready, partial(run_plan, task, plan, flaws, noise=noise, seed=item["seed"]))


ROUNDS: Final = 5
"""How often each piece of work is timed; the median counts."""
TRIALS: Final = 24
"""Of a batch, at least."""
PARTS: Final = {
    "physics": (("plant", "step"),),
    "sensors and motors": (("plant", "sense"), ("plant", "actuate")),
    "control": (("body", "see"), ("body", "command"), ("fall", "see")),
    "sampling": (("samples", "keep"),),
}
"""Part of the work -> what does it: owner and method."""
REST: Final = "motions and sequencer"


def climber_on(task: LimbedTask, plant: ClimberPlant) -> TracedClimber:
    """The climber as `run_plan` has it, pegs where the map says."""
    return TracedClimber(task.robot, task.world, plant, truth=plant.truth)


def shares_of(task: LimbedTask, plan: Plan, flaws: LimbFlaws) -> dict[str, float]:
    """Part of the work -> its share of the time of a climb; the clock's own calls go to the rest."""
    plant = ClimberPlant(task.robot, task.world, flaws)
    climber = climber_on(task, plant)
    owners = {"plant": plant, "samples": climber.samples, "body": climber.body, "fall": climber.fall}
    times = dict.fromkeys(PARTS, 0.0)
    for part, places in PARTS.items():
        for owner, method in places:
            setattr(owners[owner], method, _clocked(getattr(owners[owner], method), part, times))
    sequencer = Sequencer(Climbing(climber, lay_course(task, plan)))
    start = time.perf_counter()
    sequencer.run()
    whole = time.perf_counter() - start
    shares = {part: spent / whole for part, spent in times.items()}
    return shares | {REST: 1.0 - sum(shares.values())}


def _clocked(call: Callable[..., Any], part: str, times: dict[str, float]) -> Callable[..., Any]:
    def clocked(*args: Any, **options: Any) -> Any:
        start = time.perf_counter()
        out = call(*args, **options)
        times[part] += time.perf_counter() - start
        return out

    return clocked


def loop_rows(*, rounds: int = ROUNDS, say: Say = keep_quiet) -> list[Row]:
    """Two rungs of the ladder as `clamber run` climbs them, samples and all, over real time and over `mj_step` of the same states."""
    task, plan = two_rungs()
    flaws = climbing_flaws(task, ())
    say("two rungs of the ladder, and their physics alone")
    plant = TapedClimberPlant(task.robot, task.world, flaws)
    report = Sequencer(Climbing(climber_on(task, plant), lay_course(task, plan))).run()
    whole, bare = round_times((lambda: run_plan(task, plan, flaws), plant.replay), rounds).T
    rows = [
        Row("closed loop, one core", report.seconds / median(whole), "x real time", ">= 20"),
        Row("raw mj_step of the same states", report.seconds / median(bare), "x real time"),
        Row("closed loop over raw mj_step", median(whole / bare), "ratio", "<= 1.6"),
        Row("raw mj_step, a step", 1e6 * median(bare) / plant.steps, "us"),
    ]
    say("where the time goes")
    shares = shares_of(task, plan, flaws)
    return [*rows, *(Row(f"share of {part}", share, "share") for part, share in shares.items())]


def trial_rows(*, trials: int = TRIALS, workers: Sequence[int] = WORKERS, say: Say = keep_quiet) -> list[Row]:
    """Efficiency of the same trials on more and more local workers, against linear; the start of the workers is apart."""
    items = [{"seed": seed} for seed in range(trials)]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        one = None
        for n in workers:
            say(f"{trials} trials on {n} workers")
            batch = run_batch(items, LocalProcesses(n), Path(folder) / f"{n}.db", timed_trial)
            one = one or batch
            aim = ">= 0.85" if n <= (os.cpu_count() or 1) else None
            rows.append(Row(f"efficiency, {trials} trials on {n} workers", one.work / batch.held, "share", aim))
            rows.append(Row(f"processor time of the trials, one worker to {n}", one.cpu / batch.cpu, "ratio"))
            rows.append(Row(f"time of {n} ready workers that the trials took", batch.work / batch.held, "share"))
            rows.append(Row(f"trials a minute on {n} workers", 60.0 * trials * n / batch.held, "1/min"))
    return [*rows, Row("load of the machine at that time, this work included", os.getloadavg()[0], "processes")]


def climb_rows(*, say: Say = keep_quiet) -> list[Row]:
    """All of it."""
    return [*loop_rows(say=say), *trial_rows(say=say)]
