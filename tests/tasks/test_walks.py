"""Walks from files: ways as twists, starts against the simulation, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

from clamber.errors import ClamberError, SpecError
from clamber.sim.walker_flaws import WalkerFlaws
from clamber.sim.walker_plant import WalkerSim
from clamber.tasks.walks import is_walk, load_walk, walk_names
from clamber.tasks.walks.library import walk_from_document
from clamber.tasks.walks.walk import Piece

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
    x, y, turn = Piece(turn=0.5, about=about).twist()
    assert (x - turn * about[1], y + turn * about[0]) == pytest.approx((0.0, 0.0))
    assert Piece(direction=math.pi / 2, distance=2.0).twist() == pytest.approx((0.0, 2.0, 0.0))


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
        (["way.0.turn=1deg"], "one of the three"),
        (["way.0={ direction = '0 deg' }"], "both direction and distance"),
        (["way.0={ turn = '0 deg' }"], "must not be 0"),
        (["way.0={ direction = '0 deg', distance = '1 m', about = ['0 m', '0 m'] }"], "is for a turn"),
        (["arm=['0 deg']"], "4 entries"),
        (["ground.slope=30deg"], "legs of"),
        (["start.x=20m"], "no ground"),
        (["robot=libra"], "must be 'walker'"),
        (["ground=slop"], "slope"),
        (["wey=1"], "way"),
        (["start.plate=tilted"], "level"),
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
    from clamber.robots.library import DATA

    text = (DATA / "hoshino.toml").read_text(encoding="utf-8")
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
    with pytest.raises(SpecError, match="place alone"):
        load_walk("level-walk", ("way=[{to=['1 m', '0.5 m'], turn='20 deg'}]",))
    with pytest.raises(SpecError, match="heading"):
        load_walk("level-walk", ("way=[{turn='20 deg', heading='20 deg'}]",))
