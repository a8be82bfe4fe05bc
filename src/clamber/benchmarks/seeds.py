"""How surely the default profile finds plans: many seeds of every task of the thesis, with and without hangs."""

from collections.abc import Iterable
from typing import Final

from ..planning.genetic.profile import load_profile
from ..tasks import load_task
from .planner_trials import Crew, run_cases
from .rows import Row, Say, keep_quiet

SEEDS: Final = range(20)
TASKS: Final[dict[str, tuple[str, tuple[str, ...]]]] = {
    "ladder, 3 in": ("ladder", ()),
    "ladder, 1 in": ("ladder", ("step.length=1in",)),
    "modified-ladder": ("modified-ladder", ()),
    "h": ("h", ()),
    "h, 1500 oz-in": ("h", ("motor.torque_limit=1500ozin",)),
    "across": ("across", ()),
    "circle": ("circle", ()),
}
"""Label -> task and overrides."""
HANGS: Final[dict[str, tuple[str, ...]]] = {"hangs allowed": (), "no hangs": ("rules.max_hangs=0",)}


def bench_seeds(
    *,
    seeds: Iterable[int] = SEEDS,
    tasks: Iterable[str] = tuple(TASKS),
    crew: Crew | None = None,
    say: Say = keep_quiet,
) -> list[Row]:
    """Success, evaluations and lengths of the default profile on every task."""
    profile = load_profile("default")
    chosen = tuple(seeds)
    cases = {
        f"{label}, {hangs}": (load_task(TASKS[label][0], (*TASKS[label][1], *rule)), profile)
        for label in tasks
        for hangs, rule in HANGS.items()
    }
    say(f"{len(cases)} cases with {len(chosen)} seeds each")
    done = run_cases(cases, chosen, crew)
    return [row for label, trials in done.items() for row in trials.rows(label, aim=f"{len(chosen)}")]
