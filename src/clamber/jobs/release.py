"""What must be the same wherever and whenever the items of one batch run, so that they give the same numbers."""

import platform
from functools import cache
from typing import Final

from .. import __version__
from ..sources import package_hash
from ..types import Json

COMPUTE: Final = ("numpy", "numba", "llvmlite", "mujoco")
"""Packages whose version may change a number."""


@cache
def release() -> Json:
    """Clamber's version, the hash of all its files, and the versions of Python and of what it computes with."""
    return {
        "clamber": __version__,
        "files": package_hash()[:16],
        "python": platform.python_version(),
        **{name: version_of(name) for name in COMPUTE},
    }


def difference(mine: Json, theirs: Json) -> str:
    """What differs between two releases, as errors name it."""
    return ", ".join(
        f"{name} {theirs.get(name)}, not {mine.get(name)}"
        for name in dict.fromkeys((*mine, *theirs))
        if mine.get(name) != theirs.get(name)
    )


def version_of(name: str) -> str | None:
    """Of an installed package; None if it is missing."""
    import importlib.metadata  # takes longer than the rest of this file

    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None
