"""Elbows that are kept: sets of assignments, and a plan that only limb by limb has sides for its elbows."""

import random
from itertools import product

import numpy as np
import pytest

from clamber.families.climber.planning.problem import LimbedProblem
from clamber.families.climber.statics.elbows import (
    EVERY,
    WORDS,
    free_elbow,
    has_assignment,
    open_branches,
    reflect_elbows,
)
from clamber.families.climber.statics.stance import HOOK
from clamber.planning.problem.codes import Code
from clamber.planning.problem.problems import pose_problem
from clamber.studies.bevly_1997.printed_plans import limbed_task
from clamber.studies.boards_exact.hook_cones import hooked
from plain.evaluator import PlainEvaluator

SETS = [(n, seed) for n in range(2, 9) for seed in range(3)]
H_RULES = tuple(rule.replace("step.length=1in", "step.length=3in") for rule in hooked(60.0))
# The optimum of H that was proved while sides were kept limb by limb: kind, limb and argument (index of the hold, or direction)
H_PLAN = (
    "h0.10 m2 h1.3 r2 m2 m2 m2 m0 h2.9 r1 m0 m0 m0 h1.14 h0.15 m0 h0.17 h1.11 h2.16 m2 m0 r1 m0 m0 m0 m5 h1.21 h2.20 r0 m0 m0 m0 "
    "h0.29 h2.28 m2 m2 m2 m2 h1.23 h0.31 r2 m2 m2 m2 m2 m2"
)
BREAKS = 24
"""The action of it after which no sides are left."""


def members(elbows: np.ndarray, n: int) -> set[int]:
    return {m for m in range(1 << n) if has_assignment(elbows, m)}


def a_set(n: int, seed: int) -> np.ndarray:
    drawn, words = random.Random(seed), np.zeros(WORDS, np.int64)
    for m in range(1 << n):
        if drawn.random() < 0.2:
            words[m >> 6] |= np.int64(np.uint64(1 << (m & 63)).astype(np.int64))
    return words


def parse(text: str) -> list[int]:
    codes = []
    for word in text.split():
        kind = {"h": "hold", "m": "move", "r": "release"}[word[0]]
        limb, _, argument = word[1:].partition(".") if kind != "move" else ("0", "", word[1:])
        codes.append(Code(kind, int(limb), int(argument or 0)).packed())
    return codes


@pytest.mark.parametrize(("n", "seed"), SETS)
def test_a_freed_elbow_may_have_either_branch(n: int, seed: int) -> None:
    for i in range(n):
        before = a_set(n, seed)
        after = before.copy()
        free_elbow(after, n, i)
        assert members(after, n) == {m for m in range(1 << n) if {m | 1 << i, m & ~(1 << i)} & members(before, n)}
        assert open_branches(after, n, i) == (3 if members(before, n) else 0)


@pytest.mark.parametrize(("n", "seed"), SETS)
def test_an_image_has_the_other_branch_of_the_other_limb(n: int, seed: int) -> None:
    image = np.array(random.Random(seed).sample(range(n), n), np.int32)
    before, after = a_set(n, seed), np.full(WORDS, EVERY)
    reflect_elbows(before, n, image, after)
    expected = {sum((1 - (m >> i & 1)) << int(image[i]) for i in range(n)) for m in members(before, n)}
    assert members(after, n) == expected


def test_a_plan_without_one_side_for_each_elbow_is_refused() -> None:
    """Each leg by itself has a side that serves from step 22 to 24, but at no step of these do they serve together."""
    problem = pose_problem(limbed_task("h", H_RULES), threads=1).problem
    assert isinstance(problem, LimbedProblem)
    codes = parse(H_PLAN)
    replay = problem.replay(np.array(codes, np.int32))
    assert replay.reasons.tolist() == [-1] * (BREAKS - 1) + [HOOK]
    # Each stance by itself, by the plain reading of the page: which sides of all elbows bear it
    task = limbed_task("h", (*H_RULES, "rules.branch=free"))
    plain, numbers = PlainEvaluator(task), [hold.number for hold in task.world.holds]
    stance, bear = plain.start(), {}
    for step, code in enumerate(codes[:BREAKS], 1):
        kind, limb, argument = Code.of(code).kind, Code.of(code).limb, Code.of(code).argument
        action = {
            "move": ("move", argument // 2, -1 if argument % 2 else 1),
            "release": ("release", limb),
            "hold": ("hold", limb, numbers[argument]),
        }[kind]
        stance = plain.step(stance, action).stance
        if step >= BREAKS - 2:
            holders = stance.holders()
            bear[step] = {
                tuple(sides[i] for i in holders)
                for sides in product((0, 1), repeat=plain.n)
                if all(plain.judge(stance, None, set(), sides).margins[c] >= -1e-9 for c in ("joint", "torque", "hook"))
            }
    assert all(set.intersection(*({sides[leg] for sides in found} for found in bear.values())) for leg in range(2))
    assert not set.intersection(*bear.values())
