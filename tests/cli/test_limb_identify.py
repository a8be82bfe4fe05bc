import json
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from clamber.cli import main
from clamber.execution.log_files import read_log, write_log


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recorded log of one limb."""
    path = tmp_path_factory.mktemp("logs") / "right.mcap"
    with pytest.raises(SystemExit):
        main(("limb", "record", "right", "-o", str(path), "--seed", "1", "-q"))
    return path


@pytest.mark.slow
def test_a_recorded_log_is_identified_in_a_table_of_eighty_columns(clamber: Any, log: Path) -> None:
    code, text, _ = clamber("limb", "identify", str(log))
    assert code == 0
    for word in ("right shoulder", "right elbow", "inertia", "amplifier gain", "backlash", "constant torques alone"):
        assert word in text
    assert max(map(len, text.splitlines()[1:])) <= 80


@pytest.mark.slow
def test_json_a_picture_and_lines_for_a_robot_file_come_from_the_same_log(
    clamber: Any, log: Path, tmp_path: Path
) -> None:
    picture, lines = tmp_path / "a.png", tmp_path / "a.toml"
    words = ("limb", "identify", str(log), "--joint", "right elbow", "--json", "-o")
    code, out, _ = clamber(*words, str(picture))
    assert code == 0
    shown = json.loads(out)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert clamber(*words, str(lines))[0] == 0
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
    clamber: Any,
    log: Path,
    words: tuple[str, ...],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, err = clamber("limb", *(word.replace("{log}", str(log)) for word in words))
    assert code == 2
    assert message in err
    assert list(tmp_path.iterdir()) == []


def test_a_log_that_tells_nothing_says_what_it_would_need_and_leaves_with_one(clamber: Any, tmp_path: Path) -> None:
    still = tmp_path / "still.csv"
    still.write_text("time [ms],q [deg]\n" + "".join(f"{5 * k},30\n" for k in range(100)))
    code, text, _ = clamber("limb", "identify", str(still))
    assert code == 1
    assert "inertia: not in this log: needs torque" in text
    assert "backlash: not in this log: needs an angle measured behind the gear" in text


@pytest.mark.slow
def test_what_no_joint_can_have_is_warned_of(clamber: Any, log: Path, tmp_path: Path) -> None:
    kept = read_log(log)
    driven = ("current", "command", "torque")
    assert any(word in name for name in kept.columns for word in driven)
    turned = {name: -rows if any(word in name for word in driven) else rows for name, rows in kept.columns.items()}
    write_log(replace(kept, columns=turned), tmp_path / "turned.csv")
    _, out, err = clamber("limb", "identify", str(tmp_path / "turned.csv"))
    assert "its inertia came out below 0, which cannot be" in " ".join((out + err).split())
    assert "below 0" not in "".join(clamber("limb", "identify", str(log))[1:])


@pytest.mark.slow
@pytest.mark.parametrize("constant", [0.0, 0.3])  # currents and commands are what torques come from
@pytest.mark.parametrize("word", ["current", "command", "angle"])
def test_columns_that_never_change_end_in_an_error_or_an_answer(
    clamber: Any, log: Path, tmp_path: Path, word: str, constant: float
) -> None:
    kept = read_log(log)
    columns = {
        name: np.full_like(values, constant) if word in name else values for name, values in kept.columns.items()
    }
    assert any(word in name for name in columns)
    write_log(replace(kept, columns=columns), tmp_path / "constant.csv")
    code, out, err = clamber("limb", "identify", str(tmp_path / "constant.csv"))
    assert code in (0, 1, 2) and "Traceback" not in err
    assert (err.startswith("clamber: ") and "constant.csv" in err) if code == 2 else "inertia" in out
