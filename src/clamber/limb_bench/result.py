"""Results of the limb bench as values, JSON, CSV and logs; laws compared by one motion, each with its measures over its trials."""

import json
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final

import numpy as np

from ..control.law_settings import LawSettings
from ..execution.log import Log
from ..execution.trace import LimbTrace, trace_log
from ..files import csv_text, write_atomically
from ..json_form import HIDDEN, Count, Jsonable, Key, in_json
from ..notebook import Pictured
from ..sim.bench_limb import BenchLimb
from ..sim.flaw_texts import plant_words
from ..sim.limb_flaws import LimbFlaws
from ..types import Floats
from .entries import Match, tip_stiffness
from .measures import (
    Figures,
    LabelledRun,
    Measured,
    Measures,
    Run,
    TipMeasures,
    components,
    measure,
    radial_error,
    scenario_size,
)
from .runner import Contest, run_contest, with_sensors
from .scenario import Scenario

SCHEMA: Final = "clamber-limb-1"
LEAST_BEYOND: Final = 1e-3
"""Less is the give of a stop [rad]."""
MISMATCH: Final = 0.01
"""A matched stiffness that is off by more than this part is told."""


class BenchResult(Jsonable):
    """A result that can be kept in files."""

    __slots__ = ()
    picture: ClassVar[str]
    """Module of `pictures`, and function in it that draws such a result into a file."""

    def table(self) -> tuple[list[str], list[list[Any]]]:
        """Columns and lines of its CSV; an empty field is what never came."""
        raise NotImplementedError

    def draw(self, path: str | Path) -> None:
        """Draw it into a file (.png, .svg, .pdf).

        Raises:
            SuffixError: If the file's suffix names no format for still pictures.
            FileError: If the file cannot be written.
        """
        module, _, name = self.picture.partition(":")
        getattr(import_module(f"{__package__}.pictures.{module}"), name)(self, path)

    def save(self, path: str | Path) -> None:
        """Write `to_json` to a file, whole or not at all."""
        write_atomically(Path(path), json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n")

    def save_table(self, path: str | Path) -> None:
        """Write `table` to a file as CSV, whole or not at all."""
        columns, lines = self.table()
        write_atomically(Path(path), csv_text((columns, *lines)))

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

    schema: str = ""
    limb: BenchLimb
    flaws: Annotated[LimbFlaws, HIDDEN]
    plant: Annotated[str, HIDDEN] = "mujoco"

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


@dataclass(frozen=True, slots=True, eq=False)
class Matching(Jsonable):
    """Which stiffness of which law the gains of others were matched to, and where."""

    reference: Annotated[LawSettings, Key(kind=dict[str, Any], after="how")]
    """Law that the others are matched to."""
    how: Match = "none"
    at: Annotated[Floats | None, Key(kind=list[float], after="reference")] = None
    """Joint angles [rad]; None: those at the limb's start."""
    not_matched: tuple[str, ...] = ()
    """Laws that were to be matched and cannot be: those with one gain for all directions."""


@dataclass(frozen=True, slots=True, eq=False)
class Row(Jsonable, Measured[tuple[Measures, ...]]):
    """One law and all its trials: the first one's run, and the measures of each."""

    run: Annotated[
        LabelledRun,
        Key(
            "own_gains",
            get=attrgetter("entry.own_gains"),
            kind=bool,
            meaning="Whether its gains were given, not matched.",
        ),
    ]
    measures: Annotated[tuple[Measures, ...], Key("trials", after="worst")]
    stiffness: Annotated[Floats, Key(kind=list[list[float]])]
    """At the tip, at `Matching.at`, shape (2, 2) [N/m]."""

    @property
    @in_json(after="stiffness", key="unstable_trials")
    def unstable(self) -> Count:
        """Number of trials that went unstable."""
        return sum(each.unstable_at is not None for each in self.measures)

    def values(self, pick: Callable[[Measures], float | None]) -> list[float]:
        """One measure of every stable trial; a trial without it is left out."""
        told = (pick(each) for each in self.measures if each.unstable_at is None)
        return [value for value in told if value is not None]

    @in_json(after="unstable_trials")
    def mean(self) -> Figures:
        """Of the stable trials; null where one of them never came."""
        return self._over(lambda values: float(np.mean(values)))

    @in_json(after="mean")
    def worst(self) -> Figures:
        """Likewise the largest."""
        return self._over(max)

    def _over(self, how: Callable[[list[float]], float]) -> Figures:
        def figure(pick: Callable[[Measures], float | None]) -> float:
            values = self.values(pick)
            return how(values) if values else math.inf

        true, encoder = (
            TipMeasures(
                **{key: figure(attrgetter(f"{side}.{key}")) for key in getattr(self.measures[0], side).to_json()}
            )
            for side in ("true", "encoder")
        )
        costs = {key: figure(attrgetter(key)) for key in ("work", "heat", "saturated", "tick")}
        return Figures(true=true, encoder=encoder, **costs)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class LimbResult(Comparison, Pictured):
    """What came out of one scenario with several laws on one plant."""

    picture = "comparison:draw_comparison"
    schema: str = SCHEMA
    scenario: Annotated[Scenario, Key(after="schema")]
    matching: Annotated[Matching, Key("match", after="plant")]
    rows: Annotated[tuple[Row, ...], Key("laws", after="trials")]

    def told(self) -> str:
        """What was compared, on what."""
        return f"{self.title()}: {', '.join(row.entry.label for row in self.rows)} on {self.plant_words()}"

    @property
    @in_json(after="seed")
    def trials(self) -> Count:
        """Trials of each law."""
        return len(self.rows[0].measures)

    @in_json(after="limb", key="plant")
    def whole_plant(self) -> dict[str, Any]:
        """What is not ideal about it, with the scenario's push."""
        return {"name": self.plant} | asdict(self.scenario.on(self.flaws))

    @property
    @in_json(after="beyond_limits")
    def seed(self) -> int | None:
        """Of the plant's draws."""
        return self.flaws.seed

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
            "/".join(f"{one:g}" for one in np.atleast_1d(gain))
            for gain in (self.matching.reference.kp, self.matching.reference.kd)
        )
        law = f"{self.matching.reference.law} (kp {kp}, kd {kd})"
        if self.matching.how == "none":
            return f"not matched; the numbers of {law}, whatever their unit"
        what = {"yy": "Kyy", "mean": "mean of Kxx and Kyy", "diagonal": "Kxx and Kyy"}[self.matching.how]
        own = sum(row.entry.own_gains for row in self.rows)
        where = "the start" if self.matching.at is self.limb.q0 else "the centre"
        return f"matched by '{self.matching.how}': {what} at {where} as {law}" + (
            f"; {own} of their own" if own else ""
        )

    @in_json(after="match")
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
    matching = replace(matching, at=at)
    rows = tuple(
        Row(run, measures, tip_stiffness(limb.chain, run.entry.settings, at))
        for run, measures in zip(first, zip(*measured, strict=True), strict=True)
    )
    return LimbResult(
        limb=limb,
        flaws=with_sensors(flaws, entries),
        plant=contest.plant,
        scenario=scenario,
        matching=replace(matching, not_matched=_not_matched(limb, matching, rows)),
        rows=rows,
    )


