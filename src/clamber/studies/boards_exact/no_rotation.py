"""The modified ladder without rotation: impossible in one reading, possible in another, and what one hang changes."""

from importlib import resources
from pathlib import Path
from typing import Final

import numpy as np

from ...planning.beam_layers import search_layers
from ...planning.genetic.planner import plan_genetic
from ...planning.problem.plan import load_plan
from ...planning.problem.problem import Beam
from ...planning.problem.problems import pose_problem
from ...planning.problem.verdict import check_plan
from ...units import INCH
from ..bevly_1997.modified_ladder import HELD_OFFSET, OWN_HALVES, WITHOUT_TURNS
from ..bevly_1997.printed_plans import limbed_task
from ..result import Cells, Compared, StudyResult, Table
from .proofs import MODEL, TOLD, Proof, prove

READINGS: Final = {
    "own halves, offset while holding": (OWN_HALVES, HELD_OFFSET),
    "own halves": (OWN_HALVES,),
    "offset while holding": (HELD_OFFSET,),
    "free": (),
}
"""What section 2.5.2 leaves unsaid, in words and as rules."""
ONE_HANG: Final = "rules.max_hangs=1"
ONE_HANG_PLAN: Final = Path(str(resources.files(__package__) / "plans" / "one_hang.json"))
MOST_WITH_A_HANG: Final = 1_000_000
"""Stances that exact search keeps where hangs leave the space open."""
BEAMS: Final = (Beam(), Beam(width=5000, niche=50, toll=0.01, longest=200))
SEEDS: Final = range(5)


def forbid_rotation(most: int = MOST_WITH_A_HANG, seeds: range = SEEDS, beams: tuple[Beam, ...] = BEAMS) -> StudyResult:
    """Exact search in four readings, without hangs and with one; where one is allowed by stances, seeds of the genetic search, beams."""
    rows: list[Cells] = []
    proofs: dict[str, Proof] = {}
    for words, rules in READINGS.items():
        never = proofs[words] = prove("modified-ladder", (*MODEL, *rules, WITHOUT_TURNS))
        rows.append((words, 0, never.status, never.length, never.stances, never.length, _highest(never)))
    hanging: dict[str, tuple[Proof, int | None, float]] = {}
    for words in ("own halves, offset while holding", "free"):
        overrides = (*MODEL, *READINGS[words], WITHOUT_TURNS, ONE_HANG)
        once = prove("modified-ladder", overrides, most=most)
        shortest, highest = _tried(overrides, seeds, beams)
        known = min((length for length in (once.length, shortest) if length is not None), default=None)
        hanging[words] = once, known, max(highest, _highest(once))
        rows.append((words, 1, once.status, known, once.stances, once.at_least, hanging[words][2]))
    strict, free = proofs["own halves, offset while holding"], proofs["free"]
    held, known, top = hanging["own halves, offset while holding"]
    loose, shorter, _ = hanging["free"]
    kept = load_plan(ONE_HANG_PLAN)
    shown = check_plan(kept.rebuild_task(str(ONE_HANG_PLAN)), kept)
    proved = strict.status == "infeasible" and free.feasible and free.valid
    return StudyResult(
        claim="Without modules 005 and 006 the modified ladder can't be climbed if legs 1 and 2 keep to their own column and the reach "
        "offset counts while a leg holds (no hangs); if both are free, it can.",
        verdict="holds" if proved and shown.reached else "differs",
        compared=(
            Compared("own halves, offset while holding, no hangs", strict.told, "impossible (section 2.5.2)"),
            Compared("stances that can be reached, all of them seen", strict.stances),
            Compared("highest body there [in]", _highest(strict)),
            Compared("what closes it (actions forbidden)", strict.reason.partition("forbidden: ")[2]),
            Compared("free, no hangs", free.told),
            Compared("own halves, offset while holding, one hang: exact search", held.status),
            Compared("the same: stances seen when its memory ended", held.stances),
            Compared("the same: a plan has at least [actions]", held.at_least),
            Compared("the same: shortest plan found by genetic and beam search [actions]", known if known is not None else "none found"),
            Compared("the same: a kept plan with one hang, replayed [actions]", _told(shown.reached, len(kept.actions))),
            Compared("the same: highest body that any of them reached [in]", top),
            Compared("free, one hang: exact search", loose.status),
            Compared("free, one hang: a plan has at least [actions]", loose.at_least),
            Compared("free, one hang: shortest plan found [actions]", shorter if shorter is not None else "none found"),
        ),
        deviations=(
            *TOLD,
            "A hang turns the body for nothing, so one hang is rotation by another door: it puts the robot off the lattice of poses, and "
            "while it hangs every body move swings it to a new place. The stances it can reach are too many to see them all, so a reading "
            "without a plan can't be proved to have none; what is proved is the least number of actions.",
            "The kept plan (`plans/one_hang.json`) was found by hanging at random from the stances that can be reached, up to 25 "
            "moves in the hang, and exact search without hangs from there: one of some five thousand such tries led to the goal. So "
            "one hang opens the board in this reading; whether a shorter plan does is open.",
            f"There exact search keeps {most} stances, genetic search tries {len(seeds)} seeds, beam search widths of "
            f"{' and '.join(str(beam.width) for beam in beams)}; where none finds a plan, that is no proof that there is none.",
        ),
        seeds=seeds,
        table=Table(
            ("reading", "hangs", "exact search", "shortest plan known", "stances seen", "proved at least", "highest body [in]"),
            tuple(rows),
        ),
    )  # fmt: skip


def _told(reached: bool, actions: int) -> str:
    return f"{actions}, goal reached" if reached else "fails"


def _highest(proof: Proof) -> float:
    """How high the body comes on the plan, or on the way to the furthest stance [in]."""
    return float(proof.replay().stances["y"].max()) / INCH


def _tried(overrides: tuple[str, ...], seeds: range, beams: tuple[Beam, ...]) -> tuple[int | None, float]:
    """The shortest plan that searches without proof find, if any, and how high the body came [in]."""
    task = limbed_task("modified-ladder", overrides)
    problem = pose_problem(task, threads=1).problem
    tried = []
    for seed in seeds:
        result = plan_genetic(task, seed=seed, threads=1)
        tried.append((result.status == "found", result.plan.codes(task, task.name)))
    for beam in beams:
        reached = search_layers(problem, beam)
        tried.append((reached.found, reached.codes))
    replays = [problem.replay(np.asarray(codes)) for _, codes in tried]
    lengths = [len(codes) for (found, codes), replay in zip(tried, replays, strict=True) if found and replay.ok]
    return min(lengths, default=None), max(float(replay.stances["y"].max()) / INCH for replay in replays)
