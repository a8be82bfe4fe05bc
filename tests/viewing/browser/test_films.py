"""Films: plans rest in their stances, runs are where their traces say, and the forces that a run tells carry the weight."""

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.errors import ClamberError, SpecError
from clamber.execution.log import LogError
from clamber.execution.log_files import write_log
from clamber.families.climber.control.limb_chain import legs_of
from clamber.families.climber.execution.climb_trace import TOPIC
from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.pictures.climb_run import ClimbFilm
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.run_plan import ClimbRun, climbing_flaws, run_plan
from clamber.families.walker.pictures.walk_film import PlannedWalkFilm, loads_at_rest
from clamber.family import family_of
from clamber.planning.planners import plan_task
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task
from clamber.viewing.browser.viewer_content import ViewerContent, exhibit_of, open_exhibit
from clamber.viewing.recording import PlanView, Recording
from clamber.viewing.scene import join


@pytest.fixture(scope="module")
def climbed() -> ClimbRun:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    return run_plan(strict, Plan.of_codes(strict, [thesis_code(strict, 300)]), climbing_flaws(strict, ()))


@pytest.fixture(scope="module")
def hand() -> ViewerContent:
    return open_exhibit(["ladder-hand"])


def run_film_of(run: ClimbRun) -> Recording[Any]:
    return family_of(run.task).scenes.run_film(exhibit_of(run.task), run)


def test_plan_rests_in_its_stances(hand: ViewerContent) -> None:
    film = hand.plan_film
    assert isinstance(film, PlanView)
    for step in range(len(film.steps)):
        at, settled = film.at(float(film.ends[step])), film.settled(step)
        np.testing.assert_allclose(at.posture.chains, settled.posture.chains, atol=1e-9)
        np.testing.assert_allclose(at.torques, settled.torques, atol=1e-9)


def test_plan_moves_without_jumps(hand: ViewerContent) -> None:
    film = hand.plan_film
    assert film is not None
    times = np.arange(0.0, film.seconds, 1.0 / 200.0)
    tips = np.array([film.at(float(time)).posture.chains[:, 3] for time in times])
    ways = np.linalg.norm(np.diff(tips, axis=0), axis=-1)
    reach = 0.4  # [m]
    assert ways.max() < 0.1 * reach  # a reach lasts half a second at least
    assert [film.step_at(film.rest(step)) for step in range(len(film.steps))] == list(range(len(film.steps)))
    assert film.step_at(0.0) == 0 and film.step_at(film.seconds) == len(film.steps) - 1


def test_margins_of_a_step_are_those_of_the_replay(hand: ViewerContent) -> None:
    film = hand.plan_film
    assert isinstance(film, PlanView)
    worst = film.worst
    assert worst is not None
    shares = []
    for step in range(1, len(film.steps)):
        rows = film.margins(step)
        marked = [row for row in rows if row.worst]
        assert len(marked) == 1
        hard = [row.share for row in rows if row.hard and np.isfinite(row.share)]
        assert marked[0].share == pytest.approx(min(hard))
        shares.append(marked[0].share)
    assert int(np.argmin(shares)) + 1 == worst


