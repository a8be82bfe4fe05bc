"""What opens an infeasible task: proofs on both sides, keys that work as overrides, added holds that really help."""

import json
import math
from typing import Any

import numpy as np
import pytest

from clamber.cli import main
from clamber.errors import PlannerError, SpecError, StartError
from clamber.families.climber.planning.relaxations import climber_relaxations
from clamber.family import Family, families, family_of
from clamber.planning.exact.planner import plan_exact
from clamber.planning.infeasibility.find import FeasibleRelaxation, InfeasibilityExplanation, explain_infeasibility
from clamber.planning.infeasibility.relaxations import Dial
from clamber.planning.problem.problems import pose_problem
from clamber.tasks import load_task
from clamber.tasks.library import change_task

NO_HANGS = "rules.max_hangs=0"
STEEP = ("modified-ladder", (NO_HANGS, "step.length=3in", 'rules.allowed=["+y","-y","grab","release"]'))
WEAK = ("ladder", (NO_HANGS, "step.length=3in", "motor.torque_limit=500oz-in", "goal.y_min=24in"))
SHORT = ("ladder", (NO_HANGS, "step.length=3in", "rules.reach_offset=14cm", "goal.y_min=24in"))
GAP = (
    "ladder",
    (NO_HANGS, "step.length=3in", "board.ladder.rungs=7", "board.ladder.removed=[7,8,9,10,11,12]", "goal.y_min=30in"),
)
RING = (
    "patch-walk",
    (
        "goal.x_min=0.8m", "step.length=80mm", "step.angle=30deg",
        'ground.patches=[{x_min="40cm",x_max="60cm",y_min="-2m",y_max="2m"},{x_min="-80cm",x_max="-40cm",y_min="-2m",y_max="2m"},'
        '{x_min="-80cm",x_max="60cm",y_min="40cm",y_max="2m"},{x_min="-80cm",x_max="60cm",y_min="-2m",y_max="-40cm"}]',
    ),
)  # fmt: skip
Case = tuple[str, tuple[str, ...]]


def openings_of(case: Case, **options: Any) -> InfeasibilityExplanation:
    return explain_infeasibility(load_task(*case), seconds=None, threads=2, max_stances=100_000, **options)


@pytest.fixture(scope="module")
def steep() -> InfeasibilityExplanation:
    return openings_of(STEEP)


def is_feasible(case: Case, *overrides: str) -> int | None:
    """Length of the shortest plan by the planner itself, from the files; None if there is none."""
    try:
        result = plan_exact(load_task(case[0], (*case[1], *overrides)))
    except StartError:
        return None
    assert result.status in ("optimal", "infeasible")
    return result.length if result.status == "optimal" else None


def at(opening: FeasibleRelaxation, value: float) -> tuple[str, ...]:
    """The overrides of a numeric opening with another value."""
    if opening.key == "all joint ranges, each end" or "ranges" in opening.key:
        dials = climber_relaxations(load_task(*STEEP))  # type: ignore[arg-type]
        dial = next(d for d in dials if isinstance(d, Dial) and d.key == opening.key)
        return dial.overrides(value)
    return (f"{opening.key}={value} {opening.unit}".rstrip(),)


@pytest.mark.slow
@pytest.mark.parametrize("case", [STEEP, WEAK, SHORT])
def test_every_opening_is_feasible_and_infeasible_one_step_before(case: Case, steep: InfeasibilityExplanation) -> None:
    found = steep if case == STEEP else openings_of(case)
    assert found.openings and not found.ended
    assert is_feasible(case) is None
    for opening in found.openings:
        assert is_feasible(case, *opening.overrides) == opening.length, opening.text
        assert opening.shortest and opening.least
        if opening.shut_at is not None:
            assert isinstance(opening.after, float)
            step = 1.0 if not isinstance(opening.shut_at, float) else abs(opening.after - opening.shut_at)
            assert step == pytest.approx(0.1)
            assert is_feasible(case, *at(opening, float(opening.shut_at))) is None, opening.text


