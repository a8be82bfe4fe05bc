"""Section 2.5.2: without rotation of the body the modified ladder is said to be impossible."""

from itertools import product
from pathlib import Path
from typing import Final

from ...planning.genetic.planner import plan_genetic
from ...planning.problem.problems import plan_family
from ...types import Ints
from ...units import INCH
from ..exhaust import exhaust
from ..result import Compared, Figure, StudyResult, Table, Value
from . import PAPER
from .modified_ladder import HELD_OFFSET, NO_HANGS, OWN, OWN_HALVES, reading
from .replayed import INFERRED, limbed_task, replay_printed

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
        paper=PAPER,
        result="no-rotation",
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
    rows: list[tuple[Value, ...]] = []
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

    def route(path: Path) -> None:
        from ...viewing.pictures import draw_route

        draw_route(free, replay, path)

    shortest = next(row for row in rows if row[0] == reading((NO_HANGS,)) and row[1] == "strict")
    return StudyResult(
        paper=PAPER,
        result="no-rotation-free",
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
        figures=(Figure("route", "A plan of ours without rotation: a leg crosses to the other column.", route),),
    )


def _length(codes: Ints | None) -> int | None:
    return None if codes is None else len(codes)
