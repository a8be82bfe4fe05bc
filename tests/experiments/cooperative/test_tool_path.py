"""Tool paths: their files, and the curve over time that they become."""

from pathlib import Path

import numpy as np
import pytest

from clamber.errors import FileError, UnknownNameError
from clamber.execution.log import LogError
from clamber.execution.log_files import parse_csv
from clamber.families.walker.trials.cooperative.tool_path import load_tool_path, path_names, path_of


def path(text: str) -> object:
    return path_of(parse_csv(text, "path.csv"))


def test_units_are_those_of_the_titles() -> None:
    found = path_of(parse_csv("x [mm],y [cm],z [in],t [min]\n10,2,1,0\n20,2,1,1\n", "path.csv"))
    np.testing.assert_allclose(found.points, [[0.01, 0.02, 0.0254], [0.02, 0.02, 0.0254]])
    np.testing.assert_allclose(found.times, [0.0, 60.0])
    assert found.notes == ()


def test_a_missing_unit_is_told() -> None:
    found = path_of(parse_csv("x,y [m],z [m]\n0,0,1\n1,0,1\n", "path.csv"))
    assert found.notes == ("column 'x' states no unit: read as m",)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x [m],y [m]\n0,0\n1,1\n", "column 'z': no such column"),
        ("x [m],y [m],z [kg]\n0,0,0\n1,1,1\n", "column 'z' = [kg]: is no unit of length"),
        ("x [m],y [m],z [m],t [m]\n0,0,0,0\n1,1,1,1\n", "column 't' = [m]: is no unit of time"),
        ("x [m],y [m],z [m],w [m]\n0,0,0,0\n1,1,1,1\n", "column 'w': no such column of a path"),
        ("x [m],y [m],z [m]\n0,0,0\n", "1 row: must have two points or more"),
        ("x [m],y [m],z [m]\n0,0,0\n0,0,0\n", "row 2: must be another point than the row before"),
        ("x [m],y [m],z [m],t [s]\n0,0,0,1\n1,0,0,1\n", "column 't', row 2 = 1 s: must be later than the row before"),
        ("x [m],y [m],z [m]\n0,0,0\n0,1e6,0\n", "column 'y', row 2 = 1e+06 m: must be within 1000 m"),
        ("x [m],y [m],z [m]\n0,0,nan\n0,1,0\n", "column 'z', row 1"),
        ("x [m],y [m],z [m]\n0,0,a\n0,1,0\n", "row 1 = 'a': must be a finite number"),
    ],
)
def test_a_file_that_is_no_path_is_named_with_what_is_wrong(text: str, words: str) -> None:
    with pytest.raises(LogError) as error:
        path(text)
    assert str(error.value).startswith("path.csv")
    assert words in str(error.value)


def test_a_path_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="does not exist"):
        load_tool_path(str(tmp_path / "none.csv"))
    with pytest.raises(UnknownNameError, match="did you mean 'circle'"):
        load_tool_path("cirle")


@pytest.mark.parametrize("name", path_names())
def test_shipped_paths_start_and_end_at_rest_and_pass_their_points(name: str) -> None:
    found = load_tool_path(name)
    timed = found.sample(0.05)
    for time in (0.0, timed.lasts):
        np.testing.assert_allclose(timed.at(time)[1], 0.0, atol=1e-12)
    np.testing.assert_allclose(timed.at(0.0)[0], found.points[0])
    np.testing.assert_allclose(timed.at(timed.lasts + 5.0)[0], found.points[-1], atol=1e-15)
    moments = np.linspace(0.0, timed.lasts, 20001)
    curve = np.array([timed.at(moment)[0] for moment in moments])
    for point in found.points:
        assert np.linalg.norm(curve - point, axis=1).min() < 1e-4


@pytest.mark.parametrize("timed", [False, True])
def test_the_velocity_is_the_places_derivative_and_the_speed_is_kept(timed: bool) -> None:
    text = "x [m],y [m],z [m]" + (",t [s]" if timed else "") + "\n"
    rng = np.random.default_rng(1)
    for k, point in enumerate(rng.uniform(-1, 1, (8, 3))):
        text += ",".join(f"{v:.4f}" for v in point) + (f",{2 * k + 3}" if timed else "") + "\n"
    found = path_of(parse_csv(text, "path.csv")).sample(0.05)
    fastest = 0.0
    for moment in np.linspace(0.01, found.lasts - 0.01, 301):
        ahead, behind = found.at(moment + 1e-6)[0], found.at(moment - 1e-6)[0]
        velocity = found.at(moment)[1]
        np.testing.assert_allclose(velocity, (ahead - behind) / 2e-6, atol=1e-5)
        fastest = max(fastest, float(np.linalg.norm(velocity)))
    if timed:
        assert found.lasts == pytest.approx(14.0)
    else:
        assert 0.049 < fastest < 0.0505
