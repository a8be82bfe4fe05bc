"""Walks from files: ways as twists, starts against the simulation, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

from clamber.errors import ClamberError, SpecError
from clamber.families.walker.planning import is_walk, load_walk, walk_names
from clamber.families.walker.planning.piece import BodyTwist, Piece
from clamber.families.walker.planning.walks import walk_from_document
from clamber.families.walker.sim.walker_flaws import WalkerFlaws
from clamber.families.walker.sim.walker_plant import WalkerSim

FILE = """
schema = "clamber-walk-1"
name = "mine"
robot = "hoshino"
ground = "slope"
way = [{ direction = "0 deg", distance = "1 m" }]
"""


@pytest.mark.parametrize("name", walk_names())
def test_every_shipped_walk_begins_with_six_feet_on_the_ground(name: str) -> None:
    walk = load_walk(name)
    assert is_walk(name)
    assert walk.title
    sim = WalkerSim(walk.robot, walk.ground, WalkerFlaws())
    sim.reset(walk.start_pose(), walk.start_place(), walk.start_legs(), np.array(walk.arm))
    true = sim.truth()
    assert true.touching.sum() == 6
    assert np.abs(true.pose[4:]).max() < math.radians(0.2)
    again = walk_from_document(walk.document)
    np.testing.assert_array_equal(again.start_legs(), walk.start_legs())


@pytest.mark.parametrize("heading", [0.0, 40.0, -130.0])
@pytest.mark.parametrize("uphill", [0.0, 75.0])
def test_a_plate_may_lie_as_the_ground(heading: float, uphill: float) -> None:
    changes = ["start.plate=ground", f"start.heading={heading}deg", f"ground.uphill={uphill}deg", "start.twist=10deg"]
    walk = load_walk("slope-walk", changes)
    sim = WalkerSim(walk.robot, walk.ground, WalkerFlaws())
    sim.reset(walk.start_pose(), walk.start_place(), walk.start_legs(), np.array(walk.arm))
    normal = sim._axes[:, 2]
    assert math.degrees(math.acos(normal @ walk.ground.axes()[:, 2])) < 0.3
    assert sim.truth().touching.sum() == 6
    assert sim.truth().pose[3] == pytest.approx(math.radians(heading), abs=1e-2)


def test_a_piece_turns_about_its_point() -> None:
    """The velocity of the point is zero: v + omega x r."""
    about = (0.3, -0.2)
    x, y, turn = Piece(turn=0.5, about=about).whole_twist()
    assert (x - turn * about[1], y + turn * about[0]) == pytest.approx((0.0, 0.0))
    assert Piece(direction=math.pi / 2, distance=2.0).whole_twist() == pytest.approx((0.0, 2.0, 0.0))


def test_overrides_reach_walk_robot_and_ground() -> None:
    walk = load_walk("slope-walk", ["level=false", "ground.slope=5deg", "way.0.distance=3m", "legs.nominal=36cm"])
    assert not walk.level
    assert math.degrees(walk.ground.slope) == pytest.approx(5.0)
    assert walk.way[0].distance == 3.0
    assert walk.robot.legs.nominal == 0.36
    assert load_walk("slope-walk", ["ground=level"]).ground.name == "level"


def test_another_seed_is_another_rough_ground() -> None:
    walk = load_walk("rough-walk")
    places = np.random.default_rng(0).uniform(-0.5, 0.8, (50, 2))
    np.testing.assert_array_equal(walk.with_seed(0).ground.heights(places), walk.ground.heights(places))
    assert (walk.with_seed(1).ground.heights(places) != walk.ground.heights(places)).all()
    level = load_walk("level-walk")
    assert level.with_seed(3).ground == level.ground


def test_a_walk_may_be_the_user_s_own_file(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(FILE, encoding="utf-8")
    assert is_walk(str(path))
    assert load_walk(str(path)).name == "mine"
    assert not is_walk("ladder")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (["way=[]"], "way"),
        (["way.0.turn=1deg"], "one of: direction"),
        (["way.0={ direction = '0 deg' }"], "both direction and distance"),
        (["way.0={ turn = '0 deg' }"], "must not be 0"),
        (["way.0={ direction = '0 deg', distance = '1 m', about = ['0 m', '0 m'] }"], "is for a piece with 'turn'"),
        (["arm=['0 deg']"], "4 entries"),
        (["ground.slope=30deg"], "legs of"),
        (["start.x=20m"], "no ground"),
        (["start.twist=60deg"], "start.*actuators of .* they can be 50 to 300 mm"),
        (["start.offset=['0 m', '0.12 m']", "start.twist=40deg"], "of the way to a singular posture.*0.9 is allowed"),
        (["robot=libra"], "must be 'walker'"),
        (["ground=slop"], "slope"),
        (["wey=1"], "way"),
        (["start.plate=tilted"], "level"),
        (["way=[{ twist = { vx = '1 mm/s' } }]"], "both twist and lasts"),
        (["way=[{ twist = {}, lasts = '1 s' }]"], "way.0.twist.*must not be 0"),
        (["way=[{ twist = { vx = '1 mm' }, lasts = '1 s' }]"], "way.0.twist.vx.*no unit of speed"),
        (["way=[{ twist = { vz = '1 mm/s' }, lasts = '1 s' }]"], "vz.*unknown key; allowed are vx, vy, omega"),
        (["way=[{ twist = { omega = '1 deg/s' }, lasts = '-1 s' }]"], "way.0.lasts.*more than 0 s"),
        (["way=[{ through = [] }]"], "a place or more"),
        (["way=[{ through = [{ x = '1 m' }] }]"], "way.0.through.0.y"),
        (["way=[{ through = [{ x = '1 m', y = '0 m' }], turn = '3 deg' }]"], "must state one of"),
        (["way=[{ path = 3 }]"], "way.0.path"),
        (["way=[{ path = 'gone.csv' }]"], "gone.csv: does not exist"),
        (["way=[{ path = 'gone.csv', through = [] }]"], "not both"),
        (["hold={ x = '1 m', y = '0.3 m' }"], "hold.z"),
        (["hold={ x = '1 m', y = '0.3 m', z = '0.6 s' }"], "hold.z"),
        (["hold={ x = '1 m', y = '0.3 m', z = '0.6 m', within = '0 m' }"], "hold.within"),
        (["hold={ x = '1 m', y = '0.3 m', z = '0.6 m', wihtin = '1 m' }"], "wihtin"),
    ],
)  # fmt: skip
def test_what_cannot_be_walked_is_named(changes: list[str], words: str) -> None:
    with pytest.raises(ClamberError, match=words):
        load_walk("slope-walk", changes)


def test_a_payload_needs_an_arm(tmp_path: Path) -> None:
    from clamber.families.walker.family import WALKER

    text = (WALKER.data / "robots" / "hoshino.toml").read_text(encoding="utf-8")
    (tmp_path / "armless.toml").write_text(text[: text.index("[arm]")], encoding="utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(FILE.replace('"hoshino"', '"armless.toml"'), encoding="utf-8")
    assert load_walk(str(path)).arm == ()
    with pytest.raises(SpecError, match="needs an arm"):
        load_walk(str(path), ["payload=1kg"])
    with pytest.raises(SpecError, match="hold"):
        load_walk(str(path), ["hold={ x = '1 m', y = '0.3 m', z = '0.6 m' }"])


def test_a_place_is_a_piece_of_the_way() -> None:
    walk = load_walk("level-walk", ("way=[{to=['1 m', '0.5 m'], heading='20 deg'}]",))
    assert walk.way[0].to == (1.0, 0.5) and walk.way[0].heading == pytest.approx(math.radians(20.0))
    with pytest.raises(SpecError, match="one of: direction"):
        load_walk("level-walk", ("way=[{to=['1 m', '0.5 m'], turn='20 deg'}]",))
    with pytest.raises(SpecError, match="heading"):
        load_walk("level-walk", ("way=[{turn='20 deg', heading='20 deg'}]",))


def test_a_twist_covers_the_way_that_its_time_makes() -> None:
    walk = load_walk(
        "level-walk", ("way=[{ twist = { vx = '2 mm/s', vy = '-1 mm/s', omega = '0.1 deg/s' }, lasts = '5 min' }]",)
    )
    assert walk.way[0].twist == BodyTwist(vx=0.002, vy=-0.001, omega=math.radians(0.1))
    np.testing.assert_allclose(walk.way[0].whole_twist(), (0.6, -0.3, math.radians(30.0)))


PATH = """# measured on the plan
x [mm], y [m], heading [deg]
0, 0, 0

