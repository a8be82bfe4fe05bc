"""A terminal for tests: a command is typed in one of so many columns, and what comes is kept with its time and as it stands at the end."""

import codecs
import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import sys
import termios
import time
from dataclasses import dataclass
from pathlib import Path

STEERING = re.compile(r"\x1b\[([?\d;]*)([A-Za-z])|\r\n|[\r\n]|[^\x1b\r\n]+|\x1b")


@dataclass(frozen=True, slots=True)
class Session:
    """What came of a command in a terminal."""

    code: int
    silence: float
    """The longest time without a letter, from the start on and to the end [s]."""
    stretched: float
    """How many times longer everything takes than on a machine that does nothing else: the load of a core."""
    written: str
    """All that was ever written, steering and all."""
    screen: list[str]
    """Lines as they stand at the end, as written: those that the terminal itself breaks are whole."""


def typed(words: list[str], *, columns: int, folder: Path, encoding: str = "utf-8", most: float = 1800.0) -> Session:
    """Type a command and watch it to its end."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    plain = {
        key: value for key, value in os.environ.items() if key not in ("COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR")
    }
    process = subprocess.Popen(
        [sys.executable, "-c", "from clamber.cli import main; main()", *words],
        stdin=theirs, stdout=theirs, stderr=theirs, cwd=folder, start_new_session=True,
        env=plain | {"TERM": "xterm-256color", "PYTHONIOENCODING": encoding},
    )  # fmt: skip
    os.close(theirs)
    decode = codecs.getincrementaldecoder(encoding)(errors="replace")
    began = last = time.monotonic()
    silence, written, loads = 0.0, "", [os.getloadavg()[0]]
    try:
        while True:
            assert time.monotonic() < began + most, f"it takes more than {most:.0f} s\n{written[-2000:]}"
            ready = select.select([ours], [], [], 0.2)[0]
            now = time.monotonic()
            if not ready:
                if process.poll() is not None:
                    break
                continue
            try:
                came = os.read(ours, 65536)
            except OSError:  # the other end is closed
                break
            if not came:
                break
            silence, last = max(silence, now - last), now
            loads.append(os.getloadavg()[0])
            written += decode.decode(came)
        code = process.wait(60)
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
        os.close(ours)
    silence = max(silence, time.monotonic() - last)
    stretched = max(1.0, max(loads) / (os.cpu_count() or 1))
    return Session(code, silence, stretched, written, screen_of(written))


def screen_of(written: str) -> list[str]:
    """The lines that stand at the end, from letters and the few ways to steer that we use: back, up, erase, colour."""
    lines, row, column = [""], 0, 0
    for found in STEERING.finditer(written):
        text = found[0]
        if found[2] == "A":
            row = max(0, row - int(found[1] or 1))
        elif found[2] == "K":
            lines[row] = "" if found[1] == "2" else lines[row][:column]
        elif text in ("\n", "\r\n"):
            row, column = row + 1, 0
            lines += [""] * (row + 1 - len(lines))
        elif text == "\r":
            column = 0
        elif not text.startswith("\x1b"):
            lines[row] = lines[row][:column].ljust(column) + text + lines[row][column + len(text) :]
            column += len(text)
    return [line.rstrip() for line in lines]
