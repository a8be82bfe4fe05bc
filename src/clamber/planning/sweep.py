"""A sweep: one or two keys of a task varied, each point planned by itself, over worker processes."""

import csv
import io
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Annotated, Final

from ..errors import ClamberError, SpecError, StartError
from ..files import write_atomically
from ..jobs import Executor, Outcome, map_items, read_result
from ..json_form import HIDDEN, INLINE, Count, Jsonable, Key, in_json
from ..kernel_cache import is_compiled
from ..notebook import Pictured
from ..shown_units import SI, ShownUnits, units_of
from ..tasks import Task, load_task, task_from_document
from ..types import Json
from ..units import OZ_IN
from .axes import Axis, Mark, check_axes
from .planners import accepts, find_planner, first_loop
from .problem.problems import plan_family

SUCCESS: Final = ("optimal", "found")
NO_START: Final = "no start"
"""Status of a point whose task can't begin: its values contradict each other, or its start violates a hard check."""
FAILED: Final = "failed"
"""Status of a point whose planner raised an error or died."""
_SMALLEST: Final = ("longest", "max_checks", "max_evaluations", "max_stances", "width")
"""Options that make a search as small as can be."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Point(Jsonable):
    """One point of a sweep."""

    values: tuple[str, ...]
    """One per axis, as in an override."""
    status: str
    """A planner's status, "no start", or "failed"."""
    length: int | None = None
    """Actions of the plan; None without one."""
    least_torque: Annotated[float | None, Key("least_torque_Nm")] = None
    """The least that the largest joint torque of any plan can be, the start included: proved [N m]. None without a proof, or where
    joints are not modelled."""
    largest_torque: Annotated[float | None, Key("max_torque_Nm")] = None
    """Largest joint torque of the plan [N m]; the exact planner takes the easiest of the shortest plans."""
    lower_bound: int | None = None
    """Proved: no plan has fewer actions."""
    seconds: float = 0.0
    """Time that planning took [s]."""
    reason: str
    """In a sentence."""

    @in_json(after="max_torque_Nm")
    def least_torque_oz_in(self) -> float | None:
        """The proved least of the largest joint torque in oz-in."""
        return None if self.least_torque is None else self.least_torque / OZ_IN

    @in_json(after="least_torque_oz_in")
    def max_torque_oz_in(self) -> float | None:
        """The plan's largest joint torque in oz-in."""
        return None if self.largest_torque is None else self.largest_torque / OZ_IN


@dataclass(frozen=True, slots=True)
class MarkedPoint:
    """One point of a sweep, and whether it was asked to be marked."""

    point: Annotated[Point, INLINE]
    marked: bool
    """Whether it lies in the marks of every axis that has some."""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Sweep(Jsonable, Pictured):
    """All points of a sweep, the last axis fastest."""

    task: str
    planner: str
    axes: tuple[Axis, ...]
    marks: tuple[Mark, ...] = ()
    points: Annotated[tuple[Point, ...], HIDDEN]
    """The last axis fastest."""
    units: Annotated[ShownUnits, HIDDEN] = SI
    """In which it is printed and drawn."""

    def told(self) -> str:
        """How many points have a plan, over what."""
        keys = " and ".join(axis.key for axis in self.axes)
        return f"{self.found} of {len(self.points)} points of {self.task!r} over {keys} have a plan"

    def marked(self, index: int) -> bool:
        """Whether a point lies in the marks of every axis that has some."""
        place = index
        for axis in reversed(self.axes):
            place, k = divmod(place, len(axis.values))
            mine = [mark for mark in self.marks if mark.key == axis.key]
            if mine and (axis.numbers is None or not any(mark.holds(axis.numbers[k]) for mark in mine)):
                return False
        return bool(self.marks)

    @in_json(key="points")
    def marked_points(self) -> tuple[MarkedPoint, ...]:
        """The last axis fastest."""
        return tuple(MarkedPoint(point, self.marked(k)) for k, point in enumerate(self.points))

    @property
    @in_json(after="axes")
    def found(self) -> Count:
        """Points with a plan."""
        return sum(point.status in SUCCESS for point in self.points)

    def save_table(self, path: Path) -> None:
        """Write the points as CSV, whole or not at all."""
        text = io.StringIO()
        table = csv.writer(text, lineterminator="\n")
        rows = self.to_json()["points"]
        columns = [column for column in rows[0] if column != "values" and (self.marks or column != "marked")]
        table.writerow([*(axis.key for axis in self.axes), *columns])
        for point, told in zip(self.points, rows, strict=True):
            table.writerow([*point.values, *("" if told[column] is None else told[column] for column in columns)])
        write_atomically(path, text.getvalue())


