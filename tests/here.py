"""Batches without worker processes, of which each takes seconds to start: for tests of what comes of a batch."""

from collections.abc import Generator, Mapping

from clamber.jobs import LocalProcesses
from clamber.jobs.executor import End
from clamber.jobs.worker import find_function, run_item


class Here(LocalProcesses):
    """Runs items in this process, as a worker would."""

    def run(self, name: str, items: Mapping[str, str]) -> Generator[End]:
        for key, item in items.items():
            told = run_item(find_function(name), item)
            yield End(key, told["result"], told["seconds"], told["error"], 1)
