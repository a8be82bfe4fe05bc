"""What each ingredient of the default profile is worth: the profile with one of them switched off at a time."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, Final

from ..planning.genetic.profile import Profile, load_profile
from ..tasks import load_task
from .planner_trials import Crew, run_cases
from .rows import Row, Say, keep_quiet

SEEDS: Final = range(20)
TASKS: Final[dict[str, tuple[str, tuple[str, ...]]]] = {
    "across without hangs": ("across", ("rules.max_hangs=0",)),
    "circle without hangs": ("circle", ("rules.max_hangs=0",)),
    "h without hangs": ("h", ("rules.max_hangs=0",)),
    "modified-ladder": ("modified-ladder", ()),
}
"""Label -> task and overrides: the tasks that the default profile finds hardest, and the one that needs hangs."""
VARIANTS: Final[dict[str, dict[str, Any]]] = {
    "default": {},
    "no niching": {"niching": 0.0},
    "no fresh tails": {"tail_share": 0.0},
    "no runs": {"run_length": 1},
    "roulette selection": {"selection": "roulette"},
    "no best prefix": {"best_prefix": False},
    "little mutation": {"mutation": 0.05},
    "no fresh starts": {"patience": 0},
    "no configuration filter": {"configuration_filter": False},
    "learned macros": {"learned_macros": True},
    "no polishing": {"polish": 0},
    "no exact windows": {"windows": 0},
    "no beam about the plan": {"beam": 0},
    "no sub-goals": {"subgoals": False},
    "one-point crossover": {"crossover": "one_point"},
    "two-point crossover": {"crossover": "two_point"},
}
"""Name -> what it changes in the profile's search."""


def varied(profile: Profile, changes: Mapping[str, Any]) -> Profile:
    """A profile with some settings of its search changed."""
    return replace(profile, search=replace(profile.search, **changes))


def bench_ablation(
    *,
    seeds: Iterable[int] = SEEDS,
    variants: Iterable[str] = tuple(VARIANTS),
    crew: Crew | None = None,
    say: Say = keep_quiet,
) -> list[Row]:
    """Success, evaluations and lengths of every variant on every task, with the same seeds."""
    default = load_profile("default")
    tasks = {label: load_task(name, overrides) for label, (name, overrides) in TASKS.items()}
    cases = {
        f"{label}, {variant}": (task, varied(default, VARIANTS[variant]))
        for variant in variants
        for label, task in tasks.items()
    }
    chosen = tuple(seeds)
    say(f"{len(cases)} cases with {len(chosen)} seeds each")
    return [row for label, trials in run_cases(cases, chosen, crew).items() for row in trials.rows(label)]
