"""Hoshino 1995, sections 3.2 and 7: walks in every direction, turns, steps, and the tool followed on the robot."""

import pytest

from clamber.families.walker.trials.max_setting import Tried
from clamber.studies.hoshino_1995.tool_runs import judge_following
from clamber.studies.hoshino_1995.walks import Strayed, judge_steps, judge_strayed, turn_anywhere, walk_everywhere
from clamber.studies.library import OF_ARM_AND_BODY, OF_WALKING

STRAIGHT = Strayed(done=True, direction=0.2, turned=-0.3, centre=0.0, steps=6)


@pytest.mark.parametrize(
    "strayed",
    [
        Strayed(done=False, direction=0.0, turned=0.0, centre=0.0, steps=3),
        Strayed(done=True, direction=1.1, turned=0.0, centre=0.0, steps=6),
        Strayed(done=True, direction=0.0, turned=-1.1, centre=0.0, steps=6),
        Strayed(done=True, direction=0.0, turned=0.0, centre=0.011, steps=6),
    ],
)
def test_one_walk_that_strays_is_enough_for_no(strayed: Strayed) -> None:
    assert judge_strayed([STRAIGHT]) == "holds"
    assert judge_strayed([STRAIGHT, strayed]) == "differs"
    assert judge_strayed([]) == "differs"


def test_the_rules_on_steps_and_on_the_tool_can_say_no() -> None:
    passed = Tried("seed 0", True, "", 0.04, 0.001)
    assert judge_steps([passed]) == "holds"
    assert judge_steps([passed, Tried("seed 1", False, "fell", None, 0.5)]) == "differs"
    assert judge_following({4: (0.004, 0.009)}) == "holds"
    assert judge_following({4: (0.004, 0.009), 10: (0.006, 0.009)}) == "differs"
    assert judge_following({4: (0.004, 0.011)}) == "differs"


@pytest.mark.slow
def test_a_walk_aside_and_a_turn_about_a_point_go_where_they_are_asked_to_go() -> None:
    assert walk_everywhere((120,)).verdict == "holds"
    assert turn_anywhere(((0.25, 0.0),)).verdict == "holds"


VERDICTS = {
    "walk-directions": "holds",
    "turn-about-points": "holds",
    "passing-steps": "holds",
    "tool-experiment": "holds",
}


@pytest.mark.long
@pytest.mark.parametrize("name", VERDICTS)
def test_results_of_the_robot_on_its_feet_keep_their_verdicts(name: str) -> None:
    assert (OF_WALKING | OF_ARM_AND_BODY)[name]().verdict == VERDICTS[name]
