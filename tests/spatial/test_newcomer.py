"""The path of a newcomer: from a URDF to a picture of a plan by the commands of docs/space.md."""

import json
import re
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest

Run = Callable[..., tuple[int, str, str]]
PAGE = Path(__file__).parents[2] / "docs" / "space.md"
LEG = """
<link name="{n}_hip"><inertial><origin xyz="0 {s}0.05 0"/><mass value="0.6"/>
  <inertia ixx="8e-4" iyy="8e-4" izz="8e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="{n}_hip_joint" type="revolute"><parent link="base"/><child link="{n}_hip"/><origin xyz="{x} {y} 0"/><axis xyz="1 0 0"/>
  <limit lower="-0.8" upper="0.8" effort="23" velocity="20"/></joint>
<link name="{n}_thigh"><inertial><origin xyz="0 0 -0.1"/><mass value="1.1"/>
  <inertia ixx="5e-3" iyy="5e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><origin xyz="0 0 -0.1"/><geometry><box size="0.03 0.03 0.2"/></geometry></collision></link>
<joint name="{n}_thigh_joint" type="revolute"><parent link="{n}_hip"/><child link="{n}_thigh"/>
  <origin xyz="0 {s}0.09 0"/><axis xyz="0 1 0"/><limit lower="-1.5" upper="3.4" effort="23" velocity="20"/></joint>
<link name="{n}_calf"><inertial><origin xyz="0 0 -0.1"/><mass value="0.25"/>
  <inertia ixx="1e-3" iyy="1e-3" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="{n}_calf_joint" type="revolute"><parent link="{n}_thigh"/><child link="{n}_calf"/><origin xyz="0 0 -0.21"/><axis xyz="0 1 0"/>
  <limit lower="-2.7" upper="-0.85" effort="45" velocity="15"/></joint>
<link name="{n}_foot"/>
<joint name="{n}_foot_joint" type="fixed"><parent link="{n}_calf"/><child link="{n}_foot"/><origin xyz="0 0 -0.21"/></joint>
"""
"""A leg of a quadruped of the Go2's size, made up."""


def urdf() -> str:
    legs = "".join(
        LEG.format(n=name, x=x, y=y, s="" if y > 0 else "-")
        for name, x, y in (("FL", 0.19, 0.05), ("FR", 0.19, -0.05), ("RL", -0.19, 0.05), ("RR", -0.19, -0.05))
    )
    base = (
        '<link name="base"><inertial><mass value="7"/><inertia ixx="0.03" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
        '<visual><geometry><mesh filename="package://go2/meshes/base.dae"/></geometry></visual>'
        '<collision><geometry><box size="0.37 0.09 0.11"/></geometry></collision></link>'
    )
    return f'<robot name="go2">{base}{legs}</robot>'


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


@pytest.mark.slow
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
