"""A line on stderr that follows something long: what is done, for how long, and about how long it will go on.

On a terminal it is rewritten all the time, elsewhere there is a line at once and one every ten seconds, so that nobody has to guess.
"""

import math
import time
from collections.abc import Callable
from threading import Event, Thread
from types import TracebackType
from typing import Final, Self

from rich.console import Console
from rich.live import Live
from rich.text import Text

from .output import borrow_stderr

STEADY = 10.0
"""Where stderr is no terminal, so often there is a line [s]."""
SOON: Final = 1.0
"""After this long with something done, what is left can be told [s]."""
TURN: Final = "-\\|/"
"""What turns on a terminal while the command works; letters that every terminal has."""


class LiveLine:
    """A `with` block in which `show` tells how far things are.

    Args:
        console: Of stderr.
        quiet: Whether nothing is told but what `say` says.
        doing: What is told until something is shown; empty: nothing.
    """

    def __init__(self, console: Console, *, quiet: bool, doing: str = "") -> None:
        self._console, self._quiet, self._words, self._told = console, quiet, doing, -math.inf
        self._began = self._since = time.monotonic()
        self._first = self._share = 0.0
        self._end: float | None = None  # when it will be done, by what is
        self._fresh = True  # nothing was shown yet
        self._ended = Event()
        self._live = (
            Live(console=console, refresh_per_second=8, transient=True, get_renderable=self._turning)
            if console.is_terminal
            else None
        )

    def __enter__(self) -> Self:
        self._began = self._since = time.monotonic()
        if self._quiet:
            return self
        if self._live is not None:
            self._live.start()
            borrow_stderr(self._console)
        else:
            Thread(target=self._tell_steadily, daemon=True).start()
            self._tell(now=False)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()
        if self._live is not None and not self._quiet:
            borrow_stderr(None)
            self._live.stop()

    def say(self, words: str) -> None:
        """Tell something that is not to be overwritten, asked for or not."""
        self._console.print(words, soft_wrap=not self._console.is_terminal)  # a log's lines stay whole

    def show(self, words: str, share: float | None = None, *, now: bool = False) -> None:
        """Tell this moment, if it is time to.

        Args:
            words: What is done, and how far it is.
            share: Of the work that is done, 0 to 1, where that is known; less than before begins to count anew.
            now: Whether it is time in a log, too.
        """
        moment = time.monotonic()
        if share is None or share < self._share or not self._words:
            self._since, self._first, self._end = moment, share or 0.0, None
        elif share > max(self._share, self._first) and moment >= self._since + SOON:
            self._end = moment + (moment - self._since) * (1.0 - share) / (share - self._first)
        self._words, self._share = words, share or 0.0
        if self._live is None and not self._quiet:
            self._tell(now=now or self._fresh)
        self._fresh = False

    def counting(self, what: str) -> Callable[[int, int], None]:
        """What shows "`what` k of n" as the k-th begins, and counts the time from the first on."""
        return lambda k, n: self.show(f"{what} {k} of {n}", (k - 1) / n if k > 1 else None)

    def begin_from(self, share: float) -> None:
        """Take a share as done before the block, in none of its time."""
        self._first = share

    def _tell(self, *, now: bool) -> None:
        """A line in a log, if it is time to or has to be `now`."""
        moment = time.monotonic()
        if self._words and not self._ended.is_set() and (now or moment >= self._told + STEADY):
            self._told = moment
            self._console.print(self._line(), soft_wrap=True, style="dim")

    def _tell_steadily(self) -> None:
        """Tell in a log that it goes on, where nobody shows anything."""
        while not self._ended.wait(1.0):
            self._tell(now=False)

    def _line(self) -> str:
        """What was shown last, and its times."""
        return self._words + self._times()

    def _times(self) -> str:
        """How long it has taken by now, and what is left."""
        spent = time.monotonic() - self._began
        left = 0.0 if self._end is None else self._end - time.monotonic()
        after = f", {_time(spent)}" if spent >= SOON else ""
        return after + (f", about {_time(left)} left" if left >= SOON else "")

    def _turning(self) -> Text:
        """The same as it stands on a terminal now, in which times have room before words have."""
        times, turn = self._times(), int(4 * (time.monotonic() - self._began)) % len(TURN)
        room = max(0, self._console.width - len(times) - 3)
        return Text(f"{TURN[turn]} {self._words[:room]}{times}", no_wrap=True, overflow="crop")


def _time(seconds: float) -> str:
    """A time as people say it."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"
