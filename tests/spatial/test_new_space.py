"""`clamber new world` and `clamber new task` for robots in space: files that build, starts that hold, and mistakes that are named."""

import copy
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.errors import SpecError
from clamber.families.spatial.planning.first_task import first_task, fit_named
from clamber.families.spatial.planning.problem import SpatialProblem
from clamber.families.spatial.robot import contact_kinds
from clamber.families.spatial.world.made import Fit, Kind, Wanted, world_data
from clamber.families.spatial.world.world import World, build_world
from clamber.files import Document
from clamber.tasks import load_task
from clamber.tasks.library import task_from_document, task_names
from clamber.toml_text import toml_text

Run = Callable[..., tuple[int, str, str]]
FITTING = {
    "quadruped": (Kind.stones,),
    "hexapod": (Kind.stones, Kind.chimney),
    "gripper-climber": (Kind.wall, Kind.overhang, Kind.ceiling, Kind.chimney),
    "magnet-quadruped": (Kind.corner,),
    "clamp-triped": (Kind.wall,),
    "inchworm": (Kind.wall,),
}  # fmt: skip


def made(kind: Kind, **sizes: float | int) -> World:
    return build_world(Document("made", world_data(Wanted(kind=kind, **sizes), Fit(), "made")))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("kind", "angle", "up", "normal"),
    [
        (Kind.stones, None, (1, 0, 0), (0, 0, 1)),
        (Kind.slope, 45.0, (math.sqrt(0.5), 0, math.sqrt(0.5)), (-math.sqrt(0.5), 0, math.sqrt(0.5))),
        (Kind.wall, None, (0, 0, 1), (-1, 0, 0)),
        (Kind.overhang, 30.0, (-0.5, 0, math.sqrt(0.75)), (-math.sqrt(0.75), 0, -0.5)),
        (Kind.ceiling, None, (-1, 0, 0), (0, 0, -1)),
    ],
)
def test_a_surface_leans_as_it_is_called(
    kind: Kind, angle: float | None, up: tuple[float], normal: tuple[float]
) -> None:
    world = made(kind, bumps=0.0, **({} if angle is None else {"angle": angle}))
    assert world.frames[:, 3:6] == pytest.approx(np.broadcast_to(up, (len(world.frames), 3)), abs=1e-5)
    assert world.normals == pytest.approx(np.broadcast_to(normal, world.normals.shape), abs=1e-5)
    assert (world.places @ np.array(normal)) == pytest.approx(0.0, abs=1e-5)


def test_the_walls_of_a_chimney_face_each_other_over_its_gap() -> None:
    world = made(Kind.chimney, gap=0.5, bumps=0.0)
    sides = np.sign(world.places[:, 1])
    assert world.places[:, 1] == pytest.approx(0.25 * sides) and world.normals[:, 1] == pytest.approx(-sides)
    assert 0.4 < float((sides > 0).mean()) < 0.6


def test_the_same_seed_makes_the_same_world_and_another_one_another() -> None:
    assert np.array_equal(made(Kind.wall, seed=3).places, made(Kind.wall, seed=3).places)
    assert not np.array_equal(made(Kind.wall, seed=3).places, made(Kind.wall, seed=4).places)


def test_solids_lie_below_every_hold() -> None:
    for kind in Kind:
        world = made(kind)
        for solid in world.solids:
            over = (world.places - np.array(solid.at)) @ np.array(solid.normal)
            assert over.min() > -1e-3, kind


@pytest.mark.slow
@pytest.mark.parametrize(("robot", "kind"), [(robot, kind) for robot, kinds in FITTING.items() for kind in kinds])
def test_a_new_task_starts_where_every_check_holds(robot: str, kind: Kind, tmp_path: Path) -> None:
    world = tmp_path / "world.toml"
    world.write_text(toml_text(world_data(Wanted(kind=kind), fit_named(robot), "world")))
    (tmp_path / "task.toml").write_text(toml_text(first_task(robot, str(world), "task")))
    task = load_task(str(tmp_path / "task.toml"))
    replay = SpatialProblem(task, 1, exact=True)  # type: ignore[arg-type]
    assert float(replay.start["share"][0]) >= 0.05
    assert task.goals[0].along_min > 2.0 * fit_named(robot).reach


def test_feet_do_not_start_on_a_wall_and_the_error_says_why(tmp_path: Path) -> None:
    world = tmp_path / "world.toml"
    world.write_text(toml_text(world_data(Wanted(kind=Kind.wall), fit_named("quadruped"), "world")))
    with pytest.raises(SpecError, match=r"violate 'equilibrium'.* places near the guide's beginning were tried"):
        first_task("quadruped", str(world), "task")


def test_a_world_out_of_reach_is_told_by_the_distance_of_its_nearest_hold(tmp_path: Path) -> None:
    world = world_data(Wanted(kind=Kind.stones), fit_named("quadruped"), "world")
    world["patterns"][0]["height"] = "-3 m"
    world["solids"] = []
    (tmp_path / "world.toml").write_text(toml_text(world))
    with pytest.raises(SpecError, match=r"violate 'reach'; the nearest hold to the tip of \w+ is \d+, 3 m away"):
        first_task("quadruped", str(tmp_path / "world.toml"), "task")


