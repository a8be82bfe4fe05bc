"""Many seeds of the genetic planner: on every task, with one ingredient off at a time, without filters, with a learned macro."""

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from statistics import median
from typing import Any, Final

from ..files import Document
from ..jobs import LocalProcesses
from ..planning.genetic.learning import Macro
from ..planning.genetic.planner import plan_genetic
from ..planning.genetic.profile import Profile, load_profile
from ..planning.learning import learn_macros
from ..planning.problem.problems import pose_problem
from ..specs import build_spec
from ..tasks import Task, load_task, task_from_document
from ..trials.measured import NOTHING, Crew, Row, Say, keep_quiet, median_or_nothing
from ..types import Json

EVALUATIONS = 50_000
"""Budget of one trial, polishing included."""


@dataclass(frozen=True, slots=True)
class Trials:
    """One entry per seed; None where the budget ran out before a plan was found."""

    evaluations: tuple[int | None, ...]
    """Whole plans evaluated up to the first plan that reaches the goal."""
    first_lengths: tuple[int | None, ...]
    """Actions of that plan."""
    lengths: tuple[int | None, ...]
    """Actions of the plan after polishing."""

    @property
    def found(self) -> int:
        """Seeds that found a plan."""
        return sum(length is not None for length in self.lengths)

    def rows(self, name: str, aim: str | None = None) -> list[Row]:
        """As rows whose names start with `name`."""
        n = len(self.lengths)
        return [
            Row(f"{name}: success of {n} seeds within {EVALUATIONS} evaluations", self.found, "seeds", aim),
            Row(f"{name}: evaluations to success, median", median_or_nothing(self.evaluations), "evaluations"),
            Row(f"{name}: first plan, median length", median_or_nothing(self.first_lengths), "actions"),
            Row(f"{name}: final plan, median length", median_or_nothing(self.lengths), "actions"),
        ]


def run_cases(
    cases: Mapping[str, tuple[Task, Profile]],
    seeds: Iterable[int],
    crew: Crew | None = None,
    *,
    max_evaluations: int = EVALUATIONS,
    filters: bool = True,
    macros: Sequence[Macro] = (),
) -> dict[str, Trials]:
    """Plan every case with every seed, each on one thread, all of them one batch.

    Args:
        cases: Label -> task and profile.
        seeds: The same for every case.
        crew: Who runs them; None: local processes, one a core.
        max_evaluations: Budget of one trial.
        filters: Whether the inventory is filtered.
        macros: Learned modules that it has, too.

    Raises:
        ClamberError: As `Crew.answers`.
    """
    crew = crew or Crew(executor=LocalProcesses(os.cpu_count() or 1))
    chosen = tuple(seeds)
    common: Json = {"evaluations": max_evaluations, "filters": filters, "macros": [asdict(macro) for macro in macros]}
    items: list[Json] = [
        {"document": task.document, "profile": asdict(profile), "seed": seed} | common
        for task, profile in cases.values()
        for seed in chosen
    ]
    title = f"{len(chosen)} seeds each of {', '.join(list(cases)[:3])} ... ({len(cases)} cases)"
    answers = crew.answers(run_trial, items, {"items": items}, title)
    told = [tuple(answer["told"]) for answer in answers]
    rows = [told[k : k + len(chosen)] for k in range(0, len(told), len(chosen))]
    return {label: Trials(*zip(*row, strict=True)) for label, row in zip(cases, rows, strict=True)}


def run_trials(task: Task, profile: Profile, seeds: Iterable[int], **options: Any) -> Trials:
    """Plan one task with every seed; options as in `run_cases`."""
    return run_cases({task.name: (task, profile)}, seeds, **options)[task.name]


def run_trial(item: Json) -> Json:
    """One seed of one case; runs in a worker.

    Args:
        item: `document` of the task, `profile` and `macros` as plain data, `seed`, `evaluations`, `filters`.

    Returns:
        `told`: the three entries of `Trials`.
    """
    result = plan_genetic(
        task_from_document(item["document"]),
        seed=item["seed"],
        profile=build_spec(Profile, Document("profile", item["profile"])),
        max_evaluations=item["evaluations"],
        threads=1,
        filters=item["filters"],
        macros=[build_spec(Macro, Document("macro", macro)) for macro in item["macros"]],
    )
    if result.status != "found":
        return {"told": [None, None, None]}
    return {"told": [result.first_evaluations, result.first_length, result.length]}


SUCCESS_SEEDS: Final = range(20)
SUCCESS_TASKS: Final[dict[str, tuple[str, tuple[str, ...]]]] = {
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
    seeds: Iterable[int] = SUCCESS_SEEDS,
    tasks: Iterable[str] = tuple(SUCCESS_TASKS),
    crew: Crew | None = None,
    say: Say = keep_quiet,
) -> list[Row]:
    """Success, evaluations and lengths of the default profile on every task."""
    profile = load_profile("default")
    chosen = tuple(seeds)
    cases = {
        f"{label}, {hangs}": (load_task(SUCCESS_TASKS[label][0], (*SUCCESS_TASKS[label][1], *rule)), profile)
        for label in tasks
        for hangs, rule in HANGS.items()
    }
    say(f"{len(cases)} cases with {len(chosen)} seeds each")
    done = run_cases(cases, chosen, crew)
    return [row for label, trials in done.items() for row in trials.rows(label, aim=f"{len(chosen)}")]


