"""Machine code of the kernels on disk, in a folder that is named by all that it was made of and that nobody else can write.

Numba's own cache looks at the file of the outermost function only, so a change in a function that it calls, or in a constant of another
file, would leave the old machine code in use, silently. It also loads pickles from wherever it is told, and one that is damaged ends the
process. Here a file is loaded only if it is whole and this user's own; else the kernel is compiled anew.
"""

import contextlib
import hashlib
import os
import pickle
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

import llvmlite
import numba
import numpy as np
from numba.core import types
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile, _CacheLocator

from .interrupts import ending
from .sealed import DAMAGED as DAMAGED
from .sealed import FOREIGN as FOREIGN
from .sealed import SealError, access_problem, read_sealed, write_sealed
from .sources import PACKAGE, kernel_sources_hash, outside_hash, package_hash
from .turns import Turns

FINE: Final = "fine"
UNWRITABLE: Final = "unwritable"
TOLD: Final = "CLAMBER_CACHE_TOLD"
"""Set in the environment once it was said that there is no cache, so that workers do not say it again."""


@dataclass(frozen=True, slots=True)
class Use:
    """A use of kernels that takes long to compile."""

    function: str
    """Uses each of them once, as "module:name"."""
    kernel: str
    """The one of them that takes longest."""


def bounds_checked() -> bool:
    """Whether kernels are compiled with every index checked: ``CLAMBER_BOUNDSCHECK=1`` (or Numba's own) is in the environment."""
    return os.environ.get("CLAMBER_BOUNDSCHECK", "") not in ("", "0") or bool(numba.config.BOUNDSCHECK)


@cache
def kernel_hash(package: Path = PACKAGE) -> str:
    """Hash of all that kernels are made of, and of what turns it into machine code."""
    digest = hashlib.sha256(f"bounds checked: {bounds_checked()}".encode())
    for version in (sys.version, numba.__version__, llvmlite.__version__, np.__version__):
        digest.update(version.encode())
    digest.update(_known_sources_hash(package).encode())
    return digest.hexdigest()[:16]


def _known_sources_hash(package: Path) -> str:
    """`kernel_sources_hash`, which takes a second, from a note of an earlier process about the same files."""
    note = cache_root() / "sources" / package_hash(package)[:32]
    if folder_problem(cache_root()) is not None:
        return kernel_sources_hash(package)
    with contextlib.suppress(OSError, SealError):
        return read_sealed(note).decode()
    found = kernel_sources_hash(package)
    with contextlib.suppress(OSError):
        _make(note.parent)
        write_sealed(note, found.encode())
    return found


def cache_root() -> Path:
    """Folder of the compiled kernels: ``$CLAMBER_CACHE``, else the user's cache folder."""
    named = os.environ.get("CLAMBER_CACHE")
    if named:
        return Path(named)
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "clamber"


def _make(folder: Path) -> None:
    """Make a folder of the cache, and the cache's own, so that others can't write there whatever the umask."""
    cache_root().parent.mkdir(parents=True, exist_ok=True)
    cache_root().mkdir(mode=0o755, exist_ok=True)
    folder.mkdir(mode=0o755, exist_ok=True)


def cache_folder(package: Path = PACKAGE) -> Path:
    """Where the machine code of the kernels as they are now lies."""
    return cache_root() / f"kernels-{kernel_hash(package)}"


def is_compiled(name: str) -> bool:
    """Whether machine code of the present kernel `name` is on disk, so that using it needs no compiler."""
    return next(iter(cache_folder().glob(f"*.{name}-*.nbc")), None) is not None


def folder_problem(folder: Path) -> tuple[str, str] | None:
    """Why a folder is not used for machine code, as a state (`FOREIGN`, `UNWRITABLE`) and in words; None where it is, or can be made."""
    try:
        facts = folder.stat()
    except FileNotFoundError:
        above = next((path for path in folder.absolute().parents if path.exists()), None)
        if above is not None and above.is_dir() and os.access(above, os.W_OK | os.X_OK):
            return None
        return UNWRITABLE, f"{folder} cannot be made"
    except OSError as error:
        return UNWRITABLE, f"{folder} cannot be used ({error.strerror})"
    if not folder.is_dir():
        return UNWRITABLE, f"{folder} is no folder"
    if (problem := access_problem(facts)) is not None:
        return FOREIGN, f"{folder} {problem}"
    return None if os.access(folder, os.W_OK | os.X_OK) else (UNWRITABLE, f"{folder} cannot be written")


def cache_problem() -> tuple[str, str] | None:
    """Why there is no cache of machine code, as a state and in words; None where there is one."""
    return folder_problem(cache_root()) or folder_problem(cache_folder())


def cache_states(folder: Path) -> dict[str, list[str]]:
    """State (`FINE`, `DAMAGED`, `FOREIGN`) -> names of a folder's files in it; those that it lacks are left out."""
    found: dict[str, list[str]] = {}
    for path in sorted(path for path in folder.glob("*.nb[ci]")):
        state = FINE
        try:
            read_sealed(path)
        except SealError as error:
            state = error.state
        except OSError:
            state = FOREIGN
        found.setdefault(state, []).append(path.name)
    return found


