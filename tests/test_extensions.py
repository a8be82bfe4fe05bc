"""What other packages add: it is listed and used by name, and what goes wrong in it is named and no traceback."""

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.cli import main
from clamber.extensions import GROUPS, ExtensionError, load_outside, outside
from clamber.families.climber.family import CLIMBER
from clamber.planning.planners import find_planner
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task
from clamber.tasks.robots import load_robot

MODULE = '''
from pathlib import Path

from clamber.families.climber.family import Climber
from clamber.planning.problem.verdict import OutsideCheck
from clamber.planning.exact.planner import plan_exact
from clamber.sim.ode_limb import OdeLimb

ROBOT = Path(__file__).parent / "own.toml"

class OwnFamily(Climber):
    """Climbers by another name, without files of its own."""

    name, title, data = "own-family", "own climber", None

FAMILY = OwnFamily()

def plan_own(task, seed=0):
    return plan_exact(task, threads=1)

LOW = OutsideCheck(unit="m", meaning="height of the body above 1 m", margin=lambda task, step: step.pose[1] - 1.0)

class Spring:
    """A spring and a damper at the tip."""

    def __init__(self, chain, settings, period):
        self.chain, self.kp, self.kd = chain, settings.kp, settings.kd

    def reset(self):
        pass

    def torques(self, aim, q, qd, wrench):
        jacobian = self.chain.jacobian(q)[:3]
        force = self.kp * (aim["place"] - self.chain.place(q)) - self.kd * (jacobian @ qd)
        return jacobian.T @ force

def make_plant(chain, flaws, *, gears=None, batch=1, threads=0):
    return OdeLimb(chain, flaws, gears=gears, batch=batch)
'''
ENTRIES = {
    "clamber.families": "own-family = own_climber:FAMILY",
    "clamber.robots": "own-robot = own_climber:ROBOT",
    "clamber.checks": "own-check = own_climber:LOW",
    "clamber.planners": "own-planner = own_climber:plan_own",
    "clamber.laws": "own-law = own_climber:Spring",
    "clamber.plants": "own-plant = own_climber:make_plant",
}


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Installs a package of one module, with entry points, on a path of its own."""

    def installed(module: str = MODULE, entries: dict[str, str] | None = None, name: str = "own_climber") -> None:
        site = tmp_path / name
        info = site / f"{name}-1.2.dist-info"
        info.mkdir(parents=True)
        (site / f"{name}.py").write_text(module)
        robot = (CLIMBER.data / "robots" / "gecko4.toml").read_text().replace('name = "gecko4"', 'name = "own-robot"')
        (site / "own.toml").write_text(robot)
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name.replace('_', '-')}\nVersion: 1.2\n")
        lines = (f"[{group}]\n{line}\n" for group, line in (ENTRIES if entries is None else entries).items())
        (info / "entry_points.txt").write_text("".join(lines))
        monkeypatch.syspath_prepend(str(site))
        monkeypatch.delitem(sys.modules, name, raising=False)

    return installed


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setenv("COLUMNS", "120")

    def call(*words: str) -> tuple[int, str, str]:
        capfd.readouterr()
        with pytest.raises(SystemExit) as left:
            main(words)
        out, err = capfd.readouterr()
        assert "Traceback" not in err
        return int(left.value.code or 0), out, err

    return call


Run = Callable[..., tuple[int, str, str]]


def test_nothing_is_added_where_no_package_adds_it() -> None:
    assert all(outside(kind) == {} for kind in GROUPS)


def test_all_kinds_are_listed_with_their_package(install: Any, run: Run) -> None:
    install()
    listed = json.loads(run("list", "--json")[1])
    for kind in GROUPS:
        names = {each["name"]: each["title"] for each in listed[kind]}
        own = next(name for name in names if name.startswith("own-"))
        assert names[own] == "of the package own-climber 1.2"


def test_listing_loads_nothing_of_it(install: Any, run: Run) -> None:
    install("raise RuntimeError('loaded')")
    assert "own-planner" in run("list", "planners")[1]


def test_its_robot_is_loaded_by_name_and_climbs(install: Any) -> None:
    install()
    assert load_robot("own-robot").name == "own-robot"
    assert load_task("gecko-climb", ["robot=own-robot"]).robot.name == "own-robot"


def test_its_planner_plans_and_its_check_reports(install: Any, run: Run, tmp_path: Path) -> None:
    install()
    plan = tmp_path / "plan.json"
    code, out, err = run("plan", "ladder", "--planner", "own-planner", "-o", str(plan), "--json")
    assert code == 0, err
    assert json.loads(out)["status"] == "optimal"
    code, out, _ = run("check", str(plan), "--json")
    verdict = json.loads(out)
    heights = [step["margins"]["own-check"] for step in verdict["per_step"]]
    assert code == 0 and verdict["ok"], "a check of another package only reports"
    low = [k for k, height in enumerate(heights, start=1) if height < 0.0]
    assert low and verdict["warnings"]["own-check"] == low
    inches = verdict["final"]["y_in"]
    assert heights[-1] == pytest.approx(0.0254 * inches - 1.0, abs=1e-9)


@pytest.mark.usefixtures("in_this_process")
def test_its_planner_takes_part_where_ours_are_given_usual_options(install: Any, run: Run) -> None:
    install()
    words = (
        "sweep",
        "ladder",
        "--planner",
        "own-planner",
        "--vary",
        "step.length=3in..4in:2",
        "--workers",
        "1",
        "--json",
    )
    code, out, err = run(*words)
    assert code == 0, err
    assert {point["status"] for point in json.loads(out)["points"]} <= {"optimal", "infeasible"}


def test_its_law_moves_the_tip_as_ours_of_the_same_equation_does(install: Any) -> None:
    """Where gravity does not act and nothing limits the motors, J^T (kp e - kd v) is our jacobian-transpose."""
    install()
    from clamber.control.law_settings import LawSettings
    from clamber.limb_bench.bench_limb import bench_limb
    from clamber.limb_bench.measures import Entry
    from clamber.limb_bench.runner import run_contest
    from clamber.limb_bench.scenario import step_scenario
    from clamber.sim.limb_flaws import LimbFlaws

    limb, flaws = bench_limb(), LimbFlaws()
    scenario = step_scenario(limb, flaws.control_rate, dy=-0.005, seconds=0.5)
    entries = [
        Entry(law, LawSettings(law=law, kp=800.0, kd=60.0, feed_force=False))
        for law in ("jacobian-transpose", "own-law")
    ]
    ours, theirs = run_contest(limb, scenario, entries, flaws, plant="own-plant", timed=False)
    assert np.ptp(ours.trace.true[:, 0, 0], axis=0).max() > 0.01
    np.testing.assert_allclose(theirs.trace.true, ours.trace.true, atol=1e-9)


def test_its_law_and_plant_are_taken_by_the_command(install: Any, run: Run) -> None:
    install()
    words = ("limb", "step", "-c", "own-law:kp=800,kd=60", "-c", "scct", "--plant", "own-plant", "--json")
    code, out, err = run(*words)
    assert code == 0, err
    assert [law["label"] for law in json.loads(out)["laws"]] == ["own-law", "scct"]


@pytest.mark.parametrize(
    ("old", "new", "words", "said"),
    [
        ("return plan_exact(task, threads=1)", "return 1 / 0", ("plan", "ladder", "--planner", "own-planner"),
         "'own-planner' of the package own-climber 1.2 (clamber.planners): ZeroDivisionError: division by zero "
         "(own_climber.py, line 19)"),
        ("return plan_exact(task, threads=1)", "return {}", ("plan", "ladder", "--planner", "own-planner"),
         "answered a dict; a planner answers a PlanResult"),
        ("return jacobian.T @ force", "return force", ("limb", "step", "-c", "own-law"), "they must be finite, of shape (2,)"),
        ("return OdeLimb(chain", "return Missing(chain", ("limb", "step", "--plant", "own-plant"), "NameError"),
        ('"own.toml"', '"none.toml"', ("plan", "gecko-climb", "--set", "robot=own-robot"), "none.toml: does not exist"),
        ("from pathlib", "from nowhere", ("plan", "ladder", "--planner", "own-planner"), "No module named 'nowhere'"),
    ],
)  # fmt: skip
def test_what_goes_wrong_in_it_is_named(
    install: Any, run: Run, old: str, new: str, words: tuple[str, ...], said: str
) -> None:
    assert old in MODULE
    install(MODULE.replace(old, new))
    code, _, err = run(*words)
    assert code == 2
    assert said in " ".join(err.split())


def test_a_check_that_fails_is_a_note_and_no_error(install: Any, run: Run) -> None:
    install(MODULE.replace("step.pose[1] - 1.0", "step.height"))
    code, out, _ = run("check", "ladder-hand", "--json")
    verdict = json.loads(out)
    assert code == 0 and "own-check" not in verdict["per_step"][0]["margins"]
    assert any("a check was left out: 'own-check'" in note and "AttributeError" in note for note in verdict["notes"])


def test_a_plan_that_does_not_hold_is_refused(install: Any) -> None:
    """A planner can claim anything; what it found is carried out again before anybody sees it."""
    broken = """
    from dataclasses import replace
    from numpy import repeat
    from clamber.planning.problem.plan import Plan
    result = plan_exact(task, threads=1)
    return replace(result, plan=Plan.of_codes(task, repeat(result.plan.codes(task)[:1], 40)))
