"""The path of a newcomer: from a URDF to a picture of a plan by the commands of docs/space.md."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from quadruped_urdf import urdf

PAGE = Path(__file__).parents[2] / "docs" / "space.md"


def test_five_commands_lead_from_a_urdf_to_a_picture(
    clamber: Callable[..., tuple[int, str, str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "go2.urdf").write_text(urdf())
    block = re.search(r"## From URDF to plan in five commands\n```\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert block is not None
    commands = block[1].strip().splitlines()
    assert len(commands) == 5
    for command in commands:
        words = command.split()[1:]
        if words[0] == "plan":  # a metre of the five
            words += ["--set", "goal={ along_min = '1 m' }"]
        code, out, err = clamber(*words)
        assert code == 0, f"{command}\n{out}\n{err}"
    told = (tmp_path / "go2.toml").read_text()
    assert "guess" in told and told.count("[[limb]]") == 4
    assert (tmp_path / "go2-plan.png").stat().st_size > 20_000
