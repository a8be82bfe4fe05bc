"""Forces on a wall, a panel of force over time for each law; the open loop: paths of the tip and its first turns."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from ...sim.bench_limb import BenchLimb
from ...types import Floats
from ...viewing import style
from ...viewing.output import drawing
from ...viewing.style import LAW_COLOURS, WANTED, bare
from ..force import ForceResult
from ..measures import ForceMeasures, Measured
from ..open_loop import OpenLoopResult, OpenLoopRun
from ..scenario import direction, left_of
from .panels import MM, dress, head, legend_below, study_title

Pressed: TypeAlias = Measured[ForceMeasures]
COLOURS: Final = {
    "none": "#6B6B6B",
    "model": "#E69F00",
    "integral": "#CC79A7",
    "wrist": "#0072B2",
    "base": "#009E73",
    "wrist+model": "#56B4E9",
    "base+model": "#7A9E3B",
}
"""Colour of each way to deal with friction."""
LINES: Final = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (6, 1.5, 1, 1.5)), "-", (0, (3, 1)))
"""So that curves that coincide are both seen."""
SHOWN: Final = 4.0
"""Errors up to this many tolerances are drawn [-]."""


def draw_force(result: ForceResult, path: str | Path) -> None:
    """Draw the true force of every law over time, by controller, beside the limb at the wall."""
    laws = list(dict.fromkeys(row.entry.settings.law for row in result.rows))
    with drawing(path, (9.6, 1.7 + 1.75 * max(2, len(laws)))) as figure:
        grid = figure.add_gridspec(max(2, len(laws)), 2, width_ratios=(2.5, 1.0))
        panels = [figure.add_subplot(grid[k, 0]) for k in range(len(laws))]
        for law, axes in zip(laws, panels, strict=True):
            _draw_forces(axes, result, [row for row in result.rows if row.entry.settings.law == law], law)
            axes.sharex(panels[0])
        for axes in panels[:-1]:
            axes.tick_params(labelbottom=False)
        panels[-1].set_xlabel("time [s]")
        split = (len(laws) + 1) // 2 if len(laws) > 1 else 1
        _draw_place(figure.add_subplot(grid[:split, 1]), result)
        _draw_off_line(figure.add_subplot(grid[split:, 1]), result)
        title = f"{result.title()}, {result.limb.robot.name}'s {result.limb.name} limb"
        held = f"green: within {result.task.tolerance:g} N; (no): not held"
        under = "; ".join(filter(None, (f"plant: {result.plant_words()}", result.belief_words(), held)))
        height = figure.get_figheight()
        head(
            figure, title, under, room=1.0 - 0.6 / height, tops=(1.0 - 0.1 / height, 1.0 - 0.1 / height - 0.23 / height)
        )


def _compensation(row: Pressed) -> str:
    return row.entry.label.partition(" / ")[2]


def _look(row: Pressed, k: int) -> dict[str, Any]:
    return {"color": COLOURS.get(_compensation(row), style.INK), "ls": LINES[k % len(LINES)], "lw": 1.3}


def _draw_forces(axes: Axes, result: ForceResult, rows: list[Pressed], law: str) -> None:
    bare(axes)
    task = result.task
    axes.axhspan(task.force - task.tolerance, task.force + task.tolerance, color=style.GOAL, alpha=0.16, lw=0)
    low, high = task.force - SHOWN * task.tolerance, task.force + SHOWN * task.tolerance
    for k, row in enumerate(rows):
        force = row.run.force_into(task.angle)
        told = f"{_compensation(row)}{'' if row.measures.held else ' (no)'}"
        axes.plot(row.run.trace.time, force, label=told, zorder=3, **_look(row, k))
    time = rows[0].run.trace.time
    late = np.array([row.run.force_into(task.angle)[time >= result.scenario.settle] for row in rows])
    room = 0.5 * task.tolerance
    axes.set_ylim(max(-0.02 * task.force, min(low, float(late.min()) - room)), max(high, float(late.max()) + room))
    axes.set_xlim(0.0, float(time[-1]))
    for at, words in (
        (0.0, "touch"),
        (task.approach, "press"),
        (task.approach + task.rise, "stand"),
        (task.slide_from, "slide"),
        (task.slide_from + task.sliding, "stand"),
    ):
        axes.axvline(at, color=style.FAINT, lw=0.8, zorder=1)
        axes.annotate(
            words, (at, 0.0), (2.0, 3.0), xycoords=("data", "axes fraction"), textcoords="offset points",
            fontsize=6.5, color=style.QUIET,
        )  # fmt: skip
    axes.set_ylabel("force [N]")
    axes.set_title(law, fontsize=9)
    axes.legend(
        loc="upper right",
        bbox_to_anchor=(1.0, 1.22),
        ncols=len(rows),
        fontsize=6.5,
        handlelength=1.8,
        columnspacing=0.8,
        handletextpad=0.5,
    )


def _limb_points(limb: BenchLimb, q: Floats) -> Floats:
    """Port, elbow and tip in the port frame, shape (3, 2) [m]."""
    elbow = limb.links[0] * direction(float(q[0]))
    return np.vstack([np.zeros(2), elbow, limb.chain.place(q)[:2]])


def _draw_place(axes: Axes, result: ForceResult) -> None:
    """The limb at the start and at the end, and the wall."""
    axes.set_aspect("equal")
    axes.axis("off")
    task, limb = result.task, result.limb
    into = direction(task.angle)
    along = left_of(into)
    surface = np.array(limb.start) + task.gap * into
    reach = 0.06 + abs(task.slide)
    sides = surface + reach * np.array((-1.0, 1.0))[:, None] * along
    corners = np.vstack((sides, sides[::-1] + 0.02 * into))
    axes.add_patch(Polygon(corners, facecolor=style.BODY, edgecolor=style.QUIET, lw=0.8))
    trace = result.rows[0].run.trace
    for k, alpha in ((len(trace.time) - 1, 0.4), (0, 1.0)):
        points = _limb_points(limb, trace.true[k, 0, 0])
        axes.plot(*points.T, color=style.PARTS[0], lw=4.5, alpha=alpha, solid_capstyle="round", solid_joinstyle="round")
        axes.plot(*points[:2].T, ls="none", marker="o", ms=4, mfc=style.PAPER, mec=style.PARTS[0], alpha=alpha)
    tail = surface + 0.075 * into
    axes.annotate(
        "",
        tuple(tail),
        tuple(surface + 0.025 * into),
        arrowprops={"arrowstyle": "-|>", "color": style.FORCE, "lw": 1.4},
    )
    axes.annotate(
        f"{task.force:g} N", tuple(tail), tuple(8.0 * into), textcoords="offset points", color=style.FORCE, fontsize=8,
        ha="center", va="center",
    )  # fmt: skip
    axes.plot(*(tail + 0.02 * into), ls="none")
    axes.margins(0.1)


def _draw_off_line(axes: Axes, result: ForceResult) -> None:
    """How far each law is off along the wall, at most."""
    bare(axes)
    rows = result.rows[::-1]
    sizes = [1e3 * row.measures.off_line for row in rows]
    axes.barh(range(len(rows)), sizes, color=[COLOURS.get(_compensation(row), style.INK) for row in rows], height=0.62)
    axes.set_yticks(range(len(rows)), [row.entry.label for row in rows], fontsize=7)
    axes.set_xlabel("most off along the wall [mm]")
    axes.tick_params(axis="y", length=0)
    top = max((size for size in sizes if math.isfinite(size)), default=0.0)
    for k, size in enumerate(sizes):
        axes.annotate(f"{size:.2f}", (size, k), (3.0, 0.0), textcoords="offset points", va="center", fontsize=7)
    axes.set_xlim(0.0, 1.18 * top if top > 0.0 else 1.0)


NEAR: Final = 10.0
"""Way of the close view [mm]."""


class Drawn(NamedTuple):
    """A run, its label and how it is drawn."""

    label: str
    run: OpenLoopRun
    line: Any = "-"
    width: float = 1.8


def draw_open_loop(columns: Mapping[str, Sequence[Drawn]], far: float, title: str, path: str | Path) -> None:
    """Draw paths of the tip, the wanted direction downwards: up to `far` to scale, and the first centimetre stretched across.

    Args:
        columns: Heading -> paths.
        far: How far along the wanted direction [mm].
        title: Of the picture.
        path: A file (.png, .svg, .pdf).
    """
    with drawing(path, (9.2 if len(columns) > 1 else 6.4, 4.6)) as figure:
        grid = figure.subplots(1, 2 * len(columns), squeeze=False)[0]
        for views, reach in ((grid[::2], far), (grid[1::2], NEAR)):
            low, high = _sides([shown.run for paths in columns.values() for shown in paths], reach)
            for axes, (name, paths) in zip(views, columns.items(), strict=True):
                for shown in paths:
                    across, along = _as_far_as(shown.run, reach)
                    axes.plot(
                        across, -along, color=LAW_COLOURS[shown.run.transform], ls=shown.line, lw=shown.width,
                        label=shown.label,
                    )  # fmt: skip
                axes.plot([0, 0], [0, -reach], color=WANTED, lw=0.7, zorder=0.5)
                axes.set_xlim(low, high)
                axes.set_ylim(-reach, 0.03 * reach)
                dress(axes, grid=0.6)
                if reach == far:
                    axes.set_aspect("equal", anchor="N")
                    axes.set_title(f"{name}, to scale", fontsize=9.5)
                    axes.set_xlabel("across [mm]")
                else:
                    axes.set_title(f"{name}, first {reach:g} mm", fontsize=9.5)
                    axes.set_xlabel("across, stretched [mm]")
        grid[0].set_ylabel("along the wanted direction [mm]")
        study_title(figure, title)
        legend_below(figure, grid[0], 5, handlelength=3.2)


def draw_open_loop_result(result: OpenLoopResult, path: str | Path) -> None:
    """Draw the paths of one limb's tip, every transform in the colour of its law."""
    lines = ("-", "-", (0, (4, 1.5)), (0, (1, 1)))
    drawn = [Drawn(run.transform, run, lines[k % 4], 2.2 - 0.3 * (k % 4)) for k, run in enumerate(result.runs)]
    # as far as any transform gets, to a tenth of a metre at most
    far = min(100.0, max(10.0, *(float(run.along.max()) * MM for run in result.runs)))
    kind = "torques that follow the pose" if result.renewed else "steady torques"
    title = f"Open loop: {kind}, {result.runs[0].force:g} N along {math.degrees(result.direction):g} deg"
    draw_open_loop({f"{result.limb.robot.name}, {result.limb.name}": drawn}, far, title, path)


