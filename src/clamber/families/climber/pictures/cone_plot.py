"""Shortest plans against the cone in which hooks take forces."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from matplotlib.ticker import MaxNLocator

from ....viewing import style
from ....viewing.output import drawing
from ....viewing.style import bare

ROOM: Final = 0.05
"""Least distance of two names, as a part of the height."""


def draw_cones(lengths: Mapping[str, Mapping[float, int | None]], path: str | Path) -> None:
    """Draw one curve per board.

    Args:
        lengths: Board -> half angle of the cone [deg] -> actions of the shortest plan, None where there is none.
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (7.2, 4.8)) as figure:
        axes = figure.subplots()
        bare(axes)
        ends: list[tuple[float, str, str]] = []
        for k, (board, by_cone) in enumerate(lengths.items()):
            colour = style.PARTS[k % len(style.PARTS)]
            known = [(degrees, length) for degrees, length in sorted(by_cone.items()) if length is not None]
            none = [degrees for degrees, length in by_cone.items() if length is None]
            if not known:
                continue
            across, up = zip(*known, strict=True)
            axes.plot(across, up, color=colour, lw=1.6, marker="o", ms=3.5)
            if none:
                axes.plot(across[0], up[0], color=colour, ls="none", marker="|", ms=16, mew=2.2)
            axes.annotate(
                f"{across[0]:g}\N{DEGREE SIGN}", (across[0], up[0]), xytext=(0, 9), textcoords="offset points", ha="center",
                color=colour, fontsize=8.5,
            )  # fmt: skip
            ends.append((up[-1], board, colour))
        low, high = axes.get_ylim()
        for height, (_, board, colour) in zip(_apart(sorted(ends), ROOM * (high - low)), sorted(ends), strict=True):
            axes.annotate(
                board, (90.0, height), xytext=(7, 0), textcoords="offset points", va="center", color=colour, fontsize=8.5,
                annotation_clip=False,
            )  # fmt: skip
        axes.grid(axis="y", color=style.FAINT, lw=0.6)
        axes.set_axisbelow(True)
        axes.margins(y=0.08)
        axes.set_xlim(0.0, 90.0)
        axes.set_xticks(range(0, 91, 15))
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlabel("half angle of the cone about the grab direction [deg]")
        axes.set_ylabel("actions of the shortest plan")
        axes.set_title("Hooks that only pull: narrower cones, longer plans")
        figure.supxlabel(
            "bars and angles: the narrowest cone; left of them there is no plan, proved", fontsize=8, color=style.QUIET
        )


def _apart(ends: Sequence[tuple[float, str, str]], room: float) -> list[float]:
    """Heights of names, from below, none nearer than `room` to the one below it."""
    heights: list[float] = []
    for height, _, _ in ends:
        heights.append(height if not heights else max(height, heights[-1] + room))
    return heights
