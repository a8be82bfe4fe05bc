"""The benchmark set: the boards are what they say, no planner contradicts a proof, a contest resumes, its tables and picture are made."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from clamber.benchmarks import contest as contest_module
from clamber.benchmarks.contest import (
    DENSITIES,
    PATTERN,
    SIZES,
    THESIS,
    Allowance,
    Contender,
    Contest,
    Trial,
    Truth,
    all_cases,
    contenders,
    random_case,
    run_contest,
    run_trial,
    thesis_case,
)
from clamber.benchmarks.pictures.boards_plot import draw_boards
from clamber.benchmarks.tables import (
    contradictions,
    groups,
    ranking,
    rows_of,
    save_markdown,
    save_trials,
    standing,
    tables,
    within,
)
from clamber.cli import main
from clamber.cli.printed.library import schema_of
from clamber.errors import SpecError
from clamber.families.climber.planning.random_task import random_task
from clamber.jobs import LocalProcesses, StoreError
from clamber.planning.exact.explore import explore
from clamber.planning.planners import PLANNERS, BuiltIn, accepts, find_planner
from clamber.planning.problem.problems import pose_problem
from clamber.tasks import Task, load_task, task_from_document
from clamber.trials.measured import Crew
from here import Here
from plain.search import breadth_first

FEW = Allowance(checks=100_000, seconds=0.3, patience=60.0)
NO_HANGS = ("rules.max_hangs=0",)


@pytest.fixture(scope="module")
def contest() -> Contest:
    """A solvable board, one without a way, and the ladder."""
    cases = [thesis_case("ladder"), random_case(10, 1), random_case(10, 0)]
    return run_contest(cases=cases, seeds=(0,), allowance=FEW, crew=Crew(executor=Here()))


@pytest.mark.slow
def test_the_set_is_five_boards_and_forty_random_ones_and_the_same_every_time() -> None:
    made = all_cases()
    assert len(made) == 45 and len({case.name for case in made}) == 45
    assert [case.name for case in made[:5]] == list(THESIS)
    assert {case.size for case in made[5:]} == {str(size) for size in SIZES}
    assert {case.density for case in made[5:]} == {f"{density:g}" for density in DENSITIES}
    for case in made[5::9]:
        assert case == random_case(int(case.size), int(case.name.rpartition("-")[2]))
    for case in made:
        task = task_from_document(case.document)
        assert task.rules.max_hangs == 0 and pose_problem(task).problem.incomplete is None


def test_a_random_board_has_the_holds_and_the_density_that_its_name_says() -> None:
    for seed in range(len(PATTERN)):
        case = random_case(40, seed)
        world = task_from_document(case.document).world
        assert len(world.holds) == 40
        width, height = np.ptp(world.positions(), axis=0)
        assert 40 / (width * height) > 0.95 * float(case.density)


def test_every_planner_takes_part_and_every_profile() -> None:
    field = contenders()
    assert {contender.planner for contender in field} == set(PLANNERS)
    assert {"genetic/default", "genetic/thesis", "exact", "greedy", "random", "mcts"} <= {one.name for one in field}
    for contender in field:
        limits = contender.limits(FEW)
        assert all(accepts(contender.planner, option) for option in (*limits, *contender.options, "seed", "threads"))
        assert "max_checks" in limits or limits["seconds"] <= FEW.patience


@pytest.mark.slow
def test_no_answer_contradicts_a_proof(contest: Contest) -> None:
    truths = contest.truths()
    assert contradictions(contest, truths) == []
    assert truths["ladder"] == Truth(feasible=True, shortest=30)
    assert truths[contest.cases[2].name] == Truth(feasible=False, shortest=None)


def test_a_wrong_answer_is_told(contest: Contest) -> None:
    trials = [replace(trial, length=29) if trial.contender == "greedy" else trial for trial in contest.trials]
    told = contradictions(replace(contest, trials=tuple(trials)), contest.truths())
    assert any("29 actions, fewer than the proved 30" in line for line in told)
    assert any("where none was proved to exist" in line for line in told)
    failed = replace(contest.trials[0], status="failed", reason="it broke")
    assert "it broke" in contradictions(replace(contest, trials=(failed,)), contest.truths())[0]


def test_a_standing_counts_what_the_trials_say(contest: Contest) -> None:
    truths = contest.truths()
    for contender in contest.contenders:
        one = standing(contest, contender.name, truths)
        mine = [trial for trial in contest.of(contender.name) if truths[trial.case].feasible]
        found = [trial for trial in mine if trial.length is not None and trial.cost <= FEW.checks]
        assert (one.trials == len(mine) and one.solved == len(found)) or not contender.counts
        assert all(gap >= 0.0 for gap in one.gaps)
    greedy = standing(contest, "greedy", truths)
    assert (greedy.trials, greedy.solved, greedy.hopeless, greedy.told) == (2, 2, 1, 1)
    exact = standing(contest, "exact", truths)
    assert exact.gaps == (0.0,) * exact.solved


def test_an_answer_beyond_the_allowance_does_not_count(contest: Contest) -> None:
    trial = next(trial for trial in contest.of("exact") if trial.length is not None)
    assert within(contest, replace(trial, cost=FEW.checks))
    assert not within(contest, replace(trial, cost=FEW.checks + 1))


def test_the_tables_name_every_planner_and_count_the_boards(contest: Contest, tmp_path: Path) -> None:
    told = tables(contest)
    assert told[0].title == "3 boards: 2 have a plan, 1 have none"
    for table in told:
        assert {row[0] for row in table.rows} == {contender.name for contender in contest.contenders}
        assert all(len(row) == len(table.columns) for row in table.rows)
    assert list(groups(contest, "size")) == ["thesis", "10"]
    save_markdown(contest, tmp_path / "t.md")
    assert (tmp_path / "t.md").read_text().count("| greedy |") == 3
    save_trials(contest, tmp_path / "t.csv")
    assert len((tmp_path / "t.csv").read_text().splitlines()) == 1 + len(contest.trials)


def test_the_rows_of_the_benchmark_have_finite_or_missing_values(contest: Contest) -> None:
    rows = rows_of(contest)
    assert rows[-1].value == 0 and rows[-1].aim == "0"
    assert all(math.isnan(row.value) or row.value >= 0.0 for row in rows)
    json.dumps([row.to_json() for row in rows], allow_nan=False)


def test_the_picture_is_written_and_has_no_trouble_with_planners_that_solved_nothing(
    contest: Contest, tmp_path: Path
) -> None:
    draw_boards(contest, tmp_path / "boards.png")
    assert (tmp_path / "boards.png").stat().st_size > 10_000
    nothing = tuple(replace(trial, length=None, status="stopped") for trial in contest.trials)
    draw_boards(replace(contest, trials=nothing), tmp_path / "nothing.svg")
    assert "<svg" in (tmp_path / "nothing.svg").read_text()


def test_the_ranking_puts_those_first_that_solve_most(contest: Contest) -> None:
    shares = [one.solved / one.trials for one in ranking(contest, contest.truths())]
    assert shares == sorted(shares, reverse=True)


@pytest.mark.slow
def test_a_contest_resumes_and_tells_the_same_on_two_workers(tmp_path: Path) -> None:
    some = [contender for contender in contenders() if contender.name in ("greedy", "random", "exact")]
    setting = {"cases": [random_case(10, 1), random_case(10, 7)], "entrants": some, "seeds": (0,), "allowance": FEW}
    store = tmp_path / "boards.sqlite"
    alone = run_contest(**setting, crew=Crew(executor=Here()))  # type: ignore[arg-type]
    first = run_contest(**setting, crew=Crew(executor=LocalProcesses(2), store=store))  # type: ignore[arg-type]
    again = run_contest(**setting, crew=Crew(executor=LocalProcesses(1), store=store, resume=True))  # type: ignore[arg-type]
    assert again == first

    def timeless(trials: tuple[Trial, ...]) -> list[Trial]:
        return [replace(trial, seconds=0.0) for trial in trials]

    assert timeless(alone.trials) == timeless(first.trials)
    with pytest.raises(StoreError, match="other data"):
        run_contest(**{**setting, "seeds": (1,)}, crew=Crew(executor=LocalProcesses(1), store=store, resume=True))  # type: ignore[arg-type]


def test_a_planner_that_cannot_take_a_task_is_refused_and_not_failed() -> None:
    document = load_task("ladder", ('rules.allowed=["3","191"]',)).document
    told = run_trial({"document": document, "planner": "greedy", "options": {"seed": 0}})
    assert told["status"] == "refused" and "rules.allowed" in told["reason"]


def plan_by_time(task: Task, *, seed: int = 0, seconds: float | None = None, threads: int | None = None) -> None: ...


def test_a_planner_that_only_knows_time_is_limited_by_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PLANNERS, "timed", BuiltIn(f"{__name__}:plan_by_time", "", "replay"))
    timed = Contender(name="timed", planner="timed")
    assert not timed.counts and timed.limits(FEW) == {"seconds": FEW.seconds}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("boards", "--resume"), "--store"),
        (("boards", "-o", "boards.txt"), "boards.txt"),
        (("boards", "-o", "no/such/folder/boards.png"), "no/such/folder"),
        (("plan", "--workers", "2"), "are for one of seeds"),
        (("bords",), "no benchmark is called 'bords'"),
    ],
)
def test_bad_words_are_told_before_anything_runs(
    words: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as left:
        main(["bench", *words])
    assert left.value.code == 2
    assert said in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
def test_the_command_prints_tables_and_writes_the_picture(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(contest_module, "SIZES", (10,))
    monkeypatch.setattr(contest_module, "PATTERN", (0, 3))
    monkeypatch.setattr(contest_module, "THESIS", ())
    monkeypatch.setattr("clamber.benchmarks.contest.ALLOWANCE", FEW)
    few = [contender for contender in contenders() if contender.name in ("greedy", "exact", "random")]
    monkeypatch.setattr("clamber.benchmarks.contest.contenders", lambda: tuple(few))
    picture, store = tmp_path / "boards.svg", tmp_path / "boards.sqlite"
    main_quietly(["bench", "boards", "--workers", "1", "--store", str(store), "-o", str(picture)])
    said = capsys.readouterr().out
    assert "2 boards" in said and "greedy" in said and "no answer contradicts a proof" in said
    assert picture.exists()
    main_quietly(["bench", "boards", "--workers", "1", "--store", str(store), "--resume", "--json"])
    rows = json.loads(capsys.readouterr().out)
    assert rows
    Draft202012Validator(schema_of("bench")).validate(rows)


def main_quietly(words: list[str]) -> None:
    try:
        main(words)
    except SystemExit as left:
        assert not left.code


def small_boards(count: int) -> list[tuple[int, float, int, tuple[str, ...]]]:
    """Holds, density, seed and rules of small random boards, sparse ones more often, so that many have no way."""
    rng = np.random.default_rng(5)
    chosen = []
    for seed in range(count):
        holds = int(rng.integers(5, 11))
        density = float(rng.choice([7.0, 9.0, 12.0, 16.0, 20.0]))
        step = str(rng.choice(["4in", "6in"]))
        chosen.append((holds, density, seed, (*NO_HANGS, f"step.length={step}", "step.angle=30deg")))
    return chosen


def exact_agrees(board: tuple[int, float, int, tuple[str, ...]]) -> bool | None:
    """Whether a plan exists; None where the robot can't stand. The exact planner must say the same as breadth-first search."""
    holds, density, seed, overrides = board
    try:
        task = random_task(holds, density, seed, overrides=overrides)
    except SpecError:
        return None
    problem = pose_problem(task, threads=1).problem
    shortest, seen = breadth_first(problem, most=300_000)
    found = explore(problem, most_stances=400_000)
    assert found.found == (shortest is not None), board
    if shortest is None:
        assert found.exhausted and found.stances == len(seen), board
    else:
        assert len(found.codes) == shortest, board
    for rival in ("greedy", "random", "mcts"):
        result = find_planner(rival)(task, seed=1, max_checks=20_000, threads=1)
        assert result.status != "infeasible" or shortest is None, board
        if result.status == "found":
            assert shortest is not None and result.length >= shortest, board
    return shortest is not None


@pytest.mark.slow
def test_exact_search_agrees_with_breadth_first_search_on_small_random_boards() -> None:
    told = [exact_agrees(board) for board in small_boards(15)]
    assert told.count(True) >= 3 and told.count(False) >= 3


@pytest.mark.long
def test_exact_search_agrees_with_breadth_first_search_on_two_hundred_small_random_boards() -> None:
    told: list[bool] = []
    for board in small_boards(260):
        answer = exact_agrees(board)
        if answer is not None:
            told.append(answer)
        if len(told) == 200:
            break
    assert len(told) == 200 and min(told.count(True), told.count(False)) >= 40
