"""Robots, boards and grounds are shown without a task, and files of other programs are told from them."""

from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

from clamber.families.climber.pictures.pictures import climber_alone
from clamber.families.climber.robot.robot import build_limbed
from clamber.tasks.robots import read_robot
from clamber.viewing.browser.viewer_content import open_exhibit

Clamber = Callable[..., tuple[int, str, str]]


@pytest.mark.parametrize("name", ["libra", "gecko4", "hoshino", "gecko-wall", "terrace"])
def test_a_shipped_robot_board_or_ground_is_drawn(clamber: Clamber, tmp_path: Path, name: str) -> None:
    picture = tmp_path / "alone.png"
    assert clamber("show", name, "-o", str(picture))[:2] == (0, f"written to {picture}\n")
    with Image.open(picture) as image:
        colours = image.convert("RGB").getcolors(2**24)
    assert colours is not None and len(colours) > 20  # not an empty page


def test_own_files_are_drawn(clamber: Clamber, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    clamber("new", "robot", "--limbs", "5", "-o", "mine.toml")
    clamber("new", "board", "-o", "wall.toml")
    Path("holds.csv").write_text("x [cm],y [cm]\n0,0\n20,10\n5,40\n")
    for thing in ("mine.toml", "wall.toml", "holds.csv"):
        code, _, err = clamber("show", thing, "-o", "alone.svg")
        assert (code, err) == (0, ""), thing
        assert Path(thing).stem in Path("alone.svg").read_text(encoding="utf-8") or thing == "holds.csv"


def test_limbs_alone_are_drawn_within_their_joints() -> None:
    document = read_robot("libra")
    shown = climber_alone(build_limbed(document), document.data)
    assert shown.at.posture.held == (-1, -1, -1)
    x0, x1, y0, y1 = shown.bounds
    tips = shown.at.posture.chains[:, 3]
    assert ((tips > (x0, y0)) & (tips < (x1, y1))).all()


@pytest.mark.parametrize("name", ["libra", "hoshino", "gecko-wall", "step"])
def test_the_viewer_opens_one_alone(clamber: Clamber, tmp_path: Path, name: str) -> None:
    exhibit = open_exhibit([name])
    assert exhibit.task is None
    assert exhibit.main.seconds == 0.0
    page = tmp_path / "alone.html"
    assert clamber("view", name, "-o", str(page))[0] == 0
    assert name in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("options", [("--step", "1"), ("--torques",), ("--set", "start.x=0m")])
def test_options_of_plans_are_refused(clamber: Clamber, options: tuple[str, ...]) -> None:
    code, _, err = clamber("show", "libra", *options)
    assert code == 2
    assert "is for tasks and plans" in err


@pytest.mark.parametrize(
    ("file", "text", "told"),
    [
        (
            "quad.urdf",
            "<robot/>",
            "quad.urdf: is a URDF robot model; `clamber new robot --from quad.urdf -o quad.toml`",
        ),
        ("quad.xml", "<mujoco/>", "quad.xml: is a robot model (MJCF or URDF); `clamber new robot --from quad.xml"),
        ("part.stl", "solid", "part.stl: is a mesh; `clamber new world --mesh part.stl -o part.toml` makes a world in"),
        ("part.glb", "glTF", "makes a world in space of an STL, OBJ or PLY file, so convert it first"),
        ("robots/mine.toml", "", "robots: is a folder; name a file in it, such as mine.toml"),
    ],
)
@pytest.mark.parametrize("command", ["check", "show", "view", "plan", "run"])
def test_another_kind_of_file_is_told(
    clamber: Clamber, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str, file: str, text: str, told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / file).parent.mkdir(exist_ok=True)
    (tmp_path / file).write_text(text)
    code, _, err = clamber(command, file.split("/")[0])
    assert code == 2
    assert told in " ".join(err.split())


def test_a_robot_in_place_of_a_task_is_told(clamber: Clamber, tmp_path: Path) -> None:
    mine = tmp_path / "mine.toml"
    clamber("new", "robot", "-o", str(mine))
    code, _, err = clamber("plan", str(mine))
    assert code == 2
    assert "it must be a task" in err and f"`clamber show {mine}` draws a robot" in err