ABLATION_SEEDS: Final = range(20)
ABLATION_TASKS: Final[dict[str, tuple[str, tuple[str, ...]]]] = {
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
    seeds: Iterable[int] = ABLATION_SEEDS,
    variants: Iterable[str] = tuple(VARIANTS),
    crew: Crew | None = None,
    say: Say = keep_quiet,
) -> list[Row]:
    """Success, evaluations and lengths of every variant on every task, with the same seeds."""
    default = load_profile("default")
    tasks = {label: load_task(name, overrides) for label, (name, overrides) in ABLATION_TASKS.items()}
    cases = {
        f"{label}, {variant}": (task, varied(default, VARIANTS[variant]))
        for variant in variants
        for label, task in tasks.items()
    }
    chosen = tuple(seeds)
    say(f"{len(cases)} cases with {len(chosen)} seeds each")
    return [row for label, trials in run_cases(cases, chosen, crew).items() for row in trials.rows(label)]


FILTER_TASKS: Final = ("ladder", "h")
FILTER_SEEDS: Final = range(10)
FILTER_EVALUATIONS: Final = 200_000
"""Enough for most searches through the unfiltered inventory to end."""
MACRO_SEEDS: Final = range(10)
MACRO_EVALUATIONS: Final = 200_000
TALL: Final = ("board.ladder.rungs=33", "goal.y_min=192in")
"""Three times as many rungs, and a goal as far below the top as on the short ladder."""


def _factor_rows(name: str, before: Trials, after: Trials, what: str) -> list[Row]:
    seeds = len(before.evaluations)
    slow, fast = median_or_nothing(before.evaluations), median_or_nothing(after.evaluations)
    return [
        Row(f"{name}: evaluations to success without {what}, median of {seeds} seeds", slow, "evaluations"),
        Row(f"{name}: evaluations to success with {what}, median of {seeds} seeds", fast, "evaluations"),
        Row(f"{name}: seeds of {seeds} that found a plan without {what}", before.found, "seeds"),
        Row(f"{name}: seeds of {seeds} that found a plan with {what}", after.found, "seeds"),
        Row(f"{name}: times fewer evaluations with {what}", slow / fast, "ratio"),
    ]


def filter_rows(*, seeds: range = FILTER_SEEDS, say: Say = keep_quiet) -> list[Row]:
    """Search with and without the inventory's filters, and the number of sequences D = N^m before and after."""
    profile = varied(load_profile("default"), {"polish": 0})
    rows = []
    for name in FILTER_TASKS:
        task = load_task(name)
        done = {}
        for filters in (False, True):
            say(f"{name}, filters {'on' if filters else 'off'}")
            done[filters] = run_trials(task, profile, seeds, max_evaluations=FILTER_EVALUATIONS, filters=filters)
        rows += _factor_rows(name, done[False], done[True], "filters")
        lengths = [length for length in done[True].first_lengths if length is not None]
        if not lengths:
            rows.append(Row(f"{name}: log10 of the sequences (no plan, so no length)", NOTHING, "log10"))
            continue
        size = pose_problem(task).sized(round(median(lengths)))
        actions = f"plans of {size.length} actions"
        rows += [
            Row(
                f"{name}: sequences D = N^m before filters, {actions}, N = {size.full_size}",
                size.log10_before,
                "log10",
            ),
            Row(
                f"{name}: sequences D = N^m after filters, {actions}, N = {size.modules}",
                size.log10_after,
                "log10",
            ),
        ]
    return rows


def macro_rows(*, seeds: range = MACRO_SEEDS, say: Say = keep_quiet) -> list[Row]:
    """A macro learned on the ladder, used on one three times as tall."""
    say("learning a macro on the ladder")
    lesson = learn_macros(load_task("ladder"))
    name = "ladder three times as tall"
    if not lesson.macros:
        return [Row(f"{name}: times fewer evaluations with a learned macro (none was learned)", NOTHING, "ratio")]
    tall = load_task("ladder", TALL)
    profile = varied(load_profile("default"), {"polish": 0})
    done = {}
    for macros in ((), lesson.macros):
        say(f"{name}, {len(macros)} macros")
        done[len(macros)] = run_trials(tall, profile, seeds, max_evaluations=MACRO_EVALUATIONS, macros=macros)
    return [
        Row("learning the macro: evaluations, on the short ladder", lesson.evaluations, "evaluations"),
        Row("learning the macro: actions of the macro", len(lesson.macros[0].codes), "actions"),
        *_factor_rows(name, done[0], done[len(lesson.macros)], "the macro"),
    ]
