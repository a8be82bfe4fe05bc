"""The thesis's remark that pegs must be 18 to 20 in apart across and about 6 in up: both distances of the ladder varied."""

from dataclasses import replace
from typing import Final

from ...planning.axes import range_axis, read_mark
from ...planning.sweep import NO_START, SUCCESS, Sweep, run_sweep
from ...types import Json
from ...units import INCH
from ...viewing.sweep_plot import draw_sweep
from ..bevly_1997.printed_plans import limbed_task
from ..result import Cells, Compared, Figure, StudyResult, Table
from .proofs import CORES, MODEL, NEVER_HANGS, TOLD, prove_all

ACROSS: Final = "board.spacing=12in..26in:15"
UP: Final = "board.rung=3in..12in:10"
RUNG: Final = 6.0
"""About what the thesis states [in]."""
MARKS: Final = ("board.spacing=18in..20in", "board.rung=6in")
"""What the thesis states."""
TALL: Final = "board.ladder.rungs=25"
"""High enough for the goal with rungs of 3 in, too."""
LIFTS: Final = (2, 4, 6, -2, -4, -6)
"""Other heights of the start tried where the task's own is not allowed [in]."""


def vary_spacing(across: str = ACROSS, up: str = UP) -> StudyResult:
    """Shortest plan on ladders of every width and rung."""
    axes = (range_axis(across), range_axis(up))
    marks = [read_mark(mark, axes) for mark in MARKS]
    swept = run_sweep("ladder", axes, overrides=(*MODEL, TALL), marks=marks, workers=CORES)
    assert all(point.status in (*SUCCESS, "infeasible", NO_START) for point in swept.points), "a point was left open"
    lifted = _lift(swept)
    gained = sum(
        new.length is not None and old.length is None for old, new in zip(swept.points, lifted.points, strict=True)
    )
    inside = [point for k, point in enumerate(swept.points) if swept.marked(k)]
    own = {_place(point.values) for point in swept.points if point.length is not None}
    climbed = {_place(point.values) for point in lifted.points if point.length is not None}
    stated = {_place(point.values) for point in inside}
    others = {place for place in climbed if place[1] == RUNG} - stated
    best = min(point.length for point in swept.points if point.length is not None)
    shortest = [point.values for point in swept.points if point.length == best]
    return StudyResult(
        claim="The thesis says that pegs must be 18 to 20 in apart across and about 6 in up for the robot to climb. "
        "On ladders of other widths and rungs: which can be climbed, and on which is the climb to 60 in shortest?",
        verdict="holds" if stated <= climbed and not others else "differs",
        compared=(
            Compared("ladders tried", len(swept.points)),
            Compared("ladders climbed from the task's start", swept.found),
            Compared("ladders where the start itself is not allowed", sum(point.status == NO_START for point in swept.points)),
            Compared("of these, ladders that can be climbed from a start up to 6 in higher or lower", gained),
            Compared("marked ladders climbed", f"{sum(point.length is not None for point in inside)} of {len(inside)}", "all"),
            Compared("widths climbed with 6 in rungs from a level start between two pegs [in]", _listed(own, 1, RUNG), "18 to 20"),
            Compared("widths that can be climbed with 6 in rungs from any of the starts [in]", _listed(climbed, 1, RUNG), "18 to 20"),
            Compared("rungs that can be climbed at 18 in across [in]", _listed(climbed, 0, 18.0), "about 6"),
            Compared("rungs that can be climbed at 20 in across [in]", _listed(climbed, 0, 20.0), "about 6"),
            Compared("shortest climb from the task's start [actions]", best),
            Compared("on ladders (across x up)", "; ".join(" x ".join(values) for values in shortest)),
        ),
        deviations=(
            *TOLD,
            NEVER_HANGS,
            "The start is between pegs 3 and 4, body level, and moves with them; where that stance is not allowed, the start is also tried "
            "2, 4 and 6 in higher and lower on the same pegs, and the shortest plan from any of these heights counts. A higher "
            "start spares actions, so those lengths tell that a ladder can be climbed, not how it compares.",
            "A ring says that none of the starts tried is allowed: nothing is proved of that ladder.",
            "The ladders have 25 rungs instead of eleven, so that all reach above the goal at 60 in; "
            "the verdict is for the words 'must be': it differs if a ladder with 6 in rungs and another width can be climbed.",
        ),
        table=_table(swept, lifted),
        figures=(
            Figure("field", "Actions of the shortest plan by distance of the pegs across and up; dashed: what the thesis states.",
                   lambda path: draw_sweep(swept, path)),
            Figure("heights", "The same with higher and lower starts where the level one is not allowed (rings: none is).",
                   lambda path: draw_sweep(lifted, path)),
        ),
    )  # fmt: skip


def _place(values: tuple[str, ...]) -> tuple[float, float]:
    """Distance of the pegs across and up [in]."""
    across, up = (float(value.removesuffix(" in")) for value in values)
    return across, up


def _listed(climbed: set[tuple[float, float]], axis: int, at: float) -> str:
    """The distances that can be climbed where the one on `axis` is `at`."""
    return ", ".join(f"{place[1 - axis]:g}" for place in sorted(climbed) if place[axis] == at) or "none"


def _lift(swept: Sweep) -> Sweep:
    """The sweep with, where the start is not allowed, the shortest plan from a start on the same pegs at another height."""
    items: list[Json] = []
    places: list[int] = []
    for k, point in enumerate(swept.points):
        if point.status != NO_START:
            continue
        ladder = (*MODEL, TALL, *(f"{axis.key}={value}" for axis, value in zip(swept.axes, point.values, strict=True)))
        height = limbed_task("ladder", ladder).start.y / INCH
        items += [{"name": "ladder", "overrides": (*ladder, f"start.y={height + lift:g}in")} for lift in LIFTS]
        places += [k] * len(LIFTS)
    points = list(swept.points)
    for k, proof in zip(places, prove_all(items), strict=True):
        known = points[k].length
        if proof.feasible and (known is None or (proof.length or 0) < known):
            points[k] = replace(points[k], status="optimal", reason=proof.reason, length=proof.length)
        elif proof.status == "infeasible" and known is None:
            points[k] = replace(points[k], status="infeasible", reason=proof.reason)
    return replace(swept, points=tuple(points))


def _table(swept: Sweep, lifted: Sweep) -> Table:
    rows: list[Cells] = []
    for k, (point, other) in enumerate(zip(swept.points, lifted.points, strict=True)):
        across, up = _place(point.values)
        marked = "stated" if swept.marked(k) else None
        rows.append((across, up, point.status, point.length, other.status, other.length, marked))
    return Table(
        ("across [in]", "up [in]", "level start", "actions", "any of the starts", "actions from it", "by the thesis"),
        tuple(rows),
    )
