"""Figure 4: where the frames can be to each other, at one angle after the other."""

from pathlib import Path
from typing import Final

import numpy as np

from ...families.walker.robot import TwoFrames
from ...families.walker.robot.turning import turning_range
from ...families.walker.robot.workspace import best_directions, workspace
from ...types import Floats
from ...units import DEGREE
from ..result import Compared, Figure, StudyResult, Table, Value
from . import CALIBRATED, SIGNS
from .walker import ANGLES, CM2, MM, hoshino

SHOWN: Final = (-15, -10, 0, 10, 20, 30, 40, 46)
"""Angles of the panels and of the table [deg]."""


def draw_figure_4() -> StudyResult:
    """Regions by strokes alone, without singular poses, and with the guard of the robot's file."""
    frames = TwoFrames.of(hoshino().mechanism)
    curve = np.array([_areas(frames, theta) for theta in ANGLES])
    return StudyResult(
        claim="Figure 4, section 3.1: the larger the angle between the frames, the larger the range of their relative position; only the "
        "strokes of 0 to 250 mm limit it.",
        verdict="holds" if bool((np.diff(curve[:, 0]) > 0.0).all()) else "differs",
        compared=_compare(frames, curve),
        deviations=_deviations(frames, curve),
        table=_table(frames),
        figures=_figures(frames, curve),
    )


def _areas(frames: TwoFrames, theta: float) -> tuple[float, float, float, float]:
    """Of all parts and of the part around the centre by strokes, of the latter short of a singular pose and within the guard [cm^2]."""
    space = workspace(frames, theta * DEGREE)
    free, guarded = (workspace(frames, theta * DEGREE, guard=guard).central for guard in (1.0, frames.guard))
    parts = (space.central, free, guarded)
    return space.area * CM2, *(0.0 if part is None else part.area * CM2 for part in parts)  # type: ignore[return-value]


def _guard(frames: TwoFrames) -> str:
    return f"within {frames.guard:g} of the singular distance"


def _compare(frames: TwoFrames, curve: Floats) -> tuple[Compared, ...]:
    fine = (0.01 * k for k in range(3000, 4800))
    apart = next((theta for theta in fine if len(workspace(frames, theta * DEGREE).parts) > 1), None)
    peak, turn, at = int(np.argmax(curve[:, 3])), turning_range(frames, (0.0, 0.0, 0.0)), ANGLES.index
    guard = _guard(frames)
    return (
        *(Compared(f"area by strokes alone, theta = {theta} deg [cm^2]", curve[at(theta), 0]) for theta in SHOWN),
        *(Compared(f"area {guard}, theta = {theta} deg [cm^2]", curve[at(theta), 3]) for theta in SHOWN),
        Compared("angle of the largest guarded area [deg]", ANGLES[peak]),
        Compared("largest guarded area [cm^2]", curve[peak, 3]),
        Compared("angle from which on the centre is cut off from most of the range [deg]", apart),
        Compared("least angle [deg]", turn.least / DEGREE),
        Compared("largest angle [deg]", turn.most / DEGREE),
    )


def _deviations(frames: TwoFrames, curve: Floats) -> tuple[str, ...]:
    peak = ANGLES[int(np.argmax(curve[:, 3]))]
    return (
        "The figure's curves are not at hand, so the verdict is on what section 3.1 says of it, taken as it stands: strokes and nothing "
        "else.",
        f"What can be used grows only to {peak} deg. At |p| = rho, which shrinks as theta grows, the mechanism is singular: there the "
        "actuators cannot hold a push in one direction, and beyond it the frames are assembled the other way round. The paper leaves this "
        f"out. Kept {_guard(frames)}, the region shrinks again past {peak} deg, against the figure's growth.",
        "Beyond the angle named the strokes leave separate regions, and the frames with their origins on each other, as in a pivot, are "
        "in a small one.",
        CALIBRATED,
        SIGNS,
    )


def _table(frames: TwoFrames) -> Table:
    rows: list[tuple[Value, ...]] = []
    for theta in SHOWN:
        steps = (best_directions(frames, theta * DEGREE, guard=guard)[1] * MM for guard in (None, frames.guard))
        parts = len(workspace(frames, theta * DEGREE).parts)
        rows.append((theta, *(round(one, 2) for one in _areas(frames, theta)), parts, *steps))
    titles = (
        "theta [deg]", "strokes [cm^2]", "around the centre [cm^2]", "short of singular [cm^2]", f"{_guard(frames)} [cm^2]", "parts",
        "longest step [mm]", "guarded [mm]",
    )  # fmt: skip
    return Table(titles, tuple(rows))


def _figures(frames: TwoFrames, curve: Floats) -> tuple[Figure, ...]:
    def picture(path: Path) -> None:
        from ...families.walker.pictures.mechanism_plots import draw_regions

        draw_regions(frames, SHOWN, path)

    def growth(path: Path) -> None:
        from ...families.walker.pictures.mechanism_plots import draw_areas

        names = ("strokes alone", "part around the centre", "short of a singular pose", _guard(frames))
        draw_areas(ANGLES, dict(zip(names, curve.T, strict=True)), path)

    places = "Places of the Y-frame's origin in the Delta-frame at eight angles; the dashed circle is singular."
    return (
        Figure("regions", places, picture),
        Figure("areas", "Area of the region by the angle between the frames.", growth),
    )
