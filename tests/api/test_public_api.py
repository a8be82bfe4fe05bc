"""What `import clamber` offers: a plan, a run and a comparison in ten lines each; quick to import, every name there and told."""

import ast
import inspect as python_inspect
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import clamber
from clamber.planning.problem.codes import MOVE, pack


def test_importing_it_loads_nothing() -> None:
    code = (
        "import sys\nbefore = set(sys.modules)\nimport clamber\n"
        "print(sorted(name for name in set(sys.modules) - before if name.startswith('clamber.')))\n"
        "print(sorted({'numpy', 'numba', 'scipy', 'pydantic', 'mujoco', 'matplotlib', 'rich', 'typer'} & set(sys.modules)))"
    )
    environment = os.environ | {"PYTHONPATH": str(Path(clamber.__file__).parents[1])}
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True)
    assert told.stdout.splitlines() == ["[]", "[]"]


@pytest.mark.parametrize("name", clamber.__all__)
def test_every_name_is_there_and_has_a_docstring(name: str) -> None:
    thing = getattr(clamber, name)
    assert name in dir(clamber)
    if name != "__version__":
        assert python_inspect.getdoc(thing)
        assert thing is getattr(clamber, name)


@pytest.mark.parametrize(
    "name",
    [
        "answer",
        "check",
        "compare",
        "draw",
        "explain_infeasibility",
        "inspect",
        "plan",
        "reach",
        "validate",
        "run",
        "sweep",
        "trials",
        "view",
    ],
)
def test_every_function_tells_its_arguments(name: str) -> None:
    function = getattr(clamber, name)
    told = python_inspect.getdoc(function) or ""
    for argument in python_inspect.signature(function).parameters:
        if name != "draw" or argument != "what":
            assert f"{argument}:" in told or f"{argument}, " in told or f", {argument}:" in told, argument
    assert "Raises:" in told


def test_type_checkers_are_told_the_same_names_as_readers() -> None:
    tree = ast.parse(Path(clamber.__file__).read_text())
    checked = {
        alias.asname
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.level
        for alias in node.names
    }
    assert checked == set(clamber.__all__) - {"__version__"} == set(clamber._PLACES)
    assert clamber.__all__ == sorted(clamber.__all__)


def test_a_name_that_is_not_there_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'fly'"):
        clamber.fly  # noqa: B018


def test_an_old_name_is_read_for_one_release_and_names_the_new_one() -> None:
    with pytest.warns(DeprecationWarning, match="clamber.find_openings is called explain_infeasibility now"):
        assert clamber.find_openings is clamber.explain_infeasibility


def test_a_plan_in_ten_lines(tmp_path: Path) -> None:
    task = clamber.load_task("ladder", ["rules.max_hangs=0"])
    result = clamber.plan(task, "exact")
    assert result.status == "optimal"
    verdict = clamber.check(result)
    assert verdict.ok and verdict.reached
    margin, step = verdict.tightest()["reach"]
    assert margin >= 0.0 and 1 <= step <= result.length
    result.plan.save(tmp_path / "plan.json")
    again = clamber.check(tmp_path / "plan.json")
    assert again.tightest() == verdict.tightest()
    assert clamber.check(clamber.load_plan(tmp_path / "plan.json"), task).pose == verdict.pose
    assert clamber.draw(result, tmp_path / "plan.png").stat().st_size > 1000


@pytest.mark.slow
def test_a_task_of_a_walker_is_planned_by_the_same_function() -> None:
    result = clamber.plan("patch-walk", "exact", seconds=60.0)
    assert result.has_plan and clamber.check(result).reached


@pytest.mark.slow
def test_a_comparison_in_ten_lines(tmp_path: Path) -> None:
    result = clamber.compare(["scct", "jacobian-transpose"], "circle", radius=0.03, lap=3.0, flaws="nominal")
    off = {row.entry.label: row.measures[0].true.radial_rms for row in result.rows}
    assert set(off) == {"scct", "jacobian-transpose"}
    for row in result.rows:
        places = np.array([result.limb.chain.place(q)[:2] for q in row.run.trace.true[-600:, 0, 0]])
        by_hand = np.hypot(*(places - (0.22, 0.0)).T) - 0.03
        assert np.sqrt(np.mean(by_hand**2)) == pytest.approx(off[row.entry.label], rel=0.2)
    assert clamber.draw(result, tmp_path / "laws.svg").stat().st_size > 1000


def test_a_comparison_takes_texts_where_the_command_does() -> None:
    result = clamber.compare(["scct:kp=50,kd=5"], "step", dy=-0.01, seconds=0.5, plant="ode", changes=["friction=50%"])
    assert result.rows[0].entry.settings.kp == 50.0 and result.flaws.friction == 0.5
    push = clamber.compare(["scct"], "push", force=(5.0, 0.0), tip=(0.2, 0.05), end=0.6, seconds=1.0)
    assert push.scenario.kind == "push" and push.limb.start == pytest.approx((0.2, 0.05))


@pytest.mark.slow
def test_a_walk_is_run_by_name(tmp_path: Path) -> None:
    walk = clamber.load_walk("level-walk", ["way.0.distance=0.1m"])
    run = clamber.run(walk)
    assert run.done, run.reason
    x, y = run.true.pose[-1, :2]
    assert np.hypot(x, y) == pytest.approx(0.1, abs=0.005)


@pytest.mark.slow
def test_a_climb_in_ten_lines(tmp_path: Path) -> None:
    task = clamber.load_task("gap")
    run = clamber.run(task, noise=["peg_error=3mm"], seed=1, log=tmp_path / "climb.mcap")
    assert run.done, run.reason
    assert all(action.outcome == "ok" for action in run.report.actions)
    assert (tmp_path / "climb.mcap").stat().st_size > 1000
    clamber.draw(run, tmp_path / "climb.png")
    again = clamber.run(run.plan, noise=["peg_error=3mm"], seed=1)
    assert again.report.pose == run.report.pose


def test_what_cannot_be_is_one_kind_of_error() -> None:
    for call in (
        lambda: clamber.load_task("none"),
        lambda: clamber.plan("ladder", "none"),
        lambda: clamber.plan("ladder", "exact", width=3),
        lambda: clamber.compare(["none"]),
        lambda: clamber.compare(["scct"], changes=["backlash=2kg"]),
        lambda: clamber.run("none"),
        lambda: clamber.check("none.json"),
        lambda: clamber.inspect("none"),
        lambda: clamber.draw(3, "three.png"),
    ):
        with pytest.raises(clamber.ClamberError):
            call()


def test_a_planner_of_ones_own_answers_actions() -> None:
    task = clamber.load_task("ladder", ["rules.max_hangs=0"])
    best = clamber.plan(task, "exact")
    codes = best.plan.codes(task)
    own = clamber.answer(task, codes, planner="mine", reason="by hand")
    assert own.status == "found" and own.check().reached and own.max_torque == best.max_torque
    part = clamber.answer(task, codes[:-1], planner="mine")
    assert part.status == "stopped" and part.furthest is not None and part.furthest.actions == len(codes) - 1
    with pytest.raises(clamber.ClamberError, match="violates the hard check"):
        clamber.answer(task, [pack(MOVE, argument=2)] * 40, planner="mine")