def _not_matched(limb: BenchLimb, matching: Matching, rows: Sequence[Row]) -> tuple[str, ...]:
    """Labels of laws that were to be matched and are not."""
    if matching.how == "none" or matching.at is None:
        return ()
    picks: dict[str, Callable[[Floats], Any]] = {"yy": lambda s: s[1, 1], "mean": np.trace, "diagonal": np.diag}
    pick = picks[matching.how]
    wanted = np.atleast_1d(pick(tip_stiffness(limb.chain, matching.reference, matching.at)))
    return tuple(
        row.entry.label
        for row in rows
        if not row.entry.own_gains and np.abs(np.atleast_1d(pick(row.stiffness)) / wanted - 1.0).max() > MISMATCH
    )


@dataclass(frozen=True, slots=True, eq=False)
class ErrorLine:
    """Sizes of one error over a run."""

    what: str
    over: str
    error: Floats
    """Shape (samples,) [m]; NaN after a run that broke off."""


def error_line(run: Run, scenario: Scenario, until: float) -> ErrorLine:
    """Distance from the circle in the last lap, or until a time [s] from the line of a step or the aim under a push; in truth."""
    trace = run.trace
    tip = trace.true_places()[:, 0, :2]
    if scenario.kind == "circle":
        last = trace.time >= scenario.settle
        return ErrorLine("distance from the circle", "round the last lap", np.abs(radial_error(tip, scenario)[last]))
    shown = trace.time < until
    error = (tip - trace.wanted_places()[:, 0, :2])[shown]
    if scenario.kind == "step":
        across = components(error, scenario.direction)[1]
        return ErrorLine("distance from the line of the step", f"over {until:.3g} s", np.abs(across))
    return ErrorLine("distance from the aim", f"over {until:.3g} s", np.hypot(error[:, 0], error[:, 1]))
