"""Terrain from files: what is read of height maps, meshes and clouds, the holds on them, and distances from them."""

import io
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from scipy.spatial import cKDTree

from clamber.errors import FileError, SpecError
from clamber.families.spatial.planning.first_task import first_task
from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.world.library import read_world
from clamber.families.spatial.world.terrain_files import read_heights, read_mesh, read_points
from clamber.families.spatial.world.terrain_kernels import terrain_distance
from clamber.families.spatial.world.world import World, build_world
from clamber.tasks import load_task, task_from_document
from clamber.toml_text import toml_text
from clamber.types import Floats

GUIDE: list[dict[str, Any]] = [{"at": ["-1 m", "0 m", "0 m"], "normal": [0, 0, 1]}, {"at": ["1 m", "0 m", "0 m"]}]
Run = Callable[..., tuple[int, str, str]]


def waves(x: Floats, y: Floats) -> Floats:
    return 0.1 * np.sin(4 * x) * np.cos(3 * y)


def wavy_map(rows: int = 81, columns: int = 121) -> Floats:
    """Heights over 3 m x 2 m, the far side first."""
    x, y = np.linspace(-1.5, 1.5, columns), np.linspace(1.0, -1.0, rows)
    return waves(x[None], y[:, None])


def write_world(folder: Path, *terrain: dict[str, Any], **more: Any) -> Path:
    path = folder / "world.toml"
    path.write_text(
        toml_text({"schema": "clamber-world-1", "name": "here", "guide": GUIDE, "terrain": list(terrain)} | more)
    )
    return path


def read(folder: Path, *terrain: dict[str, Any]) -> World:
    return build_world(read_world(str(write_world(folder, *terrain))))


def distances(world: World, places: Floats) -> Floats:
    records = world.solid_records
    return np.array([terrain_distance(records, *map(float, place)) for place in places])


def heights(**more: Any) -> dict[str, Any]:
    return {"kind": "heights", "file": "map.npy", "size": ["3 m", "2 m"], "spacing": "100 mm", "radius": "15 mm"} | more