def run_sweep(
    name: str,
    axes: Sequence[Axis],
    *,
    overrides: Sequence[str] = (),
    planner: str = "exact",
    options: Json | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    marks: Sequence[Mark] = (),
    store: Path | None = None,
    resume: bool = False,
    progress: Callable[[int, int, Outcome], None] | None = None,
) -> Sweep:
    """Plan a task at every point of one or two axes.

    Args:
        name: Name or path of the task.
        axes: What varies.
        overrides: What is set at every point, before the axes.
        planner: Name of the planner; each point is planned on one thread.
        options: Plain options of the planner, such as `seed`.
        workers: Processes; the table doesn't depend on it, but for the seconds.
        executor: Who plans the points, in place of local processes, such as a cluster.
        marks: References on the axes, for table and picture.
        store: SQLite file that keeps each point as it ends.
        resume: Whether to go on with that file.
        progress: Told of each end.

    Raises:
        SweepError: If the axes don't fit.
        UnknownNameError: If there is no such task or planner.
        SpecError: If no point of the sweep is a task; the first point's error.
        StoreError: If the file can't be the store of this sweep.
        ClusterError: If there is no cluster to run on, or it is lost.
    """
    check_axes(axes)
    find_planner(planner)
    places = list(product(*(axis.values for axis in axes)))
    loaded = [_load(name, (*overrides, *made)) for made in product(*(axis.overrides() for axis in axes))]
    tasks = [task for task in loaded if not isinstance(task, SpecError)]
    if not tasks:
        assert isinstance(loaded[0], SpecError)
        raise loaded[0]
    settings = dict(options or {})
    items: list[Json] = [{"document": task.document, "planner": planner, "options": settings} for task in tasks]
    if executor is None or executor.here:
        _compile(tasks, planner)
    outcomes = iter(
        map_items(
            plan_point,
            items,
            workers=workers,
            executor=executor,
            store=store,
            about={"axes": [axis.to_json() for axis in axes], "items": items},
            title=f"the sweep of '{name}' over {' and '.join(axis.key for axis in axes)}",
            resume=resume,
            progress=progress,
        )
    )
    points = tuple(
        Point(values=values, status=NO_START, reason=task.headline)
        if isinstance(task, SpecError)
        else _point(values, next(outcomes), store)
        for values, task in zip(places, loaded, strict=True)
    )
    units = units_of(tasks[0].document)
    return Sweep(task=name, planner=planner, axes=tuple(axes), points=points, marks=tuple(marks), units=units)


def plan_point(item: Json) -> Json:
    """Plan one point; runs in a worker.

    Args:
        item: `document` of the task, `planner`, `options`.

    Returns:
        The fields of `Point` beside `values` and `seconds`.
    """
    task = task_from_document(item["document"])
    planner = find_planner(item["planner"])
    proves = accepts(item["planner"], "minimize") and "torque" in plan_family(task).costs(task)
    order: Json = {"minimize": ("length", "torque")} if proves else {}
    try:
        result = planner(task, threads=1, **item["options"], **order)
    except StartError as error:
        return {"status": NO_START, "reason": str(error)}
    point: Json = {"status": result.status, "reason": result.reason, "lower_bound": result.lower_bound}
    if result.status in SUCCESS:
        torques = [row.max_torque for row in result.check().per_step if row.max_torque is not None]
        point |= {"length": result.length, "largest_torque": max(torques, default=None)}
        if proves and torques:
            easiest = planner(task, threads=1, **item["options"], minimize=("torque",))
            point["least_torque"] = easiest.costs["torque"] if easiest.status == "optimal" else None
    return point


def _point(values: tuple[str, ...], outcome: Outcome, store: Path | None) -> Point:
    if outcome.result is None:
        return Point(values=values, status=FAILED, reason=outcome.error or "", seconds=outcome.seconds)
    return read_result(Point, outcome.result | {"values": values, "seconds": outcome.seconds}, store)


def _load(name: str, overrides: Sequence[str]) -> Task | SpecError:
    try:
        return load_task(name, overrides)
    except SpecError as error:
        return error


def _compile(tasks: Sequence[Task], planner: str) -> None:
    """Compile the kernels here, once, and not in every worker at the same time."""
    if is_compiled(first_loop(planner)) and is_compiled("replay"):
        return
    least = {option: 1 for option in _SMALLEST if accepts(planner, option)}
    for task in tasks:
        with suppress(ClamberError):
            find_planner(planner)(task, threads=1, **least).check()
            return
