"""What commands share: options, output, progress, names; and the line that stands in a terminal while they are loaded."""

import sys
import time
from collections.abc import Sequence
from threading import Event, Lock, Thread
from typing import Final

SOON: Final = 1.0
"""Whoever waits for so long is told what for [s]: a disk that has not been read for a while takes ten times as long."""
_loaded: Final = Event()
_loaded.set()
_writing: Final = Lock()


def tell_loading(words: Sequence[str]) -> None:
    """Tells in a terminal that a command is loaded, and for how long, from a second after the start on until it says something itself."""
    if sys.stderr.isatty() and not {"-q", "--quiet"} & set(words):
        _loaded.clear()
        Thread(target=_tell, args=(time.monotonic(),), daemon=True).start()


def _tell(began: float) -> None:
    while not _loaded.wait(SOON):
        with _writing:
            if not _loaded.is_set():
                sys.stderr.write(f"loading, {time.monotonic() - began:.0f} s\r")
                sys.stderr.flush()


def loaded() -> None:
    """Take that line away; called before anything else is written."""
    with _writing:
        if not _loaded.is_set():
            _loaded.set()
            sys.stderr.write(" " * 40 + "\r")
            sys.stderr.flush()
