"""Results of the limb bench as values, JSON, CSV and logs; laws compared by one motion, each with its measures over its trials."""

import csv
import io
import json
import math
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, replace
from operator import attrgetter
from pathlib import Path
from typing import Any, Final

import numpy as np

from ..control.law_settings import LawSettings
from ..execution.log import Log
from ..execution.log_trace import trace_log
from ..execution.trace import LimbTrace
from ..files import write_atomically
from ..sim.bench_limb import BenchLimb
from ..sim.flaw_texts import plant_words
from ..sim.limb_flaws import LimbFlaws
from ..types import Floats, Json
from .entries import Match, tip_stiffness
from .measures import Measured, Measures, Run, components, measure, radial_error, scenario_size
from .runner import Contest, run_contest, with_sensors
from .scenario import Scenario

SCHEMA: Final = "clamber-limb-1"
LEAST_BEYOND: Final = 1e-3
"""Less is the give of a stop [rad]."""
MISMATCH: Final = 0.01
"""A matched stiffness that is off by more than this part is told."""


class BenchResult:
    """A result that can be kept in files."""

    __slots__ = ()

    def to_json(self) -> Json:
        """Plain data, in SI units and radians; `null` is what never came."""
        raise NotImplementedError

    def table(self) -> tuple[list[str], list[list[Any]]]:
        """Columns and lines of its CSV; an empty field is what never came."""
        raise NotImplementedError

    def draw(self, path: str | Path) -> None:
        """Draw it into a file (.png, .svg, .pdf).

        Raises:
            SuffixError: If the file's suffix names no format for still pictures.
            FileError: If the file cannot be written.
        """
        raise NotImplementedError

    def save(self, path: str | Path) -> None:
        """Write `to_json` to a file, whole or not at all."""
        write_atomically(Path(path), json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n")

    def save_table(self, path: str | Path) -> None:
        """Write `table` to a file as CSV, whole or not at all."""
        text = io.StringIO()
        columns, lines = self.table()
        csv.writer(text, lineterminator="\n").writerows((columns, *lines))
        write_atomically(Path(path), text.getvalue())

    def write(self, path: Path) -> None:
        """Write a file as its suffix says: .json, .csv or a picture.

        Raises:
            SuffixError: If it says none of them.
            FileError: If the file cannot be written.
        """
        if path.suffix.lower() == ".json":
            self.save(path)
        elif path.suffix.lower() == ".csv":
            self.save_table(path)
        else:
            self.draw(path)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Comparison(BenchResult):
    """Runs of one limb on one plant."""

    limb: BenchLimb
    flaws: LimbFlaws
    plant: str = "mujoco"

    def traces(self) -> Iterable[tuple[str, LimbTrace]]:
        """Label and trace of each run that is logged."""
        raise NotImplementedError

    def logs(self) -> dict[str, Log]:
        """Label -> every tick of a run; notes name robot, limb, law and whether weight acted, which identification needs.

        Raises:
            LogError: If not even the first tick of a run is finite.
        """
        upright = {"upright": "yes"} if self.flaws.upright else {}
        notes = {"robot": self.limb.robot.name, "limb": self.limb.name} | upright
        return {label: trace_log(trace, notes=notes | {"law": label}) for label, trace in self.traces()}

    def limb_json(self) -> Json:
        """The limb, where it starts and its joint angles there."""
        return {
            "robot": self.limb.robot.name,
            "name": self.limb.name,
            "start": list(self.limb.start),
            "angles": [float(q) for q in self.limb.q0],
        }


@dataclass(frozen=True, slots=True, eq=False)
class Matching:
    """Which stiffness of which law the gains of others were matched to, and where."""

    reference: LawSettings
    how: Match = "none"
    at: Floats | None = None
    """Joint angles [rad]; None: those at the limb's start."""


@dataclass(frozen=True, slots=True, eq=False)
class Row(Measured[tuple[Measures, ...]]):
    """One law and all its trials: the first one's run, and the measures of each."""

    stiffness: Floats
    """At the tip, at `LimbResult.match_at`, shape (2, 2) [N/m]."""

    @property
    def unstable(self) -> int:
        """Number of trials that went unstable."""
        return sum(each.unstable_at is not None for each in self.measures)

    def values(self, pick: Callable[[Measures], float | None]) -> list[float]:
        """One measure of every stable trial; a trial without it is left out."""
        told = (pick(each) for each in self.measures if each.unstable_at is None)
        return [value for value in told if value is not None]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LimbResult(Comparison):
    """What came out of one scenario with several laws on one plant."""

    scenario: Scenario
    match: Match
    reference: LawSettings
    """The law that gains were matched to."""
    match_at: Floats
    """Joint angles at which they were [rad]."""
    rows: tuple[Row, ...]

    @property
    def trials(self) -> int:
        """Trials of each law."""
        return len(self.rows[0].measures)

    @property
    def stable(self) -> bool:
        """Whether any law was stable in all its trials."""
        return any(row.unstable == 0 for row in self.rows)

    @property
    def imperfect(self) -> bool:
        """Whether the encoders tell something else than the truth."""
        flaws = self.flaws
        return bool(flaws.backlash or flaws.encoder_counts or flaws.delay)

    def shown_until(self) -> float:
        """Up to when a plot over time tells most [s]: of a step a while after the last law settled, else the whole run."""
        end = len(self.scenario.aims) * self.flaws.period
        settled = [row.measures[0].encoder.settling for row in self.rows if row.measures[0].unstable_at is None]
        if self.scenario.kind != "step" or any(value is None or not math.isfinite(value) for value in settled):
            return end
        return min(end, max(1.0, 2.0 * max((value for value in settled if value is not None), default=end)))

    def title(self) -> str:
        """What was asked for, in a few words."""
        scenario = self.scenario
        if scenario.kind == "step":
            return f"step of {1e3 * scenario_size(self.rows[0].run.trace, scenario):.4g} mm"
        if scenario.kind == "circle":
            assert scenario.radius is not None and scenario.lap is not None
            return f"circle of radius {1e3 * scenario.radius:g} mm in {scenario.lap:g} s"
        if scenario.push is not None:
            push = scenario.push
            return f"push of {math.hypot(push.x, push.y):g} N from {push.start:g} to {push.end:g} s"
        return scenario.kind

    def plant_words(self) -> str:
        """The plant and what is not ideal about it, in one line."""
        return f"{self.plant}, {plant_words(self.flaws)}"

    def match_words(self) -> str:
        """What the laws' gains have in common, in one line."""
        kp, kd = (
            "/".join(f"{one:g}" for one in np.atleast_1d(gain)) for gain in (self.reference.kp, self.reference.kd)
        )
        law = f"{self.reference.law} (kp {kp}, kd {kd})"
        if self.match == "none":
            return f"not matched; the numbers of {law}, whatever their unit"
        what = {"yy": "Kyy", "mean": "mean of Kxx and Kyy", "diagonal": "Kxx and Kyy"}[self.match]
        own = sum(row.entry.own_gains for row in self.rows)
        where = "the start" if self.match_at is self.limb.q0 else "the centre"
        return f"matched by '{self.match}': {what} at {where} as {law}" + (f"; {own} of their own" if own else "")

    def mismatches(self) -> list[str]:
        """Labels of laws that were to be matched and cannot be: those with one gain for all directions."""
        if self.match == "none":
            return []
        theirs = tip_stiffness(self.limb.chain, self.reference, self.match_at)
        pick: dict[str, Callable[[Floats], Any]] = {
            "yy": lambda s: s[1, 1],
            "mean": np.trace,
            "diagonal": np.diag,
        }
        wanted = np.atleast_1d(pick[self.match](theirs))
        return [
            row.entry.label
            for row in self.rows
            if not row.entry.own_gains
            and np.abs(np.atleast_1d(pick[self.match](row.stiffness)) / wanted - 1.0).max() > MISMATCH
        ]

    def beyond_limits(self) -> dict[str, float]:
        """Joints that any stable law turned beyond the limits of the robot's file, and how far [rad]: the plant has no stops."""
        joints = self.limb.chain.joints
        out: dict[str, float] = {}
        for row in self.rows:
            if row.measures[0].unstable_at is not None:
                continue
            angles = row.run.trace.true[:, 0, 0]
            over = np.maximum(angles - joints["upper"], joints["lower"] - angles).max(axis=0)
            for name, most in zip(self.limb.chain.joint_names, over, strict=True):
                if most > LEAST_BEYOND:
                    out[name] = max(out.get(name, 0.0), float(most))
        return out

    def to_json(self) -> Json:
        """Everything but the traces, in SI units and radians; `null` is a time that never came.

        Keys are stable: schema, scenario, limb, plant, match, beyond_limits, seed, trials, laws. Of `laws`, `tick` alone depends on the
        machine.
        """
        scenario = self.scenario
        return {
            "schema": SCHEMA,
            "scenario": {
                "kind": scenario.kind,
                "seconds": len(scenario.aims) * self.flaws.period,
                "direction": list(scenario.direction),
                "lap": scenario.lap,
                "centre": None if scenario.centre is None else list(scenario.centre),
                "radius": scenario.radius,
                "aim": [float(value) for value in scenario.aims["place"][-1, 0, :2]],
            },
            "limb": self.limb_json(),
            "plant": {"name": self.plant} | asdict(scenario.on(self.flaws)),
            "match": {
                "how": self.match,
                "reference": settings_json(self.reference),
                "at": self.match_at.tolist(),
                "not_matched": self.mismatches(),
            },
            "beyond_limits": self.beyond_limits(),
            "seed": self.flaws.seed,
            "trials": self.trials,
            "laws": [_law(row) for row in self.rows],
        }

    def draw(self, path: str | Path) -> None:
        """Draw paths, errors over time and torques of the first trial."""
        from .pictures.comparison import draw_comparison

        draw_comparison(self, path)

    def traces(self) -> Iterable[tuple[str, LimbTrace]]:
        """Of the first trial of each law."""
        return ((row.entry.label, row.run.trace) for row in self.rows)

    def table(self) -> tuple[list[str], list[list[Any]]]:
        """One line for each trial of each law."""
        lines = []
        for row in self.rows:
            for trial, measures in enumerate(row.measures):
                flat = {"law": row.entry.label, "trial": trial}
                for key, value in measures.to_json().items():
                    flat |= (
                        {f"{key}.{name}": inner for name, inner in value.items()}
                        if isinstance(value, dict)
                        else {key: value}
                    )
                lines.append(flat)
        columns = list(dict.fromkeys(key for line in lines for key in line))
        return columns, [[line.get(column) for column in columns] for line in lines]


def settings_json(settings: LawSettings) -> Json:
    """All settings of a law."""
    return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(settings).items()}


