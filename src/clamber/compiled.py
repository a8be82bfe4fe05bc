"""The one way to compile: ``@kernel``, with machine code kept on disk (`kernel_cache`)."""

import contextlib
from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.core import cgutils, types
from numba.core.types import unliteral
from numba.extending import intrinsic

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

    dispatcher.compile = compile_in_turn
    return dispatcher  # type: ignore[no-any-return]


@intrinsic  # type: ignore[untyped-decorator]
def pointer(typing_context: Any, address: types.Type) -> Any:
    """An integer address as a pointer, for kernels. Whoever stores the address keeps the array alive."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(address), generate
