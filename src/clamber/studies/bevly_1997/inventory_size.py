"""Section 2.2.1: sizes of the inventory and of the search space."""

import math

from ...families.climber.planning.inventory import full_inventory, make_inventory
from ...planning.problem.codes import Code
from ..result import Compared, StudyResult
from . import PAPER
from .replayed import limbed_task

PEGS = 30
LENGTH = 60
"""Actions of the plan in Table 2.3."""


def count_modules() -> StudyResult:
    """Count modules with and without the grabs by number, for 30 pegs and for the ladder."""
    thirty = limbed_task("ladder", (f"board.ladder.rungs={PEGS // 2}",))
    modules = full_inventory(thirty, 3)
    full = len(modules)
    reduced = sum(Code.of(module.codes[0]).kind not in ("hold", "random") for module in modules)
    pegs = len(thirty.world.holds)
    filtered = make_inventory(limbed_task("modified-ladder"))
    return StudyResult(
        paper=PAPER,
        result="inventory-size",
        claim="Section 2.2.1: the inventory has 21 + 3p modules for p pegs, 111 for 30, 18 without N99 and NXX; "
        "the search space is D = N^m.",
        verdict="holds" if (full, reduced) == (22 + 3 * pegs, 19) else "differs",
        compared=(
            Compared("pegs", pegs, PEGS),
            Compared("modules without the no-op", full - 1, 111),
            Compared("modules without no-op, N99 and NXX", reduced - 1, 18),
            Compared("log10 of D for 60 actions, all modules", LENGTH * math.log10(full - 1), LENGTH * math.log10(111)),
            Compared(
                "log10 of D for 60 actions, 18 modules", LENGTH * math.log10(reduced - 1), LENGTH * math.log10(18)
            ),
            Compared("modules on the modified ladder after our filters", len(filtered.modules)),
        ),
        deviations=(
            "Our inventory also counts module 0, the no-op that starts the printed plans; it is taken off here.",
            "Where more than three pegs can lie in reach, our inventory adds N94 and so on, and our filters drop what changes nothing.",
        ),
    )
