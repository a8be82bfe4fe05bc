"""Golden outputs: the figures that commands print and write, hashed per command, so that a change of structure can't change one.

`python tests/golden/outputs.py` compares with `hashes.json`; `--write` renews it; `--keep FOLDER` keeps what was hashed, to compare
two trees by `diff -r`. Figures count, prose does not: of a text with spaces only its numbers are kept. Names of keys and of values
that were renamed since the hashes were written stand in `renamed.toml`, new = old.

Floats are rounded to `DIGITS` digits: processors differ in the last ones, by the order of sums and by fused multiplication. Where a search
or a simulation turns on such a digit, hashes differ from processor to processor all the same; then compare two trees on one machine.
"""

import argparse
import hashlib
import io
import json
import os
import re
import shlex
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from clamber.cli import main
from clamber.jobs import LocalProcesses

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

from here import Here  # noqa: E402

DIGITS = 9
"""Of a float, that are hashed; what is smaller than `NOUGHT` is 0."""
NOUGHT = 1e-12
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
VOLATILE = {
    "release",
    "version",
    "memory",
    "made_by",
    "sha256",
    "threads",
    "workers",
    "times_real_time",
    "wall_seconds",
    "speed",
}
"""Keys of what differs from run to run or from tree to tree: memory, hashes of the source, the machine, times of the clock."""
CLOCKS = {command: {"seconds"} for command in ("plan", "shorten", "learn", "sweep", "reach")} | {"limb": {"tick"}}
"""Command -> its keys that hold times of the clock; elsewhere "seconds" are those of a simulation."""


def commands() -> list[str]:
    """The lines of `commands.txt` that are commands."""
    lines = (HERE / "commands.txt").read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


@dataclass(frozen=True)
class Frozen:
    """What is frozen of a JSON value: keys under their old names, numbers, identifiers, and the numbers in prose."""

    keys: dict[str, str]
    values: dict[str, str]
    left_out: set[str]

    def of(self, value: Any) -> Any:
        """The frozen part of a value."""
        if isinstance(value, dict):
            old = {self.keys.get(key, key): entry for key, entry in value.items()}
            return {key: self.of(entry) for key, entry in old.items() if key not in self.left_out}
        if isinstance(value, list):
            return [self.of(entry) for entry in value]
        if isinstance(value, float):
            return 0.0 if abs(value) < NOUGHT else float(f"{value:.{DIGITS}g}")
        if isinstance(value, str):
            prose = " " in value or "/" in value
            return NUMBER.findall(Path(value).name) if prose else self.values.get(value, value)
        return value


def frozen_outputs(only: str = "") -> Iterator[tuple[str, str]]:
    """Each command and what is frozen of it, as JSON text; run in a new folder, in order, in this process."""
    renamed = tomllib.loads((HERE / "renamed.toml").read_text())
    before = Path.cwd()
    os.environ["COLUMNS"] = "80"
    LocalProcesses.run = Here.run  # type: ignore[method-assign]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for line in commands():
                if only and not re.search(only, line):
                    continue
                kept = {path: path.stat().st_mtime_ns for path in Path().glob("golden.*")}
                out, err, code = io.StringIO(), io.StringIO(), 0
                with redirect_stdout(out), redirect_stderr(err):
                    try:
                        main([*shlex.split(line.replace("{root}", str(HERE.parents[1]))), "--json"])
                    except SystemExit as left:
                        code = int(left.code or 0)
                assert code in (0, 1), f"clamber {line}: {code}\n{err.getvalue()}"
                written = {}
                for path in sorted(Path().glob("golden.*")):
                    if kept.get(path) != path.stat().st_mtime_ns:
                        text = path.read_text()
                        written[path.name] = json.loads(text) if path.suffix == ".json" else NUMBER.findall(text)
                whole = {"code": code, "printed": json.loads(out.getvalue()), "written": written}
                frozen = Frozen(renamed["keys"], renamed["values"], VOLATILE | CLOCKS.get(line.split()[0], set()))
                yield line, json.dumps(frozen.of(whole), indent=1, sort_keys=True)
        finally:
            os.chdir(before)


def digest(text: str) -> str:
    """SHA-256 of a text, in hexadecimal."""
    return hashlib.sha256(text.encode()).hexdigest()


def compare() -> int:
    """Runs the commands and compares, as the options say; how many differ."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="renew hashes.json")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keep what was hashed")
    parser.add_argument("--only", default="", metavar="PATTERN", help="commands that this regular expression finds")
    asked = parser.parse_args()
    path = HERE / "hashes.json"
    hashes = json.loads(path.read_text()) if path.exists() else {}
    differ, started = 0, time.monotonic()
    for line, text in frozen_outputs(asked.only):
        if asked.keep:
            asked.keep.mkdir(parents=True, exist_ok=True)
            (
                asked.keep / (f"{commands().index(line):02d}" + re.sub(r"[^A-Za-z0-9.=-]+", "_", line) + ".json")
            ).write_text(text)
        same = hashes.get(line) == digest(text)
        differ += not same
        print(f"{time.monotonic() - started:6.1f} s ", "same   " if same else "DIFFERS", line, flush=True)
        started = time.monotonic()
        hashes[line] = digest(text)
    if asked.write:
        path.write_text(json.dumps({line: hashes[line] for line in commands()}, indent=1) + "\n")
    return differ


if __name__ == "__main__":
    sys.exit(min(compare(), 1))
