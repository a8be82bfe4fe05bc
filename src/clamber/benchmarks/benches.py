"""The benchmarks by name."""

from collections.abc import Callable
from typing import Final

from .ablation import bench_ablation
from .batches import batch_rows
from .bench import bench_boards
from .climb_speed import climb_rows
from .control_speed import control_rows
from .gaps import bench_gaps
from .hexapod_speed import hexapod_rows
from .planner_trials import Crew
from .plant_bench import plant_rows
from .proofs import bench_exact
from .races import race_rows
from .reductions import filter_rows, macro_rows
from .rows import Row as Row
from .rows import Say, keep_quiet
from .seeds import bench_seeds
from .speed import speed_rows
from .starts import command_rows, start_rows
from .walls import wall_rows


def bench_plan(*, say: Say = keep_quiet) -> list[Row]:
    """Speed of planning, whole: the evaluator, the search beside peers, processes, and what makes searches smaller."""
    parts: tuple[Callable[..., list[Row]], ...] = (speed_rows, race_rows, start_rows, filter_rows, macro_rows)
    return [row for part in parts for row in part(say=say)]


BENCHES: Final[dict[str, Callable[..., list[Row]]]] = {
    "plan": bench_plan,
    "start": command_rows,
    "exact": bench_exact,
    "gaps": bench_gaps,
    "seeds": bench_seeds,
    "ablation": bench_ablation,
    "walls": wall_rows,
    "jobs": batch_rows,
    "boards": bench_boards,
    "control": control_rows,
    "climb": climb_rows,
    "plant": plant_rows,
    "hexapod": hexapod_rows,
}
"""Name -> benchmark; the command line's choices and the tests read it. Each can be called without arguments, or with `say`."""


BATCHED: Final = ("seeds", "ablation", "jobs", "boards", "gaps")
"""Those that are batches of items and take a `crew`; the others measure speed, alone."""


def run_bench(name: str, say: Say = keep_quiet, crew: Crew | None = None) -> list[Row]:
    """Run a benchmark by name; `crew` is for those of `BATCHED`."""
    return BENCHES[name](say=say, **({"crew": crew} if name in BATCHED else {}))
