"""Samples of a run, of whatever robot: one every few ticks and one of the last tick, whatever ends it."""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from ..types import Floats


class Sampled(Protocol):
    """A robot that samples are taken of."""

    ticks: int
    """Since the start."""

    def sample(self) -> Floats:
        """Of now; a new array, shape (columns,)."""


class Samples:
    """What is kept of a run.

    Args:
        robot: Whose.
        every: Ticks between samples.
    """

    def __init__(self, robot: Sampled, every: int) -> None:
        self._robot, self._every = robot, every
        self.told: Callable[[Floats], None] | None = None
        """Is told each sample when the next one is taken; the last one, `last`, may still be taken again."""
        self._rows: list[Floats] = []
        self._kept = -1

    def over(self, tick: Callable[[], None]) -> None:
        """Let a tick pass and take a sample where one is due; that of a tick which ends the run is taken, too."""
        try:
            tick()
        except BaseException:
            self.keep()
            raise
        if self._robot.ticks % self._every == 0:
            self.keep()

    def keep(self) -> None:
        """Take a sample of now, in place of one that there is."""
        row = self._robot.sample()
        if self._kept == self._robot.ticks:
            self._rows[-1] = row
            return
        if self._rows and self.told is not None:
            self.told(self._rows[-1])
        self._kept = self._robot.ticks
        self._rows.append(row)

    def last(self) -> Floats:
        """A sample of now."""
        self.keep()
        return self._rows[-1]

    def table(self) -> Floats:
        """All so far, with one of now, shape (rows, columns)."""
        self.keep()
        return np.array(self._rows)
