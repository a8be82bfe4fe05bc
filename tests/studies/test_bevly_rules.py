"""Verdict rules of chapter 2 of Bevly 1997: each says no to a result that is not what is printed."""

from dataclasses import replace

import numpy as np
import pytest

from clamber.studies.bevly_1997.evolution import PASSED, Curve, judge_curves
from clamber.studies.bevly_1997.printed_plans import PRINTED, judge_plan
from clamber.studies.bevly_1997.search_variants import TASKS, judge_planner

SHOWN = Curve(generations=60, passed=40, before=0.01, after=0.04, flat=(15, 38))


@pytest.mark.parametrize(
    ("few", "verdict"),
    [((), "holds"), (("across",), "open"), (("across", "circle"), "open"), (("h",), "differs"), (TASKS, "differs")],
)
def test_a_planner_that_finds_plans_with_half_of_its_seeds_has_not_shown_that_it_does(
    few: tuple[str, ...], verdict: str
) -> None:
    found = {name: 10 if name in few else 11 for name in TASKS}
    assert judge_planner(found, 20) == verdict


@pytest.mark.parametrize(
    "unlike",
    [
        {"passed": None},  # it never comes past the missing pegs
        {"after": 0.019},  # it does not grow faster there
        {"flat": (41, 55)},  # it is flat for longest afterwards
    ],
)
def test_seeds_that_do_not_look_like_figure_2_16_count(unlike: dict[str, object]) -> None:
    other = replace(SHOWN, **unlike)  # type: ignore[arg-type]
    assert SHOWN.as_printed and not other.as_printed
    assert judge_curves([SHOWN] * 6 + [other] * 4) == "holds"
    assert judge_curves([SHOWN] * 4 + [other] * 6) == ("open" if other.passed is None else "differs")
    assert judge_curves([other] * 10) == "differs"


def test_the_shape_of_a_fitness_is_read_from_it() -> None:
    fitness = np.concatenate((np.linspace(0.0, 0.4, 11), np.full(30, 0.4), np.linspace(0.5, 1.5, 20)))
    curve = Curve.of(fitness)
    assert curve.flat == (10, 40)
    assert curve.passed == 41 == int(np.argmax(fitness >= PASSED))
    assert curve.as_printed
    late = Curve.of(np.concatenate((np.linspace(0.0, 1.0, 20), np.full(30, 1.0), [1.1])))
    assert late.flat == (19, 49) and not late.as_printed
    assert Curve.of(np.full(50, 0.4)).passed is None


@pytest.mark.parametrize(
    ("torque", "verdict"), [(1849.0, "differs"), (1851.0, "holds"), (1949.0, "holds"), (1951.0, "differs")]
)
def test_the_hand_made_plan_needs_about_1900_oz_in_and_not_only_less_than_2000(torque: float, verdict: str) -> None:
    printed = PRINTED["h-hand-plan"]
    assert judge_plan(printed, printed.holds, torque) == verdict
    assert judge_plan(printed, printed.holds - 1, torque) == "differs"


def test_the_planners_plan_needs_less_than_1500_oz_in() -> None:
    printed = PRINTED["h-planner-plan"]
    assert [judge_plan(printed, printed.holds, torque) for torque in (1499.0, 1500.0)] == ["holds", "differs"]
