"""Section 2.2.2: a module of a higher level, "climb up one step", learned from a plan; and what a search with such modules alone loses."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from ...benchmarks.planner_trials import TALL, run_trials, varied
from ...families.climber.planning.task import LimbedTask
from ...planning.genetic.learning import Macro
from ...planning.genetic.profile import load_profile
from ...planning.learning import learn_macros
from ...planning.problem.problem import CompiledProblem, Records
from ...planning.problem.problems import pose_problem
from ...types import Ints
from ...units import INCH
from ..result import Cells, Compared, StudyResult, Table, Verdict
from .modified_ladder import NO_HANGS, exhaust
from .printed_plans import INFERRED, limbed_task
from .search_variants import WEIGHTS, median_evaluations

SEEDS: Final = range(100, 110)
"""Of the plans of the tall ladder."""
LESSONS: Final = range(100, 112)
"""Of the plans that modules are learned from."""
BUDGET: Final = 200_000
"""Most plans one seed evaluates."""
RUNG: Final = 6.0
"""Distance of two rungs [in]."""
ALMOST_ALL: Final = 0.9
"""Share of the seeds in which the module has to save evaluations."""
KEPT: Final = 12
"""Most modules that the search with modules alone is given."""
STEP: Final = "step.length=3in"
"""The ladder's own step, in which modules are learned."""
TIMES: Final = 100
"""Most goes of a module in a row."""
MOST: Final = 20_000
"""Stances after which a search with modules alone gives up."""


def judge_learning(leads: bool, saved: int, seeds: int) -> Verdict:
    """The verdict on a learned module.

    It holds if the module, done again and again, climbs the ladder by itself and the tall ladder takes fewer evaluations with it in almost
    all seeds; it differs if it does not climb by itself, or saves evaluations in no more than half of the seeds.
    """
    if not leads or saved <= seeds / 2:
        return "differs"
    return "holds" if saved >= ALMOST_ALL * seeds else "open"


def judge_modules_alone(ladder: bool, modified: bool | None, by_actions: bool) -> Verdict:
    """The verdict on modules alone, from whether they climb the ladder, and the modified one (None: cut short), and whether actions do.

    It holds if they climb the ladder and no sequence of them the modified one, which single actions of the same step do climb; it differs
    if a sequence of them does.
    """
    if modified:
        return "differs"
    return "holds" if ladder and modified is False and by_actions else "open"


def learn_to_climb() -> StudyResult:
    """A module learned on the ladder, and plans of a ladder three times as tall with it and without."""
    profile, ladder = load_profile("thesis"), limbed_task("ladder")
    lesson = learn_macros(ladder, seeds=LESSONS, profile=profile, max_evaluations=BUDGET)
    tall = limbed_task("ladder", TALL)
    plain, helped = (
        run_trials(tall, varied(profile, {"polish": 0}), SEEDS, max_evaluations=BUDGET, macros=macros)
        for macros in ((), lesson.macros)
    )
    pairs = list(zip(plain.evaluations, helped.evaluations, strict=True))
    saved = sum(b is not None and (a is None or b < a) for a, b in pairs)
    macro = lesson.macros[0] if lesson.macros else None
    met = macro is not None and climbs(pose_problem(ladder, threads=1).problem, (macro,)) is True
    alone = {} if macro is None else {name: _highest(task, macro) for name, task in (("short", ladder), ("tall", tall))}
    return StudyResult(
        claim='Section 2.2.2: a repeated sequence can be one module of a higher level, "climb up one step"; the planner can learn it, and '
        "with it in the inventory the search is smaller.",
        verdict=judge_learning(met, saved, len(SEEDS)),
        compared=(
            Compared("the module learned on the ladder: actions", None if macro is None else len(macro.codes)),
            Compared("rungs that it climbs in one go", None if macro is None else macro.gain / (RUNG * INCH)),
            Compared(
                "times in a row that it works from the ladder's start", None if macro is None else macro.from_start
            ),
            Compared("the module alone, again and again, climbs the ladder", "yes" if met else "no"),
            Compared("highest body by the module alone, goal at 60 in [in]", None if macro is None else alone["short"]),
            Compared(
                "the same on the ladder three times as tall, goal at 192 in [in]",
                None if macro is None else alone["tall"],
            ),
            Compared("evaluated plans until it was learned", lesson.evaluations),
            Compared(f"ladder three times as tall: seeds of {len(SEEDS)} that find a plan without it", plain.found),
            Compared(f"ladder three times as tall: seeds of {len(SEEDS)} that find a plan with it", helped.found),
            Compared("evaluations without it, median", median_evaluations(plain)),
            Compared("evaluations with it, median", median_evaluations(helped)),
            Compared(f"seeds of {len(SEEDS)} in which it saves evaluations", saved),
        ),
        deviations=(
            *INFERRED,
            WEIGHTS,
            "How modules were learned is not printed (the thesis refers to Farritor 1997). Ours looks for a window of a plan that works "
            "from several of its stances, and as far as it leads from the task's start.",
            f"The tall ladder has 33 rungs, its goal at 192 in; {BUDGET} evaluations a seed at most. Holds if the module climbs the ladder "
            f"by itself and saves evaluations in {ALMOST_ALL:.0%} of the seeds or more; differs if it does not climb, or saves in no more "
            "than half; the rule was fixed before the seeds were run.",
            "A module names pegs by how near they are. At a ladder's top, where there are none above, others are the nearest, so that it "
            "stops there, however far it has climbed.",
        ),
        seeds=SEEDS,
        table=Table(
            ("seed", "evaluations without the module", "evaluations with it"),
            tuple((seed, a, b) for seed, (a, b) in zip(SEEDS, pairs, strict=True)),
        ),
    )


