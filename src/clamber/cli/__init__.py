"""The command `clamber`: one file or folder per command; they read options, call the package and print what it answers."""

import atexit
import contextlib
import gc
import os
import signal
import sys
from collections.abc import Sequence
from typing import Final

from ..interrupts import answer, asked, left_behind, listening
from ..terminal import loaded, tell_loading

INTERRUPTED: Final = 130
"""Exit code after Ctrl-C: that of a process which SIGINT ends, in shells."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run a command and leave with its exit code; after Ctrl-C with 130, whatever it could still tell.

    Args:
        arguments: Words after `clamber`; None takes those of the process.
    """
    atexit.register(_leave)
    tell_loading(sys.argv[1:] if arguments is None else arguments)
    code: int | str | None = INTERRUPTED
    with listening():
        try:
            from .app import run  # what it imports takes a while, in which there may be a Ctrl-C, too

            code = run(arguments)
        except KeyboardInterrupt:
            pass
        answer()
    loaded()
    if asked() and code in (None, 0, 1, INTERRUPTED):
        print("clamber: interrupted", file=sys.stderr)
        code = INTERRUPTED
    if left_behind():
        with contextlib.suppress(OSError):  # nobody reads any more
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code if isinstance(code, int) else 1)
    sys.exit(code)


def _leave() -> None:
    """Leave to the system what a command that has told all still holds; undoing it would take Python a second."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # there is nothing to end any more
    gc.freeze()