def _as_far_as(run: OpenLoopRun, reach: float) -> tuple[Floats, Floats]:
    """Ways across and along the wanted direction up to `reach` along it [mm]."""
    along, across = run.along * MM, run.across * MM
    end = int(np.argmax(along > reach)) + 1 if along.max() > reach else len(along)
    return across[:end], along[:end]


def _sides(runs: Sequence[OpenLoopRun], reach: float) -> tuple[float, float]:
    """Limits of an axis that shows all ways across, with some room."""
    ways = np.concatenate([_as_far_as(run, reach)[0] for run in runs])
    room = 0.06 * float(np.ptp(ways))
    return float(ways.min()) - room, float(ways.max()) + room


def draw_turns(
    directions: Floats, turns: Mapping[str, Mapping[str, Floats]], names: Mapping[str, str], path: str | Path
) -> None:
    """Draw how far the first motion is off the wanted direction, for every direction.

    Args:
        directions: From the x axis, shape (n,) [rad].
        turns: Name of a law -> branch -> angle off, anticlockwise positive, shape (n,) [deg].
        names: Name of a law -> its label.
        path: A file (.png, .svg, .pdf).
    """
    lines = ("-", (0, (4, 1.5)))
    with drawing(path, (7.6, 4.0)) as figure:
        axes = figure.subplots()
        for law, branches in turns.items():
            for line, (branch, values) in zip(lines, branches.items(), strict=False):
                label = f"{names[law]}, {branch}"
                axes.plot(np.degrees(directions), values, color=LAW_COLOURS[law], ls=line, lw=1.6, label=label)
        axes.axvline(math.degrees(1.5 * math.pi), color=WANTED, lw=0.8)
        axes.text(math.degrees(1.5 * math.pi) + 3, axes.get_ylim()[1], "-y", va="top", fontsize=9)
        axes.set_xlim(0.0, 360.0)
        axes.margins(y=0.08)
        axes.set_xticks(range(0, 361, 45), [f"{a}" for a in range(0, 361, 45)])
        dress(axes, "wanted direction from +x [deg]", "first acceleration off it [deg]", grid=0.6)
        axes.set_title("How straight each transform starts, without friction")
        figure.legend(loc="outside lower center", ncols=4, fontsize=8, handlelength=3.0)