def plan_with_modules_alone() -> StudyResult:
    """Every sequence of learned modules on the ladder and on the modified ladder, beside single actions of the same step."""
    ladder, modified = limbed_task("ladder"), limbed_task("modified-ladder", (NO_HANGS, STEP))
    lesson = learn_macros(ladder, seeds=LESSONS, profile="thesis", max_evaluations=BUDGET, most=KEPT)
    on_ladder, on_modified = (
        climbs(pose_problem(task, threads=1).problem, lesson.macros) for task in (ladder, modified)
    )
    actions = exhaust(modified)
    words: dict[bool | None, str] = {True: "yes", False: "no, every sequence looked at", None: "cut short"}
    rows: tuple[Cells, ...] = tuple(
        (macro.name, len(macro.codes), macro.gain / INCH, macro.from_start) for macro in lesson.macros
    )
    return StudyResult(
        claim="Section 2.5.2: where only modules of a high level are used a solution may be lost, as the robot's full capabilities are "
        "not.",
        verdict=judge_modules_alone(on_ladder is True, on_modified, actions.codes is not None),
        compared=(
            Compared("modules learned on the ladder", len(lesson.macros)),
            Compared("they alone climb the ladder", words[on_ladder]),
            Compared("they alone climb the modified ladder", words[on_modified]),
            Compared(
                "shortest plan of single actions there, the same step [actions]",
                None if actions.codes is None else len(actions.codes),
            ),
        ),
        deviations=(
            *INFERRED,
            "Which modules of a high level there might be is not printed: ours are learned from one plan of the ladder, the best "
            f"{KEPT} at most. Others could be thought of that pass the missing pegs.",
            "The modified ladder is taken with the ladder's step of 3 in and without hangs. Holds if the modules climb the ladder, no "
            "sequence of them the modified ladder, and single actions do; the rule was fixed before they were tried.",
        ),
        seeds=LESSONS,
        table=Table(("module", "actions", "gain [in]", "times in a row from the start"), rows),
    )


def _highest(task: LimbedTask, macro: Macro) -> float:
    """Highest body of a module done again and again from the task's start until it cannot be done [in]."""
    problem = pose_problem(task, threads=1).problem
    codes: Ints = np.tile(np.array(macro.codes, np.int32), TIMES)
    return float(problem.replay(codes).stances["y"].max()) / INCH


def climbs(problem: CompiledProblem, macros: Sequence[Macro]) -> bool | None:
    """Whether some sequence of modules leads from the start to the goal; None if there are too many stances to say."""
    seen, ends = {_key(problem.start)}, [problem.start]
    while ends and len(seen) <= MOST:
        found: list[Records] = []
        for start in ends:
            here = problem.rebind(problem.actions, start)
            for macro in macros:
                codes: Ints = np.array(macro.codes, np.int32)
                replay = here.replay(codes)
                stages = replay.stances["stage"]
                if (stages >= problem.goals).any():
                    return True
                end = replay.stances[-1:]
                if replay.ok and _key(end) not in seen:
                    seen.add(_key(end))
                    found.append(end.copy())
        ends = found
    return None if ends else False


def _key(stance: Records) -> tuple[bytes, ...]:
    """What the future of a stance depends on: holds, the limb in use, goals met, and places to a nanometre."""
    whole = (stance[name].tobytes() for name in ("hold", "left", "branch", "in_use", "hangs", "stage", "laps"))
    places = (np.round(stance[name], 9).tobytes() for name in ("x", "y", "angle", "foot"))
    return (*whole, *places)
