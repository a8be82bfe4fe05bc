"""What is told of an error that nobody foresaw: that it is ours, and all that it takes to find it."""

import platform
import shlex
import traceback
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from typing import Final

from .. import __version__
from ..errors import printable

UNEXPECTED: Final = 70
"""Exit code, EX_SOFTWARE of sysexits.h: no answer, and no fault of the user's."""
BESIDE: Final = ("numpy", "numba", "mujoco", "typer")
"""Packages whose versions matter."""


def unexpected(error: BaseException, words: Sequence[str]) -> str:
    """A report of an error to send: what ran, on what, and the traceback.

    Args:
        error: What was raised.
        words: Of the command, after `clamber`.
    """
    last = "".join(traceback.format_exception_only(error)).strip().splitlines()[-1]
    told = [
        f"clamber: unexpected error: {last}",
        "This is a fault of Clamber, not yours. Please send what is below the line, and the files that the command reads.",
        "-" * 80,
        f"clamber {__version__}, Python {platform.python_version()}, {platform.platform()}",
        ", ".join(f"{name} {_version(name)}" for name in BESIDE),
        f"command: clamber {shlex.join(words)}",
        "".join(traceback.format_exception(error)).rstrip(),
    ]
    return printable("\n".join(told))


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "is missing"
