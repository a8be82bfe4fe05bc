"""The scaling law of a batch: how long it takes on any number of cores, from four measured times."""

from dataclasses import dataclass

GOOD = 0.8
"""Efficiency from which a number of cores counts as worth it."""


@dataclass(frozen=True, slots=True)
class ScalingLaw:
    """Time of a batch of equal items: start + items * max(driver, (item + overhead) / cores) + one last item.

    The driver hands out items and stores results one after another: however many cores there are, a batch takes no less
    than that. Cores work side by side otherwise, and the last item ends alone. A bottleneck law: it says nothing of
    contention inside a machine (memory, shared caches), which the measured efficiency of this machine's cores shows.
    """

    start: float
    """From the call until the workers are ready, kernels loaded [s]; once a batch."""
    driver: float
    """Of the driver for each item: hand out, take back, store [s]."""
    overhead: float
    """Of a worker for each item, beside the item itself [s]."""

    def seconds(self, item: float, items: int, cores: int) -> float:
        """Predicted wall-clock time of a batch [s].

        Args:
            item: Time that one item takes on one core [s].
            items: How many there are.
            cores: Workers, each on a core of its own.
        """
        return self.start + items * max(self.driver, (item + self.overhead) / cores) + (item if cores > 1 else 0.0)

    def efficiency(self, item: float, items: int, cores: int) -> float:
        """Share of linear speed-up, the start included: one core's bare work over what all cores were there for [-]."""
        return item * items / (cores * self.seconds(item, items, cores))

    def shortest_item(self, items: int, cores: int, good: float = GOOD) -> float:
        """Least time of an item [s] at which so many cores reach an efficiency; infinite where no item is long enough."""
        low, high = 1e-6, 1e6
        if self.efficiency(high, items, cores) < good:
            return float("inf")
        while high / low > 1.001:
            middle = (low * high) ** 0.5
            low, high = (low, middle) if self.efficiency(middle, items, cores) >= good else (middle, high)
        return high
