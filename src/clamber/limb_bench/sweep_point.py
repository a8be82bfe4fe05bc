"""One point of a sweep over plants and gains: every law runs there, is measured, and must come to rest afterwards.

What varies is text, such as "backlash" and "2 deg", so that a point is plain data and can go to any worker.
"""

import math
from dataclasses import asdict, dataclass, replace
from typing import Any, Final

import numpy as np

from ..errors import StatedError, UnknownNameError
from ..jobs import read_result
from ..sim.bench_limb import BenchLimb
from ..sim.flaw_texts import DIMENSIONS as FLAWS
from ..sim.flaw_texts import WHOLE, read_flaw
from ..sim.limb_flaws import LimbFlaws
from ..types import Json
from ..units import read_number
from .bench_limb import bench_limb
from .entries import Match, make_entries, match_pose, read_law, reference_law
from .measures import Entry, Measures, Run, measure
from .runner import run_contest
from .scenario import MOTIONS, MotionKind, Scenario
from .stability import RESTING, STEADY, peak_to_peak, scaled_gains

GAIN_KEYS: Final = ("kp", "kd", "gain")
"""kp and kd of the reference law, which others are matched to; gain multiplies every law's own."""
REST: Final = 3.0
"""After the scenario the aim stands still so long; the tip must be at rest in the second half of it [s]."""
USUAL_MEASURE: Final[dict[MotionKind, str]] = {"step": "across_max", "circle": "radial_rms", "push": "along_max"}
PEAK: Final = "peak_to_peak"
"""Of the true tip at the end of the rest; the one measure that is no field of `Measures`."""


class SweepKeyError(StatedError):
    """Something is to vary that cannot: names the key, its value and what is allowed."""

    says = "--vary {key} = {value}: {allowed}"
    key: str
    value: object
    allowed: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Bench:
    """What is the same at every point, as plain words and numbers."""

    robot: str
    limb: str | None
    start: tuple[float, float]
    elbow: int | None
    kind: MotionKind
    command: Json
    """Arguments of the scenario beside limb and rate."""
    laws: tuple[str, ...]
    """As on the command line; none: the usual set."""
    reference: str
    kp: float
    kd: float
    match: Match
    measure: str
    """A field of `TipMeasures`, of the truth or with "encoder." before it, of `Measures`, or `PEAK`."""
    flaws: Json
    """Fields of `LimbFlaws`."""

    def build_limb(self) -> BenchLimb:
        """The limb at its start."""
        return bench_limb(self.robot, self.limb, self.start, elbow=self.elbow, upright=self.flaws["upright"])

    def build_point(self, limb: BenchLimb, varied: Json) -> tuple[LimbFlaws, list[Entry]]:
        """Plant and laws where some keys have the values of `varied`, texts by key.

        kd keeps its proportion to kp where kp alone varies. Where the control rate varies, the physics runs at the next whole multiple
        of it from that of the bench on.

        Raises:
            SweepKeyError: If a key cannot vary or a value cannot be.
        """
        flaws = LimbFlaws(**self.flaws)
        changes: dict[str, Any] = dict(
            read_flaw(f"{key}={text}") for key, text in varied.items() if key not in GAIN_KEYS
        )
        if "control_rate" in changes and "physics_rate" not in changes:
            rate = changes["control_rate"]
            changes["physics_rate"] = rate * max(1, math.ceil(flaws.physics_rate / rate - 1e-9)) if rate > 0 else 0.0
        law = read_law(self.reference).law
        gains = {key: _gain(law, key, varied[key]) for key in ("kp", "kd") if key in varied}
        kp = gains.get("kp", self.kp)
        kd = gains.get("kd", self.kd * kp / self.kp if self.kp else self.kd)
        # where gains are matched does not depend on the rate: the pose of the circle's centre, or the start
        at = match_pose(limb, self._command(limb, flaws.control_rate))
        reference = replace(reference_law(self.reference, None, None), kp=kp, kd=kd)
        entries = make_entries(limb, self.laws, reference, self.match, at)
        if "gain" in varied:
            factor = read_number("gain", varied["gain"], "ratio")
            entries = [replace(entry, settings=scaled_gains(entry.settings, factor)) for entry in entries]
        return flaws.with_changes(**changes), entries

    def build_scenario(self, limb: BenchLimb, rate: float) -> tuple[Scenario, int]:
        """The command with its rest, and how many ticks are before the rest."""
        scenario = self._command(limb, rate)
        ticks = len(scenario.aims)
        still = np.repeat(scenario.aims[-1:], round(REST * rate), axis=0)
        for key in ("twist", "acceleration"):
            still[key] = 0.0
        return replace(scenario, aims=np.concatenate((scenario.aims, still))), ticks

    def _command(self, limb: BenchLimb, rate: float) -> Scenario:
        return MOTIONS[self.kind](limb, rate, **self.command)


