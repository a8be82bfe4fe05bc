"""What a user waits for and pays in memory: whole processes of the command line; and the page of measured speeds."""

import math
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from .. import __version__
from ..jobs.release import version_of
from ..kernel_cache import cache_root
from ..trials.measured import Row, Say, keep_quiet

COMMAND: Final = (sys.executable, "-c", "from clamber.cli import main; main()")
STARTS: Final = 3
BYTES_PER_UNIT: Final = 1 if sys.platform == "darwin" else 1024
"""Of `ru_maxrss`."""


LAUNCHER: Final = """
import os, subprocess, sys, time
started = time.perf_counter()
quiet = subprocess.DEVNULL
child = subprocess.Popen(sys.argv[1:], stdin=quiet, stdout=quiet, stderr=quiet)
if hasattr(os, "wait4"):
    _, status, used = os.wait4(child.pid, 0)
    code, memory = os.waitstatus_to_exitcode(status), used.ru_maxrss
else:
    code, memory = child.wait(), "nan"
print(time.perf_counter() - started, memory)
sys.exit(code)
"""
"""A small process between us and the one measured: Linux counts the memory of whoever starts a process as its own."""


def run_command(arguments: tuple[str, ...], cache: Path) -> tuple[float, float]:
    """Run the command line once: seconds, and peak memory [MiB] (NaN on Windows).

    Raises:
        CalledProcessError: If it fails.
    """
    environment = {**os.environ, "CLAMBER_CACHE": str(cache)}
    launch = (sys.executable, "-S", "-c", LAUNCHER, *COMMAND, *arguments)
    told = subprocess.run(launch, env=environment, capture_output=True, text=True, check=True)
    seconds, memory = (float(word) for word in told.stdout.split())
    return seconds, memory * BYTES_PER_UNIT / 2**20


def start_rows(*, say: Say = keep_quiet) -> list[Row]:
    """First start with an empty cache, second start, memory of a long search, and help."""
    with tempfile.TemporaryDirectory(prefix="clamber-bench-") as name:
        cache = Path(name)
        say("first start: compiles")
        first, _ = run_command(("plan", "ladder", "--json"), cache)
        compiled = set(cache.rglob("*.nbc"))
        say("second start")
        again = [run_command(("plan", "ladder", "--json"), cache) for _ in range(STARTS)]
        added = set(cache.rglob("*.nbc")) - compiled
        say("memory")
        long, memory = run_command(("plan", "h", "--json"), cache)
    return [
        Row("clamber plan ladder --json, first start, compiles everything", first, "s"),
        Row(f"clamber plan ladder --json, second start, best of {STARTS}", min(taken for taken, _ in again), "s"),
        Row("files of machine code that the second start added", len(added), "files", "0"),
        Row("clamber plan ladder --json, peak memory", max(used for _, used in again), "MiB"),
        Row("clamber plan h --json, whole process", long, "s"),
        Row("clamber plan h --json, peak memory", memory, "MiB"),
        *command_rows(say=say),
    ]


def command_rows(*, say: Say = keep_quiet) -> list[Row]:
    """How long commands take that compute nothing: whole processes."""
    here = cache_root()
    rows = []
    for words, aim in ((("--help",), "0.3 s"), (("--version",), None), (("list",), "1 s"), (("doctor",), None)):
        told = " ".join(words)
        say(told)
        taken = min(run_command(words, here)[0] for _ in range(STARTS))
        rows.append(Row(f"clamber {told}, best of {STARTS}", taken, "s", aim and f"under {aim}"))
    return rows


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
