"""What benchmarks measured, as a page that says on which machine."""

import math
import os
import platform
from collections.abc import Mapping, Sequence
from pathlib import Path

from .. import __version__
from ..jobs.release import version_of
from .rows import Row

COUNTED = ("numpy", "numba", "mujoco", "scipy", "pin", "mink", "deap", "pymoo", "pygad")
"""Packages whose version a figure depends on."""


def performance_page(measured: Mapping[str, Sequence[Row]], command: str) -> str:
    """Markdown: the command, the machine, and a table for each benchmark, in the order in which they ran.

    Args:
        measured: Name of a benchmark -> its rows.
        command: The words that made it, as they are to be typed.
    """
    parts = [
        "# Performance",
        "Times say little about another machine; ratios against a named peer, or against the raw step of the same model, say more. All of "
        f"this page is what one command wrote, on a machine with nothing else to do:\n\n    {command}",
        f"**Machine.** {machine()}",
    ]
    for name, rows in measured.items():
        lines = [f"## {name}", "| figure | value | unit | aim |", "|---|---:|---|---|"]
        lines += [f"| {_cell(row.name)} | {_value(row)} | {_cell(row.unit)} | {_cell(row.aim or '')} |" for row in rows]
        parts.append(lines[0] + "\n" + "\n".join(lines[1:]))
    return "\n\n".join(parts) + "\n"


def machine() -> str:
    """Processor, cores, memory and versions, in a line."""
    told = [processor(), f"{os.cpu_count() or 1} cores"]
    if hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
        told.append(f"{os.sysconf('SC_PAGE_SIZE') * os.sysconf('SC_PHYS_PAGES') / 2**30:.0f} GiB")
    told += [
        f"{platform.system()} {platform.machine()}",
        f"Python {platform.python_version()}",
        f"clamber {__version__}",
    ]
    found = {package: version_of(package) for package in COUNTED}
    told += [f"{package} {version}" for package, version in found.items() if version is not None]
    return ", ".join(told) + "."


def processor() -> str:
    """The processor by the name that it gives itself, or its kind where it gives none."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    named = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return named[0] if named else platform.processor() or platform.machine()


def _value(row: Row) -> str:
    return f"{row.value:.4g}" if math.isfinite(row.value) else "none"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")
