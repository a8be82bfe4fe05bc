"""A line on stderr that follows something long: rewritten on a terminal, a line at once and every ten seconds elsewhere."""

import math
import time
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.live import Live
from rich.text import Text

STEADY = 10.0
"""Where stderr is no terminal, so often there is a line [s]."""


class LiveLine:
    """A `with` block in which `show` tells how far things are."""

    def __init__(self, console: Console, *, quiet: bool) -> None:
        self._console, self._quiet, self._told = console, quiet, -math.inf
        self._live = Live(console=console, refresh_per_second=8, transient=True) if console.is_terminal else None

    def __enter__(self) -> Self:
        if self._live is not None and not self._quiet:
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live is not None and not self._quiet:
            self._live.stop()

    def say(self, words: str) -> None:
        """Tell something that is not to be overwritten, asked for or not."""
        self._console.print(words, soft_wrap=True)

    def show(self, words: str) -> None:
        """Tell this moment, if it is time to."""
        if self._quiet:
            return
        if self._live is not None:
            self._live.update(Text(words, no_wrap=True, overflow="ellipsis"))
        elif time.monotonic() >= self._told + STEADY:
            self._told = time.monotonic()
            self._console.print(words, soft_wrap=True)