def test_what_is_told_to_open_nothing_opens_nothing(steep: InfeasibilityExplanation) -> None:
    told = {shut.key for shut in steep.shut if shut.proved}
    assert {"rules.reach_offset", "motor.torque_limit", "rules.clearance"} <= told
    assert is_feasible(STEEP, "rules.reach_offset=0 mm") is None
    assert is_feasible(STEEP, "motor.torque_limit=10000 N m") is None
    assert is_feasible(STEEP, "rules.clearance=0 mm") is None


def test_the_least_torque_limit_is_that_of_the_plan_of_least_torque() -> None:
    opening = next(o for o in openings_of(WEAK).openings if o.key == "motor.torque_limit")
    best = plan_exact(load_task(WEAK[0], (*WEAK[1], "motor.torque_limit=3000oz-in")), minimize=("torque",))
    limit = change_task(load_task(*WEAK), opening.overrides).robot.motor.torque_limit  # type: ignore[union-attr]
    assert 0.0 <= limit - best.costs["torque"] <= 0.1 * 0.0070616


@pytest.mark.parametrize("case", [STEEP, RING])
def test_openings_are_overrides_as_a_user_writes_them(case: Case) -> None:
    task = load_task(*case)
    relaxations = family_of(task).relaxations
    assert relaxations is not None
    for relaxation in relaxations(task):
        overrides = relaxation.overrides(relaxation.most) if isinstance(relaxation, Dial) else relaxation.overrides  # type: ignore[attr-defined]
        changed = change_task(task, overrides)
        assert changed.document == load_task(case[0], (*case[1], *overrides)).document
        assert changed.document != task.document


