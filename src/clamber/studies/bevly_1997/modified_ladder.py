"""Section 2.5.2: the modified ladder without rotation of the body and by step length, by exact search in several readings."""

from dataclasses import dataclass
from itertools import product
from typing import Final

from ...families.climber.planning.task import LimbedTask
from ...planning.exact.explore import explore
from ...planning.genetic.planner import plan_genetic
from ...planning.problem.problems import plan_family, pose_problem
from ...types import Ints
from ...units import INCH
from ...viewing.pictures import draw_route
from ..result import Cells, Compared, Figure, StudyResult, Table
from .printed_plans import INFERRED, limbed_task, replay_printed

OWN_HALVES: Final = 'rules.keep=[{limb="right",x_min="9in"},{limb="left",x_max="9in"}]'
"""Legs 1 and 2 keep to their own column of pegs."""
HELD_OFFSET: Final = "rules.offset_while_holding=true"
"""The reach offset of 1 in counts while a leg holds, too, not only when it grabs."""
NO_HANGS: Final = "rules.max_hangs=0"
"""A hang turns the body without a module for it."""
OWN: Final = (OWN_HALVES, HELD_OFFSET, NO_HANGS)
"""The reading that fits all claims of the section."""
WORDS: Final = {OWN_HALVES: "own halves", HELD_OFFSET: "offset while holding", NO_HANGS: "no hangs"}


def reading(rules: tuple[str, ...]) -> str:
    """A set of rules in words."""
    return ", ".join(WORDS[rule] for rule in rules if rule in WORDS) or "free"


MOST_STANCES = 2_000_000


@dataclass(frozen=True, slots=True)
class Exhausted:
    """What a search through the stances came to."""

    codes: Ints | None
    """A shortest plan that reaches the goal; None: there is none, or the search was cut short."""
    closed: bool
    """Whether every stance that can be reached was looked at without meeting the goal: there is no plan."""
    stances: int
    """Different stances looked at."""
    highest: float
    """y of the body's origin where it came furthest [m]."""


def exhaust(task: LimbedTask, *, most: int = MOST_STANCES) -> Exhausted:
    """Search the stances of a task; without hangs (`max_hangs = 0`) they are finitely many.

    Args:
        task: The task; `rules.allowed` may leave out body moves.
        most: Stances after which the search gives up.
    """
    problem = pose_problem(task, threads=1).problem
    seen = explore(problem, most_stances=most)
    highest = float(problem.replay(seen.codes).stances["y"].max())
    return Exhausted(seen.codes if seen.found else None, seen.exhausted, seen.stances, highest)


WITHOUT_TURNS: Final = 'rules.allowed=["+x","-x","+y","-y","release","nearest"]'
"""All but modules 005 and 006."""
READ: Final = (
    "That legs 1 and 2 keep to their own column of pegs and that the offset counts while holding is inferred: "
    "the printed plan of Table 2.3 keeps all three rules, and both claims of the section then hold.",
    "Without hangs there are finitely many stances; all were looked at by the exact planner, with every peg in reach open to every grab.",
)


def rotation_is_needed() -> StudyResult:
    """Search every stance without rotation, in the reading that fits the section."""
    without = exhaust(limbed_task("modified-ladder", (*OWN, WITHOUT_TURNS)))
    with_turns = exhaust(limbed_task("modified-ladder", OWN))
    printed = replay_printed("modified-ladder-ga", OWN).verdict
    proved = without.codes is None and without.closed and with_turns.codes is not None
    return StudyResult(
        claim="Section 2.5.2: without modules 005 and 006 and with a reach offset of 1 in the modified ladder is impossible; "
        "with them the planner finds a plan.",
        verdict="holds" if proved else "differs",
        compared=(
            Compared("plan without rotation", "none, proved" if without.closed else "found"),
            Compared("stances that can be reached without rotation", without.stances),
            Compared("highest body without rotation [in]", without.highest / INCH),
            Compared("actions of a shortest plan with rotation", _length(with_turns.codes)),
            Compared("stances looked at with rotation", with_turns.stances),
            Compared("steps of Table 2.3 that keep these rules", printed.steps, 60),
        ),
        deviations=(
            *INFERRED,
            *READ,
            'If the stance is checked only after a grab (support = "atomic"), a plan exists here too; see no-rotation-free.',
        ),
    )


