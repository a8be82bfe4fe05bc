"""Seeds that no tuning may use: told in results, refused where plans are made surer, never mixed with others."""

import json
from collections.abc import Sequence
from typing import Any

import pytest

from clamber.families.climber.cli.validate import FIRST_SEED
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.plan_repair import learn
from clamber.families.climber.trials.planning import SEEDS
from clamber.families.climber.trials.trial import ClimbTrial
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task
from clamber.trials.held_out import FIRST_HELD_OUT, HeldOutError, are_held_out, check_training


def test_seeds_are_held_out_from_a_billion_on() -> None:
    assert not are_held_out(range(1, 301))
    assert are_held_out(range(FIRST_HELD_OUT, FIRST_HELD_OUT + 300))
    with pytest.raises(HeldOutError, match="partly held out"):
        are_held_out(range(FIRST_HELD_OUT - 1, FIRST_HELD_OUT + 1))


def test_what_clamber_tunes_by_itself_uses_training_seeds() -> None:
    check_training(SEEDS)
    check_training(range(FIRST_SEED, FIRST_SEED + 10_000))


def test_a_plan_does_not_learn_from_held_out_seeds() -> None:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)

    def climbs(plan: Plan, seeds: Sequence[int]) -> list[ClimbTrial]:
        raise AssertionError("climbed")

    with pytest.raises(HeldOutError, match="nothing may be tuned"):
        learn(task, Plan.of_codes(task, []), climbs, range(FIRST_HELD_OUT, FIRST_HELD_OUT + 3), lessons=1, seconds=1.0)


def test_rehearsals_with_held_out_seeds_are_refused_by_the_command(clamber: Any) -> None:
    code, _, err = clamber("validate", "ladder-hand", "-n", "1", "--seed", str(FIRST_HELD_OUT), "-q")
    assert code == 2 and "held out for rates" in err


def test_trials_refuse_seeds_of_both_kinds(clamber: Any) -> None:
    code, _, err = clamber("trials", "ladder-hand", "-n", "2", "--seed", str(FIRST_HELD_OUT - 1), "-q")
    assert code == 2 and "partly held out" in err


@pytest.mark.long
def test_trials_say_whether_their_seeds_are_held_out(clamber: Any) -> None:
    words = ("trials", "level-walk", "-n", "1", "--workers", "1", "-q", "--seed")
    assert json.loads(clamber(*words, "1", "--json")[1])["held_out"] is False
    assert json.loads(clamber(*words, str(FIRST_HELD_OUT), "--json")[1])["held_out"] is True
    assert "seeds 1 to 1: training" in clamber(*words, "1")[1]
