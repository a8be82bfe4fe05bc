"""What the viewer shows of a walk's loads is what its log has, number by number, and what physics says of it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from clamber.control.support import support_margin
from clamber.errors import SpecError
from clamber.execution.log import Log, LogError
from clamber.execution.log_files import read_log, write_log
from clamber.families.walker.execution.walk_trace import LEG_NAMES, PHASES
from clamber.families.walker.pictures.walk_film import WalkFilm
from clamber.families.walker.pictures.walker_loads import grip_in_use
from clamber.families.walker.planning import load_walk
from clamber.families.walker.trials.run_walk import WalkRun, run_walk, walk_flaws
from clamber.units import GRAVITY
from clamber.viewing.browser.viewer_content import open_exhibit

WEIGHT = 80.0 * GRAVITY
AXES = "xyz"


@pytest.fixture(scope="module")
def walked() -> WalkRun:
    walk = load_walk("slope-walk", ["way.0.distance=80mm"])
    return run_walk(walk, walk_flaws(walk, ()))


@pytest.fixture(scope="module")
def log(walked: WalkRun, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("log") / "walk.mcap"
    write_log(walked.trace.to_log(), path, "walk")
    return path


@pytest.fixture(scope="module")
def columns(log: Path) -> Log:
    return read_log(log)


@pytest.fixture(scope="module")
def film(log: Path) -> WalkFilm:
    found = open_exhibit([str(log), "slope-walk"]).run_film
    assert isinstance(found, WalkFilm)
    return found


def of_legs(columns: Log, what: str, k: int) -> np.ndarray:
    return np.array([columns.column(f"{leg} {what}")[k] for leg in LEG_NAMES])


def vectors(columns: Log, what: str, k: int) -> np.ndarray:
    return np.array([[columns.column(f"{leg} {what} {axis}")[k] for axis in AXES] for leg in LEG_NAMES])


def rows(columns: Log) -> list[int]:
    """One of each phase, with three feet on the ground and with six, and both ends."""
    phase = columns.column("phase")
    middles = [int(np.flatnonzero(phase == p)[np.count_nonzero(phase == p) // 2]) for p in range(len(PHASES))]
    return [0, *middles, columns.rows - 1]


@pytest.mark.slow
def test_bars_of_a_logged_walk_are_the_numbers_of_its_log(film: WalkFilm, columns: Log) -> None:
    time = columns.column("time")
    for k in rows(columns):
        at = film.at(float(time[k]))
        forces, grip, legs, thrusts, actuators = film.values(at)
        # the load cells feel along the leg what the ground gives; they were read at the start of the tick, before it moved
        assert forces == pytest.approx(of_legs(columns, "force", k), abs=15.0)
        assert forces.sum() == pytest.approx(WEIGHT, rel=0.02)
        assert legs == pytest.approx(of_legs(columns, "length", k), abs=0.3e-3)
        assert thrusts == pytest.approx([columns.column(f"actuator {i + 1} force")[k] for i in range(3)])
        assert actuators == pytest.approx(
            [columns.column(f"actuator {i + 1} commanded")[k] for i in range(3)], abs=3e-4
        )
        told = np.isfinite(grip)
        np.testing.assert_array_equal(told, forces > 0.02 * WEIGHT)
        assert (grip[told] <= 1.0).all()
        if told.sum() == 3:  # three feet on a slope carry the weight along it as well: statics, whoever simulates it
            assert 0.5 < grip[told].mean() / (np.tan(np.radians(10.0)) / 0.8) < 1.5


def test_arrows_of_a_logged_walk_are_the_forces_of_its_log(film: WalkFilm, columns: Log) -> None:
    time = columns.column("time")
    for k in rows(columns):
        at = film.at(float(time[k]))
        np.testing.assert_allclose(at.forces.reshape(6, 3), vectors(columns, "ground force", k))
        np.testing.assert_allclose(at.shapes.legs[:, :, 1].reshape(6, 3), vectors(columns, "sole", k))
        assert at.forces.sum(axis=(0, 1)) == pytest.approx((0.0, 0.0, WEIGHT), abs=0.02 * WEIGHT)
        assert at.shapes.centre == pytest.approx([columns.column(f"centre of mass {axis} true")[k] for axis in AXES])
        assert at.shapes.arm[2] == pytest.approx([columns.column(f"tool {axis} true")[k] for axis in AXES])


def test_balance_that_is_shown_follows_from_the_feet_and_the_centre_of_mass_of_the_log(
    film: WalkFilm, columns: Log
) -> None:
    time = columns.column("time")
    for k in rows(columns):
        feet, forces = vectors(columns, "sole", k), vectors(columns, "ground force", k)
        centre = np.array([columns.column(f"centre of mass {axis} true")[k] for axis in AXES])
        stands = (forces != 0.0).any(axis=1).astype(np.int32)
        assert film.at(float(time[k])).margin == pytest.approx(support_margin(feet, stands, centre))


def test_margins_of_a_step_are_the_least_of_its_rows(film: WalkFilm, columns: Log) -> None:
    step, balance = columns.column("step"), columns.column("margin true")
    lengths = np.array([columns.column(f"{leg} length") for leg in LEG_NAMES])
    for number in range(1, len(film.steps)):
        shown = {row.name: row for row in film.margins(number)}
        mine = step == number
        assert shown["balance"].value == f"{1e3 * balance[mine].min():+.0f} mm"
        room = min(lengths[:, mine].min() - 0.25, 0.45 - lengths[:, mine].max())
        assert shown["leg-stroke"].share == pytest.approx(room / 0.1, abs=0.01)
        assert 0.0 < shown["grip"].share < 1.0
        assert "leg-force" not in shown and "thrust" not in shown  # the robot's file states no such limit
        assert [row.name for row in film.margins(number) if row.worst] == ["balance"]


def test_a_run_shows_what_its_log_shows(walked: WalkRun, film: WalkFilm) -> None:
    fresh = WalkFilm(walked.walk.robot, walked.walk.ground, walked.true, walked.report.to_json(), "")
    time = float(walked.trace.time[len(walked.trace.time) // 2])
    for ours, logged in zip(fresh.values(fresh.at(time)), film.values(film.at(time)), strict=True):
        np.testing.assert_allclose(ours, logged, atol=1e-9)


def test_grip_in_use_is_the_tangent_over_the_coefficient_of_friction() -> None:
    forces = np.zeros((6, 3))
    forces[0] = 3.0, 4.0, 100.0
    forces[1] = 0.0, 0.0, 50.0
    shares = grip_in_use(forces, np.array((0.0, 0.0, 1.0)), 0.8, 200.0)
    assert shares[:2] == pytest.approx((5.0 / 80.0, 0.0)) and np.isnan(shares[2:]).all()
    tilt = np.radians(10.0)  # a weight at rest on a slope uses its tangent
    upright = np.tile((0.0, 0.0, 100.0), (6, 1))
    assert grip_in_use(upright, np.array((-np.sin(tilt), 0.0, np.cos(tilt))), 0.8, 200.0) == pytest.approx(
        np.tan(tilt) / 0.8
    )


def test_a_log_without_the_forces_of_the_ground_is_named_for_what_it_lacks(columns: Log, tmp_path: Path) -> None:
    kept = {name: values for name, values in columns.columns.items() if "ground force" not in name}
    write_log(replace(columns, columns=kept), tmp_path / "older.mcap", "walk")
    with pytest.raises(LogError, match="ground force"):
        open_exhibit([str(tmp_path / "older.mcap")])


@pytest.mark.parametrize(
    ("steps", "told"),
    [
        ("null", "note 'report': steps = None: must be a"),
        ('[{"frame": "Y"}]', "note 'report': steps.0.way: must be given"),
        ('[{"frame": "Y", "way": 0.1, "outcome": "ok", "start": -1e300}]', "note 'report': steps.0.start = -1e[+]300: must be"),
        ('[{"frame": "Y", "way": 0.1, "outcome": [], "start": 0.0}]', "note 'report': steps.0.outcome = \\[\\]: must be 'ok'"),
    ],
)  # fmt: skip
def test_a_walks_damaged_report_is_refused_by_the_name_of_its_log_and_key(
    columns: Log, tmp_path: Path, steps: str, told: str
) -> None:
    path = tmp_path / "walk.mcap"
    write_log(replace(columns, notes={**columns.notes, "report": f'{{"steps": {steps}}}'}), path, "walk")
    with pytest.raises(SpecError, match=rf"walk\.mcap, {told}"):
        open_exhibit([str(path), "slope-walk"])
