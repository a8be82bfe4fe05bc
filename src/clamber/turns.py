"""Processes that compile at the same time take turns with each kernel: one compiles it, the others wait and find it on disk."""

import contextlib
import os
import time
import zlib
from pathlib import Path
from typing import Final

try:
    from fcntl import LOCK_EX, LOCK_NB, LOCK_UN, lockf
except ImportError:  # no such locks here: every process compiles what it misses
    lockf = None  # type: ignore[assignment]

FILE: Final = "turns.lock"
MOST_SECONDS: Final = 120.0
"""The longest wait for another process, which may have been stopped [s]; after that a kernel is compiled here, too."""
LOOK: Final = 0.02
"""Between two looks whether it is one's turn [s]."""


class Turns:
    """The turns at one folder's kernels: one byte of a file for each name, locked by the process whose turn it is.

    Such a lock ends with its process, however that ends, and is no lock between the threads of a process, which Numba keeps apart itself.
    No process can wait for one that waits for it: kernels are compiled callees first, and none calls itself.
    """

    def __init__(self) -> None:
        self._open: dict[Path, int] = {}
        """Folder -> its file, which stays open: closing it would end every turn of this process."""

    def take(self, folder: Path, name: str, most: float = MOST_SECONDS) -> None:
        """Wait until no other process has its turn with `name`; where files cannot be locked, nobody waits."""
        began = time.monotonic()
        with contextlib.suppress(OSError):
            while not self._locked(folder, name) and time.monotonic() - began < most:
                time.sleep(LOOK)

    def leave(self, folder: Path, name: str) -> None:
        """End one's turn, if one has it."""
        if folder in self._open and lockf is not None:
            with contextlib.suppress(OSError):
                lockf(self._open[folder], LOCK_UN, 1, _byte(name))

    def _locked(self, folder: Path, name: str) -> bool:
        if lockf is None:
            return True
        if folder not in self._open:
            self._open[folder] = os.open(folder / FILE, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        try:
            lockf(self._open[folder], LOCK_EX | LOCK_NB, 1, _byte(name))
        except (BlockingIOError, PermissionError):  # another process has it
            return False
        return True


def _byte(name: str) -> int:
    return zlib.crc32(name.encode()) >> 1
