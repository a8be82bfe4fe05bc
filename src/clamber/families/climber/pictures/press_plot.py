"""A force held while the body moves: the force over time above the body's way."""

from pathlib import Path

from ....viewing.output import drawing
from ....viewing.style import bare
from ..trials.press import Pressed

FORCE, AIM, TRUE = "#0072B2", "#999999", "#D55E00"


def draw_press(result: Pressed, path: str | Path) -> None:
    """Draw the true force with its band of a tenth, and how far the body went beside what it was asked.

    Args:
        result: From `run_press`.
        path: A file (.png, .svg, .pdf).

    Raises:
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    with drawing(path, (7.2, 5.0)) as figure:
        force, body = figure.subplots(2, 1, sharex=True, height_ratios=(1.4, 1.0))
        force.axhspan(0.9 * result.wanted, 1.1 * result.wanted, color=FORCE, alpha=0.12, lw=0)
        force.plot(result.time, result.force, color=FORCE, lw=0.9)
        force.set_ylabel("force on the wall [N]")
        force.set_title(f"{result.wanted:.3g} N held while the body moves; the band is a tenth", loc="left")
        for k, (axis, dashes) in enumerate((("x", (3, 1.5)), ("y", (1, 0)))):
            start = result.aim[0, k]
            body.plot(result.time, 1e3 * (result.aim[:, k] - start), color=AIM, lw=0.9, dashes=dashes)
            body.plot(result.time, 1e3 * (result.body[:, k] - start), color=TRUE, lw=1.2, dashes=dashes, label=axis)
        body.set_ylabel("body from its first aim [mm]")
        body.set_xlabel("time [s]")
        body.legend(frameon=False, loc="upper left")
        for axes in (force, body):
            bare(axes)
