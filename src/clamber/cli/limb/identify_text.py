"""An identification as people read it: a table for each joint, within 80 columns, and files by suffix."""

from pathlib import Path
from textwrap import wrap

from rich.console import Console

from ...control.identification.estimate import Estimate
from ...control.identification.joint import IdentifiedJoint
from ...execution.log_identify import Identification
from ...files import write_atomically
from ...units import DEGREE
from ..output import plain_table

WIDTH = 80


def print_identification(console: Console, result: Identification) -> None:
    """Print every joint's table and what had to be assumed."""
    whose = f": {result.limb} limb of {result.robot}" if result.robot else ""
    console.print(f"{result.log}{whose}", style="bold")
    for joint in result.joints:
        console.print()
        _print_joint(console, joint)
    for note in result.notes:
        console.print()
        for line in wrap(f"note: {note}", WIDTH, subsequent_indent="  "):
            console.print(line)


def _print_joint(console: Console, joint: IdentifiedJoint) -> None:
    time = joint.samples.time
    console.print(f"{joint.samples.name}: {time.size} samples, {time[-1] - time[0]:.1f} s", style="bold")
    if joint.fit is not None and joint.fit.rows is not None:
        console.print(
            f"  torque from {joint.torque_from}; angle {joint.fit.lag * 1e3:.1f} ms behind it;"
            f" {joint.fit.residual:.2g} N m left over"
        )
    table = plain_table(
        "  parameter",
        "value",
        "std error",
        "unit",
        "in the file",
        "diff",
        right=("value", "std error", "in the file", "diff"),
    )
    told = [estimate for estimate in joint.estimates if estimate.value is not None]
    for estimate in told:
        table.add_row(*_cells(estimate))
    if told:
        console.print(table)
    for estimate in joint.estimates:
        if estimate.value is None:
            line = f"{estimate.name}: not in this log: needs {estimate.needs}"
            for words in wrap(line, WIDTH - 2, subsequent_indent="  "):
                console.print(f"  {words}")
    rough = joint.rough
    if rough.damping is not None and rough.friction is not None:
        inertia = "" if rough.inertia is None else f"inertia {rough.inertia:.3g}, "
        console.print(
            f"  by {len(rough.episodes)} constant torques alone: {inertia}damping {rough.damping:.3g},"
            f" friction {rough.friction:.3g}"
        )


def _cells(estimate: Estimate) -> tuple[str, ...]:
    scale, unit = (1.0 / DEGREE, "deg") if estimate.unit == "rad" else (1.0, estimate.unit)
    value, error = (estimate.value or 0.0) * scale, (estimate.error or 0.0) * scale
    stated = "" if estimate.stated is None else f"{estimate.stated * scale:.4g}"
    difference = "" if estimate.difference is None else f"{100 * estimate.difference:+.1f} %"
    return f"  {estimate.name}", f"{value:.4g}", f"{error:.2g}", unit, stated, difference


def write_identification(result: Identification, path: Path) -> None:
    """Write a picture, or lines for a robot's file (.toml), as the suffix says.

    Raises:
        SuffixError: If the suffix names neither.
        FileError: If the file cannot be written.
    """
    if path.suffix.lower() == ".toml":
        write_atomically(path, result.toml())
        return
    from ...limb_bench.pictures.identify_plot import draw_identification

    draw_identification(result, path)
