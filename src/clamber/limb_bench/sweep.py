"""Laws over a range of plants or gains: where each is best, and where it goes unstable, its boundary found by bisection."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from itertools import pairwise, product
from typing import Annotated, Any, Final

from ..errors import UnknownNameError
from ..jobs import Outcome, read_result
from ..json_form import HIDDEN, Key, in_json
from ..planning.axes import Axis, check_axes
from ..sim.flaw_texts import WHOLE, plant_words
from ..sim.limb_flaws import LimbFlaws
from ..types import Json
from .entries import GAINS
from .measures import TipMeasures
from .result import BenchResult
from .runner import Crew
from .scenario import MotionKind
from .sweep_point import (
    GAIN_KEYS,
    PEAK,
    USUAL_MEASURE,
    Bench,
    Cell,
    SweepKeyError,
    check_key,
    find_boundary,
    run_point,
)

SCHEMA: Final = "clamber-limb-sweep-1"
PRECISION: Final = 0.02
"""Of a boundary, over the distance of the two grid values that it lies between."""
TIP_FIELDS: Final = tuple(field.name for field in fields(TipMeasures))
RUN_MEASURES: Final = ("work", "heat", "saturated", PEAK)
MEASURES: Final = (*TIP_FIELDS, *(f"encoder.{name}" for name in TIP_FIELDS), *RUN_MEASURES)
"""What can be drawn: of the true tip, of the encoders' tip, of the run."""
SCENARIO_MEASURES: Final = {
    "step": ("across_max", "across_rms", "overshoot", "settling", "on_aim", "rest", "iae"),
    "circle": ("radial_rms", "radial_max", "lag", "iae"),
    "push": ("along_max", "across_max", "across_rms", "settling", "on_aim", "rest", "iae"),
}
"""Those of the tip a scenario has."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Boundary:
    """Where one law changes from steady to not, along one axis."""

    label: str
    """Of the law."""
    key: str
    """Of the axis along which it was looked for."""
    at: float
    """In the unit of that axis."""
    beside: float | None
    """Value of the other axis, in its unit; None if there is no other."""
    steady_below: bool
    """Whether the law is steady below it."""


@dataclass(frozen=True, slots=True)
class SweepPoint:
    """One point."""

    values: dict[str, str]
    """Key to value."""
    winner: str | None
    """The steady law with the least measure."""
    laws: dict[str, Cell]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LimbSweep(BenchResult):
    """All points of a sweep, the last axis fastest."""

    picture = "sweep:draw_sweep"
    schema: str = SCHEMA
    bench: Annotated[Bench, Key(kind=dict[str, Any])]
    axes: tuple[Axis, ...]
    labels: Annotated[tuple[str, ...], Key("laws")]
    """Of the laws, in their order."""
    points: Annotated[tuple[dict[str, Cell], ...], HIDDEN]
    boundaries: Annotated[tuple[Boundary, ...], Key(after="scan")]
    scan: Annotated[str | None, Key(after="wins")]
    """Key of the axis along which boundaries were looked for; None where no axis can be divided."""

    def winner(self, index: int) -> str | None:
        """Label of the steady law with the smallest measure at a point; None where no law is steady."""
        best = [
            (cell.value, place, label)
            for place, (label, cell) in enumerate(self.points[index].items())
            if cell.steady and cell.value is not None
        ]
        return min(best)[2] if best else None

    @in_json(after="laws")
    def wins(self) -> dict[str, int]:
        """Points that each law wins."""
        winners = [self.winner(k) for k in range(len(self.points))]
        return {label: winners.count(label) for label in self.labels}

    def values(self, index: int) -> dict[str, str]:
        """Texts of a point by key."""
        return dict(zip((axis.key for axis in self.axes), _places(self.axes)[index], strict=True))

    @in_json(after="boundaries", key="points")
    def all_points(self) -> tuple[SweepPoint, ...]:
        """Of the sweep."""
        return tuple(SweepPoint(self.values(k), self.winner(k), point) for k, point in enumerate(self.points))

    def plant_words(self) -> str:
        """What does not vary of the plant, in one line."""
        varied = {axis.key for axis in self.axes}
        kept = {key: value for key, value in self.bench.flaws.items() if key not in varied}
        return plant_words(LimbFlaws(**kept), rate="control_rate" not in varied)

    def gain_words(self) -> str:
        """Where the gains come from, in one line."""
        bench, varied = self.bench, {axis.key for axis in self.axes}
        if bench.laws and all(any(f"{key}=" in text for key in GAINS) for text in bench.laws):
            return "each law's own"
        kp = "" if "kp" in varied else f"kp {bench.kp:g}"
        kd = (
            "" if "kd" in varied else f"kd = {bench.kd / bench.kp:.3g} s x kp" if "kp" in varied else f"kd {bench.kd:g}"
        )
        told = ", ".join(filter(None, (kp, kd)))
        told = f" ({told})" if told else ""
        if bench.match == "none":
            return f"the numbers of {bench.reference}{told}, not matched"
        return f"matched by '{bench.match}' to {bench.reference}{told}"

    def table(self) -> tuple[list[str], list[list[Any]]]:
        """One line for each law at each point."""
        columns = [*(axis.key for axis in self.axes), "law", self.bench.measure, "peak_to_peak", "steady"]
        return columns, [
            [*self.values(k).values(), label, cell.value, cell.peak_to_peak, cell.steady]
            for k, point in enumerate(self.points)
            for label, cell in point.items()
        ]


def chosen_measure(kind: MotionKind, measure: str | None) -> str:
    """What is compared of a motion: the usual measure unless one is named.

    Raises:
        UnknownNameError: If the motion has no such measure.
    """
    chosen = USUAL_MEASURE[kind] if measure is None else measure
    inner = chosen.rpartition(".")[2]
    if chosen not in MEASURES or (inner in TIP_FIELDS and inner not in SCENARIO_MEASURES[kind]):
        known = (*(f"{each}{name}" for each in ("", "encoder.") for name in SCENARIO_MEASURES[kind]), *RUN_MEASURES)
        raise UnknownNameError(f"measure of a {kind}", chosen, known)
    return chosen


def _places(axes: Sequence[Axis]) -> list[tuple[str, ...]]:
    return list(product(*(axis.values for axis in axes)))


def run_limb_sweep(bench: Bench, axes: Sequence[Axis], crew: Crew | None = None) -> LimbSweep:
    """Run every law at every point, then look for the boundaries between steady and unsteady neighbours.

    The axes are one or two keys of the plant (as of `--set`) or of the gains (`GAIN_KEYS`), with numbers.

    Raises:
        SweepError: If the axes don't fit together.
        SweepKeyError: If a point failed; its reason.
        UnknownNameError: If a key cannot vary, or there is no such law or limb.
        PlantError, LawError: If the first point cannot be.
    """
    crew = crew or Crew()
    check_axes(axes)
    for axis in axes:
        check_key(axis.key)
        if axis.numbers is None:
            raise SweepKeyError(axis.key, ", ".join(axis.values), "must be numbers")
    places = [dict(zip((axis.key for axis in axes), place, strict=True)) for place in _places(axes)]
    limb = bench.build_limb()
    built = [bench.build_point(limb, varied) for varied in places]  # every mistake is told before anything runs
    labels = tuple(entry.label for entry in built[0][1])
    about: Json = {"bench": asdict(bench)}
    items: list[Json] = [about | {"varied": varied} for varied in places]
    title = f"the limb sweep over {' and '.join(axis.key for axis in axes)}"
    ends = crew.map(run_point, items, title=title, about=about | {"axes": [axis.to_json() for axis in axes]})
    points = tuple(
        {label: read_result(Cell, _result(end, varied).get(label) or {}, crew.store) for label in labels}
        for end, varied in zip(ends, places, strict=True)
    )
    scan = _scanned(axes)
    boundaries = () if scan is None else _boundaries(about, axes, scan, points, crew)
    return LimbSweep(
        bench=bench,
        axes=tuple(axes),
        labels=labels,
        points=points,
        boundaries=boundaries,
        scan=None if scan is None else axes[scan].key,
    )


def _result(end: Outcome, varied: Json) -> Json:
    if end.result is None:
        key = next(iter(varied))
        raise SweepKeyError(key, varied[key], end.error or "failed")
    return end.result


def _scanned(axes: Sequence[Axis]) -> int | None:
    """The axis along which boundaries are looked for: one of gains if there is one, else the last whose values can be divided."""
    divided = [k for k, axis in enumerate(axes) if axis.key not in WHOLE]
    gains = [k for k in divided if axes[k].key in GAIN_KEYS]
    return max(gains or divided, default=None)


def _boundaries(
    about: Json, axes: Sequence[Axis], scan: int, points: Sequence[dict[str, Cell]], crew: Crew
) -> tuple[Boundary, ...]:
    """Bisect between every two neighbours of the scanned axis of which a law is steady at one alone."""
    axis, other = axes[scan], axes[1 - scan] if len(axes) == 2 else None
    assert axis.numbers is not None
    order = sorted(range(len(axis.numbers)), key=axis.numbers.__getitem__)
    items: list[Json] = []
    found: list[tuple[str, float | None, bool]] = []
    for row in range(1 if other is None else len(other.values)):
        for label in points[0]:
            for k, up in pairwise(order):
                at, then = (_index(axes, scan, place, row) for place in (k, up))
                steady = points[at][label].steady
                if steady == points[then][label].steady:
                    continue
                low, high = axis.numbers[k], axis.numbers[up]
                items.append(
                    about
                    | {"varied": {} if other is None else {other.key: other.values[row]}}
                    | {"key": axis.key, "unit": axis.unit, "label": label, "low": low, "high": high, "steady": steady}
                    | {"precision": PRECISION * (high - low)}
                )
                beside = None if other is None or other.numbers is None else other.numbers[row]
                found.append((label, beside, steady))
    ends = crew.map(find_boundary, items) if items else []
    return tuple(
        Boundary(label=label, key=axis.key, at=_result(end, item["varied"] | {axis.key: item["low"]})["at"],
                 beside=beside, steady_below=steady)
        for (label, beside, steady), end, item in zip(found, ends, items, strict=True)
    )  # fmt: skip


def _index(axes: Sequence[Axis], scan: int, place: int, row: int) -> int:
    if len(axes) == 1:
        return place
    across = len(axes[1].values)
    return place * across + row if scan == 0 else row * across + place
