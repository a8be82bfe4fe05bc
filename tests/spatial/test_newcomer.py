"""The path of a newcomer: from a URDF to a picture of a plan by the commands of docs/space.md."""

import json
import re
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest

from quadruped_urdf import urdf

Run = Callable[..., tuple[int, str, str]]
PAGE = Path(__file__).parents[2] / "docs" / "space.md"


def follow_the_page(run: Run, robots: Path, folder: Path, goal: str = "") -> None:
    """Carry out the page's five commands in a folder, with another goal if it is named."""
    block = re.search(r"## From URDF to plan in five commands\n.*?```\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert block is not None
    commands = block[1].strip().splitlines()
    assert len(commands) == 5
    for command in commands:
        words = command.replace("$ROBOTS", str(robots)).split()[1:]
        if words[0] == "plan" and goal:
            words += ["--set", goal]
        code, out, err = run(*words)
        assert code == 0, f"{command}\n{out}\n{err}"
    told = (folder / "go2.toml").read_text()
    assert "guess" in told and told.count("[[limb]]") == 4
    assert (folder / "plan.png").stat().st_size > 20_000
    code, out, _ = run("check", "plan.json", "--json")
    verdict = json.loads(out)
    assert code == 0 and verdict["reached"]


def test_five_commands_lead_from_a_urdf_to_a_picture(
    clamber: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "go2_description" / "urdf").mkdir(parents=True)
    (tmp_path / "go2_description" / "urdf" / "go2.urdf").write_text(urdf())
    follow_the_page(clamber, tmp_path, tmp_path, "goal={ along_min = '1 m' }")


@pytest.mark.long
def test_the_same_commands_do_with_the_model_of_example_robot_data(
    clamber: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    try:
        files = distribution("example-robot-data").files or []
    except PackageNotFoundError:
        pytest.skip("needs the extra `models`")
    model = next(file for file in files if str(file).endswith("robots/go2_description/urdf/go2.urdf"))
    monkeypatch.chdir(tmp_path)
    follow_the_page(clamber, Path(str(model.locate())).parents[2], tmp_path)
