"""The result of a comparison on the limb bench: every law's measures over its trials, as values, JSON and CSV."""

import csv
import io
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from ...control.law_settings import LawSettings
from ...files import write_atomically
from ...sim.limb_flaws import LimbFlaws
from ...types import Floats, Json
from .bench_limb import BenchLimb
from .contest import Entry, Run, run_contest
from .matching import Match, tip_stiffness
from .measures import Measures, measure, scenario_size
from .scenario import Scenario

SCHEMA: Final = "clamber-limb-1"
MISMATCH: Final = 0.01
"""A matched stiffness that is off by more than this part is told."""


@dataclass(frozen=True, slots=True, eq=False)
class Row:
    """One law and all its trials."""

    entry: Entry
    stiffness: Floats
    """At the tip, at `LimbResult.match_at`, shape (2, 2) [N/m]."""
    measures: tuple[Measures, ...]
    """One of each trial."""
    run: Run
    """The first trial's."""

    @property
    def unstable(self) -> int:
        """Number of trials that went unstable."""
        return sum(each.unstable_at is not None for each in self.measures)

    def values(self, pick: Callable[[Measures], float | None]) -> list[float]:
        """One measure of every stable trial; a trial without it is left out."""
        told = (pick(each) for each in self.measures if each.unstable_at is None)
        return [value for value in told if value is not None]


@dataclass(frozen=True, slots=True, eq=False)
class LimbResult:
    """What came out of one scenario with several laws on one plant."""

    limb: BenchLimb
    scenario: Scenario
    flaws: LimbFlaws
    plant: str
    match: Match
    reference: LawSettings
    """The law that gains were matched to."""
    match_at: Floats
    """Joint angles at which they were [rad]."""
    seed: int
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

    def title(self) -> str:
        """What was asked for, in a few words."""
        scenario = self.scenario
        if scenario.kind == "step":
            return f"step of {1e3 * scenario_size(self.rows[0].run.trace, scenario):g} mm"
        if scenario.kind == "circle":
            assert scenario.radius is not None and scenario.lap is not None
            return f"circle of radius {1e3 * scenario.radius:g} mm in {scenario.lap:g} s"
        if scenario.push is not None:
            push = scenario.push
            return f"push of {math.hypot(push.x, push.y):g} N from {push.start:g} to {push.end:g} s"
        return scenario.kind

    def plant_words(self) -> str:
        """The plant and what is not ideal about it, in one line."""
        flaws = self.flaws
        told = [self.plant, f"{flaws.control_rate:g} Hz"]
        for key, words in (
            ("backlash", f"backlash {math.degrees(flaws.backlash):.4g} deg"),
            ("encoder_counts", f"{flaws.encoder_counts} counts"),
            ("delay", f"delay {flaws.delay}"),
            ("payload", f"payload {flaws.payload:g} kg"),
            ("speed_noise", f"speed noise {flaws.speed_noise:g} rad/s"),
            ("wrench_noise", f"force noise {flaws.wrench_noise:g} N"),
            ("model_error", f"model error {100 * flaws.model_error:g} %"),
        ):
            if getattr(flaws, key):
                told.append(words)
        told += [f"{key} x {getattr(flaws, key):g}" for key in ("friction", "damping") if getattr(flaws, key) != 1.0]
        told += ["upright"] if flaws.upright else []
        told += [] if flaws.motor_limits else ["motors without limits"]
        return ", ".join([*told, *([] if flaws.seed is None else [f"seed {self.seed}"])])

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
                if most > 0.0:
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
            "limb": {
                "robot": self.limb.robot.name,
                "name": self.limb.name,
                "start": list(self.limb.start),
                "angles": [float(q) for q in self.limb.q0],
            },
            "plant": {"name": self.plant} | asdict(scenario.on(self.flaws)),
            "match": {
                "how": self.match,
                "reference": _gains(self.reference),
                "at": self.match_at.tolist(),
                "not_matched": self.mismatches(),
            },
            "beyond_limits": self.beyond_limits(),
            "seed": self.seed,
            "trials": self.trials,
            "laws": [_law(row) for row in self.rows],
        }

    def save(self, path: Path) -> None:
        """Write `to_json` to a file, whole or not at all."""
        write_atomically(path, json.dumps(self.to_json(), indent=2, allow_nan=False) + "\n")

    def save_table(self, path: Path) -> None:
        """Write one line of CSV for each trial of each law, whole or not at all; an empty field is a time that never came."""
        lines = []
        for row in self.rows:
            for trial, told in enumerate(row.measures):
                flat = {"law": row.entry.label, "trial": trial}
                for key, value in told.to_json().items():
                    if isinstance(value, dict):
                        flat |= {f"{key}.{name}": inner for name, inner in value.items()}
                    else:
                        flat[key] = value
                lines.append(flat)
        columns = list(dict.fromkeys(key for line in lines for key in line))
        text = io.StringIO()
        table = csv.DictWriter(text, columns, restval="", lineterminator="\n")
        table.writeheader()
        table.writerows({key: "" if value is None else value for key, value in line.items()} for line in lines)
        write_atomically(path, text.getvalue())


def _gains(settings: LawSettings) -> Json:
    return {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(settings).items()}


def _law(row: Row) -> Json:
    return {
        "label": row.entry.label,
        "settings": _gains(row.entry.settings),
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

    out: Json = {}
    for side in ("true", "encoder"):
        keys = row.measures[0].to_json()[side]
        out[side] = {key: figure(lambda m, s=side, k=key: getattr(getattr(m, s), k)) for key in keys}  # type: ignore[misc]
    return out | {key: figure(lambda m, k=key: getattr(m, k)) for key in ("work", "heat", "saturated", "tick")}  # type: ignore[misc]


def run_trials(
    limb: BenchLimb,
    scenario: Scenario,
    entries: Sequence[Entry],
    flaws: LimbFlaws,
    *,
    plant: str = "mujoco",
    seed: int = 0,
    trials: int = 1,
    match: Match = "none",
    reference: LawSettings | None = None,
    match_at: Floats | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> LimbResult:
    """Run every entry `trials` times, on plants drawn from `seed` and the trial's number.

    One trial of a plant with nothing left to chance (`flaws.seed` None) is the plant as it is.

    Raises:
        LawError: If settings do not fit the limb.
    """
    told: list[list[Measures]] = [[] for _ in entries]
    first: list[Run] = []
    for trial in range(trials):
        drawn = flaws if flaws.seed is None else flaws.with_changes(seed=seed + trial)
        runs = run_contest(limb, scenario, entries, drawn, plant=plant)
        first = first or runs
        for k, run in enumerate(runs):
            told[k].append(measure(run, scenario, limb))
        if progress is not None:
            progress(trial + 1, trials)
    at = limb.q0 if match_at is None else match_at
    rows = tuple(
        Row(entry, tip_stiffness(limb.chain, entry.settings, at), tuple(measures), run)
        for entry, measures, run in zip(entries, told, first, strict=True)
    )
    return LimbResult(limb, scenario, flaws, plant, match, reference or LawSettings(law="scct"), at, seed, rows)
