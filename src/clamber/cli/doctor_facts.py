"""What `clamber doctor` finds out about the machine and the installation; nothing here changes anything."""

import importlib.metadata
import os
import platform
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from .. import __version__, kernel_cache, sources
from ..extensions import GROUPS, ExtensionError, all_outside, load_outside, outside, package_of
from ..jobs.cores import usable_cores
from ..jobs.release import version_of
from ..types import Json

FIRST_KERNEL: Final = "replay"
"""Every command that judges a stance needs it."""
BROWSERS: Final = ("chromium", "chromium-browser", "google-chrome", "chrome")
GL_SECONDS: Final = 20.0
"""A driver that has not answered by then counts as none [s]."""
GL_PROBE: Final = "import mujoco; mujoco.GLContext(16, 16).make_current()"
GL_WAYS: Final = ("egl", "osmesa", "glfw")
_REQUIREMENT: Final = re.compile(r"([A-Za-z0-9._-]+)[^;]*(?:;\s*extra\s*==\s*['\"]([^'\"]+)['\"])?")


def facts() -> Json:
    """All of it as plain data; sizes in bytes."""
    return {
        "clamber": {"version": __version__, "folder": str(sources.PACKAGE)},
        "python": {"version": platform.python_version(), "executable": sys.executable},
        "machine": machine(),
        "required": parts(None),
        "optional": {extra: parts(extra) for extra in extras()},
        "extensions": extensions(),
        "kernels": kernels(),
        "gl": gl(),
        "ffmpeg": ffmpeg(),
        "chromium": next((path for name in BROWSERS if (path := shutil.which(name))), None),
    }


def problems(found: Json) -> list[str]:
    """What keeps Clamber from working, in sentences; empty where nothing does."""
    missing = [name for name, version in found["required"].items() if version is None]
    wrong = [f"{name} is not installed: pip install {name}" for name in missing]
    if found["kernels"]["problem"] is not None:
        wrong.append(found["kernels"]["problem"])
    for state, what in (("damaged", "is damaged"), ("foreign", "could have been written by others")):
        names = found["kernels"][state]
        more = "" if len(names) < 2 else f", and {len(names) - 1} more"
        if names:
            file = Path(found["kernels"]["folder"]) / names[0]
            wrong.append(f"{file} {what}{more}: not loaded, and compiled anew when it is needed; you may remove it")
    wrong += [f"{each['error']}" for each in found["extensions"] if each["error"] is not None]
    return wrong


def extensions() -> list[Json]:
    """What other packages add, each loaded, with the error where it cannot be."""
    told: list[Json] = []
    for kind in GROUPS:
        counts = outside(kind)
        for point in all_outside(kind):
            error = None
            if counts[point.name].value != point.value:
                error = f"'{point.name}' of the package {package_of(point)}: another package's thing has the same name"
            else:
                try:
                    load_outside(kind, point.name)
                except ExtensionError as problem:
                    error = str(problem)
            told.append({"kind": kind, "name": point.name, "package": package_of(point), "error": error})
    return told


def machine() -> Json:
    """System, cores that this process may use, and memory."""
    return {
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "cores": usable_cores(),
        "memory": _memory("SC_PHYS_PAGES"),
        "memory_free": _memory("SC_AVPHYS_PAGES"),
    }


def _memory(pages: str) -> int | None:
    try:
        return os.sysconf(pages) * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):  # not every system tells
        return None


def extras() -> tuple[str, ...]:
    """Names of the optional parts."""
    return tuple(sorted({extra for _, extra in _requirements() if extra is not None}))


def parts(extra: str | None) -> dict[str, str | None]:
    """Package -> its installed version, None if it is missing: of one optional part, or what is always needed."""
    return {name: version_of(name) for name, of in _requirements() if of == extra}


def _requirements() -> list[tuple[str, str | None]]:
    """Packages that Clamber names, each with the optional part that it belongs to."""
    try:
        lines = importlib.metadata.requires("clamber") or []
    except importlib.metadata.PackageNotFoundError:  # run from its sources
        return []
    found = (_REQUIREMENT.match(line) for line in lines)
    return [(match[1], match[2]) for match in found if match is not None]


def kernels() -> Json:
    """Where the compiled kernels lie, whether those of this version are there, and what older ones take up."""
    root, folder = kernel_cache.cache_root(), kernel_cache.cache_folder()
    older = [path for path in root.glob("kernels-*") if path != folder] if root.is_dir() else []
    problem = kernel_cache.cache_problem()
    states = {} if problem is not None else kernel_cache.cache_states(folder)
    return {
        "folder": str(folder),
        "state": problem[0] if problem is not None else _worst(states),
        "problem": None if problem is None else kernel_cache.advice(problem),
        "damaged": states.get("damaged", []),
        "foreign": states.get("foreign", []),
        "bounds_checked": kernel_cache.bounds_checked(),
        "compiled": problem is None and kernel_cache.is_compiled(FIRST_KERNEL),
        "functions": sum(1 for _ in folder.glob("*.nbc")),
        "bytes": _size(folder),
        "older_folders": len(older),
        "older_bytes": sum(_size(path) for path in older),
    }


def _worst(states: Mapping[str, list[str]]) -> str:
    return next((state for state in (kernel_cache.FOREIGN, kernel_cache.DAMAGED) if state in states), kernel_cache.FINE)


def _size(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.glob("*") if path.is_file())


def gl(run: Callable[..., Any] = subprocess.run) -> str | None:
    """How a picture can be rendered without a screen: the first of `GL_WAYS` that MuJoCo can open, None if none.

    Each is tried in a process of its own: a broken driver may take its process with it.
    """
    said = os.environ.get("MUJOCO_GL")
    for way in (said,) if said else GL_WAYS:
        try:
            ended = run(
                [sys.executable, "-c", GL_PROBE], env=os.environ | {"MUJOCO_GL": way}, capture_output=True,
                timeout=GL_SECONDS, check=False,
            )  # fmt: skip
        except (OSError, subprocess.TimeoutExpired):
            continue
        if ended.returncode == 0:
            return way
    return None


def ffmpeg() -> str | None:
    """The program that writes MP4, None if there is none: that of `imageio-ffmpeg`."""
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return str(get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        return None