def advice(problem: tuple[str, str]) -> str:
    """What comes of a folder that is not used, and what to do, in one line."""
    repair = "; take others' right to write (chmod go-w), or" if problem[0] == FOREIGN else ":"
    return f"{problem[1]}, so kernels are compiled anew by every command{repair} name another folder in CLAMBER_CACHE"


def tell_no_cache() -> None:
    """Say on standard error, once, if kernels are compiled anew each time."""
    problem = _problem_at_start()
    if problem is not None and not os.environ.get(TOLD):
        os.environ[TOLD] = "1"
        print(f"clamber: {advice(problem)}", file=sys.stderr)


@cache
def _problem_at_start() -> tuple[str, str] | None:
    """`made_problem` when the first kernel was met."""
    return made_problem()


def made_problem() -> tuple[str, str] | None:
    """`cache_problem`, with the folder made where there is none."""
    problem = cache_problem()
    if problem is None:
        try:
            _make(cache_folder())
        except OSError as error:
            return UNWRITABLE, f"{cache_folder()} cannot be made ({error.strerror})"
        problem = cache_problem()
    return problem


_outside_types: Final[dict[Any, Path]] = {}
"""Record type -> a file with kernels of another package that are chosen by it."""


def made_outside(kind: Any, kernels: Iterable[Any]) -> None:
    """Take note of a record type by which kernels are chosen: machine code for it is made of their sources, too, wherever they stand."""
    for each in kernels:
        file = Path(each.py_func.__code__.co_filename)
        if PACKAGE not in file.parents:
            _outside_types[kind] = file


class _KernelLocator(_CacheLocator):  # type: ignore[misc]
    """Puts every kernel's machine code into the one folder of `cache_folder`."""

    def __init__(self, py_func: Callable[..., Any], py_file: str) -> None:
        self._lineno = py_func.__code__.co_firstlineno
        self._module = py_func.__module__

    def get_cache_path(self) -> str:
        return str(cache_folder())

    def ensure_cache_path(self) -> None:
        """Nothing: the folder was looked at with the first kernel."""

    def get_source_stamp(self) -> str:
        return kernel_hash()

    def get_disambiguator(self) -> str:
        return f"{self._module}-{self._lineno}"

    @classmethod
    def from_function(cls, py_func: Callable[..., Any], py_file: str) -> "_KernelLocator | None":
        return None if _problem_at_start() is not None else cls(py_func, py_file)


class _KernelCacheImpl(CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes = (_KernelLocator,)


class _KernelCacheFile(IndexDataCacheFile):  # type: ignore[misc]
    """Numba's index and data of one kernel in sealed files; one that is damaged or foreign counts as none, and is replaced."""

    def _load_index(self) -> dict[Any, str]:
        loaded = self._load(self._index_path)
        if loaded is None:
            return {}
        stamp, overloads = loaded
        return overloads if stamp == self._source_stamp else {}

    def _save_index(self, overloads: dict[Any, str]) -> None:
        write_sealed(Path(self._index_path), self._dump((self._source_stamp, overloads)))

    def _load_data(self, name: str) -> Any:
        return self._load(self._data_path(name))

    def _save_data(self, name: str, data: Any) -> None:
        write_sealed(Path(self._data_path(name)), self._dump(data))

    @staticmethod
    def _load(path: str) -> Any:
        try:
            return pickle.loads(read_sealed(Path(path)))
        except (OSError, SealError):
            return None


def _record_of(kind: Any) -> Any:
    """The element type of an array, or the type itself."""
    return kind.dtype if isinstance(kind, types.Array) else kind


class KernelCache(FunctionCache):  # type: ignore[misc]
    """A kernel's machine code on disk; of several processes that miss it, one compiles it and the others wait for that.

    Numba numbers a kernel's files by what it finds in an index, so two that write the same kernel's code for other types at the same
    time would each take the other's for their own.
    """

    _impl_class = _KernelCacheImpl
    _turns = Turns()

    def __init__(self, py_func: Callable[..., Any]) -> None:
        """Raises `RuntimeError` where there is no folder for it."""
        super().__init__(py_func)
        self._cache_file = _KernelCacheFile(self._cache_path, self._impl.filename_base, kernel_hash())

    def _index_key(self, sig: Any, codegen: Any) -> tuple[Any, ...]:
        """Numba's key, and the sources of other packages that the machine code is made of."""
        files = {_outside_types[kind] for kind in map(_record_of, getattr(sig, "args", sig)) if kind in _outside_types}
        own = Path(self._py_func.__code__.co_filename)
        if PACKAGE not in own.parents:
            files.add(own)
        return (*super()._index_key(sig, codegen), *sorted(map(outside_hash, files)))

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The machine code for some types, or None; then it is this process's turn to compile it.

        Raises:
            KeyboardInterrupt: If it would have to be compiled after Ctrl-C: that takes longer than anybody waits then.
        """
        found = super().load_overload(sig, target_context)
        if found is None:
            if ending():
                raise KeyboardInterrupt
            self._turns.take(Path(self.cache_path), self._impl.filename_base)
            found = super().load_overload(sig, target_context)
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the machine code for some types."""
        with contextlib.suppress(OSError):  # a full disk, or a folder that is gone: the kernel works all the same
            super().save_overload(sig, data)

    def end_turn(self) -> None:
        """Whatever came of the kernel, others may look for it now."""
        self._turns.leave(Path(self.cache_path), self._impl.filename_base)
