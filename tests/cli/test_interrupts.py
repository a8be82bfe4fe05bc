"""Ctrl-C in commands that take long, as a terminal sends it: to a real group of processes that do not ignore it."""

import os
import random
import shlex
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import pytest

from clamber import interrupts

SCRIPT = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from clamber.cli import main; main()"
"""A shell that starts a process with "&" has it ignore SIGINT; one in the foreground does not."""
SOON = 2.0
"""How soon after Ctrl-C a command has ended [s], on a machine that does nothing else."""
CROWDED = 8.0
"""How much longer that may take per process that waits for a core when the signal is sent, over the number of cores: a command that ends
in 0.5 s of computing then gets a part of a core only, and its workers end after it."""
PYTHON = 0.3
"""Until then Python itself starts, and nothing of ours runs [s]."""
MOMENTS = 10


@dataclass(frozen=True, slots=True)
class Ended:
    """What came of a command that was interrupted."""

    code: int
    seconds: float
    """Since the signal."""
    limit: float
    """The most that it may have taken, with the machine as it was."""
    out: str
    err: str


def begin(words: str, folder: Path) -> "subprocess.Popen[str]":
    out, err = (folder / "out").open("w"), (folder / "err").open("w")
    with out, err:
        return subprocess.Popen(
            [sys.executable, "-c", SCRIPT, *shlex.split(words)],
            stdin=subprocess.DEVNULL, stdout=out, stderr=err, text=True, cwd=folder, start_new_session=True,
            env=os.environ | {"COLUMNS": "400"},
        )  # fmt: skip


def end(process: "subprocess.Popen[str]", folder: Path) -> Ended:
    """Press Ctrl-C and wait."""
    limit = SOON * max(1.0, CROWDED * os.getloadavg()[0] / (os.cpu_count() or 1) / 8.0 + 1.0)
    os.killpg(process.pid, signal.SIGINT)
    sent = time.monotonic()
    try:
        code = process.wait(60)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        raise
    seconds = time.monotonic() - sent
    left = time.monotonic() + 5.0
    while time.monotonic() < left:  # its workers go a moment later
        try:
            os.killpg(process.pid, 0)
        except ProcessLookupError:
            break
        time.sleep(0.05)
    else:
        raise AssertionError("processes of the command are left")
    return Ended(code, seconds, limit, (folder / "out").read_text(), (folder / "err").read_text())


def check(ended: Ended, at: float) -> None:
    told = f"interrupted after {at:.2f} s, ended with {ended.code} after {ended.seconds:.2f} s\n{ended.err[-2000:]}"
    assert ended.code == 130, told
    assert ended.seconds < ended.limit, told
    assert "Traceback" not in ended.err and "Exception ignored" not in ended.err, told
    assert "interrupted" in ended.err + ended.out, told
