"""The one way to compile: ``@kernel``, with machine code kept on disk (`kernel_cache`)."""

import contextlib
import itertools
from collections.abc import Callable, Hashable
from functools import partial
from typing import Any, Final, TypeVar

import numba
import numpy as np
from numba.core import cgutils, types
from numba.core.types import unliteral
from numba.extending import NativeValue, intrinsic, models, register_model, unbox

from .interrupts import abandonable
from .kernel_cache import KernelCache, bounds_checked, tell_no_cache

carray = numba.carray
"""View of the memory at a `pointer` as an array of given shape and type, for kernels; it owns nothing and counts no references."""
F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile `function` with Numba: cached by the hash of all kernels, without the interpreter's lock, strict IEEE arithmetic.

    With ``CLAMBER_BOUNDSCHECK=1`` every index into an array is checked and a wrong one raises `IndexError`. A view of memory at a
    `pointer` is checked against the shape that it was given, which nobody checks.

    Never ``parallel=True`` (slow to compile, and its threading layer aborts a process that enters it from two Python threads): threads
    are a pool over chunks, outside.
    """
    return _compile(function, inline=False)


def inlined(function: F) -> F:
    """A kernel that becomes part of its callers: for small ones, where passing a family's parameters costs more than the work."""
    return _compile(function, inline=True)


def _compile(function: F, *, inline: bool) -> F:
    dispatcher = numba.njit(
        nogil=True, error_model="numpy", forceinline=inline, no_cfunc_wrapper=True, boundscheck=bounds_checked()
    )(function)
    template = dispatcher.get_call_template
    # Numba would compile a kernel anew for every literal number that another kernel calls it with: three times the compile time
    dispatcher.get_call_template = lambda args, kws: template(
        tuple(unliteral(arg) for arg in args), {name: unliteral(arg) for name, arg in kws.items()}
    )
    compile_or_load = dispatcher.compile
    cached: KernelCache | None = None
    with contextlib.suppress(RuntimeError):  # no folder for it: compile at every start rather than fail
        dispatcher._cache = cached = KernelCache(dispatcher.py_func)

    def compile_in_turn(signature: Any) -> Any:
        if cached is None:
            tell_no_cache()
            return compile_or_load(signature)
        try:
            return compile_or_load(signature)
        finally:
            cached.end_turn()

    dispatcher.compile = lambda signature: abandonable(partial(compile_in_turn, signature))
    return dispatcher  # type: ignore[no-any-return]


@intrinsic  # type: ignore[untyped-decorator]
def pointer(typing_context: Any, address: types.Type) -> Any:
    """An integer address as a pointer, for kernels. Whoever stores the address keeps the array alive."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(address), generate


class HandleType(types.Type):  # type: ignore[misc]
    """Of a `Handle`, by what it holds."""

    def __init__(self, held: types.Type) -> None:
        super().__init__(f"Handle({held})")
        self.held = held


class Handle:
    """A tuple of arrays, numbers and such tuples that kernels take as one argument, which they open with `opened`.

    Numba looks at every array of a tuple anew in each call, for 0.3 to 0.6 us, and a control tick passes hundreds. A handle is looked at
    once; it keeps what it holds alive, and kernels count no references to that. Numbers are those of when it was made.
    """

    __slots__ = ("_memory", "_numba_type_", "address", "held")

    def __init__(self, *held: Any) -> None:
        self.held: Final = held
        self._memory = np.array(_words(held), np.int64)
        self.address: Final = int(self._memory.ctypes.data)
        form = Handle, _form(held)
        if form not in _types:
            _types[form] = HandleType(_kind(held))
        self._numba_type_ = _types[form]

    def __index__(self) -> int:
        return self.address


def ready(function: Any, *like: Any) -> Callable[..., Any]:
    """What calls a kernel at once, with arguments of the types of those here; handles that come first are these for good.

    Numba looks at the type of each argument at each call, for half a microsecond where it is a handle. Here nobody looks any more, and an
    array of another type or layout would be read as if it were not: for a caller's own arrays, in loops of a dozen calls a tick.
    """
    kinds = tuple(map(_kind, like))
    known = function.overloads.get(kinds)
    handles = tuple(itertools.takewhile(lambda one: isinstance(one, Handle), like))
    call = partial(function.compile(kinds) if known is None else known.entry_point, *(one.address for one in handles))
    vars(call)["handles"] = handles  # or their memory would go
    return call


_types: Final[dict[Hashable, types.Type]] = {}
"""By `_form`: Numba takes a millisecond for the type of fifty arrays."""


def _kind(value: Any) -> types.Type:
    """Numba's type of a value."""
    if isinstance(value, Handle):
        return value._numba_type_
    form = _form(value)
    if form not in _types:
        _types[form] = numba.typeof(value)
    return _types[form]


def _form(value: Any) -> Hashable:
    """What Numba's type of a value depends on."""
    if isinstance(value, np.ndarray):
        flags = value.flags
        return value.dtype, value.ndim, flags.c_contiguous, flags.f_contiguous, flags.aligned, flags.writeable
    return (type(value), *(map(_form, value) if isinstance(value, tuple) else ()))


def _words(value: Any) -> list[int]:
    """A value as Numba's kernels have it in memory: of an array that nobody counts, size, place, shape and strides."""
    if isinstance(value, np.ndarray):
        return [0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides]
    if isinstance(value, tuple):
        return [word for each in value for word in _words(each)]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise TypeError(f"a handle holds arrays, whole and real numbers, not {type(value).__name__}")
    return [int(np.array(value, np.float64).view(np.int64)) if isinstance(value, float) else value]


register_model(HandleType)(models.OpaqueModel)


@unbox(HandleType)  # type: ignore[untyped-decorator]
def _take(kind: HandleType, handle: Any, call: Any) -> NativeValue:
    """The address in a handle, or an address that `ready` took from one, as kernels have it."""
    return NativeValue(call.builder.inttoptr(call.pyapi.number_as_ssize_t(handle), cgutils.voidptr_t))


@intrinsic  # type: ignore[untyped-decorator]
def opened(typing_context: Any, handle: HandleType) -> Any:
    """The tuple that a `Handle` holds, for kernels."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = context.get_value_type(handle.held).as_pointer()
        return builder.load(builder.bitcast(arguments[0], kind))

    return handle.held(handle), generate
