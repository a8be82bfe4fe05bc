"""What the pictures of the limb bench share: units, lines, heads, panels and legends."""

from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...viewing import style

MM: Final = 1e3
LINES: Final = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (6, 1.5, 1, 1.5)), (0, (3, 1, 1, 1, 1, 1)), (0, (8, 2)))
"""So that laws whose curves coincide are both seen."""
DASHED: Final[dict[str, Any]] = {"color": style.INK, "lw": 0.7, "ls": (0, (2, 2)), "zorder": 1}
"""Of what is desired."""


def dress(axes: Axes, across: str = "", up: str = "", *, grid: float = 0.5, **text: Any) -> None:
    """Give a panel its frame, its grid and the labels of its axes."""
    style.bare(axes)
    axes.grid(color=style.FAINT, lw=grid)
    axes.set_axisbelow(True)
    if across:
        axes.set_xlabel(across, **text)
    if up:
        axes.set_ylabel(up, **text)


def head(figure: Figure, title: str, under: str, *, room: float, tops: tuple[float, float]) -> None:
    """Write a title and what it holds for above the panels, which keep to `room`; all in parts of the figure's height."""
    figure.get_layout_engine().set(rect=(0.0, 0.0, 1.0, room))  # type: ignore[union-attr, call-arg]
    figure.text(0.012, tops[0], title, va="top", fontsize=11, fontweight="bold")
    spacing = 1.4 if "\n" in under else 1.2
    figure.text(0.012, tops[1], under, va="top", fontsize=8, color=style.QUIET, linespacing=spacing)


def study_title(figure: Figure, title: str) -> None:
    """Write the title of a study's picture."""
    figure.suptitle(title, x=0.01, ha="left", fontsize=11, fontweight="bold")


def legend_below(figure: Figure, axes: Axes, columns: int, **look: Any) -> None:
    """Say below all panels what the lines of one are, each label once."""
    handles, labels = axes.get_legend_handles_labels()
    kept = dict(zip(labels, handles, strict=True))
    columns = min(columns, len(kept))
    figure.legend(kept.values(), kept.keys(), loc="outside lower center", ncols=columns, fontsize=8, **look)
