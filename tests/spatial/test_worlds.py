"""Worlds in space: guides, solids, holds from tables and patterns."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from clamber.errors import FileError, SpecError
from clamber.families.spatial.planning.surface import LEAST, SMOOTH, fit_surface, on_guide, span_along
from clamber.families.spatial.world.guide import GRAIN
from clamber.families.spatial.world.library import read_world
from clamber.families.spatial.world.patterns import frame_at
from clamber.families.spatial.world.solids import SOLID, Box, Plane, Round, solid_record
from clamber.families.spatial.world.terrain_kernels import terrain_distance
from clamber.families.spatial.world.world import World, build_world
from clamber.files import Document

FLOOR: list[dict[str, Any]] = [{"at": ["0 m", "0 m", "0 m"], "normal": [0, 0, 1]}, {"at": ["2 m", "0 m", "0 m"]}]


def world(**keys: Any) -> World:
    data = {"schema": "clamber-world-1", "name": "here", "guide": FLOOR} | keys
    return build_world(Document("here.toml", data))


def corner(bend: str = "300 mm") -> list[dict[str, Any]]:
    """From a floor up a wall."""
    return [
        {"at": ["0 m", "0 m", "0 m"], "normal": [0, 0, 1]},
        {"at": ["1 m", "0 m", "0 m"], "normal": [-1, 0, 0], "bend": bend},
        {"at": ["1 m", "0 m", "1 m"]},
    ]


def test_a_guide_turns_evenly_about_its_arc_and_its_frames_are_square() -> None:
    frames = world(guide=corner()).frames
    length = 0.7 + 0.7 + 0.3 * math.pi / 2
    assert len(frames) == pytest.approx(length / GRAIN + 1, abs=1.0)
    steps = np.linalg.norm(np.diff(frames[:, :3], axis=0), axis=1)
    assert steps == pytest.approx(GRAIN, rel=1e-3)
    axes = frames[:, 3:].reshape(-1, 3, 3)
    assert np.einsum("nij,nkj->nik", axes, axes) == pytest.approx(np.broadcast_to(np.eye(3), axes.shape), abs=2e-3)
    assert np.linalg.det(axes) == pytest.approx(1.0, abs=2e-3)
    assert frames[0, 9:] == pytest.approx([0, 0, 1]) and frames[-1, 9:] == pytest.approx([-1, 0, 0])
    centre = np.array([0.7, 0.0, 0.3])
    bent = frames[(frames[:, 0] > 0.71) & (frames[:, 2] < 0.29)]
    assert np.linalg.norm(bent[:, :3] - centre, axis=1) == pytest.approx(0.3, abs=1e-4)
    assert bent[:, 9:] == pytest.approx((centre - bent[:, :3]) / 0.3, abs=2e-3)


def test_a_guide_goes_straight_on_beyond_its_ends() -> None:
    frames = world(guide=corner()).frames
    assert frame_at(frames, -0.5)[:3] == pytest.approx([-0.5, 0, 0])
    assert frame_at(frames, GRAIN * (len(frames) - 1) + 0.5)[:3] == pytest.approx([1, 0, 1.5], abs=GRAIN)


PATCH: dict[str, Any] = {
    "on": {"at": ["0 m", "0 m", "0 m"], "x": [1, 0, 0], "normal": [0, 0, 1]},
    "along": ["0 m", "1 m"],
    "across": ["0 m", "1 m"],
    "spacing": "0.1 m",
}


@pytest.mark.parametrize(
    ("guide", "key", "words"),
    [
        (corner("2 m"), "guide.0.bend", "arcs leave -1000 mm"),
        ([FLOOR[0] | {"normal": [1, 0, 0]}, FLOOR[1]], "guide.0.normal", "must not lie along the piece"),
        ([{"at": ["0 m", "0 m", "0 m"]}, FLOOR[1]], "guide.0", "must state the normal"),
        ([FLOOR[0], {"at": ["0 m", "0 m", "0 m"]}], "guide.0.at", "5 mm or more from the next"),
        ([FLOOR[0]], "guide", "two points or more"),
        ([FLOOR[0], {"at": ["100000 m", "0 m", "0 m"]}], "guide", "is 100000 m long; at most 1000 m"),
        ([*FLOOR, {"at": ["0.5 m", "1 mm", "0 m"]}], "guide.1.at", "must not turn right back"),
    ],
)  # fmt: skip
def test_a_guide_that_is_none_is_refused(guide: list[dict[str, Any]], key: str, words: str) -> None:
    with pytest.raises(SpecError, match=words) as refused:
        world(guide=guide)
    assert refused.value.key == key and refused.value.file == "here.toml"


@pytest.mark.parametrize(
    ("changed", "key", "words"),
    [
        ({"patterns": [PATCH | {"on": PATCH["on"] | {"normal": [2, 0, 0]}}]}, "patterns.0.on.normal", "lie along x"),
        ({"patterns": [PATCH | {"on": PATCH["on"] | {"normal": [0, 0, 1e-320]}}]}, "patterns.0.on.normal", "be zero"),
        ({"patterns": [PATCH | {"on": PATCH["on"] | {"x": [1e7, 0, 0]}}]}, "patterns.0.on.x.0", "or less"),
        ({"holds": [{"number": 1, "at": ["0 m", "0 m", "0 m"], "normal": [0, 0, 0]}]}, "holds.0.normal", "be zero"),
        (
            {"solids": [{"kind": "plane", "at": ["0 m", "0 m", "0 m"], "normal": [0, 0, 0]}]},
            "solids.0.normal",
            "be zero",
        ),
    ],
)
def test_a_vector_without_a_direction_is_refused(changed: dict[str, Any], key: str, words: str) -> None:
    with pytest.raises(SpecError, match=words) as refused:
        world(**changed)
    assert refused.value.key == key


def distance(solid: Any, place: Any) -> float:
    rows = np.zeros(1, SOLID)
    rows[0] = solid_record(solid)
    return float(terrain_distance(rows, *map(float, place)))


def test_distances_from_solids_are_those_of_geometry() -> None:
    plane = Plane(kind="plane", at=(0.0, 0.0, 0.1), normal=(0.0, 0.0, 2.0))
    assert distance(plane, (3, 4, 0.5)) == pytest.approx(0.4)
    box = Box(kind="box", at=(0.0, 0.0, 0.0), size=(2.0, 1.0, 0.4))
    assert distance(box, (2, 0, 0)) == pytest.approx(1.0)
    assert distance(box, (1.3, 0.9, 0)) == pytest.approx(0.5)
    assert distance(box, (0, 0, 0)) == pytest.approx(-0.2)
    pillar = Round(kind="cylinder", at=(0.0, 0.0, 0.0), to=(0.0, 0.0, 2.0), radius=0.3)
    assert distance(pillar, (0.5, 0, 1)) == pytest.approx(0.2)
    assert distance(pillar, (0, 0, 2.5)) == pytest.approx(0.5)
    assert distance(pillar, (0.6, 0, 2.4)) == pytest.approx(0.5)
    silo = Round(kind="tube", at=(0.5, 0.0, 0.0), to=(0.5, 0.0, 1.0), radius=0.5)
    assert distance(silo, (0.5, 0, 7)) == pytest.approx(0.5)
    assert distance(silo, (1.2, 0, 0)) == pytest.approx(-0.2)
    bar = Round(kind="bar", at=(0.0, 0.0, 0.0), to=(1.0, 0.0, 0.0), radius=0.1)
    assert distance(bar, (0.5, 0.4, 0.3)) == pytest.approx(0.4)
    assert distance(bar, (1.3, 0.4, 0)) == pytest.approx(0.4)


numbers = st.floats(-2.0, 2.0)


@given(numbers, numbers, numbers, numbers, numbers, numbers)
def test_no_distance_grows_faster_than_one_goes(x: float, y: float, z: float, u: float, v: float, w: float) -> None:
    solids = [
        Box(kind="box", at=(0.1, 0.2, 0.3), size=(1.0, 0.5, 0.4), x=(1.0, 1.0, 0.0), z=(0.0, 0.3, 1.0)),
        Round(kind="cylinder", at=(0.0, 0.0, 0.0), to=(0.5, 0.4, 0.6), radius=0.2),
        Round(kind="bar", at=(0.0, 0.0, 0.0), to=(0.5, 0.4, 0.6), radius=0.2),
        Round(kind="tube", at=(0.0, 0.0, 0.0), to=(0.5, 0.4, 0.6), radius=0.7),
    ]
    for solid in solids:
        change = abs(distance(solid, (x, y, z)) - distance(solid, (u, v, w)))
        assert change <= math.dist((x, y, z), (u, v, w)) + 1e-9


def test_a_pattern_is_the_same_each_time_and_lies_on_its_bumps() -> None:
    pattern = {
        "along": ["0 m", "2 m"],
        "across": ["-0.4 m", "0.4 m"],
        "spacing": "100 mm",
        "jitter": "30 mm",
        "seed": 3,
    }
    flat, bumpy = world(patterns=[pattern]), world(patterns=[pattern | {"bumps": "50 mm", "bump_length": "0.5 m"}])
    assert len(flat.holds) == len(bumpy.holds) == 21 * 9
    assert np.array_equal(world(patterns=[pattern]).places, flat.places)
    assert flat.places[:, 2] == pytest.approx(0.0) and flat.normals[:, 2] == pytest.approx(1.0)
    assert 0.02 < abs(bumpy.places[:, 2]).max() <= 0.05
    assert np.linalg.norm(bumpy.normals, axis=1) == pytest.approx(1.0)
    thinned = world(patterns=[pattern | {"left_out": "50 %"}])
    assert 0.35 < len(thinned.holds) / len(flat.holds) < 0.65


def test_the_normals_of_a_pattern_are_those_of_its_heights() -> None:
    dense = {
        "along": ["0 m", "1 m"],
        "across": ["0 m", "1 m"],
        "spacing": "10 mm",
        "bumps": "50 mm",
        "bump_length": "0.5 m",
    }
    made = world(patterns=[dense])
    heights = made.places[:, 2].reshape(101, 101)
    normals = made.normals.reshape(101, 101, 3)
    slopes = -normals[..., :2] / normals[..., 2:]
    by_difference = np.stack(np.gradient(heights, 0.01), axis=-1)
    assert slopes[1:-1, 1:-1] == pytest.approx(by_difference[1:-1, 1:-1], abs=0.01)


def test_places_on_a_guide_are_found_again() -> None:
    frames = world(guide=corner()).frames
    for along, across, height in ((0.2, 0.1, 0.05), (0.9, -0.2, 0.02), (1.6, 0.3, 0.0), (-0.3, 0.0, 0.1)):
        frame = frame_at(frames, along)
        place = frame[:3] + across * frame[6:9] + height * frame[9:12]
        assert on_guide(frames, place[None])[0] == pytest.approx([along, across, height], abs=GRAIN)


def test_a_fitted_surface_is_the_plane_of_holds_that_lie_in_one() -> None:
    rng = np.random.default_rng(1)
    places = np.column_stack((rng.uniform(0, 2, 500), rng.uniform(-0.5, 0.5, 500), np.zeros(500)))
    places[:, 2] = 0.1 + 0.02 * places[:, 0]
    grid, (along, across) = fit_surface(places, 0.1, 0.2)
    middle = grid[round((1.0 - along) / 0.1), round((0.0 - across) / 0.1)]
    at = along + 0.1 * round((1.0 - along) / 0.1)
    assert middle[0] == pytest.approx(0.1 + 0.02 * at, abs=2e-3)
    assert middle[1] == pytest.approx(0.02, abs=5e-3) and middle[2] == pytest.approx(0.0, abs=1e-3)


def test_a_fitted_surface_is_of_least_squares_about_each_node() -> None:
    """Weighted by a Gaussian of the radius, slopes held towards 0: of NumPy's least squares, node by node."""
    rng = np.random.default_rng(3)
    places, grain, radius = rng.normal(size=(60, 3)) * (0.5, 0.3, 0.05), 0.15, 0.25
    grid, corner = fit_surface(places, grain, radius)
    for i, j in np.ndindex(*grid.shape[:2]):
        away = places[:, :2] - (np.array(corner) + grain * np.array((i, j)))
        weight = np.exp(-(away**2).sum(axis=1) / (2.0 * radius**2)) + LEAST
        root, flat = np.sqrt(weight), radius * math.sqrt(SMOOTH * weight.sum())
        rows = np.vstack((np.column_stack((np.ones(60), away)) * root[:, None], ((0, flat, 0), (0, 0, flat))))
        fitted = np.linalg.lstsq(rows, np.concatenate((places[:, 2] * root, (0, 0))))[0]
        assert grid[i, j] == pytest.approx(fitted, abs=1e-9)


