"""The one way to compile: ``@kernel``, with a disk cache that knows every kernel source.

Numba's own cache looks at the file of the outermost function only, so a change in a function that it calls would leave the old machine
code in use, silently. Here the cache folder is named by a hash of all kernel sources together: edit any of them and everything compiles
again, edit none and nothing does.
"""

import contextlib
import hashlib
import os
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import llvmlite
import numba
import numpy as np
from numba.core import cgutils, types
from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator
from numba.core.types import unliteral
from numba.extending import intrinsic

from .turns import Turns

carray = numba.carray
"""View of the memory at a `pointer` as an array of given shape and type, for kernels; it owns nothing and counts no references."""
F = TypeVar("F", bound=Callable[..., Any])

PACKAGE = Path(__file__).resolve().parent
KERNEL_MARK = re.compile(rb"^\s*(?:from|import)\s+(?:[\w.]*\b(?:compiled|family)|numba)\b", re.MULTILINE)


def kernel_files(package: Path = PACKAGE) -> tuple[Path, ...]:
    """The source files of `package` that decide what is compiled: those that import this module, the family seam, or Numba."""
    return tuple(path for path in sorted(package.rglob("*.py")) if KERNEL_MARK.search(path.read_bytes()))


@cache
def kernel_hash(package: Path = PACKAGE) -> str:
    """Hash of all kernel sources and of the versions that turn them into machine code."""
    digest = hashlib.sha256()
    for version in (sys.version, numba.__version__, llvmlite.__version__, np.__version__):
        digest.update(version.encode())
    for path in kernel_files(package):
        digest.update(str(path.relative_to(package)).encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def cache_root() -> Path:
    """Folder of the compiled kernels: ``$CLAMBER_CACHE``, else the user's cache folder."""
    named = os.environ.get("CLAMBER_CACHE")
    if named:
        return Path(named)
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "clamber"


def cache_folder(package: Path = PACKAGE) -> Path:
    """Where the machine code of the kernels as they are now lies."""
    return cache_root() / f"kernels-{kernel_hash(package)}"


def is_compiled(name: str) -> bool:
    """Whether machine code of the present kernel `name` is on disk, so that using it needs no compiler."""
    return next(iter(cache_folder().glob(f"*.{name}-*.nbc")), None) is not None


class _KernelLocator(_CacheLocator):  # type: ignore[misc]
    """Puts every kernel's machine code into the one folder of `cache_folder`."""

    def __init__(self, py_func: Callable[..., Any], py_file: str) -> None:
        self._lineno = py_func.__code__.co_firstlineno
        self._module = py_func.__module__

    def get_cache_path(self) -> str:
        return str(cache_folder())

    def get_source_stamp(self) -> str:
        return kernel_hash()

    def get_disambiguator(self) -> str:
        return f"{self._module}-{self._lineno}"

    @classmethod
    def from_function(cls, py_func: Callable[..., Any], py_file: str) -> "_KernelLocator | None":
        self = cls(py_func, py_file)
        try:
            self.ensure_cache_path()
        except OSError:
            return None
        return self


class _KernelCacheImpl(CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes = (_KernelLocator,)


class _KernelCache(FunctionCache):  # type: ignore[misc]
    """A kernel's machine code on disk; of several processes that miss it, one compiles it and the others wait for that.

    Numba numbers a kernel's files by what it finds in an index, so two that write the same kernel's code for other types at the same
    time would each take the other's for their own.
    """

    _impl_class = _KernelCacheImpl
    _turns = Turns()

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        found = super().load_overload(sig, target_context)
        if found is None:
            self._turns.take(Path(self.cache_path), self._impl.filename_base)
            found = super().load_overload(sig, target_context)
        return found

    def end_turn(self) -> None:
        """Whatever came of the kernel, others may look for it now."""
        self._turns.leave(Path(self.cache_path), self._impl.filename_base)


def kernel(function: F) -> F:
    """Compile `function` with Numba: cached by the hash of all kernels, without the interpreter's lock, strict IEEE arithmetic.

    Never ``parallel=True`` (slow to compile, and its threading layer aborts a process that enters it from two Python threads): threads
    are a pool over chunks, outside.
    """
    return _compile(function, inline=False)


def inlined(function: F) -> F:
    """A kernel that becomes part of its callers: for small ones, where passing a family's parameters costs more than the work."""
    return _compile(function, inline=True)


def _compile(function: F, *, inline: bool) -> F:
    dispatcher = numba.njit(nogil=True, error_model="numpy", forceinline=inline, no_cfunc_wrapper=True)(function)
    template = dispatcher.get_call_template
    # Numba would compile a kernel anew for every literal number that another kernel calls it with: three times the compile time
    dispatcher.get_call_template = lambda args, kws: template(
        tuple(unliteral(arg) for arg in args), {name: unliteral(arg) for name, arg in kws.items()}
    )
    with contextlib.suppress(RuntimeError):  # nowhere to write: compile at every start rather than fail
        dispatcher._cache = cached = _KernelCache(dispatcher.py_func)
        compile_or_load = dispatcher.compile

        def compile_in_turn(signature: Any) -> Any:
            try:
                return compile_or_load(signature)
            finally:
                cached.end_turn()

        dispatcher.compile = compile_in_turn
    return dispatcher  # type: ignore[no-any-return]


@intrinsic  # type: ignore[untyped-decorator]
def pointer(typing_context: Any, address: types.Type) -> Any:
    """An integer address as a pointer, for kernels. Whoever stores the address keeps the array alive."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(address), generate