def test_run_is_where_its_trace_says(climbed: ClimbRun) -> None:
    film = run_film_of(climbed)
    for k in (0, len(climbed.trace.time) // 2, len(climbed.trace.time) - 1):
        at = film.at(float(climbed.trace.time[k]))
        assert climbed.trace.true_pose is not None
        assert (at.posture.x, at.posture.y, at.posture.angle) == pytest.approx(tuple(climbed.trace.true_pose[k]))
    assert film.seconds == climbed.trace.time[-1]
    assert len(film.steps) == 1 + len(climbed.report.actions)
    assert [film.step_at(film.rest(step)) for step in range(len(film.steps))] == list(range(len(film.steps)))


def test_forces_of_a_climber_at_rest_carry_its_weight(climbed: ClimbRun) -> None:
    """Statics: by the motors' torques alone the forces of the holds add up to the weight, but for what joints at rest rub."""
    film = run_film_of(climbed)
    at = film.at(0.2)  # it waits for half a second before its first action
    assert min(at.posture.held) >= 0
    unknown = np.zeros(2)
    for (port, elbow, _, tip), leg in zip(at.posture.chains, legs_of(climbed.task.robot), strict=True):
        arms = np.array([tip - port, tip - elbow])
        jacobian = np.column_stack((-arms[:, 1], arms[:, 0])).T  # (axes, joints)
        unknown += np.abs(np.linalg.inv(jacobian.T)) @ (leg["friction1"], leg["friction2"])
    off = at.forces.sum(axis=0) - (0.0, climbed.task.robot.weight)
    assert (np.abs(off) <= unknown).all()
    assert (unknown < 0.4 * climbed.task.robot.weight).all()  # else this would say little


def test_run_and_plan_are_shown_at_the_same_action(climbed: ClimbRun) -> None:
    exhibit = exhibit_of(climbed.task, climbed.plan)
    film, plan = run_film_of(climbed), exhibit.plan_film
    assert isinstance(film, ClimbFilm) and isinstance(plan, PlanView)
    for k, action in enumerate(climbed.report.actions, 1):
        assert film.planned_time(float(film.starts[k]), plan) == pytest.approx(plan.starts[action.first])
        assert film.planned_time(float(film.ends[k]) - 1e-9, plan) == pytest.approx(plan.ends[action.last], abs=1e-6)


def test_log_shows_the_run_that_it_is_of(climbed: ClimbRun, tmp_path: Path) -> None:
    path = tmp_path / "climb.mcap"
    write_log(climbed.trace.to_log(), path, TOPIC)
    exhibit = open_exhibit([str(path)])  # it says that its task is the ladder
    film, straight = exhibit.run_film, run_film_of(climbed)
    assert film is not None
    assert (film.steps, film.grades, film.seconds) == (straight.steps, straight.grades, straight.seconds)
    for time in np.linspace(0.0, film.seconds, 7):
        np.testing.assert_allclose(film.at(time).posture.chains, straight.at(time).posture.chains)
    with pytest.raises(LogError, match="robot 'gecko4' has other ones"):
        open_exhibit([str(path), "gecko-climb"])
    with pytest.raises(LogError, match="no log of a walk"):
        open_exhibit(["patch-walk", str(path)])


def spoilt_action(**changed: object) -> str:
    action = {
        "first": 1, "last": 1, "kind": "move", "title": "up", "outcome": "ok", "start": 0.5, "seconds": 2.0, "tries": 1, "off": 0.0,
        "body_error": None, "tip_error": None,
    }  # fmt: skip
    return json.dumps({"task": "ladder", "actions": [{k: v for k, v in (action | changed).items() if v != "nothing"}]})


@pytest.mark.parametrize(
    ("report", "told"),
    [
        ("", "its note 'report' is not valid JSON"),
        ('{"task": "ladder", "actions": [', "its note 'report' is not valid JSON"),
        ("[" * 100_000, "its note 'report' is not valid JSON"),
        ("[1, 2]", "its note 'report' must be a table"),
        ('{"task": "ladder", "short": NaN}', "its note 'report' is not valid JSON: NaN"),
        ('{"task": "ladder", "actions": {"a": 1}}', "note 'report': actions: must be a"),
        ('{"task": "ladder", "actions": [3]}', "note 'report': actions.0 = 3: must be a table"),
        (spoilt_action(outcome="flew"), "note 'report': actions.0.outcome = 'flew': must be 'ok'"),
        (spoilt_action(start="soon"), "note 'report': actions.0.start = 'soon': must be"),
        (spoilt_action(seconds=1e300), "note 'report': actions.0.seconds = 1e[+]300: must be"),
        (spoilt_action(title="nothing"), "note 'report': actions.0.title: must be given"),
        ('{"task": "ladder", "replans": [{}]}', "note 'report': replans.0.after: must be given"),
    ],
)
def test_a_damaged_report_is_refused_by_the_name_of_its_log_and_key(
    climbed: ClimbRun, tmp_path: Path, report: str, told: str
) -> None:
    path, log = tmp_path / "climb.mcap", climbed.trace.to_log()
    write_log(replace(log, notes={**log.notes, "report": report}), path, TOPIC)
    with pytest.raises(ClamberError, match=rf"^.*climb\.mcap(: |, ){told}"):
        open_exhibit([str(path), "ladder"])


@pytest.mark.parametrize(
    ("limbs", "told"), [("right, left", "its note 'limbs' is not valid JSON"), ("[3]", "must be a list of names")]
)
def test_a_log_with_damaged_names_of_limbs_is_refused(climbed: ClimbRun, tmp_path: Path, limbs: str, told: str) -> None:
    path, log = tmp_path / "climb.mcap", climbed.trace.to_log()
    write_log(replace(log, notes={**log.notes, "limbs": limbs}), path, TOPIC)
    with pytest.raises(LogError, match=told):
        open_exhibit([str(path)])


def test_numbers_that_no_robot_has_are_refused_by_column_and_row(climbed: ClimbRun, tmp_path: Path) -> None:
    path, log = tmp_path / "climb.mcap", climbed.trace.to_log()
    far = log.column("body x true").copy()
    far[6] = 1e300
    write_log(replace(log, columns={**log.columns, "body x true": far}), path, TOPIC)
    with pytest.raises(LogError, match=r"climb\.mcap, column 'body x true', row 7 = 1e\+300: must lie between"):
        open_exhibit([str(path)])


def test_planned_walk_stands_on_the_ground() -> None:
    exhibit = open_exhibit(["terrace-walk"])
    film = exhibit.plan_film
    assert isinstance(film, PlannedWalkFilm)
    shapes = film.at(0.0).shapes
    stands = shapes.touching.astype(bool)
    soles = shapes.legs[:, :, 1]
    heights = film._surface.heights(soles[..., :2])
    np.testing.assert_allclose(soles[stands, 2], heights[stands])
    assert (soles[~stands, 2] > heights[~stands]).all()


def test_a_planned_walks_standing_feet_carry_its_weight() -> None:
    film = open_exhibit(["terrace-walk"]).plan_film
    assert isinstance(film, PlannedWalkFilm)
    at = film.at(0.0)
    stands = at.shapes.touching.astype(bool)
    assert stands.any(axis=1).tolist().count(True) == 1
    assert at.forces.sum(axis=(0, 1)) == pytest.approx((0.0, 0.0, at.weight))
    assert (at.forces[~stands] == 0.0).all()
    arms = at.shapes.legs[:, :, 1] - at.shapes.centre
    np.testing.assert_allclose(np.cross(arms, at.forces).sum(axis=(0, 1))[:2], 0.0, atol=1e-9 * at.weight)


def test_a_walks_plan_is_found_again_step_by_step_from_where_its_frames_are() -> None:
    task = load_task("patch-walk")
    planned = plan_task(task, "auto", seed=0)
    film = exhibit_of(task, planned.plan).plan_film
    assert isinstance(film, PlannedWalkFilm) and len(film.steps) > 20
    rests = [film.rest(step) for step in range(len(film.steps))]
    times = [film.nearest(film._film.at(rest).poses) for rest in rests]
    assert all(a <= b for a, b in pairwise(times)), "it never goes back"
    steps = [film.step_at(time) for time in times]
    assert all(abs(found - step) <= 1 for step, found in enumerate(steps)), (
        steps
    )  # frames that land stay where they are


@given(shares=st.tuples(st.floats(0.01, 1.0), st.floats(0.01, 1.0), st.floats(0.01, 1.0)), far=st.floats(1.5, 9.0))
def test_loads_at_rest_are_the_shares_that_put_the_centre_there(shares: tuple[float, ...], far: float) -> None:
    feet = np.array([(0.3, 0.0), (-0.2, 0.25), (-0.1, -0.3)])
    parts = np.array(shares) / sum(shares)
    np.testing.assert_allclose(loads_at_rest(feet, parts @ feet, 200.0), 200.0 * parts, rtol=1e-9)
    assert (loads_at_rest(feet, far * feet[0], 200.0) == 0.0).all()  # it tips


def test_things_that_do_not_go_together_are_named(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="one can be shown at a time"):
        open_exhibit(["ladder", "h"])
    with pytest.raises(ClamberError, match="is called 'laddr'"):
        open_exhibit(["laddr"])


def test_joined_parts_hold_both() -> None:
    assert join((0.0, 1.0, 0.0, 1.0), (-1.0, 0.5, 0.5, 2.0)) == (-1.0, 1.0, 0.0, 2.0)