def test_a_stated_start_step_or_goal_is_kept(tmp_path: Path) -> None:
    world = tmp_path / "world.toml"
    world.write_text(toml_text(world_data(Wanted(kind=Kind.stones), fit_named("quadruped"), "world")))
    said = ["start.along=0.3m", "start.height=0.26m", "step.length=40mm", "goal.along_min=1m", "rules.need=0.02"]
    data = first_task("quadruped", str(world), "task", said)
    assert data["start"] == {"height": "0.26m", "along": "0.3m"} and data["goal"] == {"along_min": "1m"}
    assert data["step"]["length"] == "40mm" and data["rules"] == {"need": 0.02}


@pytest.mark.slow
def test_commands_write_files_that_check_likes(clamber: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, err = clamber("new", "world", "stones", "--robot", "quadruped", "--seed", "2", "-o", "w.toml", "--json")
    assert code == 0, err
    told = json.loads(out)
    assert told["written"] == {"world": "w.toml"} and told["holds"] > 100 and told["length_m"] > 1.0
    code, out, err = clamber("new", "task", "--robot", "quadruped", "--world", "w.toml", "-o", "t.toml", "--json")
    assert code == 0 and json.loads(out)["start"]["height"], err
    for name in ("w.toml", "t.toml"):
        code, out, err = clamber("check", name, "--json")
        assert code == 0 and json.loads(out)["odd"] == [], (out, err)
    assert "clamber new task" not in err
    code, _, err = clamber("new", "world", "-o", "w.toml")
    assert code == 2 and "is there already" in err and "--force" in err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("world", "wall", "--length", "2"), "--length = '2': lacks its unit"),
        (("world", "wall", "--length", "0.1mm"), "must be 0.001 m to 1000 m"),
        (("world", "slope", "--angle", "100deg"), "--angle = '100deg': must be 0 deg to 90 deg"),
        (("world", "wall", "--gap", "1m"), "is of chimney"),
        (("world", "wall", "--angle", "10deg"), "is of slope and overhang"),
        (("world", "wall", "--robot", "libra"), "--robot: 'libra' is no robot in space"),
        (("world", "wall", "--spacing", "1mm"), "a world may have 60000"),
        (("task", "--robot", "libra", "--world", "stones"), "--world: is no place for a limbed climber"),
        (("task", "--robot", "quadruped"), "needs one: clamber new world"),
        (("task", "--robot", "quadruped", "--world", "nowhere"), "no world is called 'nowhere'"),
        (("task", "--robot", "quadruped", "--world", "stones", "--board", "h"), "are worlds of different robots"),
    ],
)
def test_mistakes_are_named(
    clamber: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, err = clamber("new", *words, "-o", "new.toml")
    assert code == 2 and told in " ".join(err.replace("│", " ").split()), err
    assert not (tmp_path / "new.toml").exists()


def test_a_limbs_contact_and_its_numbers_are_set_and_kept() -> None:
    task: Any = load_task("wall-gripper", ["limb.LF.contact=magnet", "contacts.gripper.pull=20 N"])
    for one in (task, task_from_document(task.document)):
        assert [end.kind for end in one.robot.ends] == ["magnet", "gripper", "gripper", "gripper"]
        assert {end.pull for end in one.robot.ends[1:]} == {20.0}
    assert task.hashes["robot"] != load_task("wall-gripper").hashes["robot"]
    with pytest.raises(
        SpecError, match=r"limb\.0\.contact = 'glue': no contact is called 'glue'; there are area, clamp"
    ):
        load_task("wall-gripper", ["limb.LF.contact=glue"])
    with pytest.raises(SpecError, match=r"contacts\.gripper\.pull=-2 N: pull = .* must be more than 0 N"):
        load_task("wall-gripper", ["contacts.gripper.pull=-2 N"])


def test_a_stored_task_has_no_say_in_which_files_are_read(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text((Path(contact_kinds.__file__).parent.parent / "data/contacts/magnet.toml").read_text())
    task: Any = load_task("wall-gripper", [f"limb.LF.contact={file}"])
    assert task_from_document(task.document).robot.ends[0].kind == "magnet"
    document = copy.deepcopy(task.document)
    del document["robot"]["contacts"][str(file)]
    with pytest.raises(SpecError, match=r"limb\.0\.contact = .* must be one of 'contacts', or come with Clamber"):
        task_from_document(document)


def test_lists_tell_of_worlds_and_of_the_family_of_every_task(clamber: Run) -> None:
    listed = json.loads(clamber("list", "--json")[1])
    assert {"bumpy-wall", "stones"} <= {entry["name"] for entry in listed["worlds"]}
    families = {entry["name"]: entry["family"] for entry in listed["tasks"]}
    assert families.keys() == set(task_names())
    assert (families["ladder"], families["wall-gripper"], families["patch-walk"]) == ("limbed", "spatial", "walker")