@pytest.mark.slow
def test_holds_lie_on_a_height_map_with_its_normals_and_their_spacing(tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", wavy_map())
    world = read(tmp_path, heights())
    places = world.places
    assert places[:, 2] == pytest.approx(waves(places[:, 0], places[:, 1]), abs=1e-3)
    slopes = np.column_stack((-0.4 * np.cos(4 * places[:, 0]) * np.cos(3 * places[:, 1]),
                              0.3 * np.sin(4 * places[:, 0]) * np.sin(3 * places[:, 1]), np.ones(len(places))))  # fmt: skip
    slopes /= np.linalg.norm(slopes, axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", slopes, world.normals).min() > math.cos(math.radians(3.0))
    assert cKDTree(places).query(places, k=2)[0][:, 1].min() >= 0.1
    assert len(places) > 0.5 * 6.0 / 0.1**2  # a square grid has 600; discs packed at random half as many or more
    assert np.array_equal(read(tmp_path, heights()).places, places)
    assert not np.array_equal(read(tmp_path, heights(seed=1)).places, places)


@pytest.mark.slow
def test_steep_parts_of_a_height_map_have_no_holds(tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", 3.0 * wavy_map())
    steep = read(tmp_path, heights(slope="30 deg"))
    assert steep.normals[:, 2].min() >= math.cos(math.radians(30.0)) - 1e-9
    assert len(steep.holds) < len(read(tmp_path, heights(slope="80 deg")).holds)


@pytest.mark.slow
def test_png_csv_and_npy_are_the_same_map(tmp_path: Path) -> None:
    grey = np.round(65535 * (wavy_map() + 0.1) / 0.2).astype(np.uint16)
    Image.fromarray(grey).save(tmp_path / "map.png")
    np.save(tmp_path / "map.npy", grey / 65535.0)
    np.savetxt(tmp_path / "map.csv", grey / 65535.0, delimiter=",", fmt="%.9f")
    worlds = [read(tmp_path, heights(file=f"map.{end}", scale="200 mm")) for end in ("png", "npy", "csv")]
    for world in worlds[1:]:
        assert world.places == pytest.approx(worlds[0].places, abs=1e-6)
    assert np.ptp(worlds[0].places[:, 2]) == pytest.approx(0.2, abs=0.02)


def test_a_terrain_stands_where_its_frame_says(tmp_path: Path) -> None:
    """The same map as a wall: turned with its frame, hold by hold."""
    np.save(tmp_path / "map.npy", wavy_map())
    level = read(tmp_path, heights())
    wall = read(tmp_path, heights(at=["1 m", "2 m", "3 m"], x=[0, 0, 1], z=[-1, 0, 0]))
    turn = np.array(((0, 0, 1), (0, -1, 0), (-1, 0, 0))).T  # columns: where x, y and z go; y is z cross x
    assert np.linalg.det(turn) == pytest.approx(1.0) or np.linalg.det(turn) == pytest.approx(-1.0)
    axes = np.array(((0.0, 0.0, 1.0), np.cross((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)), (-1.0, 0.0, 0.0)))
    assert wall.places == pytest.approx(level.places @ axes + np.array((1.0, 2.0, 3.0)), abs=1e-6)
    assert wall.normals == pytest.approx(level.normals @ axes, abs=1e-6)


def test_distances_from_a_height_map_are_those_along_its_normals(tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", wavy_map())
    world = read(tmp_path, heights())
    inner = np.abs(world.places[:, 0]) < 1.2
    inner &= np.abs(world.places[:, 1]) < 0.7
    places, normals = world.places[inner], world.normals[inner]
    assert abs(distances(world, places)).max() < 0.003
    for off in (0.02, 0.05, -0.05, 0.15):  # the sharpest bend has a radius of 0.6 m
        assert distances(world, places + off * normals) == pytest.approx(off, abs=0.003)
    assert len(read(tmp_path, heights(solid=False)).solid_records) == 0


def test_no_distance_from_a_terrain_grows_faster_than_one_goes(tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", wavy_map())
    world = read(tmp_path, heights())
    rng = np.random.default_rng(0)
    a = rng.uniform(
        (-1.2, -0.8, -0.6), (1.2, 0.8, 0.6), (3000, 3)
    )  # over the map; beyond its edge, over and under meet
    b = a + rng.normal(0.0, 0.05, a.shape)
    grown = np.abs(distances(world, a) - distances(world, b)) - np.linalg.norm(a - b, axis=1)
    assert grown.max() < 0.03  # a cell of the grid is 20 mm


def sphere(radius: float) -> Any:
    trimesh = pytest.importorskip("trimesh", reason="comes with the extra `terrain`")
    return trimesh.creation.icosphere(4, radius)


@pytest.mark.slow
@pytest.mark.parametrize("end", ["stl", "obj", "ply"])
def test_holds_are_all_over_a_mesh_and_distances_are_those_of_a_ball(tmp_path: Path, end: str) -> None:
    sphere(500.0).export(tmp_path / f"ball.{end}")
    ball = {"kind": "mesh", "file": f"ball.{end}", "scale": "1 mm", "spacing": "120 mm", "radius": "20 mm"}
    world = read(tmp_path, ball)
    assert np.linalg.norm(world.places, axis=1) == pytest.approx(0.5, abs=2e-3)
    assert np.einsum("ij,ij->i", world.normals, world.places / 0.5).min() > 0.995
    assert (world.places[:, 2] < -0.3).any() and (world.places[:, 2] > 0.3).any()
    rng = np.random.default_rng(1)
    places = rng.uniform(-0.7, 0.7, (400, 3))
    assert distances(world, places) == pytest.approx(np.linalg.norm(places, axis=1) - 0.5, abs=0.02)
    upper = read(tmp_path, ball | {"slope": "45 deg"})
    assert upper.normals[:, 2].min() >= math.cos(math.radians(45.0)) - 1e-9


def test_thin_walls_have_holds_of_both_sides_with_their_own_normals(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh", reason="comes with the extra `terrain`")
    trimesh.creation.box((2.0, 0.01, 1.0)).export(tmp_path / "plate.stl")
    world = read(tmp_path, {"kind": "mesh", "file": "plate.stl", "spacing": "80 mm", "radius": "30 mm"})
    broad = np.abs(np.abs(world.places[:, 1]) - 0.005) < 1e-4
    inner = broad & (np.abs(world.places[:, 0]) < 0.9) & (np.abs(world.places[:, 2]) < 0.4)
    assert inner.sum() > 50
    assert world.normals[inner, 1] == pytest.approx(np.sign(world.places[inner, 1]), abs=1e-6)


@pytest.mark.parametrize("end", ["csv", "npy", "ply"])
def test_a_cloud_has_holds_with_the_normals_of_its_planes(tmp_path: Path, end: str) -> None:
    rng = np.random.default_rng(2)
    xy = rng.uniform((-1.5, -1.0), (1.5, 1.0), (8000, 2))
    cloud = np.column_stack((xy, waves(xy[:, 0], xy[:, 1]) + rng.normal(0.0, 3e-4, 8000)))
    scale: dict[str, Any] = {}
    if end == "csv":
        rows = "\n".join(",".join(f"{value:.3f}" for value in 1e3 * row) for row in cloud)
        (tmp_path / "scan.csv").write_text(f"x [mm],y [mm],z [mm],intensity\n{rows}\n".replace("\n", ",1\n", 0))
    elif end == "npy":
        np.save(tmp_path / "scan.npy", cloud)
    else:
        trimesh = pytest.importorskip("trimesh", reason="comes with the extra `terrain`")
        trimesh.PointCloud(1e3 * cloud).export(tmp_path / "scan.ply")
        scale = {"scale": "1 mm"}
    world = read(tmp_path, {"kind": "points", "file": f"scan.{end}", "spacing": "100 mm", "neighbours": 20} | scale)
    places = world.places
    assert len(places) > 250 and len(world.solid_records) == 0
    assert cKDTree(places).query(places, k=2)[0][:, 1].min() >= 0.1
    slopes = np.column_stack((-0.4 * np.cos(4 * places[:, 0]) * np.cos(3 * places[:, 1]),
                              0.3 * np.sin(4 * places[:, 0]) * np.sin(3 * places[:, 1]), np.ones(len(places))))  # fmt: skip
    slopes /= np.linalg.norm(slopes, axis=1, keepdims=True)
    assert np.median(np.einsum("ij,ij->i", slopes, world.normals)) > math.cos(math.radians(2.0))


@pytest.mark.slow
def test_a_task_keeps_its_terrain_without_the_file_and_overrides_reach_it(tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", 0.3 * wavy_map())
    path = write_world(tmp_path, heights(spacing="140 mm", radius="40 mm"))
    (tmp_path / "task.toml").write_text(toml_text(first_task("quadruped", str(path), "walk")))
    task = load_task(str(tmp_path / "task.toml"))
    denser = load_task(str(tmp_path / "task.toml"), ["world.terrain.0.spacing=70mm"])
    (tmp_path / "map.npy").unlink()
    again: SpatialTask = task_from_document(task.document)  # type: ignore[assignment]
    assert np.array_equal(again.world.places, task.world.places) and len(again.world.fields) == 1
    assert len(denser.world.holds) > 3 * len(task.world.holds)


def picture(mode: str, size: tuple[int, int] = (4, 4)) -> bytes:
    stream = io.BytesIO()
    Image.new(mode, size).save(stream, "PNG")
    return stream.getvalue()


def array(values: Any, **more: Any) -> bytes:
    stream = io.BytesIO()
    np.save(stream, values, **more)
    return stream.getvalue()


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("map.png", b"no picture", "is no PNG that can be read"),
        ("map.png", picture("RGB"), "is a picture of mode RGB.*shades of grey"),
        ("map.png", picture("L", (800, 800)), "has 800 x 800 values.*at most 360000"),
        ("map.npy", array(np.array([{}], object), allow_pickle=True), "is no array that can be read"),
        ("map.npy", array(np.array(["a"])), "has no plain numbers"),
        ("map.npy", array(np.zeros(3)), r"has values of shape \(3,\)"),
        ("map.npy", array(np.array([[0.0, np.nan], [1, 1]])), "no finite value in row 1, column 2"),
        ("map.npy", array(np.zeros((700, 700))), "resample it"),
        ("map.csv", b"1,2\n3\n", r"map.csv:2: has 1 values; every row has 2"),
        ("map.csv", b"1,2\n3,four\n", "map.csv:2: has 'four'"),
        ("map.csv", b"", "is empty"),
        ("map.tif", b"", "is no height map"),
    ],
)  # fmt: skip
def test_what_is_no_height_map_is_refused_by_file_and_reason(
    tmp_path: Path, name: str, content: bytes, words: str
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FileError, match=words) as refused:
        read_heights(tmp_path / name)
    assert name in str(refused.value)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("scan.csv", b"a,b,c\n1,2,3\n", "the header is x, y, z"),
        ("scan.csv", b"x [m],y [mm],z [m]\n1,2,3\n", "has no unit that x, y and z share"),
        ("scan.csv", b"x,y,z\n1,2\n", r"scan.csv:2: has 2 values"),
        ("scan.csv", b"x,y,z\n1_000,1,2,3\n", r"scan.csv:2: has 4 values"),
        ("scan.csv", b"x,y,z\n" + 20 * b"1,2,1e300\n", "point 1 is not finite"),
        ("scan.csv", b"x,y,z\n1,2,3\n", "has 1 points; 12 to 200000"),
        ("scan.npy", array(np.full((20, 3), np.inf)), "point 1 is not finite"),
        ("scan.npy", array(np.zeros((20, 2))), "points are rows of x, y, z"),
        ("scan.las", b"", "is no cloud of points"),
    ],
)  # fmt: skip
def test_what_is_no_cloud_is_refused_by_file_and_reason(tmp_path: Path, name: str, content: bytes, words: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FileError, match=words):
        read_points(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("rock.stl", b"solid but not", "is no STL that can be read|has no triangles"),
        ("rock.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "is no OBJ that can be read|has no triangles"),
        ("rock.ply", b"ply\nnonsense", "is no PLY that can be read"),
        ("rock.dae", b"", "is no mesh"),
    ],
)
def test_what_is_no_mesh_is_refused_by_file_and_reason(tmp_path: Path, name: str, content: bytes, words: str) -> None:
    pytest.importorskip("trimesh", reason="comes with the extra `terrain`")
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FileError, match=words):
        read_mesh(tmp_path / name)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changed", "key", "words"),
    [
        ({"size": None}, "terrain.0.size", "must be given, of a height map"),
        ({"file": None}, "terrain.0.file", "must be the path of a file"),
        ({"scale": "0 m"}, "terrain.0.scale", "must not be 0"),
        ({"z": [1, 0, 0]}, "terrain.0.z", "must not be zero or lie along x"),
        ({"spacing": "3 mm"}, "terrain.0.spacing", "a world may have 60000"),
        ({"spacing": "0 m"}, "terrain.0.spacing", "more than 0"),
        ({"kind": "voxels"}, "terrain.0.kind", "heights"),
    ],
)
def test_a_terrain_with_a_mistake_is_refused_by_its_key(
    tmp_path: Path, changed: dict[str, Any], key: str, words: str
) -> None:
    np.save(tmp_path / "map.npy", wavy_map(21, 31))
    stated = {name: value for name, value in (heights() | changed).items() if value is not None}
    with pytest.raises(SpecError, match=words) as refused:
        read(tmp_path, stated)
    assert refused.value.key == key


@pytest.mark.slow
def test_a_command_makes_a_world_of_each_kind_of_file(
    clamber: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    np.save("map.npy", 0.3 * wavy_map())
    (tmp_path / "holds.csv").write_text(
        "x,y,z,nx,ny,nz\n" + "".join(f"{0.1 * k},{0.1 * (k % 3)},0,0,0,1\n" for k in range(20))
    )
    for words in (("--heights", "map.npy", "--size", "3m,2m", "--slope", "45deg"), ("--table", "holds.csv")):
        code, out, err = clamber("new", "world", *words, "--robot", "gripper-climber", "-o", "made.toml", "--force")
        assert code == 0, err
        code, out, err = clamber("check", "made.toml")
        assert code == 0 and "holds" in out, (out, err)
    code, _, err = clamber("new", "world", "--heights", "map.npy", "-o", "other.toml")
    assert code == 2 and "--size" in err
    code, _, err = clamber("new", "world", "wall", "--table", "holds.csv", "-o", "other.toml")
    assert code == 2 and "take one" in " ".join(err.replace("│", " ").split())