500, 0.5, 90
"""


def test_a_path_is_read_beside_the_walk_and_from_where_an_override_is_typed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "path.csv").write_text(PATH, encoding="utf-8")
    mine = tmp_path / "there" / "mine.toml"
    mine.write_text(FILE.replace('direction = "0 deg", distance = "1 m"', 'path = "path.csv"'), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    for walk in (load_walk(str(mine)), load_walk("level-walk", ("way=[{ path = 'there/path.csv' }]",))):
        np.testing.assert_allclose(walk.way[0].poses(2.0), ((0.0, 0.0, 0.0), (0.5, 0.5, math.pi / 2)))
        (tmp_path / "there" / "path.csv").rename(tmp_path / "there" / "gone.csv")
        again = walk_from_document(walk.document)  # a worker needs no file
        assert again.way == walk.way
        (tmp_path / "there" / "gone.csv").rename(tmp_path / "there" / "path.csv")
    with pytest.raises(ClamberError, match=r"path.csv: does not exist"):
        load_walk(str(mine), ("way.0.path='path.csv'",))


def test_places_without_a_heading_keep_the_one_before() -> None:
    walk = load_walk(
        "level-walk",
        ("way=[{ through = [{x='1 m', y='0 m'}, {x='1 m', y='1 m', heading='1 rad'}, {x='2 m', y='1 m'}] }]",),
    )
    np.testing.assert_allclose(walk.way[0].poses(0.5)[:, 2], (0.5, 1.0, 1.0))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "has no places"),
        ("x [m], y [m]\n", "has no places"),
        ("x [m]\n1\n", "names no column y"),
        ("x [m], y [m], z [m]\n", "column 'z \\[m\\]'; there are x, y, heading"),
        ("x, y\n", "names no unit of x; write 'x \\[m\\]'"),
        ("x [m], x [m]\n", "names x twice"),
        ("x [m], y [deg]\n", "'y \\[deg\\]' is no unit of length"),
        ("x [m], y [m]\n1, 2, 3\n", ":2: has 3 columns"),
        ("x [m], y [m]\n1, two\n", ":2: y = 'two'"),
        ("x [m], y [m]\n1, inf\n", ":2: y = 'inf'"),
        ("x [m], y [m]\n1, 1e300\n", "through.0.y.*far too large"),
        ("x [m], y [m]\n" + 10_001 * "1, 2\n", "is place 10001; a path has at most 10000"),
    ],
)
def test_a_file_that_is_no_path_is_named_with_its_line(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "path.csv").write_text(text, encoding="utf-8")
    with pytest.raises(ClamberError, match=words):
        load_walk("level-walk", (f"way=[{{ path = '{tmp_path / 'path.csv'}' }}]",))