def rotation_is_not_needed() -> StudyResult:
    """Which of the unsaid rules the claim rests on, and a plan without rotation where they are off."""
    rows: list[Cells] = []
    for support in ("strict", "atomic"):
        for chosen in product(*(((), (rule,)) for rule in (OWN_HALVES, HELD_OFFSET))):
            rules = (*(rule for part in chosen for rule in part), NO_HANGS)
            found = exhaust(limbed_task("modified-ladder", (*rules, WITHOUT_TURNS, f"rules.support={support}")))
            answer = "impossible, proved" if found.closed else "possible"
            rows.append((reading(rules), support, answer, _length(found.codes), found.stances, found.highest / INCH))
    free = limbed_task("modified-ladder", (WITHOUT_TURNS, NO_HANGS))
    result = plan_genetic(free, threads=1)
    checked = result.check()
    hanging = plan_genetic(limbed_task("modified-ladder", (WITHOUT_TURNS, OWN_HALVES, HELD_OFFSET)), threads=1)
    replay = plan_family(free).problem(free).replay(result.plan.codes(free))
    shortest = next(row for row in rows if row[0] == reading((NO_HANGS,)) and row[1] == "strict")
    return StudyResult(
        claim="Section 2.5.2, read literally: no plan for the modified ladder does without rotation, whatever pegs the legs use.",
        verdict="differs" if result.status == "found" and checked.ok else "open",
        compared=(
            Compared("our plan without rotation: status", result.status, "impossible"),
            Compared("our plan without rotation: actions", result.length),
            Compared("our plan without rotation: steps that hold", checked.steps),
            Compared("actions of a shortest plan without rotation", shortest[3]),
            Compared("readings without rotation that have a plan", sum(row[3] is not None for row in rows)),
            Compared("readings tried", len(rows)),
            Compared("own halves and offset while holding, hangs allowed: planner's status", hanging.status),
        ),
        deviations=(
            *INFERRED,
            "Every leg may use every peg, the offset counts only when a leg grabs, and the robot never hangs.",
            "With hangs the stances are not finitely many; there the planner's failure proves nothing.",
        ),
        table=Table(
            ("rules", "support", "without rotation", "shortest plan", "stances", "highest body [in]"), tuple(rows)
        ),
        figures=(
            Figure(
                "route",
                "A plan of ours without rotation: a leg crosses to the other column.",
                lambda path: draw_route(free, replay, path),
            ),
        ),
    )


def _length(codes: Ints | None) -> int | None:
    return None if codes is None else len(codes)


STEPS: Final = (6, 3, 2, 1)
"""Lengths of a body move [in]."""


def vary_step_size() -> StudyResult:
    """Search every stance of the modified ladder, rotation allowed, for each step length and both readings."""
    rows: list[Cells] = []
    lengths: dict[tuple[str, int], int | None] = {}
    for rules in (OWN, (NO_HANGS,)):
        for step in STEPS:
            found = exhaust(limbed_task("modified-ladder", (*rules, f"step.length={step}in")))
            shortest = None if found.codes is None else len(found.codes)
            lengths[reading(rules), step] = shortest
            answer = "impossible, proved" if found.closed else "possible"
            rows.append((reading(rules), step, answer, shortest, found.stances, found.highest / INCH))
    own = reading(OWN)
    held = lengths[own, 6] is None and lengths[own, 1] is not None
    return StudyResult(
        claim="Section 2.5.2: with 6 in for module 3 there is no plan for the modified ladder, with 1 in there is; "
        "smaller steps cost a larger search space.",
        verdict="holds" if held else "differs",
        compared=tuple(
            Compared(
                f"shortest plan, {step} in steps, {reading(rules)} [actions]", lengths[reading(rules), step] or "none"
            )
            for rules in (OWN, (NO_HANGS,))
            for step in STEPS
        )
        + tuple(Compared(f"stances looked at, {row[1]} in steps, {row[0]}", row[4]) for row in rows),
        deviations=(
            *INFERRED,
            "The verdict is for the reading in which section 2.5.2 is consistent (own halves, offset while holding, no hangs).",
            "In the free reading a plan with 6 in steps exists, too: rotation alone then places the body.",
            "In the reading of the verdict 3 in has a plan and 2 in has none: a smaller step is not always a finer choice, "
            "for body heights count in steps from the start at y = 6 in.",
        ),
        table=Table(
            ("rules", "step [in]", "with rotation", "shortest plan", "stances", "highest body [in]"), tuple(rows)
        ),
    )
