"""Ctrl-C: what is asked to end is asked again until somebody answers, because an exception that is raised in compiled code may be lost."""

import signal
import sys
import threading
import time
from _thread import start_new_thread
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import FrameType, TracebackType
from typing import Any, Final, Self, TypeVar

T = TypeVar("T")

AGAIN: Final = 0.4
"""Whoever has not answered is interrupted again after so long [s]."""
PATIENCE: Final = 1.0
"""How long machine code is waited for that is loaded after Ctrl-C, to tell what there is [s]."""
HEARD: Final = 0.1
"""So often whoever waits looks up: a signal that another thread is given does not wake the main one, which alone hears it, and what that
one hears wakes no other [s]."""
STACK: Final = 16 << 20
"""Of a thread that compiles [B]: half a megabyte, as some systems give to one, is too little for LLVM."""


@dataclass(slots=True)
class _Interrupts:
    """What became of Ctrl-C in this process."""

    asked: bool = False
    """Whether there was one since the command began."""
    open: bool = False
    """Whether the last one has no answer yet."""
    wholes: int = 0
    """Blocks of `passed_on` that are open."""
    listens: bool = False
    """Whether Ctrl-C is raised again until it is answered."""
    calls: set[object] = field(default_factory=set)
    """Of `abandonable`, that have not ended."""


_now: Final = _Interrupts()
_here: Final = threading.local()
"""`works` in the thread of a call of `abandonable`."""


def answer() -> None:
    """Take Ctrl-C as heard; called first by whoever catches it and then ends with what there is.

    Raises:
        KeyboardInterrupt: In a block of `passed_on`, whose owner answers.
    """
    if _now.wholes:
        raise KeyboardInterrupt
    _now.open = False


class Interruptible:
    """A block that Ctrl-C ends, and nothing after it: what follows goes on with what there is. See `answer`."""

    interrupted = False
    """Whether it did."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: object, trace: TracebackType | None) -> bool:
        if kind is None or not issubclass(kind, KeyboardInterrupt):
            return False
        answer()
        self.interrupted = True
        return True


def asked() -> bool:
    """Whether the command was interrupted, whoever answered."""
    return _now.asked


def unanswered() -> bool:
    """Whether the last Ctrl-C has no answer yet: what goes wrong then may come of it, such as an import that broke off."""
    return _now.open


@contextmanager
def passed_on() -> Iterator[None]:
    """A block of which Ctrl-C ends all: parts that by themselves would end with what they have raise it on, and nothing follows them."""
    _now.wholes += 1
    try:
        yield
    finally:
        _now.wholes -= 1


def abandonable(work: Callable[[], T]) -> T:
    """What one long call answers, into compiled code or of the compiler: Ctrl-C cannot stop such a call, but leave it behind in a thread.

    An exception within would be lost in a callback of LLVM's, and leave a kernel without code or Numba with half of what it registers;
    the thread, which gets none, ends the call as if nothing had been. What it works on may not be used any more after Ctrl-C. Outside of
    `listening`, and within such a call, it is called as anything else is.

    Raises:
        KeyboardInterrupt: After Ctrl-C, in whatever thread waits for it.
    """
    if not _now.listens or getattr(_here, "works", False):
        return work()
    answers: list[T] = []
    errors: list[BaseException] = []
    works = (
        threading.Lock()
    )  # an `Event`, as `threading.Thread` waits for, breaks where a signal's handler ends the wait or sets it
    works.acquire()

    def call() -> None:
        _here.works = True
        try:
            answers.append(work())
        except BaseException as error:  # raised where it is waited for
            errors.append(error)
        finally:
            _now.calls.discard(works)
            works.release()

    before = threading.stack_size(STACK)
    try:
        _now.calls.add(works)
        start_new_thread(call, ())
    finally:
        threading.stack_size(before)
    patient = time.monotonic() + PATIENCE if _now.asked else 0.0  # what was left behind may hold Numba's lock
    while not works.acquire(timeout=HEARD):
        if _now.asked and time.monotonic() >= patient:
            raise KeyboardInterrupt
    if errors:
        raise errors[0]
    return answers[0]


def ending() -> bool:
    """Whether a command was interrupted that has not ended yet."""
    return _now.listens and _now.asked


def left_behind() -> bool:
    """Whether a call of `abandonable` still works: Python cannot end beside LLVM, which aborts the process, but the process can."""
    return bool(_now.calls)


@contextmanager
def listening() -> Iterator[None]:
    """A command: Ctrl-C in it is raised every `AGAIN` seconds until it is answered, or the command has ended.

    Where the process ignores Ctrl-C, as in the background of a shell, it stays so.
    """
    _now.asked = _now.open = False
    here = threading.current_thread() is threading.main_thread()
    if (
        not here
        or signal.getsignal(signal.SIGINT) is not signal.default_int_handler
        or not hasattr(signal, "setitimer")
    ):
        yield
        return
    before: dict[int, Any] = {signal.SIGINT: signal.signal(signal.SIGINT, _hear)}
    before[signal.SIGALRM] = signal.signal(signal.SIGALRM, _hear_again)
    told, sys.unraisablehook = sys.unraisablehook, _tell_lost
    _now.listens = True
    try:
        yield
    finally:
        sys.unraisablehook = told
        _now.open = _now.listens = False
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in before.items():
            signal.signal(number, handler)


def _hear(number: int, frame: FrameType | None) -> None:
    _now.asked = _now.open = True
    _hear_again(number, frame)


def _hear_again(number: int, frame: FrameType | None) -> None:
    if not _now.open:
        return
    signal.setitimer(signal.ITIMER_REAL, AGAIN)
    raise KeyboardInterrupt


def _tell_lost(lost: "sys.UnraisableHookArgs") -> None:
    """Tell of an exception that nobody could be given, unless it is an interrupt, which comes again."""
    if not (_now.open and lost.exc_type is not None and issubclass(lost.exc_type, KeyboardInterrupt)):
        sys.__unraisablehook__(lost)