def test_no_hold_within_reach_is_farther_along_a_guide_than_its_span() -> None:
    frames = world(guide=corner()).frames
    span = span_along(frames, 0.4, 0.2)
    rng = np.random.default_rng(2)
    pairs = rng.uniform(0.0, GRAIN * (len(frames) - 1), (4000, 2))
    for body, hold in pairs:
        a, b = frame_at(frames, body), frame_at(frames, hold)
        place = a[:3] + rng.uniform(0.0, 0.2) * a[9:12]
        if np.linalg.norm(place - b[:3]) <= 0.4:
            assert abs(body - hold) <= span
    assert span_along(world().frames, 0.4, 0.2) == 0.4


def test_gravity_is_a_body_or_a_vector() -> None:
    assert world().gravity == (0.0, 0.0, -9.80665)
    assert world(gravity="moon").gravity == (0.0, 0.0, -1.625)
    assert world(gravity=["-9.81 m/s^2", "0 m/s^2", "1 m/s^2"]).gravity == (-9.81, 0.0, 1.0)
    with pytest.raises(SpecError, match="gravity"):
        world(gravity="jupiter")


TABLE = """# marked in a scan
x [mm],y [mm],z [mm],nx,ny,nz,strength [N],friction
0,0,0,0,0,1,20,0.5
100,0,5,0,0.1,1,,
"""


