"""The genetic planner: plans that replay, the same plan on any number of threads, resumed runs, learned macros, both families."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from clamber.errors import ClamberError, FileError, SpecError
from clamber.families.climber.planning.inventory import make_inventory
from clamber.families.climber.planning.problem import LimbedProblem
from clamber.jobs import LocalProcesses
from clamber.planning.genetic.learning import learn
from clamber.planning.genetic.planner import Budget, plan_genetic, search
from clamber.planning.genetic.profile import load_profile, profile_names
from clamber.planning.islands import plan_islands
from clamber.planning.learning import learn_macros, load_macros
from clamber.planning.planners import PLANNERS, find_planner
from clamber.planning.problem.arrays import ActionTable
from clamber.planning.problem.problems import pose_problem
from clamber.planning.progress import Progress
from clamber.planning.result import PlanResult
from clamber.tasks import load_task, task_names

QUICK = ("ladder", "modified-ladder", "h", "across", "circle", "patch-walk")


@pytest.mark.parametrize("planner", sorted(PLANNERS))
def test_every_planner_finds_a_plan_that_replays_to_the_goal(planner: str) -> None:
    result = find_planner(planner)(load_task("ladder", ("rules.max_hangs=0",)), seed=3)
    assert result.status in ("found", "optimal")
    verdict = result.check()
    assert verdict.ok and verdict.reached


@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        *((name, ()) for name in QUICK),
        ("gecko-climb", ("goal.y_min=40cm",)),
        pytest.param("gecko-climb", ("goal.y_min=60cm",), marks=pytest.mark.slow),
        pytest.param("gecko-climb", (), marks=pytest.mark.long),
    ],
)
def test_the_genetic_planner_solves_every_task(name: str, overrides: tuple[str, ...]) -> None:
    result = plan_genetic(load_task(name, overrides), seed=3)
    assert result.status == "found" and result.check().reached
    assert result.evaluations <= 50_000
    assert result.first_length is not None and result.length <= result.first_length


@pytest.mark.parametrize("name", ["h", "across"])
def test_plans_without_hangs_never_hang(name: str) -> None:
    task = load_task(name, ("rules.max_hangs=0",))
    result = plan_genetic(task, seed=1)
    assert result.status == "found" and result.check().reached
    replayed = pose_problem(task).problem.replay(result.plan.codes(task))
    assert int(replayed.stances["hangs"].max()) == 0
    n = len(task.robot.limbs)
    assert int((replayed.stances["hold"][:, :n] >= 0).sum(axis=1).min()) >= 2


@pytest.mark.slow
def test_the_same_seed_gives_the_same_plan_on_any_number_of_threads() -> None:
    task = load_task("circle")
    plans = [plan_genetic(task, seed=5, threads=threads).plan.to_json() for threads in (1, 2, 4)]
    assert plans[0] == plans[1] == plans[2]


def test_other_seeds_give_other_plans() -> None:
    task = load_task("ladder")
    assert len({tuple(plan_genetic(task, seed=seed).plan.numbers() or ()) for seed in range(4)}) > 1


class DeathError(Exception):
    """Stands for a process that dies."""


@pytest.fixture(scope="module")
def whole() -> PlanResult:
    """An undisturbed run."""
    return plan_genetic(load_task("h", ("rules.max_hangs=0",)), seed=2)


@pytest.mark.slow
@pytest.mark.parametrize("dies_at", [30, 110, 3, 95])
def test_a_killed_run_resumes_to_the_plan_of_the_undisturbed_run(
    dies_at: int, whole: PlanResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("clamber.planning.genetic.checkpoint.EVERY", 0.0)
    task = load_task("h", ("rules.max_hangs=0",))
    path = tmp_path / "search.json"
    calls = 0

    def die(_: Progress) -> None:
        nonlocal calls
        calls += 1
        if calls >= dies_at:
            raise DeathError

    with pytest.raises(DeathError):
        plan_genetic(task, seed=2, checkpoint=path, progress=die)
    assert path.exists() or dies_at == 1
    resumed = plan_genetic(task, seed=2, checkpoint=path)
    assert resumed.plan == whole.plan
    assert (resumed.evaluations, resumed.first_evaluations) == (whole.evaluations, whole.first_evaluations)
    assert resumed.history == whole.history


def test_a_checkpoint_of_another_search_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "search.json"
    plan_genetic(load_task("ladder"), seed=2, checkpoint=path)
    with pytest.raises(FileError, match="another search"):
        plan_genetic(load_task("ladder"), seed=3, checkpoint=path)
    path.write_text(path.read_text()[:1000])
    with pytest.raises(FileError, match="no checkpoint"):
        plan_genetic(load_task("ladder"), seed=2, checkpoint=path)


def test_an_interrupt_returns_the_best_so_far() -> None:
    def interrupt(progress: Progress) -> None:
        if progress.generation == 10:
            raise KeyboardInterrupt

    result = plan_genetic(load_task("h"), seed=0, progress=interrupt)
    assert result.status == "stopped" and "interrupted" in result.reason
    assert result.length > 0 and result.check().ok


def test_an_interrupt_while_polishing_returns_the_plan_that_works() -> None:
    def interrupt(progress: Progress) -> None:
        if progress.best_length is not None:
            raise KeyboardInterrupt

    result = plan_genetic(load_task("ladder"), seed=0, progress=interrupt)
    assert result.status == "found" and "interrupted" in result.reason
    assert result.check().reached


def test_no_plan_tells_the_furthest_stance_and_what_stopped_it() -> None:
    task = load_task("modified-ladder", ('rules.allowed=["+y","grab","release"]', "rules.max_hangs=0"))
    result = plan_genetic(task, seed=0, max_evaluations=4000)
    assert result.status == "stopped"
    assert result.furthest is not None and result.furthest.stopped_by
    assert set(result.furthest.stopped_by) <= {"reach", "joint", "support", "hangs", "torque", "power", "clearance"}
    assert result.evaluations <= 4000


def test_a_torque_limit_below_the_weight_leaves_no_start() -> None:
    with pytest.raises(ClamberError, match=r"start.*torque"):
        plan_genetic(load_task("ladder", ("motor.torque_limit=100ozin",)))


def test_sub_goals_can_be_switched_off() -> None:
    profile = load_profile("default")
    bare = replace(profile, search=replace(profile.search, subgoals=False))
    result = plan_genetic(load_task("across"), seed=0, profile=bare, max_evaluations=3000)
    assert result.furthest is None or result.furthest.goals == 1


def test_profiles_load_and_name_features_of_the_families() -> None:
    features = set(pose_problem(load_task("ladder")).problem.features)
    for name in profile_names():
        assert set(load_profile(name).weights) <= features


@pytest.mark.parametrize("name", ["ladder", "h", "circle"])
def test_filters_lose_no_stance(name: str) -> None:
    """From random stances, the filtered inventory leads to the very stances that the full one does (shared holds apart)."""
    task = load_task(name)
    task = replace(task, rules=replace(task.rules, hard=(*task.rules.hard, "shared")))
    full = make_inventory(task, filters=False)
    small = make_inventory(task)
    assert len(small.modules) < len(full.modules)
    rng = np.random.default_rng(0)
    problems = [LimbedProblem(task, inventory.table(), threads=1) for inventory in (full, small)]
    here = problems[0].start
    tested = 0
    for _ in range(60):
        reached = []
        for problem in problems:
            table = problem.actions
            ends = set()
            for entry in range(len(table)):
                after = problem.rebind(table, here).replay(table.spell(np.array([entry], np.int32)))
                if after.ok:
                    last = after.stances[-1]
                    ends.add((last["ix"], last["iy"], last["ia"], *last["hold"][:3], last["in_use"]))
            reached.append(ends)
        stay = tuple(here[["ix", "iy", "ia"]][0]) + tuple(here["hold"][0][:3])
        assert {end for end in reached[0] if end[:6] != stay} == {end for end in reached[1] if end[:6] != stay}
        tested += 1
        children = problems[1].rebind(problems[1].actions, here).expand(here)
        here = children.stance[rng.integers(len(children.stance))][None].copy()
        here["stage"] = 0
    assert tested == 60


def test_the_ladder_gait_is_learned_and_climbs_a_hundred_rungs_alone(tmp_path: Path) -> None:
    task = load_task("ladder", ("rules.max_hangs=0",))
    lesson = learn_macros(task, seeds=range(12))
    assert lesson.macros
    macro = lesson.macros[0]
    assert macro.starts >= 3
    tall = load_task("ladder", ("rules.max_hangs=0", "board.ladder.rungs=100", "goal.y_min=594in"))
    problem = pose_problem(tall).problem
    alone = problem.rebind(ActionTable.build([(macro.name, macro.codes, False)]))
    genes = np.zeros((1, 400), np.int32)
    record = alone.rollout(genes, np.array([400], np.int32), np.zeros(len(problem.features)), 1 << 20)[0]
    assert record["done"] == 1
    path = tmp_path / "macros.json"
    lesson.save(path)
    assert load_macros(path, task) == lesson.macros
    path.write_text(json.dumps({"schema": "other"}))
    with pytest.raises(SpecError, match="clamber-macros-2"):
        load_macros(path, task)


@pytest.mark.slow
def test_a_macro_halves_the_search_on_a_ladder_three_times_as_tall() -> None:
    macro = learn_macros(load_task("ladder", ("rules.max_hangs=0",)), seeds=range(12)).macros
    tall = load_task("ladder", ("rules.max_hangs=0", "board.ladder.rungs=31", "goal.y_min=180in"))
    without = [plan_genetic(tall, seed=seed).first_evaluations for seed in range(5)]
    with_it = [plan_genetic(tall, seed=seed, macros=macro).first_evaluations for seed in range(5)]
    numbers = [float(np.median([50_000 if n is None else n for n in counts])) for counts in (without, with_it)]
    assert numbers[1] < 0.5 * numbers[0]


def test_a_sequence_that_leads_nowhere_is_not_learned() -> None:
    task = load_task("ladder")
    problem = pose_problem(task).problem
    up, down = (problem.actions.codes[problem.actions.names.index(name)] for name in ("3", "4"))
    assert learn(problem, np.array([up, down] * 6, np.int32)) == []


def test_search_needs_nothing_of_a_family_but_arrays() -> None:
    """The walker goes through the very same search as the climber."""
    posed = pose_problem(load_task("patch-walk"))
    outcome = search(posed.problem, load_profile("default"), seed=0, budget=Budget(50_000))
    assert outcome.found and posed.problem.replay(outcome.codes).ok


def test_no_planner_mentions_a_family() -> None:
    folder = Path(__file__).parents[2] / "src" / "clamber" / "planning"
    for path in folder.rglob("*.py"):
        words = set(re.findall(r"[a-z]+", path.read_text().lower()))
        assert not words & {"walker", "limbed", "libra"}, path


@pytest.mark.slow
@pytest.mark.parametrize("hangs", [-1, 0])
@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("ladder", ()),
        ("ladder", ("step.length=1in",)),
        ("modified-ladder", ()),
        ("h", ()),
        ("h", ("motor.torque_limit=1500ozin",)),
        ("across", ()),
        ("circle", ()),
    ],
)
def test_the_default_profile_solves_every_board_in_twenty_of_twenty_seeds(
    name: str, overrides: tuple[str, ...], hangs: int
) -> None:
    task = load_task(name, (*overrides, f"rules.max_hangs={hangs}"))
    profile = load_profile("default")
    unpolished = replace(profile, search=replace(profile.search, polish=0))
    results = [plan_genetic(task, seed=seed, profile=unpolished) for seed in range(20)]
    assert all(result.status == "found" and result.evaluations <= 50_000 for result in results)
    assert all(result.check().reached for result in results)


@pytest.mark.slow
def test_every_task_can_be_posed() -> None:
    for name in task_names():
        assert len(pose_problem(load_task(name)).problem.actions) > 5


@pytest.mark.slow
def test_islands_find_the_same_plan_on_any_number_of_workers() -> None:
    task = load_task("ladder", ("rules.max_hangs=0",))
    plans = [
        plan_islands(task, islands=3, executor=LocalProcesses(workers), max_evaluations=8_000) for workers in (1, 2)
    ]
    assert plans[0].status == "found" and plans[0].check().reached
    assert plans[0].plan == plans[1].plan and plans[0].evaluations == plans[1].evaluations
    alone = [plan_genetic(task, seed=seed, max_evaluations=8_000, threads=1) for seed in range(3)]
    assert plans[0].length == min(one.length for one in alone if one.has_plan)


@pytest.mark.usefixtures("in_this_process")
def test_islands_that_find_nothing_go_on_from_where_they_came_furthest() -> None:
    task = load_task("across", ("rules.max_hangs=0",))
    result = plan_islands(task, islands=2, executor=LocalProcesses(2), max_evaluations=600)
    assert result.status == "stopped" and result.furthest is not None and result.furthest.actions == result.length
    assert result.evaluations > 3 * 400, "both rounds ran"
