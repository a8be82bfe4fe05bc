"""How far above the proved optimum the genetic planner's polished plans are, over seeds and boards without hangs."""

from collections.abc import Sequence
from typing import Final

from ..planning.exact.planner import plan_exact
from ..planning.genetic.profile import load_profile
from ..tasks import load_task
from .planner_trials import Crew, run_cases
from .rows import NOTHING, Row, Say, keep_quiet

BOARDS: Final = ("ladder", "modified-ladder", "h", "across", "circle")
OVERRIDES: Final = ("rules.max_hangs=0", "step.length=1in")
SEEDS: Final = tuple(range(20))


def bench_gaps(
    *, boards: Sequence[str] = BOARDS, seeds: Sequence[int] = SEEDS, say: Say = keep_quiet, crew: Crew | None = None
) -> list[Row]:
    """Per board: the optimum, and the mean and largest length of the default profile's plans as parts of it."""
    tasks = {board: load_task(board, OVERRIDES) for board in boards}
    say("genetic plans")
    trials = run_cases({board: (task, load_profile("default")) for board, task in tasks.items()}, seeds, crew)
    rows = []
    for board, task in tasks.items():
        say(f"the optimum of {board}")
        proof = plan_exact(task, threads=1)
        assert proof.status == "optimal", board
        lengths = [length for length in trials[board].lengths if length is not None]
        assert min(lengths, default=proof.length) >= proof.length, board
        parts = [length / proof.length for length in lengths] if len(lengths) == len(seeds) else [NOTHING]
        rows += [
            Row(f"{board}, 1 in, no hangs: proved optimum", proof.length, "actions"),
            Row(f"{board}: polished genetic plans, mean over the optimum, {len(lengths)} of {len(seeds)} found",
                sum(parts) / len(parts), "1"),
            Row(f"{board}: polished genetic plans, longest over the optimum", max(parts), "1", "at most 1.1"),
        ]  # fmt: skip
    return rows