"""
    install(MODULE.replace("    return plan_exact(task, threads=1)", broken))
    with pytest.raises(ExtensionError, match="violates a hard check"):
        find_planner("own-planner")(load_task("ladder"))


def test_our_own_names_are_not_taken(install: Any) -> None:
    install(entries={"clamber.planners": "exact = own_climber:plan_own", "clamber.checks": "reach = own_climber:LOW"})
    assert find_planner("exact").__module__.startswith("clamber.")
    plan = Plan.of_codes(load_task("ladder"), [])
    from clamber.planning.problem.verdict import check_plan

    assert any("one of Clamber's own checks" in note for note in check_plan(load_task("ladder"), plan).notes)


def test_two_packages_with_one_name_are_told_by_the_doctor(install: Any, run: Run) -> None:
    install(name="alpha", entries={"clamber.planners": "far = alpha:plan_own"})
    install(name="beta", entries={"clamber.planners": "far = beta:plan_own"})
    assert outside("planners")["far"].value.startswith("alpha")
    code, out, _ = run("doctor", "--json")
    assert code == 1
    assert any("another package's thing has the same name" in line for line in json.loads(out)["problems"])


def test_an_error_survives_the_way_to_another_process(install: Any) -> None:
    import copyreg

    install("raise RuntimeError('broken')")
    with pytest.raises(ExtensionError) as caught:
        load_outside("planners", "own-planner")
    rebuild, args, *_ = caught.value.__reduce_ex__(2)
    assert rebuild is not copyreg._reconstructor  # type: ignore[attr-defined]
    assert str(rebuild(*args)) == str(caught.value)