def test_holds_are_read_from_a_table(tmp_path: Path) -> None:
    (tmp_path / "scan.csv").write_text(TABLE)
    (tmp_path / "scan.toml").write_text(
        'schema = "clamber-world-1"\nname = "scan"\ntable = "scan.csv"\n'
        'guide = [{ at = ["0 m", "0 m", "0 m"], normal = [0, 0, 1] }, { at = ["1 m", "0 m", "0 m"] }]\n'
    )
    holds = build_world(read_world(str(tmp_path / "scan.toml"))).holds
    assert [hold.at for hold in holds] == [(0.0, 0.0, 0.0), (0.1, 0.0, 0.005)]
    assert (holds[0].strength, holds[0].friction) == (20.0, 0.5)
    assert (holds[1].strength, holds[1].friction) == (None, None)


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("x,y,z,nx,ny\n0,0,0,0,0\n", 1, "no column 'nz'"),
        ("x,y,z,nx,ny,nz,colour\n", 1, "unknown column 'colour'"),
        ("x,y,z,nx,ny,nz\n0,0,0,0,0,1\n0,0,zero,0,0,1\n", 3, "z = 'zero'"),
        ("x,y,z,nx,ny,nz\n0,0,0\n", 2, "has no nx"),
        ("\n", 0, "has no holds"),
    ],
)
def test_a_table_with_a_mistake_is_refused_by_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    (tmp_path / "scan.csv").write_text(text)
    (tmp_path / "scan.toml").write_text('schema = "clamber-world-1"\nname = "scan"\ntable = "scan.csv"\nguide = []\n')
    with pytest.raises(FileError, match=words) as refused:
        read_world(str(tmp_path / "scan.toml"))
    assert str(refused.value).startswith(f"{tmp_path / 'scan.csv'}" + (f":{line}" if line else ""))
