"""How well laws held a force on a wall: measured on the true force, as values and JSON."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import numpy as np

from ..execution.log import Log
from ..files import write_atomically
from ..sim.flaw_texts import plant_words
from ..sim.limb_flaws import LimbFlaws
from ..types import Floats, Json
from .bench_limb import BenchLimb
from .contest import Entry, Run, run_contest, with_sensors
from .force_scenario import ForceTask, direction, force_scenario
from .run_logs import run_logs
from .scenario import Scenario

SCHEMA: Final = "clamber-limb-force-1"


@dataclass(frozen=True, slots=True, kw_only=True)
class ForceMeasures:
    """What one law did to the wall, by the true force, after it had time to settle. Errors are actual less wanted force."""

    mean_error: float
    """[N]."""
    worst_standing: float
    """Largest size of the error before and after the slide [N]."""
    worst_sliding: float
    """Largest size of the error during the slide; 0 without one [N]."""
    worst: float
    """Largest size of all, where the slide starts and ends too [N]."""
    contact: float
    """Share of ticks with the tip on the wall [-]."""
    held: bool
    """Whether the tip never left the wall and no error was beyond the tolerance."""
    bounces: int
    """How often the tip left the wall before that."""
    peak: float
    """Largest force of the whole run, with the impact at the start [N]."""
    off_line: float
    """Largest error of the place along the wall, in truth [m]."""
    work: float
    """Sum of what each motor gives or brakes, |torque x turn| [J]."""

    def to_json(self) -> Json:
        """All measures, in SI; a law that left the finite numbers has None."""
        return {key: value if math.isfinite(value) else None for key, value in asdict(self).items()}


@dataclass(frozen=True, slots=True, eq=False)
class ForceRow:
    """One law."""

    entry: Entry
    run: Run
    measures: ForceMeasures


@dataclass(frozen=True, slots=True, eq=False)
class ForceResult:
    """Laws on the same wall, the same limb, the same command."""

    limb: BenchLimb
    task: ForceTask
    flaws: LimbFlaws
    scenario: Scenario
    rows: tuple[ForceRow, ...]

    @property
    def held(self) -> bool:
        """Whether any law held the force."""
        return any(row.measures.held for row in self.rows)

    def title(self) -> str:
        """What was asked for, in a few words."""
        task = self.task
        slide = f", {1e2 * abs(task.slide):g} cm along it" if task.slide else ""
        return f"{task.force:g} N on a wall at {math.degrees(task.angle):g} deg of {task.stiffness / 1e3:g} N/mm{slide}"

    def plant_words(self) -> str:
        """The plant and what is not ideal about it, in one line."""
        wall = [f"wall friction {self.task.friction:g}"] if self.task.friction else []
        return ", ".join((plant_words(self.flaws), *wall))

    def belief_words(self) -> str:
        """What the laws are wrong about, in one line; empty if nothing."""
        task = self.task
        told = []
        if task.task_angle != task.angle:
            told.append(f"the angle is {math.degrees(task.task_angle):g} deg")
        if task.task_stiffness != task.stiffness:
            told.append(f"the stiffness is {task.task_stiffness / 1e3:g} N/mm")
        return f"the laws believe that {' and '.join(told)}" if told else ""

    def to_json(self) -> Json:
        """Everything but the traces, in SI units and radians."""
        return {
            "schema": SCHEMA,
            "task": asdict(self.task),
            "limb": {"robot": self.limb.robot.name, "name": self.limb.name, "start": list(self.limb.start)},
            "plant": asdict(self.scenario.on(self.flaws)),
            "held": self.held,
            "laws": [
                {"label": row.entry.label, "settings": asdict(row.entry.settings), **row.measures.to_json()}
                for row in self.rows
            ],
        }

    def logs(self) -> dict[str, Log]:
        """Label -> every tick of each law."""
        return run_logs(self.limb, self.flaws, ((row.entry.label, row.run.trace) for row in self.rows))

    def save(self, path: Path) -> None:
        """Write `to_json` to a file, whole or not at all."""
        write_atomically(path, json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n")


def run_force(limb: BenchLimb, task: ForceTask, entries: Sequence[Entry], flaws: LimbFlaws) -> ForceResult:
    """Run every entry alone on the wall.

    Raises:
        LawError: If settings do not fit the limb.
        ScenarioError: If the wall is out of reach.
    """
    sensing = with_sensors(flaws, entries)
    scenario = force_scenario(limb, flaws.control_rate, task)
    runs = run_contest(limb, scenario, entries, sensing)
    rows = tuple(ForceRow(run.entry, run, measure_force(run, task)) for run in runs)
    return ForceResult(limb, task, sensing, scenario, rows)


def pressing(run: Run, task: ForceTask) -> Floats:
    """True force into the wall, tick by tick, shape (ticks,) [N]."""
    force: Floats = run.trace.wrenches[:, 0, :2] @ direction(task.angle)
    return force


def measure_force(run: Run, task: ForceTask) -> ForceMeasures:
    """Measures of a run of `force_scenario`."""
    trace = run.trace
    force = pressing(run, task)
    still, sliding = task.judged(trace.time)
    judged = trace.time >= trace.time[np.argmax(still)]
    error = force - task.force
    touching = force > 0.0
    into = direction(task.angle)
    off = (trace.true_places() - trace.wanted_places())[:, 0, :2] @ np.array((-into[1], into[0]))
    turned = np.diff(trace.true[:, 0, 0], axis=0)
    worst = float(np.abs(error[judged]).max())
    contact = float(touching[judged].mean())
    return ForceMeasures(
        mean_error=float(error[judged].mean()),
        worst_standing=float(np.abs(error[still]).max()),
        worst_sliding=float(np.abs(error[sliding]).max()) if sliding.any() else 0.0,
        worst=worst,
        contact=contact,
        held=bool(contact == 1.0 and worst <= task.tolerance),
        bounces=int((np.diff(touching[~judged].astype(int)) < 0).sum()),
        peak=float(force.max()),
        off_line=float(np.abs(off[judged]).max()),
        work=float(np.abs(trace.applied[:-1, 0] * turned).sum()),
    )
