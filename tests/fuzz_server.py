"""Runs cases of the fuzzer, each in a fork of a process that has everything loaded: `python tests/fuzz_server.py FIRST [LAST]`.

A crash ends the fork alone. What fails is told with its number, its words and what it printed; one number alone prints all of that.
"""

import contextlib
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

os.environ |= {"OPENBLAS_NUM_THREADS": "1", "COLUMNS": "80", "MPLBACKEND": "agg", "NUMBA_NUM_THREADS": "1"}

from clamber.cli import main
from clamber.jobs import LocalProcesses
from clamber.kernel_cache import cache_folder
from fuzz_cases import case, copy_files, prepare
from here import Here

MOST_SECONDS: Final = 10
"""Of processor time [s]."""
MOST_WALL: Final = 120.0
"""A case that takes longer waits for something [s], however busy the machine."""
MOST_MEMORY: Final = 1 << 30
"""Peak of the whole process [bytes]."""


@dataclass(frozen=True, slots=True)
class End:
    """How a case ended."""

    number: int
    words: tuple[str, ...]
    code: int
    """Exit code; negative: the signal that ended it."""
    seconds: float
    """Of processor time."""
    peak: int
    """Of memory [bytes]."""
    said: str
    """The end of what it printed."""
    faults: tuple[str, ...]


def run_here(*words: str) -> int:
    """Run a command in this process, in silence."""
    with open(os.devnull, "w") as null, contextlib.redirect_stdout(null), contextlib.redirect_stderr(null):
        try:
            main(words)
        except SystemExit as left:
            return left.code if isinstance(left.code, int) else 0
    return 0


def run_case(number: int, prepared: Path) -> End:
    """Run one case; again where it took too long and compiled kernels, as those stay compiled."""
    while True:
        kernels = _kernels()
        end = _run_once(number, prepared)
        if end.seconds <= MOST_SECONDS or _kernels() == kernels:
            return end


def _kernels() -> int:
    return sum(1 for _ in cache_folder().glob("*.nbc"))


def _run_once(number: int, prepared: Path) -> End:
    """Run one case in a fork, in a folder of its own."""
    folder = Path(tempfile.mkdtemp(prefix="fuzz-"))
    try:
        copy_files(prepared, folder)
        words = case(number, folder)
        before = {path.name for path in folder.iterdir()}
        out, err = folder.parent / f"{folder.name}.out", folder.parent / f"{folder.name}.err"
        code, used = _forked(words, folder, out, err)
        told, problem = _text(out), _text(err)
        seconds, peak = used.ru_utime + used.ru_stime, used.ru_maxrss * 1024
        left = {path.name for path in folder.iterdir()} - before
        faults = _faults(words, code, told, problem, left)
        faults += [f"took {seconds:.1f} s"] if seconds > MOST_SECONDS else []
        faults += [f"took {peak >> 20} MB"] if peak > MOST_MEMORY else []
        return End(number, words, code, seconds, peak, (told[-1500:] + problem[-4000:]), tuple(faults))
    finally:
        shutil.rmtree(folder)
        for suffix in (".out", ".err"):
            Path(f"{folder}{suffix}").unlink(missing_ok=True)


def _text(path: Path) -> str:
    return path.read_bytes()[-200_000:].decode("utf-8", "backslashreplace")


def _faults(words: tuple[str, ...], code: int, told: str, problem: str, left: set[str]) -> list[str]:
    """What is wrong with the end of a case."""
    steering = {
        letter
        for letter in told + problem
        if not letter.isprintable() and letter not in "\n\t" and not letter.isspace()
    }
    checks = {
        f"ended by signal {-code}": code < 0,
        f"left with {code}": code not in (0, 1, 2) and code > 0,
        "a traceback": "Traceback" in problem or "Traceback" in told,
        f"control characters {steering!r}": bool(steering),
        "refused without a word": code == 2 and not problem.strip(),
        "ran out of memory": "more memory than there is" in problem,
        "left a file half written": any(name.startswith(".clamber-") for name in left),
    }
    return [fault for fault, there in checks.items() if there]


def _forked(words: tuple[str, ...], folder: Path, out: Path, err: Path) -> tuple[int, resource.struct_rusage]:
    """Exit code and use of a command in a fork."""
    child = os.fork()
    if child == 0:
        code = 71
        try:
            os.setsid()
            os.chdir(folder)
            for file, number in ((os.devnull, 0), (str(out), 1), (str(err), 2)):
                os.dup2(os.open(file, os.O_RDWR | os.O_CREAT, 0o600), number)
            resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS + 2, MOST_SECONDS + 4))
            resource.setrlimit(resource.RLIMIT_AS, (_size() + MOST_MEMORY,) * 2)
            resource.setrlimit(resource.RLIMIT_FSIZE, (MOST_MEMORY,) * 2)
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            try:
                main(words)
                code = 0
            except SystemExit as left:
                code = left.code if isinstance(left.code, int) else 0 if left.code is None else 1
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(code)
    began = time.monotonic()
    while True:
        ended, status, used = os.wait4(child, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status), used
        if time.monotonic() - began > MOST_WALL:
            os.killpg(child, signal.SIGKILL)
            _, status, used = os.wait4(child, 0)
            return os.waitstatus_to_exitcode(status), used
        time.sleep(0.002)


def _size() -> int:
    """Addresses that this process has taken [bytes]."""
    return int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")


def _compile_apart() -> None:
    """Fill the cache in a fork: what a compiler leaves in memory would count as every case's own."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        child = os.fork()
        if child == 0:
            try:
                os.chdir(folder)
                prepare(Path(folder), run_here)
            finally:
                os._exit(0)
        os.waitpid(child, 0)


def serve(first: int, last: int) -> int:
    """Run cases and print a line for each that fails, then one of all; the number of failures."""
    LocalProcesses.run = Here.run  # type: ignore[method-assign]  # in the fork, and no workers of it
    prepared = Path(tempfile.mkdtemp(prefix="fuzz-files-"))
    here = Path.cwd()
    try:
        _compile_apart()
        os.chdir(prepared)
        prepare(prepared, run_here)
        os.chdir(here)
        failures, codes, kinds = 0, Counter[int](), Counter[str]()
        slowest, largest, total = 0.0, 0, 0.0
        for number in range(first, last):
            end = run_case(number, prepared)
            codes[end.code] += 1
            kinds[end.words[0]] += 1
            slowest, largest, total = max(slowest, end.seconds), max(largest, end.peak), total + end.seconds
            if end.faults or last - first == 1:
                failures += bool(end.faults)
                print(json.dumps(asdict(end)), flush=True)
        print(
            json.dumps(
                {"cases": last - first, "failures": failures, "codes": codes, "commands": kinds, "slowest": slowest, "largest": largest,
                 "seconds": total}
            ),
            flush=True,
        )  # fmt: skip
        return failures
    finally:
        shutil.rmtree(prepared)


if __name__ == "__main__":
    begin = int(sys.argv[1])
    sys.exit(1 if serve(begin, int(sys.argv[2]) if len(sys.argv) > 2 else begin + 1) else 0)
