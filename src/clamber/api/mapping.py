"""A task at many values of its keys, and everything that a robot can reach in it."""

from collections.abc import Sequence
from typing import Any, Unpack

from ..planning.axes import check_axes, range_axis, read_mark, values_axis
from ..planning.planners import accepts
from ..planning.reach.reach import MOST_STANCES, Reach, find_reach
from ..planning.sweep import Sweep, run_sweep
from ..tasks import Task
from .options import Crew, check_kind, check_options, executor_for, store_of, texts
from .planning import task_of


class Points(Crew, total=False):
    """How the points of a sweep are planned."""

    planner: str
    """"exact" unless given."""
    seed: int
    """Of the genetic planner."""
    evaluations: int
    """Most plans that the genetic planner tries; 50 000 unless given."""
    stances: int
    """Most stances that the exact planner keeps; 2 000 000 unless given."""


def sweep(
    task: str,
    vary: str | Sequence[str] = (),
    values: str | Sequence[str] = (),
    *,
    mark: str | Sequence[str] = (),
    overrides: str | Sequence[str] = (),
    **options: Unpack[Points],
) -> Sweep:
    """Plan at every point of a range: where a plan exists, how long the shortest is, how hard it loads the joints.

    Args:
        task: Its name or file.
        vary: A key and its range, such as "motor.torque_limit=10Nm..21Nm:12".
        values: A key and its values, such as "board=ladder,h"; one or two keys vary in all.
        mark: A value of a varied key, or "low..high", that is marked in table and picture.
        overrides: Texts "key=value" that are set at every point.
        options: `planner` ("exact" unless given), `seed`, `evaluations` and `stances` (what each search may take), `workers`, `ray`,
            `store` and `resume` as `trials` has them.

    Returns:
        The sweep: `points`, each with `values`, `status`, `length` and torques [N m], and how many were `found`; `save_table(path)`.

    Raises:
        ClamberError: If the task cannot be had, or the keys cannot be varied so.
    """
    check_options(options, Points.__annotations__)
    check_kind("task", task, str)
    axes = [*map(range_axis, texts("vary", vary)), *map(values_axis, texts("values", values))]
    check_axes(axes)
    planner = options.get("planner", "exact")
    stated = {"max_evaluations": options.get("evaluations", 50_000), "max_stances": options.get("stances", 2_000_000)}
    limits: dict[str, Any] = {name: most for name, most in stated.items() if accepts(planner, name)}
    return run_sweep(
        task,
        axes,
        overrides=texts("overrides", overrides),
        planner=planner,
        options={"seed": options.get("seed", 0)} | limits,
        executor=executor_for(options),
        marks=[read_mark(text, axes) for text in texts("mark", mark)],
        store=store_of(options),
        resume=options.get("resume", False),
    )


def reach(
    task: Task | str,
    *,
    hangs: bool = False,
    stances: int = MOST_STANCES,
    seconds: float | None = None,
    threads: int | None = None,
) -> Reach:
    """Every pose and hold that a robot can get to, and what it costs to be there.

    Args:
        task: A task, or its name or file; its goals stop nothing.
        hangs: Whether hangs count as the task's rules have them; the space may have no end then.
        stances: Memory: most stances that are kept.
        seconds: Most time [s]; None: as long as it takes.
        threads: Threads; None: one a core.

    Returns:
        The reachable space: `status`, `poses`, `places`, `holds`, `goals`; `save_table(path)`. `clamber.draw` draws it, `layer` by `layer`.

    Raises:
        ClamberError: If the task cannot be had, its start does not hold, or its actions cannot be listed.
    """
    check_kind("hangs", hangs, bool)
    check_kind("stances", stances, int)
    check_kind("seconds", seconds, float | None)
    check_kind("threads", threads, int | None)
    return find_reach(task_of(task), hangs=hangs, max_stances=stances, seconds=seconds, threads=threads)
