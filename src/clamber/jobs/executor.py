"""The seam: where the items of a batch are run. Whoever runs them, a batch looks the same to its store and its user."""

from collections.abc import Generator, Mapping
from dataclasses import dataclass
from typing import Final, Protocol

MOST_TRIES: Final = 3
"""An item whose worker dies is run again by another one, until it was tried so often."""


@dataclass(frozen=True, slots=True)
class End:
    """How the run of one item ended, as a worker tells it: plain data, results as JSON text."""

    key: str
    """Which item."""
    result: str | None
    """JSON text; None if the function raised, or the item's workers died."""
    seconds: float
    """Wall-clock time of the run that ended it [s]."""
    error: str | None
    tries: int
    """Workers that it took."""


class Executor(Protocol):
    """Runs the items of a batch."""

    @property
    def here(self) -> bool:
        """Whether on this machine, where its caller can prepare it."""

    def check(self) -> None:
        """Makes sure that work can start.

        Raises:
            ClamberError: If it cannot; nothing was run then.
        """

    def run(self, name: str, items: Mapping[str, str]) -> Generator[End]:
        """Run a function on every item and give each end as it comes, in any order.

        An exception of the function is an end. An item whose worker dies is tried again, `MOST_TRIES` times in all.
        Closing the iterator stops what is at work.

        Args:
            name: The function, as "module:name".
            items: Key -> item as JSON text.
        """