def _gain(law: str, key: str, text: str) -> float:
    value = getattr(read_law(f"{law}:{key}={text}"), key)
    assert isinstance(value, float)
    return value


def check_key(key: str) -> None:
    """Make sure that a key can vary.

    Raises:
        UnknownNameError: If not.
    """
    known = (*FLAWS, *WHOLE, *GAIN_KEYS)
    if key not in known:
        raise UnknownNameError("key to vary", key, known)


@dataclass(frozen=True, slots=True)
class Cell:
    """What one law did at one point."""

    value: float | None
    """The measure, in SI; None where it never came or the run was lost."""
    peak_to_peak: float
    """Of the true tip in the second half of the rest [m]."""
    steady: bool
    """Whether it stayed in control, and came to rest."""


def try_laws(bench: Bench, varied: Json, only: str | None = None) -> dict[str, Cell]:
    """Every law, or the one with the label `only`, at one point."""
    limb = bench.build_limb()
    flaws, entries = bench.build_point(limb, varied)
    scenario, ticks = bench.build_scenario(limb, flaws.control_rate)
    chosen = [entry for entry in entries if only in (None, entry.label)]
    return {
        run.entry.label: _cell(bench, limb, scenario, run, ticks) for run in run_contest(limb, scenario, chosen, flaws)
    }


def _cell(bench: Bench, limb: BenchLimb, scenario: Scenario, run: Run, ticks: int) -> Cell:
    since = ticks / (1.0 / run.period) + REST / 2
    swing = float(peak_to_peak(run.trace, since)[0])
    asked = replace(scenario, aims=scenario.aims[:ticks])
    told = measure(replace(run, trace=run.trace.first(ticks)), asked, limb)
    # Behind resting motors a link may still coast through its play: that is no cycle, and dies out
    resting = float(peak_to_peak(run.trace, since, motors=True)[0]) <= RESTING
    steady = told.unstable_at is None and (swing <= STEADY or resting)
    value = swing if bench.measure == PEAK else _pick(told, bench.measure)
    lost = value is None or not math.isfinite(value)
    return Cell(None if lost else value, swing if math.isfinite(swing) else 1e9, steady)


def _pick(told: Measures, name: str) -> float | None:
    side, _, inner = name.rpartition(".")
    for where in (getattr(told, side or "true"), *(() if side else (told,))):
        if hasattr(where, inner):
            value: float | None = getattr(where, inner)
            return value
    raise AssertionError(name)


def run_point(item: Json) -> Json:
    """Every law at one point; runs in a worker.

    Args:
        item: `bench`, the fields of `Bench`, and `varied`, texts by key.

    Returns:
        The fields of `Cell` by label of the law.
    """
    cells = try_laws(read_result(Bench, item["bench"]), item["varied"])
    return {label: asdict(cell) for label, cell in cells.items()}


def find_boundary(item: Json) -> Json:
    """Where between two values of a key one law stops, or begins, to be steady; runs in a worker.

    Args:
        item: As of `run_point`, with `label` of the law, `key`, `unit`, the numbers `low` and `high`, whether it is `steady` at `low`, and
            `precision` of the answer, in that unit.

    Returns:
        `at`, in that unit.
    """
    bench, low, high = read_result(Bench, item["bench"]), item["low"], item["high"]
    while high - low > item["precision"]:
        middle = 0.5 * (low + high)
        text = f"{middle:.12g} {item['unit']}".rstrip()
        cell = try_laws(bench, item["varied"] | {item["key"]: text}, item["label"])[item["label"]]
        low, high = (middle, high) if cell.steady == item["steady"] else (low, middle)
    return {"at": 0.5 * (low + high)}
