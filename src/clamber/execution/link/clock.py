"""Time as a server of plants has it, and how well it keeps it."""

import select
import socket
import time
from collections import deque
from typing import Final, Protocol

import numpy as np

MOST_TICKS: Final = 20_000
"""Whose lateness is kept."""
WATCHED_TICKS: Final = 100
"""Among which overruns are counted."""
MOST_OVERRUNS: Final = 20
"""Of the watched ticks may overrun; a busy machine's 99th percentile of lateness is a period (`clamber bench plant`)."""


class Clock(Protocol):
    """Time as a server has it."""

    def now(self) -> float:
        """[s], from anywhere."""

    def select(self, sockets: list[socket.socket], timeout: float | None) -> list[socket.socket]:
        """Those of `sockets` that can be read, after waiting for one for at most `timeout` [s]; None: for ever."""


class WallClock:
    """The machine's."""

    def now(self) -> float:
        """See `Clock`."""
        return time.monotonic()

    def select(self, sockets: list[socket.socket], timeout: float | None) -> list[socket.socket]:
        """See `Clock`."""
        return select.select(sockets, [], [], timeout)[0]


class Lateness:
    """How late the ticks of a clock begin.

    Args:
        period: Of the ticks, by the clock; a tick that begins later than this overruns [s].
    """

    def __init__(self, period: float) -> None:
        self.period = period
        self._late: deque[float] = deque(maxlen=MOST_TICKS)
        self._overran: deque[bool] = deque(maxlen=WATCHED_TICKS)

    def note(self, late: float) -> None:
        """Count a tick that began so late [s]."""
        self._late.append(late)
        self._overran.append(late > self.period)

    def forget_overruns(self) -> None:
        """Begin anew to count them."""
        self._overran.clear()

    def problem(self) -> str | None:
        """Why the clock does not count as kept, or None."""
        overruns = sum(self._overran)
        if overruns <= MOST_OVERRUNS:
            return None
        return f"{overruns} of the last {len(self._overran)} ticks began a period late or more"

    def summary(self) -> str | None:
        """Of all ticks since the last summary; None if there were none."""
        if not self._late:
            return None
        late = np.array(self._late)
        self._late.clear()
        middle, most = 1e3 * np.quantile(late, (0.5, 0.99))
        return (
            f"the last {len(late)} ticks began {middle:.2f} ms late in the median, 99 % within {most:.2f} ms; "
            f"{np.count_nonzero(late > self.period)} were a period late or more"
        )
