"""Bevly 1997, claims beside the figures: the rules of their verdicts can say no."""

import math

import numpy as np
import pytest

from clamber.benchmarks.planner_trials import Trials
from clamber.planning.genetic.learning import Macro
from clamber.planning.problem.codes import MOVE, pack
from clamber.planning.problem.problems import pose_problem
from clamber.studies.bevly_1997.learned_module import climbs, judge_learning, judge_modules_alone
from clamber.studies.bevly_1997.limb_claims import damping_ratios, judge_damping, judge_identity
from clamber.studies.bevly_1997.limb_entries import leg_1, scct
from clamber.studies.bevly_1997.printed_plans import limbed_task
from clamber.studies.bevly_1997.search_variants import fight, judge_crossover, judge_subgoals, luck
from clamber.studies.bevly_1997.static_forces import Split, judge_push_pull, judge_static, split_weight
from clamber.studies.library import STUDIES


def trials(*evaluations: int | None) -> Trials:
    return Trials(evaluations, evaluations, evaluations)


def test_a_seed_is_won_by_who_finds_a_plan_with_fewer_evaluations() -> None:
    assert fight(trials(100, 100, None, 100, None), trials(200, 50, 300, None, None)) == (2, 2)
    assert luck(5, 0) == pytest.approx(1.0 / 32.0)
    assert luck(0, 0) == 1.0


def test_the_rule_on_crossover_can_say_each_verdict() -> None:
    ahead, even, behind = [(18, 2)] * 2, [(10, 10)] * 2, [(2, 18)] * 2
    assert judge_crossover([ahead, ahead]) == "holds"
    assert judge_crossover([ahead, even]) == "open"
    assert judge_crossover([ahead, behind]) == "differs"
    # beaten on one task, however far ahead on others
    assert judge_crossover([[(20, 0), (20, 0), (3, 17)]]) == "open"


def test_the_rule_on_sub_goals_can_say_each_verdict() -> None:
    assert judge_subgoals([(18, 0), (20, 20)], 20) == "holds"
    assert judge_subgoals([(18, 3), (20, 20)], 20) == "open"
    assert judge_subgoals([(18, 16), (20, 20)], 20) == "differs"
    assert judge_subgoals([(3, 0)], 20) == "differs"  # hardly any seed finds a plan either way


def test_the_rules_on_modules_can_say_each_verdict() -> None:
    assert judge_learning(True, 9, 10) == "holds"
    assert judge_learning(True, 7, 10) == "open"
    assert judge_learning(True, 5, 10) == "differs"
    assert judge_learning(False, 10, 10) == "differs"
    assert judge_modules_alone(True, False, True) == "holds"
    assert judge_modules_alone(True, True, True) == "differs"
    assert judge_modules_alone(True, None, True) == "open"
    assert judge_modules_alone(True, False, False) == "open"


def test_modules_climb_the_ladder_only_if_some_sequence_of_them_does() -> None:
    """The nominal gait of figure 2.14 with the step of a rung climbs; a body move alone ends where limbs end."""
    from clamber.families.climber.planning.plans import thesis_code
    from clamber.studies.bevly_1997.nominal_gait import GAIT

    task = limbed_task("ladder", ("step.length=6in", "rules.support=atomic"))
    problem = pose_problem(task, threads=1).problem

    def module(codes: tuple[int, ...]) -> Macro:
        return Macro(name="m", codes=codes, gain=0.1, starts=1, tried=1, seen=1, from_start=1)

    gait = module(tuple(int(thesis_code(task, number)) for number in GAIT))
    up = module((int(pack(MOVE, 0, 2)),))
    assert climbs(problem, (up,)) is False
    assert climbs(problem, (up, gait)) is True


@pytest.mark.parametrize("seed", range(20))
def test_the_least_largest_force_is_that_of_a_search_over_all_splits(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = rng.uniform(-0.4, 0.4, (2, 2))
    weight = 40.0
    split = split_weight(a, b, weight)
    u = (b - a) / np.hypot(*(b - a))
    # any split that balances: moments first, then any force along the line between the pegs
    some = np.linalg.lstsq(
        np.array([[1, 0, 1, 0], [0, 1, 0, 1], [-a[1], a[0], -b[1], b[0]]]), np.array([0.0, weight, 0.0]), rcond=None
    )[0]
    free = np.linspace(-2000.0, 2000.0, 400_001)
    sizes = np.maximum(
        np.hypot(some[0] + free * u[0], some[1] + free * u[1]), np.hypot(some[2] - free * u[0], some[3] - free * u[1])
    )
    assert split.least == pytest.approx(sizes.min(), rel=1e-3)
    # equation 2.16 in its form without a division: both forces through the centre
    printed = np.linalg.solve(
        np.array([[1, 0, 1, 0], [0, 1, 0, 1], [-a[1], a[0], -b[1], b[0]], [a[1], -a[0], 0, 0]]),
        np.array([0.0, weight, 0.0, 0.0]),
    )
    assert split.push_pull == pytest.approx(max(np.hypot(*printed[:2]), np.hypot(*printed[2:])), rel=1e-6)
    assert split.push_pull >= split.least - 1e-9


def test_pegs_one_above_the_other_at_equal_distances_have_the_least_forces() -> None:
    split = split_weight(np.array((0.2, 0.15)), np.array((0.2, -0.15)), 40.0)
    assert split.push_pull == pytest.approx(split.least)
    assert split.vertical == np.inf


def test_the_rules_on_forces_and_torques_can_say_each_verdict() -> None:
    least, more = Split(20.0, 20.0, 30.0), Split(25.0, 20.0, 30.0)
    assert judge_push_pull([least] * 3 + [more] * 20) == "holds"
    assert judge_push_pull([least, least, more]) == "open"
    assert judge_push_pull([more] * 20) == "differs"
    assert judge_static([2.0, 5.0]) == "holds"
    assert judge_static([1.9, 5.0]) == "differs"


def test_the_rules_on_damping_and_admittance_can_say_each_verdict() -> None:
    assert judge_damping([(3.2, 1.0), (1.0, 0.3)], [(1.0, 1.1)]) == "holds"
    assert judge_damping([(3.2, 1.0), (1.3, 0.8)], [(1.0, 1.1)]) == "differs"
    assert judge_damping([(3.2, 1.0)], [(1.0, 1.5)]) == "open"
    assert judge_identity(0.0, 0.1) == "holds"
    assert judge_identity(1e-6, 0.1) == "differs"
    assert judge_identity(0.0, 0.0) == "differs"  # a term that does nothing proves nothing


@pytest.mark.parametrize("branch", ["elbow +", "elbow -"])
def test_damping_ratios_are_those_of_a_mass_on_a_spring_with_a_damper(branch: str) -> None:
    """SCCT makes the tip a mass of the largest inertia along either axis; joints' own friction and 200 Hz add a little."""
    limb = leg_1()[branch]
    inertia = limb.chain.largest_inertia
    kp, ratios = (200.0, 400.0), (0.5, 1.0)
    kd = tuple(2.0 * ratio * math.sqrt(k * inertia) for ratio, k in zip(ratios, kp, strict=True))
    assert damping_ratios(limb, scct(kp, kd)) == pytest.approx(ratios, rel=0.1)


VERDICTS = {"section-3-2-3": "holds", "section-3-3-2": "holds"}


@pytest.mark.parametrize("name", VERDICTS)
def test_the_claims_on_one_limb_hold(name: str) -> None:
    result = STUDIES["bevly-1997"][name]()
    assert (result.result, result.verdict) == (name, VERDICTS[name])
