"""What `clamber doctor` finds out about the machine and the installation; nothing here changes anything."""

import importlib.metadata
import os
import platform
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from .. import __version__, kernel_cache, sources
from ..extensions import GROUPS, ExtensionError, all_outside, load_outside, outside, package_of
from ..jobs.ahead import usable_cores
from ..jobs.release import version_of
from ..json_form import Count, Key, in_json
from .app import NO_GL

FIRST_KERNEL: Final = "replay"
"""Every command that judges a stance needs it."""
BROWSERS: Final = ("chromium", "chromium-browser", "google-chrome", "chrome")
GL_SECONDS: Final = 20.0
"""A driver that has not answered by then counts as none [s]."""
GL_PROBE: Final = "import mujoco; mujoco.GLContext(16, 16).make_current()"
GL_WAYS: Final = ("egl", "osmesa", "glfw")
_REQUIREMENT: Final = re.compile(r"([A-Za-z0-9._-]+)[^;]*(?:;\s*extra\s*==\s*['\"]([^'\"]+)['\"])?")


@dataclass(frozen=True, slots=True)
class Installed:
    """Clamber itself."""

    version: str
    folder: str


@dataclass(frozen=True, slots=True)
class Python:
    """The interpreter."""

    version: str
    executable: str


@dataclass(frozen=True, slots=True)
class Machine:
    """The machine."""

    system: str
    cores: int | None
    """That this process may use."""
    memory: int | None
    """[bytes]; None where the system does not tell."""
    memory_free: int | None


@dataclass(frozen=True, slots=True)
class Extension:
    """What another package adds."""

    kind: str
    name: str
    package: str
    error: str | None
    """Why it cannot be loaded."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kernels:
    """Compiled kernels."""

    folder: str
    state: Annotated[str, Key(kind=Literal["fine", "damaged", "foreign", "unwritable"])]
    """foreign: others could have written it; what is not fine is not loaded."""
    problem: str | None
    """Why the folder is not used, so that every command compiles anew."""
    damaged: list[str]
    """Files of it."""
    foreign: list[str]
    """Files of it that others could have written."""
    bounds_checked: bool
    """Whether kernels check every index (CLAMBER_BOUNDSCHECK=1)."""
    compiled: bool
    functions: Count
    bytes: Count
    older_folders: Count
    older_bytes: Count


@dataclass(frozen=True, slots=True, kw_only=True)
class Health:
    """What is installed and what is wrong; exit code 1 where something is."""

    clamber: Installed
    python: Python
    machine: Machine
    required: dict[str, str | None]
    """Package to its version; None: missing."""
    optional: dict[str, dict[str, str | None]]
    """Optional part to its packages."""
    extensions: list[Extension]
    kernels: Kernels
    gl: str | None
    """How a picture can be rendered without a screen."""
    ffmpeg: str | None
    chromium: str | None

    @property
    @in_json()
    def problems(self) -> list[str]:
        """What keeps Clamber from working, in sentences; empty where nothing does."""
        missing = [name for name, version in self.required.items() if version is None]
        wrong = [f"{name} is not installed: pip install {name}" for name in missing]
        kernels = self.kernels
        if kernels.problem is not None:
            wrong.append(kernels.problem)
        for names, what in ((kernels.damaged, "is damaged"), (kernels.foreign, "could have been written by others")):
            more = "" if len(names) < 2 else f", and {len(names) - 1} more"
            if names:
                file = Path(kernels.folder) / names[0]
                wrong.append(f"{file} {what}{more}: not loaded, and compiled anew when it is needed; you may remove it")
        return wrong + [each.error for each in self.extensions if each.error is not None]


def examine() -> Health:
    """All of it; sizes in bytes."""
    return Health(
        clamber=Installed(__version__, str(sources.PACKAGE)),
        python=Python(platform.python_version(), sys.executable),
        machine=machine(),
        required=parts(None),
        optional={extra: parts(extra) for extra in extras()},
        extensions=extensions(),
        kernels=kernels(),
        gl=gl(),
        ffmpeg=ffmpeg(),
        chromium=next((path for name in BROWSERS if (path := shutil.which(name))), None),
    )


def extensions() -> list[Extension]:
    """What other packages add, each loaded, with the error where it cannot be."""
    told: list[Extension] = []
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
            told.append(Extension(kind, point.name, package_of(point), error))
    return told


def machine() -> Machine:
    """System, cores that this process may use, and memory."""
    system = f"{platform.system()} {platform.release()} {platform.machine()}"
    return Machine(system, usable_cores(), _memory("SC_PHYS_PAGES"), _memory("SC_AVPHYS_PAGES"))


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


def kernels() -> Kernels:
    """Where the compiled kernels lie, whether those of this version are there, and what older ones take up."""
    root, folder = kernel_cache.cache_root(), kernel_cache.cache_folder()
    older = [path for path in root.glob("kernels-*") if path != folder] if root.is_dir() else []
    problem = kernel_cache.made_problem()
    states = {} if problem is not None else kernel_cache.cache_states(folder)
    return Kernels(
        folder=str(folder),
        state=problem[0] if problem is not None else _worst(states),
        problem=None if problem is None else kernel_cache.advice(problem),
        damaged=states.get("damaged", []),
        foreign=states.get("foreign", []),
        bounds_checked=kernel_cache.bounds_checked(),
        compiled=problem is None and kernel_cache.is_compiled(FIRST_KERNEL),
        functions=sum(1 for _ in folder.glob("*.nbc")),
        bytes=_size(folder),
        older_folders=len(older),
        older_bytes=sum(_size(path) for path in older),
    )


def _worst(states: Mapping[str, list[str]]) -> str:
    return next((state for state in (kernel_cache.FOREIGN, kernel_cache.DAMAGED) if state in states), kernel_cache.FINE)


def _size(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.glob("*") if path.is_file())


def gl(run: Callable[..., Any] = subprocess.run) -> str | None:
    """How a picture can be rendered without a screen: the first of `GL_WAYS` that MuJoCo can open, None if none.

    Each is tried in a process of its own: a broken driver may take its process with it.
    """
    said = os.environ.get("MUJOCO_GL")
    for way in (said,) if said not in (None, "", NO_GL) else GL_WAYS:
        try:
            ended = run(
                [sys.executable, "-c", GL_PROBE],
                env=os.environ | {"MUJOCO_GL": way},
                capture_output=True,
                timeout=GL_SECONDS,
                check=False,
            )
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
