"""Section 2.3.2: the push-pull constraint, both forces through the centre of gravity, beside the split with the least forces."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from ...types import Floats
from ..result import Compared, StudyResult, Table, Value, Verdict
from .printed_plans import INFERRED, PLANS, replay_printed

SEVERAL: Final = 3
"""Configurations of the printed plans that count as several."""
SAME: Final = 1.01
"""A largest force that is no more than so many times the least possible counts as the least [-]."""
PLACES: Final = 4
"""Configurations whose pegs lie in the same places from the body, to so many decimals of a metre, are one."""


@dataclass(frozen=True, slots=True)
class Split:
    """The weight carried by two legs: sizes of the larger end-effector force [N]."""

    push_pull: float
    """Both forces through the centre of gravity, equations 2.14 and 2.16."""
    least: float
    """The least that any split has."""
    vertical: float
    """Vertical forces alone, equation 2.9; infinite with the pegs on one vertical line."""


def split_weight(a: Floats, b: Floats, weight: float) -> Split:
    """Splits of the weight between two legs.

    A force along the line between the pegs keeps every balance, so one number is free: the largest force is least at the vertex of one of
    two parabolas in it, or where they cross.

    Args:
        a, b: Pegs from the centre of gravity [m], shape (2,).
        weight: [N].
    """
    away = b - a
    distance = float(np.hypot(*away))
    u = away / distance
    n = np.array((-u[1], u[0]))
    half, across = 0.5 * weight * float(u[1]), weight * float(b[0]) / distance
    other = weight * float(n[1]) - across

    def largest(free: float) -> float:
        return max(math.hypot(across, half + free), math.hypot(other, half - free))

    free = [-half, half]
    if half != 0.0:
        free.append((other * other - across * across) / (4.0 * half))
    turns = float(a[0] * b[1] - a[1] * b[0])
    if abs(turns) > 1e-12:  # forces s a and t b with s a + t b = (0, weight)
        s, t = -weight * float(b[0]) / turns, weight * float(a[0]) / turns
        push_pull = max(abs(s) * float(np.hypot(*a)), abs(t) * float(np.hypot(*b)))
    else:
        push_pull = 0.5 * weight if abs(a[0]) < 1e-9 and abs(b[0]) < 1e-9 else math.inf
    wide = float(a[0] - b[0])
    vertical = math.inf if abs(wide) < 1e-9 else weight * max(abs(float(a[0])), abs(float(b[0]))) / abs(wide)
    return Split(push_pull, min(map(largest, free)), vertical)


def judge_push_pull(splits: list[Split]) -> Verdict:
    """The verdict: the constraint has the least forces in several configurations, in some, or in none."""
    least = sum(split.push_pull <= SAME * split.least for split in splits)
    return "holds" if least >= SEVERAL else "open" if least else "differs"


def compare_push_pull() -> StudyResult:
    """The three splits in every push-pull configuration of the printed plans."""
    rows: list[tuple[Value, ...]] = []
    splits: dict[tuple[float, ...], Split] = {}
    for label, (name, overrides) in PLANS.items():
        replayed = replay_printed(name, overrides)
        holds, weight = replayed.task.world.holds, replayed.task.robot.weight
        stances = replayed.replay.stances
        seen: dict[tuple[float, ...], Split] = {}
        for stance in stances[stances["push_pull"] != 0]:
            carriers = [i for i in range(len(replayed.task.robot.limbs)) if int(stance["carriers"]) >> i & 1]
            pegs = [holds[int(stance["hold"][i])] for i in carriers]
            a, b = (np.array((peg.x - stance["x"], peg.y - stance["y"])) for peg in pegs)
            split = split_weight(a, b, weight)
            told = float(np.hypot(*stance["force"][carriers].T).max())
            assert math.isclose(told, split.push_pull, rel_tol=1e-6), "the evaluator's split is that of equation 2.16"
            seen[tuple(np.round([*a, *b], PLACES).tolist())] = split
        splits |= seen
        if seen:
            rows.append(
                (
                    label,
                    len(seen),
                    sum(one.push_pull <= SAME * one.least for one in seen.values()),
                    max(one.push_pull / one.least for one in seen.values()),
                    sum(one.push_pull < one.vertical for one in seen.values()),
                )
            )
    every = list(splits.values())
    ratios = sorted(one.push_pull / one.least for one in every)
    return StudyResult(
        claim="Section 2.3.2: with two legs on one side both forces are taken through the centre of gravity, which for several "
        "configurations makes the end-effector forces least.",
        verdict=judge_push_pull(every),
        compared=(
            Compared("push-pull configurations of the printed plans", len(every)),
            Compared("of them with the least largest force, to 1 %", sum(ratio <= SAME for ratio in ratios), "several"),
            Compared("largest force over the least possible, least [-]", ratios[0]),
            Compared("largest force over the least possible, median [-]", ratios[len(ratios) // 2]),
            Compared("largest force over the least possible, most [-]", ratios[-1]),
            Compared(
                "configurations in which vertical forces alone would be larger",
                sum(one.push_pull < one.vertical for one in every),
            ),
        ),
        deviations=(
            *INFERRED,
            "End-effector forces are compared by the larger of the two, and several is read as three or more; the rule was fixed before "
            "configurations were counted. The thesis names none.",
            "Forces of any direction are allowed, as in the thesis; hooks could not push (see hook-check).",
        ),
        table=Table(
            (
                "plan",
                "push-pull configurations",
                "with the least largest force",
                "largest over least, most [-]",
                "vertical larger",
            ),
            tuple(rows),
        ),
    )
