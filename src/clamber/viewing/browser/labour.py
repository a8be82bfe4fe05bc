"""Work that takes long, beside the page: one piece at a time, in a thread of its own; it can be told to stop."""

import threading
import time
import traceback
from collections.abc import Callable
from typing import Any, Protocol

from ...errors import ClamberError


class StoppedError(Exception):
    """The work was told to stop; raised where it next tells how far it is."""


class Tell(Protocol):
    """Hears how far a piece of work is, and ends it by an error once it is to stop."""

    def __call__(self, words: str, share: float | None = None) -> None:
        """Take words, and a share of the whole where that is known [-].

        Raises:
            StoppedError: If the work is to stop.
        """
        ...


class Labour:
    """One piece of work at a time.

    Args:
        told: Is called with words and the share of the whole, from the work's thread.
    """

    def __init__(self, told: Callable[[str, float | None], None]) -> None:
        self._told, self._stop, self._thread = told, threading.Event(), threading.Thread()
        self._lock = threading.Lock()

    @property
    def busy(self) -> bool:
        """Whether a piece of work is under way."""
        return self._thread.is_alive()

    def begin(self, work: Callable[[Tell], Any], done: Callable[[Any], None], failed: Callable[[str], None]) -> bool:
        """Begin a piece of work; False if another is under way.

        Args:
            work: What is to be done; it is handed what it tells its progress to.
            done: Is called with what it returned.
            failed: Is called in its place with the reason, in words, if the work raised an error or was stopped.
        """
        with self._lock:
            if self.busy:
                return False
            self._stop.clear()
            self._thread = threading.Thread(target=self._do, args=(work, done, failed), name="labour", daemon=True)
            self._thread.start()
            return True

    def stop(self, wait: float = 0.0) -> None:
        """Tell the work to stop, and wait for that for some time at most [s]."""
        self._stop.set()
        if wait > 0.0 and self.busy:
            self._thread.join(timeout=wait)

    def _do(self, work: Callable[[Tell], Any], done: Callable[[Any], None], failed: Callable[[str], None]) -> None:
        began = time.monotonic()

        def tell(words: str, share: float | None = None) -> None:
            if self._stop.is_set():
                raise StoppedError
            self._told(f"{words} ({time.monotonic() - began:.0f} s)", share)

        try:
            done(work(tell))
        except StoppedError:
            failed("stopped")
        except ClamberError as error:
            failed(str(error))
        except Exception as error:  # a mistake of ours must not take the page with it
            traceback.print_exc()
            failed(f"a mistake in Clamber: {type(error).__name__}: {error}")
