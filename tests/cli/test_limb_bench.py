"""`clamber limb step|circle|push`: tables, pictures, JSON, exit codes, and mistakes in one line."""

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from clamber.cli import main
from clamber.control.law_settings import LAWS


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setenv("COLUMNS", "80")

    def call(*words: str) -> tuple[int, str, str]:
        capfd.readouterr()
        try:
            main(words)
            code = 0
        except SystemExit as left:
            code = left.code if isinstance(left.code, int) else 0 if left.code is None else 1
        out, err = capfd.readouterr()
        return code, out, err

    return call


SHORT = {
    "step": ("--seconds", "1"),
    "circle": ("--lap", "1"),
    "push": ("--from", "0.1", "--to", "0.4", "--seconds", "1"),
}


@pytest.mark.parametrize("kind", SHORT)
@pytest.mark.parametrize("flaws", ["ideal", "nominal"])
def test_the_usual_laws_are_compared_within_80_columns(run: Any, kind: str, flaws: str) -> None:
    code, out, _ = run("limb", kind, *SHORT[kind], "--flaws", flaws, "--all", "-q")
    assert code == 0
    assert max(map(len, out.splitlines())) <= 80
    for label in ("scct", "jacobian-transpose", "operational-space", "joint-pd", "resolved-rate"):
        assert label in out
    assert "matched by 'yy'" in out
    assert ("by encoders" in out) == (flaws == "nominal")


@pytest.mark.parametrize("match", ["yy", "mean", "diagonal", "none"])
def test_the_table_says_what_was_matched(run: Any, match: str) -> None:
    _, out, _ = run("limb", "step", "-c", "scct", *SHORT["step"], "--match", match)
    assert ("not matched" if match == "none" else f"matched by '{match}'") in out


def test_json_is_one_value_with_its_schema(run: Any) -> None:
    code, out, _ = run("limb", "step", "-c", "scct", "-c", "joint-pd", *SHORT["step"], "--seed", "3", "--json")
    told = json.loads(out)
    assert code == 0
    assert set(told) == {
        *("schema", "scenario", "limb", "plant", "match", "beyond_limits", "seed", "trials", "laws"),
    }
    assert told["schema"] == "clamber-limb-1" and told["plant"]["seed"] == 3
    assert [law["label"] for law in told["laws"]] == ["scct", "joint-pd"]


def test_results_are_written_as_picture_json_and_csv(run: Any, tmp_path: Path) -> None:
    for suffix in ("png", "json", "csv"):
        path = tmp_path / f"laws.{suffix}"
        code, out, _ = run("limb", "push", "-c", "scct", *SHORT["push"], "-o", str(path))
        assert code == 0 and "written to" in out
    assert (tmp_path / "laws.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads((tmp_path / "laws.json").read_text())["scenario"]["kind"] == "push"
    assert next(csv.DictReader((tmp_path / "laws.csv").read_text().splitlines()))["law"] == "scct"


def test_one_comes_out_where_every_law_is_unstable(run: Any) -> None:
    wild = ("-c", "scct:kp=4000,kd=0", "--set", "delay=6", *SHORT["step"])
    code, out, _ = run("limb", "step", *wild)
    assert code == 1 and "unstable" in out
    assert run("limb", "step", *wild, "-c", "scct")[0] == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("step", "--kd", "-1"), "kd = -1.0: must be 0 or more"),
        (("step", "-c", "scct:kd=-1"), "scct: kd = -1.0: must be 0 or more"),
        (("step", "--set", "damping=-1"), "plant: damping = -1.0: must be 0 or more"),
        (("step", "--start", "311mm,0"), "is singular"),
        (("step", "--start", "40cm,0"), "start (0.4, 0) m is out of reach"),
        (("step", "-c", "sct"), "did you mean 'scct'?"),
        (("step", "--by", "10cm,0"), "step: target = (0.32, 0) m: must be"),
        (("circle", "--centre", "15cm,0", "--radius", "17cm", "--start", "15cm,17cm"), "circle: target = (0.32, 0) m"),
        (("circle", "--start", "22cm,0"), "circle: start = (0.22, 0) m: must lie on the circle"),
        (("push", "--force", "0,0"), "push: force"),
        (("push", "--from", "3", "--to", "2"), "must start at 0 s or later"),
        (("step", "--set", "control_rate=300Hz"), "control_rate = 300 Hz: must divide the physics rate of 2000 Hz"),
        (("step", "--set", "bakclash=2deg"), "did you mean 'backlash'?"),
        (("step", "--set", "backlash=2"), "lacks its unit"),
        (("step", "--plant", "mojuco"), "no plant is called 'mojuco'"),
        (("step", "--limb", "fourth"), "no limb of libra is called 'fourth'"),
        (("step", "--robot", "hoshino"), "hoshino: the limb bench takes robots of the family 'limbed'"),
        (("step", "--elbow", "up"), "elbow = up: must be + or -"),
    ],
)
def test_a_mistake_is_named_in_one_line_and_nothing_is_written(
    run: Any, tmp_path: Path, words: tuple[str, ...], said: str
) -> None:
    path = tmp_path / "laws.json"
    code, out, err = run("limb", *words, "-o", str(path), "-q")
    assert code == 2
    assert out == "" and said in err and err.count("\n") == 1
    assert err.startswith("clamber: ") and "Traceback" not in err
    assert not list(tmp_path.iterdir())


def test_a_file_that_cannot_be_written_is_named_before_anything_runs(run: Any, tmp_path: Path) -> None:
    assert run("limb", "step", "-o", str(tmp_path / "laws.xyz"))[0] == 2
    assert run("limb", "step", "-o", str(tmp_path / "none" / "laws.png"))[0] == 2


def test_controllers_and_plants_are_listed(run: Any) -> None:
    code, out, _ = run("list", "controllers", "--json")
    assert code == 0
    assert [entry["name"] for entry in json.loads(out)["controllers"]] == list(LAWS)
    assert "mujoco" in run("list", "plants")[1]
