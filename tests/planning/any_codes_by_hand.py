"""A process that hands any codes, genes and indices in by every public way, for tests/planning/test_crafted_files.py: error or answer."""

import json
import math
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from clamber.errors import ClamberError
from clamber.planning.genetic.learning import Macro
from clamber.planning.genetic.planner import plan_genetic
from clamber.planning.genetic.profile import load_profile
from clamber.planning.learning import load_macros
from clamber.planning.problem.arrays import ActionTable
from clamber.planning.problem.codes import ARGUMENT_BITS, LIMB_BITS, Code
from clamber.planning.problem.plan import Plan
from clamber.planning.problem.problems import pose_problem
from clamber.tasks import Task, load_task

FOLDER = Path(sys.argv[1])
EXAMPLES = int(sys.argv[2])
settings.register_profile("here", derandomize=True, deadline=None, max_examples=EXAMPLES, database=None)
settings.load_profile("here")
PROFILE = load_profile("default")
SMALL = replace(
    PROFILE, search=replace(PROFILE.search, population=10, first_length=5, longest=20, polish=0, beam=0, windows=0)
)


def packed(kind: int, limb: int, argument: int) -> int:
    return kind << (ARGUMENT_BITS + LIMB_BITS) | limb << ARGUMENT_BITS | argument


sound = st.builds(packed, st.integers(0, 5), st.integers(0, 2), st.integers(0, 6))
near = st.builds(packed, st.integers(0, 15), st.integers(0, 15), st.integers(0, 400))
any_code = st.one_of(sound, near, st.integers(-(2**70), 2**70), st.floats(), st.none(), st.text(max_size=3))
codes = st.one_of(st.lists(sound, max_size=5), st.lists(near, max_size=5), st.lists(any_code, max_size=5))
index = st.one_of(st.integers(0, 30), st.integers(-(2**33), 2**33))


def answers(way: Callable[[], Any]) -> bool:
    """Whether a way in gives an answer; an error of ours is one, too, and anything else ends the process."""
    try:
        way()
    except ClamberError:
        return False
    return True


def is_action(task: Any, code: Any) -> bool:
    """Whether a code is an action of a climber's task, by what its parts say."""
    if not isinstance(code, int) or not 0 <= code < 2**31 or code >> (ARGUMENT_BITS + LIMB_BITS) > 5:
        return False
    opened = Code.of(code)
    limbs, holds = len(task.robot.limbs), len(task.world.holds)
    alone = opened.limb == 0
    return {
        "none": alone and opened.argument == 0,
        "move": alone and opened.argument < 6,
        "release": opened.limb < limbs and opened.argument == 0,
        "nearest": opened.limb < limbs and opened.argument >= 1,
        "hold": opened.limb < limbs and opened.argument < holds,
        "random": opened.limb < limbs and opened.argument == 0,
    }[opened.kind]


def try_task(task: Task, *, climber: bool) -> None:
    problem = pose_problem(task, threads=1).problem
    weights = np.zeros(len(problem.features))

    @given(codes)
    def any_codes(given_codes: list[Any]) -> None:
        went = answers(lambda: problem.replay(given_codes, go_on=True))
        assert not climber or went == all(is_action(task, code) for code in given_codes), given_codes
        assert answers(lambda: Plan.of_codes(task, given_codes)) == went
        entry = ("any", given_codes, False)
        bound: list[Any] = []
        if answers(lambda: bound.append(problem.rebind(ActionTable.build([entry])))):
            bound[0].rollout(np.zeros((2, 3), np.int32), np.full(2, 3, np.int32), weights, 50)
            bound[0].possible(np.zeros(2, np.int32))

    @given(
        st.lists(st.lists(index, min_size=4, max_size=4), min_size=1, max_size=6),
        st.lists(index, min_size=1, max_size=6),
    )
    def any_genes(genes: list[list[int]], lengths: list[int]) -> None:
        answers(lambda: problem.rollout(np.array(genes, np.int64), np.array(lengths, np.int64), weights, 50))  # type: ignore[arg-type]
        answers(lambda: problem.rollout(np.array(genes, np.int64), np.full(len(genes), 4), weights[:-1], 50))  # type: ignore[arg-type]
        answers(lambda: problem.possible(np.array(genes[0], np.int64)))  # type: ignore[arg-type]

    @given(st.sampled_from(sorted(problem.limits.fields)), index)
    def any_stance(field: str, value: int) -> None:
        stance = problem.start.copy()
        stance[field] = np.int64(value).astype(np.int32)
        answers(lambda: problem.expand(stance))
        answers(lambda: problem.measured(stance))
        answers(lambda: problem.rebind(problem.actions, stance).replay([0], go_on=True))

    any_codes()
    any_genes()
    any_stance()


def try_files(task: Task) -> None:
    good = Macro(name="m", codes=(packed(1, 0, 2),), gain=0.1, starts=3, tried=3, seen=1, from_start=3)
    checkpoint = FOLDER / "checkpoint.json"
    plan_genetic(task, profile=SMALL, max_evaluations=30, threads=1, checkpoint=checkpoint)
    whole = json.loads(checkpoint.read_text())
    file = FOLDER / "any.json"

    @given(codes)
    def any_macro(given_codes: list[Any]) -> None:
        macro = {"name": "m", "codes": given_codes, "gain": 0.1, "starts": 3, "tried": 3, "seen": 1, "from_start": 3}
        stored = {"schema": "clamber-macros-2", "task": "t", "robot": task.robot.name, "plans": 1, "evaluations": 1}
        file.write_text(json.dumps(stored | {"macros": [macro]}))
        if answers(lambda: load_macros(file, task)):
            plan_genetic(task, profile=SMALL, max_evaluations=20, threads=1, macros=load_macros(file, task))
        elif all(isinstance(code, int) for code in given_codes):
            odd = replace(good, codes=tuple(given_codes))
            assert not answers(lambda: plan_genetic(task, profile=SMALL, max_evaluations=20, threads=1, macros=[odd]))

    parts = ("genes", "records", "follow", "best", "width", "polished", "first", "history", "macros", "best_actions")

    @given(
        st.sampled_from(parts),
        st.integers(0, 9),
        st.integers(0, 9),
        st.one_of(index, st.just(math.nan), st.none(), st.just([10**9])),
    )
    def any_checkpoint(part: str, first: int, second: int, value: Any) -> None:
        told = json.loads(json.dumps(whole))
        here = told[part]
        if isinstance(here, list) and here:
            inner = here[first % len(here)]
            if isinstance(inner, list) and inner:
                inner[second % len(inner)] = value
            else:
                here[first % len(here)] = value
        else:
            told[part] = [value] if second % 2 else value
        file.write_text(json.dumps(told))
        answers(lambda: plan_genetic(task, profile=SMALL, max_evaluations=50, threads=1, checkpoint=file))

    any_macro()
    any_checkpoint()


ladder = load_task("ladder")
try_task(ladder, climber=True)
try_files(ladder)
try_task(load_task("patch-walk"), climber=False)
try_task(load_task("truss-inchworm"), climber=False)
print("every way in gave an answer or an error")