@pytest.mark.long
def test_a_hold_added_where_it_is_told_opens_the_board_and_no_other_place_does() -> None:
    found = openings_of(GAP, spacing=0.1524).places
    assert found is not None and found.complete and found.openings
    assert [o.length for o in found.openings] == sorted(o.length for o in found.openings)
    start = load_task(*GAP).start
    opened = {}
    for opening in found.openings:
        (override,) = opening.overrides
        board = load_task(GAP[0], (*GAP[1], override)).world
        hold = board.holds[-1]  # type: ignore[union-attr]
        opened[round((hold.x - start.x) / found.spacing), round((hold.y - start.y) / found.spacing)] = opening
    for opening in found.openings[:: max(1, len(found.openings) // 6)]:
        assert is_feasible(GAP, *opening.overrides) == opening.length
    # The rest of the lattice, with what was left out unseen: a place that lies out of reach can't open it, nor one that was tried
    rng = np.random.default_rng(0)
    closed = [(i, j) for i in range(-3, 7) for j in range(-3, 9) if (i, j) not in opened]
    for k in rng.permutation(len(closed))[:40]:
        x, y = start.x + closed[k][0] * found.spacing, start.y + closed[k][1] * found.spacing
        if all(math.hypot(hold.x - x, hold.y - y) > 0.02 for hold in load_task(*GAP).world.holds):  # type: ignore[union-attr]
            added = f'board.added=[{{number=15,x="{x:.9g} m",y="{y:.9g} m"}}]'
            assert is_feasible(GAP, added) is None, closed[k]


def test_the_answer_does_not_depend_on_threads(steep: InfeasibilityExplanation) -> None:
    again = explain_infeasibility(load_task(*STEEP), seconds=None, threads=1, max_stances=100_000).to_json()
    assert again | {"seconds": 0} == steep.to_json() | {"seconds": 0}


def test_a_walker_learns_which_patch_shuts_it_in() -> None:
    found = openings_of(RING)
    assert found.places is None
    dropped = [opening for opening in found.openings if opening.key == "ground.patches"]
    assert dropped[0].before == "patch 0"
    assert is_feasible(RING, *dropped[0].overrides) == dropped[0].length
    assert {shut.key for shut in found.shut if shut.proved} >= {"rules.clearance", "rules.balance"}


@pytest.mark.parametrize("family", families(), ids=lambda family: str(family.name))
def test_every_family_says_what_can_be_relaxed(family: Family) -> None:
    assert family.relaxations is not None


def test_without_time_nothing_is_claimed() -> None:
    found = explain_infeasibility(load_task(*STEEP), seconds=0.0, threads=1)
    assert not found.found and found.ended == "time"
    assert all(not shut.proved for shut in found.shut)


def test_an_interrupt_leaves_what_was_found() -> None:
    def interrupt(moment: Any) -> None:
        if moment.key == "rules.allowed":
            raise KeyboardInterrupt

    found = openings_of(STEEP, progress=interrupt)
    assert found.ended == "interrupted" and found.places is None
    assert {opening.key for opening in found.openings} == {"all joint ranges, each end", "shoulder ranges, each end"}


def test_a_task_that_has_a_plan_is_refused() -> None:
    with pytest.raises(PlannerError, match="has a plan"):
        openings_of(("ladder", (NO_HANGS, "goal.y_min=24in")))


@pytest.mark.parametrize(
    ("added", "message"),
    [
        ('[{number=1,x="1 m",y="1 m"}]', "added"),
        ('[{number=99,x="0 in",y="0.1 in"}]', r"added\.99.*overlap"),
        ('[{number=99,x="0 in"}]', r"added\.99\.y"),
    ],
)
def test_an_added_hold_that_cannot_be_is_named(added: str, message: str) -> None:
    with pytest.raises(SpecError, match=message):
        load_task("ladder", (f"board.added={added}",))


def test_an_added_hold_is_one_like_the_others() -> None:
    task = load_task("ladder", ('board.added=[{number=99,x="9 in",y="30 in"}]',))
    hold = task.world.by_number(99)  # type: ignore[union-attr]
    assert hold.x == pytest.approx(0.2286) and hold.radius == task.world.by_number(1).radius  # type: ignore[union-attr]
    assert pose_problem(task).problem is not None


def run(capfd: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as left:
        main(words)
    out, err = capfd.readouterr()
    return int(left.value.code or 0), out, err


def words_of(case: Case, *more: str) -> tuple[str, ...]:
    overrides = [word for text in case[1] for word in ("--set", text)]
    return ("plan", case[0], "--planner", "exact", *overrides, "--quiet", *more)


def test_the_command_prints_the_openings_after_the_proof(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, steep: InfeasibilityExplanation
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    code, out, _ = run(capfd, *words_of(STEEP))
    assert code == 1 and out.index("infeasible:") < out.index("any one of these changes")
    for opening in steep.openings:
        assert opening.key.split(",")[0] in out
    assert "proved infeasible even with" in out and "board.added" in out
    assert max(map(len, (line for line in out.splitlines() if "--set" not in line))) <= 80
    _, short, _ = run(capfd, *words_of(STEEP, "--no-openings"))
    assert "any one of these" not in short and "infeasible:" in short


@pytest.mark.slow
def test_the_json_has_the_openings(capfd: pytest.CaptureFixture[str], steep: InfeasibilityExplanation) -> None:
    code, out, _ = run(capfd, *words_of(STEEP, "--json"))
    told = json.loads(out)
    assert code == 1 and told["status"] == "infeasible"
    assert [o["text"] for o in told["openings"]["openings"]] == [o.text for o in steep.openings]
    assert told["openings"]["one_hold_more"]["complete"]
    _, out, _ = run(capfd, *words_of(STEEP, "--json", "--no-openings"))
    assert json.loads(out)["openings"] is None


def test_a_start_that_cannot_be_held_is_an_error_with_what_would_let_it_start(
    capfd: pytest.CaptureFixture[str],
) -> None:
    code, out, err = run(capfd, *words_of(WEAK, "--json"))
    told = json.loads(out)
    assert code == 2 and "start" in err and told["status"] == "no start"
    (limit,) = (o for o in told["openings"]["openings"] if o["key"] == "motor.torque_limit")
    assert limit["to"] > 500.0 and limit["infeasible_at"] == pytest.approx(limit["to"] - 0.1)


def test_nothing_found_is_said_with_what_was_tried(capfd: pytest.CaptureFixture[str]) -> None:
    far = ("ladder", (NO_HANGS, "step.length=3in", 'rules.allowed=["+x"]'))
    code, out, _ = run(capfd, *words_of(far))
    assert code == 1
    assert "no single change that was tried makes it feasible" in out and "proved infeasible even with" in out