def _law(row: Row) -> Json:
    return {
        "label": row.entry.label,
        "settings": settings_json(row.entry.settings),
        "own_gains": row.entry.own_gains,
        "stiffness": row.stiffness.tolist(),
        "unstable_trials": row.unstable,
        "mean": _over(row, lambda values: float(np.mean(values))),
        "worst": _over(row, max),
        "trials": [each.to_json() for each in row.measures],
    }


def _over(row: Row, how: Callable[[list[float]], float]) -> Json:
    """A figure of every measure over the stable trials; None where one of them never came."""

    def figure(pick: Callable[[Measures], float | None]) -> float | None:
        values = row.values(pick)
        value = how(values) if values else math.inf
        return value if math.isfinite(value) else None

    out: Json = {
        side: {key: figure(attrgetter(f"{side}.{key}")) for key in getattr(row.measures[0], side).to_json()}
        for side in ("true", "encoder")
    }
    return out | {key: figure(attrgetter(key)) for key in ("work", "heat", "saturated", "tick")}


def compare_laws(
    contest: Contest,
    *,
    trials: int = 1,
    workers: int = 1,
    matching: Matching | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> LimbResult:
    """Run every entry `trials` times, on plants drawn from the seed of the contest's plant plus the trial's number.

    The first trial runs here, is kept whole and tells how long a tick takes; the others run over `workers` processes and are measured
    there. The result does not depend on how many. `matching` is how the entries came by their gains.

    Raises:
        LawError: If settings do not fit the limb.
        ClamberError: If a worker failed.
    """

    def ended(later: int) -> None:
        if progress is not None:
            progress(later + 1, trials)

    limb, scenario, entries, flaws = contest.limb, contest.scenario, contest.entries, contest.flaws
    first = run_contest(limb, scenario, entries, flaws, plant=contest.plant)
    measured = [[measure(run, scenario, limb) for run in first]]
    ended(0)
    measured += [
        [replace(each, tick=run.tick_seconds) for each, run in zip(trial, first, strict=True)]
        for trial in contest.measure_trials(range(1, trials), workers, ended)
    ]
    matching = matching or Matching(LawSettings(law="scct"))
    at = limb.q0 if matching.at is None else matching.at
    return LimbResult(
        limb=limb,
        flaws=with_sensors(flaws, entries),
        plant=contest.plant,
        scenario=scenario,
        match=matching.how,
        reference=matching.reference,
        match_at=at,
        rows=tuple(
            Row(run, measures, tip_stiffness(limb.chain, run.entry.settings, at))
            for run, measures in zip(first, zip(*measured, strict=True), strict=True)
        ),
    )


@dataclass(frozen=True, slots=True, eq=False)
class ErrorLine:
    """Sizes of one error over a run."""

    what: str
    over: str
    error: Floats
    """Shape (samples,) [m]; NaN after a run that broke off."""


def error_line(run: Run, scenario: Scenario, until: float, index: int = 0) -> ErrorLine:
    """Distance from the circle in the last lap, or until a time [s] from the line of a step or the aim under a push; in truth."""
    trace = run.trace
    tip = trace.true_places()[:, index, :2]
    if scenario.kind == "circle":
        last = trace.time >= scenario.settle
        return ErrorLine("distance from the circle", "round the last lap", np.abs(radial_error(tip, scenario)[last]))
    shown = trace.time < until
    error = (tip - trace.wanted_places()[:, 0, :2])[shown]
    if scenario.kind == "step":
        across = components(error, scenario.direction)[1]
        return ErrorLine("distance from the line of the step", f"over {until:.3g} s", np.abs(across))
    return ErrorLine("distance from the aim", f"over {until:.3g} s", np.hypot(error[:, 0], error[:, 1]))
