"""How every picture looks: light, calm, in colours that colour-blind readers can tell apart (after Okabe and Ito)."""

from contextlib import AbstractContextManager
from typing import Any, Final, Literal, TypeAlias

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

PARTS: Final = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#8C564B", "#B5A900", "#6B6B6B")
"""Colour of each limb, in the robot's order."""
INK: Final = "#22303C"
QUIET: Final = "#6E7B87"
FAINT: Final = "#DCE1E6"
PAPER: Final = "#FFFFFF"
WALL: Final = "#F7F8FA"
BODY: Final = "#C9D1D9"
HOLD: Final = "#8E99A4"
GOAL: Final = "#7A9E3B"
FORCE: Final = "#3D3553"
ALERT: Final = "#C1272D"
STRIP: Final = (ALERT, "#F2A65A", "#BFD8E8", "#7FB0D0")
"""Colour of a step by its smallest relative margin: violated, tight, fair, ample (`margins.grade`)."""
STRIP_WORDS: Final = ("violated", "under 5 %", "under 15 %", "ample")

RC: Final[dict[str, Any]] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],  # shipped with Matplotlib, so pictures are the same everywhere
    "font.size": 9.0,
    "text.color": INK,
    "axes.edgecolor": QUIET,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.titlesize": 11.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "legend.frameon": False,
    "hatch.linewidth": 0.6,
    "savefig.facecolor": PAPER,
    "svg.hashsalt": "clamber",  # the same picture gives the same bytes
}
"""Settings of every picture."""


def styled() -> AbstractContextManager[None]:
    """A `with` block in which Matplotlib draws in Clamber's style; nothing global stays changed."""
    return rc_context(RC)  # type: ignore[arg-type]  # its keys are literals there


def bare(axes: Axes) -> None:
    """Take away the frame's top and right side."""
    axes.spines[["top", "right"]].set_visible(False)


def ruled(axes: Axes, axis: Literal["both", "x", "y"] = "both", *, behind: bool = False) -> None:
    """The same, with fine lines at the ticks of an axis or both, behind everything else if told so."""
    bare(axes)
    axes.grid(color=FAINT, lw=0.6, axis=axis)
    if behind:
        axes.set_axisbelow(True)


def entitle(figure: Figure, title: str, size: float = 11.0) -> None:
    """Say above the whole figure, from its left edge on, what it shows."""
    figure.suptitle(title, x=0.01, ha="left", fontsize=size, weight="bold")


Line: TypeAlias = str | tuple[int, tuple[float, ...]]
LAW_COLOURS: Final[dict[str, str]] = {
    "scct": "#0072B2",
    "jacobian-transpose": "#D55E00",
    "operational-space": "#00A878",
    "resolved-rate": "#CC79A7",
    "resolved-rate-plain": "#6E2A1B",
    "joint-pd": "#8A8A8A",
    "admittance": "#4F5A00",
    "implicit-admittance": "#56C4E9",
    "hybrid": "#4A1486",
    "implicit-force": "#E6A700",
}
"""Name of a law -> its colour: as far from each other as ten can be, for colour-blind readers, too."""
OUTSIDE: Final = "#B5125B"
"""Laws of other packages."""
WANTED: Final = INK
"""What was asked for."""
MATCH_LINES: Final[dict[str, Line]] = {
    "yy": "-",
    "mean": (0, (5, 1.6)),
    "diagonal": (0, (6, 1.5, 1, 1.5)),
    "none": (0, (1, 1.2)),
}
"""How gains were matched -> the line's pattern."""
