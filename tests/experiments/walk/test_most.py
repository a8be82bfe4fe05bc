"""The most that a walk bears: bisection over what is borne and what is not."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.families.walker.planning import load_walk
from clamber.families.walker.trials.max_setting import Tried, find_most, most_tries
from clamber.families.walker.trials.run_walk import run_walk, walk_flaws


def judged(value: str, borne: bool) -> Tried:
    return Tried(value, borne, "" if borne else "fell", 0.05, 0.0)


@given(st.integers(2, 200), st.data())
def test_it_finds_the_last_that_is_borne_with_few_walks(n: int, data: st.DataObject) -> None:
    last = data.draw(st.integers(-1, n - 1))
    walked: list[str] = []

    def walk(value: str) -> Tried:
        walked.append(value)
        return judged(value, int(value) <= last)

    found = find_most([str(k) for k in range(n)], walk)
    assert len(found.tried) <= most_tries(n)
    assert (found.borne and found.borne.value) == (str(last) if last >= 0 else None)
    assert (found.refused and found.refused.value) == (str(last + 1) if last < n - 1 else None)
    assert len(walked) == len(set(walked)) <= 2 + math.ceil(math.log2(n))
    assert [each.value for each in found.tried] == sorted(walked, key=int)


@pytest.mark.slow
@pytest.mark.parametrize(("payload", "borne"), [("5 kg", True), ("30 kg", False)])
def test_a_walk_is_borne_if_it_ends_in_balance(payload: str, borne: bool) -> None:
    # 30 kg at 0.59 m move the centre of mass by 160 mm, past feet of one frame, whose sides are 119 mm from the middle
    walk = load_walk("level-walk", ("way.0.distance=3cm", f"payload={payload}"))
    tried = Tried.of(payload, run_walk(walk, walk_flaws(walk, [])))
    assert tried.borne == borne == (not tried.reason)
