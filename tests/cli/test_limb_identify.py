import json
import tomllib
from pathlib import Path

import pytest

from clamber.cli import main


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recorded log of one limb."""
    path = tmp_path_factory.mktemp("logs") / "right.mcap"
    main_or_exit("limb", "record", "right", "-o", str(path), "--seed", "1", "-q")
    return path


def main_or_exit(*words: str) -> int:
    try:
        main(words)
    except SystemExit as left:
        return int(left.code or 0)
    return 0


def test_a_recorded_log_is_identified_in_a_table_of_eighty_columns(
    log: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert main_or_exit("limb", "identify", str(log)) == 0
    text = capsys.readouterr().out
    for word in ("right shoulder", "right elbow", "inertia", "amplifier gain", "backlash", "constant torques alone"):
        assert word in text
    assert max(map(len, text.splitlines()[1:])) <= 80


def test_json_a_picture_and_lines_for_a_robot_file_come_from_the_same_log(
    log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture, lines = tmp_path / "a.png", tmp_path / "a.toml"
    words = ("limb", "identify", str(log), "--joint", "right elbow", "--json", "-o")
    assert main_or_exit(*words, str(picture)) == 0
    shown = json.loads(capsys.readouterr().out)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert main_or_exit(*words, str(lines)) == 0
    table = tomllib.loads(lines.read_text())["limbs"]["elbow"]
    told = {estimate["name"]: estimate["value"] for estimate in shown["joints"][0]["estimates"]}
    assert table["inertia"]["value"] == pytest.approx(told["inertia"], rel=1e-5)
    assert table["damping"]["unit"] == "N m s/rad"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("identify", "nowhere.csv"), "does not exist"),
        (("identify", "log.bag"), "no log has the suffix"),
        (("identify", "{log}", "--robot", "librra"), "librra"),
        (("identify", "{log}", "--limb", "tail"), "tail"),
        (("identify", "{log}", "--joint", "knee"), "no such joint"),
        (("identify", "{log}", "--column", "x"), "must be COLUMN=ROLE"),
        (("identify", "{log}", "--column", "x=time"), "no such column"),
        (("identify", "{log}", "--gear", "-3"), "state a finite number over 0"),
        (("identify", "{log}", "--torque-constant", "3 kg"), "is no unit of torque constant"),
        (("identify", "{log}", "-o", "a.xyz"), ".xyz"),
        (("record", "-o", "a.xyz"), "no log has the suffix"),
        (("record", "tail", "-o", "a.csv"), "tail"),
        (("record", "-o", "a.csv", "--set", "backlash=-1deg"), "must be 0 or more"),
        (("record", "-o", "a.csv", "--current-noise", "-1"), "noise.current"),
    ],
)
def test_bad_input_is_named_and_nothing_is_written(
    log: Path,
    words: tuple[str, ...],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main_or_exit("limb", *(word.replace("{log}", str(log)) for word in words)) == 2
    assert message in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_log_that_tells_nothing_says_what_it_would_need_and_leaves_with_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    still = tmp_path / "still.csv"
    still.write_text("time [ms],q [deg]\n" + "".join(f"{5 * k},30\n" for k in range(100)))
    assert main_or_exit("limb", "identify", str(still)) == 1
    text = capsys.readouterr().out
    assert "inertia: not in this log: needs torque" in text
    assert "backlash: not in this log: needs an angle measured behind the gear" in text
